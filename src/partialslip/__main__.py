"""``python -m partialslip``: the command line."""

import sys

from partialslip.cli import main

if __name__ == "__main__":
    sys.exit(main())
