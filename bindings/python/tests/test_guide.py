"""The chapter of the guide: its examples run, one after the other."""

import re
from pathlib import Path

import pytest

CHAPTER = Path(__file__).resolve().parents[3] / "docs" / "src" / "python.md"


def test_the_examples_of_the_guide_run():
    for name in ["pandas", "scipy", "umbridge"]:
        pytest.importorskip(name)
    blocks = re.findall(r"```python\n(.*?)```", CHAPTER.read_text(encoding="utf-8"), re.S)
    assert len(blocks) > 7
    # Not the main program, which would serve models without end.
    names = {"__name__": "chapter"}
    for number, block in enumerate(blocks):
        exec(compile(block, f"block {number + 1} of the chapter", "exec"), names)
