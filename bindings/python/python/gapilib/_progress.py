"""Progress of long work, on a terminal or in a notebook."""

import sys
import time
from typing import Callable, Optional, Union

Progress = Union[None, bool, Callable[[str, int, int, Optional[float]], None]]

#: Seconds between two lines.
_REDRAWN = 0.2


class Line:
    """One line on standard error that is drawn again and again."""

    def __init__(self) -> None:
        self._drawn = 0.0
        self._width = 0

    def __call__(self, label: str, done: int, total: int, best: Optional[float]) -> None:
        now = time.monotonic()
        if now - self._drawn < _REDRAWN:
            return
        self._drawn = now
        share = f"{done}/{total} ({done / total:.0%})" if total else str(done)
        text = f"{label} {share}" + ("" if best is None else f"  best {best:.4e}")
        sys.stderr.write("\r" + text.ljust(self._width))
        sys.stderr.flush()
        self._width = len(text)

    def close(self) -> None:
        """Takes the line away."""
        if self._width:
            sys.stderr.write("\r" + " " * self._width + "\r")
            sys.stderr.flush()


def _is_watched() -> bool:
    """Whether standard error is a terminal or shown in a notebook."""
    if "ipykernel" in sys.modules:
        return True
    return bool(sys.stderr) and sys.stderr.isatty()


def shown(progress: Progress):
    """What is called with the progress, if anything is: `None` for a line on a terminal and in a notebook."""
    if progress is None:
        progress = _is_watched()
    if progress is True:
        return Line()
    return progress or None


def close(line) -> None:
    """Ends what `shown` has begun."""
    if isinstance(line, Line):
        line.close()
