"""Measured data that a problem holds itself, as files: what `gapi identify` reads."""

import contextlib
import csv
import hashlib
import io
import os
from typing import Any, Dict, List, Mapping, Optional, Tuple

import numpy as np


def is_file(data: Any) -> bool:
    """Whether these are the data of a file, by its name."""
    return isinstance(data, str) or hasattr(data, "__fspath__")


def text_of(data: Any) -> str:
    """A data frame of pandas, or a dict of columns, as CSV.

    An index that has a name, or holds times, is a column; so are dates, in seconds from the first one.
    Units are those of pint, a second level of the headings, ``frame.attrs["units"]``, or part of a heading
    as in ``U [mV]``. What is missing in the frame is missing in the file.
    """
    if hasattr(data, "columns") and hasattr(data, "to_dict"):
        columns, units = _of_frame(data)
    elif isinstance(data, Mapping):
        columns, units = {str(name): np.asarray(values) for name, values in data.items()}, {}
    else:
        raise TypeError(
            f"the data of an experiment are a file, a data frame or a dict of columns, not {type(data).__name__}"
        )
    lengths = {name: len(values) if values.ndim == 1 else None for name, values in columns.items()}
    if len(set(lengths.values())) != 1 or None in lengths.values():
        raise ValueError(f"the columns of the data must be vectors of one length, but these have {lengths}")
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow([f"{name} [{units[name]}]" if units.get(name) else name for name in columns])
    writer.writerows(zip(*[_cells(name, values) for name, values in columns.items()]))
    return file.getvalue()


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


def with_files(problem: Mapping[str, Any], folder: Any) -> Tuple[Dict[str, Any], List[str]]:
    """A problem whose data are in files in `folder`, and these files. They are the caller's to remove.

    They are named after their content: a problem with the same data is the same one, and can be resumed.
    """
    given: Dict[str, Any] = dict(problem)
    made: List[str] = []
    experiments: Any = given.get("experiment")
    if experiments is None:
        return given, made
    changed: List[Any] = []
    try:
        for one in [experiments] if isinstance(experiments, Mapping) else experiments:
            data: Optional[Any] = one.get("data") if isinstance(one, Mapping) else None
            if data is not None and not is_file(data):
                content = text_of(data).encode()
                name = f"problem-data-{hashlib.sha256(content).hexdigest()[:16]}.csv"
                path = os.path.join(folder, name)
                with open(path, "wb") as file:
                    made.append(path)
                    file.write(content)
                one = {**one, "data": name}
            changed.append(one)
    except BaseException:
        remove(made)
        raise
    given["experiment"] = changed
    return given, made


def remove(files: List[str]) -> None:
    """Removes files; two experiments can have the same one."""
    for path in files:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(path)
