"""Each notebook of the manual runs from top to bottom, and prints what it is kept with."""
import pathlib
import sys

import nbformat
import pytest

NOTEBOOKS = pathlib.Path(__file__).resolve().parents[3] / "docs/notebooks"
sys.path.insert(0, str(NOTEBOOKS))
from make import executed, texts  # noqa: E402


@pytest.mark.parametrize("notebook", sorted(NOTEBOOKS.glob("*.ipynb")), ids=lambda file: file.stem)
def test_prints_what_it_is_kept_with(notebook):
    book = executed(notebook)
    assert all(cell.execution_count for cell in book.cells if cell.cell_type == "code")
    kept = list(texts(nbformat.read(notebook, as_version=4)))
    assert list(texts(book)) == kept and kept, "docs/notebooks/make.py keeps what they print now"


def test_there_are_four():
    assert len(list(NOTEBOOKS.glob("*.ipynb"))) == 4
