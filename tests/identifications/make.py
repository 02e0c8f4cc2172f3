#!/usr/bin/env python3
"""Data and expected values of the identification sets: make.py [--data]

Nothing here comes from the program under test: the models are closed forms, the optimum is that of
scipy's least squares, the data are simulated with known parameters and seeded Gaussian noise.
`initial` is the best fitness of an initial population of MRG32k3a (L'Ecuyer 1999). `best` lies between
the optimum and twice the worst of 40 runs of the paper's algorithm written in numpy; the parameters lie
within 1.5 times the confidence ellipsoid that belongs to that upper limit.
"""
import os
import sys

import numpy as np
from scipy.io import savemat
from scipy.optimize import least_squares

HERE = os.path.dirname(os.path.abspath(__file__))


def mrg(seed, n):
    """n numbers of MRG32k3a."""
    s = [int(v) for v in seed]
    out = []
    for _ in range(n):
        p1 = (1403580 * s[1] - 810728 * s[0]) % 4294967087
        p2 = (527612 * s[5] - 1370589 * s[3]) % 4294944443
        s = [s[1], s[2], p1, s[4], s[5], p2]
        out.append(((p1 - p2) if p1 > p2 else (p1 - p2 + 4294967087)) * 2.328306549295727688e-10)
    return np.array(out)


class Stream:
    """MRG32k3a that goes on where it was."""

    def __init__(self, seed):
        self.all, self.at, self.seed = np.empty(0), 0, seed

    def take(self, n):
        if self.at + n > len(self.all):
            self.all = mrg(self.seed, self.at + n)
        self.at += n
        return self.all[self.at - n:self.at]


