"""What the package for Python costs: polarization curves without Python, by single calls, and by `many`.

    cargo build --release --manifest-path bindings/python/Cargo.toml --example curves \\
        --features pyo3/extension-module
    python bindings/python/examples/curves.py bindings/python/target/release/examples/curves

The three are measured in turn, `--rounds` times, on one thread; printed are the smallest and the median
seconds, and the ratio of both to those without Python.
"""

import argparse
import statistics
import subprocess
import time

import numpy as np

import gapilib

NAMES = ["A", "In", "Io", "B", "R", "Ilim"]
VALUES = [0.039, 1.4e-3, 1.5856e-6, 0.0918, 7.286e-4, 0.2265]


def arguments():
    parser = argparse.ArgumentParser(description="What the package for Python costs.")
    parser.add_argument("native", help="the program made of curves.rs")
    parser.add_argument("--count", type=int, default=100_000, help="curves")
    parser.add_argument("--points", type=int, default=14, help="points of a curve")
    parser.add_argument("--rounds", type=int, default=7)
    return parser.parse_args()


def main():
    given = arguments()
    current = 0.22 * np.arange(1, given.points + 1) / given.points
    model = gapilib.Session().model("CaseStudies.PolarizationCurve")
    simulator = model.simulator(NAMES, "V", at=current, x="i", threads=1)
    rows = np.tile(VALUES, (given.count, 1))
    rows[:, 0] *= 1 + 0.1 * np.arange(given.count) / given.count
    lists = rows.tolist()

    def native():
        command = [given.native, str(given.count), str(given.points)]
        seconds, total = subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout.split()
        return float(seconds), float(total)

    def timed(curves):
        begin = time.perf_counter()
        last = curves()
        return time.perf_counter() - begin, last

    def calls(values):
        total = 0.0
        for row in values:
            total += simulator(row)[-1]
        return total

    ways = {
        "native": native,
        "many": lambda: timed(lambda: simulator.many(rows)[:, -1].sum()),
        "calls with arrays": lambda: timed(lambda: calls(rows)),
        "calls with lists": lambda: timed(lambda: calls(lists)),
    }
    seconds = {way: [] for way in ways}
    for _ in range(given.rounds):
        totals = []
        for way, measure in ways.items():
            lasted, total = measure()
            seconds[way].append(lasted)
            totals.append(total)
        np.testing.assert_allclose(totals, totals[0], rtol=1e-9)
    least = min(seconds["native"]), statistics.median(seconds["native"])
    print(f"{given.count} curves of {given.points} points: seconds (ratio)")
    for way, all_of_it in seconds.items():
        found = min(all_of_it), statistics.median(all_of_it)
        shown = [f"{value:.3f} ({value / base:.2f})" for value, base in zip(found, least)]
        print(f"{way:18} smallest {shown[0]}   median {shown[1]}")


if __name__ == "__main__":
    main()
