"""A run as plain data: the content of ``results.json``. The types here define the schema of the file."""

from pathlib import Path
from typing import Any

import msgspec

from partialslip.errors import InputError
from partialslip.inputfile import read_bytes
from partialslip.judge import Comparison, Outcome, Verdict
from partialslip.origin import Made, versions
from partialslip.output.json import json_text
from partialslip.plan import Effect, Plan
from partialslip.result.record import Number, ResultRecord, number
from partialslip.run import Run
from partialslip.scene import Scene

SCHEMA = "partialslip/result/3"
_LARGEST = 500_000_000  # bytes of a results.json to read


class PlanRecord(msgspec.Struct, frozen=True):
    """Record of a plan.

    Parameters
    ----------
    called_for, left_out : tuple of str
        Effects that the scene calls for, and effects left out.
    missing : tuple of str
        Effects called for but forced off.
    reasons : dict of str to str
        Reason by effect.
    """

    called_for: tuple[Effect, ...]
    left_out: tuple[Effect, ...]
    missing: tuple[Effect, ...]
    reasons: dict[Effect, str]

    @classmethod
    def of(cls, plan: Plan) -> "PlanRecord":
        """Make the record of ``plan``."""
        return cls(
            called_for=tuple(plan.called_for),
            left_out=tuple(plan.left_out),
            missing=tuple(plan.missing),
            reasons={**plan.called_for, **plan.left_out},
        )


class ComparisonRecord(msgspec.Struct, frozen=True):
    """A :class:`partialslip.Comparison` as plain data.

    ``outcome`` is the verdict on the whole, ``missed`` lists in words what is missed. ``errors`` and ``bars`` are by
    quantity and belong to ``verdicts``; ``conditions`` are verdicts that need no reference: finite numbers and small
    residuals. ``p_nodal``, ``q_nodal``, ``p_nodal_max`` and ``q_nodal_max`` are as in :class:`partialslip.Comparison`.
    """

    outcome: Outcome
    errors: dict[str, Number]
    p_nodal: Number
    q_nodal: Number
    p_nodal_max: Number
    q_nodal_max: Number
    bars: dict[str, Number]
    missed: tuple[str, ...]
    verdicts: tuple[Verdict, ...]
    conditions: tuple[Verdict, ...]

    @classmethod
    def of(cls, comparison: Comparison) -> "ComparisonRecord":
        """Make the record of ``comparison``."""
        return cls(
            outcome=comparison.outcome,
            errors={key: number(error) for key, error in comparison.errors.items()},
            p_nodal=number(comparison.p_nodal),
            q_nodal=number(comparison.q_nodal),
            p_nodal_max=number(comparison.p_nodal_max),
            q_nodal_max=number(comparison.q_nodal_max),
            bars={key: number(bar) for key, bar in comparison.bars.items()},
            missed=comparison.missed,
            verdicts=tuple(verdict.finite for verdict in comparison.verdicts),
            conditions=tuple(verdict.finite for verdict in comparison.conditions),
        )


class Record(msgspec.Struct, frozen=True):
    """Content of ``results.json``, in SI units.

    Parameters
    ----------
    schema : str
        Name and version of the schema.
    outcome : Outcome
        Verdict on the whole run.
    reference : str or None
        Name of the reference method.
    missed : tuple of str
        Missed verdicts as text.
    scene : Scene
    plan : PlanRecord
    methods : dict of str to ResultRecord
        Results by method.
    comparison : dict of str to ComparisonRecord
        Comparisons with the reference by method.
    versions : dict of str to str
        Versions of Python and of the packages that compute the results.
    made : Made or None
        Date, command, overrides, commit and machine; None in ledgers, whose entries have their own.
    """

    schema: str
    outcome: Outcome
    reference: str | None
    missed: tuple[str, ...]
    scene: Scene
    plan: PlanRecord
    methods: dict[str, ResultRecord]
    comparison: dict[str, ComparisonRecord]
    versions: dict[str, str]
    made: Made | None = None

    def __repr__(self) -> str:
        return f"Record of {self.scene.name}: {self.outcome}; {', '.join(self.methods)}"

    @property
    def json(self) -> str:
        """The record as JSON."""
        return json_text(self)


def record(run: Run, *, curves: bool = True, made: Made | None = None) -> Record:
    """Make the record of ``run``.

    Parameters
    ----------
    run : Run
    curves : bool
        Whether to include tractions, slip and stresses along the surfaces.
    made : Made, optional
        Origin of the run (:func:`partialslip.origin.made_now`).
    """
    return Record(
        schema=SCHEMA,
        outcome=run.outcome,
        reference=run.reference,
        missed=run.missed,
        scene=run.scene,
        plan=PlanRecord.of(run.plan),
        methods={name: ResultRecord.of(result, curves) for name, result in run.results.items()},
        comparison={name: ComparisonRecord.of(comparison) for name, comparison in run.comparisons.items()},
        versions=versions(),
        made=made,
    )


def load_result(path: str | Path) -> Record:
    """Read a ``results.json`` from ``path``.

    Raises
    ------
    InputError
        If the file cannot be read, or has another schema than this version writes.
    """
    text = read_bytes(path, _LARGEST)
    try:
        found = msgspec.json.decode(text, type=_Schema).schema
        if found != SCHEMA:
            raise InputError(f"{path}: schema {found!r}: must be {SCHEMA!r}; run the scene again")
        return msgspec.json.decode(text, type=Record)
    except (msgspec.DecodeError, msgspec.ValidationError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(f"{path}: must be a results.json that partialslip has written: {error}") from None


class _Schema(msgspec.Struct):
    schema: str = ""


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of ``results.json``."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Record)}
