"""A plugin for pytest that runs scripts (.mos) as ``gapi test`` does: one item for each script.

A script is compared with the transcript ``NAME.mos.snap`` next to it, or with the result that it embeds
between ``// Result:`` and ``// endResult``. Scripts are collected only if they are named on the command
line, or match a pattern of the option ``gapi_files``::

    [pytest]
    gapi_files = tests/*.mos
    gapi_options = --time-limit 60

The package is separate from `gapilib`: pytest imports its plugins at every start, and the compiled module
takes longer to load than this file.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any, Iterator, List, Optional
from xml.etree import ElementTree

import pytest

#: The class of the test cases in the JUnit report that stand for whole scripts; those for single
#: statements are named after their script.
_SCRIPT = "gapi"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addini(
        "gapi_files",
        "patterns of scripts (.mos) that are run and compared as `gapi test` does, as in tests/*.mos",
        type="args",
        default=[],
    )
    parser.addini("gapi_options", "further options of `gapi test`", type="args", default=[])


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> Optional["ScriptFile"]:
    if file_path.suffix != ".mos":
        return None
    patterns = parent.config.getini("gapi_files")
    if parent.session.isinitpath(file_path) or any(map(file_path.match, patterns)):
        return ScriptFile.from_parent(parent, path=file_path)
    return None


class ScriptFile(pytest.File):
    """A script."""

    def collect(self) -> Iterator["ScriptItem"]:
        yield ScriptItem.from_parent(self, name="gapi")


class ScriptItem(pytest.Item):
    """The comparison of a script with what is recorded of it."""

    def runtest(self) -> None:
        root = self.config.rootpath
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder, "report.xml")
            command = [sys.executable, "-m", "gapilib", "test", os.path.relpath(self.path, root)]
            command += ["--junit", str(report), *self.config.getini("gapi_options")]
            # A process for each script: a crash or a limit of memory ends one item alone.
            ended = subprocess.run(
                command,
                cwd=root,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                encoding="utf-8",
                errors="replace",
            )
            if ended.returncode == 0:
                return
            text = _failure(report) or f"exit code {ended.returncode}\n{ended.stdout}"
        raise ScriptFailure(text)

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        if isinstance(excinfo.value, ScriptFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> Any:
        return self.path, None, f"script {self.path.name}"


class ScriptFailure(Exception):
    """A script does not agree with what is recorded, or has no reference; with the text of `gapi test`."""


def _failure(report: Path) -> str:
    """Why the script failed, and which statements of an embedded result did not agree; empty without a
    report."""
    try:
        cases = list(ElementTree.parse(report).getroot().iter("testcase"))
    except (OSError, ElementTree.ParseError):
        return ""
    parts: List[str] = []
    for case in cases:
        failure, skipped = case.find("failure"), case.find("skipped")
        if case.get("classname") == _SCRIPT:
            parts += [] if failure is None else [failure.text or ""]
        elif failure is not None:
            parts.append(f"statement {case.get('name')}: {failure.text}")
        elif skipped is not None:
            parts.append(f"statement {case.get('name')}: not supported [{skipped.get('message')}]")
    return "\n".join(part.rstrip("\n") for part in parts)
