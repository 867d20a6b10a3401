"""The workers of a Dask cluster, and in one line what becomes of it."""

import logging
import re
import socket
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from contextlib import contextmanager, suppress
from importlib.metadata import version
from typing import Any

from partialslip.errors import InputError, MissingLibraryError, PartialslipError

_ADDRESS = re.compile(r"(?:(?P<protocol>tcp|tls)://)?(?P<host>[^/:\[\]\s]+|\[[0-9a-fA-F:.%]+\]):(?P<port>[0-9]{1,5})")
_ANSWERS = 10  # s in which a scheduler must
_PATIENCE = 30  # s without any worker
_GO_ON = "run it again to go on"
_LOGGERS = ("distributed", "tornado", "asyncio")

# What every worker is asked, by functions that it has without the package, too.
_ASK = """__import__("importlib.metadata").metadata.version("partialslip") if all(
    __import__("importlib").import_module(each) for each in ("partialslip.batch.job", "partialslip_fem.model")
) else ""
"""


class Cluster(Executor):
    """The workers of a Dask cluster as an executor; ``client`` is distributed's, ``address`` the scheduler's."""

    def __init__(self, client: Any, address: str) -> None:
        self.client, self.address = client, address
        self._pool = client.get_executor(pure=False)
        self._seen = time.monotonic()

    def submit(self, do: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Hand work over to the scheduler."""
        future: Future[Any] = self._pool.submit(do, *arguments, **named)
        return future

    def check(self) -> None:
        """Raise PartialslipError if the scheduler has gone, or all workers for half a minute."""
        if self.client.status != "running":
            raise PartialslipError(f"--cluster {self.address!r}: the scheduler has gone; {_GO_ON}")
        if self.client.scheduler_info(n_workers=-1)["workers"]:
            self._seen = time.monotonic()
        elif time.monotonic() - self._seen > _PATIENCE:
            raise PartialslipError(f"--cluster {self.address!r}: has had no worker for {_PATIENCE} s; {_GO_ON}")

    def greet(self) -> None:
        """Raise InputError if there is no worker, or one that cannot import this version of partialslip."""
        from distributed import TimeoutError as NoWorker

        try:
            self.client.wait_for_workers(1, timeout=_PATIENCE)
        except NoWorker:
            raise InputError(f"--cluster {self.address!r}: has no workers, for {_PATIENCE} s") from None
        mine = version("partialslip")
        for worker, its in self.client.run(eval, _ASK, on_error="return").items():
            if isinstance(its, BaseException):
                said = f"{type(its).__name__}: {its}"
                raise InputError(f"--cluster {self.address!r}: {worker} cannot import partialslip: {said}")
            if its != mine:
                raise InputError(f"--cluster {self.address!r}: {worker} has partialslip {its}: must be {mine}, as here")


@contextmanager
def dask(address: str) -> Iterator[Cluster]:
    """The workers of the Dask cluster whose scheduler is at ``address``, ``tcp://host:port``.

    Raises
    ------
    InputError
        If no scheduler answers there, or its workers do not have this version of partialslip.
    PartialslipError
        If scheduler or workers are lost; what was finished is kept.
    MissingLibraryError
        If dask.distributed is not installed.
    """
    try:
        from distributed import Client
    except ImportError:
        raise MissingLibraryError("--cluster: needs dask.distributed: pip install distributed") from None
    _reach(address)
    with _silence():
        try:
            client = Client(address, timeout=_ANSWERS, set_as_default=False)
        except Exception as error:  # of whatever kind: what answers may be anything
            raise InputError(f"--cluster {address!r}: no Dask scheduler answers there: {_said(error)}") from None
        try:
            cluster = Cluster(client, address)
            cluster.greet()
            yield cluster
        except CancelledError:
            raise PartialslipError(f"--cluster {address!r}: the scheduler has gone; {_GO_ON}") from None
        except PartialslipError:
            raise
        except Exception as error:
            if type(error).__module__.partition(".")[0] not in ("distributed", "dask", "tornado") and not isinstance(
                error, (ImportError, OSError, RuntimeError)
            ):
                raise
            raise PartialslipError(f"--cluster {address!r}: {_said(error)}; {_GO_ON}") from None
        finally:
            with suppress(Exception):  # of a scheduler that has gone
                client.close(timeout=2 if client.status == "running" else 0.1)


def _reach(address: str) -> None:
    """Raise InputError if nobody listens at ``address``: the client would try for a long time, and say much."""
    found = _ADDRESS.fullmatch(address)
    if not found or not 0 < int(found["port"]) < 65536:
        raise InputError(f"--cluster {address!r}: must be a scheduler's address, for example tcp://localhost:8786")
    try:
        socket.create_connection((found["host"].strip("[]"), int(found["port"])), timeout=_ANSWERS).close()
    except OSError as error:
        raise InputError(f"--cluster {address!r}: no scheduler answers there: {_said(error)}") from None


def _said(error: BaseException) -> str:
    """The first line of what ``error`` says."""
    said = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return (said.strip().splitlines() or [type(error).__name__])[0]


@contextmanager
def _silence() -> Iterator[None]:
    """What Dask and its libraries log is said here in one line, at the end."""
    loggers = [logging.getLogger(name) for name in _LOGGERS]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)
