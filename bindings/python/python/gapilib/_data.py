"""Measured data that a problem holds itself, as files: what `gapi identify` reads."""

import csv
import io
import os
from typing import Any, Callable, Dict, List, Mapping, Tuple

import numpy as np


def is_file(data: Any) -> bool:
    """Whether these are the data of a file, by its name."""
    return isinstance(data, str) or hasattr(data, "__fspath__")


def text_of(data: Any) -> str:
    """A data frame of pandas or polars, a table of Arrow, a dataset of xarray or a dict of columns, as CSV.

    An index that has a name, or holds times, is a column; so are dates, in seconds from the first one.
    Units are those of pint, a second level of the headings, ``frame.attrs["units"]``, or part of a heading
    as in ``U [mV]``. What is missing in the frame is missing in the file.
    """
    columns, units = _columns(data)
    lengths = {name: len(values) if values.ndim == 1 else None for name, values in columns.items()}
    if len(set(lengths.values())) != 1 or None in lengths.values():
        raise ValueError(f"the columns of the data must be vectors of one length, but these have {lengths}")
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow([f"{name} [{units[name]}]" if units.get(name) else name for name in columns])
    writer.writerows(zip(*[_cells(name, values) for name, values in columns.items()]))
    return file.getvalue()


def of_other_package(data: Any) -> bool:
    """Whether a file is one that another package reads."""
    return os.path.splitext(os.fspath(data))[1].lower() in _READERS


def read(path: str) -> Any:
    """What a file of Parquet, Feather or NetCDF holds."""
    return _READERS[os.path.splitext(path)[1].lower()](path)


def _parquet(path: str) -> Any:
    import pyarrow.parquet

    return pyarrow.parquet.read_table(path)


def _feather(path: str) -> Any:
    import pyarrow.feather

    return pyarrow.feather.read_table(path)


def _netcdf(path: str) -> Any:
    import xarray

    with xarray.open_dataset(path) as dataset:
        return dataset.load()


_READERS: Dict[str, Callable[[str], Any]] = {
    ".parquet": _parquet,
    ".feather": _feather,
    ".arrow": _feather,
    ".nc": _netcdf,
}


def _columns(data: Any) -> Tuple[Dict[str, np.ndarray], Dict[str, str]]:
    """The columns of data in memory and their units, by their names."""
    units: Dict[str, str] = {}
    if hasattr(data, "data_vars") and hasattr(data, "to_dataframe"):
        columns = {str(name): np.asarray(data[name]) for name in [*data.coords, *data.data_vars]}
        own = {str(name): data[name].attrs.get("units") for name in [*data.coords, *data.data_vars]}
        units = {name: str(unit) for name, unit in own.items() if unit}
    elif hasattr(data, "column_names") and hasattr(data, "schema"):
        # A table of Arrow; units are in the metadata of its fields.
        columns = {str(name): data.column(name).to_numpy() for name in data.column_names}
        for field in data.schema:
            unit = (field.metadata or {}).get(b"units")
            if unit:
                units[str(field.name)] = unit.decode()
    elif hasattr(data, "iter_columns") and hasattr(data, "to_dict"):
        columns = {str(name): data[name].to_numpy() for name in data.columns}
    elif hasattr(data, "columns") and hasattr(data, "to_dict"):
        return _of_frame(data)
    elif isinstance(data, Mapping):
        columns = {str(name): np.asarray(values) for name, values in data.items()}
    else:
        raise TypeError(
            "the data of an experiment are a file, a data frame, a table of Arrow, a dataset of xarray or a "
            f"dict of columns, not {type(data).__name__}"
        )
    return {name: _since_first(values, name, units) for name, values in columns.items()}, units


def _since_first(values: np.ndarray, name: str, units: Dict[str, str]) -> np.ndarray:
    """Dates and durations of NumPy in seconds, dates from the first one."""
    if values.dtype.kind not in "mM":
        return values
    units[name] = "s"
    durations = values - values[~np.isnat(values)].min() if values.dtype.kind == "M" else values
    return durations / np.timedelta64(1, "s")


def _of_frame(frame: Any) -> Tuple[Dict[str, np.ndarray], Dict[str, str]]:
    """The columns of a data frame and their units, by their names."""
    if any(str(dtype).startswith("pint") for dtype in frame.dtypes):
        frame = frame.pint.dequantify()
    units = {str(name): str(unit) for name, unit in dict(frame.attrs.get("units") or {}).items()}
    headings: List[str] = []
    for heading in frame.columns:
        name, unit = heading if isinstance(heading, tuple) and len(heading) == 2 else (heading, "")
        headings.append(str(name))
        if unit and not str(unit).startswith("Unnamed"):
            units[str(name)] = "1" if str(unit) in ("dimensionless", "No Unit") else str(unit)
    columns: Dict[str, np.ndarray] = {}
    index = frame.index
    if index.name is not None or index.dtype.kind in "mM" or hasattr(index.dtype, "tz"):
        name = "time" if index.name is None else str(index.name)
        columns[name] = _seconds(index, name, units)
    for place, name in enumerate(headings):
        if name in columns:
            raise ValueError(f"the data have two columns `{name}`")
        columns[name] = _seconds(frame.iloc[:, place], name, units)
    return columns, units


def _seconds(values: Any, name: str, units: Dict[str, str]) -> np.ndarray:
    """The values; dates and durations in seconds, dates from the first one."""
    is_date = getattr(values.dtype, "kind", "") == "M" or hasattr(values.dtype, "tz")
    if not is_date and getattr(values.dtype, "kind", "") != "m":
        return np.asarray(values)
    units[name] = "s"
    # As a column: an index has another interface.
    column = values.to_series() if hasattr(values, "to_series") else values
    durations = column - column.min() if is_date else column
    return durations.dt.total_seconds().to_numpy()


def _cells(name: str, values: np.ndarray) -> List[str]:
    return [_cell(name, value) for value in values.tolist()]


def _cell(name: str, value: Any) -> str:
    if value is None or isinstance(value, (str, bool)):
        return "" if value is None else str(value)
    try:
        number = float(value)
    except (TypeError, ValueError):
        if type(value).__name__ in ("NAType", "NaTType"):
            return ""
        raise TypeError(f"the column `{name}` has a value of type {type(value).__name__}") from None
    if number != number:
        return ""
    # All digits; whole numbers of any size as they are.
    return str(value) if isinstance(value, int) else repr(number)
