"""Kratos on the two meshed bodies of a model, run by a Python that has its contact application:
run_kratos.py PARAMETERS.json.

Mortar elements with augmented Lagrangian multipliers, friction by Coulomb's law. Quadrilaterals of small strain; the
lower body is the slave. Lengths are in a and stresses such that E is 1e4, so that the tolerances have a meaning. With
Kratos' own tangent_factor, 0.025, q is off by 0.3 f p0 at the ends of the stick zone when the load comes back; with 1
it is not.

PARAMETERS, in SI units: a; f; bodies lower and upper: points, quads, contact (edges), E, nu; held (nodes along x, and
along y) of both; pull (forces on the lower body's nodes of a unit tension); strained (strains of a unit tension); steps
(name, P, Q, sigma, increments, guided); points, numbers of the steps of load points 1 and 2; cycle, of those whose
least and largest shear q1 and q2 are; tangent_factor, null for Kratos' own; table, the file to write.
"""

import json
import sys
import time

import KratosMultiphysics as KM
import KratosMultiphysics.ContactStructuralMechanicsApplication as CSMA
import KratosMultiphysics.StructuralMechanicsApplication as SMA
import numpy as np
from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import StructuralMechanicsAnalysis

_E = 1e4  # fixed: Young's modulus of the lower body in the units of the model
_SETTINGS = """{
    "problem_data": {"problem_name": "contact", "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0,
                     "echo_level": 0},
    "solver_settings": {
        "solver_type": "Static", "model_part_name": "Structure", "domain_size": 2, "echo_level": 0,
        "analysis_type": "non_linear",
        "model_import_settings": {"input_type": "use_input_model_part"},
        "contact_settings": {"mortar_type": "ALMContactFrictional"},
        "time_stepping": {"time_step": 1.0},
        "buffer_size": 3,
        "convergence_criterion": "contact_residual_criterion",
        "displacement_relative_tolerance": 1e-6, "displacement_absolute_tolerance": 1e-12,
        "residual_relative_tolerance": 1e-6, "residual_absolute_tolerance": 1e-9,
        "max_iteration": 60,
        "linear_solver_settings": {"solver_type": "LinearSolversApplication.sparse_lu"}
    },
    "processes": {"contact_process_list": [{
        "python_module": "alm_contact_process",
        "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "process_name": "ALMContactProcess",
        "Parameters": {
            "model_part_name": "Structure",
            "assume_master_slave": {"0": ["slave"]},
            "contact_model_part": {"0": ["line"]},
            "friction_coefficients": {"0": 0.0},
            "contact_type": "Frictional"
        }
    }]},
    "output_processes": {}
}"""


