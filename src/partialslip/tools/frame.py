"""Tables as pandas data frames. pandas is imported when a table is asked for, as it takes longer than a solution."""

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pandas import DataFrame as DataFrame


def frame(columns: Mapping[str, object]) -> "DataFrame":
    """Return ``columns`` as a pandas data frame; a column of None becomes NaN."""
    pandas = importlib.import_module("pandas")  # the exact solver needs NumPy and SciPy alone
    return pandas.DataFrame({name: float("nan") if values is None else values for name, values in columns.items()})
