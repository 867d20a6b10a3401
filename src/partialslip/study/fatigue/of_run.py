"""Hot spots in the report of a run: the largest stress, and the criteria that the scene asks for."""

from partialslip.report.answer import first_knowing, scale, with_error
from partialslip.report.page import Section
from partialslip.report.rows import whose
from partialslip.result import Result
from partialslip.run import Run
from partialslip.scene import Fatigue
from partialslip.study.fatigue.spots import SIGMA, HotSpot, hot_spots
from partialslip.study.fatigue.tables import unit_of_places
from partialslip.tools.errors import InputError

_TITLE = "Fatigue criteria"
_HEADINGS = ("lower body", "unit", "value", "x/a")


def criteria_sections(run: Run) -> list[Section]:
    """Return the section of hot spots of ``run``: of the answering result, or the first other that holds and knows its
    stresses. Empty without a table ``fatigue`` in the scene, and without such a result."""
    known = first_knowing(run, lambda result: result.stress_at is not None and not result.path_dependent)
    if run.scene.fatigue == Fatigue() or not known:
        return []
    result = known.result
    try:
        found = hot_spots(run.scene, result)
    except InputError as error:
        return [Section(_TITLE, [f"Not known: {error}."])]
    distance = run.scene.fatigue.distance
    averages = f" Averages are over {run.scene.units.length(distance)} from the surface." if distance else ""
    line = f"By {whose(run, result.method)}.{averages} partialslip fatigue has the critical planes and figures."
    exponent, unit = unit_of_places(run.scene, result.a)
    rows = [
        (*_row(run, result, key, spot, found.get(key.partition(".")[0], spot).value), f"{spot.x / 10.0**exponent:.4g}")
        for key, spot in found.items()
    ]
    return [Section(_TITLE, [line], headings=(*_HEADINGS, f"x, {unit}"), rows=rows, words=(1,))]


def _row(run: Run, result: Result, key: str, spot: HotSpot, largest: float) -> tuple[str, ...]:
    """Cells of a hot spot but for its place in a unit of length, in the unit of the ``largest`` of its criterion, which
    stands at the surface."""
    name, _, over = key.partition(".")
    text = f"{name}, largest" if key == SIGMA else f"{name}, {f'averaged, {over}' if over else 'at the surface'}"
    exponent, unit = scale(largest, spot.of, run.scene.units)
    error = float("nan") if spot.error is None else spot.error * spot.value
    return text, unit, with_error(spot.value, error, exponent), f"{spot.x / result.a:.4f}"
