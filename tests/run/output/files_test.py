#!/usr/bin/env python3
"""What other tools read from the files of a run: h5py, VTK, view3dscene, xmllint, and the Python of
docs/files.md.

usage: PYTHONPATH=tests/support python3 files_test.py EDMILL
"""
import filecmp
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
from program import EXAMPLES, SOURCE, edmill, rows
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

CASE = EXAMPLES / "files.toml"
SCHEMAS = [SOURCE / "tests/run/output/x3d/nodes.xsd"]
if "X3D_SCHEMA" in os.environ:
    SCHEMAS.append(pathlib.Path(os.environ["X3D_SCHEMA"]))
GRAVITY = np.array([0, -9.8, 0])
TABLES = """
[[output]]
type = "milling_dose"
[[output]]
type = "statistics"
columns = [{ variable = "milling_dose", statistics = ["sum", "average"] }]
[[output]]
type = "frequency"
variable = "contact_normal_speed_before"
low = "0 m/s"
high = "2 m/s"
out_of_range = true
title = "Speeds, \\"normal\\""
[[output]]
type = "trends"
interval = "10 ms"
columns = [{ variable = "collision", statistics = ["sum"] }, { variable = "milling_dose", statistics = ["average", "rate"] }]
[[output]]
type = "trends_instant"
interval = "10 ms"
columns = [{ variable = "ball_ball", label = "B/V", true_text = "ball, \\"other\\"", false_text = "vessel" }, { variable = "time" }]
[[output]]
type = "trends_balls"
interval = "10 ms"
columns = [{ variable = "speed", statistics = ["maximum"], with_ball = true }]
[[output]]
type = "trace"
[[output]]
type = "iterations"
collisions = 50
[[output]]
type = "spectra"
[[output]]
type = "rates_above"
[[output]]
type = "vessel_load"
[[output]]
type = "coverage"
"""


def numbers(text):
    return np.array(text.split(), dtype=float)


def vectors(text):
    return numbers(text).reshape(-1, 3)


class Run(unittest.TestCase):
    """One run of the case with every kind of file; tests only read it."""

    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.scratch.name) / "out"
        edmill("run", CASE, "--quiet", "--out", cls.out, code=0)
        with h5py.File(cls.out / "events.h5") as file:
            cls.events = {name: data[:] for name, data in file["events"].items()}

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def last_impact(self, ball, time):
        """State after the ball's last impact up to a time, or nothing: (time, position, velocity,
        spin)."""
        e = self.events
        mine = [(e["ball"] == ball, "ball_"),
                ((e["partner"] == ball) & (e["with_wall"] == 0), "partner_")]
        found = max(((np.flatnonzero(rows & (e["time"] <= time)).max(initial=-1), body)
                     for rows, body in mine))
        k, body = found
        return None if k < 0 else (
            e["time"][k],
            *(e[body + name][k] for name in ("position", "velocity_after", "spin_after")))


