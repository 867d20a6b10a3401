"""Run gmsh in a separate process, shared by all threads: gmsh has one global state, which the caller may use.

The gmsh process starts with the first mesh and ends with the calling process, even if that is killed.
"""

import atexit
import importlib.util
import os
import pkgutil
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn

from partialslip.tools.errors import MissingLibraryError, PartialslipError
from partialslip_meshes.mesher import receive, send

# System libraries that the gmsh wheel needs, and their Debian packages.
DEBIAN_PACKAGES = {
    "libGLU.so.1": "libglu1-mesa",
    "libGL.so.1": "libgl1",
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXfixes.so.3": "libxfixes3",
    "libXrender.so.1": "libxrender1",
    "libXcursor.so.1": "libxcursor1",
    "libXft.so.2": "libxft2",
    "libXinerama.so.1": "libxinerama1",
    "libfontconfig.so.1": "libfontconfig1",
    "libgomp.so.1": "libgomp1",
}

OPTIONS: dict[str, float] = {}  # gmsh options for every mesh, by name without "Mesh."


class _Mesher:
    """A running process of :mod:`partialslip_meshes.mesher`."""

    def __init__(self, folder: str) -> None:
        source = (pkgutil.get_data("partialslip_meshes", "mesher.py") or b"").decode()
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-I", "-S", "-c", source, folder],
                bufsize=0,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                cwd=os.path.abspath(os.sep),  # the current folder may be deleted
                start_new_session=True,  # Ctrl-C goes to the calling process only
            )
        except OSError as error:
            raise PartialslipError(f"the gmsh process cannot be started: {error.strerror}") from None

    def ask(self, request: Mapping[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
        """Return the answer to ``request``. Raises EOFError or OSError if the process dies."""
        assert self._process.stdin
        assert self._process.stdout
        with _no_broken_pipe_signal():
            send(self._process.stdin.fileno(), request)
        return receive(self._process.stdout.fileno())

    def end(self) -> int:
        """Kill the process if it is running, and return its exit code."""
        self._process.kill()
        code = self._process.wait()
        self.leave()
        return code

    def leave(self) -> None:
        """Close this side of the pipes without ending the process."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe:
                pipe.close()
        self._process.returncode = self._process.returncode or 0  # nothing to wait for


@contextmanager
def _no_broken_pipe_signal() -> Iterator[None]:
    """Make a write to a closed pipe raise BrokenPipeError, even where SIGPIPE would end the calling process."""
    if not hasattr(signal, "sigtimedwait"):  # Windows has no such signal, macOS no such call
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    try:
        yield
    finally:
        if signal.SIGPIPE not in before and signal.SIGPIPE in signal.sigpending():
            signal.sigtimedwait({signal.SIGPIPE}, 0)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


_lock = threading.Lock()
_mesher: _Mesher | None = None


def ask(request: Mapping[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
    """Make a mesh in the gmsh process, one thread at a time. A process that dies is replaced once.

    ``request`` has the arguments of :func:`partialslip_meshes.mesher.mesh`, or of ``rewrite``. Returns the same, and in
    the dict "cpu_s", the CPU seconds of the mesh.

    Raises
    ------
    MissingLibraryError
        If gmsh, or a system library that gmsh needs, is missing.
    PartialslipError
        If gmsh cannot make the mesh, or the process dies twice.
    """
    global _mesher
    died = 0
    with _lock:
        while True:
            _mesher = _mesher or _Mesher(_folder())
            try:
                head, arrays = _mesher.ask({**request, "options": OPTIONS})
                break
            except (EOFError, OSError):
                code, _mesher = _mesher.end(), None
                died += 1
                if died == 2:
                    how = f"signal {-code}" if code < 0 else f"exit code {code}"
                    raise PartialslipError(f"the gmsh process died twice ({how}); is there enough memory?") from None
            except BaseException:  # Ctrl-C: the answer would be read as that of the next request
                _end()
                raise
    if "error" in head:
        _refuse(**head)
    return head, arrays


def _folder() -> str:
    """Folder that gmsh is imported from."""
    loaded = getattr(sys.modules.get("gmsh"), "__file__", None)
    spec = None if loaded else importlib.util.find_spec("gmsh")
    origin = loaded or (spec and spec.origin)
    if not origin:
        raise MissingLibraryError("gmsh is missing; pip install gmsh")
    return str(Path(origin).parent)


def _refuse(error: str, text: str, **_: Any) -> NoReturn:
    if error == "memory":
        raise MemoryError
    if error == "module":
        raise MissingLibraryError(f"gmsh cannot be loaded: {text} is missing")
    if error == "gmsh":
        raise PartialslipError(f"gmsh cannot make the mesh: {text}")
    library = re.match(r"[^\s:]+", text)
    name = library[0] if library else text
    package = DEBIAN_PACKAGES.get(name)
    hint = f"on Debian or Ubuntu: apt-get install {package}" if package else "install it with the system's packages"
    raise MissingLibraryError(f"gmsh cannot be loaded: the system library {name} is missing; {hint}")


def _end() -> None:
    global _mesher
    if _mesher:
        _mesher.end()
        _mesher = None


def _begin_anew() -> None:
    """After a fork, in the child: leave the gmsh process to the parent, whose threads may be waiting for it."""
    global _lock, _mesher
    _lock = threading.Lock()
    if _mesher:
        _mesher.leave()
        _mesher = None


atexit.register(_end)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_begin_anew)
