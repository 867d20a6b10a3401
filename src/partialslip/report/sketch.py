"""Sketch of a scene: bodies, supports and loads, as SVG in black and white."""

import html
import math
from collections.abc import Sequence

import numpy as np

from partialslip.report.answer import scale
from partialslip.report.rows import setting
from partialslip.scene import Scene
from partialslip.scene.bodies import Body
from partialslip.scene.profiles import FlatRounded
from partialslip.scene.units import Dimension, Units
from partialslip.tools.output.svg import with_dark_mode

_WIDTH, _HEIGHT = 470, 405  # display: of the drawing, in its units
_MIDDLE, _LINE = 235.0, 205.0  # display: x of the contact's middle, y of the contact line
_HALF_PLANE = 185.0, 105.0  # display: half-width and height of a half-plane as drawn
_LARGEST = 150.0, 105.0  # display: half-width and height of the largest finite body, holder included
_GIVEN = 150.0, 74.0  # display: half-width and height of a body with a given mesh
_INFINITE = 10.0  # display: width of an infinite body, in heights
_SMALLEST = 24.0, 16.0  # display: half-width and height of the smallest part, however small it is
_ROUND = 34.0  # display: height of the curved face of a body that stands for a half-plane
_HATCH = 9.0  # display: distance and length of the strokes of a clamp
_ROLLER = 4.5  # display: radius
_BEYOND = 14.0  # display: largest distance of a pin behind the body
_ARROW = 34.0  # display: length

Position = tuple[float, float]


def sketch_svg(scene: Scene) -> str:
    """Return the sketch of ``scene`` as SVG, not to scale."""
    parts = [*_body_shapes(scene, "lower"), *_body_shapes(scene, "upper"), *_loads(scene), *_axes(scene)]
    frame = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" '
        f'height="{_HEIGHT}" font-family="sans-serif" font-size="14">'
    )
    return with_dark_mode("\n".join([frame, *parts, "</svg>"])) + "\n"


def _body_shapes(scene: Scene, name: str) -> list[str]:
    """Return the shapes of the lower or the upper body, with support and sizes."""
    body = scene.bodies.lower if name == "lower" else scene.bodies.upper
    way = 1.0 if name == "lower" else -1.0  # of the body's depth on the page
    if body is None:
        return _half_plane(scene, way)
    if body.mesh is not None:
        return _given(body, way)
    return _finite(scene, body, way)


def _half_plane(scene: Scene, way: float) -> list[str]:
    half, height = _HALF_PLANE
    curved = way < 0 and not scene.bodies.pad
    face = _face(scene, half, _ROUND if curved else 0.0, way)
    back = _LINE + way * height
    left, right = (_MIDDLE - half, back), (_MIDDLE + half, back)
    far = [left, *_wave(left, right), right]
    shape = _polygon([*face, *reversed(far)], stroke="none", fill="#ebebeb")
    return [
        shape,
        _line(face),
        _line(far, dash="4 3"),
        _text(_MIDDLE + half - 6, back - way * 14 + 4, "half-plane", "end"),
    ]


def _finite(scene: Scene, body: Body, way: float) -> list[str]:
    """Return a block or pad with holder, support and sizes."""
    own, *behind = _drawn(scene, body)
    half, height = own
    face = _face(scene, half, min(0.45 * height, _ROUND) if body.kind == "pad" else 0.0, way)
    back = _LINE + way * height
    shapes = [_polygon([*face, (_MIDDLE + half, back), (_MIDDLE - half, back)])]
    width = body.width if body.width == "infinite" else scene.units.length(body.width or 0)
    texts = [
        f"{'lower' if way > 0 else 'upper'}: {body.kind}",
        f"{width} × {scene.units.length(body.height or 0)}",
    ]
    top = face[0][1]
    for half, height in behind:
        top, back = back, back + way * height
        shapes.append(_rectangle(half, top, back, fill="#d0d0d0"))
    if body.holder:
        texts.append(f"holder {scene.units.length(body.holder.width)} × {scene.units.length(body.holder.height)}")
    return [*shapes, *_support(body, half, top, back, way), *_column(texts, way)]


