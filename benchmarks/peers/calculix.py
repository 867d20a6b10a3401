"""CalculiX on an exported deck."""

from setting import Setting

from partialslip.export import export
from partialslip.export.model import modelled

_MORTAR, _PENALTY = "C3D8, mortar", "C3D8, surface-to-surface penalty"
_UNIFORM = ((0.1, 0.2), (0.05, 0.2), (0.025, 0.2), (0.0125, 0.1))
SETTINGS = (
    *(Setting(_MORTAR, size, growth, None, False) for size, growth in _UNIFORM),
    Setting(f"{_MORTAR}, graded to the ends", 0.05, 0.1, 0.01, False),
    Setting(_PENALTY, 0.025, 0.2, None, True),
)


def run(scene, setting, ends, stiffer, folder, ccx, measured):
    """Results, factors that make them SI, unknowns and costs."""
    how = {"size": setting.size, "growth": setting.growth, "stiffer": stiffer, "ends": ends, "fine": setting.fine}
    export(scene, "calculix", **how, penalty=setting.option)(folder / "peer.inp")
    made = modelled(scene, **how)
    text, cost = measured([ccx, "peer"], folder)
    if "Job finished" not in text:
        raise RuntimeError(f"CalculiX gave up: {text.strip()[-300:]}")
    dofs = sum(4 * (len(part.mesh.points) - len(part.outer)) for part in made.parts) + 2  # two sheets of nodes
    return folder / "peer.frd", (1.0, 1.0, 1.0), dofs, {"cpu_s": cost["process_cpu_s"]} | cost
