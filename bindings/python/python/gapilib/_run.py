"""Scripts as `gapi run` runs them."""

import os
from typing import Any, Dict, Union

from . import _gapilib, _progress


def run(script: Union[str, "os.PathLike[str]"], *, progress: _progress.Progress = None, **options: Any) -> Dict[str, Any]:
    """Runs a script (.mos) unchanged and returns its variables.

    Results go into `out`, by default a folder for each script in `results`. Further options: `overwrite`,
    `resume` (go on after an interruption), `libraries`, `threads`, `allow_read`, `allow_write`,
    `allow_system`, `allow_external`, `cache`. `progress` is a function of label, done, total and best;
    None shows a line on a terminal and in a notebook.

    Raises `GapilibError` for errors that the script has not asked for, `KeyboardInterrupt` when
    interrupted: what was computed is saved.
    """
    line = _progress.shown(progress)
    try:
        return _gapilib.run(os.fspath(script), progress=line, **options)
    finally:
        _progress.close(line)
