"""The load steps of all meshes: chosen on the first mesh that is fine enough, and checked on the last one."""

from dataclasses import replace

from partialslip.friction.step_errors import more_steps, steps_matter
from partialslip.result import Clock
from partialslip_fem import solving
from partialslip_fem.mesh_solution import MeshSolution
from partialslip_fem.problem import ScaledProblem


class LoadSteps:
    """The ``problem`` with the load steps of all meshes to come, whether these are ``chosen``, and the linear solves
    that they took (``iterations``)."""

    def __init__(self, problem: ScaledProblem, clock: Clock) -> None:
        self.problem, self.clock = problem, clock
        self.chosen, self.iterations = False, 0

    def on_mesh(self, solution: MeshSolution, before: MeshSolution, choose: bool) -> MeshSolution:
        """The ``solution`` with the errors of its load steps: of those that are chosen on its mesh, if it is to
        ``choose`` them, otherwise of those that were chosen on meshes ``before``."""
        if choose:
            self._keep(solution)
            solution = self._enough(solution)
        if not (solution.coupled or (choose and self.chosen)):
            solution = replace(solution, step_errors=before.step_errors)
        if not solution.path_errors:
            solution = replace(solution, path_errors=before.path_errors, path_moves=before.path_moves)
        return solution

    def checked(self, solution: MeshSolution) -> MeshSolution:
        """Check the load steps on the mesh of ``solution`` and estimate their errors anew, where steps matter: the mesh
        on which they were chosen saw less of a stick zone that moves while the loads change. Those of coupled bodies
        may be too few as soon as the errors of pressing have fallen below theirs."""
        if solution.coupled:
            return self._enough(solution)
        return self._again(solution) if steps_matter(solution.step_errors, self.problem.accuracy) else solution

    def _keep(self, solution: MeshSolution) -> None:
        if solution.history and (solution.coupled or solution.enclosed):
            self.problem = replace(self.problem, path=replace(solution.history.path, before=None))
            self.chosen = True

    def _enough(self, solution: MeshSolution) -> MeshSolution:
        """The solution in as many load steps of coupled bodies as their errors and the CPU seconds left call for."""
        while path := self.problem.path:
            more = more_steps(path, solution.path_errors, solution.step_errors, self.problem.accuracy)
            if not more or self.clock.remaining() <= 0:
                break
            self.problem = replace(self.problem, path=more)
            solution = self._again(solution)
            self._keep(solution)
        return solution

    def _again(self, before: MeshSolution) -> MeshSolution:
        """Solve contact and friction once more on the mesh ``before``, and check the load steps."""
        found = solving.solve_contact(self.problem, before.bodies, 0, self.clock, True, before=before)
        self.iterations += found.iterations
        return found
