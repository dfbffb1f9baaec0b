"""The notebooks in examples/notebooks, carried out from their first cell to the last by a kernel of their own."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).resolve().parents[2] / "examples" / "notebooks").glob("*.ipynb"))


def test_the_notebooks_are_these():
    assert [path.stem for path in NOTEBOOKS] == ["fig1", "friction_sweep"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_small_and_kept_without_its_outputs(path):
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    assert path.stat().st_size < 60_000
    assert all(not cell.outputs and cell.execution_count is None for cell in notebook.cells if cell.cell_type == "code")


def carried_out(name, folder):
    """Outputs of all cells: (text, how many pictures, how many tables). Raises CellExecutionError."""
    notebook = nbformat.read(next(path for path in NOTEBOOKS if path.stem == name), as_version=4)
    NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(folder)}}).execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    data = [output.get("data", {}) for output in outputs]
    said = "".join(output.get("text", "") for output in outputs) + "".join(part.get("text/plain", "") for part in data)
    assert not any(output.get("name") == "stderr" for output in outputs), said
    return said, sum("image/png" in part for part in data), sum("<table>" in part.get("text/html", "") for part in data)


def test_figure_1_in_a_notebook_agrees_with_johnson(tmp_path, monkeypatch):
    monkeypatch.delenv("MPLBACKEND", raising=False)  # pictures go into the notebook
    said, pictures, tables = carried_out("fig1", tmp_path)
    assert (pictures, tables) == (3, 1)
    error = float(said.partition("within ")[2].partition(" %")[0])
    assert error < 3


def test_friction_takes_work_in_a_notebook(tmp_path, monkeypatch):
    monkeypatch.delenv("MPLBACKEND", raising=False)
    said, pictures, tables = carried_out("friction_sweep", tmp_path)
    assert (pictures, tables) == (2, 1)
    lost = [int(line.partition("MPa, ")[2].partition(" %")[0]) for line in said.splitlines() if line.startswith("mu = ")]
    assert len(lost) == 3 and abs(lost[0]) < 3 < lost[1] and 3 < lost[2]