class Hdf5(Run):
    def test_events_are_described_by_the_file_itself(self):
        with h5py.File(self.out / "events.h5") as file:
            self.assertEqual(file["case"][()].decode(), CASE.read_text())
            self.assertTrue(file.attrs["program"].startswith("edmill "))
            self.assertEqual((file.attrs["precision"], file.attrs["seed"]), ("double", "1"))
            columns = list(file["events"].values())
            self.assertEqual(len(columns), 19)
            beside = ("final_time", "final_position", "final_velocity", "final_spin",
                      "ball_diameter", "ball_mass")
            for data in [*columns, *(file[name] for name in beside)]:
                self.assertTrue(data.attrs["unit"], data.name)
                self.assertTrue(data.attrs["description"], data.name)
                self.assertTrue(data.chunks, data.name)

    def test_final_state_is_that_of_the_csv(self):
        balls = rows(self.out / "final_state.csv")
        with h5py.File(self.out / "events.h5") as file:
            for name in ("position", "velocity", "spin"):
                expected = [[float(row[f"{name}_{axis}"]) for axis in "xyz"] for row in balls]
                np.testing.assert_array_equal(file["final_" + name][:], expected)
            self.assertEqual(file["final_time"][0], 0.2)
            np.testing.assert_allclose(file["ball_diameter"][:], 28 * [0.00476], rtol=1e-15)
            np.testing.assert_allclose(file["ball_mass"][:],
                                       28 * [8000 * math.pi / 6 * 0.00476 ** 3], rtol=1e-15)

    def test_energy_of_every_impact_closes_with_the_states(self):
        e = self.events
        mass = 8000 * math.pi / 6 * 0.00476**3
        inertia = 0.4 * mass * 0.00238**2
        change = 0
        for body in ("ball_", "partner_"):
            for sign, when in ((1, "after"), (-1, "before")):
                velocity, spin = e[body + "velocity_" + when], e[body + "spin_" + when]
                energy = mass / 2 * (velocity**2).sum(1) + inertia / 2 * (spin**2).sum(1)
                change = change + sign * np.nan_to_num(energy)
        # A slower body leaves with the least separation speed, 1 cm/s.
        effective = np.where(np.isnan(e["partner_spin_before"]).any(axis=1), mass, mass / 2)
        supplied = effective / 2 * np.maximum(0, 0.01**2 - e["approach_speed"] ** 2)
        np.testing.assert_allclose(change, e["wall_work"] - e["milling_dose"] + supplied,
                                   atol=1e-16)
        self.assertGreater(supplied.max(), 1e-9)
        self.assertGreater(e["milling_dose"].sum(), 0.1)

    def test_every_table_is_the_same_as_csv_and_as_hdf5_and_in_two_runs(self):
        folder = pathlib.Path(self.scratch.name)
        entries = TABLES.strip().split("[[output]]")[1:]
        both = ""
        for entry in entries:
            kind = re.search('"(.*?)"', entry)[1]
            both += "[[output]]" + entry + "\n[[output]]" + entry + f'\nfile = "{kind}.h5"\n'
        (folder / "tables.toml").write_text(CASE.read_text().split("[[output]]")[0] + both)
        for out in ("first", "second"):
            edmill("run", folder / "tables.toml", "--quiet", "--out", folder / out, code=0)
        files = sorted((folder / "first").glob("*.h5"))
        self.assertEqual(len(files), 12)
        for file in files:
            self.assertTrue(filecmp.cmp(file, folder / "second" / file.name, shallow=False),
                            file.name)
            lines = rows(file.with_suffix(".csv"))
            self.assertTrue(lines, file.name)
            with h5py.File(file) as data:
                self.assertEqual(data.attrs["seed"], "1")
                by_title = {
                    column.attrs["title"]: column for column in data.values()
                    if "title" in column.attrs
                }
                self.assertEqual(set(by_title), set(lines[0]))
                for title, column in by_title.items():
                    self.assertNotIn(column.attrs["description"], ("", column.name.strip("/")))
                    if title.endswith("]"):
                        self.assertEqual(column.attrs["unit"], title[title.rindex("[") + 1:-1])
                    cells = [row[title] for row in lines]
                    if column.dtype.kind == "S":
                        self.assertEqual([text.decode() for text in column[:]], cells)
                    else:
                        np.testing.assert_array_equal(column[:],
                                                      [float(cell or "nan") for cell in cells],
                                                      f"{file.name} {title}")

    def test_a_second_run_writes_the_same_bytes(self):
        again = pathlib.Path(self.scratch.name) / "again"
        edmill("run", CASE, "--quiet", "--out", again, code=0)
        files = [
            file.relative_to(self.out) for file in self.out.rglob("*")
            if file.is_file() and file.name != "summary.json"
        ]
        self.assertGreater(len(files), 40)
        for file in files:
            self.assertTrue(filecmp.cmp(self.out / file, again / file, shallow=False), file)


