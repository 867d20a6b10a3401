"""Submissions: what a code found, and how it is written as a folder of plain files."""

import os
import re
import unicodedata
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import msgspec
import tomli_w

from partialslip.scene.reading import parse_toml
from partialslip.scene.table import NO_TEXT
from partialslip.tools.errors import InputError
from partialslip.tools.inputfile import read_bytes, read_text
from partialslip.tools.output.files import json_text, write_texts
from partialslip.tools.output.lock import locked
from partialslip.tools.output.place import REQUEST_NAME as REQUEST
from partialslip.tools.strictjson import converted

LARGEST_FILE = 2**20  # limit: bytes of a file
META = "meta.toml"
# Cyrillic and Greek letters that look like Latin ones.
_LIKE_LATIN = str.maketrans(
    "\u0430\u0435\u043e\u0440\u0441\u0443\u0445\u0456\u0458\u0455\u04bb\u0501\u051b\u051d\u04cf"
    "\u0410\u0412\u0415\u041a\u041c\u041d\u041e\u0420\u0421\u0422\u0423\u0425\u0406\u0408\u0405"
    "\u03bf\u03bd\u03c1\u03b1\u0391\u0392\u0395\u0396\u0397\u0399\u039a\u039c\u039d\u039f\u03a1\u03a4\u03a5\u03a7",
    "aeopcyxijshdqwl" "ABEKMHOPCTYXIJS" "ovpaABEZHIKMNOPTYX",
)  # fmt: skip


