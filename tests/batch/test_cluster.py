"""Sweeps on a Dask cluster: what a worker, a scheduler or a package that is missing does."""

import json
import logging
import os
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest

import partialslip
from partialslip.study.batch.cluster import _silence
from partialslip.study.batch.job import Job
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import work_through, workers


@contextmanager
def cluster(folder, name, environment=None):
    """Address of a scheduler, its process, and those of its two workers."""
    file, quiet = folder / f"{name}.json", {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}

    def start(what, *options, env=None):
        command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--scheduler-file", str(file), *options]
        return subprocess.Popen(command, cwd=folder, env=env, **quiet)

    scheduler = start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    settings = "--no-nanny", "--nthreads", "1", "--no-dashboard", "--local-directory", str(folder)
    crew = [start("worker", *settings, env=environment) for _ in range(2)]
    try:
        for _ in range(2400):
            if file.exists() and file.read_text():
                break
            time.sleep(0.05)
        yield json.loads(file.read_text())["address"], scheduler, crew
    finally:
        for process in (*crew, scheduler):
            process.kill()
            process.wait()


@pytest.mark.slow
def test_a_dask_cluster_goes_on_where_a_worker_is_killed(tmp_path):
    pytest.importorskip("distributed")
    cases = [Job(partialslip.load_scene("hertz-shear"), ("exact",), {"number": number}) for number in range(40)]
    ledger, done = Ledger(tmp_path / "ledger.jsonl"), []
    with cluster(tmp_path, "one") as (address, _, crew):

        def kill(count, *_):
            done.append(count)
            if count == 10:
                crew[0].kill()

        with workers(address) as executor:
            work_through([case.task for case in cases], ledger, executor, kill)
    assert done == list(range(41))
    assert {entry["labels"]["number"] for entry in ledger} == set(range(40))
    assert len(ledger.path.read_text().splitlines()) == 40  # nothing twice


@pytest.mark.parametrize(
    "address",
    ["tcp://127.0.0.1:9", "127.0.0.1:9", "nonsense", "", "tcp://", "http://127.0.0.1:9", "tcp://127.0.0.1:99999"],
)
def test_no_scheduler_is_one_line(address):
    """At once, without messages of Dask."""
    pytest.importorskip("distributed")
    with pytest.raises(partialslip.InputError, match="--cluster"), workers(address):
        pass


@pytest.mark.parametrize("name", ["distributed", "distributed.client", "tornado.application", "asyncio"])
def test_no_logger_of_dask_speaks_meanwhile(name):
    """Also a logger with a level of its own, as Dask sets for some."""
    pytest.importorskip("distributed")
    logger = logging.getLogger(name)
    level = logger.level
    speak = _silence()
    assert not logger.isEnabledFor(logging.CRITICAL)
    speak()
    assert logger.level == level


SWEEP = """
import sys
from pathlib import Path
from partialslip import load_scene
from partialslip.cli.ending import ended
from partialslip.study.batch.job import Job
from partialslip.study.batch.ledger import Ledger
from partialslip.study.batch.sweep import work_through, workers
def main():
    tasks = [Job(load_scene("hertz-shear"), ("exact",), {"number": n}).task for n in range(int(sys.argv[3]))]
    with workers(sys.argv[1]) as executor:
        work_through(tasks, Ledger(Path(sys.argv[2])), executor, lambda done, *_: print(done, flush=True))
    return 0
sys.exit(ended(main))
"""


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["scheduler killed", "no package"])
def test_what_a_cluster_lacks_is_one_line(tmp_path, fault):
    """The sweep continues with another cluster."""
    pytest.importorskip("distributed")
    (tmp_path / "bare" / "partialslip").mkdir(parents=True)
    (tmp_path / "bare" / "partialslip" / "__init__.py").write_text("raise ImportError('none here')\n", "utf-8")
    bare = {**os.environ, "PYTHONPATH": str(tmp_path / "bare")}
    count = 60

    def attempt(fault):
        with cluster(tmp_path, fault, bare if fault == "no package" else None) as (address, scheduler, _):
            work = [sys.executable, "-c", SWEEP, address, str(tmp_path / "ledger.jsonl"), str(count)]
            study = subprocess.Popen(work, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            if fault == "scheduler killed":
                next(line for line in study.stdout if line == "5\n")
                scheduler.kill()
            _, said = study.communicate(timeout=300)
        return study.returncode, said

    code, said = attempt(fault)
    assert code == 2
    assert said.startswith("partialslip: --cluster ")
    assert said.count("\n") == 1
    assert attempt("none") == (0, "")
    assert len((tmp_path / "ledger.jsonl").read_text("utf-8").splitlines()) == count
