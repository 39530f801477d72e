#!/usr/bin/env python3
"""Runs the notebooks of this folder and keeps what they print and draw. Whole pages are left out: a
notebook that is run shows them.

usage: PYTHONPATH=FOLDER_OF_THE_PACKAGE /usr/bin/python3 docs/notebooks/make.py
"""
import pathlib
import tempfile

import nbformat
from nbclient import NotebookClient

HERE = pathlib.Path(__file__).resolve().parent


def executed(file):
    """The notebook with its outputs, run in an empty folder."""
    book = nbformat.read(file, as_version=4)
    with tempfile.TemporaryDirectory() as folder:
        NotebookClient(book, timeout=300, kernel_name="python3",
                       resources={"metadata": {"path": folder}}).execute()
    for cell in book.cells:
        cell.metadata.pop("execution", None)
        for output in cell.get("outputs", []):
            if "text/plain" in output.get("data", {}) and "<iframe" in output["data"].get(
                    "text/html", ""):
                del output["data"]["text/html"]
    return book


def texts(book):
    """What each cell prints, without addresses of objects."""
    for cell in book.cells:
        for output in cell.get("outputs", []):
            text = output.get("text") or output.get("data", {}).get("text/plain", "")
            yield "".join(text).split(" at 0x")[0]


if __name__ == "__main__":
    for place in sorted(HERE.glob("*.ipynb")):
        nbformat.write(executed(place), place)
        print(f"{place.name}: {place.stat().st_size / 1000:.0f} kB")
