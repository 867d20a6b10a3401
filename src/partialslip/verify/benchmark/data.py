"""The targets as a data set that stands alone: JSON, CSV, JSON Schema, citation, and an RO-Crate that describes them.

RO-Crate 1.1 (https://w3id.org/ro/crate/1.1): one JSON-LD file with the licence, the authors, the sources, the software
that made the data, and type, size and checksum of each file.
"""

import datetime
import hashlib
import inspect
from collections.abc import Iterable, Mapping
from importlib.metadata import metadata
from typing import Any

import msgspec

from partialslip.scene.reading import set_tables
from partialslip.tools.output.files import csv_text, json_text
from partialslip.verify.benchmark.problem import EDITION, SETTINGS, Problem, Source, Target, read_frozen

LICENCE = "https://creativecommons.org/licenses/by/4.0/"
SCHEMA = "problem.schema.json"
_COLUMNS = ("value", "unit", "scale", "uncertainty", "group", "known")
IDLE = ("steps", "sigma_slope")  # display: keys of loads: a setting of partialslip, and zero in all problems
_TITLE = "Targets of the benchmark of frictional contact in partial slip, edition {edition}"
_AUTHORS = "The partialslip developers"
_PROFILE = "https://w3id.org/ro/crate/1.1"
_TYPES = {"json": "application/json", "csv": "text/csv", "cff": "text/yaml", "txt": "text/plain"}
_README = """\
{title}

PS-01.json and so on: a problem with its statement, data, sources and targets, as problem.schema.json describes it.
PS-01.csv: its targets alone. targets.csv: those of all problems. All values are in SI units, per unit depth.

  key          quantity; p@0.5 is p at x = 0.5 a. The statement of the problem says what it is
  x            the place, m
  value, unit  the target
  scale        the size to which an error is relative, in the same unit: a, p0, f p0, 2 f p0, or the value itself
  uncertainty  the largest error that the value may have, in the scale
  group        contact, stick (zone), tractions, levels (shear at a load point), slip, stress
  known        how the value is known, and how far other methods are off, in the scale

Licence: CC-BY-4.0, {licence}
Cite {authors}, partialslip {version}, benchmark edition {edition}, and the sources of the problem. Made {date}.
"""


class PlacedTarget(Target, frozen=True, forbid_unknown_fields=True, kw_only=True, omit_defaults=True):
    """What a code should find: ``value`` in ``unit`` (SI) at the place ``x`` (m) along the contact, if it has one;
    ``scale``, in the same unit, to which errors are relative; ``uncertainty``, the largest error of the value, in the
    scale; how it is ``known``; and its ``group``."""

    x: float | msgspec.UnsetType = msgspec.UNSET


class ProblemData(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A problem of an ``edition`` with its ``checksum``, ``statement``, ``sources``, a ``remark`` on what is hard, its
    ``data`` (SI units, as tables of a scene file of partialslip), and its ``targets`` by key."""

    number: str
    edition: str
    checksum: str
    title: str
    statement: str
    sources: tuple[Source, ...]
    remark: str
    data: dict[str, Any]
    targets: dict[str, PlacedTarget]


def problem_data(problem: Problem) -> ProblemData:
    """All of ``problem`` as plain data."""
    a = problem.targets["a"].value
    targets = {
        key: PlacedTarget(
            x=float(place) * a if place else msgspec.UNSET, **msgspec.structs.asdict(problem.measured[key])
        )
        for key in problem.targets
        for place in [key.partition("@")[2]]
    }
    told = problem.title, problem.statement, problem.sources, problem.why
    checksum = read_frozen().checksums[problem.number]
    return ProblemData(problem.number, EDITION, checksum, *told, _given(set_tables(problem.scene, SETTINGS)), targets)


def targets_csv(problem: Problem) -> str:
    """Targets of ``problem`` as CSV."""
    return csv_text(("key", "x", *_COLUMNS), _rows(problem_data(problem)))


def schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of the file of a problem."""
    found = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(ProblemData)}
    for definition in found["$defs"].values():  # msgspec before 0.23 leaves the indentation of docstrings
        definition["description"] = inspect.cleandoc(definition["description"])
    return found


