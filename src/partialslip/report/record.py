"""A run as plain data: what ``results.json`` holds."""

import math
import platform
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

import msgspec
import numpy as np

from partialslip.judge import Comparison
from partialslip.result import Result
from partialslip.run import Run

SCHEMA = "partialslip/result/2"
_PACKAGES = ("partialslip", "numpy", "scipy", "scikit-fem", "gmsh", "meshio")


def record(run: Run, *, curves: bool = True) -> dict[str, Any]:
    """Everything that ``run`` found, as numbers, strings, lists and tables; SI units; with ``curves``, or without."""
    data = {
        "schema": SCHEMA,
        "outcome": run.outcome,
        "reference": run.reference,
        "missed": list(run.missed),
        "scene": msgspec.to_builtins(run.scene),
        "plan": {
            "called_for": list(run.plan.called_for),
            "left_out": list(run.plan.left_out),
            "missing": list(run.plan.missing),
            "reasons": {**run.plan.called_for, **run.plan.left_out},
        },
        "methods": {name: _method(result, curves) for name, result in run.results.items()},
        "comparison": {name: _comparison(comparison) for name, comparison in run.comparisons.items()},
        "versions": versions(),
    }
    return _finite(data)  # type: ignore[no-any-return]


def versions() -> dict[str, str]:
    """Versions of what the figures depend on."""
    return {"python": platform.python_version(), **{package: version(package) for package in _PACKAGES}}


def _method(result: Result, curves: bool) -> dict[str, Any]:
    return _figures(result) | (_curves(result) if curves else {})


def _figures(result: Result) -> dict[str, Any]:
    return {
        **{key: getattr(result, key) for key in ("a", "p0", "regime", "m", "n", "stick_half_width", "stick_centre")},
        "p_max": result.traction.p_max,
        **{key: result.counts[key] for key in ("dofs", "contact_nodes") if key in result.counts},
        "contact_ends": [list(ends) for ends in result.ends],
        **{key: dict(getattr(result, key)) for key in ("settings", "counts", "limits", "certificate", "estimate")},
        "shares": {source: dict(shares) for source, shares in result.shares.items()},
        "undetermined": dict(result.undetermined),
        "path_dependent": result.path_dependent,
        "notes": list(result.notes),
        "cost": asdict(result.cost),
    }


def _curves(result: Result) -> dict[str, Any]:
    return {
        "slip": {"x": result.slip.x.tolist(), "slip": result.slip.slip.tolist(), "dissipated": result.slip.dissipated}
        if result.slip
        else None,
        "surface": {"x": result.surface.x.tolist(), "sigma_xx": result.surface.sigma.tolist()}
        if result.surface
        else None,
        "traction": {key: _listed(column) for key, column in result.columns.items() if key != "x_over_a"},
    }


def _comparison(comparison: Comparison) -> dict[str, Any]:
    """The errors by quantity, bars, what is missed, and the verdicts that they are from."""
    nodal = ("p_nodal", "q_nodal", "p_nodal_max", "q_nodal_max")
    return {
        "outcome": comparison.outcome,
        **comparison.errors,
        **{key: getattr(comparison, key) for key in nodal},
        "bars": comparison.bars,
        "missed": list(comparison.missed),
        "verdicts": [verdict.data for verdict in comparison.verdicts],
        "conditions": [verdict.data for verdict in comparison.conditions],
    }


def _finite(data: Any) -> Any:
    """Plain data with null for numbers that are NaN or infinite, which JSON does not have."""
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data


def _listed(values: np.ndarray | None) -> list[float] | None:
    return None if values is None else values.tolist()