class Analysis(StructuralMechanicsAnalysis):
    """The bodies, and their loads step by step."""

    def __init__(self, told):
        self.told, a = told, told["a"]
        self.stress = told["bodies"]["lower"]["E"] / _E
        settings = KM.Parameters(_SETTINGS)
        contact = settings["processes"]["contact_process_list"][0]["Parameters"]
        contact["friction_coefficients"]["0"].SetDouble(told["f"])
        if told["tangent_factor"] is not None:
            contact.AddDouble("tangent_factor", told["tangent_factor"])
        if not told["f"]:
            contact["contact_type"].SetString("Frictionless")
            settings["solver_settings"]["contact_settings"]["mortar_type"].SetString("ALMContactFrictionless")
        settings["problem_data"]["end_time"].SetDouble(float(sum(step["increments"] for step in told["steps"])))
        model = KM.Model()
        super().__init__(model, settings)
        self.part = model["Structure"]
        self.lower = self._body("lower", 0, 1)
        self.upper = self._body("upper", len(self.lower), 2)
        self.along_x, self.along_y = ([self.upper[k] for k in nodes] for nodes in told["held"]["upper"])
        self.loads = np.zeros(3)
        self.tractions, self.unit = [], a

    def _body(self, name, first, number):
        """Add a body; return its nodes."""
        told, part = self.told["bodies"][name], self.part
        constants = part.CreateNewProperties(number)
        constants.SetValue(KM.YOUNG_MODULUS, told["E"] / self.stress)
        constants.SetValue(KM.POISSON_RATIO, told["nu"])
        constants.SetValue(KM.THICKNESS, 1.0)
        constants.SetValue(KM.CONSTITUTIVE_LAW, SMA.LinearElasticPlaneStrain2DLaw())
        points = np.array(told["points"]) / self.told["a"]
        nodes = [part.CreateNewNode(first + k, x, y, 0.0) for k, (x, y) in enumerate(points.tolist(), 1)]
        start = part.NumberOfElements()
        for k, quad in enumerate(told["quads"], start + 1):
            part.CreateNewElement("SmallDisplacementElement2D4N", k, [first + node + 1 for node in quad], constants)
        start = part.NumberOfConditions()
        for k, edge in enumerate(told["contact"], start + 1):
            part.CreateNewCondition("LineCondition2D2N", k, [first + node + 1 for node in edge], constants)
        on_line = sorted({first + node + 1 for edge in told["contact"] for node in edge})
        for group in ("line", *(["slave"] if name == "lower" else [])):
            sub = part.GetSubModelPart(group) if part.HasSubModelPart(group) else part.CreateSubModelPart(group)
            sub.AddNodes(on_line)
            sub.AddConditions(list(range(start + 1, start + len(told["contact"]) + 1)))
        if name == "lower":
            self.slaves = [part.GetNode(k) for k in on_line]
        return nodes

    def ModifyInitialGeometry(self):
        """Tie the upper body's frame, whose first nodes carry the loads."""
        super().ModifyInitialGeometry()
        number = 0
        for nodes, variable in ((self.along_x, KM.DISPLACEMENT_X), (self.along_y, KM.DISPLACEMENT_Y)):
            for node in nodes[1:]:
                number += 1
                self.part.CreateNewMasterSlaveConstraint(
                    "LinearMasterSlaveConstraint", number, nodes[0], variable, node, variable, 1.0, 0.0
                )
        first = self.part.NumberOfConditions() + 1

        def point(number, node, body):
            properties = self.part.GetProperties()[body]
            return self.part.CreateNewCondition("PointLoadCondition2D1N", first + number, [node.Id], properties)

        self.points = [point(0, self.along_x[0], 2), point(1, self.along_y[0], 2)]
        pulled = [k for k, force in enumerate(self.told["pull"]) if force]
        self.pulled = [(point(2 + i, self.lower[k], 1), self.told["pull"][k]) for i, k in enumerate(pulled)]

    def ApplyBoundaryConditions(self):
        """Loads of the increment."""
        super().ApplyBoundaryConditions()
        P, Q, sigma = self.loads
        unit = self.stress * self.unit
        strained = np.array(self.told["strained"]) * sigma
        for component, variable in enumerate((KM.DISPLACEMENT_X, KM.DISPLACEMENT_Y)):
            for k in self.told["held"]["lower"][component]:
                node = self.lower[k]
                node.Fix(variable)
                node.SetSolutionStepValue(variable, (node.X0, node.Y0)[component] * strained[component])
        first = self.along_x[0]
        if self.guided:
            first.Fix(KM.DISPLACEMENT_X)
        else:
            first.Free(KM.DISPLACEMENT_X)
        for condition, load in zip(self.points, ([-Q / unit, 0.0, 0.0], [0.0, -P / unit, 0.0]), strict=True):
            condition.SetValue(SMA.POINT_LOAD, KM.Array3(load))
        for condition, force in self.pulled:
            condition.SetValue(SMA.POINT_LOAD, KM.Array3([force * sigma / unit, 0.0, 0.0]))

    def solve(self):
        """Go through all steps; the name of the step that does not converge, or None."""
        self.Initialize()
        solver, before = self._GetSolver(), np.zeros(3)
        for step in self.told["steps"]:
            after, self.guided = np.array([step[key] for key in ("P", "Q", "sigma")]), step["guided"]
            for share in (np.arange(step["increments"]) + 1) / step["increments"]:
                self.loads = before + share * (after - before)
                self.time = solver.AdvanceInTime(self.time)
                self.InitializeSolutionStep()
                solver.Predict()
                converged = solver.SolveSolutionStep()
                self.FinalizeSolutionStep()
                if not converged:
                    return step["name"]
            before = after
            self.tractions.append(self._tractions())
        return None

    def _tractions(self):
        """p, and q of the slave on the master, on the slave's nodes, Pa."""
        p = [-node.GetValue(CSMA.AUGMENTED_NORMAL_CONTACT_PRESSURE) for node in self.slaves]
        q = [0.0] * len(p)
        if self.told["f"]:
            q = [-node.GetValue(CSMA.AUGMENTED_TANGENT_CONTACT_PRESSURE)[0] for node in self.slaves]
        active = np.array([node.Is(KM.ACTIVE) for node in self.slaves])
        return np.array([p, q]) * active * self.stress


def main(told):
    """Solve all steps, write the table, and print unknowns and CPU seconds as JSON."""
    KM.Logger.GetDefaultOutput().SetSeverity(KM.Logger.Severity.WARNING)
    KM.ParallelUtilities.SetNumThreads(1)
    analysis = Analysis(told)
    gave_up = analysis.solve()
    if not gave_up:
        x = np.array([node.X0 for node in analysis.slaves]) * told["a"]
        (p1, q1), (p, q2) = (analysis.tractions[number] for number in told["points"])
        if told["cycle"]:
            shear = np.array([analysis.tractions[number][1] for number in told["cycle"]])
            q1, q2 = shear.min(axis=0), shear.max(axis=0)
        columns = np.column_stack([x, p, p1, q1, q2])[np.argsort(x)]
        np.savetxt(told["table"], columns, "%.12e", ",", header="x,p,p1,q1,q2", comments="")
    unknowns = 2 * analysis.part.NumberOfNodes()
    print(json.dumps({"unknowns": unknowns, "cpu_s": time.process_time(), "gave_up": gave_up}))


if __name__ == "__main__":
    with open(sys.argv[1]) as file:
        main(json.load(file))
