"""A Jupyter kernel for scripts (.mos): ``python -m gapilib.kernel install`` makes it known to Jupyter.

A cell holds statements of a script, or classes of Modelica. Values are shown, figures that the cell has
made as well, and the progress of a genetic algorithm is drawn while it runs. ``?name`` shows the
declaration of a command or a class.
"""

import contextlib
import html
import io
import json
import os
import re
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from ipykernel.kernelbase import Kernel

from . import GapilibError, Session, __version__

#: How often the picture of a run is drawn, seconds.
_REDRAWN = 0.5
#: Its size in pixels.
_WIDTH, _HEIGHT = 480, 160

_PICTURES = {".svg": "image/svg+xml", ".png": "image/png"}


class _Stream(io.TextIOBase):
    """Sends what is written to the notebook."""

    def __init__(self, kernel: "GapilibKernel", name: str) -> None:
        self._kernel, self._name = kernel, name

    def write(self, text: str) -> int:
        if text:
            self._kernel.send_response(
                self._kernel.iopub_socket, "stream", {"name": self._name, "text": text}
            )
        return len(text)


class _Picture:
    """The progress of a run as a picture that is drawn again and again."""

    def __init__(self, kernel: "GapilibKernel") -> None:
        self._kernel = kernel
        self.begin("")

    def begin(self, identity: str) -> None:
        """A cell begins."""
        self._identity, self._shown, self._drawn = identity, False, time.monotonic()
        self._curve: List[Tuple[int, float]] = []

    def __call__(self, label: str, done: int, total: int, best: Optional[float]) -> None:
        if best is not None and best > 0 and (not self._curve or self._curve[-1][1] != best):
            self._curve.append((done, best))
        now = time.monotonic()
        if now - self._drawn < _REDRAWN:
            return
        self._drawn = now
        self._show(_drawing(label, done, total, self._curve))

    def end(self) -> None:
        """The cell has ended: what it printed says what came of it."""
        if self._shown:
            self._show("")

    def _show(self, page: str) -> None:
        kind = "update_display_data" if self._shown else "display_data"
        self._shown = True
        self._kernel.send_response(
            self._kernel.iopub_socket,
            kind,
            {
                "data": {"text/html": page, "text/plain": ""},
                "metadata": {},
                "transient": {"display_id": self._identity},
            },
        )


def _drawing(label: str, done: int, total: int, curve: List[Tuple[int, float]]) -> str:
    """The share that is done, and the best fitness over it."""
    import math

    share = f"{done} of {total}" if total else str(done)
    text = f"{html.escape(label)} {share}"
    if not curve:
        return f"<p>{text}</p>"
    logs = [math.log10(best) for _, best in curve]
    low, high = min(logs), max(logs)
    width, height = max(total, done, 1), (high - low) or 1.0
    points: List[str] = []
    for (at, _), value in zip(curve, logs):
        x = at / width * _WIDTH
        y = (high - value) / height * (_HEIGHT - 20) + 10
        if points:
            points.append(f"{x:.1f},{points[-1].split(',')[1]}")
        points.append(f"{x:.1f},{y:.1f}")
    points.append(f"{done / width * _WIDTH:.1f},{points[-1].split(',')[1]}")
    line = " ".join(points)
    return (
        f'<svg width="{_WIDTH}" height="{_HEIGHT}" role="img" aria-label="{text}">'
        f'<polyline points="{line}" fill="none" stroke="currentColor" stroke-width="2"/></svg>'
        f"<p>{text}, best {curve[-1][1]:.4e} (logarithmic scale)</p>"
    )


def _word_at(code: str, position: int) -> Tuple[str, str]:
    """The parts of a name before and behind a position."""
    before = re.search(r"[\w.]*$", code[:position])
    behind = re.match(r"\w*", code[position:])
    return before.group(0) if before else "", behind.group(0) if behind else ""


