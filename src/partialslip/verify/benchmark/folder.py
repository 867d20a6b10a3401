"""Read a folder of answers: ``meta.toml``, PS-01.json and so on, and tables of tractions PS-01.csv beside them."""

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes
from partialslip.tools.output.files import files_in
from partialslip.tools.strictjson import decoded
from partialslip.verify.benchmark.problem import Posed, Problem, Target
from partialslip.verify.benchmark.submission import LARGEST_FILE, META, Answer, Meta, Submission, read_meta
from partialslip.verify.benchmark.tables import TableValues, completed, read_table, remark

_FEWEST = 2  # limit: meshes of a ladder


class Folder(NamedTuple):
    """What can be read of a folder: ``meta``, ``answers`` as the files give them and ``tables`` beside them, by number
    of the problem, and a line for each thing that is ``wrong``. There is a line if meta is None."""

    meta: Meta | None
    answers: dict[str, Answer]
    tables: dict[str, TableValues]
    wrong: Sequence[str]

    def as_written(self) -> Submission:
        """The answers as the files give them. Raises InputError if anything is wrong."""
        if self.wrong or self.meta is None:
            raise InputError(self.wrong[0])
        return Submission(self.meta, self.answers)

    def submission(self, known: Mapping[str, Posed]) -> Submission:
        """The answers, completed from the tables. Raises InputError if anything is wrong."""
        written = self.as_written()
        found, remarks = dict(written.answers), []
        for number, table in self.tables.items():
            found[number] = completed(self.answers[number], table)
            remarks.append(remark(known[number], self.answers[number], table))
        return Submission(written.meta, found, tuple(remarks))


def read_submission(folder: str | os.PathLike[str], known: Mapping[str, Posed]) -> Submission:
    """Read a submission: ``meta.toml``, and a file PS-01.json and so on for each problem that is answered. Values that
    an answer leaves out are read from the table of tractions PS-01.csv, if there is one.

    Parameters
    ----------
    folder : str or path
    known : mapping of str to Problem
        Problems by number.

    Raises
    ------
    InputError
        If a file cannot be read, has a field or a value that is not allowed, or answers no problem of the benchmark.
    """
    return examined(folder, known).submission(known)


def examined(folder: str | os.PathLike[str], known: Mapping[str, Posed], *, with_tables: bool = True) -> Folder:
    """Read a submission as far as it can be read, with or without its tables. Other parameters as for
    :func:`read_submission`."""
    path = Path(folder)
    if not path.is_dir():
        return Folder(None, {}, {}, [f"{folder}: must be a folder with {META} and PS-01.json and so on"])
    meta, answers, tables, wrong = None, dict[str, Answer](), dict[str, TableValues](), list[str]()
    try:
        meta = read_meta(path)
    except InputError as error:
        wrong.append(str(error))
    files = files_in(path, "*.json")
    for file in files:
        number = file.stem
        if number not in known:
            wrong.append(f"{file}: no problem has this number; known are {', '.join(known)}")
            continue
        try:
            answer = decoded(read_bytes(file, LARGEST_FILE), Answer, str(file))
        except InputError as error:
            wrong.append(str(error))
            continue
        answers[number] = answer
        wrong += [f"{file}: {line}" for line in (*_ladder_faults(answer), *_unknown(answer, known[number].measured))]
        table = file.with_suffix(".csv")
        posed = known[number]
        if with_tables and isinstance(posed, Problem) and os.path.lexists(table):
            try:
                tables[number] = read_table(posed, table)
            except InputError as error:
                wrong.append(str(error))
    if not files:
        wrong.append(f"{folder}: no answers; must have PS-01.json and so on")
    return Folder(meta, answers, tables, wrong)


def _unknown(answer: Answer, targets: Mapping[str, Target]) -> Iterator[str]:
    """A line for each key that no target has, at the first place where it stands."""
    found = {"values": answer.values} | {
        f"ladder[{place}].values": rung.values for place, rung in enumerate(answer.ladder)
    }
    places: dict[str, str] = {}
    for name, values in found.items():
        for key in values:
            if key not in targets:
                places.setdefault(key, name)
    for key, name in places.items():
        yield f"{name}.{key}: no target has this key; known are {', '.join(targets)}"


def _ladder_faults(answer: Answer) -> Iterator[str]:
    """Lines if the ladder has one mesh, does not go from coarse to fine, or ends elsewhere than the answer."""
    sizes = [rung.h for rung in answer.ladder]
    if not sizes:
        return
    if len(sizes) < _FEWEST:
        yield f"ladder: must have {_FEWEST} meshes or more, not {len(sizes)}"
    for place, (before, after) in enumerate(itertools.pairwise(sizes), start=1):
        if not after < before:
            yield f"ladder[{place}].h = {after}: must be less than {before}, that of the mesh before"
    if answer.ladder[-1].values != answer.values:
        yield "values: must be those of the last mesh of the ladder"
