"""Many cases at once, on this machine or a Dask cluster; every finished one is in the ledger before the next is heard
of."""

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager

from partialslip.errors import InputError, MissingLibraryError, PartialslipError
from partialslip.study.case import Case, solve
from partialslip.study.ledger import Ledger

Progress = Callable[[int, int, float], None]


def sweep(cases: Sequence[Case], ledger: Ledger, executor: Executor, progress: Progress = lambda *_: None) -> None:
    """Solve those of ``cases`` that are not in ``ledger`` and add them, in the order they finish.

    ``progress`` is called with how many are done, how many there are, and the seconds left by the pace so far.

    Raises
    ------
    PartialslipError
        If a worker process dies; what was finished is kept.
    """
    to_do = {case.key: case for case in cases if case.key not in ledger}
    total = len({case.key for case in cases})
    known, began = total - len(to_do), time.monotonic()
    futures = {executor.submit(solve, case.data): key for key, case in to_do.items()}
    progress(known, total, float("nan"))
    try:
        for done, future in enumerate(as_completed(futures), start=1):
            ledger.add(futures[future], future.result())
            pace = (time.monotonic() - began) / done
            progress(known + done, total, pace * (len(futures) - done))
    except BrokenProcessPool:
        raise PartialslipError("a worker process died, perhaps for want of memory; run the study again") from None
    finally:
        for future in futures:
            future.cancel()


@contextmanager
def workers(cluster: str | None = None, processes: int | None = None) -> Iterator[Executor]:
    """Local processes, or the workers of the Dask cluster whose scheduler is at the address ``cluster``.

    Raises
    ------
    InputError
        If no scheduler answers there.
    MissingLibraryError
        If dask.distributed is not installed.
    """
    if cluster is None:
        context = multiprocessing.get_context("spawn")  # BLAS threads and gmsh do not survive a fork
        with ProcessPoolExecutor(processes or os.cpu_count(), mp_context=context) as pool:
            try:
                yield pool
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
        return
    try:
        from distributed import Client
    except ImportError:
        raise MissingLibraryError("--cluster: needs dask.distributed: pip install distributed") from None
    try:
        client = Client(cluster, timeout="10s", set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(f"--cluster {cluster!r}: no scheduler answers there: {error}") from None
    with client, client.get_executor(pure=False) as pool:
        yield pool