class Problem:
    def __init__(self, f, x, low, high, truth, sd, seed, size=16, cycles=10):
        self.f, self.x = f, np.asarray(x, float)
        self.low, self.high = np.asarray(low, float), np.asarray(high, float)
        self.truth, self.size, self.cycles = truth, size, cycles
        noise = np.random.default_rng(seed).normal(0, sd, len(self.x))
        self.y = np.array([float(f"{v:.6g}") for v in f(self.x, *truth) + noise])

    def sse(self, p):
        with np.errstate(all="ignore"):
            v = np.sum((self.f(self.x, *p) - self.y) ** 2)
        return v if np.isfinite(v) else 1e60

    def optimum(self):
        scale = self.high - self.low
        r = least_squares(lambda q: self.f(self.x, *(self.low + q * scale)) - self.y,
                          (np.array(self.truth) - self.low) / scale, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        return self.low + r.x * scale, 2 * r.cost

    def initial(self):
        m = len(self.low)
        u = mrg([12345] * 6, self.size * m).reshape(self.size, m)
        return min(self.sse(p) for p in self.low + (self.high - self.low) * u)

    def genetic(self, seed, parents, elites=1, f_mut=0.25):
        rng = np.random.default_rng(seed)
        m = len(self.low)
        draw = lambda n: self.low + (self.high - self.low) * rng.random((n, m))
        pop = draw(self.size)
        for _ in range(self.cycles):
            pop = pop[np.argsort([self.sse(p) for p in pop], kind="stable")]
            kids = []
            cut = max(m // 2, 1) if m > 1 else 0
            for i in range(0, parents, 2):
                a, b = pop[i], pop[i + 1]
                kids += [np.r_[a[:cut], b[cut:]], np.r_[b[:cut], a[cut:]]]
            kids = np.array(kids)
            u = rng.random(kids.shape)
            kids = np.where(u < f_mut, self.low + (self.high - self.low) * u / f_mut, kids)
            pop = np.vstack([pop[:elites], kids, draw(self.size - elites - len(kids))])
        return min(self.sse(p) for p in pop)

    def replayed(self, parents, cycles, seed=(12345,) * 6, f_mut=0.25, elites=1):
        """The best of the last generation, in the order that most of the scripts have: all numbers of a
        generation from one list, row by row; adjacent ranks paired; the random individuals last. Numbers
        and operators are those of the paper's description and of L'Ecuyer (1999)."""
        n, m = self.size, len(self.low)
        state = Stream(seed)
        draw = lambda: state.take(n * m).reshape(n, m)
        spread = lambda u: self.low + (self.high - self.low) * u
        pop = spread(draw())
        for cycle in range(cycles):
            sse = np.array([self.sse(p) for p in pop])
            order = np.argsort(sse, kind="stable")
            best, pop = sse[order[0]], pop[order]
            cut = max(m // 2, 1)
            kids = []
            for i in range(0, parents, 2):
                a, b = pop[i], pop[i + 1]
                kids += [np.r_[a[:cut], b[cut:]], np.r_[b[:cut], a[cut:]]]
            u = draw()
            changed = np.vstack([pop[:elites], kids])
            lots = u[: len(changed)]
            mutated = np.where(lots < f_mut, spread(lots / f_mut), changed)
            mutated[:elites] = changed[:elites]
            first = pop[0]
            pop = np.vstack([mutated, spread(u[len(changed):])])
        return best, first

    def expected(self, upper=None):
        p, s = self.optimum()
        if upper is None:
            upper = 2 * max(self.genetic(seed, 10) for seed in range(40))
        J = np.empty((len(self.x), len(p)))
        for j in range(len(p)):
            h = 1e-5 * (self.high[j] - self.low[j])
            d = np.zeros(len(p)); d[j] = h
            J[:, j] = (self.f(self.x, *(p + d)) - self.f(self.x, *(p - d))) / (2 * h)
        width = 1.5 * np.sqrt(np.diag(np.linalg.inv(J.T @ J)) * max(upper - s, 0))
        lines = [f"best = {0.9995 * s:.8g} .. {upper:.8g}"]
        for j in range(len(p)):
            low, high = max(p[j] - width[j], self.low[j]), min(p[j] + width[j], self.high[j])
            lines.append(f"p{j + 1} = {low:.8g} .. {high:.8g}")
        return lines


def around(key, value, rel):
    return f"{key} = {value - rel * abs(value):.9g} .. {value + rel * abs(value):.9g}"


t10 = np.linspace(0.5, 5, 10)
SETS = {
    # a mass that decays; the paper's four scripts
    "decay": Problem(lambda t, k, x0: x0 * np.exp(-k * t), t10, [0.1, 0.5], [2, 3], [0.6, 1.7], 0.02, 1),
    # a capacitor that is charged
    "capacitor": Problem(lambda t, U, tau: U * (1 - np.exp(-t / tau)), t10, [1, 0.2], [10, 4], [5, 1.3], 0.05, 2),
    # a cup that cools
    "cup": Problem(lambda t, Ta, tau: Ta + (90 - Ta) * np.exp(-t / tau), np.linspace(0, 30, 13), [10, 5], [30, 40], [21, 14], 0.4, 3),
    # yeast that grows (Verhulst)
    "yeast": Problem(lambda t, r, K: K / (1 + (K / 0.5 - 1) * np.exp(-r * t)), np.linspace(0, 12, 13), [0.2, 5], [1.2, 20], [0.55, 11], 0.2, 4),
    # rate of an enzyme over the concentration
    "enzyme": Problem(lambda s, v, K: v * s / (K + s), [0.2, 0.5, 1, 2, 3, 5, 8], [0.5, 0.1], [5, 4], [2.2, 0.9], 0.03, 5),
    # a spring with damper
    "spring": Problem(lambda t, w, d: np.exp(-d * t) * (np.cos(np.sqrt(w * w - d * d) * t) + d / np.sqrt(w * w - d * d) * np.sin(np.sqrt(w * w - d * d) * t)),
                      np.linspace(0.2, 6, 20), [1, 0.05], [3, 0.8], [2, 0.3], 0.02, 6),
    # a thrown stone
    "throw": Problem(lambda t, v, g: v * t - g * t * t / 2, np.linspace(0.1, 1.5, 9), [5, 5], [20, 15], [12, 9.81], 0.05, 7),
    # A -> B -> C
    "chain": Problem(lambda t, a, b: a / (b - a) * (np.exp(-a * t) - np.exp(-b * t)), np.linspace(0.5, 10, 12), [0.6, 0.05], [2, 0.5], [1.1, 0.2], 0.01, 8),
    # a polarization curve without mass transport, over the current; from 0.5 Ohm on the model fails
    "tafel": Problem(lambda i, A, R: 1.0 - A * np.log(i / 1e-3) - R * i if R < 0.5 else np.nan * i, [0.01, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0], [0.01, 0.05], [0.1, 0.6], [0.045, 0.23], 0.002, 9),
    # adsorption after Langmuir
    "langmuir": Problem(lambda p, q, K: q * K * p / (1 + K * p), [0.1, 0.3, 0.6, 1, 2, 4], [0.5, 0.2], [4, 5], [1.8, 1.4], 0.02, 10),
    # adsorption after Freundlich
    "freundlich": Problem(lambda p, K, n: K * p ** n, [0.1, 0.3, 0.6, 1, 2, 4], [0.5, 0.1], [3, 1], [1.3, 0.4], 0.02, 11),
    # a vessel that runs empty
    "vessel": Problem(lambda t, k, h: np.maximum(np.sqrt(h) - k * t / 2, 0) ** 2, np.linspace(0, 8, 9), [0.02, 0.5], [0.2, 2], [0.09, 1.2], 0.01, 12),
    # a tumour that grows (Gompertz)
    "gompertz": Problem(lambda t, a, b: np.exp(a / b * (1 - np.exp(-b * t))), np.linspace(0, 10, 11), [0.2, 0.1], [1, 0.6], [0.6, 0.25], 0.15, 13),
    # the answer of a sensor to a ramp
    "ramp": Problem(lambda t, K, tau: K * (t - tau + tau * np.exp(-t / tau)), t10, [0.5, 0.1], [3, 3], [1.4, 0.8], 0.03, 14),
    # a reaction of the second order
    "second_order": Problem(lambda t, k, c: c / (1 + c * k * t), np.linspace(0, 10, 11), [0.05, 0.5], [1, 3], [0.3, 1.5], 0.01, 15),
    # a drug that is taken up and excreted (Bateman)
    "drug": Problem(lambda t, ka, ke: 10 * ka / (ka - ke) * (np.exp(-ke * t) - np.exp(-ka * t)), np.linspace(0.5, 12, 12), [0.6, 0.05], [3, 0.5], [1.4, 0.18], 0.1, 16),
    # a thermistor over the temperature
    "thermistor": Problem(lambda T, R, B: R * np.exp(B * (1 / T - 1 / 298.15)), np.linspace(280, 340, 7), [5, 2500], [15, 4500], [10, 3450], 0.05, 17),
    # a pendulum of small amplitude
    "pendulum": Problem(lambda t, L, a: a * np.cos(np.sqrt(9.81 / L) * t), np.linspace(0.1, 3, 15), [0.5, 0.05], [1.5, 0.3], [0.8, 0.15], 0.003, 18),
    # a motor that starts: one parameter
    "motor": Problem(lambda t, tau: 100 * (1 - np.exp(-t / tau)), t10, [0.1], [3], [0.75], 0.8, 19),
    # heat loss of a house, three parameters
    "house": Problem(lambda t, Ta, tau, T0: Ta + (T0 - Ta) * np.exp(-t / tau), np.linspace(0, 24, 13), [-5, 4, 15], [10, 30, 25], [2, 12, 21], 0.1, 20, size=24, cycles=14),
}


def write_data(name, p):
    folder = os.path.join(HERE, name)
    os.makedirs(folder, exist_ok=True)
    kind = FORMAT.get(name, "mat")
    x, y = FORMAT_NAMES.get(name, ("X", "Y"))
    if kind == "mat":
        savemat(os.path.join(folder, "data.mat"), {x: p.x.reshape(-1, 1), y: p.y.reshape(-1, 1)}, format="4")
    elif kind == "row":
        savemat(os.path.join(folder, "data.mat"), {x: p.x.reshape(1, -1), y: p.y.reshape(1, -1)}, format="4")
    elif kind == "v7":
        savemat(os.path.join(folder, "data.mat"), {x: p.x.reshape(-1, 1), y: p.y.reshape(-1, 1)}, do_compression=False)
    elif kind == "csv":
        with open(os.path.join(folder, "data.csv"), "w") as f:
            f.write(f"{x},{y}\n" + "".join(f"{a:.6g},{b:.6g}\n" for a, b in zip(p.x, p.y)))
    elif kind == "text":
        with open(os.path.join(folder, "data.txt"), "w") as f:
            f.write("#1\n")
            for key, column in ((x, p.x), (y, p.y)):
                f.write(f"double {key}({len(column)},1)\n" + "".join(f"{v:.6g}\n" for v in column))


FORMAT = {"capacitor": "csv", "yeast": "csv", "enzyme": "text", "throw": "row", "chain": "v7", "tafel": "csv",
          "freundlich": "text", "gompertz": "csv", "drug": "text", "pendulum": "csv", "motor": "row", "house": "v7"}
FORMAT_NAMES = {"capacitor": ("t", "u"), "yeast": ("horas", "biomasa"), "enzyme": ("S", "v"), "tafel": ("i", "V"),
                "gompertz": ("Tag", "Volumen"), "pendulum": ("t", "phi"), "drug": ("temps", "c"), "house": ("h", "T")}


def main():
    for name, p in SETS.items():
        if "--data" in sys.argv:
            write_data(name, p)
        if name in REPLAYED:
            best, genes = p.replayed(*REPLAYED[name])
            # The script of `throw` interpolates between 100 points.
            lines = [around("best", best, 1e-2 if name == "throw" else 2e-3)]
            lines += [around(f"p{j + 1}", v, 1e-4) for j, v in enumerate(genes)]
        elif name in MINIMA:
            genes, best = p.optimum()
            lines = [around("best", best, 1e-4)]
            lines += [around(f"p{j + 1}", v, 1e-3) for j, v in enumerate(genes)]
        else:
            lines = p.expected()
        if name in WITH_INITIAL:
            lines.append(around("initial", p.initial(), 2e-3))
        with open(os.path.join(HERE, name, "expected.txt"), "w") as f:
            f.write("\n".join(lines) + "\n")


# Sets whose first population is MRG32k3a's first numbers, row by row, from the default seed.
WITH_INITIAL = ["decay", "capacitor", "yeast", "spring", "throw", "langmuir", "vessel", "ramp", "second_order", "thermistor", "motor"]

# Sets whose random numbers and operators are followed number by number: parents, generations, seed.
REPLAYED = {
    "decay": (10, 11), "capacitor": (10, 11), "yeast": (10, 10), "throw": (10, 8), "langmuir": (10, 10), "vessel": (10, 10),
    "second_order": (10, 10), "thermistor": (10, 10), "tafel": (10, 10, (3, 1, 4, 1, 5, 9)), "drug": (10, 10, (5, 5, 5, 6, 6, 6)),
}

# Sets whose script goes to the minimum by itself.
MINIMA = ["ramp"]

if __name__ == "__main__":
    main()
