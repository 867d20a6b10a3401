"""Numbered problems as data: one file a problem, and one file with the frozen targets of all."""

import hashlib
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, Protocol

import msgspec

from partialslip.scene import Scene
from partialslip.scene.reading import load_scene, parse_scene, scene_toml
from partialslip.scene.units import Dimension
from partialslip.tools.errors import InputError
from partialslip.verify.benchmark.curves import read_curves

_PACKAGE = "partialslip.verify.benchmark"
_TARGETS = "targets.json"
EDITION = "1.1"
SETTINGS = ("fem", "effects")  # tables of a scene that are settings of partialslip, no part of a problem


class Source(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A publication: its ``text``, and its ``doi`` where known."""

    text: str
    doi: str | None = None


class Target(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What a code should find.

    Parameters
    ----------
    value : float
        In SI units.
    unit : str
        Dimension of the value: m, Pa, N/m or J/m.
    scale : float
        Size to which an error is relative, in the same unit: a, p0, f p0 or P, or the value itself.
    uncertainty : float
        Largest error of the value, in ``scale``.
    known : str
        How the value is known.
    group : str
        contact, stick, tractions, levels, slip or stress.
    """

    value: float
    unit: Dimension
    scale: float
    uncertainty: float
    known: str
    group: str


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    title: str
    statement: str
    scene: dict[str, Any] | str  # tables, or the name of a shipped scene
    sources: tuple[Source, ...] = ()
    places: tuple[Annotated[float, msgspec.Meta(ge=-1, le=1)], ...] = (-0.9, -0.5, 0.0, 0.5, 0.9)
    why: str = ""
    stress: bool = False  # whether the largest sigma_xx of the lower surface is a target
    swt_over: float | None = None  # m: SWT is a target, at the surface and averaged over this depth


class Frozen(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The frozen part of an ``edition``: by number of the problem its ``checksums``, ``regimes`` and ``targets``."""

    edition: str
    checksums: dict[str, str]
    regimes: dict[str, str]
    targets: dict[str, dict[str, Target]]


class Posed(Protocol):
    """What answers are graded by: a problem, or a statement."""

    @property
    def number(self) -> str:
        """Its number."""

    @property
    def title(self) -> str:
        """Its title."""

    @property
    def measured(self) -> Mapping[str, Target]:
        """What its answers are graded by, by key."""


class Problem(msgspec.Struct, frozen=True):
    """A problem of the benchmark.

    Parameters
    ----------
    number : str
        PS-01 and so on.
    title, statement : str
        The statement stands alone: a code needs nothing else.
    why : str
        What is hard about it.
    sources : tuple of Source
    scene : Scene
    places : tuple of float
        x/a at which tractions are targets; a is the target.
    regime : str
        That of the steady state, in the words of partialslip.
    targets : mapping of str to Target
    """

    number: str
    title: str
    statement: str
    why: str
    sources: tuple[Source, ...]
    scene: Scene
    places: tuple[float, ...]
    regime: str
    targets: Mapping[str, Target]

    @property
    def measured(self) -> dict[str, Target]:
        """What answers are graded by: ``targets``, those of tractions at points in a group of their own, and the norms
        p and q, relative L2 errors over the contact as ``partialslip score`` measures them, which should be zero."""
        norms, found, curve = dict[str, Target](), dict[str, Target](), read_curves().get(self.number)
        off = curve.error if curve else 0.0
        for key, target in self.targets.items():
            name = {"p": "p", "dq": "q"}.get(key.partition("@")[0])
            if name and "@" in key and (name not in norms or norms[name].uncertainty < target.uncertainty):
                unsure, words = max(target.uncertainty, off), f"zero by definition; the curve is known as {key}"
                norms[name] = Target(value=0.0, unit="1", scale=1.0, uncertainty=unsure, known=words, group="tractions")
            found[key] = msgspec.structs.replace(target, group="points") if target.group == "tractions" else target
        return found | norms


@cache
def read_problems() -> dict[str, Problem]:
    """All problems by number, with their frozen targets."""
    frozen = read_frozen()
    return {number: parse_problem(number, text, frozen) for number, text in texts().items()}


def chosen_problems(numbers: str | None) -> dict[str, Problem]:
    """Problems whose numbers match ``numbers``, patterns such as PS-0* separated by commas; None for all.

    Raises
    ------
    InputError
        If there is no pattern, or one matches no problem.
    """
    from fnmatch import fnmatchcase

    known = read_problems()
    if numbers is None:
        return known
    found: dict[str, Problem] = {}
    for pattern in (each.strip() for each in numbers.split(",")):
        some = {number: each for number, each in known.items() if fnmatchcase(number, pattern)}
        if not some:
            raise InputError(
                f"--problems {pattern!r}: must be numbers of {', '.join(known)}, or patterns such as PS-0*"
            )
        found |= some
    return dict(sorted(found.items()))


def numbered(number: str) -> Problem:
    """The problem with this ``number``. Raises InputError if there is none."""
    known = texts()
    if number not in known:
        raise InputError(f"PROBLEM {number!r}: must be one of {', '.join(known)}")
    return parse_problem(number, known[number], read_frozen())


def texts() -> dict[str, str]:
    """Texts of the problem files by number."""
    folder = files(_PACKAGE) / "problems"
    named = {entry.name.removesuffix(".toml"): entry for entry in folder.iterdir() if entry.name.endswith(".toml")}
    return {number: named[number].read_text("utf-8") for number in sorted(named)}


def read_frozen() -> Frozen:
    """The frozen part of the edition."""
    path = files(_PACKAGE) / _TARGETS
    return msgspec.json.decode(path.read_bytes(), type=Frozen)


def frozen_text(targets: Mapping[str, Mapping[str, Target]], regimes: Mapping[str, str]) -> str:
    """Content of the file of frozen ``targets`` and ``regimes``, with a checksum of each problem."""
    made = {number: dict(some) for number, some in sorted(targets.items())}
    sums = {number: problem_checksum(number, made[number]) for number in made}
    encoded = msgspec.json.encode(Frozen(EDITION, sums, dict(sorted(regimes.items())), made))
    return msgspec.json.format(encoded, indent=1).decode() + "\n"


def problem_checksum(number: str, targets: Mapping[str, Target]) -> str:
    """Checksum of a problem: its file, its scene and its targets."""
    text = texts()[number]
    content = [text, scene_toml(parse_problem(number, text).scene, SETTINGS), dict(targets)]
    return hashlib.sha256(msgspec.json.encode(content, order="sorted")).hexdigest()


def parse_problem(number: str, text: str, frozen: Frozen | None = None) -> Problem:
    """Problem of the file ``text``, with what is ``frozen`` of it, if anything is."""
    file = msgspec.convert(tomllib.loads(text), _File)
    named = {"name": number.lower(), "title": file.title}
    shipped = isinstance(file.scene, str)
    scene = load_scene(file.scene).replace(named) if shipped else parse_scene(named | file.scene)  # type: ignore[arg-type, operator]
    if file.stress:
        scene = scene.replace(effects={"subsurface": True}, fatigue={"distance": file.swt_over})
    told = file.title, file.statement.strip(), file.why, file.sources
    known = (frozen.regimes.get(number, ""), frozen.targets.get(number, {})) if frozen else ("", {})
    return Problem(number, *told, scene, file.places, *known)
