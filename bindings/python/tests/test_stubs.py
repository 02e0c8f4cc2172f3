"""What the package says of its types is what it has."""

import subprocess
import sys

import pytest


def test_stubs_say_what_the_package_has():
    pytest.importorskip("mypy")
    # The page of the kernel and the server need packages that tell nothing of their types.
    with open("mypy.ini", "w", encoding="utf-8") as settings:
        settings.write("[mypy]\nignore_missing_imports = True\n")
    command = [sys.executable, "-m", "mypy.stubtest", "gapilib", "--mypy-config-file", "mypy.ini"]
    compared = subprocess.run(command, capture_output=True, text=True)
    assert compared.returncode == 0, compared.stdout + compared.stderr
