"""Artificial outcomes of jobs."""

from known import EXACT

from partialslip.report.record import SCHEMA, ComparisonRecord, PlanRecord, Record
from partialslip.result import Cost
from partialslip.result.record import ResultRecord
from partialslip.run.judge import Outcome
from partialslip.study.batch.job import Solved


def cost(cpu_s, **phases):
    return Cost(cpu_s, cpu_s, 100.0, phases)


def method(**changes):
    """Return the record of a result with some fields replaced."""
    fields = {name: getattr(ResultRecord.of(EXACT, curves=False), name) for name in ResultRecord.__struct_fields__}
    return ResultRecord(**fields | changes)


def solved(scene, labels=None, errors=None, process=None, **methods):
    """Return a solved job: ``methods`` gives fields of the records, ``errors`` those of the finite elements."""
    compared = ComparisonRecord(Outcome.NOT_JUDGED, errors or {}, None, None, None, None, {}, (), (), ())
    run = Record(
        schema=SCHEMA, outcome=Outcome.NOT_JUDGED, reference="exact", missed=(), scene=scene,
        plan=PlanRecord((), (), (), {}), methods={name: method(**fields) for name, fields in methods.items()},
        comparison={"fem": compared}, versions={},
    )  # fmt: skip
    return Solved(labels=labels or {}, run=run, process=process)
