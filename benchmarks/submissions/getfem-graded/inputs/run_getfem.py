"""GetFEM on two meshes, run by a Python that has getfem: run_getfem.py PARAMETERS.json.

The upper body is turned over, so that both bodies lie below their contact lines, which coincide. Its rigid motion and
the bulk strain of the lower body are put on gap and slip. Pressure p and shear q are multipliers on the lower body's
contact line, linear, with Alart and Curnier's augmented conditions; slip counts from the last increment. GetFEM
assembles, its semismooth Newton and its default direct solver solve. Lengths are in a, stresses in p0 and displacements
in p0 a/E, so that Newton's residual means the same for p and q.

PARAMETERS, in SI units: a; p0; f; order of the elements; augmentation, the constant of the augmented conditions in E/a;
gap (x, values); start, an approach that makes the bodies touch; bodies lower and upper: mesh, E, nu, lines (numbers of
the physical groups by name), held (names of lines along x and along y), pulled; strain of a unit tension; steps (name,
P, Q, sigma, M, increments); turns; points, numbers of the steps of load points 1 and 2; cycle, of those whose least and
largest shear q1 and q2 are; table, the file to write.
"""

import json
import sys
import time

import getfem as gf
import numpy as np

_BISECTIONS = 6  # accuracy: of an increment for which Newton's method does not converge
_LOADS = ("P", "Q", "sigma", "M")


def main(told):
    """Solve all steps, write the table, and print unknowns and CPU seconds as JSON."""
    gf.util_trace_level(0)
    gf.util_warning_level(0)
    contact, tractions, before, gave_up = ContactProblem(told), [], np.zeros(4), None
    for step in told["steps"]:
        after = np.array([step[key] for key in _LOADS])
        for share in (np.arange(step["increments"]) + 1) / step["increments"]:
            if not contact.reach(before + share * (after - before)):
                gave_up = step["name"]
                break
        if gave_up:
            break
        before = after
        tractions.append([contact.traction(name) for name in ("p", "q")])
    if not gave_up:
        (p1, q1), (p, q2) = (tractions[number] for number in told["points"])
        if told["cycle"]:
            shear = np.array([tractions[number][1] for number in told["cycle"]])
            q1, q2 = shear.min(axis=0), shear.max(axis=0)
        columns = np.column_stack([contact.x, p, p1, q1, q2])
        np.savetxt(told["table"], columns, "%.12e", ",", header="x,p,p1,q1,q2", comments="")
    print(json.dumps({"unknowns": contact.model.nbdof(), "cpu_s": time.process_time(), "gave_up": gave_up}))


