"""Tables that edmill writes as CSV, as NumPy structured arrays."""
from __future__ import annotations

import csv
import itertools
import pathlib
from collections.abc import Iterator, Mapping

import numpy as np


class Records(np.ndarray):
    """A structured array that other libraries take as a table."""

    def to_dataframe(self):
        """A `pandas.DataFrame` with a column for each field; of a vector, a column for each
        component: "position_x"."""
        import pandas

        columns = {}
        for name in self.dtype.names or ():
            column = np.asarray(self[name])
            if column.ndim == 2:
                columns.update({f"{name}_{axis}": column[:, k] for k, axis in enumerate("xyz")})
            else:
                columns[name] = column
        return pandas.DataFrame(columns)

    def to_xarray(self, dimension: str = "row"):
        """An `xarray.Dataset`: a variable for each field along `dimension`, vectors along "axis" as
        well. Titles with units, where the table has them, are attributes."""
        import xarray

        units = {
            name: field[2] for name, field in (self.dtype.fields or {}).items() if len(field) > 2
        }
        variables = {}
        for name in self.dtype.names or ():
            column = np.asarray(self[name])
            dimensions = (dimension, "axis") if column.ndim == 2 else (dimension,)
            variables[name] = (dimensions, column,
                               {"long_name": units[name]} if name in units else {})
        coordinates = {"axis": list("xyz")} if any(
            np.asarray(self[n]).ndim == 2 for n in self.dtype.names or ()) else {}
        return xarray.Dataset(variables, coords=coordinates)


def _column(cells: list[str]) -> np.ndarray:
    """A column as integers if possible, otherwise as floats, with NaN for empty cells, otherwise as
    texts."""
    for kind in (np.int64, np.float64) if cells else (np.float64,):
        try:
            return np.array([cell or "nan" for cell in cells], dtype=kind)
        except ValueError:
            pass
    return np.array(cells, dtype=object)


def read_table(file: str | pathlib.Path) -> Records:
    """A CSV file of edmill; columns are named without units, which `dtype.fields` keep as titles.
    Empty cells are NaN."""
    with open(file, newline="", encoding="utf-8") as stream:
        header, *rows = csv.reader(itertools.dropwhile(lambda line: line.startswith("#"), stream))
    names = [title.split(" [")[0] for title in header]
    columns = [_column([row[k] for row in rows]) for k in range(len(header))]
    table = np.empty(len(rows), dtype=[((title, name) if title != name else name, column.dtype)
                                       for title, name, column in zip(header, names, columns)])
    for name, column in zip(names, columns):
        table[name] = column
    return table.view(Records)


class Tables(Mapping):
    """The CSV files of a folder by their names without extension, or by their paths if several have
    the same name. A file is read when it is accessed. Logs in HDF5 are not included."""

    def __init__(self, folder: pathlib.Path | None):
        files = [] if folder is None else sorted(pathlib.Path(folder).rglob("*.csv"))
        stems = [f.stem for f in files]
        self._files = {
            f.stem
            if stems.count(f.stem) == 1 else f.relative_to(folder).with_suffix("").as_posix(): f
            for f in files
        }

    def __getitem__(self, name: str) -> Records:
        return read_table(self._files[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)
