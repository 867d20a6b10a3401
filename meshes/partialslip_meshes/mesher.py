"""Program of the gmsh process, which makes one mesh per request.

It answers requests on standard input until the input is closed. A message is a length (8 bytes), JSON of this length,
and arrays whose lengths in bytes are in the JSON. The file is run on its own and needs the standard library and gmsh
only: importing NumPy would take longer than most meshes.
"""

import json
import os
import sys
import time
from array import array
from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

# fixed: right-angled triangles, paired; a final refinement removes the triangles without a partner
_ALL_QUADS = {"Algorithm": 8, "RecombineAll": 1, "RecombinationAlgorithm": 3}

# limit: half-width of a block, in its height, from which quadrilaterals have at most half its height: gmsh refuses
# sides that are one element long
_SLENDER = 4.0
# cost: of an element: to which the number of elements up to a point of a line is integrated. By default gmsh integrates
# to 1e-9, which takes three quarters of the time of a mesh that is graded; with 1e-6 sizes are off by 5e-5 (measured)
_COUNTED = 1e-6
_PIECE = 1 << 20  # cost: bytes of one read from a pipe


def send(pipe: int, head: Mapping[str, Any], arrays: Sequence[bytes] = ()) -> None:
    """Write a message, ``head`` as JSON and ``arrays``, to the file descriptor ``pipe``."""
    text = json.dumps({**head, "bytes": [len(each) for each in arrays]}).encode()
    left = memoryview(b"".join([len(text).to_bytes(8, "little"), text, *arrays]))
    while left:
        left = left[os.write(pipe, left) :]


def receive(pipe: int) -> tuple[dict[str, Any], list[bytes]]:
    """Read a message from the file descriptor ``pipe``: JSON and arrays. Raises EOFError if the pipe is closed."""
    head = json.loads(_read(pipe, int.from_bytes(_read(pipe, 8), "little")))
    return head, [_read(pipe, length) for length in head["bytes"]]


def _read(pipe: int, length: int) -> bytes:
    found = bytearray()
    while len(found) < length:
        piece = os.read(pipe, min(length - len(found), _PIECE))
        if not piece:
            raise EOFError
        found += piece
    return bytes(found)


def main() -> None:
    """Answer requests; the command line has one argument, the folder of gmsh."""
    answers = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # libraries print to standard output, too
    _end_with_parent()
    sys.path.append(sys.argv[1])
    sys.modules["numpy"] = None  # type: ignore[assignment]
    counted = 0.0  # CPU seconds reported; the first answer includes the start
    while True:
        try:
            request, _ = receive(0)
        except EOFError:
            return
        head, arrays = _answer(request)
        spent = time.process_time()
        send(answers, head | {"cpu_s": spent - counted}, arrays)
        counted = spent


def _end_with_parent() -> None:
    """End the process when standard input is closed, even in the middle of a mesh."""
    import select
    import threading

    if not hasattr(select, "poll"):  # Windows: the process ends after its mesh
        return
    closed = select.poll()
    closed.register(0, 0)  # reports hang-ups only

    def wait() -> None:
        closed.poll()
        os._exit(0)

    threading.Thread(target=wait, daemon=True).start()


