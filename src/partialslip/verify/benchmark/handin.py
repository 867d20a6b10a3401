"""Hand in answers: what a folder must have to enter the scoreboard, beyond what it must have to be read."""

import os
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import checksum
from partialslip.tools.output.files import files_in
from partialslip.verify.benchmark.folder import examined
from partialslip.verify.benchmark.problem import Posed, Target
from partialslip.verify.benchmark.submission import META, Answer, Meta, Submission, seen
from partialslip.verify.benchmark.tables import TableValues, differences

_DUE = {"author": "who ran the code", "version": "the version of the code", "settings": "elements and contact in words",
        "machine": "processor and system"}  # fmt: skip
_LARGEST = 2**30  # limit: bytes of an input file
_POSITIVE = {"a", "p_max", "slip", "dissipated", "swt", "swt_line"}  # fixed: quantities that are positive
_ORDERED = (("m", "n", -1), ("left_1", "right_1", 1), ("left_2", "right_2", 1))  # fixed: ends of [-m, n] and others
_TENSION = 0.01  # limit: largest tension at the ends of the contact, in p0: what nodal means have there
_WILD = 20.0  # limit: largest error, in the scale of a target: only elements that lock, and values in mm or MPa


def handed_in(folder: str | os.PathLike[str], known: Mapping[str, Posed]) -> tuple[Submission | None, list[str]]:
    """Check a folder of answers before it is handed in.

    The folder must be one that :func:`read_submission` reads. All of ``meta.toml`` must be filled in. Each file of the
    folder must be ``meta.toml``, an answer PS-01.json, a table of tractions PS-01.csv, a hidden file, or an input file
    that ``inputs`` lists with its checksum. A value must be the one that the table beside it gives, within the error
    with which it can be read there (:mod:`partialslip.verify.benchmark.tables`).

    Parameters
    ----------
    folder : str or path
    known : mapping of str to Problem
        Problems by number.

    Returns
    -------
    Submission or None, list of str
        The submission if nothing is wrong, and a line for each thing that is wrong.
    """
    path = Path(folder)
    found = examined(path, known)
    wrong = [*found.wrong]
    if found.meta is not None:
        wrong += [*_meta_faults(path, found.meta), *_input_faults(path, found.meta)]
    for number, answer in found.answers.items():
        wrong += _answer_faults(path, known[number], answer, found.tables.get(number))
    return (None if wrong else found.submission(known)), wrong


def _meta_faults(folder: Path, meta: Meta) -> Iterator[str]:
    for name, content in _DUE.items():
        if not seen(getattr(meta, name)):
            yield f"{folder / META}: {name} = {getattr(meta, name)!r}: must be {content}"
    if not meta.inputs:
        yield f"{folder / META}: inputs: must be a table of the input files and their SHA-256 checksums"


def _input_faults(folder: Path, meta: Meta) -> Iterator[str]:
    """Lines for input files that are not as ``meta`` says, and for files that it does not list."""
    own = {META} | {f"{file.stem}{suffix}" for file in files_in(folder, "*.json") for suffix in (".json", ".csv")}
    for name, given in meta.inputs.items():
        told, file = f"{folder / META}: inputs.{name!r}", folder / name
        plain = str(PurePosixPath(name)) == name and ".." not in PurePosixPath(name).parts
        if not plain or name in own or not _lies_in(file, folder):
            yield f"{told}: must be the path of an input file in the folder, such as decks/job.inp"
            continue
        try:
            true, empty = checksum(file, _LARGEST), not file.stat().st_size
        except InputError as error:
            yield f"{told}: {error}"
            continue
        if empty:
            yield f"{told}: must not be an empty file"
        elif given != true:
            yield f"{told} = {given!r}: must be {true!r}, the SHA-256 checksum of the file"
    for file in sorted(folder.rglob("*")):
        name = file.relative_to(folder).as_posix()
        hidden = any(part.startswith(".") for part in file.relative_to(folder).parts)
        if file.is_dir() or hidden or name in meta.inputs:
            continue
        if not _lies_in(file, folder):
            yield f"{file}: must be a file of the folder, not a link to a file elsewhere or to itself"
            continue
        if name in own:
            continue
        try:
            listed = f'"{name}" = "{checksum(file, _LARGEST)}"'
        except InputError as error:
            yield str(error)
        else:
            yield f"{file}: must be listed in the table inputs of {META}, as {listed}, or left out"


def _lies_in(file: Path, folder: Path) -> bool:
    """Whether ``file`` lies in ``folder``, and is no link to elsewhere or to itself."""
    try:
        return file.resolve().is_relative_to(folder.resolve())
    except (OSError, RuntimeError):  # links that go round in circles
        return False


def _value_faults(given: Mapping[str, float], targets: Mapping[str, Target]) -> Iterator[str]:
    """Lines for values that no contact has: far from the target, of the wrong sign, or ends in the wrong order."""
    pressures = {key: value for key, value in given.items() if key.startswith("p@")}
    if pressures and all(value < -_TENSION * targets[key].scale for key, value in pressures.items()):
        key, value = next(iter(pressures.items()))  # single points of elements that lock may be in tension
        yield f"{key} = {value:.9g}: must be >= 0: pressure is positive in compression"
    for key, value in given.items():
        target = targets[key]
        if not abs(value - target.value) <= _WILD * target.scale:
            most = f"{_WILD * target.scale:.3g} {target.unit}"
            yield f"{key} = {value:.9g}: must be within {most} of the target; all values are in SI units"
        elif key in _POSITIVE and not value > 0:
            yield f"{key} = {value:.9g}: must be > 0"
    for low, high, sign in _ORDERED:
        if low in given and high in given and not sign * given[low] <= given[high]:
            least = f"{'-' if sign < 0 else ''}{low} = {sign * given[low]:.9g}"
            yield f"{high} = {given[high]:.9g}: must be >= {least}, the left end"


def _answer_faults(folder: Path, problem: Posed, answer: Answer, table: TableValues | None) -> Iterator[str]:
    file, targets = folder / f"{problem.number}.json", problem.measured
    given = {key: value for key, value in answer.values.items() if value is not None and key in targets}
    if not given and not table and not seen(answer.note):
        yield f"{file}: values: must have a value, or note must say why there is none"
    yield from (f"{file}: values.{line}" for line in _value_faults(given, targets))
    for place, rung in enumerate(answer.ladder[:-1]):  # the last one has the values of the answer
        own = {key: value for key, value in rung.values.items() if value is not None and key in targets}
        yield from (f"{file}: ladder[{place}].values.{line}" for line in _value_faults(own, targets))
    if table:
        yield from (f"{file}: {line}" for line in differences(problem, answer, table, f"{problem.number}.csv"))
