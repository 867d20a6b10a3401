"""OpenSees on the two meshed bodies of a model, run by a Python that has OpenSeesPy: run_opensees.py PARAMETERS.json.

Plane quadrilaterals of small strain. Each node of the upper contact line faces a node of the lower one. The pair has an
element SimpleContact2D, which closes the gap with a Lagrange multiplier, and whose ContactMaterial2D has Coulomb
friction with a stiffness of sticking. The element is made for a node on a segment. Here the segment has two nodes of
its own, which are tied to the lower node. The element finds out only at the end of an increment whether points touch.
Therefore each increment is repeated under the same loads until the multipliers rest. Friction acts when the upper body
is no longer guided. Lengths are in a, and stresses in E of the lower body.

PARAMETERS, in SI units: a; f; bodies lower and upper: points, quads, contact (edges), E, nu; held (nodes along x, and
along y) of both; pull (forces on the lower body's nodes of a unit tension); strained (strains of a unit tension); steps
(name, P, Q, sigma, increments, guided); points, numbers of the steps of load points 1 and 2; cycle, of those whose
least and largest shear q1 and q2 are; element, quad or bbarQuad; sticking, the stiffness of sticking, E/a; table, the
file to write.
"""

import json
import os
import sys

import numpy as np
import openseespy.opensees as ops

_ITERATIONS = 15  # limit: of Newton's method
_RESIDUAL = 1e-9  # accuracy: norm of the forces that are out of balance, in E a; 1e-10 is not always reached
_BISECTIONS = 8  # limit: of an increment that does not converge
_GUIDE = 1e4  # accuracy: stiffness of a spring that guides the upper body, in E; a tied node cannot be held as well
_REPEATS = 20  # limit: of an increment until the multipliers rest
_REST = 1e-5  # accuracy: change of a multiplier, in the largest
_ALGORITHMS = ("Newton",), ("NewtonLineSearch", "-type", "Bisection")
_LOADS = ("P", "Q", "sigma")


