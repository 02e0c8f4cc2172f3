"""Data that a problem holds itself: data frames and columns, with units and dates, instead of files."""

import numpy as np
import pytest

import gapilib
from gapilib._data import text_of

pandas = pytest.importorskip("pandas")

MODEL = """
model Decay
  parameter Real k(unit = "1/s") = 1;
  parameter Real a(unit = "V") = 1;
  Real x(start = a, fixed = true, unit = "V");
equation
  der(x) = -k*x;
  annotation(experiment(StopTime = 2));
end Decay;
"""
TIMES = np.linspace(0.0, 2, 21)
VALUES = 1.3 * np.exp(-2.1 * TIMES) + 1e-3 * np.sin(37 * np.arange(21))


def solution(tmp_path, data, **experiment):
    (tmp_path / "Decay.mo").write_text(MODEL)
    problem = {
        "model": "Decay",
        "files": ["Decay.mo"],
        "parameters": {"k": {"min": 0.1, "max": 10.0}, "a": {"min": 0.1, "max": 5}},
        "experiment": [{"data": data, "x": "time", "outputs": {"x": "x"}, **experiment}],
    }
    found = gapilib.identify(problem, progress=False)
    assert [file.name for file in tmp_path.iterdir() if "problem-" in file.name] == []
    return found


def frame(time=TIMES, values=VALUES, **options):
    return pandas.DataFrame({"x": values}, index=pandas.Index(time, name="time"), **options)


def dates():
    return pandas.Timestamp("2024-03-31 01:59:59") + pandas.to_timedelta(TIMES, unit="s")


def with_attributes():
    given = frame(values=1e3 * VALUES)
    given.attrs["units"] = {"x": "mV"}
    return given


def with_two_headings():
    given = frame(values=1e3 * VALUES).reset_index()
    given.columns = pandas.MultiIndex.from_tuples([("time", "s"), ("x", "mV")])
    return given


@pytest.mark.parametrize(
    "data",
    [
        frame(),
        frame().reset_index(),
        frame().astype("float32").astype("Float64"),
        pandas.DataFrame({"x": VALUES}, index=dates()),
        pandas.DataFrame({"time": dates().tz_localize("UTC"), "x": VALUES}),
        pandas.DataFrame({"x": VALUES}, index=pandas.to_timedelta(TIMES, unit="s")),
        {"time": TIMES, "x": VALUES},
        {"time": TIMES.astype("float32"), "x": list(VALUES)},
        {"time": np.column_stack([TIMES, TIMES])[:, 1], "x": VALUES[::-1][::-1]},
        with_attributes(),
        with_two_headings(),
        frame(values=1e3 * VALUES).rename(columns={"x": "x [mV]"}),
    ],
    ids=[
        "index", "columns", "Float64", "dates", "zoned", "durations", "dict", "float32", "strided",
        "attrs", "headings", "heading",
    ],
)
def test_data_in_memory_are_those_of_a_file(tmp_path, data):
    found = solution(tmp_path, data)
    assert found.verdicts == {"k": "identifiable", "a": "identifiable"}
    np.testing.assert_allclose([found.parameters["k"], found.parameters["a"]], [2.1, 1.3], rtol=5e-3)


def test_simulated_frames_are_data_with_their_units(tmp_path):
    session = gapilib.Session(cache=False)
    session.load_text(MODEL)
    result = session.model("Decay").simulate({"k": 2.1, "a": 1.3}, tolerance=1e-9, intervals=20)
    given = result.to_pandas(["x"])
    assert given.attrs["units"]["x"] == "V"
    found = solution(tmp_path, given)
    np.testing.assert_allclose(list(found.parameters.values()), [2.1, 1.3], rtol=1e-5)


@pytest.mark.parametrize("missing", [np.nan, None, pandas.NA])
def test_what_is_missing_is_left_out(tmp_path, missing):
    values = pandas.Series(VALUES, dtype=object)
    values[[3, 7]] = missing
    found = solution(tmp_path, pandas.DataFrame({"time": TIMES, "x": values}))
    np.testing.assert_allclose(list(found.parameters.values()), [2.1, 1.3], rtol=5e-3)
    assert "19 points" in found.text


def test_numbers_keep_all_their_digits():
    numbers = [0.1, 1e-300, -2.5e17, 1 / 3]
    lines = text_of({"a": numbers, "b": [1, 2**53 + 1, -3, 0]}).splitlines()
    assert lines[0] == "a,b"
    assert [float(line.split(",")[0]) for line in lines[1:]] == numbers
    assert lines[2].endswith(",9007199254740993")


