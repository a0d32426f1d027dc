"""Plain values of arguments: numbers, lists of numbers, columns, and their refusal by name."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def number(name: str, value: Any) -> float:
    """Return a number as a float; a text, a truth or an array is refused by the name of its argument."""
    if isinstance(value, (str, bytes, bool)) or not hasattr(value, "__float__"):
        raise TypeError(f"{name} = {value!r}: must be a number, without a unit")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} = {value!r}: must be one number") from None


def whole(name: str, value: Any) -> int:
    """Return a whole number; a fraction, a truth or a text is refused by the name of its argument."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} = {value!r}: must be a whole number")
    return int(value.__index__())


def number_or_nan(name: str, value: Any) -> float:
    """Return a number as `number` does, and NaN for a missing one."""
    return float("nan") if is_missing(value) else number(name, value)


def is_missing(value: Any) -> bool:
    """Return True for a missing value: None, NaN, NaT, NA of pandas, or a masked value of numpy."""
    if value is None or type(value).__name__ in ("NAType", "MaskedConstant"):
        return True
    # An array is not missing as a whole.
    differs = value != value
    return getattr(differs, "ndim", 0) == 0 and bool(differs)


def text_of(name: str, value: Any) -> str:
    """Return a text, or a number as one: a whole number by its digits, also where a data frame has made it a float."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool) or not hasattr(value, "__float__"):
        raise TypeError(f"{name} = {value!r}: must be a text or a number")
    if hasattr(value, "__index__"):
        return str(value.__index__())
    own = number(name, value)
    return f"{own:.0f}" if own.is_integer() and abs(own) < 2**53 else repr(own)


def unique_names(name: str, table: Any) -> list[Any]:
    """Return the names of the columns of a table; a name that is given twice is refused."""
    names = list(table.keys())
    for own in names:
        if names.count(own) > 1:
            raise ValueError(f"{name}: has the column {own} {names.count(own)} times: must have it once")
    return names


def numbers(name: str, values: Any) -> list[float]:
    """Return a list, a tuple or a one-dimensional array as a list of floats."""
    if hasattr(values, "__array__"):
        array = real_array(name, values)
        if array.ndim != 1:
            raise ValueError(f"{name}: must have one dimension, has {array.ndim}")
        listed: list[float] = array.tolist()
        return listed
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise TypeError(f"{name} = {values!r}: must be a Range, or a list or an array of numbers")
    return [number(f"{name}[{index}]", value) for index, value in enumerate(values)]


def real_array(name: str, values: ArrayLike) -> NDArray[Any]:
    """Return an array of float64; texts, truths, complex numbers, objects and masked values are refused by the name of their argument."""
    import numpy as np

    refuse_masked(name, values)
    try:
        array = np.asarray(values)
    except ValueError as why:
        raise ValueError(f"{name}: {why}") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: must be real numbers without a unit, has the type {array.dtype}")
    return array.astype(np.float64, copy=False)


def real_array_or_nan(name: str, values: ArrayLike) -> NDArray[Any]:
    """Return an array as `real_array` does, with NaN for missing values."""
    import numpy as np

    if isinstance(values, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(values), np.nan, real_array(name, values.data))
    array = np.asarray(values)
    if array.dtype.kind != "O":
        return real_array(name, array)
    known = [number_or_nan(f"{name}[{index}]", value) for index, value in enumerate(array.flat)]
    return np.reshape(known, array.shape)


def refuse_masked(name: str, values: Any) -> None:
    """Refuse masked values of numpy, also in lists, by the name of their argument: an array made of them would have no mask."""
    if _has_masked(values):
        raise ValueError(f"{name}: has masked values; leave them out")


def _has_masked(values: Any) -> bool:
    import numpy as np

    if isinstance(values, (list, tuple)):
        return any(map(_has_masked, values))
    return isinstance(values, np.ma.MaskedArray) and bool(np.ma.is_masked(values))


def check_labels(arguments: Mapping[str, Any]) -> None:
    """Refuse arrays of xarray and pandas with other dimensions or labels at the same axis. Axes count from the last one, as in broadcasting."""
    _check_axes({name: _axes(values)[::-1] for name, values in arguments.items()})


def check_columns(name: str, columns: Mapping[str, Any]) -> None:
    """Refuse columns of xarray and pandas with other dimensions or labels of the rows, their first axis."""
    _check_axes({f"{name}[{own!r}]": _axes(values)[:1] for own, values in columns.items()})


# Dimension and labels of an axis; None for what it does not have.
_Axis = tuple[Any, Any]


def _axes(values: Any) -> list[_Axis]:
    """Return the axes of an array of xarray, or of a series or data frame of pandas; other values have none."""
    if hasattr(values, "dims"):
        # Variables of a dataset share its labels.
        indexes = getattr(values, "indexes", {})
        return [(dimension, indexes.get(dimension)) for dimension in values.dims]
    # An index of pandas has `reindex`, too, but no axes.
    return [(None, labels) for labels in values.axes] if hasattr(values, "reindex") and hasattr(values, "axes") else []


def _check_axes(arguments: Mapping[str, list[_Axis]]) -> None:
    """Compare the dimensions and the labels of each axis with the first known ones there."""
    dimensions: dict[int, tuple[str, Any]] = {}
    labels: dict[int, tuple[str, Any]] = {}
    for name, axes in arguments.items():
        for place, (own_dimension, own_labels) in enumerate(axes):
            if own_dimension is not None:
                other, expected = dimensions.setdefault(place, (name, own_dimension))
                if own_dimension != expected:
                    raise ValueError(
                        f"{name}: has the dimension {own_dimension} where {other} has {expected}: arrays are combined by place; broadcast by xarray.broadcast"
                    )
            if own_labels is not None:
                other, expected = labels.setdefault(place, (name, own_labels))
                if not own_labels.equals(expected):
                    raise ValueError(f"{name}: has other labels than {other}: arrays are combined by place; align them, or give their values")


def side_of(side: Any, *, is_one: bool = False) -> str:
    """Return "cb", "cf" or "both", whatever its capitals; `is_one` refuses "both"."""
    allowed = ("cb", "cf") if is_one else ("both", "cb", "cf")
    if not isinstance(side, str) or side.lower() not in allowed:
        raise ValueError(f"side = {side!r}: must be one of {', '.join(map(repr, allowed))}")
    return side.lower()


def origin_of(name: str, given: Any) -> str:
    """Return the name of a table in messages: that of its file, or of its argument."""
    return os.fspath(given) if isinstance(given, (str, os.PathLike)) else name


def by_index(name: str, given: Any, text: str) -> str:
    """Return a message about a table, with the index of a row in columns that were given by name instead of the line of a text."""
    if isinstance(given, (str, os.PathLike)):
        return text
    def index(line: re.Match[str]) -> str:
        row = int(line[1]) - 2
        return f"{name}:" if row < 0 else f"{name}[{row}]:"

    return re.sub(rf"\b{name}:(\d+):", index, text)


@contextmanager
def naming_rows(name: str, given: Any) -> Iterator[None]:
    """Raise errors about a table with the index of the row, as `by_index` does."""
    try:
        yield
    except ValueError as why:
        if type(why) is not ValueError:
            raise
        raise ValueError(by_index(name, given, str(why))) from None


def own_names(columns: Mapping[str, str] | None) -> list[tuple[str, str]]:
    """Return pairs of an expected and an own name of a column."""
    if columns is None:
        return []
    if not hasattr(columns, "items") or not all(isinstance(own, str) for pair in columns.items() for own in pair):
        raise TypeError(f"columns = {columns!r}: must be own names of columns by expected ones, such as {{'distance_mm': 'd'}}")
    return list(columns.items())


def csv_text(name: str, columns: str | os.PathLike[str] | Mapping[str, Any]) -> str:
    """Return the text of a CSV file, or columns by name as such a text. Coordinates of a dataset are columns."""
    if isinstance(columns, (str, os.PathLike)):
        return Path(columns).read_text(encoding="utf-8-sig")
    table: Any = columns
    if hasattr(columns, "data_vars"):
        table = {own: values for own, values in table.variables.items() if values.ndim}
    if not hasattr(table, "keys"):
        raise TypeError(f"{name} = {columns!r}: must be the path of a CSV file, or columns by name")
    given = {str(own): table[own] for own in unique_names(name, table)}
    check_columns(name, given)
    listed = {own: _listed(values) for own, values in given.items()}
    lengths = {own: len(values) for own, values in listed.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"{name}: columns must be equally long, have {lengths}")
    texts = ([_cell(f"{name}[{own!r}][{index}]", value) for index, value in enumerate(values)] for own, values in listed.items())
    cells = zip(*texts)
    return "\n".join(",".join(row) for row in [tuple(listed), *cells]) + "\n"


def _listed(values: Any) -> list[Any]:
    """Return the values of a column; a single value is a column of one."""
    import numpy as np

    # An array of a list would turn numbers beside texts into texts.
    return list(values) if isinstance(values, (list, tuple)) else list(np.atleast_1d(np.asanyarray(values)))


def _cell(name: str, value: Any) -> str:
    if is_missing(value):
        # A row of empty cells would be left out.
        return "nan"
    text = str(int(value)) if type(value).__name__ in ("bool", "bool_") else text_of(name, value)
    return '"' + text.replace('"', '""') + '"'
