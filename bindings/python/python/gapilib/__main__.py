"""The command `gapi`, as the package brings it along."""

import signal
import sys

from . import _gapilib


def main() -> int:
    """Runs the command line and returns its exit code."""
    # The program has its own way to be interrupted: it saves first.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _gapilib.command(["gapi", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
