#!/usr/bin/python3
"""Frames in VTK's formats: two of LIGGGHTS 3.8 (dump custom/vtk of the vibrated box), and a .pvd
with two parts, as Lethe writes it.

usage: vtk_frames_test.py
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy

try:
    import vtkmodules.all as vtk
except ImportError:
    print("skipped: needs python3-vtk9")
    sys.exit(77)

HERE = pathlib.Path(__file__).resolve().parent
TOOL = HERE.parents[2] / "src/bindings/python/edmill/vtk_frames.py"
failed = []


def check(good, what):
    print(("ok      " if good else "FAILED  ") + what)
    if not good:
        failed.append(what)


def table(*arguments):
    done = subprocess.run(["/usr/bin/python3", str(TOOL), *map(str, arguments)],
                          capture_output=True, text=True)
    rows = [line.split(",") for line in done.stdout.splitlines()]
    return done.returncode, rows, done.stderr


def write_part(path, balls, names=("ID", "velocity", "omega", "diameter")):
    """A .vtu as deal.II writes particles: points with arrays."""
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    points.SetDataTypeToDouble()
    arrays = [vtk.vtkDoubleArray() for _ in names]
    for array, name in zip(arrays, names):
        array.SetName(name)
        array.SetNumberOfComponents(3 if name in ("velocity", "omega") else 1)
    for ball in balls:
        points.InsertNextPoint(ball, 2 * ball, 3 * ball)
        for array in arrays:
            array.InsertNextTuple([ball + 0.5 * k for k in range(array.GetNumberOfComponents())])
    grid.SetPoints(points)
    for array in arrays:
        grid.GetPointData().AddArray(array)
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(grid)
    writer.Write()


# Of LIGGGHTS, in the order of their steps, whatever the order in which they are given.
code, rows, _ = table(HERE / "liggghts_10020.vtk", HERE / "liggghts_9990.vtk", "--timestep", "1e-5")
check(code == 0 and rows[0] == "time id x y z vx vy vz omegax omegay omegaz mass radius".split(),
      "columns of LIGGGHTS")
check([row[0] for row in rows[1:]] == 5 * ["0.09990000000000002"] + 5 * ["0.10020000000000001"] or
      [float(row[0]) for row in rows[1:]] == 5 * [9990 * 1e-5] + 5 * [10020 * 1e-5],
      "times from steps")
text = (HERE / "liggghts_9990.vtk").read_text().split()
first_x = float(text[text.index("POINTS") + 3])
first_id = int(text[text.index("id") + 4])
check(
    float(rows[1][2]) == numpy.float32(first_x) and int(rows[1][1]) == first_id,
    "values as they stand in the file")
check({float(row[12]) for row in rows[1:]} == {0.004}, "radius")

with open("/dev/full", "w") as full:
    done = subprocess.run(
        ["/usr/bin/python3",
         str(TOOL),
         str(HERE / "liggghts_9990.vtk"), "--timestep", "1e-5"], stdout=full,
        stderr=subprocess.PIPE, text=True)
check(done.returncode == 1 and done.stderr == "error: standard output: No space left on device\n",
      "a full disk: " + done.stderr.strip())

with tempfile.TemporaryDirectory() as folder:
    root = pathlib.Path(folder)
    for name, balls in (("a0", [1, 2]), ("a1", [3]), ("b0", [2, 3]), ("b1", [1])):
        write_part(root / f"{name}.vtu", balls)
    sets = "".join(f'<DataSet timestep="{time}" part="{part}" file="{name}.vtu"/>'
                   for name, time, part in (("a0", 0.25, 0), ("a1", 0.25, 1), ("b0", 0.5, 0),
                                            ("b1", 0.5, 1)))
    (root / "out.pvd").write_text(
        f'<?xml version="1.0"?><VTKFile type="Collection"><Collection>{sets}</Collection></VTKFile>'
    )
    code, rows, _ = table(root / "out.pvd")
    check(
        code == 0 and [row[:2] for row in rows[1:]] == [["0.25", "1"], ["0.25", "2"], ["0.25", "3"],
                                                        ["0.5", "2"], ["0.5", "3"], ["0.5", "1"]],
        "parts of a .pvd are one frame")
    check(
        rows[3][2:] == ["3.0", "6.0", "9.0", "3.0", "3.5", "4.0", "3.0", "3.5", "4.0", "3.0"] and
        rows[0][-1] == "diameter", "places, velocities and spins of a part")

    write_part(root / "no_spin_7.vtu", [1], ("ID", "velocity"))
    (root / "no_vtk_1.vtk").write_text("no file of VTK")
    (root / "bad.pvd").write_text(
        '<?xml version="1.0"?><VTKFile><Collection><DataSet file="a0.vtu"/></Collection></VTKFile>')
    for given, expected in (((root / "no_spin_7.vtu", "--timestep", "1e-5"),
                             "omega"), ((root / "a0.csv",), "'.csv'"),
                            ((root / "absent.vtu",), "cannot be read"), ((root / "no_vtk_1.vtk",),
                                                                         "no points"),
                            ((root / "a0.vtu",), "no time"), ((root / "bad.pvd",), "timestep")):
        code, rows, error = table(*given)
        check(
            code == 2 and error.startswith("error: ") and expected in error and
            len(error.splitlines()) == 1, f"{given[0].name}: {error.strip()}")

print(f"{len(failed)} failed")
sys.exit(bool(failed))