def _drawn(scene: Scene, body: Body) -> list[tuple[float, float]]:
    """Return half-width and height of a finite body and its holder as drawn; all finite bodies have one scale."""
    stacks = [_parts(each) for _, each in scene.bodies if each.mesh is None]
    widest = max(width for parts in stacks for width, _ in parts)
    deepest = max(sum(height for _, height in parts) for parts in stacks)
    scale = min(2 * _LARGEST[0] / widest, _LARGEST[1] / deepest)
    return [(max(scale * w / 2, _SMALLEST[0]), max(scale * h, _SMALLEST[1])) for w, h in _parts(body)]


def _parts(body: Body) -> list[tuple[float, float]]:
    """Return width and height, m, of a body and of its holder."""
    holder = [(body.holder.width, body.holder.height)] if body.holder else []
    height = body.height or 0.0
    return [(_INFINITE * height if body.width == "infinite" else body.span, height), *holder]


def _given(body: Body, way: float) -> list[str]:
    """Return a body with a mesh from a file, whose outline is not known here."""
    half, height = _GIVEN
    back = _LINE + way * height
    shapes = [_rectangle(half, _LINE, back, dash="6 4"), *_support(body, half, _LINE, back, way)]
    file = str(body.mesh).replace("\\", "/").rpartition("/")[2]
    label = _text(_MIDDLE, _LINE + way * height / 2 + 4, f"given mesh {file}", "middle")
    return [*shapes, label, *_column([f"{'lower' if way > 0 else 'upper'}: {body.kind}"], way)]


def _face(scene: Scene, half: float, depth: float, way: float) -> list[Position]:
    """Return the face from left to right; ``depth`` is the height of a curved face, 0 for a flat one."""
    if not depth:
        return [(_MIDDLE - half, _LINE), (_MIDDLE + half, _LINE)]
    x = np.linspace(-1.0, 1.0, 61)
    receding = np.maximum(np.abs(x) - (0.3 if isinstance(scene.profile, FlatRounded) else 0.0), 0.0) ** 2
    y = _LINE + way * depth * receding / receding.max()
    return list(zip((_MIDDLE + half * x).tolist(), y.tolist(), strict=True))


def _support(body: Body, half: float, top: float, back: float, way: float) -> list[str]:
    """Return the support: hatched plates, rollers where the body can slide, and the pin on which it turns."""
    if body.support == "pivot":
        return _pin(body, half, back, way)
    left, right = (_MIDDLE - half, top), (_MIDDLE + half, top)
    if body.support == "clamped":
        return _plate((_MIDDLE - half, back), (_MIDDLE + half, back), (0.0, way))
    sides = [((left, (left[0], back)), (-1.0, 0.0)), ((right, (right[0], back)), (1.0, 0.0))]
    held = [side for side in sides if not (body.pulled and not body.gripped and side[1][0] > 0)]
    if body.support == "sides":
        return [shape for (start, end), out in held for shape in _plate(start, end, out)]
    rolling = [(((_MIDDLE - half, back), (_MIDDLE + half, back)), (0.0, way)), *held]
    return [shape for (start, end), out in rolling for shape in _rollers(start, end, out)]


def _pin(body: Body, half: float, back: float, way: float) -> list[str]:
    """Return the plate of a body that turns, and the pin, which hangs on a hatched plate."""
    whole = sum(height for _, height in _parts(body))
    height = (back - _LINE) * (body.pivot_height or 0.0) / whole if whole else back - _LINE + way * _BEYOND
    at = way * min(way * height, way * (back - _LINE) + _BEYOND) + _LINE
    circle = f'<circle cx="{_MIDDLE}" cy="{at:.1f}" r="{_ROLLER}" fill="#ffffff" stroke="#000000"/>'
    foot = at + way * _ROLLER
    hung = _plate((_MIDDLE - 2 * _HATCH, foot), (_MIDDLE + 2 * _HATCH, foot), (0.0, way))
    return [_line([(_MIDDLE - half, back), (_MIDDLE + half, back)], 2.2), _line([(_MIDDLE, back), (_MIDDLE, at)]),
            circle, *hung]  # fmt: skip


