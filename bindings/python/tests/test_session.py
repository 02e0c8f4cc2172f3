import threading
import time

import numpy as np
import pytest

import gapilib


def test_statements_change_variables_and_print(session, capsys):
    session.execute("a = 6*7;\nprint(String(a));\nb = {1.5, a};")
    assert session["a"] == 42 and isinstance(session["a"], int)
    np.testing.assert_array_equal(session["b"], [1.5, 42.0])
    assert capsys.readouterr().out == "42\n"
    assert "a" in session and "c" not in session
    with pytest.raises(KeyError):
        session["c"]


@pytest.mark.parametrize(
    "value",
    [
        True,
        -3,
        2.5,
        "text with \"quotes\" and ü",
        np.arange(6.0).reshape(2, 3),
        np.arange(4),
        np.array([[True], [False]]),
        [["a", "b"], ["c", "d"]],
        np.zeros((0, 3)),
    ],
)
def test_values_come_back_as_they_went(session, value):
    session["v"] = value
    found = session["v"]
    assert type(found) is type(value)
    np.testing.assert_array_equal(found, value)


def test_what_has_no_value_in_scripts_is_refused(session):
    with pytest.raises(TypeError, match="dict"):
        session["v"] = {"a": 1}
    with pytest.raises(TypeError):
        session["v"] = None
    with pytest.raises(gapilib.GapilibError, match="name of a variable"):
        session["not a name"] = 1
    with pytest.raises(gapilib.GapilibError, match="name of a variable"):
        session["end"] = 1
    with pytest.raises(OverflowError):
        session["v"] = 2**80


def test_expressions_and_records(session):
    assert session.eval("sum(1:4)") == 10
    session.load_text("record R Real a; String b; end R;")
    session.execute('r = R(1.5, "x");')
    assert session["r"] == {"a": 1.5, "b": "x"}
    with pytest.raises(gapilib.GapilibError):
        session.eval("1 +")


def test_errors_have_place_code_and_help(session):
    with pytest.raises(gapilib.GapilibError) as caught:
        session.execute('simulateModel("Decai");', name="mine.mos")
    error = caught.value
    assert error.code == "unknown-class"
    [first] = [one for one in error.diagnostics if one["severity"] == "error"]
    assert (first["file"], first["line"]) == ("mine.mos", 1)
    assert any("Decay" in help for help in first["helps"])
    assert "Decay" in str(error)


def test_errors_that_the_script_reads_end_nothing(session, capsys):
    session.execute('ok = simulateModel("Decai"); s = getLastError();')
    assert session["ok"] is False
    assert "Decai" in session["s"]
    assert "Decai" in capsys.readouterr().err


def test_classes_are_checked_and_flattened(session, tmp_path):
    assert session.check("Decay") == []
    [found] = session.check("Decay(nothing = 1)")
    assert found["severity"] == "error" and found["line"] is not None
    assert "der(x)" in session.flatten("Decay")
    file = tmp_path / "Other.mo"
    file.write_text("model Other Real y = 1; end Other;")
    assert session.load(str(file)) == ["Other"]
    with pytest.raises(gapilib.GapilibError):
        session.load(str(tmp_path / "missing.mo"))
    with pytest.raises(gapilib.GapilibError):
        session.load_text("model Broken Real y = ; end Broken;")


def test_work_is_interrupted_and_the_session_goes_on(session):
    timer = threading.Timer(0.3, session.interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        session.execute("i = 0; while true loop i = i + 1; end while;")
    assert session["i"] > 0
    session.execute("j = 1;")
    assert session["j"] == 1


def test_sessions_work_at_the_same_time_and_python_goes_on():
    sessions = [gapilib.Session(cache=False) for _ in range(2)]
    script = "s = 0; for i in 1:200000 loop s = s + i; end for;"
    workers = [threading.Thread(target=s.execute, args=(script,)) for s in sessions]
    for worker in workers:
        worker.start()
    turns = 0
    while any(worker.is_alive() for worker in workers):
        turns += 1
        time.sleep(0.001)
    assert turns > 3
    assert all(s["s"] == 20000100000 for s in sessions)


def test_one_session_serves_several_threads(session):
    def add(name):
        for _ in range(20):
            session.execute(f"{name} = 1;")

    workers = [threading.Thread(target=add, args=(f"v{k}",)) for k in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert set(session.variables()) >= {"v0", "v1", "v2", "v3"}


def test_names_are_completed_and_declared(session):
    assert "simulateModel" in session.complete("simulateM")
    assert "Decay" in session.complete("Dec")
    assert "stopTime" in session.help("simulateModel")
    assert "der(x)" in session.help("Decay")
    assert session.help("nothing") is None