class ParaView(Run):
    def frames(self):
        """Time and files of each frame."""
        times = {}
        for part in ElementTree.parse(self.out / "paraview.pvd").getroot().find("Collection"):
            times.setdefault(float(part.get("timestep")), []).append(part.get("file"))
        return times

    def read(self, name):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.out / name))
        reader.Update()
        self.assertEqual(reader.GetErrorCode(), 0, name)
        return reader.GetOutput()

    def balls(self, name):
        data = self.read(name)
        arrays = data.GetPointData()
        found = {
            arrays.GetArrayName(k): vtk_to_numpy(arrays.GetArray(k))
            for k in range(arrays.GetNumberOfArrays())
        }
        return {"position": vtk_to_numpy(data.GetPoints().GetData()), **found}

    def test_frames_come_at_their_times(self):
        frames = self.frames()
        np.testing.assert_allclose(sorted(frames), np.arange(21) * 0.01, atol=1e-15)
        for time, files in frames.items():
            self.assertEqual(len(files), 2)
            for name in files:
                self.assertEqual(
                    self.read(name).GetFieldData().GetArray("TimeValue").GetValue(0), time)

    def test_balls_of_the_last_frame_are_those_of_the_final_state(self):
        frames = self.frames()
        found = self.balls(frames[max(frames)][0])
        balls = rows(self.out / "final_state.csv")
        for name, title in (("position", "position"), ("velocity", "velocity [m/s]"),
                            ("spin", "spin [rad/s]")):
            np.testing.assert_array_equal(
                found[title], [[float(row[f"{name}_{axis}"]) for axis in "xyz"] for row in balls])
        np.testing.assert_array_equal(found["diameter [m]"], 28 * [0.00476])
        np.testing.assert_array_equal(found["ball"], range(28))

    def test_balls_of_every_frame_fly_from_their_last_impact(self):
        checked = 0
        for time, files in self.frames().items():
            found = self.balls(files[0])
            for ball in range(28):
                impact = self.last_impact(ball, time)
                if impact is None:
                    continue
                when, place, velocity, spin = impact
                flown = time - when
                np.testing.assert_allclose(found["position"][ball],
                                           place + velocity * flown + GRAVITY * flown ** 2 / 2,
                                           atol=1e-13)
                np.testing.assert_allclose(found["velocity [m/s]"][ball],
                                           velocity + GRAVITY * flown, atol=1e-13)
                np.testing.assert_array_equal(found["spin [rad/s]"][ball], spin)
                checked += 1
        self.assertGreater(checked, 400)

    def test_dose_of_each_ball_is_that_of_its_impacts(self):
        e = self.events
        for time, files in self.frames().items():
            expected = np.zeros(28)
            before = e["time"] <= time
            np.add.at(expected, e["ball"][before], e["milling_dose"][before])
            pairs = before & (e["with_wall"] == 0)
            np.add.at(expected, e["partner"][pairs], e["milling_dose"][pairs])
            np.testing.assert_allclose(
                self.balls(files[0])["milling_dose [J]"], expected, rtol=1e-12, atol=1e-18)

    def test_vessel_stands_where_the_drive_puts_it(self):
        for time, files in self.frames().items():
            data = self.read(files[1])
            x, y, z = vtk_to_numpy(data.GetPoints().GetData()).T
            phase = 2 * math.pi * 1054 / 60 * time
            theta, gamma = math.pi / 2 + math.pi / 12 * math.cos(phase), math.pi / 12 * math.sin(
                phase)
            along, across = x * math.cos(theta) + y * math.sin(theta) - 0.1, y * math.cos(
                theta) - x * math.sin(theta)
            height, depth = across * math.cos(gamma) + z * math.sin(gamma), z * math.cos(
                gamma) - across * math.sin(gamma)
            np.testing.assert_allclose(np.hypot(along, depth), 0.019, rtol=1e-9)
            np.testing.assert_allclose(np.abs(height), 0.0285, rtol=1e-9)
            walls = vtk_to_numpy(data.GetCellData().GetArray("wall"))
            for cell, wall in enumerate(walls):
                points = data.GetCell(cell).GetPointIds()
                heights = [height[points.GetId(k)] for k in range(points.GetNumberOfIds())]
                where = {0: (True, False), 1: (False, True), 2: (True, True)}[int(wall)]
                self.assertEqual((min(heights) < 0, max(heights) > 0), where)


