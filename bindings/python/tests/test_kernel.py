import pytest

pytest.importorskip("ipykernel")
nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

from gapilib import kernel  # noqa: E402

from conftest import DECAY  # noqa: E402


@pytest.fixture
def notebook(tmp_path, monkeypatch):
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path / "share" / "jupyter"))
    kernel.install(str(tmp_path))

    def execute(*cells, **options):
        notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
        client = nbclient.NotebookClient(notebook, kernel_name="gapilib", **{"timeout": 60, **options})
        client.execute()
        return [cell.outputs for cell in notebook.cells]

    return execute


def text(outputs):
    return "".join(output.get("text", "") for output in outputs)


def test_cells_share_a_session_and_show_values(notebook):
    first, second, third = notebook(DECAY, "a = 6*7;\na", 'print(String(a) + "!");')
    assert "error" not in str(first)
    assert "42" in text(second)
    assert text(third) == "42!\n"


def test_errors_end_a_cell_with_place_and_help(notebook):
    one, two = notebook(DECAY + 'simulateModel("Decai");', "1+1", allow_errors=True)
    [error] = [output for output in one if output.output_type == "error"]
    assert error.ename == "unknown-class"
    assert "Decay" in "\n".join(error.traceback)
    assert "2" in text(two)


def test_figures_are_shown(notebook):
    [outputs] = notebook(DECAY + '\nsimulateModel("Decay");\nplot({"x"});')
    kinds = [kind for output in outputs for kind in output.get("data", {})]
    assert "image/svg+xml" in kinds or "image/png" in kinds


def test_help(notebook):
    [outputs] = notebook("?simulateModel")
    assert "stopTime" in text(outputs)


def test_completion_and_completeness():
    class Quiet(kernel.GapilibKernel):
        def __init__(self):
            self._session = kernel.Session(dialogue=True)

    quiet = Quiet.__new__(Quiet)
    Quiet.__init__(quiet)
    found = quiet.do_complete("x = simulateM", 13)
    assert "simulateModel" in found["matches"] and found["cursor_start"] == 4
    assert quiet.do_is_complete("f(1,")["status"] == "incomplete"
    assert quiet.do_is_complete("a = 1;")["status"] == "complete"