class ContactProblem:
    """Two bodies in contact: ``model``, and nodes ``x`` of the tractions."""

    def __init__(self, told):
        self.told, self.f, self.E = told, told["f"], told["bodies"]["lower"]["E"]
        self.model, self.kept = gf.Model("real"), []  # GetFEM's objects must outlive the model
        self.lower = self._body("lower", "u")
        self.upper = self._body("upper", "v")
        self.line = told["bodies"]["lower"]["lines"]["contact"]
        self.multipliers = gf.MeshFem(self.lower, 1)
        self.multipliers.set_classical_fem(1)
        self._contact()
        nodes = np.array(self.multipliers.basic_dof_on_region(self.line))
        self.nodes = nodes[np.argsort(self.multipliers.basic_dof_nodes()[0, nodes])]
        self.x = told["a"] * self.multipliers.basic_dof_nodes()[0, self.nodes]

    def traction(self, name):
        """Traction p or q at the nodes, Pa."""
        if name == "q" and not self.f:
            return np.zeros(len(self.nodes))
        return self.told["p0"] * self.model.interpolation(name, self.multipliers)[self.nodes]

    def _body(self, name, u):
        """Add the elastic body ``name`` with the displacement ``u`` to the model; return its mesh."""
        body, order, nu = self.told["bodies"][name], self.told["order"], self.told["bodies"][name]["nu"]
        mesh = gf.Mesh("import", "gmsh", body["mesh"])
        mesh.transform(np.eye(2) / self.told["a"])
        displacement, inside = gf.MeshFem(mesh, 2), gf.MeshIm(mesh, 2 * order)
        displacement.set_classical_fem(order)
        held = [
            dof
            for component, lines in enumerate(body["held"])
            for line in lines
            for dof in displacement.basic_dof_on_region(body["lines"][line])
            if dof % 2 == component
        ]
        every = np.arange(displacement.nbdof())
        free = gf.Spmat("copy", gf.Spmat("identity", len(every)), np.setdiff1d(every, held), every)
        spread = gf.Spmat("copy", free)
        spread.transpose()
        displacement.set("reduction_matrices", free, spread)
        self.model.add_initialized_data(f"lame_{u}", [body["E"] / self.E * nu / ((1 + nu) * (1 - 2 * nu))])
        self.model.add_initialized_data(f"mu_{u}", [body["E"] / self.E / (2 * (1 + nu))])
        self.model.add_fem_variable(u, displacement)
        self.model.add_fem_data(f"{u}0", displacement)  # as the increment before left it
        self.model.add_isotropic_linearized_elasticity_brick(inside, u, f"lame_{u}", f"mu_{u}")
        self.kept += [displacement, inside]
        return mesh

    def _contact(self):
        """Add gap, slip, contact and friction to the model."""
        told, model, line = self.told, self.model, self.line
        unit = told["p0"] * told["a"] / self.E  # of displacements
        smooth, along = gf.MeshFem(self.lower, 1), gf.MeshIm(self.lower, 2 * told["order"] + 3)
        smooth.set_classical_fem(2)
        self.kept += [smooth, along]
        x = smooth.basic_dof_nodes()[0] * told["a"]
        model.add_initialized_fem_data("given", smooth, np.interp(x, told["gap"]["x"], told["gap"]["values"]) / unit)
        model.add_interpolate_transformation_from_expression("over", self.lower, self.upper, "X")
        length = gf.asm_generic(along, 0, "1", line, gf.Model("real"))
        for name, value in {
            "f": self.f,
            "r": told["augmentation"],
            "length": length,
            "moved0": 0.0,
            "strain": 0.0,
            "strain0": 0.0,
        }.items():
            model.add_initialized_data(name, [value])
        model.add_initialized_data("loads", [0.0] * len(_LOADS))
        model.add_filtered_fem_variable("p", self.multipliers, line)
        model.add_variable("approach", 1)
        model.set_variable("approach", [told["start"] / unit])
        if told["turns"]:
            model.add_variable("turn", 1)
        turned = " - turn*X(1)" if told["turns"] else ""
        model.add_macro("gap", f"(given - u(2) - Interpolate(v,over)(2) - approach{turned})")
        model.add_macro("pressing", "pos_part(p - r*gap)")
        terms = [
            "p*(Test_u(2) + Interpolate(Test_v,over)(2) + Test_approach) - loads(1)*Test_approach/length",
            "-(p - pressing)*Test_p/r",
        ]
        if told["turns"]:
            terms.append("p*X(1)*Test_turn - loads(4)*Test_turn/length")
        if self.f:
            model.add_filtered_fem_variable("q", self.multipliers, line)
            model.add_variable("shift", 1)
            moved = "u(1) - u0(1) - Interpolate(v,over)(1) + Interpolate(v0,over)(1)"
            model.add_macro("slip", f"({moved} + (strain - strain0)*X(1) + shift - moved0)")
            model.add_macro("pushing", "(q + r*slip)")
            model.add_macro("held", "(pushing - pos_part(pushing - f*pressing) + pos_part(-pushing - f*pressing))")
            terms += [
                "q*(Test_u(1) - Interpolate(Test_v,over)(1) + Test_shift) - loads(2)*Test_shift/length",
                "-(q - held)*Test_q/r",
            ]
        for term in terms:
            model.add_nonlinear_term(along, term, line)
        if told["bodies"]["lower"]["pulled"]:
            model.add_nonlinear_term(along, "-loads(3)*Test_u(1)", told["bodies"]["lower"]["lines"]["right"])

    def reach(self, loads, bisections=_BISECTIONS):
        """Solve for ``loads``, SI units; halve the way there if Newton's method does not converge. Whether it did."""
        model, told = self.model, self.told
        units = told["p0"] * np.array([told["a"], told["a"], 1.0, told["a"] ** 2])
        state = model.from_variables()
        names = ("loads", "strain")
        before = [model.variable(name) for name in names]
        for name, value in zip(names, (loads / units, [loads[2] * told["strain"] * self.E / told["p0"]]), strict=True):
            model.set_variable(name, value)
        try:
            converged = model.solve("max_res", 1e-9, "max_iter", 100, "lsearch", "simplest", "alpha min", 0.8)[1]
        except RuntimeError:
            converged = False
        if converged:
            for name, kept in (("u", "u0"), ("v", "v0"), ("strain", "strain0"), *[("shift", "moved0")] * bool(self.f)):
                model.set_variable(kept, model.variable(name))
            return True
        model.to_variables(state)
        for name, value in zip(names, before, strict=True):
            model.set_variable(name, value)
        halfway = (before[0] * units + loads) / 2
        return bool(bisections) and self.reach(halfway, bisections - 1) and self.reach(loads, bisections - 1)


if __name__ == "__main__":
    with open(sys.argv[1]) as file:
        main(json.load(file))
