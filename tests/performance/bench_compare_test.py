#!/usr/bin/env python3
"""bench.py detects real differences and no others, and runs simultaneously what --core promises.
usage: bench_compare_test.py BENCH_PY"""
import json
import os
import random
import subprocess
import sys
import tempfile
import unittest

BENCH = sys.argv.pop(1)
random_source = random.Random(7)


def noisy(middle, noise, count=9):
    return [middle * (1 + random_source.gauss(0, noise)) for _ in range(count)]


def figures(**named):
    units = {True: "collisions per CPU second", False: "ns CPU time"}
    return {"machine": {"cpu": "none"},
            "figures": {name: {"unit": units[more], "more_is_better": more, "values": values}
                        for name, (more, values) in named.items()}}


class Compare(unittest.TestCase):
    def compare(self, a, b, *more):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, name) for name in ("a.json", "b.json")]
            for path, content in zip(paths, (a, b)):
                with open(path, "w", encoding="utf-8") as out:
                    out.write(content if isinstance(content, str) else json.dumps(content))
            return subprocess.run([sys.executable, BENCH, "compare", *paths, *more],
                                  capture_output=True, text=True)

    def verdict(self, a, b, more_is_better=True, code=0):
        done = self.compare(figures(x=(more_is_better, a)), figures(x=(more_is_better, b)))
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        lines = [line for line in done.stdout.split("\n") if line.startswith("x ")]
        self.assertEqual(len(lines), 1)
        return lines[0].split("]")[-1].strip() if "]" in lines[0] else lines[0]

    def test_clear_differences(self):
        self.assertEqual(self.verdict(noisy(1e6, 0.01), noisy(1.1e6, 0.01)), "faster")
        self.assertEqual(self.verdict(noisy(1e6, 0.01), noisy(0.9e6, 0.01), code=1), "slower")

    def test_times_count_the_other_way(self):
        self.assertEqual(self.verdict(noisy(100, 0.01), noisy(110, 0.01), False, code=1), "slower")
        self.assertEqual(self.verdict(noisy(100, 0.01), noisy(90, 0.01), False), "faster")

    def test_noise_alone_is_rarely_a_difference(self):
        false_alarms = 0
        for _ in range(40):
            done = self.compare(figures(x=(True, noisy(1e6, 0.1))),
                                figures(x=(True, noisy(1e6, 0.1))))
            false_alarms += "no difference" not in done.stdout
        self.assertLessEqual(false_alarms, 2)

    def test_small_differences_do_not_matter(self):
        self.assertEqual(self.verdict([100.0] * 9, [101.0] * 9), "no difference")
        self.assertEqual(self.verdict([101.0] * 9, [100.0] * 9), "no difference")

    def test_one_wild_value_does_not_matter(self):
        wild = noisy(1e6, 0.005)
        wild[4] = 1e5
        self.assertEqual(self.verdict(noisy(1e6, 0.005), wild), "no difference")

    def test_two_values_decide_nothing(self):
        self.assertIn("too few values", self.verdict([1.0, 1.0], [2.0, 2.0]))

    def test_one_slower_figure_sets_the_exit_code(self):
        a = figures(fast=(True, noisy(1, 0.01)), slow=(True, noisy(1, 0.01)))
        b = figures(fast=(True, noisy(2, 0.01)), slow=(True, noisy(0.5, 0.01)))
        done = self.compare(a, b)
        self.assertEqual(done.returncode, 1)
        self.assertIn("1 faster, 1 slower", done.stdout)

    def ratio_line(self, together):
        names = {"edmill/x": [2.0, 30.0, 1.0], "minimal/x": [1.0, 10.0, 1.0]}
        content = figures(**{name: (True, values) for name, values in names.items()})
        content["together"] = together
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "a.json")
            with open(path, "w", encoding="utf-8") as out:
                json.dump(content, out)
            done = subprocess.run([sys.executable, BENCH, "ratios", path], capture_output=True,
                                  text=True)
        return [line.split() for line in done.stdout.split("\n") if line.startswith("x ")]

    def test_rounds_that_ran_together_are_compared_one_by_one(self):
        self.assertEqual(self.ratio_line(True), [["x", "2.000", "[1.000,", "3.000]"]])

    def test_rounds_that_did_not_are_compared_by_their_medians(self):
        line, = self.ratio_line(False)
        self.assertEqual(line[:2], ["x", "2.000"])
        self.assertNotEqual(line[2:], ["[1.000,", "3.000]"])

    def test_files_that_ran_together_are_compared_round_by_round(self):
        load = [random_source.uniform(0.4, 1) for _ in range(9)
               ]  # of the machine: varies much more than the difference
        a = figures(x=(True, [1e6 * m for m in load]))
        b = figures(x=(True, [1.05e6 * m * random_source.gauss(1, 0.004) for m in load]))
        self.assertIn("1 no difference", self.compare(a, b).stdout)
        a["together"], b["together"] = "one run", "another"
        self.assertIn("1 no difference", self.compare(a, b).stdout)
        b["together"] = "one run"
        self.assertIn("1 faster", self.compare(a, b).stdout)

    def test_bad_input(self):
        good = figures(x=(True, [1.0, 1.0, 1.0]))
        self.assertEqual(self.compare("{", good).returncode, 2)
        self.assertEqual(self.compare("[]", good).returncode, 2)
        self.assertEqual(self.compare(figures(x=(True, [0.0, 1.0, 1.0])), good).returncode, 2)
        self.assertEqual(self.compare(figures(y=(True, [1.0, 1.0, 1.0])), good).returncode, 2)
        self.assertEqual(self.compare(figures(x=(False, [1.0, 1.0, 1.0])), good).returncode, 2)