class GapilibKernel(Kernel):
    """Executes cells in one session."""

    implementation = "gapilib"
    implementation_version = __version__
    banner = f"gapilib {__version__}: scripts of Modelica tools; ?name shows a declaration"
    language_info = {
        "name": "modelica",
        "mimetype": "text/x-modelica",
        "file_extension": ".mos",
        "codemirror_mode": "modelica",
        "pygments_lexer": "modelica",
    }

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments)
        self._picture = _Picture(self)
        self._session = Session(dialogue=True, progress=self._picture)

    # Kernels may answer at once or later; the types of ipykernel know only the latter.
    def do_execute(  # type: ignore[override]
        self,
        code: str,
        silent: bool,
        store_history: bool = True,
        user_expressions: Optional[Dict[str, Any]] = None,
        allow_stdin: bool = False,
        **_: Any,
    ) -> Dict[str, Any]:
        if not code.strip():
            return self._done()
        wanted = re.fullmatch(r"\?\s*([\w.]+)\s*|([\w.]+)\s*\?", code.strip())
        if wanted:
            return self._helped(wanted.group(1) or wanted.group(2))
        magic = re.match(r"\s*([%!]+\S*)", code)
        if magic:
            text = (
                f"`{magic.group(1)}` is a command of IPython: cells of this kernel hold statements of scripts and "
                "classes of Modelica"
            )
            return self._failed("unknown-command", text)
        begun = time.time()
        self._picture.begin(f"run-{self.execution_count}")
        streams: Tuple[io.TextIOBase, io.TextIOBase]
        streams = (_Stream(self, "stdout"), _Stream(self, "stderr"))
        if silent:
            streams = (io.StringIO(), io.StringIO())
        try:
            with contextlib.redirect_stdout(streams[0]), contextlib.redirect_stderr(streams[1]):
                self._session.execute(code, f"cell {self.execution_count}")
        except GapilibError as error:
            return self._failed(error.code or "error", str(error))
        except KeyboardInterrupt:
            return self._failed("KeyboardInterrupt", "interrupted")
        finally:
            self._picture.end()
            if not silent:
                self._show_pictures(begun)
        return self._done()

    def do_complete(  # type: ignore[override]
        self, code: str, cursor_pos: int
    ) -> Dict[str, Any]:
        word, rest = _word_at(code, cursor_pos)
        return {
            "status": "ok",
            "matches": self._session.complete(word) if word else [],
            "cursor_start": cursor_pos - len(word),
            # The name that is chosen stands for the whole word, also behind the cursor.
            "cursor_end": cursor_pos + len(rest),
            "metadata": {},
        }

    def do_inspect(  # type: ignore[override]
        self, code: str, cursor_pos: int, detail_level: int = 0, omit_sections: Any = ()
    ) -> Dict[str, Any]:
        word = "".join(_word_at(code, cursor_pos))
        found = self._session.help(word) if word else None
        data = {"text/plain": found} if found else {}
        return {"status": "ok", "found": bool(found), "data": data, "metadata": {}}

    def do_is_complete(  # type: ignore[override]
        self, code: str
    ) -> Dict[str, str]:
        opened = len(re.findall(r"\b(?:for|while|when|if)\b(?!.*\bend\b)", code))
        if code.count("(") > code.count(")") or code.count("{") > code.count("}"):
            return {"status": "incomplete", "indent": "  "}
        return {"status": "incomplete", "indent": "  "} if opened else {"status": "complete"}

    def _helped(self, name: str) -> Dict[str, Any]:
        found = self._session.help(name)
        if not found:
            return self._failed("unknown-name", f"there is no command or class `{name}`")
        self.send_response(self.iopub_socket, "stream", {"name": "stdout", "text": found + "\n"})
        return self._done()

    def _show_pictures(self, begun: float) -> None:
        """The figures that have been written since."""
        folder = Path(self._session.output)
        for file in sorted(folder.rglob("*")) if folder.is_dir() else []:
            kind = _PICTURES.get(file.suffix)
            if kind and file.stat().st_mtime >= begun - 0.01:
                self._show_picture(kind, file)

    def _show_picture(self, kind: str, file: Path) -> None:
        import base64

        content = file.read_bytes()
        text = content.decode() if kind == "image/svg+xml" else base64.b64encode(content).decode()
        self.send_response(
            self.iopub_socket,
            "display_data",
            {"data": {kind: text, "text/plain": file.name}, "metadata": {}},
        )

    def _done(self) -> Dict[str, Any]:
        return {
            "status": "ok",
            "execution_count": self.execution_count,
            "payload": [],
            "user_expressions": {},
        }

    def _failed(self, name: str, text: str) -> Dict[str, Any]:
        first = text.splitlines()[0] if text else name
        content = {"ename": name, "evalue": first, "traceback": text.splitlines() or [name]}
        self.send_response(self.iopub_socket, "error", content)
        return {"status": "error", "execution_count": self.execution_count, **content}


def install(prefix: Optional[str] = None) -> str:
    """Makes the kernel known to Jupyter, for the user or below `prefix`; its folder."""
    from jupyter_client.kernelspec import KernelSpecManager

    spec = {
        "argv": [sys.executable, "-m", "gapilib.kernel", "-f", "{connection_file}"],
        "display_name": "GAPILib (Modelica scripts)",
        "language": "modelica",
    }
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "kernel.json").write_text(json.dumps(spec, indent=2), encoding="utf-8")
        manager = KernelSpecManager()
        return manager.install_kernel_spec(folder, "gapilib", user=prefix is None, prefix=prefix)


def main() -> None:
    """Installs the kernel, or is it."""
    if sys.argv[1:2] == ["install"]:
        in_prefix = "--sys-prefix" in sys.argv
        print(install(sys.prefix if in_prefix else os.environ.get("GAPILIB_KERNEL_PREFIX")))
        return
    from ipykernel.kernelapp import IPKernelApp

    IPKernelApp.launch_instance(kernel_class=GapilibKernel)


if __name__ == "__main__":
    main()
