"""Files of measured points that are no single trace along x, of known units and without marks, are refused."""

import numpy as np
import pytest
from refusing import line_of

from partialslip import load_scene

SCENE = """
name = "trace"
material = {E = 72.1e9, nu = 0.33}
friction.f = 0.3
load = {P = 400e3, Q = [-40e3, 40e3]}
[profile]
kind = "tabulated"
file = "pad.csv"
smooth = 200e-6
"""
X = np.linspace(-3e-3, 3e-3, 401)
Z = X**2 / 0.02 + 2e-8 * np.random.default_rng(0).standard_normal(401)


def trace_of(folder, data, keys=""):
    (folder / "pad.csv").write_bytes(data)
    (folder / "job.toml").write_text(SCENE + keys, "utf-8")
    return load_scene(folder / "job.toml").profile


def rows_of(*columns):
    return "".join(",".join(f"{value:.9g}" for value in row) + "\n" for row in zip(*columns, strict=True))


MM = rows_of(X * 1e3, Z * 1e6)
OTHER = rows_of(X * 1e3 + 1e-3, Z * 5e5)
BACK = "".join(reversed(MM.splitlines(keepends=True)))
LINES = OTHER.splitlines(keepends=True)


@pytest.mark.parametrize(("text", "told"), [
    (f"{MM}x [mm],z [um]\n{OTHER}", "2 blocks, block 1 and 2: two traces? keep one, under one heading"),
    (f"{MM}\n\n{OTHER}", "x runs back at line 405, to -2.999: two traces? keep one, in the order of x"),
    (BACK + OTHER, "x runs back at line "),
    (BACK + BACK, "x runs back at line "),
    (MM + "".join(LINES[100:300]), "x runs back at line 403, to -1.499: two traces?"),
    (f"{MM}0.8,250\n", "x runs back at line 403, to 0.8: two traces?"),
])  # fmt: skip
def test_two_traces_in_a_file_are_refused(tmp_path, text, told):
    """As one profile, those of cylinders of 10 and 20 mm were one of 13.3 mm."""
    assert told in line_of(trace_of, tmp_path, f"x [mm],z [um]\n{text}".encode())


def test_a_trace_may_descend_and_step_back_within_the_smoothing_length(tmp_path):
    given = trace_of(tmp_path, f"x [mm],z [um]\n{MM}".encode())
    assert trace_of(tmp_path, f"x [mm],z [um]\n{BACK}".encode()) == given
    whole = trace_of(tmp_path, f"x [mm],z [um]\n{rows_of(X[:399] * 1e3, Z[:399] * 1e6)}".encode())
    order = np.arange(399).reshape(-1, 7)[:, ::-1].ravel()
    stepping = rows_of(X[order] * 1e3, Z[order] * 1e6)
    assert trace_of(tmp_path, f"x [mm],z [um]\n{stepping}".encode()) == whole


@pytest.mark.parametrize(("heading", "along", "y"), [
    ("x [mm],y [mm],z [um]", 600, 800), ("x [mm],y [um],z [um]", 600, 8e5), ("x,y,z", 600, 800), ("x,y,z", 1e3, 1.1),
])  # fmt: skip
def test_a_scan_aslant_is_refused(tmp_path, heading, along, y):
    """R was 3.6 mm, not 10, as x is not the distance along the scan."""
    text = f"{heading}\n{rows_of(X * along, X * y + 7, Z * 1e6)}".encode()
    told = line_of(trace_of, tmp_path, text)
    assert "times the change of x: give the distance along the scan as x" in told


def test_a_scan_along_x_has_one_y(tmp_path):
    """Of a distance along the scan y may be anything."""
    given = trace_of(tmp_path, f"x [mm],z [um]\n{MM}".encode())
    text = f"x [mm],y [mm],z [um]\n{rows_of(X * 1e3, X * 0.9 + 7, Z * 1e6)}"
    assert trace_of(tmp_path, text.encode()).gap == given.gap
    text = f"distance [mm],y [mm],z [um]\n{rows_of(X * 1e3, X * 600, Z * 1e6)}"
    assert trace_of(tmp_path, text.encode()).gap == given.gap


@pytest.mark.parametrize("index", [False, True])
@pytest.mark.parametrize(("line", "word"), [
    ("X scale,1 mm\nZ scale,1 um", "mm"), ("step 1.0 um", "um"), ("Z-Scale: 0.5 um", "um"), ("x_scale 1 mm", "mm"),
    ("Einheit 0.001 mm", "mm"), ("Unit: m", "m"),
])  # fmt: skip
def test_a_scale_above_the_heading_is_no_amount(tmp_path, index, line, word):
    """R was 0.01 mm, not 10, as heights in um were taken for mm."""
    rows = rows_of(np.arange(401), X * 1e3, Z * 1e6) if index else MM
    told = line_of(trace_of, tmp_path, f"{line}\n{'no,x,z' if index else 'x,z'}\n{rows}".encode())
    assert f"unit {word!r} in the heading" in told


@pytest.mark.parametrize(("rows", "value"), [
    (slice(35, None, 50), -9999), (slice(35, 36), 9999), (slice(35, 36), 1e30), (slice(35, None, 5), -9999),
])  # fmt: skip
def test_marks_of_no_data_are_refused(tmp_path, rows, value):
    """Noise of 1.4 mm excused them, and R was 9.4 mm, not 10."""
    heights = Z * 1e6
    heights[rows] = value
    told = line_of(trace_of, tmp_path, f"x [mm],z [um]\n{rows_of(X * 1e3, heights)}".encode())
    assert f"pad.csv: {value:.9g} at line 37: no data? take these rows out" in told


def test_a_rough_surface_is_followed_with_its_noise_given(tmp_path):
    rough = X**2 / 0.02 + 2e-5 * np.random.default_rng(0).standard_normal(401)
    text = f"x [mm],z [um]\n{rows_of(X * 1e3, rough * 1e6)}".encode()
    assert "if the surface is that rough, give profile.noise" in line_of(trace_of, tmp_path, text)
    assert trace_of(tmp_path, text, "noise = 2e-5").measured.noise == 2e-5


def test_points_that_do_not_tell_a_curvature_leak_no_warning(tmp_path, recwarn):
    x = np.append(X[:20] * 1e-12, 1e-3)
    line_of(trace_of, tmp_path, f"x [mm],z [um]\n{rows_of(x * 1e3, Z[:21] * 1e6)}".encode())
    assert not recwarn.list