class TwoBodies:
    """The bodies, their contact, and their loads."""

    def __init__(self, told):
        self.told, self.E = told, told["bodies"]["lower"]["E"]
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 2)
        self.nodes = self.elements = 0
        bodies = [self._body(number, body) for number, body in enumerate(told["bodies"].values(), 1)]
        (self.lower, self.x, near), (self.upper, _, _) = bodies
        self.near = near
        self.share = np.gradient(self.x)
        self.share[[0, -1]] /= 2
        self._held()
        self._contact()
        self._loads()

    def _body(self, number, body):
        """Add a body; return the tag of its first node, x of its contact line, and the elements there."""
        first, a = self.nodes + 1, self.told["a"]
        points, quads = np.array(body["points"]) / a, np.array(body["quads"])
        ops.nDMaterial("ElasticIsotropic", number, body["E"] / self.E, body["nu"])
        for x, y in points.tolist():
            self.nodes += 1
            ops.node(self.nodes, x, y)
        line = np.unique(body["contact"])
        line = line[np.argsort(points[line, 0])]
        place, near = {int(node): k for k, node in enumerate(line)}, []
        for quad in quads.tolist():
            self.elements += 1
            kind = ("PlaneStrain", number) if self.told["element"] == "quad" else (number,)
            ops.element(self.told["element"], self.elements, *(first + node for node in quad), 1.0, *kind)
            near += [(self.elements, corner, place[node]) for corner, node in enumerate(quad) if node in place]
        body["line"] = (first + line).tolist()
        return first, points[line, 0], near

    def _held(self):
        """Tie the upper body's frame, whose first nodes carry the loads."""
        held = [{self.upper + node for node in nodes} for nodes in self.told["held"]["upper"]]
        self.frame = [min(held[0] & held[1] or nodes) for nodes in held]
        for node in held[0] | held[1]:  # in one tie: the handler Transformation drops a second one
            components = [k for k in (0, 1) if node in held[k] and node != self.frame[k]]
            if components:
                ops.equalDOF(self.frame[components[0]], node, *(k + 1 for k in components))
        ops.uniaxialMaterial("Elastic", 1, _GUIDE)
        self.guides = {}  # elements by direction

    def _contact(self):
        """Add an element of contact for each pair of nodes."""
        lower, upper = (self.told["bodies"][name]["line"] for name in ("lower", "upper"))
        self.multipliers = []
        for k, (below, above) in enumerate(zip(lower, upper, strict=True)):
            x, y = ops.nodeCoord(below)
            ends, multiplier = (self.nodes + 1, self.nodes + 2), self.nodes + 3
            self.nodes, self.elements = multiplier, self.elements + 1
            for node, along in zip((*ends, multiplier), (-0.5, 0.5, 0.0), strict=True):
                ops.node(node, x + along, y)
            for node in ends:
                ops.equalDOF(below, node, 1, 2)
            stiffness = self.told["sticking"] * self.share[k]
            ops.nDMaterial("ContactMaterial2D", 10 + k, self.told["f"], stiffness, 0.0, 0.0)
            ops.element("SimpleContact2D", self.elements, *ends, above, multiplier, 10 + k, 1e-12, 1e-12)
            ops.parameter(1 + k, "element", self.elements, "friction")
            self.multipliers.append(multiplier)

    def _loads(self):
        """Loads over the number of the increment."""
        told, before = self.told, np.zeros(3)
        loads = [before]
        for step in told["steps"]:
            after = np.array([step[key] for key in _LOADS])
            shares = (np.arange(step["increments"]) + 1) / step["increments"]
            loads += list(before + shares[:, None] * (after - before))
            before = after
        loads = np.array(loads) / self.E / [told["a"], told["a"], 1.0]
        pulled, strains = np.array(told["pull"]) / told["a"], np.array(told["strained"]) * self.E
        for number, values in enumerate(loads.T.tolist(), 1):
            ops.timeSeries("Path", number, "-time", *map(float, range(len(loads))), "-values", *values)
            ops.pattern("Plain", number, number)
            if number == 1:
                ops.load(self.frame[1], 0.0, -1.0)
            elif number == 2:
                ops.load(self.frame[0], -1.0, 0.0)
            else:
                for node in np.flatnonzero(pulled).tolist():
                    ops.load(self.lower + node, float(pulled[node]), 0.0)
                for component, nodes in enumerate(told["held"]["lower"]):
                    for node in nodes:
                        place = ops.nodeCoord(self.lower + node)[component]
                        ops.sp(self.lower + node, component + 1, float(place * strains[component]))

    def guide(self, components):
        """Hold the upper body's frame along ``components`` alone; friction acts if it is free along x."""
        for component in set(self.guides) - components:
            ops.remove("element", self.guides.pop(component))
        for component in components - set(self.guides):
            node = self.frame[component - 1]
            self.nodes, self.elements = self.nodes + 1, self.elements + 1
            ops.node(self.nodes, *ops.nodeCoord(node))
            ops.fix(self.nodes, 1, 1)
            ops.element("zeroLength", self.elements, node, self.nodes, "-mat", 1, "-dir", component)
            self.guides[component] = self.elements
        for k in range(len(self.x)):
            ops.updateParameter(1 + k, float(1 not in components))
        ops.wipeAnalysis()
        ops.constraints("Transformation")
        ops.numberer("RCM")
        ops.system("UmfPack")
        ops.test("NormUnbalance", _RESIDUAL, _ITERATIONS, 0)
        ops.algorithm("Newton")
        ops.integrator("LoadControl", 0.0)
        ops.analysis("Static")

    def solve(self):
        """Go through all steps; the name of the step that does not converge, or None, and tractions after each."""
        self.guide({1, 2})
        tractions = []
        if ops.analyze(1):  # the elements find out where the bodies overlap
            return "touch", tractions
        for step in self.told["steps"]:
            components = {1} if step["guided"] else set()
            if components != set(self.guides):
                self.guide(components)
            for _ in range(step["increments"]):
                if not self.advance(1.0, _BISECTIONS):
                    return step["name"], tractions
            tractions.append(self.tractions())
        return None, tractions

    def advance(self, share, bisections):
        """Solve the next ``share`` of an increment, in halves where that does not converge. Whether it did."""
        ops.integrator("LoadControl", share)
        if self.fails():
            return bool(bisections) and all(self.advance(share / 2, bisections - 1) for _ in range(2))
        ops.integrator("LoadControl", 0.0)
        before = self.pressed()
        for _ in range(_REPEATS):
            if self.fails():
                return False
            now = self.pressed()
            if np.abs(now - before).max() <= _REST * np.abs(now).max():
                return True
            before = now
        return False

    def fails(self):
        """Solve by one of the algorithms; whether none converges."""
        for algorithm in _ALGORITHMS:
            ops.algorithm(*algorithm)
            if not ops.analyze(1):
                return False
        return True

    def pressed(self):
        """Multipliers."""
        return np.array([ops.nodeDisp(node, 1) for node in self.multipliers])

    def tractions(self):
        """p, and q of the lower body on the upper one, on the lower body's nodes, Pa: forces on the elements."""
        forces = np.zeros((len(self.x), 2))
        for element, corner, k in self.near:
            forces[k] += ops.eleResponse(element, "force")[2 * corner : 2 * corner + 2]
        return (-forces[:, ::-1] / self.share[:, None] * self.E).T


def main(told):
    """Solve all steps, write the table, and print the unknowns as JSON."""
    bodies = TwoBodies(told)
    gave_up, tractions = bodies.solve()
    if not gave_up:
        (p1, q1), (p, q2) = (tractions[number] for number in told["points"])
        if told["cycle"]:
            shear = np.array([tractions[number][1] for number in told["cycle"]])
            q1, q2 = shear.min(axis=0), shear.max(axis=0)
        columns = np.column_stack([bodies.x * told["a"], p, p1, q1, q2])
        np.savetxt(told["table"], columns, "%.12e", ",", header="x,p,p1,q1,q2", comments="")
    print(json.dumps({"unknowns": ops.systemSize(), "gave_up": gave_up}), flush=True)
    os._exit(0)  # OpenSees prints a line when it ends


if __name__ == "__main__":
    with open(sys.argv[1]) as file:
        main(json.load(file))