class X3d(Run):
    def pages(self):
        pages = sorted(self.out.glob("*.x3d"))
        self.assertEqual([page.name for page in pages], ["animation.x3d", "snapshot_100.x3d"])
        return pages

    def validates(self, page, schema):
        return subprocess.run(["xmllint", "--nonet", "--noout", "--schema", schema, page],
                              capture_output=True, check=False)

    def test_pages_validate(self):
        for page in self.pages():
            for schema in SCHEMAS:
                result = self.validates(page, schema)
                self.assertEqual(result.returncode, 0, result.stderr.decode())

    def loaded(self, page):
        """What an X3D program makes of a page: it writes it down again, in single precision. Debian
        12 has it in view3dscene, Debian 13 in castle-model-viewer."""
        command = ["tovrmlx3d", page] if shutil.which("tovrmlx3d") else [
            "castle-model-converter", page, "-", "--stdout-url=page.x3dv"
        ]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def test_pages_load_without_a_warning(self):
        for page in self.pages():
            result = self.loaded(page)
            self.assertEqual((result.returncode, result.stderr), (0, ""), page.name)
            places = re.findall(r"DEF ball_\d+ Transform \{\s*translation (\S+ \S+ \S+)",
                                result.stdout)
            expected = [
                node.get("translation") for node in ElementTree.parse(page).iter("Transform")
                if re.fullmatch(r"ball_\d+",
                                node.get("DEF") or "")
            ]
            self.assertEqual(len(places), 28)
            np.testing.assert_allclose([numbers(place) for place in places],
                                       [numbers(place) for place in expected], rtol=1e-7)

    def test_loading_finds_what_is_wrong(self):
        text = (self.out / "animation.x3d").read_text()
        page = pathlib.Path(self.scratch.name) / "wrong.x3d"
        for right, wrong in (("diffuseColor", "difuseColor"), ("cycleInterval", "cycle"),
                             ("<Sphere ", "<Ball "), ("toNode=\"ball_0\"", "toNode=\"ball_99\""),
                             ("set_rotation", "set_rot")):
            self.assertIn(right, text)
            page.write_text(text.replace(right, wrong, 1))
            self.assertTrue(self.loaded(page).stderr, wrong)

    def test_the_schema_finds_what_is_wrong(self):
        text = (self.out / "animation.x3d").read_text()
        for right, wrong in (("diffuseColor=\"0 0 1\"", "diffuseColor=\"0 0 2\""), ("cycleInterval",
                                                                                    "cycle"),
                             ("<Sphere ", "<Ball "), ("coordIndex=\"0", "coordIndex=\"-2")):
            self.assertIn(right, text)
            page = pathlib.Path(self.scratch.name) / "wrong.x3d"
            page.write_text(text.replace(right, wrong, 1))
            self.assertNotEqual(self.validates(page, SCHEMAS[0]).returncode, 0, wrong)

    def test_interpolators_have_a_value_for_each_key_and_drive_what_is_there(self):
        scene = ElementTree.parse(self.out / "animation.x3d").getroot().find("Scene")
        width = {"PositionInterpolator": 3, "OrientationInterpolator": 4}
        paths = [node for node in scene if node.tag in width]
        self.assertEqual(len(paths), 30)
        for node in paths:
            keys = numbers(node.get("key"))
            self.assertTrue((np.diff(keys) >= 0).all() and keys[0] >= 0 and keys[-1] <= 1 + 1e-12)
            self.assertEqual(len(numbers(node.get("keyValue"))), width[node.tag] * len(keys))
        names = {node.get("DEF") for node in scene.iter()}
        for route in scene.iter("ROUTE"):
            self.assertTrue({route.get("fromNode"), route.get("toNode")} <= names)
        driven = {route.get("toNode"): route.get("toField") for route in scene.iter("ROUTE")}
        self.assertEqual(sum(field == "set_translation" for field in driven.values()), 28)

    def test_balls_of_the_snapshot_touch_and_fly_as_in_the_log(self):
        scene = ElementTree.parse(self.out / "snapshot_100.x3d").getroot().find("Scene")
        places = {
            node.get("DEF"): vectors(node.get("translation"))[0] for node in scene.iter("Transform")
            if (node.get("DEF") or "").startswith("ball_")
        }
        self.assertEqual(len(places), 28)
        e, time = self.events, self.events["time"][100]
        np.testing.assert_allclose(places[f"ball_{e['ball'][100]}"], e["ball_position"][100],
                                   atol=1e-15)
        for ball in range(28):
            impact = self.last_impact(ball, time)
            if impact is not None:
                flown = time - impact[0]
                np.testing.assert_allclose(places[f"ball_{ball}"],
                                           impact[1] + impact[2] * flown + GRAVITY * flown ** 2 / 2,
                                           atol=1e-13)

    def test_balls_of_the_animation_pass_through_their_impacts(self):
        scene = ElementTree.parse(self.out / "animation.x3d").getroot().find("Scene")
        e = self.events
        self.assertAlmostEqual(float(scene.find("TimeSensor").get("cycleInterval")), 50, places=9)
        for ball in range(28):
            path = next(node for node in scene if node.get("DEF") == f"ball_{ball}_path")
            times, places = numbers(path.get("key")) * 0.05, vectors(path.get("keyValue"))
            for k in np.flatnonzero((e["ball"] == ball) & (e["time"] <= 0.05)):
                nearest = np.abs(times - e["time"][k]).argmin()
                self.assertAlmostEqual(times[nearest], e["time"][k], places=14)
                np.testing.assert_allclose(places[nearest], e["ball_position"][k], atol=1e-15)


class Page(Run):
    def test_python_of_the_page_runs_in_the_folder_of_a_run(self):
        snippets = re.findall(r"^```python\n(.*?)^```", (SOURCE / "docs/files.md").read_text(),
                              re.MULTILINE | re.DOTALL)
        self.assertEqual(len(snippets), 5)  # CSV, HDF5, JSON, VTP and PVD, X3D
        for snippet in snippets:
            self.assertLessEqual(len(snippet.splitlines()), 6)
            result = subprocess.run([sys.executable, "-c", snippet], cwd=self.out,
                                    capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, 0, snippet + result.stderr)
            self.assertTrue(result.stdout.strip(), snippet)


if __name__ == "__main__":
    del sys.argv[1]
    unittest.main()
