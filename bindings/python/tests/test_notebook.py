"""The notebook of the examples runs in a kernel and ends with the verdict and its figure."""

import nbformat
from conftest import ROOT
from nbclient import NotebookClient

NOTEBOOK = ROOT / "bindings" / "python" / "examples" / "frame_to_verdict.ipynb"


def test_the_notebook_goes_from_a_frame_to_a_verdict_with_its_figure(tmp_path):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.outputs == [] and cell.execution_count is None for cell in cells)
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    said, shown = cells[-1].outputs
    assert said["text"].split() == ["leak", "1"]
    assert "<svg" in shown["data"]["text/html"]
    events = next(cell for cell in cells if cell.id == "told").outputs[-1]["data"]["text/plain"]
    assert "+01:00" in events and "leak" in events, events
