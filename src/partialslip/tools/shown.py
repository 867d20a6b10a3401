"""Display of objects: short reprs, notebook tables and plots."""

import dataclasses
import importlib
import reprlib
from collections.abc import Iterator, Mapping, Sized
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import msgspec
import numpy as np

from partialslip.tools.arrays import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_Found = TypeVar("_Found")
_DISPLAY = "partialslip.report.notebook"  # a name: what shows objects stands above them, and is loaded when it is asked


class Short:
    """Mixin: the repr names the fields that are set; of an array it shows the shape and the range."""

    __slots__ = ()

    def __repr__(self) -> str:
        return short(self)


class ByMethod(Generic[_Found]):
    """Mixin: what each method has found, by its name: ``run["fem"]``."""

    __slots__ = ()

    @property
    def _by_method(self) -> Mapping[str, _Found]:
        raise NotImplementedError

    def __getitem__(self, method: str) -> _Found:
        """Return what ``method`` has found."""
        try:
            return self._by_method[method]
        except KeyError:
            has = ", ".join(self._by_method)
            raise KeyError(f"method {method!r}: the {type(self).__name__.lower()} has {has}") from None

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the methods."""
        return iter(self._by_method)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._by_method)


class Notebook:
    """Mixin: a notebook shows the object as tables."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        return str(_display().html(self))


class Drawn(Notebook):
    """Mixin: the object can also be drawn."""

    __slots__ = ()

    def plot(self, axes: "Axes | None" = None, what: str = "tractions", in_units: bool = False) -> "Axes":
        """Draw tractions or stresses along the contact on matplotlib ``axes`` (default: new axes). Returns the axes.

        Parameters
        ----------
        axes : matplotlib Axes, optional
        what : "tractions", "shear" or "stress"
            p/p0 and q/(f p0), q = (q2 - q1)/2, of all methods; or q1 and q2; or sigma_xx along the surface of the lower
            body at load points 1 and 2.
        in_units : bool
            Whether shear and stresses are drawn in the units of the scene over x, not in f p0 or p0 over x/a.
            A result alone knows neither f nor the scene: its shear is scaled by p0, its units are SI.

        Raises
        ------
        InputError
            If ``what`` is none of these, or no method knows it.
        """
        return _display().plot(self, axes, what, in_units)


def _display() -> Any:
    return importlib.import_module(_DISPLAY)


def short(record: Any) -> str:
    """Return the fields of ``record`` that are set, as text of one line.

    Parameters
    ----------
    record : dataclass, msgspec struct or named tuple
        Functions and empty fields are left out, and fields of a struct that equal the default.
    """
    if isinstance(record, msgspec.Struct):
        infos = msgspec.structs.fields(record)
        values = [(each, getattr(record, each.name)) for each in infos]
        fields = {each.encode_name: value for each, value in values if value != each.default}
    elif isinstance(record, tuple):
        fields = record._asdict()  # type: ignore[attr-defined]
    else:
        fields = {each.name: getattr(record, each.name) for each in dataclasses.fields(record)}
    shown = (f"{name}={_SHORT.repr(value)}" for name, value in fields.items() if not _empty(value))
    return f"{type(record).__name__}({', '.join(shown)})"


def span(values: Array) -> str:
    """Return the range of ``values``, without NaN, as text."""
    low, high = (float(which.reduce(values, axis=None)) for which in (np.fmin, np.fmax))
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def _empty(value: Any) -> bool:
    return value is None or callable(value) or (isinstance(value, Sized) and len(value) == 0)


class _Short(reprlib.Repr):
    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = 1000

    def repr1(self, x: Any, level: int) -> str:
        return short(x) if isinstance(x, tuple) and hasattr(x, "_fields") else super().repr1(x, level)

    def repr_float(self, number: float, _: int) -> str:
        return f"{number:g}" if float(f"{number:g}") == number else repr(number)

    def repr_ndarray(self, values: Array, _: int) -> str:
        return f"<{' x '.join(map(str, values.shape))}: {span(values)}>" if values.ndim else str(values)


_SHORT = _Short()
