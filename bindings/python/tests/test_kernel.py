import pytest

pytest.importorskip("ipykernel")
nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

from gapilib import kernel  # noqa: E402

from conftest import DECAY  # noqa: E402


@pytest.fixture
def kernel_spec(tmp_path, monkeypatch):
    monkeypatch.setenv("JUPYTER_PATH", str(tmp_path / "share" / "jupyter"))
    kernel.install(str(tmp_path))


@pytest.fixture
def notebook(kernel_spec):
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


def test_commands_of_ipython_are_refused(notebook):
    one, two = notebook("%matplotlib inline", "1+1", allow_errors=True)
    [error] = [output for output in one if output.output_type == "error"]
    assert error.ename == "unknown-command" and "`%matplotlib`" in error.evalue
    assert "2" in text(two)


def test_long_output_is_whole(notebook):
    [outputs] = notebook("for i in 1:3000 loop print(String(i)); end for;")
    assert text(outputs).split() == [str(k) for k in range(1, 3001)]


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
    # In the middle of a word all of it is replaced.
    found = quiet.do_complete("x = simulateMo + 1", 10)
    assert "simulateModel" in found["matches"]
    assert (found["cursor_start"], found["cursor_end"]) == (4, 14)
    assert quiet.do_is_complete("f(1,")["status"] == "incomplete"
    assert quiet.do_is_complete("a = 1;")["status"] == "complete"


def test_a_cell_is_interrupted_and_the_next_one_runs(kernel_spec):
    import queue

    from jupyter_client.manager import start_new_kernel

    manager, client = start_new_kernel(kernel_name="gapilib", startup_timeout=60)
    try:
        # Behind an error a kernel refuses for a moment what is in its queue, which the next cell may be.
        identity = client.execute(
            'print("begun"); i = 0; while true loop i = i + 1; end while;', stop_on_error=False
        )
        # The kernel is interrupted while the loop runs, not before.
        while "begun" not in client.get_iopub_msg(timeout=60)["content"].get("text", ""):
            pass
        def reply(timeout):
            # A slow start leaves answers to other questions behind.
            while True:
                found = client.get_shell_msg(timeout=timeout)
                if found["parent_header"]["msg_id"] == identity:
                    return found

        with pytest.raises(queue.Empty):
            reply(timeout=0.5)
        manager.interrupt_kernel()
        reply = reply(timeout=60)
        assert reply["content"]["status"] == "error"
        assert reply["content"]["ename"] == "KeyboardInterrupt"
        # The session is the same: its variable has the value that the loop has reached.
        printed = []
        client.execute_interactive("print(String(i > 0));", timeout=60, output_hook=printed.append)
        assert "true\n" in [message["content"].get("text") for message in printed]
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
