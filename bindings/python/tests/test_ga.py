from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import gapilib
from gapilib import ga

SEED = [1, 2, 3, 4, 5, 6]
BOUNDS = [(-2.0, 2.0), (-1.0, 3.0)]


def rosenbrock(genes):
    return (1 - genes[0]) ** 2 + 100 * (genes[1] - genes[0] ** 2) ** 2


def reference(seed, count):
    """MRG32k3a as its author gives it (L'Ecuyer 1999)."""
    m1, m2 = 4294967087, 4294944443
    x, y = list(seed[:3]), list(seed[3:])
    for _ in range(count):
        p1 = (1403580 * x[1] - 810728 * x[0]) % m1
        p2 = (527612 * y[2] - 1370589 * y[0]) % m2
        x, y = [*x[1:], p1], [*y[1:], p2]
        yield ((p1 - p2) % m1 or m1) * 2.328306549295728e-10


def test_random_numbers_are_those_of_the_generator():
    np.testing.assert_allclose(ga.Random([12345] * 6).uniform(1000), list(reference([12345] * 6, 1000)), rtol=0, atol=0)
    random = ga.Random(SEED)
    random.uniform(5)
    np.testing.assert_array_equal(ga.Random(random.state).uniform(3), random.uniform(3))
    with pytest.raises(gapilib.GapilibError):
        ga.Random([0, 0, 0, 1, 1, 1])


@pytest.mark.parametrize("method", ["genetic", "gapilib2006", "lshade", "cma-es", "nelder-mead"])
def test_searches_are_reproducible_and_stay_within_their_bounds(method):
    def search():
        found, search = [], ga.Optimizer(BOUNDS, method=method, seed=SEED)
        for _ in range(20):
            rows = search.ask()
            if not len(rows):
                break
            assert (rows >= [-2, -1]).all() and (rows <= [2, 3]).all()
            np.testing.assert_array_equal(rows, search.ask())
            search.tell([rosenbrock(row) for row in rows])
            found.append(rows)
        return found, search.best

    (first, best), (second, again) = search(), search()
    for one, other in zip(first, second):
        np.testing.assert_array_equal(one, other)
    assert best[1] == again[1] == min(rosenbrock(row) for rows in first for row in rows)


def test_unknown_methods_and_settings_are_refused():
    for wrong in [
        dict(method="genetics"),
        dict(settings={"populatoin": 5}),
        dict(settings={"population": -5}),
        dict(settings={"crossover": "sbxx"}),
    ]:
        with pytest.raises(gapilib.GapilibError):
            ga.Optimizer(BOUNDS, **wrong).ask()
    with pytest.raises(gapilib.GapilibError):
        ga.Optimizer([(1.0, 0.0)])
    with pytest.raises(ValueError):
        ga.Optimizer([])
    search = ga.Optimizer(BOUNDS)
    with pytest.raises(RuntimeError):
        search.tell([1.0])
    search.ask()
    with pytest.raises(ValueError):
        search.tell([1.0])


def test_executors_do_not_change_the_result():
    alone = ga.minimize(rosenbrock, BOUNDS, generations=30, seed=SEED)
    with ThreadPoolExecutor(3) as executor:
        together = ga.minimize(rosenbrock, BOUNDS, generations=30, seed=SEED, executor=executor)
    np.testing.assert_array_equal(alone[0], together[0])
    assert alone[1] == together[1] < 0.1


def test_failed_individuals_are_survived():
    def objective(genes):
        if genes[0] > 0:
            raise ZeroDivisionError
        return float(np.sum(np.square(genes)))

    genes, fitness = ga.minimize(objective, BOUNDS, generations=60, seed=SEED)
    assert genes[0] <= 0 and fitness < 0.01


def test_least_squares_by_ask_and_tell():
    x = np.linspace(0, 1, 12)
    measured = 0.7 * np.exp(-1.9 * x)
    search = ga.Optimizer(
        [(0.1, 2.0), (0.1, 5.0)],
        method="levenberg-marquardt",
        start=[1.5, 0.5],
        data_norm=float(np.linalg.norm(measured)),
    )
    for _ in range(60):
        rows = search.ask()
        if not len(rows):
            break
        model = rows[:, :1] * np.exp(-rows[:, 1:] * x)
        residuals = model - measured
        jacobians = np.stack([model / rows[:, :1], -x * model], axis=-1)
        search.tell((residuals**2).sum(axis=1), residuals, jacobians)
    genes, fitness = search.best
    np.testing.assert_allclose(genes, [0.7, 1.9], rtol=1e-6)
    assert fitness < 1e-12


def test_operators():
    random = ga.Random(SEED)
    population = ga.sample(BOUNDS, 8, method="latin_hypercube", random=random)
    assert population.shape == (8, 2)
    parents = ga.select([3.0, 1.0, 2.0], 2, method="truncation(share = 1)", random=random)
    assert list(parents) == [1, 2]
    children = ga.cross(population, BOUNDS, method="one_point", random=random)
    np.testing.assert_array_equal(np.sort(children, axis=0), np.sort(population, axis=0))
    np.testing.assert_array_equal(ga.mutate(population, BOUNDS, 0.0, random=random), population)
    mutated = ga.mutate(population, BOUNDS, 1.0, random=random)
    assert (mutated != population).all() and (mutated >= [-2, -1]).all() and (mutated <= [2, 3]).all()
    with pytest.raises(gapilib.GapilibError):
        ga.cross(population, BOUNDS, method="zero_point", random=random)
    with pytest.raises(ValueError):
        ga.mutate(population, BOUNDS[:1], 1.0, random=random)