def _plate(start: Position, end: Position, out: Position) -> list[str]:
    """Return a rigid plate from ``start`` to ``end``, hatched on the side ``out``."""
    count = max(int(math.dist(start, end) / _HATCH), 2)
    along = ((end[0] - start[0]) / count, (end[1] - start[1]) / count)
    strokes = []
    for number in range(count):  # a stroke each, a drawing of some dozens
        foot = (start[0] + (number + 0.5) * along[0], start[1] + (number + 0.5) * along[1])
        tip = (foot[0] + _HATCH * out[0] + 0.5 * along[0], foot[1] + _HATCH * out[1] + 0.5 * along[1])
        strokes.append(_line([foot, tip], width=0.8))
    return [_line([start, end], width=2.2), *strokes]


def _rollers(start: Position, end: Position, out: Position) -> list[str]:
    """Return rollers along a side, and the plate that they roll on."""
    count = max(int(math.dist(start, end) / 26), 2)
    off = (_ROLLER * out[0], _ROLLER * out[1])
    places = [(number + 0.5) / count for number in range(count)]
    circles = [
        f'<circle cx="{start[0] + (end[0] - start[0]) * share + off[0]:.1f}" '
        f'cy="{start[1] + (end[1] - start[1]) * share + off[1]:.1f}" r="{_ROLLER}" fill="#ffffff" stroke="#000000"/>'
        for share in places
    ]
    moved = [(x + 2 * off[0], y + 2 * off[1]) for x, y in (start, end)]
    return [*circles, *_plate(moved[0], moved[1], out)]


def _loads(scene: Scene) -> list[str]:
    """Return arrows and texts of P, Q, or the displacement of plates in its place, and sigma."""
    load = scene.load
    sigma, slope = ([*each] for each in zip(*load.tension, strict=True))
    top = 26.0
    pressing = [(P, M or 0.0) for P, M in scene.pressing]
    P, moment = ([each[i] for each in pressing] for i in (0, 1))
    shown = f"P = {_normal(P, 'N/m', scene.units)}"
    shown += f", M = {_normal(moment, 'N', scene.units)}" if any(moment) else ""
    shapes = [_arrow((_MIDDLE, top), (_MIDDLE, top + _ARROW)), _text(_MIDDLE + 8, top + 10, shown)]
    if load.displacement is not None:
        shapes.append(_text(6, top + 24, f"lower \u2212 upper plate: {_values([*load.driving], 'm', scene.units)}"))
    elif any(load.driving):
        # Q is the resultant of q, which acts on the upper body along +x: what balances it acts along -x
        shapes += [_arrow((_MIDDLE - 10, top + 20), (_MIDDLE - 10 - _ARROW, top + 20))]
        shown = f"Q = {_values([*load.driving], 'N/m', scene.units)}"
        shapes += [_text(_MIDDLE - 18 - _ARROW, top + 24, shown, "end")]
    if any(sigma) or any(slope):
        lower = scene.bodies.lower
        half, height = _HALF_PLANE if lower is None else _GIVEN if lower.mesh is not None else _drawn(scene, lower)[0]
        beyond = _MIDDLE + half + (2 * _ROLLER + _HATCH if lower and lower.gripped else 0) + 4
        for share in (0.25, 0.75):
            y = _LINE + share * height
            shapes.append(_arrow((beyond, y), (beyond + _ARROW, y)))
            if not (lower and lower.pulled):
                shapes.append(_arrow((_MIDDLE - half - 4, y), (_MIDDLE - half - 4 - _ARROW, y)))
        shown = f"σ = {_values(sigma, 'Pa', scene.units)}"
        shown += f", σ' = {_values(slope, 'Pa/m', scene.units)}" if any(slope) else ""
        shapes += [_text(_WIDTH - 6, _LINE + _HALF_PLANE[1] + 58, shown, "end")]
    return shapes


