"""Frames of DEM codes in VTK's formats, of LIGGGHTS and Lethe, as the table that `edmill import`
reads.

    python3 -m edmill.vtk_frames post/box_*.vtk --timestep 1e-6 | edmill import - --case box.toml
    python3 -m edmill.vtk_frames out.pvd | edmill import - --case box.toml

A frame is one file (`.vtk`, `.vtp`, `.vtu`, `.pvtu`, `.pvtp`), or what a `.pvd` lists under one
time. Its time is that of the `.pvd`, or the field TimeValue or TIME of the file, or the last number
in its name times the time step. VTK itself reads them (Debian: python3-vtk9).
"""
from __future__ import annotations

import argparse
import itertools
import os
import pathlib
import re
import sys
import xml.etree.ElementTree
from collections.abc import Iterable, Iterator

import numpy

#: Names of the arrays of each quantity in different codes; mass, radius and diameter are optional.
NAMES = {"id": ("id", "ID", "particle_id"), "velocity": ("v", "velocity", "Velocity"),
         "spin": ("omega", "angular_velocity", "Angular velocity"), "mass": ("mass", "Mass"),
         "radius": ("radius", "Radius"), "diameter": ("diameter", "Diameter")}


class BadFrame(ValueError):
    """A file that is no frame: what was found and what was expected."""


def _read(file: pathlib.Path):
    """The points and arrays of a file, by VTK."""
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import vtk_to_numpy
    readers = {
        ".vtk": vtk.vtkGenericDataObjectReader, ".vtp": vtk.vtkXMLPolyDataReader,
        ".vtu": vtk.vtkXMLUnstructuredGridReader, ".pvtp": vtk.vtkXMLPPolyDataReader,
        ".pvtu": vtk.vtkXMLPUnstructuredGridReader
    }
    if file.suffix not in readers:
        raise BadFrame(
            f"{file}: found a name that ends in '{file.suffix}', expected {', '.join(readers)} or .pvd"
        )
    if not file.is_file():
        raise BadFrame(f"{file}: cannot be read")
    vtk.vtkObject.GlobalWarningDisplayOff()
    reader = readers[file.suffix]()
    reader.SetFileName(str(file))
    if file.suffix == ".vtk":
        reader.ReadAllScalarsOn()
        reader.ReadAllVectorsOn()
        reader.ReadAllFieldsOn()
    reader.Update()
    data = reader.GetOutput()
    if data is None or not hasattr(data, "GetPoints") or data.GetPoints() is None:
        raise BadFrame(f"{file}: no points, expected a file of VTK with a point for each ball")
    points = data.GetPointData()
    arrays = {
        points.GetArrayName(k): vtk_to_numpy(points.GetArray(k))
        for k in range(points.GetNumberOfArrays()) if points.GetArray(k)
    }
    fields = data.GetFieldData()
    times = [
        fields.GetArray(name).GetTuple1(0) for name in ("TimeValue", "TIME")
        if fields.GetArray(name)
    ]
    return vtk_to_numpy(data.GetPoints().GetData()), arrays, times[0] if times else None


def _find(arrays: dict, what: str):
    return next((arrays[name] for name in NAMES[what] if name in arrays), None)


def table_of(file: pathlib.Path) -> tuple[numpy.ndarray, float | None, list[str]]:
    """Rows of one file, its time if it says one [s], and the names of the columns."""
    places, arrays, time = _read(file)
    missing = [what for what in ("id", "velocity", "spin") if _find(arrays, what) is None]
    if missing:
        raise BadFrame(
            f"{file}: found the arrays {', '.join(sorted(arrays)) or 'none'}, expected one of {', '.join(NAMES[missing[0]])} as well"
        )
    columns = ["id", "x", "y", "z", "vx", "vy", "vz", "omegax", "omegay", "omegaz"]
    parts = [_find(arrays, "id"), places, _find(arrays, "velocity"), _find(arrays, "spin")]
    for what in ("mass", "radius", "diameter"):
        if (values := _find(arrays, what)) is not None:
            parts.append(values)
            columns.append(what)
    rows = numpy.column_stack([numpy.asarray(part, dtype=float) for part in parts])
    if rows.shape[1] != len(columns):
        raise BadFrame(
            f"{file}: found arrays of other shapes, expected three numbers for each velocity and spin"
        )
    return rows, time, columns


def _time_of(file: pathlib.Path, said: float | None, timestep: float | None) -> float:
    if said is not None:
        return said
    numbers = re.findall(r"\d+", file.stem)
    if timestep is None or not numbers:
        raise BadFrame(
            f"{file}: no time: add a field TimeValue, or a number to the name and give --timestep")
    return int(numbers[-1]) * timestep


def _in_order(file: pathlib.Path):
    """Sort key that orders numbers in names by value: box_900 before box_1000."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", str(file))]


def frames_of(files: Iterable[str | os.PathLike],
              timestep: float | None = None) -> Iterator[tuple[float, numpy.ndarray, list[str]]]:
    """Time [s], rows and names of columns of each frame, in order of time. Raises BadFrame."""
    paths = [pathlib.Path(file) for file in files]
    if len(paths) == 1 and paths[0].suffix == ".pvd":
        try:
            sets = xml.etree.ElementTree.parse(paths[0]).iter("DataSet")
            listed = [(float(part.attrib["timestep"]), paths[0].parent / part.attrib["file"])
                      for part in sets]
        except (xml.etree.ElementTree.ParseError, KeyError, ValueError, OSError) as problem:
            raise BadFrame(
                f"{paths[0]}: found {problem}, expected a .pvd with a file and a timestep in each DataSet"
            ) from problem
    else:
        listed = [(None, file) for file in sorted(paths, key=_in_order)]
    tables = ((table_of(file), said, file) for said, file in listed)
    parts = ((_time_of(file, own if said is None else said, timestep), columns, rows)
             for (rows, own, columns), said, file in tables)
    for (time, columns), of_frame in itertools.groupby(parts, key=lambda part: part[:2]):
        yield time, numpy.vstack([rows for _, _, rows in of_frame]), columns


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python3 -m edmill.vtk_frames", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE")
    parser.add_argument("--timestep", type=float, metavar="SECONDS",
                        help="of names that hold the step")
    given = parser.parse_args(arguments)
    first = None
    try:
        for time, rows, columns in frames_of(given.files, given.timestep):
            if first is None:
                first = columns
                print(",".join(["time", *columns]))
            if columns != first:
                raise BadFrame(
                    f"frame at {time} s: found the columns {', '.join(columns)}, expected {', '.join(first)}"
                )
            for row in rows:
                print(",".join(
                    [repr(time),
                     str(int(row[0])), *(repr(float(value)) for value in row[1:])]))
        sys.stdout.flush()
    except BadFrame as problem:
        print(f"error: {problem}", file=sys.stderr)
        return 2
    except ImportError:
        print("error: needs VTK for Python (Debian: apt-get install python3-vtk9)", file=sys.stderr)
        return 1
    except OSError as problem:
        os.dup2(os.open(os.devnull, os.O_WRONLY),
                sys.stdout.fileno())  # what is left in the buffer goes nowhere
        if not isinstance(problem, BrokenPipeError):
            print(f"error: standard output: {problem.strerror}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
