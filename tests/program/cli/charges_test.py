#!/usr/bin/env python3
"""What a person at the mill asks, by the program: new cases of all mills, wrong wishes, charges
compared in a sweep and on a page, milling times, runs until a precision, how evenly powder is
treated.

usage: PYTHONPATH=tests/support python3 charges_test.py EDMILL
"""
import math
import pathlib
import random
import re
import sys
import tempfile
import unittest

from program import rows, said, summary


class Charges(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def new(self, name, *words):
        (self.folder / name).write_text(said("new", *words))
        return self.folder / name

    def summary(self, case, *words):
        said("run", case, "--quiet", "--out", self.folder / "run", *words)
        return summary(self.folder / "run")

    def test_every_mill_runs_and_tells_the_milling_time(self):
        keys = [line.split()[0] for line in said("machines").splitlines() if line[0] != " "]
        self.assertEqual(len(keys), 14)
        self.assertIn("spex8000m", keys)
        for mill in keys:
            case = self.new(
                "case.toml", "--mill", mill, "--balls", "8x8mm", "--powder", "3g", "--target-dose",
                "10 kJ/g", "--time",
                "8 s" if mill == "drum" else "1.5 s")  # a turn of the drum takes a second
            s = self.summary(case)
            expected = 1e7 * 3e-3 / s["milling_dose_rate"]
            self.assertAlmostEqual(s["target"]["milling_time"] / expected, 1, 12)
            share = s["intervals"]["milling_dose_rate"] / s["milling_dose_rate"]
            self.assertAlmostEqual(s["target"]["milling_time_half_width"] / expected / share, 1, 9)

    def test_wishes_that_cannot_be_are_told(self):
        for words, part in ((["--mill",
                              "foo"], "--mill"), (["--balls",
                                                   "ten"], "--balls"), (["--balls",
                                                                         "10x12.7"], "--balls"),
                            (["--balls",
                              "0x5mm"], "--balls"), (["--balls",
                                                      "3x5mm:wood"], "a material among steel"),
                            (["--balls", "400x12.7mm"], "at most 0.741"), (["--powder",
                                                                            "5"], "--powder"),
                            (["--speed", "fast"], "--speed"), (["--target-dose",
                                                                "1 kJ/g"], "--powder"),
                            (["--powder", "5g", "--target-dose",
                              "1 J"], "--target-dose"), (["--restitution", "1.2"], "--restitution"),
                            (["--friction", "-1"], "--friction"), (["--time", "0 s"], "--time")):
            error = said("new", *words, code=2)
            self.assertIn(part, error)
            self.assertEqual(error.count("edmill: "), 1, error)

    def test_an_edited_case_is_not_replaced(self):
        case = self.folder / "case.toml"
        words = ("new", "--balls", "3x12mm", "--out", case)
        for _ in range(2):  # the same file again is no loss
            said(*words)
        made = case.read_text()
        case.write_text(made + "# mine\n")
        self.assertIn(f'--out: "{case}" exists', said(*words, code=2))
        self.assertEqual(case.read_text(), made + "# mine\n")
        said(*words, "--force")
        self.assertEqual(case.read_text(), made)

    def test_mills_have_the_names_that_people_write(self):
        for key, names in {
                "Retsch PM 100 planetary ball mill": ("PM100", "pm 100", "Retsch PM 100", "pm-100"),
                "SPEX 8000M Mixer/Mill": ("8000M", "spex 8000m", "SPEX SamplePrep 8000M"),
                "Fritsch PULVERISETTE 5 planetary mill":
                    ("P5", "Pulverisette 5 classic line", "Fritsch P-5"),
                "Fritsch PULVERISETTE 7 planetary micro mill":
                    ("p7", "PULVERISETTE 7 premium line"), "Retsch MM 400 mixer mill":
                        ("MM400", "Retsch mixer mill MM 400")
        }.items():
            for name in names:
                self.assertEqual(
                    said("new", "--mill", name, "--balls", "1x5mm").split(",")[0], f"# {key}", name)
        for name, part in (("emax", "joints"), ("Simoloyer", "stirs"), ("MM 200", "mm400"),
                           ("pm10", "'pm100'"), ("hammer", "[[mill.joint]]")):
            self.assertIn(part, said("new", "--mill", name, code=2), name)
        self.assertEqual(said("new", "--balls", "2x5mm:WC"),
                         said("new", "--balls", "2x5mm:tungsten-carbide"))

    def test_a_jar_and_its_filling(self):
        def value(case, key):
            return re.search(rf"(?m)^{key} = \"?([\d.]+)", case)[1]

        pm = ["new", "--mill", "pm100"]
        half = said(*pm, "--jar", "250ml", "--fill", "50%", "--balls", "15mm")
        volume = math.pi / 4 * 7.5**2 * 5.7
        self.assertEqual(value(half, "count"),
                         str(round(0.5 * 0.6 * volume / (math.pi / 6 * 1.5 ** 3))))
        self.assertRegex(half, r"fill 5\d %|fill 50 %")
        for size in ("75x57mm", "75 mm x 57 mm", "7.5x5.7cm"):
            other = said(*pm, "--jar", size, "--fill", "0.5", "--balls", "15mm")
            self.assertEqual(
                (value(other, "diameter"), value(other, "height"), value(other, "count")),
                ("75", "57", value(half, "count")), size)
        for mill in ("pm100", "mm400",
                     "drum"):  # a volume that is not in the list: the shape of the usual jar
            case = self.new("case.toml", "--mill", mill, "--jar", "0.08 l", "--balls", "1x5mm")
            free = re.search(r"packing fraction +([\d.e-]+)", said("check", case))[1]
            self.assertAlmostEqual(math.pi / 6 * 0.5**3 / float(free) / 80, 1, 2, mill)
        case = said("new", "--balls", "10mm", "--powder", "5g", "--bpr", "10:1")
        self.assertEqual(value(case, "count"), str(round(50 / (8 * math.pi / 6))))
        case = said("new", "--balls", "10x10mm", "--bpr", "10")
        self.assertAlmostEqual(float(value(case, "mass")), 8 * math.pi / 6, 3)
        mixed = said("new", "--balls", "2x12.7mm", "--balls", "6mm", "--fill", "20%")
        self.assertEqual(mixed.count("[[balls]]"), 2)
        for words, part in ((["--jar", "250"], "--jar"), (["--jar", "75x57"], "--jar"),
                            (["--jar", "0ml"], "--jar"), (["--fill",
                                                           "130%"], "--fill"), (["--fill",
                                                                                 "half"], "--fill"),
                            (["--fill", "10%", "--balls",
                              "3x5mm"], "alone"), (["--bpr",
                                                    "-1"], "--bpr"), (["--balls", "5mm"],
                                                                      "determine their number"),
                            (["--balls", "5mm", "--balls", "6mm", "--fill",
                              "9%"], "determine their number"), (["--balls", "5mm", "--bpr",
                                                                  "10"], "determine their number"),
                            (["--fill", "9%", "--bpr", "9", "--powder", "1g"], "two of the three"),
                            (["--balls", "3x5mm", "--bpr", "9", "--powder",
                              "1g"], "alone"), (["--fill", "100%"], "only the first")):
            error = said("new", *words, code=2)
            self.assertIn(part, error)
            self.assertEqual(error.count("edmill: "), 1, error)

    def test_doubtful_wishes_get_a_word_and_others_none(self):
        for mill, speed, said_so in (("pm100", "500rpm", False), ("pm100", "800rpm", True),
                                     ("mm400", "20Hz", False), ("mm400", "50Hz", True)):
            self.assertEqual("the machine has" in said("new", "--mill", mill, "--speed", speed),
                             said_so, mill + speed)
        for fill, said_so in (("30%", False), ("50%", False), ("80%", True)):
            self.assertEqual(
                "Above half" in said("new", "--mill", "pm100", "--jar", "250ml", "--balls", "5mm",
                                     "--fill", fill), said_so, fill)
        for balls, said_so in (("10x10mm", False), ("10x10mm:inox", False), ("10x10mm:WC", True),
                               ("10x10mm:agate", True)):
            self.assertEqual("assumed for" in said("new", "--balls", balls, "--powder", "4g"),
                             said_so, balls)

    def test_random_charges_are_cases(self):
        numbers = random.Random(20261126)
        print("seed 20261126")
        for _ in range(20):
            words = []
            for _ in range(numbers.randint(1, 3)):
                material = numbers.choice(["", ":steel", ":zirconia", ":tungsten-carbide"])
                words += [
                    "--balls", f"{numbers.randint(1, 8)}x{numbers.uniform(2, 9):.2f}mm{material}"
                ]
            if numbers.random() < 0.5:
                words += ["--powder", f"{numbers.uniform(0.5, 9):.2f} g"]
            case = self.new("case.toml", "--mill", numbers.choice(["spex8000", "pm100"]), *words)
            self.assertIn("is a valid case", said("check", case))

    def test_a_point_has_its_own_list_of_balls(self):
        self.new("base.toml", "--powder", "5g", "--target-dose", "10 kJ/g", "--time", "1.5 s",
                 "--restitution", "0.5")
        (self.folder / "charges.sweep.toml").write_text('''[sweep]
case = "base.toml"
replicas = 2
[[sweep.point]]
name = "large"
[[sweep.point.balls]]
count = 10
diameter = "12.7 mm"
[[sweep.point]]
name = "mixed"
balls = [{ count = 2, diameter = "12.7 mm" },
         { count = 4, diameter = "6.35 mm", density = "7.8 g/cm3" }]
[[sweep.point]]
name = "by mass"
balls = [{ mass = "20 g", diameter = "12.7 mm", density = "8 g/cm3" }, { count = 0, diameter = "1 mm" }]
''')
        text = said("sweep", self.folder / "charges.sweep.toml", "--estimate", "--out",
                    self.folder / "out")
        self.assertRegex(text, r"^6 runs, about \d+:\d\d min on \d+ threads\n$")
        self.assertFalse((self.folder / "out").exists())
        said("sweep", self.folder / "charges.sweep.toml", "--quiet", "--out", self.folder / "out")
        text = said("sweep", self.folder / "charges.sweep.toml", "--estimate", "--out",
                    self.folder / "out")
        self.assertEqual(text, "6 runs reused; no run is left to do\n")
        points = rows(self.folder / "out/sweep.csv")
        self.assertEqual([point["name"] for point in points], ["large", "mixed", "by mass"])
        # The same by a case of its own; 20 g of 12.7 mm are 2 balls.
        for row, words in zip(
                points, (["10x12.7mm"], ["2x12.7mm", "4x6.35mm:stainless-steel"], ["2x12.7mm"])):
            case = self.new("own.toml", *(w for text in words for w in ("--balls", text)),
                            "--powder", "5g", "--target-dose", "10 kJ/g", "--time", "1.5 s",
                            "--restitution", "0.5")
            rates = [
                self.summary(case, "--set", f"run.seed={seed}")["milling_dose_rate"]
                for seed in (1, 2)
            ]
            self.assertAlmostEqual(float(row["milling_dose_rate [W]"]), sum(rates) / 2, 12)
            time = sum(1e7 * 5e-3 / rate for rate in rates) / 2
            self.assertAlmostEqual(float(row["milling_time [s]"]) / time, 1, 12)
        page = (self.folder / "out/sweep.html").read_text()
        for name in ("large", "mixed", "by mass"):
            self.assertTrue(name in page, name)

    def test_points_are_drawn_over_what_varies(self):
        self.new("base.toml", "--balls", "3x9mm", "--time", "1 s", "--restitution", "0.5")
        for grid, title, curves in (
            ('"mill.speed" = ["900 rpm", "1000 rpm", "1100 rpm"]', "mill.speed [rpm]", 1),
            ('"mill.speed" = ["900 rpm", "1000 rpm", "1100 rpm"]\n"contact.restitution" = [0.5, 0.7]',
             "mill.speed [rpm]", 2),
            ('"contact.model" = ["walton-braun", "constant"]\n"contact.restitution_tangential" = [0.5]',
             "point", 0)):
            (self.folder / "s.sweep.toml").write_text(
                f'[sweep]\ncase = "base.toml"\n[sweep.grid]\n{grid}\n"run.end_time" = ["0.8 s"]\n')
            out = self.folder / f"points of {curves} curves"
            said("sweep", self.folder / "s.sweep.toml", "--quiet", "--out", out)
            page = (out / "sweep.html").read_text()
            self.assertIn(f">{title}<", page)
            for e in (0.5, 0.7) if curves == 2 else ():
                self.assertIn(f">contact.restitution = {e:g}<", page)
                self.assertIn(f"mill.speed = 900 rpm, contact.restitution = {e:g}<", page)
            self.assertNotIn("run.end_time = 0.8 s", page)  # all points have it

    def test_no_balls_at_all_are_refused(self):
        case = self.new("case.toml", "--balls", "3x5mm")
        error = said("check", case, "--set", "balls.0.count=0", code=2)
        self.assertIn("found 0 in all entries", error)
        error = said("check", case, "--set", 'balls=[{count=2, mass="5 g", diameter="5 mm"}]',
                     code=2)
        self.assertIn("both 'count' and 'mass'", error)

    def test_an_optimum_at_the_end_of_its_range_is_told(self):
        self.new("base.toml", "--balls", "4x9mm", "--time", "1 s", "--restitution", "0.5")
        (self.folder / "o.optimize.toml").write_text('''[optimize]
case = "base.toml"
objective = "milling_dose_rate"
runs_max = 12
points = 2
refinements = 0
[[optimize.variable]]
key = "mill.speed"
low = "900 rpm"
high = "1100 rpm"
''')
        text = said("optimize", self.folder / "o.optimize.toml", "--estimate", "--out",
                    self.folder / "out")
        self.assertRegex(text, r"^6 runs, about .* in all at most 12 runs, about \d+:\d\d min\n$")
        text = said("optimize", self.folder / "o.optimize.toml", "--out", self.folder / "out")
        self.assertIn("mill.speed is at the end 'high' of its range", text)
        self.assertTrue("at the end" in (self.folder / "out/optimize.html").read_text())

    def test_a_page_compares_runs(self):
        for name, balls in (("a", "6x9mm"), ("b", "3x9mm")):
            case = self.new("case.toml", "--balls", balls, "--time", "4 s")
            said("run", case, "--report", "--quiet", "--out", self.folder / name)
        text = said("report", self.folder / "a", self.folder / "b", self.folder / "a", "--out",
                    self.folder / "page.html")
        self.assertIn("page.html", text)
        page = (self.folder / "page.html").read_text()
        rates = [summary(self.folder / name)["milling_dose_rate"] for name in "ab"]
        change = 100 * (rates[1] / rates[0] - 1)
        for part in (f"\u2212{-change:.1f} %, significant<", "+0.0 %, not significant", "6 of 9 mm",
                     "3 of 9 mm"):  # the third run is the first one
            self.assertTrue(part in page, part)
        self.assertIn("no readable file",
                      said("report", self.folder / "a", self.folder / "none", code=2))
        self.assertIn("several runs",
                      said("report", self.folder / "a", "--out", self.folder / "x.html", code=2))

    def test_a_run_ends_at_its_precision_or_says_how_far_it_is(self):
        case = self.new("case.toml", "--balls", "6x9mm", "--time", "3 s")
        s = self.summary(case, "--until-precision", "3 %")
        self.assertEqual(s["end_reason"], "dose_rate_precision")
        self.assertLess(s["intervals"]["milling_dose_rate"], 0.031 * s["milling_dose_rate"])
        s = self.summary(case, "--until-precision", "0.001", "--set", 'run.end_time="4 s"')
        self.assertEqual(s["end_reason"], "end_time")
        self.assertIn("precision", s["warnings"])
        for wrong in ("0", "100%", "1 percent", "-1%"):
            self.assertIn("--until-precision",
                          said("run", case, f"--until-precision={wrong}", code=2))

    def test_hits_of_powder_are_poissons(self):
        case = self.new("case.toml", "--balls", "6x9mm", "--time", "2 s")
        output = 'output=[{type="treatment", share_per_impact=1e-3, most=40, angles=6, heights=4, rings=2}, {type="collisions"}]'
        self.summary(case, "--set", output)
        lines = (self.folder / "run/treatment.csv").read_text().splitlines()
        portions = rows(self.folder / "run/treatment.csv")
        column = {name.split(" [")[0]: name for name in portions[0]}
        impacts = len((self.folder / "run/collisions.csv").read_text().splitlines()) - 1
        self.assertTrue(any(line == f"# {impacts} impacts that work powder" for line in lines),
                        impacts)
        mean = 1e-3 * impacts
        for row in portions[:-1]:
            n = int(row["hits"])
            self.assertAlmostEqual(float(row[column["mixed"]]),
                                   math.exp(-mean + n * math.log(mean) - math.lgamma(n + 1)), 9)
        for name in ("mixed", "in_place"):
            self.assertAlmostEqual(sum(float(row[column[name]]) for row in portions), 1, 9)
        # Powder that is not mixed is treated less evenly: more of it is not hit at all.
        self.assertGreater(float(portions[0][column["in_place"]]),
                           float(portions[0][column["mixed"]]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
