"""A gmsh session that is quiet, clean and interruptible, and says which system library is missing."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType

from partialslip.errors import MissingLibraryError

# The libraries that the gmsh wheel needs from the system, and the Debian packages that have them.
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


@contextmanager
def gmsh_session() -> Iterator[ModuleType]:
    """An initialised gmsh with an empty model, finalised at the end.

    Raises
    ------
    MissingLibraryError
        If gmsh, or a system library that it needs, is not there.
    """
    gmsh = _import_gmsh()
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield gmsh
    finally:
        gmsh.finalize()


def _import_gmsh() -> ModuleType:
    try:
        import gmsh
    except OSError as error:  # the wheel installs everywhere, but its library links to the system's
        library = re.match(r"[^\s:]+", str(error))
        name = library[0] if library else str(error)
        package = DEBIAN_PACKAGES.get(name)
        hint = f"on Debian or Ubuntu: apt-get install {package}" if package else "install it with the system's packages"
        raise MissingLibraryError(f"gmsh cannot be loaded: the system library {name} is missing; {hint}") from None
    return gmsh  # type: ignore[no-any-return]
