"""Runs in several threads of one process: the same results as one after the other, and the caller's settings left."""

import io
import os
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import meshio
import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import partialslip
from partialslip.halfplane.cauchy import Cauchy
from partialslip.tools.threads import one_thread
from partialslip_fem import Kept
from partialslip_meshes.files import quiet

TWO = os.environ | {"OPENBLAS_NUM_THREADS": "2"}
COARSE = ["fem.accuracy=5e-2", "fem.order=2"]
SETTINGS = [  # of runs: adaptive and not, one body and two, both factors, with and without a closed form
    ["fem.factor=superlu"],
    ["fem.factor=cholmod", "load.sigma=[0, 5e8]", "fem.size=0.2"],
    ["fem.size=0.1"],
    ["friction.f=0.7", "load.Q=[-5e4, 5e4]", "fem.size=0.2"],
    ["fem.size=0.3", "fem.lower_size=0.7"],
]


def solved(settings, keep=None):
    """Everything that a run finds, and what it counts."""
    pytest.importorskip("cvxopt")
    fem = partialslip.run(partialslip.load_scene("hertz-shear", [*COARSE, *settings]), ["fem"], keep=keep).results[
        "fem"
    ]
    traction = fem.traction
    columns = [getattr(traction, key) for key in ("x", "p", "q1", "q2")]
    return [np.array([fem.a, fem.m, fem.n]), *columns], dict(fem.counts)


def same(found, other):
    """Counts alike, and figures to the last bit."""
    return found[1] == other[1] and all(np.array_equal(each, its) for each, its in zip(found[0], other[0], strict=True))


def blas():
    """Threads of those that NumPy and SciPy bring."""
    return [(each["filepath"], each["num_threads"]) for each in threadpool_info() if "scipy" in each["prefix"]]


@pytest.fixture(scope="module")
def alone():
    return [solved(settings) for settings in SETTINGS]


@pytest.mark.parametrize(("threads", "times"), [pytest.param(3, 1), pytest.param(8, 3, marks=pytest.mark.slow)])
def test_as_one_after_the_other(alone, threads, times):
    """Each thread makes the same runs in another order."""

    def all_of_them(thread):
        order = np.roll(np.arange(len(SETTINGS)), thread)
        return [(number, solved(SETTINGS[number])) for number in order]

    with threadpool_limits(3, user_api="blas"):  # more than runs take for themselves
        before = blas()
        for _ in range(times):
            with ThreadPoolExecutor(threads) as pool:
                found = list(pool.map(all_of_them, range(threads)))
            assert all(same(result, alone[number]) for runs in found for number, result in runs)
            assert blas() == before
    assert {number for _, number in before} == {3}


LATE = """
from threadpoolctl import threadpool_info, threadpool_limits
import numpy
from partialslip.tools.threads import one_thread

def threads():
    return {each["num_threads"] for each in threadpool_info() if "scipy" in each["prefix"]}

@one_thread
def inside():
    return threads()

@one_thread
def outside():
    import scipy.linalg
    return inside()

threadpool_limits(2, user_api="blas")
print(outside(), len(threadpool_info()), threads())
"""


def test_a_library_that_is_loaded_within_a_limit_is_limited_too():
    """SciPy's BLAS, which a function around it, or another thread, had not loaded. Rounding may decide on a mesh."""
    done = subprocess.run([sys.executable, "-c", LATE], capture_output=True, text=True, check=True, env=TWO)
    assert done.stdout.split()[0] == "{1}"
    assert done.stdout.split()[-1] == "{2}"


def test_what_is_kept_is_the_thread_s_own(alone):
    """Bodies that are kept change no result, only the count; and another thread has none of them."""
    keep = Kept()
    first, second = (solved(SETTINGS[2], keep) for _ in range(2))
    with ThreadPoolExecutor(1) as pool:
        elsewhere = pool.submit(solved, SETTINGS[2], keep).result()
    assert same(first, alone[2])
    assert same(elsewhere, alone[2])
    assert same((second[0], first[1]), first)
    assert second[-1]["factorizations"] == 0


def test_limits_that_overlap(alone):
    """The first one in comes out before the second one: BLAS stays on one thread until both are out."""
    del alone
    inside, out, seen = threading.Barrier(2, timeout=30), threading.Event(), []

    @one_thread
    def first():
        inside.wait()

    @one_thread
    def second():
        inside.wait()
        out.wait(30)
        seen.append(blas())

    with threadpool_limits(3, user_api="blas"):
        before = blas()
        with ThreadPoolExecutor(2) as pool:
            one, other = pool.submit(first), pool.submit(second)
            one.result()
            out.set()
            other.result()
        assert blas() == before
    assert {threads for _, threads in seen[0]} == {1}


def test_exact_stresses_take_one_thread(monkeypatch):
    """While a scene is solved and when stresses are asked for later; on busy cores several threads only cost."""
    seen = []

    def watch(name):
        integrals = getattr(Cauchy, name)
        monkeypatch.setattr(Cauchy, name, lambda self, z: seen.append(blas()) or integrals(self, z))

    watch("__call__")
    watch("along")
    with threadpool_limits(3, user_api="blas"):
        exact = partialslip.run("hertz-shear", "exact", subsurface=True)["exact"]
        solving = len(seen)
        exact.stress_at([0.0, 1e-3], -1e-3)
    assert 0 < solving < len(seen)
    assert {threads for each in seen for _, threads in each} == {1}


def test_what_other_threads_print_while_a_mesh_is_read(tmp_path, monkeypatch):
    """meshio prints; what it does is kept from the terminal, and only that."""
    out = io.StringIO()
    monkeypatch.setattr(sys, "stdout", out)
    with quiet() as said, ThreadPoolExecutor(1) as pool:
        print("mine")
        pool.submit(print, "theirs").result()
    assert (said.getvalue(), out.getvalue()) == ("mine\n", "theirs\n")
    path = tmp_path / "bad.msh"
    path.write_text("nothing")

    def read(_):
        with pytest.raises(SystemExit), quiet():
            meshio.read(path)

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(read, range(200)))
    assert sys.stdout is out
    assert out.getvalue() == "theirs\n"