def _answer(request: Mapping[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
    try:
        import gmsh
    except ModuleNotFoundError as error:
        return {"error": "module", "text": str(error.name)}, []
    except OSError as error:  # the wheel installs everywhere, but needs system libraries
        return {"error": "library", "text": str(error)}, []
    try:
        if "path" in request:
            return rewrite(gmsh, request["path"], request["target"])
        return mesh(gmsh, **{key: value for key, value in request.items() if key != "bytes"})
    except MemoryError:
        return {"error": "memory", "text": ""}, []
    except Exception as error:  # gmsh raises plain Exception
        return {"error": "gmsh", "text": str(error)}, []


def mesh(gmsh: ModuleType, corners: int, smooth: float, options: Mapping[str, float] | None = None,
         **outline: Any) -> tuple[dict[str, Any], list[bytes]]:  # fmt: skip
    """Mesh a block in a new gmsh session.

    Parameters
    ----------
    gmsh : module
    corners : int
        Corners of an element: 3 or 4.
    smooth : float
        Square of the largest ratio of neighbours on a line.
    options : mapping, optional
        Further gmsh options.
    **outline
        As for :func:`partialslip_meshes.block`, with sizes as pairs, and "at_corners" for corners; element sizes there
        are formulas of the distance F.

    Returns
    -------
    dict, list of bytes
        Names of the lines; then node tags, node coordinates, node tags of the elements, and node tags of each line.
    """
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        lines = _outline(gmsh, **outline)
        kind = _ALL_QUADS if corners == 4 else {}
        if kind and outline["width"] > _SLENDER * outline["height"]:
            kind = kind | {"MeshSizeMax": outline["height"] / 2}
        usual = {"SmoothRatio": smooth, "LcIntegrationPrecision": _COUNTED}
        for option, value in {**usual, **kind, **(options or {})}.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        cells = [_element_nodes(gmsh, 2, [-1]), *(_element_nodes(gmsh, 1, curves) for curves in lines.values())]
    finally:
        gmsh.finalize()
    return {"lines": list(lines)}, [array("Q", tags).tobytes(), array("d", coordinates).tobytes(), *cells]


def rewrite(gmsh: ModuleType, path: str, target: str) -> tuple[dict[str, Any], list[bytes]]:
    """Write the elements of surfaces and of physical groups in the file ``path`` into the file ``target``, in format
    4.1 without parameters, which meshio reads."""
    gmsh.initialize([], readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        rest = [tag for _, tag in gmsh.model.getEntities(2) if not len(gmsh.model.getPhysicalGroupsForEntity(2, tag))]
        if rest:
            gmsh.model.addPhysicalGroup(2, rest)
        for option, value in {"MshFileVersion": 4.1, "Binary": 0, "SaveAll": 0, "SaveParametric": 0}.items():
            gmsh.option.setNumber(f"Mesh.{option}", value)
        gmsh.write(target)
    finally:
        gmsh.finalize()
    return {}, []


def _element_nodes(gmsh: ModuleType, dimension: int, entities: Sequence[int]) -> bytes:
    """Node tags of the elements of all ``entities``, in order."""
    return b"".join(
        array("Q", nodes[0]).tobytes()
        for _, _, nodes in (gmsh.model.mesh.getElements(dimension, entity) for entity in entities)
    )


def _outline(
    gmsh: ModuleType,
    width: float,
    height: float,
    holder: tuple[float, float] | None,
    contact: tuple[float, float],
    sizes: Sequence[tuple[float, str]],
    growth: float,
    along: float | None,
    facets: float | None,
    at_corners: Mapping[str, str],
) -> dict[str, list[int]]:
    """Make the geometry and the size field; return the curves of each named line."""
    geo, field = gmsh.model.geo, gmsh.model.mesh.field
    starts_at = dict(sizes)
    on_contact = sorted({*contact, *starts_at})
    # corners of the right side, from the back to the face
    corners = [(width, -height), (width, 0.0)]
    if holder:
        foot = (holder[0], -height)
        corners = [(holder[0], -height - holder[1]), *([foot] if foot != corners[0] else []), *corners]
    right = [geo.addPoint(x, y, 0) for x, y in corners]
    left = [geo.addPoint(-x, y, 0) for x, y in corners]
    surface = [left[-1], *(geo.addPoint(x, 0, 0) for x in on_contact), right[-1]]
    loop = [*right, *reversed(surface[1:-1]), *reversed(left)]
    curves = [geo.addLine(start, end) for start, end in zip(loop, [*loop[1:], loop[0]], strict=True)]
    geo.addPlaneSurface([geo.addCurveLoop(curves)])
    geo.synchronize()

    starts = {surface[1 + on_contact.index(x)]: size for x, size in starts_at.items()}
    places = {"foot": 0, "shoulder": 1 if holder else -1}
    if holder and holder[0] != width:
        places["notch"] = 1 if holder[0] < width else 2
    for corner, size_there in at_corners.items():
        if corner in places:
            starts |= {side[places[corner]]: size_there for side in (left, right)}
    grades = []
    for point, size_there in starts.items():
        distance = field.add("Distance")
        field.setNumbers(distance, "PointsList", [point])
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", size_there.replace("F", f"F{distance}"))
    middle, half = (contact[0] + contact[1]) / 2, (contact[1] - contact[0]) / 2
    beyond = f"(abs(x - ({middle!r})) - {half!r})"
    if along is not None:
        grades.append(field.add("MathEval"))
        field.setString(grades[-1], "F", f"{along!r} + {growth!r} * sqrt(y^2 + ({beyond} + abs{beyond})^2 / 4)")
    if facets is not None:
        grades.append(field.add("MathEval"))
        field.setString(
            grades[-1], "F", f"{facets!r} * ({half!r} + ({beyond} + abs{beyond}) / 2) + {growth!r} * abs(y)"
        )
    smallest = field.add("Min")
    field.setNumbers(smallest, "FieldsList", grades)
    field.setAsBackgroundMesh(smallest)
    for other in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints", "MeshSizeFromCurvature"):
        gmsh.option.setNumber(f"Mesh.{other}", 0)

    up = len(corners) - 1  # curves of a side
    return {
        "contact": curves[up + 1 : -up - 2],
        "face": [curves[up], curves[-up - 2]],
        "back": curves[-1:],
        "left": [curves[-2]],
        "right": curves[:1],
        **({"flanks": [*curves[1:up], *curves[-up - 1 : -2]]} if up > 1 else {}),
    }


if __name__ == "__main__":
    main()
