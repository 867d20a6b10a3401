"""A run as plain data: the content of ``results.json``. The types here define the schema of the file.

A file is sealed (:mod:`partialslip.tools.seal`), and its outcomes are concluded anew from its numbers when it is read.
"""

import inspect
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec
from msgspec.structs import replace

from partialslip.halfplane.noise import Noise
from partialslip.result.record import JsonNumber, ResultRecord, plain, record_of
from partialslip.run import Run
from partialslip.run.judge import Outcome, Verdict, conclude, conditions, of_run
from partialslip.run.judge.comparison import judged_again
from partialslip.run.judge.reference import reference_among
from partialslip.run.judge.verdicts import missed_by
from partialslip.run.tolerance import Propagation
from partialslip.scene import Scene
from partialslip.scene.plan import Effect, Plan
from partialslip.tools.origin import Made, versions
from partialslip.tools.seal import KEY, read_sealed, sealed_text
from partialslip.tools.shown import ByMethod

SCHEMA = "partialslip/result/3"
_LARGEST = 500_000_000  # limit: bytes of a results.json to read


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
    errors: dict[str, JsonNumber]
    p_nodal: JsonNumber
    q_nodal: JsonNumber
    p_nodal_max: JsonNumber
    q_nodal_max: JsonNumber
    bars: dict[str, JsonNumber]
    missed: tuple[str, ...]
    verdicts: tuple[Verdict, ...]
    conditions: tuple[Verdict, ...]

    def judged_again(
        self, result: ResultRecord, reference: ResultRecord, conditions: tuple[Verdict, ...]
    ) -> "ComparisonRecord":
        """The record with outcomes concluded anew, for a ``result``, its ``reference`` and its ``conditions``."""
        verdicts = tuple(judged_again(verdict, result, reference) for verdict in self.verdicts)
        whole = conclude(verdicts, conditions)
        return replace(
            self,
            outcome=whole.outcome,
            errors={verdict.quantity: verdict.error for verdict in verdicts if verdict.quantity != "regime"},
            bars={verdict.quantity: verdict.bar for verdict in verdicts if verdict.bar is not None},
            missed=whole.missed,
            verdicts=verdicts,
            conditions=conditions,
        )


class Record(ByMethod[ResultRecord], msgspec.Struct, frozen=True):
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
    noise : Noise or None
        Scatter due to the noise of a measured profile; None in ledgers.
    spacing : dict of str to float
        Errors due to the spacing of a tabulated profile.
    tolerance : Propagation
        What the tolerances of the scene allow; left out without tolerances.
    edited : bool or None
        Whether the file that the record was read from was changed since partialslip wrote it; None if the file has no
        checksum.
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
    noise: Noise | None = None
    spacing: dict[str, float] = {}
    tolerance: Propagation | msgspec.UnsetType = msgspec.UNSET
    edited: bool | None = False

    def __repr__(self) -> str:
        said = {True: ", edited since it was written", False: "", None: ", without a checksum"}[self.edited]
        return f"Record of {self.scene.name}{said}: {self.outcome}; {', '.join(self.methods)}"

    @property
    def _by_method(self) -> Mapping[str, ResultRecord]:
        return self.methods

    @property
    def json(self) -> str:
        """The record as JSON, with a checksum as its last key, ``sum``."""
        return sealed_text(self)

    @property
    def judged_again(self) -> "Record":
        """Record with outcomes and missed quantities derived again from its numbers.

        A comparison whose reference is not the reference method of the scene makes no run pass.
        """
        told = {name: each.conditions for name, each in self.comparison.items()}
        known = {name: plain(conditions(each, told.get(name, ()))) for name, each in self.methods.items()}
        reference = self.methods.get(self.reference or "")
        comparison = {
            name: each.judged_again(self.methods[name], reference, known[name])
            for name, each in self.comparison.items()
            if reference and name in self.methods
        }
        missed = missed_by(
            {name: (*(comparison[name].verdicts if name in comparison else ()), *known[name]) for name in known}
        )
        conclusions = {name: conclude(each.verdicts, each.conditions) for name, each in comparison.items()}
        sound = self.reference == reference_among(self.scene, self.methods)
        hold = {name: sound and not each.path_dependent for name, each in self.methods.items()}
        whole = of_run(conclusions, missed, hold)
        return replace(self, outcome=whole.outcome, missed=whole.missed, comparison=comparison)


def record(run: Run, *, curves: bool = True, made: Made | None = None) -> Record:
    """Make the record of ``run``.

    Parameters
    ----------
    run : Run
    curves : bool
        Whether to include tractions, slip and stresses along the surfaces, and the scatter due to noise.
    made : Made, optional
        Origin of the run (:func:`partialslip.tools.origin.made_now`).
    """
    return record_of(
        Record,
        run,
        schema=SCHEMA,
        plan=PlanRecord.of(run.plan),
        methods={name: ResultRecord.of(result, curves) for name, result in run.results.items()},
        comparison={name: record_of(ComparisonRecord, comparison) for name, comparison in run.comparisons.items()},
        versions=versions(),
        made=made,
        noise=run.noise if curves else None,
        tolerance=run.tolerance or msgspec.UNSET,
        edited=False,
    )


def load_result(path: str | Path) -> Record:
    """Read a ``results.json`` from ``path``.

    Outcomes are concluded anew from the numbers of the file. If the file was edited since partialslip wrote it, a
    warning says so, and :attr:`Record.edited` is True.

    Raises
    ------
    InputError
        If the file cannot be read, is no strict JSON, or has another schema than this version writes.
    """
    what, again = "must be a results.json that partialslip has written", "run the scene again"
    kept, changed = read_sealed(path, _LARGEST, Record, SCHEMA, what, again)
    if changed or kept.edited:
        warnings.warn(f"{path}: edited since partialslip wrote it", stacklevel=2)
    return replace(kept, edited=True if kept.edited else changed).judged_again


def schema() -> dict[str, Any]:
    """Return the JSON Schema (draft 2020-12) of ``results.json``."""
    found = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(Record)}
    seal = {"type": "string", "description": "Checksum of all other keys; see partialslip.tools.seal."}
    found["$defs"]["Record"]["properties"][KEY] = seal
    for definition in found["$defs"].values():  # msgspec before 0.23 leaves the indentation of docstrings
        if "description" in definition:
            definition["description"] = inspect.cleandoc(definition["description"])
    return found
