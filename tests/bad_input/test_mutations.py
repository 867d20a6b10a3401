"""Scenes and tables that were spoiled at random, in processes whose time and memory are limited.

PARTIALSLIP_FUZZ=N draws N times as many as are run always, and PARTIALSLIP_SEED=S others.
"""

import contextlib
import io
import json
import multiprocessing
import os
import traceback
from pathlib import Path

import numpy as np
import pytest

from partialslip.cli import main
from partialslip.scene.reading import shipped_scenes

resource = pytest.importorskip("resource")

TIMES = int(os.environ.get("PARTIALSLIP_FUZZ", "1"))
SEED = int(os.environ.get("PARTIALSLIP_SEED", "0"))
SECONDS, BYTES = 60, 2 * 2**30
BATCH = 25
COUNTS = {"exact": 50, "fem": 3, "score": 5}

SCENES = Path(__file__).parents[2] / "src" / "partialslip" / "scene" / "shipped"
NUMBERS = [
    "0",
    "-0.0",
    "1",
    "-1",
    "1e-100",
    "1e100",
    "1e-30",
    "1e30",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "0x" + "f" * 4000,
    "9" * 5000,
    "true",
    "1e-3",
    "0.5",
    "3",
    "1000",
    "2e-5",
    "0.4999999",
    "1979-05-27",
    "1_000",
    "0b1",
]
WORDS = [
    "''",
    "'x'",
    '"\\u202e"',
    '"\\u0085"',
    '"\\U0010ffff"',
    '"µ ΔQ"',
    "'" + "x" * 5000 + "'",
    "[]",
    "[1]",
    "{}",
    "[[1, 2], [3]]",
    "[1e5, -1e5]",
    "[0, 0]",
    "[-1e4, 2e4, 0]",
    "[" + "1," * 2000 + "]",
    "[" * 200 + "]" * 200,
    '"half-plane"',
    '"box"',
    '"hertz"',
    '"tabulated"',
    '"stress"',
    "{E = 1e9, nu = 0.3}",
]
KEYS = [
    "name",
    "title",
    "material.E",
    "material.nu",
    "material.plane",
    "material.upper",
    "profile.kind",
    "profile.R",
    "profile.b",
    "profile.x",
    "profile.gap",
    "friction.f",
    "load.P",
    "load.p0",
    "load.a",
    "load.Q",
    "load.sigma",
    "load.cycles",
    "load.steps",
    "fem.accuracy",
    "fem.order",
    "fem.size",
    "fem.far_field",
    "fem.width",
    "bodies.upper.width",
    "bodies.lower.mesh",
    "effects.friction",
    "effects.coupling",
    ".".join("a" * 900),
    "x" * 5000,
    "\u202e",
    "a b",
    "E",
]


def mutated(random):
    """A scene file's bytes, and settings: a shipped scene with some of its lines, bytes and numbers changed."""
    names = sorted(shipped_scenes())
    text = (SCENES / f"{names[random.integers(len(names))]}.toml").read_text("utf-8")
    settings = []
    for _ in range(random.integers(1, 4)):
        way, lines = random.integers(7), text.splitlines()
        place = int(random.integers(len(lines)))
        value = [NUMBERS, WORDS][random.integers(2)]
        value = value[random.integers(len(value))]
        if way == 0:
            del lines[place]
        elif way == 1:
            lines.insert(place, lines[random.integers(len(lines))])
        elif way == 2 and "=" in lines[place]:
            lines[place] = f"{lines[place].partition('=')[0]}= {value}"
        elif way == 3:
            lines.insert(place, f"{KEYS[random.integers(len(KEYS))].rpartition('.')[2]} = {value}")
        elif way == 4:
            settings.append(f"{KEYS[random.integers(len(KEYS))]}={value}")
        elif way == 5:
            at = int(random.integers(len(text)))
            text = text[:at] + chr(random.integers(0x250)) + text[at + int(random.integers(4)) :]
            continue
        else:  # a sound scene, of other numbers
            key = ["material.E", "profile.R", "friction.f", "load.Q", "load.sigma"][random.integers(5)]
            number = 10.0 ** random.uniform(-12, 12)
            settings.append(f"{key}={[-number, number] if key in ('load.Q', 'load.sigma') else number}")
        text = "\n".join(lines) + "\n"
    return text.encode("utf-8", "surrogatepass"), settings


def table(random):
    """A table to score as bytes: the tractions of a contact with words, lines and numbers changed."""
    x = np.linspace(-1.1e-3, 1.1e-3, int(random.integers(5, 80)))
    p = 4e8 * np.sqrt(np.maximum(1 - (x / 1e-3) ** 2, 0))
    rows = [["x", "p", "dq"], *([repr(each) for each in row] for row in np.column_stack([x, p, p / 4]).tolist())]
    for _ in range(random.integers(1, 4)):
        row = int(random.integers(len(rows)))
        words = [*NUMBERS, "", "a", "1,5", "1;2", "\x00", "é", "1e5 Pa", "#", '"']
        word = words[random.integers(len(words))]
        ways = [
            lambda row=row: rows.pop(row),
            lambda row=row: rows.insert(row, rows[row]),
            lambda row=row, word=word: rows[row].append(word),
            lambda row=row, word=word: rows.__setitem__(row, [*rows[row][:1], word, *rows[row][2:]]),
            lambda row=row: rows.__setitem__(row, rows[row][:-1]),
        ]
        if len(rows) > 1:
            ways[random.integers(len(ways))]()
    text = "\n".join(",".join(row) for row in rows) + "\n"
    if random.integers(6) == 0:
        text = text.replace(",", [";", "\t", " "][random.integers(3)])
    return text.encode(["utf-8", "utf-16", "latin-1"][random.integers(3)] if random.integers(8) == 0 else "utf-8")