def _axes(scene: Scene) -> list[str]:
    """Return x and y in the contact, and the data of profile, friction and materials."""
    profile, material = scene.profile, scene.material
    data = [f"{profile.__struct_config__.tag}, R = {scene.units.length(profile.R)}"]
    if isinstance(profile, FlatRounded):
        data += [f"b = {scene.units.length(profile.b)}"]
        data += [f"crown = {scene.units.length(profile.crown)}"] if profile.crown else []
    data.append(f"f = {scene.friction.shown}")
    kinds = {"material": "other" if material.upper or material.lower else "both"}
    stiffness = [
        f"{kinds.get(name) or name.removeprefix('material.')}: "
        f"E = {_values([each.E], 'Pa', scene.units)}, ν = {each.nu:g}"
        for name, each in material
    ]
    y = _LINE + _HALF_PLANE[1] + 58
    lines = [", ".join(data), *stiffness]
    return [
        _arrow((_MIDDLE, _LINE), (_MIDDLE + _ARROW, _LINE), width=1.0),
        _text(_MIDDLE + _ARROW + 4, _LINE + 15, "x"),
        *(_text(6, y + 17 * number, line) for number, line in enumerate(lines)),
    ]


def _values(values: Sequence[float], of: Dimension, units: Units) -> str:
    """Return load points as text with one unit; more than three as a range."""
    exponent, unit = scale(max(map(abs, values)), of, units)
    texts = [setting(float(f"{each / 10.0**exponent:.4g}")) for each in values]
    low, high = (texts[values.index(each)] for each in (min(values), max(values)))
    return f"{f'{low} to {high}' if len(values) > 3 else ', '.join(texts)} {unit}"


def _normal(values: Sequence[float], of: Dimension, units: Units) -> str:
    """Return a normal load as text, at the load points if it varies."""
    return _values(values if len(set(values)) > 1 else values[:1], of, units)


def _column(texts: Sequence[str], way: float) -> list[str]:
    """Return lines of text at the right, beside the lower or the upper body."""
    start = _LINE + _HALF_PLANE[1] + 2 if way > 0 else 54.0
    return [_text(_WIDTH - 6, start + 16 * number, text, "end") for number, text in enumerate(texts)]


def _wave(start: Position, end: Position) -> list[Position]:
    """Return a wavy line between two points: the body goes on."""
    x = np.linspace(start[0], end[0], 81)
    y = start[1] + 2.5 * np.sin(np.linspace(0.0, 16 * np.pi, 81))
    return list(zip(x.tolist(), y.tolist(), strict=True))


def _rectangle(half: float, top: float, back: float, fill: str = "#ebebeb", dash: str = "") -> str:
    left, right = _MIDDLE - half, _MIDDLE + half
    return _polygon([(left, top), (right, top), (right, back), (left, back)], fill=fill, dash=dash)


def _polygon(points: Sequence[Position], fill: str = "#ebebeb", stroke: str = "#000000", dash: str = "") -> str:
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return f'<polygon points="{_places(points)}" fill="{fill}" stroke="{stroke}"{dashed}/>'


def _line(points: Sequence[Position], width: float = 1.2, dash: str = "") -> str:
    dashed = f' stroke-dasharray="{dash}"' if dash else ""
    return f'<polyline points="{_places(points)}" fill="none" stroke="#000000" stroke-width="{width}"{dashed}/>'


def _arrow(start: Position, end: Position, width: float = 1.8) -> str:
    """Return an arrow with a filled head at ``end``."""
    reach = math.dist(start, end)
    along = ((end[0] - start[0]) / reach, (end[1] - start[1]) / reach)
    foot = (end[0] - 9 * along[0], end[1] - 9 * along[1])
    head = [end, *((foot[0] + side * along[1], foot[1] - side * along[0]) for side in (4.0, -4.0))]
    return _line([start, foot], width) + _polygon(head, fill="#000000")


def _places(points: Sequence[Position]) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points)


def _text(x: float, y: float, text: str, anchor: str = "start") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{html.escape(text)}</text>'
