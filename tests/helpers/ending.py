"""Processes that end."""

import time
from pathlib import Path


def ended(number, within=20.0):
    """Whether the process ``number`` ends before long. It may stay a zombie if nobody waits for it."""
    until = time.monotonic() + within
    while time.monotonic() < until:
        try:
            if Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except (FileNotFoundError, ProcessLookupError):
            return True
        time.sleep(0.02)
    return False
