"""Adapters for other packages: values and derivatives against formulas and differences."""

import numpy as np
import pytest

TIMES = np.linspace(0.1, 1.5, 8)
AT = np.array([2.0, 1.5])


@pytest.fixture
def single(decay):
    return decay.simulator(["k", "a"], "x", at=TIMES, tolerance=1e-10)


@pytest.fixture
def double(decay):
    return decay.simulator(["k", "a"], ["x", "y"], at=TIMES, tolerance=1e-10)


def exact(values):
    return values[..., 1:] * np.exp(-values[..., :1] * TIMES)


def loss(values):
    """Depends on all outputs differently."""
    return float((exact(np.asarray(values)) ** 2 * np.arange(1, 9)).sum())


def difference(function, at, step=1e-6):
    """Central differences."""
    units = step * np.eye(len(at))
    return np.array([(function(at + unit) - function(at - unit)) / (2 * step) for unit in units])


def test_jax(single, double):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    from gapilib.jax import function

    simulate, weights = function(single), np.arange(1, 9)
    np.testing.assert_allclose(simulate(AT), exact(AT), rtol=1e-7)

    def objective(values):
        return (simulate(values) ** 2 * weights).sum()

    slope = difference(loss, AT)
    np.testing.assert_allclose(jax.grad(objective)(AT), slope, rtol=1e-6)
    np.testing.assert_allclose(jax.jit(jax.grad(objective))(AT), slope, rtol=1e-6)
    # Forward mode has the same rule.
    np.testing.assert_allclose(jax.jacfwd(objective)(AT), slope, rtol=1e-6)
    rows = np.stack([AT, 2 * AT, [100.0, 1.0]])
    batch = jax.vmap(simulate)(rows)
    np.testing.assert_allclose(batch[:2], exact(rows[:2]), rtol=1e-7)
    # A row whose simulation fails is not a number.
    assert np.isnan(batch[2]).all()
    gradients = jax.vmap(jax.grad(objective))(rows[:2])
    np.testing.assert_allclose(gradients[1], difference(loss, rows[1]), rtol=1e-6)
    two = function(double)
    np.testing.assert_allclose(two(AT)[:, 1], 2 * exact(AT), rtol=1e-7)
    assert jax.jacrev(two)(AT).shape == (8, 2, 2)
    with pytest.raises(ValueError, match="vmap"):
        simulate(rows)


def test_jax_descends_a_gradient(single):
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    from gapilib.jax import function

    simulate, measured = function(single), exact(AT)
    step = jax.jit(jax.value_and_grad(lambda values: ((simulate(values) - measured) ** 2).sum()))
    values = np.array([1.0, 1.0])
    for _ in range(400):
        objective, slope = step(values)
        values = values - 0.4 * np.asarray(slope)
    assert objective < 1e-6
    np.testing.assert_allclose(values, AT, rtol=1e-2)


def test_torch(single, double):
    torch = pytest.importorskip("torch")
    from gapilib.torch import function

    simulate = function(single)
    values = torch.tensor(AT, requires_grad=True)
    (simulate(values) ** 2 * torch.arange(1, 9)).sum().backward()
    np.testing.assert_allclose(values.grad, difference(loss, AT), rtol=1e-6)
    assert torch.autograd.gradcheck(simulate, torch.tensor(AT, requires_grad=True), rtol=1e-4, atol=1e-6)
    assert torch.autograd.gradcheck(function(double), torch.tensor(AT, requires_grad=True), rtol=1e-4, atol=1e-6)
    rows = torch.tensor(np.stack([AT, 2 * AT]), requires_grad=True)
    (simulate(rows) ** 2 * torch.arange(1, 9)).sum().backward()
    np.testing.assert_allclose(rows.grad[1], difference(loss, 2 * AT), rtol=1e-6)
    # Without gradients a failed row of a batch is not a number.
    assert torch.isnan(simulate(torch.tensor([[2.0, 1.5], [100.0, 1.0]]).double())[1]).all()


def test_pytensor(single, double):
    pytensor = pytest.importorskip("pytensor")
    import pytensor.tensor as pt
    from gapilib.pytensor import function

    k, a = pt.dscalars("k", "a")
    outputs = function(single)([k, a])
    objective = (outputs**2 * np.arange(1, 9)).sum()
    compiled = pytensor.function([k, a], [objective, *pytensor.grad(objective, [k, a])], mode="FAST_COMPILE")
    found = compiled(*AT)
    assert float(found[0]) == pytest.approx(loss(AT), rel=1e-7)
    np.testing.assert_allclose(found[1:], difference(loss, AT), rtol=1e-6)
    values = pt.dvector("values")
    total = function(double)(values).sum()
    slope = pytensor.function([values], pytensor.grad(total, values), mode="FAST_COMPILE")(AT)
    np.testing.assert_allclose(slope, difference(lambda v: 3 * exact(v).sum(), AT), rtol=1e-6)


def test_pypesto(single):
    pytest.importorskip("pypesto")
    from gapilib.pypesto import objective

    measured = exact(AT) + 0.01 * np.cos(np.arange(8))
    own = objective(single, measured, sigma=0.01)
    at = np.array([1.7, 1.2])

    def value(values):
        return 0.5 * float((((exact(values) - measured) / 0.01) ** 2).sum())

    assert own(at) == pytest.approx(value(at), rel=1e-7)
    np.testing.assert_allclose(own(at, sensi_orders=(1,)), difference(value, at), rtol=1e-5)
    residuals = own(at, mode="mode_res")
    assert 0.5 * residuals @ residuals == pytest.approx(value(at), rel=1e-7)
    assert own(np.array([100.0, 1.0])) == np.inf
    # A value that is missing is left out.
    measured[3] = np.nan
    assert np.isfinite(objective(single, measured)(at))


def test_scipy(single):
    optimize = pytest.importorskip("scipy.optimize")
    measured = exact(AT)
    found = optimize.least_squares(
        lambda values: single(values) - measured, [1.0, 1.0], jac=lambda values: single.jacobian(values)[1]
    )
    np.testing.assert_allclose(found.x, AT, rtol=1e-6)
    error = optimize.check_grad(
        lambda values: float(single(values).sum()), lambda values: single.jacobian(values)[1].sum(axis=0), AT
    )
    assert error < 1e-4


def test_optuna(single):
    optuna = pytest.importorskip("optuna")
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    measured = exact(AT)

    def objective(trial):
        values = [trial.suggest_float("k", 0.1, 10, log=True), trial.suggest_float("a", 0.1, 5)]
        return float(((single(values) - measured) ** 2).sum())

    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=1))
    study.optimize(objective, n_trials=60)
    assert study.best_value < 0.1