# Replaces a benchmark program. With PARTY set, each process waits until that many processes of a
# case exist.
PROGRAM = r"""#!/usr/bin/env python3
import glob, json, os, re, sys, time
names = ["edmill/a/1/iterations:3", "minimal/a/1", "edmill/b", "operation/c"]
options = dict(argument.split("=", 1) for argument in sys.argv[1:] if "=" in argument)
chosen = [n for n in names if re.search(options.get("--benchmark_filter", ""), n)]
if "--benchmark_list_tests" in sys.argv:
    print("\n".join(chosen))
    sys.exit()
case = chosen[0].split("/")[1]
here = os.path.dirname(os.path.abspath(__file__))
open(os.path.join(here, "%s.%d" % (case, os.getpid())), "w").close()
party = json.loads(os.environ.get("PARTY", "{}")).get(case, 0)
late = time.monotonic() + 20
while len(glob.glob(os.path.join(here, case + ".*"))) < party:
    if time.monotonic() > late:
        sys.exit("alone")
    time.sleep(0.01)
print(json.dumps({"benchmarks": [{"name": n, "time_unit": "ns", "cpu_time": 5.0, "collisions": 1e6} for n in chosen]}))
"""


class Run(unittest.TestCase):
    def run_bench(self, party, *more):
        """Runs one program as both binaries, and reads the resulting files."""
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "program")
            with open(program, "w", encoding="utf-8") as out:
                out.write(PROGRAM)
            os.chmod(program, 0o755)
            paths = [os.path.join(folder, name) for name in ("a.json", "b.json")]
            files = [
                argument for path in paths for argument in ("--binary", program, "--out", path)
            ]
            done = subprocess.run([sys.executable, BENCH, "run", *files, "--rounds", "1", *more],
                                  capture_output=True, text=True,
                                  env={**os.environ, "PARTY": json.dumps(party)})
            self.assertEqual(done.returncode, 0, done.stderr)
            results = []
            for path in paths:
                with open(path, encoding="utf-8") as text:
                    results.append(json.load(text))
            return results

    def test_all_programs_of_a_case_run_at_once(self):
        core = str(min(os.sched_getaffinity(0)))
        one, two = self.run_bench({"a": 4, "b": 2, "c": 2}, "--core", core)
        self.assertTrue(one["together"])
        self.assertEqual(one["together"], two["together"])
        for result in one, two:
            self.assertEqual(
                {name: len(figure["values"]) for name, figure in result["figures"].items()},
                {"edmill/a/1": 1, "minimal/a/1": 1, "edmill/b": 1, "operation/c": 1})

    def test_without_a_core_they_run_in_turn(self):
        one, two = self.run_bench({}, "--filter", "^edmill/")
        self.assertIsNone(one["together"])
        self.assertEqual(list(two["figures"]), ["edmill/a/1", "edmill/b"])


if __name__ == "__main__":
    unittest.main()
