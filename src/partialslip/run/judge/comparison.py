"""Comparison of a result with a reference: one verdict per quantity.

What a file says of outcomes is not believed: verdicts are found anew from its numbers.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from partialslip.result import Result
from partialslip.result.record import ResultRecord
from partialslip.run.judge.measures import measures, nodal_errors, pair_of
from partialslip.run.judge.reference import reference as reference_of
from partialslip.run.judge.verdicts import (
    NAN,
    READ,
    Bar,
    Conclusion,
    Outcome,
    Verdict,
    conclude,
    conditions,
    decide,
    judge_regime,
    judged,
    plus_estimate,
    read_to,
)
from partialslip.scene.reading import AnyScene, as_scene
from partialslip.tools.bars import Accuracy, asked
from partialslip.tools.shown import Notebook

# limit: Difference, in a, of an error from that of the lengths of the file. Below it the error of the file counts:
# errors of tiny stick zones are computed without cancellation.
_ROUNDING = 1e-9


@dataclass(frozen=True, repr=False)
class Comparison(Notebook):
    """Verdicts on a result against a reference.

    Parameters
    ----------
    verdicts : tuple of Verdict
        One per quantity, listed below.
    conditions : tuple of Verdict
        Checks of the result alone: finite numbers, small residuals.
    p_nodal, q_nodal : float or None
        Relative L2 errors of nodal p and of nodal q; None for p if no node lies within the reference's contact, for q
        without shear.
    p_nodal_max, q_nodal_max : float or None
        Largest errors of a node, in p0 and f p0; None for q without shear.

    Notes
    -----
    Quantities of ``verdicts`` and their errors:

    - ``a``, ``left``, ``right``, ``m``, ``n``: absolute difference as a fraction of a; ``left_1`` to ``right_2`` where
      the ends of the contact differ between the load points.
    - ``P``, ``P_1``: int p dx / P - 1, at load points 2 and 1; ``dQ``: (int dq dx - dQ)/(2 f P).
    - ``p``, ``p_1``: relative L2 over the contact of cell averages, at load points 2 and 1. Each cell's mean is
      compared with the reference's mean over the same cell.
    - ``q``, ``q1``, ``q2``: the same with q = (q2 - q1)/2, relative to the larger of q's norm and 1e-3 of f p's norm.
    - ``p_max``, ``q_max``: difference of the largest values, in p0 and f p0. ``p_least``: tension in a table, in p0.
    - ``surface``: relative L2 of sigma_xx along both surfaces, by cell averages. ``largest``: relative error of the
      largest sigma_xx on the lower body. ``inside``: relative L2, by area, of the stresses within 3 a, at 3600
      points. All three only if stresses were asked for and both results have them.
    - ``regime``: the name.

    - ``M``, ``M_1``: int x p dx about x = 0, in P a, at load points 2 and 1, where the pressure is not even.

    ``P_1``, ``M_1`` and ``p_1`` are present only where the pressure differs between the load points.
    """

    verdicts: tuple[Verdict, ...]
    conditions: tuple[Verdict, ...]
    p_nodal: float | None
    q_nodal: float | None
    p_nodal_max: float
    q_nodal_max: float | None

    def __repr__(self) -> str:
        """Outcome and main errors, in a line."""
        lengths, norms = (
            ", ".join(f"{key} {error:.1e}" for key in keys if (error := self.errors.get(key)) is not None)
            for keys in (("a", "m", "n"), ("p", "q"))
        )
        return f"Comparison: {self.conclusion.text}; errors in a: {lengths}; relative L2: {norms}"

    @property
    def conclusion(self) -> Conclusion:
        """What the verdicts amount to (:func:`partialslip.run.judge.conclude`)."""
        return conclude(self.verdicts, self.conditions)

    @property
    def outcome(self) -> Outcome:
        """Passed, missed or not judged, as a whole."""
        return self.conclusion.outcome

    @property
    def passed(self) -> bool:
        """Whether every headline quantity was judged and nothing is missed."""
        return self.outcome is Outcome.PASSED

    @property
    def missed(self) -> tuple[str, ...]:
        """Missed verdicts as text."""
        return self.conclusion.missed

    @property
    def unjudged(self) -> tuple[str, ...]:
        """Headline quantities that were not judged."""
        return self.conclusion.unjudged

    @property
    def errors(self) -> dict[str, float | None]:
        """Errors by quantity; None if the result or the reference has no value."""
        return {verdict.quantity: verdict.error for verdict in self.verdicts if verdict.quantity != "regime"}

    @property
    def bars(self) -> dict[str, float]:
        """Bars by quantity; quantities without a bar are absent."""
        return {verdict.quantity: verdict.bar for verdict in self.verdicts if verdict.bar is not None}

    @property
    def a(self) -> float | None:
        """Error of a, as a fraction of a."""
        return self.errors["a"]

    @property
    def m(self) -> float | None:
        """Error of m, as a fraction of a."""
        return self.errors["m"]

    @property
    def n(self) -> float | None:
        """Error of n, as a fraction of a."""
        return self.errors["n"]

    @property
    def p(self) -> float | None:
        """Relative L2 error of the cell averages of p."""
        return self.errors["p"]

    @property
    def q(self) -> float | None:
        """Relative L2 error of the cell averages of q = (q2 - q1)/2."""
        return self.errors["q"]


def compare(
    result: Result,
    reference: Result,
    scene: AnyScene,
    accuracy: Accuracy | None,
    bars: Mapping[str, Bar] | None = None,
    *,
    stresses: bool = True,
) -> Comparison:
    """Compare ``result`` with ``reference`` and judge it.

    Parameters
    ----------
    result, reference : Result
        Results for the same ``scene``.
    scene : Scene, str or path
        The loads and the coefficient of friction scale the resultants and the errors of q.
    accuracy : float, (float, float, float) or None
        Bar for a, m, n and the ends of the contact, as a fraction of a. The bar for p and P is 10 times ``accuracy``,
        for q, q1, q2 and dQ 15 times, none above 0.1. Three numbers are the bars for contact, stick zone and tractions.
        With None only the quantities in ``bars`` have a bar.
    bars : mapping of str to Bar, optional
        Bars by quantity that replace the usual ones.
    stresses : bool
        Whether to compare the stresses that both results have.

    Raises
    ------
    InputError
        If a number of ``accuracy`` is not above 0 and at most 0.1.

    Notes
    -----
    The reference's own error estimate is added to each bar. If the estimate exceeds the bar, the quantity is not
    judged.
    """
    own, scene = bars or {}, as_scene(scene)
    wanted = asked(accuracy)
    usual = {key: Bar(bar) for key, bar in wanted.bars.items()} if wanted else {}
    if wanted and scene.friction.f == 0 and wanted.tractions is None:  # q = 0 has no ends whose errors it multiplies
        usual |= dict.fromkeys(("q", "q1", "q2"), Bar(wanted.contact))
    applied = {key: plus_estimate(bar, key, reference) for key, bar in {**usual, **own}.items()}
    unknown = reference_of(scene).unknown
    pair = pair_of(result, reference)
    every = measures(result, reference, scene, unknown, stresses=stresses, pair=pair)
    verdicts = [decide(each, applied.get(each.quantity), result) for each in every]
    nodal = nodal_errors(result, reference, pair, scene.friction.f)
    untold = result.undetermined if READ in result.settings else {}  # a table without ends does not tell the regime
    regime = judge_regime(result, reference, scene, applied, {**unknown, **untold})
    return Comparison((*verdicts, regime), conditions(result), *nodal)


def judged_again(verdict: Verdict, result: ResultRecord, reference: ResultRecord) -> Verdict:
    """Return the ``verdict`` on a ``result`` with values, error and outcome found anew.

    Errors of lengths and the regimes follow from both results. Norms and sums are integrals of tractions over cells,
    which a file does not have: their errors are those of the file, and only their outcome is found anew.
    """
    key = verdict.quantity
    if key == "regime":
        return _regime(replace(verdict, reference=reference.regime, found=result.regime))
    own, true = (_length(key, each) for each in (result, reference))
    a = reference.a
    if a and own is not None and true is not None and verdict.error is not None:
        error = abs(own - true) / a
        if abs(error - verdict.error) > _ROUNDING * max(1.0, error):
            verdict = replace(verdict, reference=true / a, found=own / a, error=error)
    return replace(verdict, outcome=_outcome(verdict, read_to(key, result)))


def _outcome(verdict: Verdict, unsure: float) -> Outcome:
    """Return the outcome that follows from error and bar, as :func:`partialslip.run.judge.verdicts.decide` finds it."""
    if verdict.error is None:
        lost = verdict.reason == NAN or (verdict.reference is not None and verdict.bar is not None)
        return Outcome.MISSED if lost else Outcome.NOT_JUDGED
    return Outcome.NOT_JUDGED if verdict.bar is None else judged(verdict.error, verdict.bar, unsure)


def _regime(verdict: Verdict) -> Verdict:
    """Return the verdict on the regime. The reason why two regimes cannot be told apart, such as a zone that is too
    narrow, is taken from the file."""
    same, other = verdict.found == verdict.reference, f"{verdict.found}, not {verdict.reference}"
    if verdict.outcome is Outcome.NOT_JUDGED and verdict.reason not in ("", other):
        return verdict
    outcome, reason = (Outcome.PASSED, "") if same else (Outcome.MISSED, other)
    return replace(verdict, outcome=outcome, reason=reason)


def _length(key: str, result: ResultRecord) -> float | None:
    """Return a, m, n or an end of the contact, m; None if the ``key`` is none of them, or has no value."""
    side, _, point = key.partition("_")
    if side in ("left", "right"):
        return result.contact_ends[0 if point == "1" else 1][side == "right"]
    return getattr(result, key) if key in ("a", "m", "n") else None
