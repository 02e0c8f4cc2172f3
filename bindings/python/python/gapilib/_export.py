"""Results of simulations for other packages."""

import os
from typing import Any, Optional, Sequence

from . import _gapilib


def arrow(result: _gapilib.SimulationResult, names: Optional[Sequence[str]] = None) -> Any:
    """A table of Arrow: time and the variables, with `units` and `description` in the metadata of the fields."""
    import pyarrow

    units, descriptions = result.units, result.descriptions
    chosen = [name for name in (result.names if names is None else names) if name != "time"]

    def field(name: str) -> Any:
        about = {"units": units.get(name), "description": descriptions.get(name)}
        return pyarrow.field(name, pyarrow.float64(), metadata={k: v for k, v in about.items() if v})

    schema = [pyarrow.field("time", pyarrow.float64(), metadata={"units": "s"}), *map(field, chosen)]
    columns = [result.time, *(result[name] for name in chosen)]
    return pyarrow.table([pyarrow.array(column) for column in columns], schema=pyarrow.schema(schema))


def xarray(result: _gapilib.SimulationResult, names: Optional[Sequence[str]] = None) -> Any:
    """A dataset of xarray over time, with `units` and `long_name` as the conventions for NetCDF have them."""
    import xarray as package

    units, descriptions = result.units, result.descriptions
    chosen = [name for name in (result.names if names is None else names) if name != "time"]

    def variable(name: str) -> Any:
        about = {"units": units.get(name), "long_name": descriptions.get(name)}
        return ("time", result[name], {k: v for k, v in about.items() if v})

    return package.Dataset(
        {name: variable(name) for name in chosen}, coords={"time": ("time", result.time, {"units": "s"})}
    )


def is_written(result: _gapilib.SimulationResult, path: str) -> bool:
    """Writes a file of Parquet, Feather or NetCDF; whether its name is that of one."""
    ending = os.path.splitext(path)[1].lower()
    if ending == ".parquet":
        import pyarrow.parquet

        pyarrow.parquet.write_table(arrow(result), path)
    elif ending in (".feather", ".arrow"):
        import pyarrow.feather

        pyarrow.feather.write_feather(arrow(result), path)
    elif ending == ".nc":
        xarray(result).to_netcdf(path)
    else:
        return False
    return True
