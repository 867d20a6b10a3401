"""How coupled bodies are pressed together: half-planes under a parabolic gap, self-similarly.

With friction, what has been pressed together early keeps the displacement that it had when it stuck. Of half-planes and
a parabola all stages are alike: at a half-width s the contact grows as if a flat punch of that half-width were pressed,
in which the part |x| < c s sticks, with c the same at all stages (Spence 1968, 1975). Tractions are therefore sums of
those of flat punches,

    q(x) = int_x^a q_flat(x/s) 2 s ds / (s a^2),    p likewise,

and one problem, that of the punch, tells them all. What is solved for in the end is one small step from a moment before
the last, so that the answer satisfies all of the conditions of contact and friction, with a certificate.
"""

from dataclasses import dataclass

import numpy as np

from partialslip.arrays import Array

_TELLING = 1e-9  # of the half-width


@dataclass(frozen=True)
class Punch:
    """A flat punch pressed with 1: half-width, nodal forces along y and x (n,) at the nodes ``x`` (n,), whose
    ``weights`` (n,) turn tractions into forces."""

    half_width: float
    x: Array
    weights: Array
    normal: Array
    tangential: Array

    def stage(self, share: float) -> tuple[Array, Array]:
        """Nodal forces along y and x (n,) of the parabola, pressed until its contact has ``share`` of the punch's
        half-width."""
        reach = self.half_width * share
        inside = np.abs(self.x) < self.half_width * (1 - _TELLING)
        at = np.concatenate([[-1.0], self.x[inside] / self.half_width, [1.0]])

        def forces(of: Array) -> Array:
            values = np.concatenate([[0.0], self._summed(of)[inside], [0.0]])
            traction = np.interp(self.x / reach, at, values, left=0.0, right=0.0)
            result: Array = self.weights * traction * share
            return result

        p, q = forces(self.normal), forces(self.tangential)
        # what the nodes make of the sums is little, but not beside what the last step adds
        return p * share**2 / p.sum(), q - q.sum() / p.sum() * p

    def _summed(self, forces: Array) -> Array:
        """2 x int_x^1 of the punch's traction over t^2 dt, lengths in half-widths: of t = sin(angle), in which the
        traction times cos(angle) is regular at the ends and goes linearly from node to node."""
        scaled = self.x / self.half_width
        result = np.zeros(len(scaled))
        for way in (1, -1):
            side = np.flatnonzero((way * scaled > _TELLING) & (way * scaled < 1 - _TELLING))
            side = side[np.argsort(way * scaled[side])]
            angle = np.arcsin(way * scaled[side])
            regular = forces[side] / self.weights[side] * np.cos(angle)
            regular[-2:] = regular[-3]  # the nodes beside the end carry its singularity
            angle, regular = np.append(angle, np.pi / 2), np.append(regular, regular[-1])
            slope = np.diff(regular) / np.diff(angle)
            pieces = slope * np.diff(np.log(np.sin(angle))) - np.diff(regular / np.tan(angle))
            result[side] = 2 * np.sin(angle[:-1]) * np.cumsum(pieces[::-1])[::-1]
        middle, known = np.abs(scaled) <= _TELLING, np.abs(scaled) > _TELLING
        result[middle] = np.interp(scaled[middle], scaled[known], result[known])
        return result
