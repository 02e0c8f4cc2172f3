"""Other processes, other ways to keep results, and what interrupts."""

import copy
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import gapilib

from conftest import DECAY

TIMES = [0.5, 1.0]

#: Its fast component needs steps of 1e-6 s to the end: minutes.
SLOW = """
model Slow
  parameter Real w = 1e6;
  Real x(start = 0, fixed = true);
  Real v(start = 1, fixed = true);
equation
  der(x) = w*v;
  der(v) = -w*x;
end Slow;
"""
# The same with so much to do at each step that the limit on the number of steps is reached after some
# ten seconds: that of two states is reached within half a second.
LONG = SLOW.replace("equation\n", """\
  Real y[1000](each start = 0, each fixed = true);
equation
  for i in 1:1000 loop
    der(y[i]) = w*v - i*y[i];
  end for;
""")


def test_results_are_pickled_and_copied(decay):
    result = decay.simulate({"k": 3.0})
    for again in [pickle.loads(pickle.dumps(result)), copy.deepcopy(result)]:
        assert list(again) == result.names and again.units == result.units
        assert again.statistics == result.statistics and repr(again) == repr(result)
        np.testing.assert_array_equal(again.time, result.time)
        for name in result:
            np.testing.assert_array_equal(again[name], result[name])


def test_what_is_not_the_state_of_a_result_is_refused(decay):
    restore, (model, when, series, counts) = decay.simulate().__reduce__()
    name, unit, description, values = series[0]
    for wrong in [np.zeros(1), (len(series), False)]:
        with pytest.raises(ValueError):
            restore(model, when, [(name, unit, description, wrong), *series[1:]], counts)


@pytest.mark.parametrize("what", ["session", "decay"])
def test_what_belongs_to_a_process_is_not_pickled(what, request):
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(request.getfixturevalue(what))


def _forked(work):
    """What `work` gives or raises in a forked process; it hangs no longer than a minute."""
    context = multiprocessing.get_context("fork")
    answers = context.SimpleQueue()

    def child():
        try:
            answers.put(work())
        except Exception as error:
            answers.put(error)

    process = context.Process(target=child)
    process.start()
    process.join(60)
    if process.is_alive():
        process.kill()
        pytest.fail("the forked process hangs")
    # One that has died has said nothing.
    assert process.exitcode == 0 and not answers.empty()
    return answers.get()


needs_fork = pytest.mark.skipif(
    "fork" not in multiprocessing.get_all_start_methods(), reason="this system does not fork"
)


@needs_fork
def test_a_forked_process_simulates_with_the_simulators_of_its_parent(decay):
    simulator = decay.simulator(["k"], "x", TIMES)
    rows = [[1.0], [2.0], [3.0]]
    expected = simulator.many(rows)
    np.testing.assert_array_equal(_forked(lambda: simulator.many(rows)), expected)
    np.testing.assert_array_equal(_forked(lambda: simulator(rows[1])), expected[1])


@needs_fork
def test_a_forked_process_needs_a_session_of_its_own(session, decay):
    error = _forked(decay.simulate)
    assert isinstance(error, RuntimeError) and "session in each process" in str(error)
    assert isinstance(_forked(lambda: session.execute("a = 1;")), RuntimeError)

    # What is read in pieces is spread over threads, which a forked process does not have.
    classes = "".join(f"model M{k} Real x = {k}; end M{k}; " for k in range(40))

    def own():
        session = gapilib.Session(cache=False)
        session.load_text(classes)
        session.execute("a = 6*7;")
        return session["a"], session.model("M7").simulate(stop=1.0)["x"][-1]

    assert own() == (42, 7)
    assert _forked(own) == (42, 7)


@needs_fork
def test_what_a_call_has_used_is_free_behind_it(decay):
    simulator = decay.simulator(["k"], "x", TIMES)
    rows = [[1.0], [2.0], [3.0]]
    expected = simulator.many(rows)
    for _ in range(20):
        simulator.many(rows)
        np.testing.assert_array_equal(_forked(lambda: simulator.many(rows)), expected)


