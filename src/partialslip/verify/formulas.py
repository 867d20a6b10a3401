"""Formulas that the exact method evaluates for a scene, and their references, as text."""

from partialslip.result import Result
from partialslip.scene import Scene
from partialslip.scene.profiles import FlatRounded, Hertz

PUBLICATIONS = {
    "1": "H. Andresen, D. A. Hills and M. R. Moore, The steady state partial slip problem for half plane contacts "
    "subject to a constant normal load using glide dislocations",
    "2": "K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985",
    "3": "M. Ciavarella, D. A. Hills and G. Monno, The influence of rounded edges on indentation by a flat punch, 1998",
    "4": "C. Cattaneo, Sul contatto di due corpi elastici, 1938; R. D. Mindlin, Compliance of elastic bodies in "
    "contact, 1949",
    "5": "D. Nowell and D. A. Hills, Mechanics of fretting fatigue tests, Int. J. Mech. Sci. 29, 1987",
    "6": "R. D. Mindlin and H. Deresiewicz, Elastic spheres in contact under varying oblique forces, 1953",
    "7": "P. J. Roache, Perspective: a method for uniform reporting of grid refinement studies, J. Fluids Eng. 116, "
    "1994",
    "8": "ASME V&V 10, Standard for verification and validation in computational solid mechanics",
}

Formula = tuple[str, str]  # text, and numbers of references

_MATERIAL = "A = (κ + 1)/(2 μ), κ = 3 − 4 ν in plane strain, κ = (3 − ν)/(1 + ν) in plane stress"
_STEADY = "q2 − q1 = 2 f p in the slip zone on the right, 2 s f p on the left; no change of slip in −m < x < n"


def formulas(scene: Scene, result: Result) -> tuple[Formula, ...]:
    """Return the formulas for ``scene`` and for the regime of ``result``, each with numbers of :data:`REFERENCES`."""
    return ((_MATERIAL, "1"), _normal(scene), *_tangential(scene, result))


def _normal(scene: Scene) -> Formula:
    """Return the formula of the pressure."""
    if isinstance(scene.profile, Hertz):
        return "p = p0 √(1 − x²/a²), p0 = 2 P/(π a), a² = 2 A R P/π", "2"
    if isinstance(scene.profile, FlatRounded) and not scene.profile.crown:
        return "P = a²/(A R) (ψ − sin ψ cos ψ), b = a cos ψ; p by the closed form of the reference", "3"
    return "p = the sum of the pressures of flat punches with round corners, one for each step of the curvature", "3"


def _tangential(scene: Scene, result: Result) -> tuple[Formula, ...]:
    """Return the formulas of the stick zone and of the shear."""
    hertz = isinstance(scene.profile, Hertz)
    if result.regime == "frictionless":
        return (("q = 0", "2"),)
    if result.regime == "sliding":
        return (("q = ± f p", "2"),)
    if result.regime == "ratchets":
        return (("no steady state: every cycle adds slip", "6"),)
    if not scene.load.in_phase:
        return (("no closed form: q follows from the load steps, with |q| ≤ f p and no slip in the stick zone", "1"),)
    if result.regime == "small tension":
        return ((_STEADY + ", s = +1", "1"), *_small_tension(scene, hertz))
    if result.regime == "large tension":
        by = "complete elliptic integrals" if hertz else "quadrature"
        return ((_STEADY + ", s = −1", "1"), (f"m and n from the two consistency conditions, by {by}", "1"))
    return ((_STEADY, "1"),)


def _small_tension(scene: Scene, hertz: bool) -> tuple[Formula, ...]:
    if hertz and not (scene.load.dsigma or scene.load.dslope):
        return (("m = n = a √(1 − ΔQ/(2 f P))", "4"),)
    if hertz and not scene.load.dslope:
        return (("(n + m)/2 = a √(1 − ΔQ/(2 f P)), (n − m)/2 = −A R Δσ/(8 f)", "1, 5"),)
    return (("m and n from the two consistency conditions, by quadrature", "1"),)
