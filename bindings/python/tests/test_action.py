"""The action for GitHub: its steps run here, with a release that a stand-in for `gh` serves."""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

yaml = pytest.importorskip("yaml")
if os.name == "nt" or not shutil.which("bash") or not shutil.which("sha256sum"):
    pytest.skip("the steps need bash and sha256sum", allow_module_level=True)

ACTION = Path(__file__).resolve().parents[3] / ".github" / "actions" / "test" / "action.yml"
CHAPTER = Path(__file__).resolve().parents[3] / "docs" / "src" / "python.md"
ARCHIVE = "gapi-0.1.0-x86_64-linux.tar.gz"


def program(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("#!/usr/bin/env bash\n" + text)
    path.chmod(0o755)


@pytest.fixture
def runner(tmp_path):
    """A folder as that of a runner: `release` with the files of a release, `bin` with what is installed."""
    program(tmp_path / "gapi-0.1.0-x86_64-linux" / "gapi", f'exec "{sys.executable}" -m gapilib "$@"\n')
    release = tmp_path / "release"
    release.mkdir()
    with tarfile.open(release / ARCHIVE, "w:gz") as archive:
        archive.add(tmp_path / "gapi-0.1.0-x86_64-linux", "gapi-0.1.0-x86_64-linux")
    sum = hashlib.sha256((release / ARCHIVE).read_bytes()).hexdigest()
    (release / "SHA256SUMS").write_text(f"{sum}  {ARCHIVE}\n{'0' * 64}  gapilib-0.1.0.whl\n")
    program(tmp_path / "bin" / "gh", f'echo "$GH_REPO $@" >> "{tmp_path}/asked"\ncp "{release}"/* .\n')
    (tmp_path / "a.mos").write_text("a := 6*7;\n\n// Result:\n// 42\n// endResult\n")
    (tmp_path / "b.mos").write_text("a := 6*7;\n\n// Result:\n// 43\n// endResult\n")
    return tmp_path


def run(runner, name, **inputs):
    """Executes a step with the inputs; the others have their defaults."""
    action = yaml.safe_load(ACTION.read_text(encoding="utf-8"))
    assert action["runs"]["using"] == "composite"
    [step] = [step for step in action["runs"]["steps"] if step["name"] == name]
    values = {f"inputs.{key}": one["default"] for key, one in action["inputs"].items()}
    values.update({f"inputs.{key}": one for key, one in inputs.items()})
    values.update({"runner.os": "Linux", "runner.arch": "X64", "runner.temp": str(runner / "temp")})
    values.update({"github.action_repository": "owner/name", "github.token": "secret"})

    def filled(text):
        return re.sub(r"\$\{\{ *([\w.]+) *\}\}", lambda found: filled(values[found.group(1)]), text)

    added = runner / "path"
    on_path = added.read_text().split() if added.exists() else []
    environment = {key: filled(one) for key, one in step["env"].items()}
    path = os.pathsep.join([*on_path, str(runner / "bin"), "/usr/bin", "/bin"])
    environment.update({"GITHUB_PATH": str(added), "PATH": path})
    environment.update({key: os.environ[key] for key in ["HOME", "PYTHONPATH"] if key in os.environ})
    # What the inputs hold reaches the shell in variables alone: it is not executed.
    assert "${{" not in step["run"]
    return subprocess.run(
        ["bash", "-c", step["run"]], cwd=runner, env=environment, capture_output=True, text=True
    )


def test_a_release_is_installed_and_scripts_are_compared(runner):
    assert shutil.which("gapi", path="/usr/bin:/bin") is None
    installed = run(runner, "Install gapi", version="0.1.0")
    assert installed.returncode == 0, installed.stderr
    assert f"{ARCHIVE}: OK" in installed.stdout
    assert "owner/name release download v0.1.0" in (runner / "asked").read_text()
    tested = run(runner, "Run gapi test", paths="a.mos\nb.mos", junit="report.xml")
    assert tested.returncode == 1
    suite = ElementTree.parse(runner / "report.xml").getroot()
    names = [case.get("name") for case in suite.iter("testcase") if case.get("classname") == "gapi"]
    assert names == ["a.mos", "b.mos"] and "43" in tested.stdout
    tested = run(runner, "Run gapi test", paths="a.mos", options="--interpret --time-limit 60")
    assert tested.returncode == 0, tested.stderr
    assert (runner / "gapi.xml").exists()


def test_without_a_version_the_latest_release_is_asked_for(runner):
    assert run(runner, "Install gapi").returncode == 0
    assert "owner/name release download --pattern" in (runner / "asked").read_text()


def test_an_archive_that_is_not_that_of_the_release_is_refused(runner):
    sums = runner / "release" / "SHA256SUMS"
    sums.write_text(f"{'0' * 64}  {ARCHIVE}\n")
    refused = run(runner, "Install gapi")
    assert refused.returncode != 0 and "FAILED" in refused.stdout
    assert not (runner / "path").exists()


def test_a_program_that_is_there_is_used(runner):
    program(runner / "bin" / "gapi", "echo here $@\n")
    found = run(runner, "Install gapi")
    assert (found.returncode, found.stdout) == (0, "here --version\n")
    assert not (runner / "asked").exists()


def test_the_example_of_the_guide_has_inputs_of_the_action(runner):
    [example] = re.findall(r"```yaml.*?\n(.*?)```", CHAPTER.read_text(encoding="utf-8"), re.S)
    [step] = yaml.safe_load(example)
    folder = ACTION.parent.relative_to(ACTION.parents[3]).as_posix()
    assert step["uses"].split("@")[0] == f"OWNER/NAME/{folder}"
    action = yaml.safe_load(ACTION.read_text(encoding="utf-8"))
    assert set(step["with"]) <= set(action["inputs"])
    assert run(runner, "Install gapi").returncode == 0
    (runner / "tests").mkdir()
    (runner / "a.mos").rename(runner / "tests" / "a.mos")
    assert run(runner, "Run gapi test", **step["with"]).returncode == 0
    assert (runner / "report.xml").exists()


def test_the_archives_that_the_action_asks_for_are_made():
    github = ACTION.parents[2]
    asked = set(re.findall(r"archive=([\w-]+)", ACTION.read_text(encoding="utf-8")))
    jobs = yaml.safe_load((github / "workflows" / "release.yml").read_text(encoding="utf-8"))["jobs"]
    made = {one["target"] for one in jobs["programs"]["strategy"]["matrix"]["include"]}
    made.add("x86_64-linux")
    assert len(asked) == 5 and asked <= made
    # Static ones for both processors, and what they are called is what the script makes of a target.
    assert {"x86_64-unknown-linux-musl", "aarch64-unknown-linux-musl"} <= made
    script = (github.parent / "scripts" / "release").read_text(encoding="utf-8")
    assert "gapi-$version-${only:-x86_64-linux}" in script