@needs_fork
def test_a_process_that_was_forked_during_other_work_is_refused(tmp_path, decay):
    (tmp_path / "data.csv").write_text("t,x\n0.5,0.4\n1.0,0.1\n1.5,0.05\n")
    (tmp_path / "Decay.mo").write_text(DECAY)
    simulator = decay.simulator(["k"], "x", TIMES)
    errors = []

    def fork(*_):
        # Called while the session's thread works.
        if not errors:
            errors.extend(_forked(work) for work in (lambda: simulator([1.0]), gapilib.Session))

    gapilib.identify(
        {
            "model": "Decay",
            "files": ["Decay.mo"],
            "parameters": {"k": {"min": 0.1, "max": 10.0}},
            "experiment": [{"data": "data.csv", "x": {"variable": "time", "column": "t"}, "outputs": {"x": "x"}}],
        },
        progress=fork,
    )
    assert len(errors) == 2
    for error in errors:
        assert isinstance(error, RuntimeError) and "forked while another thread was at work" in str(error)
    # Behind it a process is sound again.
    np.testing.assert_array_equal(_forked(lambda: simulator([1.0])), simulator([1.0]))


@needs_fork
def test_long_work_in_a_forked_process_is_interrupted(session):
    session.load_text(LONG)
    simulator = session.model("Slow").simulator(["w"], "x", [5000.0])
    short = session.model("Slow").simulator(["w"], "x", [1e-3])
    short([1.0])

    def interrupted():
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        try:
            return simulator([1e6])
        except KeyboardInterrupt:
            return "interrupted"

    assert _forked(interrupted) == "interrupted"


INTERRUPTED = """
import gapilib, sys
session = gapilib.Session(cache=False, threads=1)
session.load_text(sys.argv[1])
model = session.model("Slow")
simulator = model.simulator(["w"], "x", [5000.0])
simulate = {
    "call": lambda: simulator([1e6]),
    "jacobian": lambda: simulator.jacobian([1e6]),
    "many": lambda: simulator.many([[1e6], [2e6]]),
    "simulate": lambda: model.simulate(stop=5000.0),
    "execute": lambda: session.execute('ok = simulateModel("Slow", stopTime = 5000);'),
}[sys.argv[2]]
print("begun", flush=True)
try:
    simulate()
except KeyboardInterrupt:
    print("interrupted", flush=True)
# What was interrupted is not in the way of what follows.
assert session.model("Slow(w = 1)").simulate(stop=1.0)["v"][0] == 1
assert abs(model.simulator(["w"], "x", [1e-3])([1.0])[0] - 1e-3) < 1e-5
print("goes on", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent in another way")
@pytest.mark.parametrize("what", ["call", "jacobian", "many", "simulate", "execute"])
def test_long_work_is_interrupted(what):
    command = [sys.executable, "-c", INTERRUPTED, LONG, what]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "begun\n"
            time.sleep(0.5)
            assert process.poll() is None, "it has ended already"
            process.send_signal(signal.SIGINT)
            assert process.stdout.readline() == "interrupted\n"
            assert process.stdout.readline() == "goes on\n"
        finally:
            process.kill()


def test_a_call_that_turns_out_to_be_long_gives_the_same(session):
    session.load_text(SLOW)
    model = session.model("Slow")
    # Some tenths of a second: begun again on another thread; short ones before and behind it.
    simulator = model.simulator(["w"], ["x", "v"], [0.5], tolerance=1e-8)
    [expected] = simulator.many([[3e4]])
    for w in [1.0, 3e4, 3e4, 1.0]:
        found = simulator([w])
        np.testing.assert_array_equal(found, simulator.many([[w]])[0])
    np.testing.assert_array_equal(simulator([3e4]), expected)


def test_python_goes_on_while_one_simulation_is_made(session):
    session.load_text(SLOW)
    simulator = session.model("Slow").simulator(["w"], "x", [1.0], tolerance=1e-8)
    worker = threading.Thread(target=simulator, args=([3e4],))
    worker.start()
    turns = 0
    while worker.is_alive():
        turns += 1
        time.sleep(0.001)
    assert turns > 3
