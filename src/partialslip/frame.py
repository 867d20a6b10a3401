"""Tables as pandas data frames, if pandas is installed."""

import importlib
from collections.abc import Mapping
from typing import TYPE_CHECKING

from partialslip.errors import MissingLibraryError

if TYPE_CHECKING:
    from pandas import DataFrame as DataFrame


def frame(columns: Mapping[str, object]) -> "DataFrame":
    """Return ``columns`` as a pandas data frame; a column of None becomes NaN. Raises MissingLibraryError without
    pandas."""
    try:
        pandas = importlib.import_module("pandas")
    except ImportError:
        raise MissingLibraryError("pandas is not installed: pip install 'partialslip[notebook]'") from None
    table: DataFrame = pandas.DataFrame(
        {name: float("nan") if values is None else values for name, values in columns.items()}
    )
    return table
