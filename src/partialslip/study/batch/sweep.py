"""Solve many cases in parallel, on this machine or a Dask cluster, and add each finished case to a ledger."""

import itertools
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import resource_tracker
from queue import Empty, SimpleQueue
from types import ModuleType
from typing import Any, NamedTuple

from partialslip.study.batch.cluster import Cluster, dask
from partialslip.study.batch.ledger import Ledger
from partialslip.tools.errors import PartialslipError

SweepProgress = Callable[[int, int, float], None]
_PULSE = 2.0  # cost: s between checks of a cluster
_AHEAD = 256  # cost: largest number of submitted tasks: more than a cluster has workers, few enough for the memory


class Task(NamedTuple):
    """A picklable task of a sweep: ``do(argument)`` returns the entry of the ledger under ``key``
    (:meth:`partialslip.study.batch.ledger.Ledger.add`)."""

    key: str
    do: Callable[[Any], object]
    argument: Any


def work_through(
    tasks: Collection[Task], ledger: Ledger, executor: Executor, progress: SweepProgress = lambda *_: None
) -> None:
    """Do the ``tasks`` that are not in the ``ledger``, and add the outcomes in the order of completion.

    Parameters
    ----------
    tasks : collection of Task
    ledger : Ledger
    executor : Executor
    progress : callable
        ``progress(done, total, seconds_left)``; the seconds left are extrapolated.

    Raises
    ------
    PartialslipError
        If a worker process dies; finished tasks are kept.
    """
    to_do = {task.key: task for task in tasks if task.key not in ledger}
    added = itertools.count(1)
    total = len({task.key for task in tasks})
    known, began = total - len(to_do), time.monotonic()
    at_work: dict[Future[object], str] = {}
    finished: SimpleQueue[Future[object]] = SimpleQueue()

    def keep() -> None:
        future = _next(finished, executor)
        ledger.add(at_work[future], future.result())
        del at_work[future]
        done = next(added)
        progress(known + done, total, (time.monotonic() - began) / done * (len(to_do) - done))

    progress(known, total, float("nan"))
    try:
        for task in to_do.values():
            future = executor.submit(task.do, task.argument)
            at_work[future] = task.key
            future.add_done_callback(finished.put)
            while len(at_work) >= _AHEAD or not finished.empty():
                keep()
        while at_work:
            keep()
    except BrokenProcessPool:
        raise PartialslipError("a worker process died, perhaps for lack of memory; run it again to go on") from None
    finally:
        for future in at_work:
            future.cancel()


def _next(finished: "SimpleQueue[Future[Any]]", executor: Executor) -> "Future[Any]":
    """Return the next finished future. Meanwhile check that a cluster still has workers."""
    while True:
        try:
            return finished.get(timeout=_PULSE if isinstance(executor, Cluster) else None)
        except Empty:
            executor.check()  # type: ignore[attr-defined]


class _Processes(ProcessPoolExecutor):
    """Pool of processes that do not import the script of the parent process again.

    A script can then use a pool without ``if __name__ == "__main__"``. The tasks are functions of modules.
    """

    def submit(self, do: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        script = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")  # where processes, which start here, look for a script
        try:
            return super().submit(do, *arguments, **named)
        finally:
            sys.modules["__main__"] = script

    def end(self) -> None:
        """Cancel what waits, terminate the processes, and wait for the thread that manages them.

        Python's exit would otherwise write to a pipe that this thread may just have closed, and print a traceback. The
        work is cancelled first: the thread fails at cancelled work of a process that has died.
        """
        processes = list((self._processes or {}).values())
        manager: Any = self._executor_manager_thread
        self.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.terminate()
        if manager:
            manager.join()


class _Here(Executor):
    """Executor in this process: ``submit`` does the work at once and raises its exceptions."""

    def submit(self, do: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(do(*arguments, **named))
        return future


@contextmanager
def workers(cluster: str | None = None, processes: int | None = None) -> Iterator[Executor]:
    """Provide an executor: local processes, or the workers of a Dask cluster.

    Parameters
    ----------
    cluster : str, optional
        Address of the Dask scheduler.
    processes : int, optional
        Number of local processes (default: number of cores); 1 means this process.

    Raises
    ------
    InputError
        If no scheduler answers, or a worker does not have this version of partialslip.
    PartialslipError
        If the scheduler or all workers are lost.
    MissingLibraryError
        If dask.distributed is not installed.
    """
    if cluster is None and processes == 1:
        yield _Here()
        return
    if cluster is None:
        _track()
        context = multiprocessing.get_context("spawn")  # BLAS threads and gmsh do not survive a fork
        pool = _Processes(processes or os.cpu_count(), context, _begin)
        try:
            yield pool
        except BaseException:
            pool.end()
            raise
        pool.shutdown()
        return
    with dask(cluster) as crew:
        yield crew


def _track() -> None:
    """Start Python's process that removes what killed processes leave, so that it outlives a closed terminal. Python
    would otherwise start another one at the end, which prints tracebacks about what it does not know."""
    if sys.platform == "win32":
        return
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGHUP})
    try:
        resource_tracker.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)


def _begin() -> None:
    """Ignore Ctrl-C and a closed terminal in a worker, which the parent process handles, and end the worker when the
    parent ends."""
    for name in ("SIGINT", "SIGHUP"):
        if number := getattr(signal, name, None):
            signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    if parent := multiprocessing.parent_process():
        parent.join()
        os._exit(1)
