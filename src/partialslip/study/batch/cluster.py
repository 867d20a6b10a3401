"""Workers of a Dask cluster, with one-line error messages."""

import logging
import re
import socket
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from contextlib import contextmanager, suppress
from importlib.metadata import version
from typing import Any

from partialslip.tools.errors import InputError, MissingLibraryError, PartialslipError

_ADDRESS = re.compile(r"(?:(?P<protocol>tcp|tls)://)?(?P<host>[^/:\[\]\s]+|\[[0-9a-fA-F:.%]+\]):(?P<port>[0-9]{1,5})")
_ANSWERS = 10  # limit: s: timeout of the scheduler
_PATIENCE = 30  # limit: s: longest time without a worker
_GO_ON = "run it again to go on"
_LOGGERS = ("distributed", "tornado", "asyncio")
_BELOW = tuple(f"{name}." for name in _LOGGERS)

# Evaluated on every worker; must work where partialslip is not installed.
_ASK = """__import__("importlib.metadata").metadata.version("partialslip") if all(
    __import__("importlib").import_module(each) for each in ("partialslip.study.batch.job", "partialslip_fem.method")
) else ""
"""


class Cluster(Executor):
    """Workers of a Dask cluster as an executor.

    Parameters
    ----------
    client : distributed.Client
    address : str
        Address of the scheduler.
    """

    def __init__(self, client: Any, address: str) -> None:
        self.client, self.address = client, address
        self._pool = client.get_executor(pure=False)
        self._seen = time.monotonic()

    def submit(self, do: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Submit the call ``do(*arguments, **named)`` to the scheduler."""
        return self._pool.submit(do, *arguments, **named)

    def check(self) -> None:
        """Raise PartialslipError if the scheduler is lost, or if there has been no worker for 30 s."""
        if self.client.status != "running":
            raise PartialslipError(f"--cluster {self.address!r}: connection to the scheduler lost; {_GO_ON}")
        if self.client.scheduler_info(n_workers=-1)["workers"]:
            self._seen = time.monotonic()
        elif time.monotonic() - self._seen > _PATIENCE:
            raise PartialslipError(f"--cluster {self.address!r}: no worker for {_PATIENCE} s; {_GO_ON}")

    def greet(self) -> None:
        """Raise InputError if there is no worker, or if a worker cannot import this version of partialslip."""
        from distributed import TimeoutError as NoWorker

        try:
            self.client.wait_for_workers(1, timeout=_PATIENCE)
        except NoWorker:
            raise InputError(
                f"--cluster {self.address!r}: no workers within {_PATIENCE} s: start workers for the scheduler"
            ) from None
        here = version("partialslip")
        for worker, there in self.client.run(eval, _ASK, on_error="return").items():
            if isinstance(there, BaseException):
                reason = f"{type(there).__name__}: {there}"
                raise InputError(f"--cluster {self.address!r}: {worker} cannot import partialslip: {reason}")
            if there != here:
                raise InputError(
                    f"--cluster {self.address!r}: {worker} has partialslip {there}: must be {here}, as on this machine"
                )


@contextmanager
def dask(address: str) -> Iterator[Cluster]:
    """Connect to the Dask cluster with the scheduler at ``address``, ``tcp://host:port``.

    Raises
    ------
    InputError
        If no scheduler answers, or a worker does not have this version of partialslip.
    PartialslipError
        If the scheduler or all workers are lost; finished cases are kept.
    MissingLibraryError
        If dask.distributed is not installed.
    """
    try:
        from distributed import Client
    except ImportError:
        raise MissingLibraryError("--cluster: needs dask.distributed: pip install distributed") from None
    _reach(address)
    speak = _silence()
    try:
        client = Client(address, timeout=_ANSWERS, set_as_default=False)
    except Exception as error:  # any kind: the server may not be Dask
        speak()
        raise InputError(f"--cluster {address!r}: no Dask scheduler answers there: {_said(error)}") from None
    try:
        cluster = Cluster(client, address)
        cluster.greet()
        yield cluster
    except CancelledError:
        raise PartialslipError(f"--cluster {address!r}: connection to the scheduler lost; {_GO_ON}") from None
    except PartialslipError:
        raise
    except Exception as error:
        if type(error).__module__.partition(".")[0] not in ("distributed", "dask", "tornado") and not isinstance(
            error, (ImportError, OSError, RuntimeError)
        ):
            raise
        raise PartialslipError(f"--cluster {address!r}: {_said(error)}; {_GO_ON}") from None
    finally:
        connected = client.status == "running"
        with suppress(Exception):  # the scheduler may be lost
            client.close(timeout=2 if connected else 0.1)
        if connected:
            speak()  # else a thread of Dask tries to reconnect for some seconds, and would say so


def _reach(address: str) -> None:
    """Raise InputError if nothing listens at ``address``. Dask's client would retry for long and print a lot."""
    found = _ADDRESS.fullmatch(address)
    if not found or not 0 < int(found["port"]) < 65536:
        raise InputError(f"--cluster {address!r}: must be a scheduler's address, for example tcp://localhost:8786")
    try:
        socket.create_connection((found["host"].strip("[]"), int(found["port"])), timeout=_ANSWERS).close()
    except OSError as error:
        raise InputError(f"--cluster {address!r}: no scheduler answers there: {_said(error)}") from None


def _said(error: BaseException) -> str:
    """Return the first line of the message of ``error``."""
    said = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return (said.strip().splitlines() or [type(error).__name__])[0]


def _silence() -> Callable[[], None]:
    """Silence the logs of Dask and the libraries below, errors of which are one line instead; return what ends this.

    Dask gives some loggers levels of their own, such as tornado.application: these ignore the level of their parent.
    """
    known = {*_LOGGERS, *(name for name in logging.root.manager.loggerDict if name.startswith(_BELOW))}
    levels = {logging.getLogger(name): logging.getLogger(name).level for name in sorted(known)}
    for logger in levels:
        logger.setLevel(logging.CRITICAL + 1)

    def speak() -> None:
        for logger, level in levels.items():
            logger.setLevel(level)

    return speak