class Meta(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Who found the values, and how.

    Only ``code`` and ``version`` must be there to read a folder. To hand it in, all must
    (:func:`partialslip.verify.benchmark.handed_in`).

    Parameters
    ----------
    code, version : str
    settings : str
        In words.
    machine : str
    author : str
        Who ran the code.
    inputs : mapping of str to str
        SHA-256 checksums of the input files, by path in the folder.

    Raises
    ------
    InputError
        If a text has control characters, line ends or marks of the direction of writing, or ``code`` is blank.
    """

    code: Annotated[str, msgspec.Meta(min_length=1, max_length=60)]
    version: Annotated[str, msgspec.Meta(max_length=60)]
    settings: Annotated[str, msgspec.Meta(max_length=400)] = ""
    machine: Annotated[str, msgspec.Meta(max_length=200)] = ""
    author: Annotated[str, msgspec.Meta(max_length=200)] = ""
    inputs: dict[str, str] = {}

    def __post_init__(self) -> None:
        for name in ("code", "version", "settings", "machine", "author"):
            _check_text(name, getattr(self, name))
        if self.code and not seen(self.code):
            raise InputError(f"code = {self.code!a}: must be the name of the code")
        for name, checksum in self.inputs.items():
            _check_text("inputs", name)
            _check_text(f"inputs.{name!r}", checksum)


class Rung(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One mesh of a ladder: size ``h`` of its elements along the contact, in a unit of the code's choice, and
    ``values``, ``cpu_s``, ``unknowns`` and ``estimate`` as in :class:`Answer`."""

    h: Annotated[float, msgspec.Meta(gt=0)]
    values: dict[str, float | None]
    cpu_s: Annotated[float, msgspec.Meta(ge=0)] | None = None
    unknowns: Annotated[int, msgspec.Meta(ge=1)] | None = None
    estimate: dict[str, Annotated[float, msgspec.Meta(ge=0)]] = {}


class Answer(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a code found for a problem.

    Parameters
    ----------
    values : mapping of str to float or None
        By key of the target, SI units; None, or no key, where the code has no value.
    cpu_s : float, optional
        CPU seconds.
    unknowns : int, optional
    memory_mb : float, optional
        Peak memory.
    note : str
        For the reader.
    estimate : mapping of str to float
        The code's own estimate of the errors, or the uncertainty of reading a value from tractions, by key, in the
        scale of the target. It stands beside grades, and is in none.
    ladder : tuple of Rung
        Two meshes or more, from coarse to fine; the values of the answer are those of the last one.
    """

    values: dict[str, float | None]
    cpu_s: Annotated[float, msgspec.Meta(ge=0)] | None = None
    unknowns: Annotated[int, msgspec.Meta(ge=1)] | None = None
    memory_mb: Annotated[float, msgspec.Meta(ge=0)] | None = None
    note: Annotated[str, msgspec.Meta(max_length=1000)] = ""
    estimate: dict[str, Annotated[float, msgspec.Meta(ge=0)]] = {}
    ladder: tuple[Rung, ...] = ()

    def __post_init__(self) -> None:
        _check_text("note", self.note)


def _check_text(name: str, text: str) -> None:
    if isinstance(text, str) and re.search(f"[{NO_TEXT}]", text):
        raise InputError(f"{name} = {ascii(text)[:60]}: must be one line of text without control characters")


class Submission(msgspec.Struct, frozen=True):
    """A code, ``meta``, its ``answers`` by number of the problem, and ``remarks`` on their tables of tractions."""

    meta: Meta
    answers: dict[str, Answer]
    remarks: tuple[str, ...] = ()


def check_apart(submissions: Sequence[Submission]) -> None:
    """Raise InputError if readers could not tell two ``submissions`` apart: code, version, settings, machine and author
    are the same, or the names of two codes look the same, such as a Latin and a Cyrillic a."""
    known: dict[str, str] = {}
    for place, each in enumerate(submissions):
        code = each.meta.code
        if any(_told(each.meta) == _told(other.meta) for other in submissions[:place]):
            same = "with the same version, settings and machine, by the same author"
            raise InputError(f"code {code!r}: answers twice, {same}: must differ")
        other = known.setdefault(seen(code), code)
        if other != code:
            raise InputError(f"code {code!a} looks like {other!a}: names of codes must look different")


def _told(meta: Meta) -> Meta:
    """What readers see of ``meta``."""
    return msgspec.structs.replace(meta, inputs={})


def seen(text: str) -> str:
    """Return ``text`` as a reader sees it: without invisible characters, with single spaces, and with Latin letters for
    those that look like them."""
    plain = unicodedata.normalize("NFKC", text).translate(_LIKE_LATIN)
    return " ".join("".join(each for each in plain if unicodedata.category(each) != "Cf").split())


def add_answer(
    number: str, answer: Answer, folder: str | os.PathLike[str], code: str, named: bool = False, force: bool = False
) -> list[Path]:
    """Add the ``answer`` to the problem ``number`` to the answers of one code in ``folder``. The folder is locked
    meanwhile.

    Parameters
    ----------
    number : str
    answer : Answer
    folder : str or path
        A new folder, or one with meta.toml. In a new one meta.toml is written, of the ``code``.
    code : str
    named : bool
        Whether the user has named the code: the folder must then be of this code.
    force : bool
        Whether to replace another answer to the problem.

    Returns
    -------
    list of Path
        Paths of the files written.

    Raises
    ------
    InputError
        If the folder holds another answer to the problem, the answers of another code, or those of a command of
        partialslip, or cannot be written.
    """
    path, text = Path(folder), json_text(answer)
    with locked(path):
        file, there = path / f"{number}.json", os.path.lexists(path / META)
        known = read_meta(path).code if there else code
        if os.path.lexists(path / REQUEST):
            raise InputError(f"--out {path}: holds what a command of partialslip has written: must be another folder")
        if named and known != code:
            raise InputError(
                f"--code {code!r}: {path} holds answers of {known!r}: must be the same code, or another folder"
            )
        if not force and os.path.lexists(file) and read_bytes(file, LARGEST_FILE) != text.encode():
            raise InputError(f"{file}: is another answer: name another folder, or replace the answer with --force")
        return write_texts(path, ({} if there else {META: _meta_text(Meta(code, ""))}) | {file.name: text})


def write_submission(submission: Submission, folder: str | os.PathLike[str]) -> list[Path]:
    """Write ``submission`` into ``folder``, as :func:`partialslip.verify.benchmark.read_submission` reads it; return
    the paths."""
    answers = {f"{key}.json": json_text(each) for key, each in submission.answers.items()}
    return write_texts(Path(folder), {META: _meta_text(submission.meta)} | answers)


def _meta_text(meta: Meta) -> str:
    """Return ``meta`` as TOML, without empty texts that need not be there."""
    given = msgspec.to_builtins(meta)
    return tomli_w.dumps({key: value for key, value in given.items() if value or key in ("code", "version")})


def read_meta(folder: Path) -> Meta:
    """Read ``meta.toml`` in ``folder``. Raises InputError if it cannot be read, or has fields that are not allowed."""
    return converted(parse_toml(read_text(folder / META, LARGEST_FILE), str(folder / META)), Meta, str(folder / META))
