"""Method ``equivalent``: bodies of a size as half-planes with other data (docs/theory.md, section 12)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from partialslip.halfplane.contact import contact, tilted_contact
from partialslip.halfplane.layer import Layer
from partialslip.halfplane.method import has_closed_form
from partialslip.halfplane.method import solve as solve_exactly
from partialslip.march.equivalent.data import HalfPlaneData, data_of, moments_of
from partialslip.march.equivalent.estimate import estimate
from partialslip.march.equivalent.stresses import stress_errors, with_stresses
from partialslip.march.equivalent.words import in_words
from partialslip.march.method import solve as solve_by_marching
from partialslip.result import Clock, Result
from partialslip.result.rig import Rig
from partialslip.result.state import State
from partialslip.scene import Bodies, Scene
from partialslip.scene.plan import Plan
from partialslip.scene.plan import plan as plan_of
from partialslip.tools.arrays import Array
from partialslip.tools.errors import InputError

_KEYS = ("a", "left", "right", "m", "n", "p", "q")
_PRESSED = "bodies that are not mirror images lock shear in when they are pressed, which is not followed; use fem"
_SETTLED, _MOST = 1e-12, 40  # accuracy: relative change of the data in an iteration; iterations
_MIXED = 6  # cost: latest iterations that the next one is made of
_SETTLED_MARCH = 1e-3  # accuracy: of the accuracy asked for, where each iteration is a march


class StandIns(NamedTuple):
    """Half-planes that stand for bodies of a size: their ``scene``, its ``result`` and the ``data``."""

    result: Result
    scene: Scene
    data: HalfPlaneData


def solve(
    scene: Scene,
    plan: Plan,
    progress: Callable[[str], None] = lambda _: None,
    start: State | None = None,
    *,
    rig_of: Callable[[Scene], Rig],
) -> Result:
    """Solve ``scene`` as half-planes with the data that make them act like its bodies.

    The data depend on the tractions: they are found by iteration. Steady states with a closed form are solved exactly
    if slip does not reverse; other loads by marching, with what the bodies add to the shear displacements in full.

    Parameters
    ----------
    scene : Scene
    plan : Plan
        Effects that the scene calls for; of these only subsurface decides something: whether to find stresses.
    progress : callable, optional
        Called with a line of text from time to time.
    start : State, optional
        Not supported.
    rig_of : callable
        Gives the rig of a scene.

    Raises
    ------
    InputError
        If no body is finite, the materials differ, P varies, a state is given, or the contact extends beyond the range
        in which the rig holds.
    """
    if start:
        raise InputError("start: must not be given for equivalent; use fem")
    scene, clock = _checked(scene), Clock()
    with clock.phase("rig"):
        progress("characterising the bodies")
        rig = _called_for(rig_of(scene), scene)
    with clock.phase("half-planes"):
        found, seen, data = _found(rig, scene, progress)
    closed = found.method == "exact"
    coarser = half_planes(scene, data_of(rig.coarser, scene, moments_of(rig, scene, found), found, shear=closed))
    shares = dict(found.shares) | estimate(rig, scene, seen, data, coarser, shear=closed)
    if (layer := Layer.of(scene)) and (by_width := layer.left_out(found.a)):
        shares["width"] = by_width
    errors = {key: sum(share.get(key, 0.0) for share in shares.values()) for key in _KEYS}
    undetermined, notes = dict(found.undetermined), found.notes
    if rig.terms.xy.any() and found.stick_centre is not None:  # not mirror images
        undetermined |= dict.fromkeys(("q1", "q2"), _PRESSED)
        notes = (*(note for note in notes if not note.startswith("q1 and q2")), f"q1 and q2: {_PRESSED}")
    stressed = None
    if plan.needs("subsurface"):
        with clock.phase("stresses"):
            stressed = _with_stresses(scene, rig, seen, closed, progress)
    if stressed:
        known = max(stressed.estimate.get(key, 0.0) for key in ("q", "q1", "q2"))
        found_off = stress_errors(scene, rig, stressed, errors["q"] + known)
        shares = shares | {key: {**shares.get(key, {}), "sigma_xx": error} for key, error in found_off.items()}
        errors["sigma_xx"] = sum(found_off.values())
    levels = {key: scale * errors["q"] for key, scale in _levels(found).items() if key not in undetermined}
    return replace(
        found,
        method="equivalent",
        cost=clock.cost(),
        settings={"model": "half-planes with the data of the bodies", "solved by": found.method},
        estimate=errors | levels,
        shares=shares,
        notes=(*([rig.note] if rig.note else []), in_words(scene, seen, data), *notes),
        undetermined=undetermined,
        surface=stressed.surface if stressed else None,
        stress_at=stressed.stress_at if stressed else None,
        state=None,
    )


def _levels(found: Result) -> dict[str, float]:
    """Norms of dq/2 over those of q1 and q2, at least 1: what errors of dq amount to in q1 and q2, where mean loads
    take most of dq/2 away; empty without q1 and q2."""
    of, x = found.traction.values, found.traction.x

    def norm(q: Array) -> float:
        return float(np.sqrt(np.trapezoid(q**2, x)))

    half = norm(of.dq) / 2
    return {
        key: max(half / (norm(q) or half or 1.0), 1.0) for key, q in zip(("q1", "q2"), of.levels or (), strict=False)
    }


def _with_stresses(scene: Scene, rig: Rig, seen: Scene, closed: bool, progress: Callable[[str], None]) -> Result | None:
    """Result of the half-planes ``seen`` with the stresses of the bodies: by marching where there is no closed form of
    q1 and q2; None where the contact slides, and these are not known."""
    plan = plan_of(seen, subsurface=True)
    found = solve_exactly(seen, plan) if closed else solve_by_marching(seen, plan, added=partial(_added, rig))
    if closed and not found.stress_at and not seen.slides:
        progress("march for the stresses")
        found = solve_by_marching(seen, plan)
    return with_stresses(scene, rig, seen, found) if found.stress_at else None


def stand_ins(scene: Scene, rig: Rig, progress: Callable[[str], None] = lambda _: None) -> StandIns:
    """Half-planes that act like the bodies of a scene.

    Parameters
    ----------
    scene : Scene
    rig : Rig
        The rig of the scene's bodies.
    progress : callable, optional
        Called with a line of text from time to time.

    Raises
    ------
    InputError
        As :func:`solve`.
    """
    scene = _checked(scene)
    return _found(_called_for(rig, scene), scene, progress)


def _found(rig: Rig, scene: Scene, progress: Callable[[str], None]) -> StandIns:
    """Half-planes that act like the bodies of a ``scene`` that is checked, with the ``rig`` that it calls for."""
    closed = scene.load.in_phase and has_closed_form(half_planes(scene, None))
    return _iterated(rig, scene, closed, progress)


def _called_for(rig: Rig, scene: Scene) -> Rig:
    """``rig``, without coupling if ``scene`` forces it off."""
    return rig.uncoupled if scene.effects.coupling is False else rig


def half_planes(scene: Scene, data: HalfPlaneData | None) -> Scene:
    """The scene of half-planes with the ``data`` that act like the bodies of ``scene``; without data, of half-planes
    that act like no size at all."""
    own = {"moment": None, "varying-pressure": None, "coupling": None}  # of half-planes: their tilt is that of bodies
    plain = scene.replace(bodies=Bodies(), load={"P": scene.P, "a": None, "p0": None}, effects=own)
    if data is None:
        return plain
    plain = plain.replace(profile=scene.profile.curved(float(data.curvature.mean())))
    M = np.array([tilted_contact(plain, scene.P, -float(tilt)).moment for tilt in data.tilt])
    load = {
        "Q": [Q for Q, *_ in scene.load.points],
        "sigma": data.sigma.tolist(),
        "sigma_slope": data.sigma_slope.tolist(),
        "M": M.tolist() if M.any() else None,
    }
    return plain.replace(load=load)


def _checked(scene: Scene) -> Scene:
    """The ``scene``, with what a grip on the right carries of Q as tension; InputError if half-planes cannot stand for
    its bodies."""
    if not scene.finite:
        raise InputError("bodies: must have upper or lower for equivalent; half-planes are solved by exact")
    if not scene.material.alike:
        raise InputError("material.upper, material.lower: the bodies differ; must be of one material for equivalent")
    scene.bodies.require_no_pin("for equivalent, whose bodies do not turn; use fem")
    if len({P for P, _ in scene.pressing}) > 1:
        raise InputError("load.P: must be constant for equivalent, as the bodies bend with P; use fem")
    scene.load.require_forces(scene.units)
    return scene.left_gripped


def _iterated(rig: Rig, scene: Scene, closed: bool, progress: Callable[[str], None]) -> StandIns:
    """Data, and what half-planes with these data do, that belong to each other."""
    seen = half_planes(scene, None)
    found = solve_exactly(seen, plan_of(seen)) if closed else _pressed(seen)
    settled = _SETTLED
    given: list[Array] = []  # data of the half-planes, and the data that their tractions call for
    called: list[Array] = []
    for number in range(1, _MOST + 1):
        data = data_of(rig, scene, moments_of(rig, scene, found), found, shear=closed)
        called.append(data.scaled(scene))
        if given and np.abs(called[-1] - given[-1]).max() <= settled:
            return StandIns(found, seen, data)
        given = given or [0 * called[0]]
        given.append(_mixed(given, called))
        data = data.moved(given[-1], scene)
        seen = _in_range(rig, scene, data)
        if closed and not has_closed_form(seen):
            return _iterated(rig, scene, False, progress)
        if closed:
            found = solve_exactly(seen, plan_of(seen))
            if found.path_dependent:  # the closed form is not the result of gradual loading
                return _iterated(rig, scene, False, progress)
        else:
            progress(f"march {number}")
            found = solve_by_marching(seen, plan_of(seen), added=partial(_added, rig))
            settled = _SETTLED_MARCH * scene.fem.accuracy
    raise InputError("bodies: must be larger compared with the contact: equivalent does not settle; use fem")


def _mixed(given: Sequence[Array], called: Sequence[Array]) -> Array:
    """Data to go on with, by Anderson's method: a contact that turns the bodies back by more than they have turned has
    data, too, which plain iteration does not reach."""
    had, got = (np.array(each[-_MIXED:]).reshape(min(len(each), _MIXED), -1) for each in (given, called))
    left = got - had
    weights = np.linalg.lstsq((left[:-1] - left[-1]).T, -left[-1], rcond=1e-10)[0]
    return (got[-1] + weights @ (got[:-1] - got[-1])).reshape(called[-1].shape)


def _pressed(scene: Scene) -> Result:
    """``scene`` without shear."""
    still = scene.replace(load={"Q": [0.0, 0.0], "sigma": [0.0, 0.0]})
    return solve_exactly(still, plan_of(still))


def _in_range(rig: Rig, scene: Scene, data: HalfPlaneData) -> Scene:
    """Half-planes with the ``data``. Raise InputError if there are none, or if their contact is too large for the rig,
    whose polynomials mean nothing out there."""
    too_small = "bodies: must be larger compared with the contact"
    try:
        seen = half_planes(scene, data)
        ends = [end for pressed in set(seen.pressing) for end in contact(seen, pressed).ends]
    except InputError:  # its field is one of the half-planes, which the user has not written
        raise InputError(f"{too_small}: no half-planes act like them; use fem") from None
    if (farthest := max(map(abs, ends))) > rig.reach:
        shown = scene.units.labelled
        raise InputError(
            f"{too_small}, which reaches x = {shown(farthest, 'm')}: "
            f"equivalent holds up to {shown(rig.reach, 'm')}; use fem"
        )
    return seen


def _added(rig: Rig, places: Array) -> Array:
    """Mean displacements along x of cells with ends at ``places`` (c + 1,), m, under unit forces on cells, in A."""
    # integrals of the powers over the cells: Gauss's rule is exact
    nodes, weights = np.polynomial.legendre.leggauss(len(rig.terms.xx) // 2 + 1)
    middle, half = (places[1:] + places[:-1]) / 2, np.diff(places) / 2
    powers = rig.powers((middle[:, None] + half[:, None] * nodes).ravel()).reshape(len(middle), len(nodes), -1)
    means = np.einsum("cgk,g->ck", powers, weights / 2)
    return means @ rig.terms.xx @ means.T
