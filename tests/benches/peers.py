"""The same fit by `gapi` and by SciPy, in CPU seconds of one thread.

An equivalent circuit with two RC pairs, its current sampled every second and held: five parameters by
Levenberg and Marquardt from the same start. SciPy gets the model twice: as its exact solution between samples,
written by hand (the fastest that can be had), and as equations for `solve_ivp`, as users of SciPy write it.

    python3 tests/benches/peers.py target/release/gapi [seconds of data, 3600]

Needs numpy and scipy. It works in a new temporary folder.
"""

import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares
from scipy.signal import lfilter

NAMES = ["R0", "R1", "C1", "R2", "C2"]
TRUTH = np.array([2e-3, 1.5e-3, 8e3, 2.5e-3, 6e4])
LOW = np.array([2e-4, 1e-4, 1e3, 1e-4, 1e4])
HIGH = np.array([2e-2, 1e-2, 1e5, 1e-2, 1e6])
CAPACITY = 25.0 * 3600

MODEL = """model Cell "equivalent circuit with two RC pairs"
  parameter Real R0 = 2e-3, R1 = 1e-3, C1 = 1e4, R2 = 1e-3, C2 = 1e5;
  input Real I;
  output Real V;
  Real q(start = 0.8, fixed = true), u1(start = 0, fixed = true), u2(start = 0, fixed = true);
equation
  der(q) = I/90000;
  C1*der(u1) = I - u1/R1;
  C2*der(u2) = I - u2/R2;
  V = 3.3 + 0.8*q + R0*I + u1 + u2;
end Cell;
"""

PROBLEM = """model = "Cell"
files = ["Cell.mo"]
[parameters]
{parameters}
[[experiment]]
data = "cell.csv"
x = {{ variable = "time", column = "t" }}
outputs = {{ V = "V" }}
inputs = {{ I = {{ column = "I", interpolation = "hold" }} }}
[method]
name = "levenberg_marquardt"
"""


def current(n):
    """A drive with phases of one to three minutes and a little noise."""
    random = np.random.default_rng(2006)
    phases = random.choice([-40.0, -25.0, -10.0, 0.0, 12.0, 20.0], size=n)
    lengths = random.integers(60, 180, size=n)
    profile = np.repeat(phases, lengths)[: n + 1] + random.normal(0, 1.5, n + 1)
    return np.round(profile - profile.mean(), 2)


def exact(parameters, held):
    """V at the samples: each RC pair is a first-order filter of the held current."""
    r0, r1, c1, r2, c2 = parameters
    charge = 0.8 + np.concatenate([[0.0], np.cumsum(held[:-1])]) / CAPACITY
    voltage = 3.3 + 0.8 * charge + r0 * held
    for r, c in ((r1, c1), (r2, c2)):
        a = np.exp(-1.0 / (r * c))
        voltage += lfilter([0.0, r * (1 - a)], [1.0, -a], held)
    return voltage


def integrated(parameters, held):
    """V at the samples by LSODA, restarted at each jump of the current by steps of one second."""
    r0, r1, c1, r2, c2 = parameters
    last = len(held) - 1

    def rates(t, y):
        i = held[min(int(t), last)]
        return [i / CAPACITY, (i - y[1] / r1) / c1, (i - y[2] / r2) / c2]

    times = np.arange(last + 1.0)
    result = solve_ivp(
        rates, (0.0, last), [0.8, 0.0, 0.0], "LSODA", times, rtol=1e-9, atol=1e-11, max_step=1.0
    )
    return 3.3 + 0.8 * result.y[0] + r0 * held + result.y[1] + result.y[2]


def fit(model, held, data, scale):
    """The estimates, the number of simulations and the CPU seconds."""
    count = 0

    def residuals(logarithms):
        nonlocal count
        count += 1
        return (model(np.exp(logarithms), held) - data) / scale

    start = time.process_time()
    middle = 0.5 * (np.log(LOW) + np.log(HIGH))
    result = least_squares(residuals, middle, bounds=(np.log(LOW), np.log(HIGH)), x_scale="jac")
    return np.exp(result.x), count, time.process_time() - start


def by_gapi(program, folder):
    """The estimates and the CPU seconds of the whole process, report and intervals included."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "identify", "cell.toml", "--threads", "1", "--out", "results"]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    result = json.loads((folder / "results" / "result.json").read_text())
    return result, seconds


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    seconds = int(sys.argv[2]) if len(sys.argv) > 2 else 3600
    held = current(seconds)
    noise = np.random.default_rng(1963).normal(0, 8e-4, seconds + 1)
    data = np.round(exact(TRUTH, held) + noise, 5)
    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "Cell.mo").write_text(MODEL)
    ranges = zip(NAMES, LOW, HIGH)
    parameters = "\n".join(f"{name} = {{ min = {a:g}, max = {b:g} }}" for name, a, b in ranges)
    (folder / "cell.toml").write_text(PROBLEM.format(parameters=parameters))
    rows = (f"{t},{i:.2f},{v:.5f}" for t, (i, v) in enumerate(zip(held, data)))
    (folder / "cell.csv").write_text("t,I,V\n" + "\n".join(rows) + "\n")
    for name, model in (("exact solution by hand", exact), ("solve_ivp", integrated)):
        found, count, spent = fit(model, held, data, 8e-4)
        print(f"{name:24} {spent:8.3f} CPU s  {count:4} simulations  {found}")
    result, spent = by_gapi(program, folder)
    found = np.array([parameter["value"] for parameter in result["parameters"]])
    print(f"{'gapi identify':24} {spent:8.3f} CPU s  with report and intervals  {found}")


if __name__ == "__main__":
    main()
