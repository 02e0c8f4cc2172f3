"""What all tests share: a folder of their own, and a model with a known solution."""

import pytest

import gapilib

DECAY = """
model Decay
  parameter Real k(min = 0, unit = "1/s") = 1;
  parameter Real a = 1;
  Real x(start = a, fixed = true, unit = "V");
  output Real y = 2*x;
equation
  assert(k < 50, "k is too large");
  der(x) = -k*x;
  annotation(experiment(StopTime = 2, Tolerance = 1e-8));
end Decay;
"""


@pytest.fixture(autouse=True)
def own_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def session():
    session = gapilib.Session(cache=False, threads=2)
    session.load_text(DECAY)
    return session


@pytest.fixture
def decay(session):
    return session.model("Decay")
