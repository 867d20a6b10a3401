"""Titles of the catalogue's families, and what makes each of them hard, in words."""

FAMILIES: dict[str, tuple[str, str]] = {
    "near-sliding": (
        "Near sliding: dQ/(2 f P) = 1 - 1e-3 to 1 - 1e-9",
        "The stick zone is sqrt(1 - Q_f) of the contact, and the room that friction leaves there is a part in 1e9 of "
        "the bound: as much as many codes take for converged. A penalty or a regularised law has by then let the "
        "whole contact creep and finds no stick zone, or one whose width is that of its elastic slip; Newton's "
        "iteration on stick and slip flags turns one last node to and fro. A mesh that does not see the zone reports "
        "ends that are off by an element while its own error estimate, made for resolved zones, says a hundredth of "
        "that: a zone of fewer than sixteen elements is therefore refined before its ends are believed.",
    ),
    "near-stuck": (
        "Near stuck: dQ/(2 f P) = 1e-3 to 1e-9",
        "Slip is confined to strips at the ends that are narrower than any element, and the traction beside them is "
        "the adhered one, infinite at the ends. Codes that follow an elastic slip tolerance report the contact as "
        "stuck, or as slipping everywhere by a little; two meshes that both miss the strips agree with each other, "
        "which must not pass for convergence. The ends of the stick zone are known well, as they are next to those of "
        "the contact, but q in the last elements is a mean over a peak nobody resolves: in the relative norm, whose "
        "reference is as small as the load, that alone is several percent.",
    ),
    "transition": (
        "At the transition from small to large tension, and 1e-9 beside it",
        "The left slip zone has just gone, or is a billionth of the contact wide; its sign changes from one side to "
        "the other. Formulas of one regime break down with the other's loads (a root of a negative number, a modulus "
        "beyond one), searches with one branch for each regime jump between them, and a code that gives regimes names "
        "by comparing floating-point loads flips. The unknown used here goes through zero smoothly.",
    ),
    "huge-tension": (
        "Huge tension: stick zones of 1e-3 to 1e-8 of a, off the middle",
        "The stick zone never vanishes but shrinks exponentially, and not to the middle. m + n cancels; elliptic "
        "integrals whose modulus tends to one lose all digits when they are given the modulus instead of its "
        "complement. On a mesh the zone is less than a node: solvers that need one sticking node to carry the rigid "
        "motion find a singular matrix, others cycle, and some report m = n = 0 at the middle.",
    ),
    "no-shear": (
        "No shear: dQ = 0",
        "Without a change of Q any tension is large tension, the transition is at zero, and the solution is "
        "antisymmetric: what is divided by dQ, or scaled with it, is lost, and an increment with zero resultant must "
        "still be a load step. A code that takes Q for the measure of convergence stops before the first iteration.",
    ),
    "no-tension": (
        "No tension: dsigma = 0",
        "The case of Cattaneo and Mindlin: symmetric, so that both ends of the stick zone move at once and whole "
        "pairs of nodes change side in the same iteration. Rules that let one node go at a time break the symmetry, "
        "and what they find may stay lopsided.",
    ),
    "beside": (
        "The stick zone beside the centre",
        "x = 0 slips. Formulas that take the sign of the traction from the sign of x, as printed, are wrong here; so "
        "is a mesh that is fine in the middle and at the ends only, and a search that begins with a centred zone.",
    ),
    "poisson": (
        "Poisson's ratio from 0 to 0.4999",
        "Low-order triangles lock as the material becomes incompressible in plane strain: contact widths and "
        "tractions come out too stiff although everything converges. An estimate from the neighbouring lower order "
        "locks with them and says nothing. At nu = 0 products with nu vanish, which hides mistakes in them.",
    ),
    "friction": (
        "Coefficients of friction of 1e-3 and 10",
        "Scaled by f nothing changes between similar bodies, so a difference between the two is a bound or a "
        "tolerance in the wrong units: shear tractions that are judged by the pressure's scale are not solved at all "
        "at 1e-3, and a large f makes fixed-point iterations between pressure and shear diverge where there should be "
        "none.",
    ),
    "sharp": (
        "Flat and rounded punches with b/a up to 0.999",
        "The pressure has two logarithmic kinks and a peak in a corner a thousandth of the contact wide, where it "
        "falls to zero like a square root. Meshes even along the contact miss the peak, its force and the slip zone "
        "in it; quadrature that does not know of the kinks stalls; the width of the corner is a difference of nearly "
        "equal numbers.",
    ),
    "mean-loads": (
        "Mean loads at 0.5, 0.9, 0.98 and 1.02 of what a steady state can hold",
        "What the first cycles lock in decides q at either load point, while its range tends to the steady one, more "
        "slowly the nearer the bound; beyond it every cycle adds slip. Codes that stop after the usual two or three "
        "cycles report a transient as steady; those that read the stick zone from the flags of one instant find it "
        "far too small; a history not committed at the end of an increment ratchets below the bound, too.",
    ),
    "cycles": (
        "Two hundred cycles at 0.995 of that bound",
        "Errors of a step add up: slack in friction's tolerance is a little slip in every cycle, and looks like "
        "ratcheting. When a cycle repeats to rounding it has been followed for good, and the rest is not computed.",
    ),
    "few-nodes": (
        "One node that sticks, none, and one node in contact",
        "Two hundred nodes are what textbooks draw; coarse meshes of large models have one. With no sticking node the "
        "rigid tangential motion is held by the force balance alone, and a matrix of sticking nodes is empty. With a "
        "single node in contact there is no area, no slope of the pressure and no end to extrapolate to. What is "
        "asked is a certified answer whose ends are within an element, and an end to the iteration.",
    ),
    "meshes": (
        "Flat triangles of aspect 1e4, meshes off the middle, meshes that do not match",
        "Flat triangles make the stiffness ill-conditioned, which iterative solvers and tolerances on absolute forces "
        "feel first. A mesh whose nodes are at the ends by construction is right for the wrong reason: shifted by a "
        "part of an element, the ends fall anywhere. Where the nodes of the two bodies do not match, node-to-segment "
        "contact fails the patch test, and gaps that are sampled at nodes of one side oscillate.",
    ),
    "mirrored": (
        "Mirrored loads",
        "With Q turned round and sigma as it was the stick zone moves to the other side. A sign that was right in one "
        "half of the contact only, or a tension applied the wrong way round, shows here and nowhere else.",
    ),
}
