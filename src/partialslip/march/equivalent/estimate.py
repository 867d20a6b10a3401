"""Error estimate of equivalent half-planes: what they leave out, and the mesh by which the rig was found.

What is left out of the gap changes the pressure by a known function without a resultant, and this the stick zone and
the moments. What is left out of the strain changes the shear of the stick zone. Each is put back, one at a time, to
see how much it matters.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from partialslip.halfplane import Contact, contact, contact_of
from partialslip.halfplane.contact import rubbing, tilted_contact
from partialslip.halfplane.loading import Loading
from partialslip.halfplane.proportional import loading
from partialslip.march.equivalent.data import HalfPlaneData, chebyshev_coefficients, nodes
from partialslip.result.rig import Rig
from partialslip.scene import Scene
from partialslip.tools.arrays import Array

_MESH = 0.25  # accuracy: error of the rig, in its difference from the rig of the coarser mesh
# accuracy: factors of what is left out: it changes itself; and q has kinks that move by less than points are apart
_NEARLY, _KINKED = 1.1, 1.5
_WAY = 2.0  # accuracy: factor of what is left out where the pressure moves
_MORE = 1e-4  # accuracy: of P
_ANGLES = np.pi * (np.arange(200) + 0.5) / 200
_PLACES = np.cos(_ANGLES)  # in half-widths of the contact


@dataclass(frozen=True)
class _Look:
    """Half-planes in one set of data: the ``second`` contact, at load point 2, and the ``mean`` of both, on which the
    ``change`` of shear from load point 1 to 2 depends; None if nothing changes or sticks."""

    second: Contact
    mean: Contact
    change: Loading | None
    f: float

    def dq(self, x: Array) -> Array:
        """dq at ``x``, m."""
        if not self.change:
            return np.zeros_like(x)
        return self.f * self.mean.p0 * self.change.traction(self.mean.scaled(x))

    def apart(self, other: "_Look", a: float) -> dict[str, float]:
        """Differences of the ends and tractions of the ``other``; ends in ``a``, tractions in relative L2."""
        ends = np.abs(np.subtract(self.second.ends, other.second.ends)) / a
        found = {"a": abs(self.second.a - other.second.a) / a, "left": ends[0], "right": ends[1]}
        if self.change and other.change:
            sticks = (each.mean.places(each.change.ends) for each in (self, other) if each.change)
            found |= dict(zip("mn", np.abs(np.subtract(*sticks)) / a, strict=True))
        x, at_mean = self.second.places(_PLACES), self.mean.places(_PLACES)
        found["p"] = _norm(self.second.pressure(x) - other.second.pressure(x)) / _norm(self.second.pressure(x))
        found["q"] = _norm(self.dq(at_mean) - other.dq(at_mean)) / (_norm(self.dq(at_mean)) or 1.0)
        return {key: float(error) for key, error in found.items()}


def estimate(
    rig: Rig, scene: Scene, seen: Scene, data: HalfPlaneData, coarser: Scene, shear: bool
) -> dict[str, dict[str, float]]:
    """Parts of the error estimate by source: ``half-planes``, what they leave out, and ``rig``.

    Parameters
    ----------
    rig : Rig
    scene, seen : Scene
        The scene, and that of half-planes with the ``data``.
    data : Data
    coarser : Scene
        The scene of half-planes with the data of the rig of the coarser mesh.
    shear : bool
        Whether the half-planes leave out a part of the strain.
    """
    A, (first, second) = scene.material.A, scene.load.ends
    own = _look(seen)
    rests = data.rest[second], (data.rest[first] + data.rest[second]) / 2
    kinks = scene.profile.kinks
    whole = (_with(pressed, rest / A, kinks) for pressed, rest in zip((own.second, own.mean), rests, strict=True))
    left_out = own.apart(_look(seen, *whole), own.second.a)
    # the moments of the pressure that is left out change the curvature and the tilt; the curvature is a mean
    a, x, R = own.second.a, own.second.places(_PLACES), _radius(seen, own.second)
    moments = rig.moments(x, _series(data.rest[second] / A)(_PLACES) * a * np.sin(_ANGLES) * np.pi / len(x))
    slope = chebyshev_coefficients(A * rig.slopes(own.second.places(nodes()), rig.opening(moments, 0 * moments)))
    grown = abs(R * slope[1] / (2 * a)) + R * float(np.ptp(data.curvature)) / 4
    moved = abs(R * slope[0] / a)
    left_out |= {"a": grown, "left": grown + moved, "right": grown + moved}
    left_out["p"] += R * float(np.ptp(data.curvature)) / 2
    if shear and own.change:
        middle, c = own.change.mirror * own.change.zone.centre, own.change.zone.half_width
        rest = _series((data.strain_rest[first] - data.strain_rest[second]) / 4)
        left_out["q"] += _norm(rest((_PLACES - middle) / c)) / (_norm(own.dq(own.mean.places(_PLACES))) or 1.0)
    left_out = {key: (_KINKED if key == "q" else _NEARLY) * error for key, error in left_out.items()}
    if np.ptp(data.tilt):  # the pressure moves, and the way from load point to load point is not followed
        left_out = {key: _WAY * error for key, error in left_out.items()}
    mesh = {key: _MESH * error for key, error in own.apart(_look(coarser), a).items()}
    return {
        source: {key: float(error) for key, error in share.items()}
        for source, share in (("half-planes", left_out), ("rig", mesh))
    }


def _look(seen: Scene, second: Contact | None = None, mean: Contact | None = None) -> _Look:
    """Half-planes of the scene ``seen``, with other contacts if given."""
    one, two = seen.end_pressing
    second = second or contact(seen, two)
    mean = rubbing(mean, seen) if mean else contact(seen, one.towards(two, 0.5))
    load, f = seen.load, mean.f
    sticks = f > 0 and not seen.slides
    change = loading(mean, f, load.dQ, load.dsigma, load.dslope, bound=2) if sticks else None
    return _Look(second, mean, None if change and change.nothing else change, f)


def _radius(seen: Scene, pressed: Contact) -> float:
    """Radius of a Hertz contact of the half-width of ``pressed`` that grows like it with P, dP = pi a da/(A R)."""
    more = pressed.P * (1 + _MORE)
    grown = tilted_contact(seen, more, pressed.tilt).a - pressed.a
    return np.pi * pressed.a * grown / (seen.material.A * _MORE * pressed.P)


def _with(pressed: Contact, rest: Array, kinks: Sequence[float]) -> Contact:
    """The contact ``pressed`` with the pressure that the ``rest`` of the gap's slope, over A, adds."""
    more = _series(rest)
    return contact_of(lambda x: pressed.pressure(x) + more(pressed.scaled(x)), pressed.a, kinks, pressed.centre)


def _series(coefficients: Array) -> Callable[[Array], Array]:
    """Sum of c_j sin(j theta) at x = cos(theta), j = 2, 3, ...: traction that the strain sum of c_j T_j(x) causes."""
    orders = np.arange(2, 2 + len(coefficients))

    def function(x: Array) -> Array:
        angles = np.arccos(np.clip(x, -1.0, 1.0))
        return np.sin(angles[..., None] * orders) @ coefficients

    return function


def _norm(values: Array) -> float:
    """L2 norm of ``values`` at the places."""
    return float(np.sqrt(values**2 @ np.sin(_ANGLES)))
