"""Exported units in FMPy, an importer that knows nothing of this program.

Needs FMPy (`pip install fmpy pytest`), and the program in the variable GAPI with the runtime of units
beside it or in GAPILIB_FMU_RUNTIME: `cargo build` leaves both in `target/debug`.
"""

import csv
import os
import pathlib
import resource
import subprocess

import pytest

fmpy = pytest.importorskip("fmpy", reason="FMPy is not installed: units are not tried in it")
np = pytest.importorskip("numpy")

from fmpy import extract, read_model_description, simulate_fmu  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

HERE = pathlib.Path(__file__).parent
GAPI = os.environ.get("GAPI", str(HERE.parents[1] / "target/debug/gapi"))
MODELS = [
    "Dahlquist",
    "VanDerPol",
    "BouncingBall",
    "Stair",
    "Feedthrough",
    "StateSpace",
    "Roberts",
    "Resource",
    "Clocks",
    "Pendulum",
    "Roots",
    "Relay",
]
TOLERANCE = 1e-8
# The importer integrates with a method and an event search of its own.
MOST = 2e-5


def gapi(*arguments):
    done = subprocess.run([GAPI, *map(str, arguments)], capture_output=True, text=True, cwd=HERE)
    assert done.returncode == 0, done.stderr
    return done.stdout


def unit(folder, model, version):
    file = folder / f"{model}{version}.fmu"
    name = f"Reference.{model}"
    gapi("export-fmu", HERE / "Reference.mo", "--model", name, "--fmi", version, "-o", file)
    return str(file)


def reference(folder, model):
    """The columns of a fine simulation by the program itself, and the times of its events."""
    file = folder / f"{model}.csv"
    gapi("simulate", HERE / "Reference.mo", "--model", f"Reference.{model}", "--tolerance", TOLERANCE,
         "--intervals", 20000, "-o", file)
    with open(file) as rows:
        names, *numbers = list(csv.reader(rows))
    columns = dict(zip(names, np.array(numbers, dtype=float).T))
    time = columns["time"]
    return columns, time[1:][np.diff(time) == 0]


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("model", MODELS)
def test_a_unit_is_valid_and_gives_what_the_program_gives(tmp_path, model, version):
    file = unit(tmp_path, model, version)
    assert validate_fmu(file) == []
    columns, events = reference(tmp_path, model)
    variables = read_model_description(file).modelVariables
    names = [v.name for v in variables if v.causality in ("output", "local") and v.name in columns]
    assert names
    time = columns["time"]
    for kind in ["ModelExchange", "CoSimulation"]:
        result = simulate_fmu(file, fmi_type=kind, relative_tolerance=TOLERANCE, output=names)
        assert abs(result["time"][-1] - time[-1]) < 0.21, "up to the end, or the step before it"
        at = result["time"]
        clear = np.all(np.abs(at[:, None] - events[None, :]) > 2e-3, axis=1) if len(events) else at >= 0
        for name in names:
            expected = np.interp(at, time, columns[name])
            scale = max(1.0, np.max(np.abs(columns[name])))
            worst = np.max(np.abs(result[name] - expected)[clear]) / scale
            assert worst < MOST, (kind, name, worst)


def test_inputs_follow_a_signal(tmp_path):
    file = unit(tmp_path, "Feedthrough", 3)
    signals = np.array(
        [(0.0, 1.5, 3, True), (1.0, 2.5, 4, False), (2.0, 3.5, 5, False)],
        dtype=[("time", float), ("Float64_continuous_input", float), ("Int32_input", int),
               ("Boolean_input", bool)],
    )
    result = simulate_fmu(file, fmi_type="CoSimulation", input=signals, output_interval=0.5,
                          output=["Float64_continuous_output", "Int32_output", "Boolean_output"])
    assert list(result["Int32_output"][[1, -1]]) == [3, 4]
    assert list(result["Boolean_output"][[1, -1]]) == [True, False]
    assert result["Float64_continuous_output"][1] == pytest.approx(1.5)


def test_memory_stays_flat(tmp_path):
    file = unit(tmp_path, "BouncingBall", 2)
    description = read_model_description(file)
    folder = extract(file, str(tmp_path / "unpacked"))

    def instance(number):
        one = fmpy.fmi2.FMU2Slave(
            guid=description.guid, unzipDirectory=folder, instanceName=f"n{number}",
            modelIdentifier=description.coSimulation.modelIdentifier)
        one.instantiate()
        return one

    def run(one):
        one.setupExperiment(startTime=0.0)
        one.enterInitializationMode()
        one.exitInitializationMode()
        one.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.1)

    def memory():
        with open("/proc/self/statm") as pages:
            return int(pages.read().split()[1]) * resource.getpagesize()

    one = instance(0)
    for count in range(10_500):
        if count == 500:
            before = memory()
        one.reset()
        run(one)
    assert memory() - before < 4e6, "resets leave nothing"
    for count in range(1_100):
        if count == 100:
            before = memory()
        other = instance(count + 1)
        run(other)
        other.fmi2FreeInstance(other.component)
    assert memory() - before < 4e6, "instances leave nothing"
