"""Titles of the catalogue's families, and the reasons why each family is hard."""

FAMILIES: dict[str, tuple[str, str]] = {
    "near-sliding": (
        "Near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9",
        "The stick zone is sqrt(1 - Q_f) of the contact. Inside it the shear is below the friction bound by a part in "
        "1e9 of the bound, which is as large as the tolerance of many codes. With a penalty or a regularised law the "
        "whole contact creeps. The code finds no stick zone, or a stick zone as wide as its elastic slip. Newton's "
        "iteration on stick and slip flags switches one last node back and forth. A mesh that does not resolve the "
        "zone gives ends that are off by an element. The error estimate assumes resolved zones and is then a hundred "
        "times too small. partialslip therefore refines a zone of fewer than sixteen elements before it accepts the "
        "ends.",
    ),
    "near-stuck": (
        "Near stuck: dQ/(2 f P) = 1e-3 to 1e-9",
        "Slip is confined to strips at the ends that are narrower than any element. The traction beside the strips is "
        "the adhered one, which is infinite at the ends. Codes with an elastic slip tolerance report that the contact "
        "is stuck, or that it slips a little everywhere. Two meshes that both miss the strips agree with each other, "
        "which is no sign of convergence. The ends of the stick zone are accurate, because they lie next to the ends "
        "of the contact. But q in the last elements is a mean over a peak that the mesh does not resolve. The "
        "reference of the relative norm is as small as the load, so this mean alone causes an error of several "
        "percent.",
    ),
    "transition": (
        "At the transition from small to large tension, and 1e-9 beside it",
        "The left slip zone has just disappeared, or is a billionth of the contact wide. Its sign changes from one "
        "side of the transition to the other. The formulas of one regime fail under the loads of the other regime: "
        "the root of a negative number, or a modulus above one. A search with one branch for each regime jumps between "
        "the branches. A code that compares floating-point loads to name the regime flips between the names. "
        "partialslip solves for an unknown that passes smoothly through zero.",
    ),
    "huge-tension": (
        "Huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle",
        "The stick zone never vanishes. It shrinks exponentially, but not to the middle of the contact. The sum m + n "
        "cancels. Elliptic integrals whose modulus tends to one lose all digits if they take the modulus instead of "
        "the complementary modulus. On a mesh the zone is smaller than the distance of two nodes. Solvers that need "
        "one sticking node to fix the rigid motion get a singular matrix, others cycle, and some report m = n = 0 at "
        "the middle. Under gradual loads the tiny zone moves along the contact, and slip reverses behind it. One step, "
        "and even four, end with the tractions of the closed form. Only some twenty and more steps follow the zone, "
        "and then m differs by 0.02 to 0.06 a. March with refined steps is the reference, and the accuracy is 1e-2.",
    ),
    "no-shear": (
        "No shear: dQ = 0",
        "Without a change of Q any tension is large tension: the transition is at zero. The solution is "
        "antisymmetric. Quantities that are divided by dQ, or scaled with dQ, are lost. An increment with zero "
        "resultant must still be a load step. A code that measures convergence by Q stops before the first iteration.",
    ),
    "no-tension": (
        "No tension: dsigma = 0",
        "This is the case of Cattaneo and Mindlin. It is symmetric, so both ends of the stick zone move at the same "
        "time, and pairs of nodes change side in the same iteration. Rules that release one node at a time break the "
        "symmetry, and the solution may stay asymmetric.",
    ),
    "beside": (
        "The stick zone beside the centre",
        "x = 0 slips. Formulas that take the sign of the traction from the sign of x, as printed, are wrong here. A "
        "mesh that is fine only in the middle and at the ends is wrong, too, and so is a search that starts with a "
        "centred zone.",
    ),
    "poisson": (
        "Poisson's ratio from 0 to 0.4999",
        "Low-order triangles lock as the material becomes incompressible in plane strain. The body is then too stiff, "
        "and contact widths and tractions are wrong although everything converges. An error estimate from the "
        "neighbouring lower order locks as well and gives no warning. At nu = 0 products with nu vanish, which hides "
        "mistakes in them.",
    ),
    "friction": (
        "Coefficients of friction of 1e-3 and 10",
        "Between similar bodies, results scaled by f do not depend on f. A difference between the two cases therefore "
        "shows a bound or a tolerance in the wrong units. At 1e-3, shear tractions are not solved at all if their "
        "tolerance has the scale of the pressure. A large f makes fixed-point iterations between pressure and shear "
        "diverge, although similar bodies need no such iteration.",
    ),
    "sharp": (
        "Flat and rounded punches with b/a up to 0.999",
        "The pressure has two logarithmic kinks, and a peak in a corner a thousandth of the contact wide. In the "
        "corner it falls to zero like a square root. A uniform mesh along the contact misses the peak, the force in "
        "it and the slip zone in it. Quadrature that does not split at the kinks stalls. The width of the corner is a "
        "difference of nearly equal numbers.",
    ),
    "mean-loads": (
        "Mean loads at 0.5, 0.9, 0.98 and 1.02 of the largest in a steady state",
        "The shear that the first cycles lock in determines q at either load point. The range of q tends to the "
        "steady range, more slowly the nearer the mean load is to the bound. Beyond the bound every cycle adds slip. "
        "Codes that stop after the usual two or three cycles report a transient as steady. Codes that read the stick "
        "zone from the flags of one instant find it far too small. If the history is not committed at the end of an "
        "increment, the contact ratchets below the bound, too. The accuracy is 1e-3: the first cycles take many steps.",
    ),
    "cycles": (
        "Two hundred cycles at 0.995 of the largest mean load",
        "Errors of the steps add up. A loose friction tolerance gives a little slip in every cycle, which looks like "
        "ratcheting. A cycle that repeats to rounding is the steady state, and partialslip skips the remaining cycles. "
        "The accuracy is 1e-3.",
    ),
    "few-nodes": (
        "One node that sticks, none, and one node in contact",
        "Textbooks show contacts with two hundred nodes, but coarse meshes of large models have one. Without a "
        "sticking node only the force balance fixes the rigid tangential motion, and the matrix of sticking nodes is "
        "empty. A single node in contact gives no area, no slope of the pressure and no end to extrapolate to. The "
        "iteration must end, and give a certified result whose ends are within an element.",
    ),
    "meshes": (
        "Flat triangles of aspect 1e4, meshes off the middle, meshes that do not match",
        "Flat triangles make the stiffness ill-conditioned. Iterative solvers and tolerances on absolute forces are "
        "affected first. A mesh with nodes at the ends by construction can give the right result for the wrong "
        "reason. If the mesh is shifted by a part of an element, the ends lie anywhere between nodes. If the nodes of "
        "the two bodies do not match, node-to-segment contact fails the patch test, and gaps sampled at the nodes of "
        "one side oscillate.",
    ),
    "mirrored": (
        "Mirrored loads",
        "If Q changes sign and sigma does not, the stick zone moves to the other side. This case alone detects a sign "
        "that is right in only one half of the contact, or a tension applied in the wrong direction.",
    ),
}
