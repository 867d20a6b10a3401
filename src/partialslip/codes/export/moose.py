"""Input file and mesh for MOOSE: mortar contact of the contact module, plane strain. Never run by this project."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from partialslip.codes.export.model import Model
from partialslip.codes.export.named_boundaries import Named, heading, named
from partialslip.scene import Scene

_TIE = 1e5  # accuracy: penalty that keeps the frame rigid, in E: its nodes move apart by 1e-5 of P/E at most
_CONTACT = "frictional"  # its multipliers are frictional_normal_lm and frictional_tangential_lm, which score knows


def moose_files(scene: Scene, model: Model, name: str) -> dict[str, bytes]:
    """Files of the deck by name: ``name``.i and ``name``.msh. Parameters and errors as of
    :func:`partialslip.codes.export.named_boundaries.named`."""
    from partialslip_meshes.write import write_quads

    made = named(scene, model, "moose")
    first, second = made.ends
    shear = f", q is -{_CONTACT}_tangential_lm, as MOOSE's tangent on a surface that faces up is -x" if model.f else ""
    notes = (
        "time counts increments; tractions of load points 1 and 2 are in",
        f"{name}_tractions_{first:04d}.csv and {name}_tractions_{second:04d}.csv:",
        f"x, p is {_CONTACT}_normal_lm{shear}",
    )
    lines = [*heading(scene, model, "MOOSE deck", notes), *_input_lines(_tree(made, name))]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "mesh.msh"
        write_quads(path, made.meshes)
        mesh = path.read_bytes()
    return {f"{name}.i": ("\n".join(lines) + "\n").encode(), f"{name}.msh": mesh}


def _input_lines(tree: Mapping[str, Any], indent: str = "") -> Iterator[str]:
    """Lines of blocks ``tree``; texts with blanks are quoted."""
    for key, value in tree.items():
        if isinstance(value, Mapping):
            yield f"{indent}[{key}]"
            yield from _input_lines(value, f"{indent}  ")
            yield f"{indent}[]"
        else:
            yield f"{indent}{key} = '{value}'" if " " in str(value) else f"{indent}{key} = {value}"


def _tree(made: Named, name: str) -> dict[str, Any]:
    model = made.model
    return {
        "GlobalParams": {"displacements": "disp_x disp_y"},
        "Mesh": {
            "bodies": {"type": "FileMeshGenerator", "file": f"{name}.msh"},
            "patch_update_strategy": "always",
            "allow_renumbering": "false",
        },
        "Physics/SolidMechanics/QuasiStatic": {
            "bodies": {
                "block": "lower upper",
                "strain": "SMALL",
                "planar_formulation": "PLANE_STRAIN",
                "add_variables": "true",
            }
        },
        "Materials": _materials(model),
        "Functions": _functions(made),
        "BCs": _boundary_conditions(made),
        "Constraints": {
            f"frame_{axis}": {
                "type": "EqualValueBoundaryConstraint",
                "variable": f"disp_{axis}",
                "secondary": f"upper-{line}",
                "penalty": f"{_TIE * model.parts[1].E:.6e}",
                "formulation": "penalty",
            }
            for axis, line in zip("xy", made.frame, strict=True)
        },
        "Contact": {_CONTACT: _contact_block(model)},
        **_guide(made),
        "VectorPostprocessors": {
            "tractions": {
                "type": "NodalValueSampler",
                "variable": " ".join(f"{_CONTACT}_{kind}_lm" for kind in ("normal", "tangential")[: 1 + bool(model.f)]),
                "boundary": "lower-contact",
                "sort_by": "x",
                "outputs": "ends",
            }
        },
        "Preconditioning": {"full": {"type": "SMP", "full": "true"}},
        "Executioner": {
            "type": "Transient",
            "solve_type": "NEWTON",
            "petsc_options_iname": "-pc_type -pc_factor_shift_type",
            "petsc_options_value": "lu NONZERO",
            "line_search": "none",
            "automatic_scaling": "true",
            "nl_rel_tol": "1e-9",
            "nl_max_its": 50,
            "dt": 1,
            "end_time": made.times[-1],
        },
        "Outputs": {
            "ends": {
                "type": "CSV",
                "file_base": name,
                "sync_times": " ".join(map(str, made.times)),
                "sync_only": "true",
            }
        },
    }


def _materials(model: Model) -> dict[str, Any]:
    elastic = {
        part.name: {
            "type": "ComputeIsotropicElasticityTensor",
            "block": part.name,
            "youngs_modulus": f"{part.E:.12e}",
            "poissons_ratio": f"{part.nu:.12e}",
        }
        for part in model.parts
    }
    return {**elastic, "stress": {"type": "ComputeLinearElasticStress", "block": "lower upper"}}


def _functions(made: Named) -> dict[str, Any]:
    """P, Q and sigma over time, the tractions on the frame, and displacements and tractions of the bulk tension."""
    times = " ".join(map(str, (0, *made.times)))
    loads = {
        name: {"type": "PiecewiseLinear", "x": times, "y": " ".join(f"{value:.12e}" for value in made.load(name))}
        for name in ("P", "Q", "sigma")
    }
    strained = made.model.parts[0].strained.tolist()
    derived = {
        f"frame_{axis}": (load, f"{-1 / made.length(line):.12e} * {load}")
        for axis, load, line in zip("xy", "QP", made.frame, strict=True)
    }
    derived |= {
        f"bulk_{axis}": ("sigma", f"{strain:.12e} * {axis} * sigma")
        for axis, strain in zip("xy", strained, strict=True)
    }
    derived |= {f"pull_{line}": ("sigma", f"{normal:.12e} * sigma") for line, normal in made.pulls.items()}
    return loads | {
        name: {"type": "ParsedFunction", "symbol_names": load, "symbol_values": load, "expression": expression}
        for name, (load, expression) in derived.items()
    }


def _boundary_conditions(made: Named) -> dict[str, Any]:
    held = {
        f"bulk_{axis}": {
            "type": "FunctionDirichletBC",
            "variable": f"disp_{axis}",
            "boundary": " ".join(f"lower-{line}" for line in lines),
            "function": f"bulk_{axis}",
        }
        for axis, lines in zip("xy", made.held, strict=True)
    }
    lines = {f"frame_{axis}": (f"upper-{line}", axis) for axis, line in zip("xy", made.frame, strict=True)}
    lines |= {f"pull_{line}": (f"lower-{line}", "x") for line in made.pulls}
    pressed = {
        name: {"type": "FunctionNeumannBC", "variable": f"disp_{axis}", "boundary": line, "function": name}
        for name, (line, axis) in lines.items()
    }
    guide = {"type": "DirichletBC", "variable": "disp_x", "boundary": f"upper-{made.frame[0]}", "value": 0}
    return held | pressed | {"guide": guide}


def _contact_block(model: Model) -> dict[str, Any]:
    c = f"{model.parts[1].E / model.a:.6e}"  # pressure over gap, as MOOSE's documentation advises
    common = {"primary": "upper-contact", "secondary": "lower-contact", "formulation": "mortar",
              "normalize_c": "true", "c_normal": c}  # fmt: skip
    if not model.f:
        return common | {"model": "frictionless"}
    return common | {"model": "coulomb", "friction_coefficient": f"{model.f:.12e}", "c_tangential": c}


def _guide(made: Named) -> dict[str, Any]:
    """Control that frees the frame after the guided steps, if it is freed."""
    if made.guided == made.times[-1]:
        return {}
    period = {
        "type": "TimePeriod",
        "enable_objects": "BCs::guide",
        "start_time": 0,
        "end_time": made.guided + 0.5,
        "execute_on": "INITIAL TIMESTEP_BEGIN",
    }
    return {"Controls": {"guide": period}}
