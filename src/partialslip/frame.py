"""Tables as pandas data frames. pandas is imported when a table is asked for, as it takes longer than a solution."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pandas import DataFrame as DataFrame


def frame(columns: Mapping[str, object]) -> "DataFrame":
    """Return ``columns`` as a pandas data frame; a column of None becomes NaN."""
    import pandas as pd

    table: DataFrame = pd.DataFrame(
        {name: float("nan") if values is None else values for name, values in columns.items()}
    )
    return table