def data_files(problems: Mapping[str, Problem], made: datetime.date) -> dict[str, bytes]:
    """The data set of ``problems`` by number, ``made`` on a day: contents by file name."""
    all_data = [problem_data(problem) for problem in problems.values()]
    version, title = metadata("partialslip")["Version"], _TITLE.format(edition=EDITION)
    words = {"title": title, "licence": LICENCE, "authors": _AUTHORS, "edition": EDITION, "version": version}
    texts = {
        "README.txt": _README.format(date=made, **words),
        "LICENSE.txt": f"{title}, by {_AUTHORS}, is licensed under CC-BY-4.0: {LICENCE}legalcode\n",
        "CITATION.cff": _citation(title, made),
        SCHEMA: json_text(schema()),
        "targets.csv": csv_text(
            ("problem", "key", "x", *_COLUMNS), ([data.number, *row] for data in all_data for row in _rows(data))
        ),
    }
    for data in all_data:
        texts[f"{data.number}.json"] = json_text(data)
        texts[f"{data.number}.csv"] = targets_csv(problems[data.number])
    files = {name: text.encode() for name, text in texts.items()}
    crate = _crate(title, version, made, files, problems)
    return files | {"ro-crate-metadata.json": json_text(crate).encode()}


def _rows(data: ProblemData) -> list[list[object]]:
    return [
        [key, None if target.x is msgspec.UNSET else target.x, *(getattr(target, name) for name in _COLUMNS)]
        for key, target in data.targets.items()
    ]


def _given(tables: dict[str, Any]) -> dict[str, Any]:
    """``tables`` of a scene without the load keys that are not part of the problem (``IDLE``)."""
    load = {key: value for key, value in tables["load"].items() if key not in IDLE}
    return tables | {"load": load}


def _sources(problems: Mapping[str, Problem]) -> list[Source]:
    return list(dict.fromkeys(source for problem in problems.values() for source in problem.sources))


def links() -> dict[str, str]:
    """Addresses of the project by name, from its metadata; none before it is published."""
    given = metadata("partialslip").get_all("Project-URL") or []
    return {name: address for name, _, address in (each.partition(", ") for each in given)}


def _citation(title: str, made: datetime.date) -> str:
    """The data set's CITATION.cff."""
    lines = [
        "cff-version: 1.2.0",
        "message: Cite these data, and the sources of the problem.",
        "type: dataset",
        f'title: "{title}"',
        f'version: "{EDITION}"',
        f"date-released: {made}",
        "license: CC-BY-4.0",
        *(f'{key}: "{links()[name]}"' for key, name in (("doi", "DOI"), ("url", "Homepage")) if name in links()),
        "authors:",
        f"  - name: {_AUTHORS}",
    ]
    return "\n".join(lines) + "\n"


def _crate(
    title: str, version: str, made: datetime.date, files: Mapping[str, bytes], problems: Mapping[str, Problem]
) -> dict[str, Any]:
    """The RO-Crate's metadata as JSON-LD."""
    cited = [
        {"@id": f"https://doi.org/{source.doi}" if source.doi else f"#source-{place}", "@type": "ScholarlyArticle",
         "name": " ".join(source.text.split())}
        for place, source in enumerate(_sources(problems), start=1)
    ]  # fmt: skip
    authors = {"@id": "#authors", "@type": "Organization", "name": _AUTHORS}
    software = {"@id": "#partialslip", "@type": "SoftwareApplication", "name": "partialslip", "version": version}
    listed = [
        {"@id": name, "@type": "File", "name": problems[number].title if number in problems else name,
         "encodingFormat": _TYPES[name.rpartition(".")[2]], "contentSize": str(len(content)),
         "sha256": hashlib.sha256(content).hexdigest(),
         **({"conformsTo": {"@id": SCHEMA}} if number in problems and name.endswith(".json") else {})}
        for name, content in files.items()
        for number in [name.rpartition(".")[0]]
    ]  # fmt: skip
    root = {
        "@id": "./", "@type": "Dataset", "name": title, "version": EDITION, "datePublished": str(made),
        "description": "Numbered problems of frictional contact with frozen targets, their units and uncertainties.",
        "license": {"@id": LICENCE}, "author": _references([authors]), "citation": _references(cited),
        "hasPart": _references(listed), "keywords": metadata("partialslip")["Keywords"],
        **{key: links()[name] for key, name in (("identifier", "DOI"), ("url", "Homepage")) if name in links()},
    }  # fmt: skip
    action = {"@id": "#made", "@type": "CreateAction", "name": "partialslip benchmark data", "endTime": str(made),
              "instrument": _references([software]), "result": _references([root])}  # fmt: skip
    descriptor = {"@id": "ro-crate-metadata.json", "@type": "CreativeWork", "about": {"@id": "./"},
                  "conformsTo": {"@id": _PROFILE}}  # fmt: skip
    licence = {"@id": LICENCE, "@type": "CreativeWork", "name": "CC-BY-4.0", "identifier": LICENCE}
    graph = [descriptor, root, *listed, licence, authors, software, action, *cited]
    return {"@context": f"{_PROFILE}/context", "@graph": graph}


def _references(entities: Iterable[Mapping[str, Any]]) -> list[dict[str, str]]:
    return [{"@id": entity["@id"]} for entity in entities]
