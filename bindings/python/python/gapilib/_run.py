"""Scripts as `gapi run` runs them."""

import os
from typing import Any, Dict, Optional, Sequence, Union

from . import _gapilib, _progress

_Path = Union[str, "os.PathLike[str]"]


def run(
    script: _Path,
    *,
    out: Optional[_Path] = None,
    overwrite: bool = False,
    resume: bool = False,
    libraries: Sequence[_Path] = (),
    threads: Optional[int] = None,
    allow_read: Sequence[_Path] = (),
    allow_write: bool = False,
    allow_system: bool = False,
    allow_external: bool = False,
    cache: bool = True,
    progress: _progress.Progress = None,
) -> Dict[str, Any]:
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
        return _gapilib.run(
            os.fspath(script),
            out=out,
            overwrite=overwrite,
            resume=resume,
            libraries=libraries,
            threads=threads,
            allow_read=allow_read,
            allow_write=allow_write,
            allow_system=allow_system,
            allow_external=allow_external,
            cache=cache,
            progress=line,
        )
    finally:
        _progress.close(line)
