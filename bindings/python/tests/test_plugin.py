"""The plugin for pytest, run by pytest."""

import re
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

CHAPTER = Path(__file__).resolve().parents[3] / "docs" / "src" / "python.md"
GOOD = 'a = 6*7;\nprint(String(a));\n'
EMBEDDED = """a := 1;
a + 1;

// Result:
// 1
// {}
// endResult
"""


def is_installed():
    """Whether pytest finds the plugin by itself; otherwise it is named, once."""
    try:
        return any(point.name == "gapilib" for point in metadata.distribution("gapilib").entry_points)
    except metadata.PackageNotFoundError:
        return False


NAMED = ["-p", "no:cacheprovider"] + ([] if is_installed() else ["-p", "pytest_gapilib"])


@pytest.fixture
def run(pytester):
    # The tests are in a process of their own.
    pytester.makepyprojecttoml("")

    def run(*arguments):
        return pytester.runpytest_subprocess(*NAMED, *arguments)

    return run


def record(pytester, name):
    """Writes the transcript of a script."""
    command = [sys.executable, "-m", "gapilib", "test", name, "--accept"]
    subprocess.run(command, cwd=pytester.path, check=True, capture_output=True)


def script(pytester, name, text):
    path = pytester.path / name
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def test_a_named_script_that_agrees_passes(pytester, run):
    script(pytester, "a.mos", GOOD)
    record(pytester, "a.mos")
    result = run("-v", "a.mos")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["*a.mos::gapi PASSED*"])


def test_differences_are_shown_where_a_script_does_not_agree(pytester, run):
    path = script(pytester, "a.mos", GOOD)
    record(pytester, "a.mos")
    path.write_text(GOOD.replace("6*7", "6*8"))
    result = run("a.mos")
    result.assert_outcomes(failed=1)
    output = result.stdout.str()
    assert "42" in output and "48" in output
    assert "Traceback" not in output and result.ret == pytest.ExitCode.TESTS_FAILED


def test_statements_of_embedded_results(pytester, run):
    script(pytester, "good.mos", EMBEDDED.format(2))
    script(pytester, "bad.mos", EMBEDDED.format(3))
    result = run("good.mos", "bad.mos")
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["statement 2: a + 1*: the output differs"])


def test_a_script_without_a_reference_fails(pytester, run):
    script(pytester, "new.mos", GOOD)
    result = run("new.mos")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["nothing is recorded"])


def test_folders_are_left_alone_unless_a_pattern_matches(pytester, run):
    for name in ["tests/a.mos", "examples/b.mos"]:
        script(pytester, name, GOOD)
        record(pytester, name)
    assert run(".").ret == pytest.ExitCode.NO_TESTS_COLLECTED
    result = run(".", "-o", "gapi_files=tests/*.mos")
    result.assert_outcomes(passed=1)
    pytester.makeini("[pytest]\ngapi_files = *.mos\n")
    run("-v").assert_outcomes(passed=2)


def test_options_are_those_of_the_command(pytester, run):
    script(pytester, "new.mos", GOOD)
    result = run("new.mos", "-o", "gapi_options=--accept")
    result.assert_outcomes(passed=1)
    assert (pytester.path / "new.mos.snap").exists()
    result = run("new.mos", "-o", "gapi_options=--nonsense")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["exit code 2", "*--nonsense*"])


def test_pytest_starts_without_the_compiled_module(pytester):
    pytester.makepyfile("import sys\ndef test_it(): assert 'gapilib' not in sys.modules")
    pytester.runpytest_subprocess(*NAMED).assert_outcomes(passed=1)


def test_the_settings_of_the_guide(pytester, run):
    [settings] = re.findall(r"```ini.*?\n(.*?)```", CHAPTER.read_text(encoding="utf-8"), re.S)
    (pytester.path / "pytest.ini").write_text(settings)
    (pytester.path / "data.txt").write_text("measured\n")
    reading = 'Modelica.Utilities.Streams.readLine("{}", 1);\n\n// Result:\n// ("measured",false)\n// endResult\n'
    # Its own folder and that of the settings can be read.
    script(pytester, "tests/fit.mos", reading.format("../data.txt"))
    script(pytester, "examples/other.mos", GOOD)
    run().assert_outcomes(passed=1)
    run("-o", "gapi_options=--time-limit").assert_outcomes(failed=1)
