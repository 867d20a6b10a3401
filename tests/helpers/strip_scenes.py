"""Scenes of two equal strips, a = 0.2 mm under P alone."""

from partialslip.scene.reading import parse_scene

A = 0.2e-3
P = 135.75e3


def strips(h, Q=(-30e3, 30e3), sigma=(0.0, 0.0), width="infinite", accuracy=1e-4, lower=None, **load):
    """Strips of height ``h``, m; pulled if ``sigma`` is given."""
    body = {"width": width, "height": h, "support": "roller"}
    grip = {"pulled": True, "right_grip": 0.5 if width == "infinite" else "stiffness"} if any(sigma) else {}
    return parse_scene(
        {
            "name": "strips",
            "material": {"E": 72.1e9, "nu": 0.33},
            "profile": {"kind": "hertz", "R": 10e-3},
            "friction": {"f": 0.3},
            "load": {"P": P, "Q": list(Q), "sigma": list(sigma)} | load,
            "bodies": {"upper": body, "lower": body | grip | (lower or {})},
            "fem": {"accuracy": accuracy},
        }
    )