def arguments(kind, random, folder):
    """Write the file of a ``kind``; return the command line that reads it."""
    if kind == "score":
        (folder / "t.csv").write_bytes(table(random))
        return ["score", "hertz-shear", "t.csv", "--json"]
    content, settings = mutated(random)
    (folder / "t.toml").write_bytes(content)
    coarse = ["--set", "fem.accuracy=0.03"] if kind == "fem" else []
    words = [word for setting in settings for word in ("--set", setting)]
    return ["run", "t.toml", "--with", kind, "--json", *coarse, *words]


def wrong(code, out, err):
    """Fault in the end of a command, if any."""
    if code == 2:
        lines = err.splitlines()
        if out or len(lines) != 1 or not lines[0].startswith("partialslip: ") or not lines[0].isprintable():
            return "not refused in one line"
        return None if len(err) < 2000 else "a long line"
    if code not in (0, 1) or err:
        return "neither done nor refused"
    try:
        json.loads(out, parse_constant=_no_number)
    except ValueError:
        return "no JSON"
    return None


def _no_number(name):
    raise ValueError(name)


def batch(kind, numbers, folder, end):
    """Call ``main`` for each of ``numbers`` within limits; send the number before, and exit code and fault after."""
    resource.setrlimit(resource.RLIMIT_AS, (BYTES + _mapped(), BYTES + _mapped()))
    os.chdir(folder)
    for number in numbers:
        called = arguments(kind, np.random.default_rng([SEED, number, len(kind)]), folder)
        used = resource.getrusage(resource.RUSAGE_SELF)
        spent = used.ru_utime + used.ru_stime
        resource.setrlimit(resource.RLIMIT_CPU, (int(spent) + SECONDS, resource.RLIM_INFINITY))
        end.send((number, None, None))
        out, err = io.StringIO(), io.StringIO()
        fault = None
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                code = main(called)
            except BaseException:
                code, fault = None, traceback.format_exc()
        seen = fault or wrong(code, out.getvalue(), err.getvalue())
        end.send((number, code, seen and f"{seen}: {called}: {err.getvalue()[:500]}"))
    end.close()


def _mapped():
    """Bytes of memory that this process has mapped already: libraries, not data."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def ends(kind, numbers, folder):
    """Exit codes and faults by number, from processes of BATCH calls each."""
    codes, faults, left = {}, {}, list(numbers)
    context = multiprocessing.get_context("fork")
    while left:
        receiving, sending = context.Pipe(duplex=False)
        process = context.Process(target=batch, args=(kind, left[:BATCH], folder, sending))
        process.start()
        sending.close()
        at, open_ = None, True
        while open_:
            try:
                at, code, fault = receiving.recv()
            except EOFError:
                open_ = False
                continue
            if code is not None or fault is not None:
                codes[at] = code
                left.remove(at)
                if fault:
                    faults[at] = fault
        process.join()
        if at in left:  # it began and did not end
            faults[at] = f"the process ended with {process.exitcode}: beyond {SECONDS} CPU s or {BYTES} bytes"
            left.remove(at)
        elif process.exitcode != 0:
            raise AssertionError(f"a process of the fuzzer ended with {process.exitcode}")
    return codes, faults


@pytest.mark.slow
@pytest.mark.parametrize("kind", COUNTS)
def test_mutations(tmp_path, kind):
    """No traceback, no other exit code, and nothing beyond the limits."""
    count = COUNTS[kind] * TIMES
    codes, faults = ends(kind, range(count), tmp_path)
    print({code: list(codes.values()).count(code) for code in set(codes.values())})
    assert faults == {}
    assert len(codes) == count


@pytest.mark.parametrize("number", [each for each in range(26) if each != 13])  # 13 takes five seconds
def test_some_mutations(tmp_path, monkeypatch, capsys, number):
    """The same without processes of their own: always run."""
    monkeypatch.chdir(tmp_path)
    code = main(arguments("exact", np.random.default_rng([SEED + 1, number, 5]), tmp_path))
    assert wrong(code, *capsys.readouterr()) is None


def test_what_is_wrong_is_seen():
    """Deliberate faults: a traceback, a wrong exit code, two lines, no JSON."""
    assert wrong(0, "{}", "") is None
    assert wrong(2, "", "partialslip: E = -1: must be > 0\n") is None
    faults = [
        (3, "", "partialslip: a fault\n"),
        (2, "", "Traceback\n"),
        (2, "{}", "partialslip: x\n"),
        (0, "", ""),
        (0, '{"a": NaN}', ""),
        (0, "{}", "warning\n"),
        (2, "", "partialslip: x\n\n"),
        (1, "half {", ""),
    ]
    for end in faults:
        assert wrong(*end)