def test_several_experiments_and_one(tmp_path):
    (tmp_path / "Decay.mo").write_text(MODEL)
    x = {"x": "time", "outputs": {"x": "x"}}
    problem = {
        "model": "Decay",
        "files": ["Decay.mo"],
        "parameters": {"k": {"min": 0.1, "max": 10.0}},
        "experiment": [
            {"name": "one", "data": frame(values=np.exp(-2.1 * TIMES)), **x},
            {"name": "two", "data": {"time": TIMES, "x": 2 * np.exp(-2.1 * TIMES)}, "set": {"a": 2.0}, **x},
        ],
    }
    assert abs(gapilib.identify(problem, progress=False).parameters["k"] - 2.1) < 1e-5
    assert sorted(file.name for file in tmp_path.iterdir()) == ["Decay.mo"]


@pytest.mark.parametrize(
    "data, error",
    [
        ({"time": TIMES, "x": VALUES[1:]}, ValueError),
        ({"time": TIMES, "x": np.zeros((21, 2))}, ValueError),
        ({"time": TIMES, "x": 1j * VALUES}, TypeError),
        ([1.0, 2.0], TypeError),
        (frame().assign(time=0.0), ValueError),
        ({}, ValueError),
    ],
)
def test_what_is_not_a_table_is_refused(tmp_path, data, error):
    with pytest.raises(error):
        solution(tmp_path, data)
    assert [file.name for file in tmp_path.iterdir()] == ["Decay.mo"]


def test_an_interrupted_problem_in_memory_is_resumed(tmp_path):
    (tmp_path / "Decay.mo").write_text(MODEL)
    problem = {
        "model": "Decay",
        "files": ["Decay.mo"],
        "parameters": {"k": {"min": 0.1, "max": 10.0}, "a": {"min": 0.1, "max": 5}},
        "experiment": {"data": frame(), "x": "time", "outputs": {"x": "x"}},
    }
    problem["experiment"] = [problem["experiment"]]
    whole = gapilib.identify(problem, progress=False, out="whole")

    def stop(label, done, total, best):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt, match="with a folder `out`"):
        gapilib.identify(problem, progress=stop)
    with pytest.raises(ValueError, match="name it with `out`"):
        gapilib.identify(problem, resume=True)
    with pytest.raises(KeyboardInterrupt, match="`resume=True` continues it"):
        gapilib.identify(problem, progress=stop, out="run")
    resumed = gapilib.identify(problem, resume=True, out="run")
    assert resumed.parameters == whole.parameters
    assert resumed.data["evaluations"] == whole.data["evaluations"]


def arrow():
    pyarrow = pytest.importorskip("pyarrow")
    fields = [("time", pyarrow.float64()), pyarrow.field("x", pyarrow.float64(), metadata={"units": "mV"})]
    return pyarrow.table([TIMES, 1e3 * VALUES], schema=pyarrow.schema(fields))


def dataset():
    xarray = pytest.importorskip("xarray")
    return xarray.Dataset({"x": ("time", 1e3 * VALUES, {"units": "mV"})}, coords={"time": TIMES})


def parquet():
    arrow()
    import pyarrow.parquet

    pyarrow.parquet.write_table(arrow(), "data.parquet")
    return "data.parquet"


def netcdf():
    pytest.importorskip("netCDF4")
    dataset().to_netcdf("data.nc")
    return "data.nc"


@pytest.mark.parametrize("make", [arrow, dataset, parquet, netcdf])
def test_data_of_other_packages(tmp_path, make):
    found = solution(tmp_path, make())
    np.testing.assert_allclose([found.parameters["k"], found.parameters["a"]], [2.1, 1.3], rtol=5e-3)


@pytest.mark.parametrize("name", ["result.parquet", "result.feather", "result.nc"])
def test_results_are_written_and_read_as_data(tmp_path, name):
    pytest.importorskip("netCDF4" if name.endswith(".nc") else "pyarrow")
    session = gapilib.Session(cache=False)
    session.load_text(MODEL)
    result = session.model("Decay").simulate({"k": 2.1, "a": 1.3}, tolerance=1e-9, intervals=20)
    result.write(name)
    found = solution(tmp_path, name)
    np.testing.assert_allclose(list(found.parameters.values()), [2.1, 1.3], rtol=1e-5)


def test_tables_and_datasets_have_names_and_units():
    session = gapilib.Session(cache=False)
    session.load_text(MODEL)
    result = session.model("Decay").simulate()
    table = pytest.importorskip("pyarrow") and result.to_arrow(["x"])
    assert table.column_names == ["time", "x"] and table.schema.field("x").metadata[b"units"] == b"V"
    np.testing.assert_array_equal(table["x"].to_numpy(), result["x"])
    whole = pytest.importorskip("xarray") and result.to_xarray()
    np.testing.assert_array_equal(whole["x"], result["x"])
    assert whole["x"].attrs["units"] == "V" and whole["time"].attrs["units"] == "s"
