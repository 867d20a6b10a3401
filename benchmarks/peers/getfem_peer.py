"""GetFEM on an exported mesh; run as a script by a Python that has getfem: getfem_peer.py MESH PARAMETERS CSV ORDER.

The bodies are mirror images, so that one mesh carries two displacement fields, that of the upper body mirrored: nodes
match, and nothing is projected from mesh to mesh. The rigid motion of the upper body and the bulk strain of the lower
one are put on the gap and the slip, instead of on the outer boundary. Pressure p and shear q are multipliers on the
contact line, linear, with Alart and Curnier's augmented conditions; GetFEM assembles, its semismooth Newton and its
default direct solver solve. Hertz only.
"""

import json
import sys
import time

from setting import Setting

# physical groups of an exported mesh, in the order they are written: of the lower body, but for the last
_CONTACT, _OUTER, _UPPER = 2, (4, 5, 6), 7
_HELD = 100

_ENDS = ((0.1, 0.3, 0.01), (0.1, 0.3, 0.003), (0.1, 0.3, 0.001), (0.05, 0.2, 0.0003), (0.05, 0.2, 0.0001))
SETTINGS = (
    *(
        Setting("Q1/P1", size, growth, None, 1)
        for size, growth in ((0.1, 0.2), (0.05, 0.2), (0.025, 0.1), (0.0125, 0.1), (0.00625, 0.1))
    ),
    *(Setting("Q2/P1", size, 0.3, None, 2) for size in (0.1, 0.05, 0.025, 0.0125, 0.00625)),
    *(Setting("Q2/P1, graded to the ends", size, growth, fine, 2) for size, growth, fine in _ENDS),
)


def run(scene, setting, ends, stiffer, folder, python, measured):
    """Results, factors that make them SI, unknowns and costs."""
    from partialslip.export import export
    from partialslip.export.model import modelled
    from partialslip.halfplane import contact

    how = {"size": setting.size, "growth": setting.growth, "stiffer": stiffer, "ends": ends, "fine": setting.fine}
    export(scene, "gmsh", **how)(folder / "peer.msh")
    made, pressed = modelled(scene, **how), contact(scene)
    parameters = {
        "a": pressed.a,
        "p0": pressed.p0,
        "f": scene.friction.f,
        "R": scene.profile.R * stiffer,
        "E": made.parts[0].E,
        "nu": made.parts[0].nu,
        "steps": [step[1:] for step in made.steps],
    }
    (folder / "peer.json").write_text(json.dumps(parameters))
    arguments = ["peer.msh", "peer.json", "peer.csv", str(setting.option)]
    text, cost = measured([python, __file__, *arguments], folder)
    told = json.loads(text.strip().splitlines()[-1])
    return folder / "peer.csv", (1.0, 1.0, 1.0), told["dofs"], {"cpu_s": told["cpu_s"]} | cost


def main(mesh_file, parameters_file, csv_file, order):
    import getfem as gf
    import numpy as np

    start = time.process_time()
    gf.util_trace_level(0)
    with open(parameters_file) as file:
        scene = json.load(file)
    # lengths in a, stresses in p0 and displacements in p0 a/E, so that Newton's residual means the same for p and q
    a, p0, f, nu = (scene[key] for key in ("a", "p0", "f", "nu"))

    mesh = gf.Mesh("import", "gmsh", mesh_file)
    mesh.del_convex(mesh.region(_UPPER)[0])
    mesh.transform(np.eye(2) / a)
    mesh.set_region(_HELD, np.hstack([mesh.region(line) for line in _OUTER]))
    displacement = gf.MeshFem(mesh, 2)
    displacement.set_classical_fem(order)
    traction = gf.MeshFem(mesh, 1)
    traction.set_classical_fem(1)
    inside, line = gf.MeshIm(mesh, 2 * order), gf.MeshIm(mesh, 2 * order + 3)

    model = gf.Model("real")
    model.add_initialized_data("lame", [nu / ((1 + nu) * (1 - 2 * nu))])
    model.add_initialized_data("mu", [1 / (2 * (1 + nu))])
    for u in ("u", "v"):  # lower, and upper in the mirror
        model.add_fem_variable(u, displacement)
        model.add_isotropic_linearized_elasticity_brick(inside, u, "lame", "mu")
        model.add_Dirichlet_condition_with_simplification(u, _HELD)
    for multiplier in ("p", "q"):
        model.add_filtered_fem_variable(multiplier, traction, _CONTACT)
    model.add_variable("approach", 1)
    model.add_variable("shift", 1)
    model.add_initialized_data("loads", [0.0, 0.0])
    model.add_initialized_data("strain", [0.0])
    model.add_initialized_data("f", [f])
    curvature = a / scene["R"] * scene["E"] / p0
    model.add_initialized_data("curvature", [curvature])
    model.add_initialized_data("r", [1.0])
    for name in ("u0", "v0"):  # as the step before left them
        model.add_fem_data(name, displacement)
    model.add_initialized_data("moved0", [0.0])
    model.add_initialized_data("strain0", [0.0])

    model.add_macro("gap", "(curvature*sqr(X(1))/2 - u(2) - v(2) - approach)")
    model.add_macro("slip", "(u(1) - u0(1) - v(1) + v0(1) + (strain - strain0)*X(1) + shift - moved0)")
    model.add_macro("pressing", "pos_part(p - r*gap)")
    model.add_macro("pushing", "(q + r*slip)")
    model.add_macro("held", "(pushing - pos_part(pushing - f*pressing) + pos_part(-pushing - f*pressing))")
    work = "p*(Test_u(2) + Test_v(2) + Test_approach) + q*(Test_u(1) - Test_v(1) + Test_shift)"
    model.add_nonlinear_term(line, work, _CONTACT)
    model.add_nonlinear_term(line, "-(p - pressing)*Test_p/r", _CONTACT)
    model.add_nonlinear_term(line, "-(q - held)*Test_q/r", _CONTACT)
    length = gf.asm_generic(line, 0, "1", _CONTACT, gf.Model("real"))
    model.add_initialized_data("length", [length])
    model.add_nonlinear_term(line, "-(loads(1)*Test_approach + loads(2)*Test_shift)/length", _CONTACT)

    x, y = traction.basic_dof_nodes()
    nodes = np.flatnonzero((y == 0) & (np.abs(x) < 1.2 + 1e-9))
    nodes = nodes[np.argsort(x[nodes])]
    model.set_variable("approach", [0.5 * curvature])
    iterations, tractions = 0, []
    for P, Q, sigma in scene["steps"]:
        model.set_variable("loads", [P / (p0 * a), Q / (p0 * a)])
        model.set_variable("strain", [sigma / p0 * (1 - nu**2)])
        iterations += model.solve("max_res", 1e-9, "max_iter", 200, "lsearch", "simplest", "alpha min", 0.8)[0]
        for name, before in (("u", "u0"), ("v", "v0"), ("shift", "moved0"), ("strain", "strain0")):
            model.set_variable(before, model.variable(name))
        tractions.append([p0 * model.interpolation(name, traction, _CONTACT)[nodes] for name in ("p", "q")])
    cpu = time.process_time() - start

    (_, q1), (p, q2) = tractions[-2:]
    np.savetxt(csv_file, np.column_stack([a * x[nodes], p, q1, q2]), "%.12e", ",", header="x,p,q1,q2", comments="")
    print(json.dumps({"dofs": int(model.nbdof()), "iterations": iterations, "cpu_s": cpu}))


if __name__ == "__main__":
    main(*sys.argv[1:4], int(sys.argv[4]))
