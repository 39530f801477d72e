#!/usr/bin/env python3
"""The npm package: built by Emscripten, installed offline into an empty folder, and compared with
the program: bits, texts, exit codes, JUnit, standard input, memory; its module; the script of
docs/examples/ci. Needs Debian's emscripten and nodejs, and npm.

usage: PYTHONPATH=tests/support python3 package_test.py EDMILL FOLDER [NODE...]
FOLDER keeps the build and the package; NODE are further programs "node" to try
"""
import hashlib
import json
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

from emscripten import build, published
from program import EDMILL, EXAMPLES, SOURCE

FOLDER = pathlib.Path(sys.argv[2]).resolve()
NODES = sys.argv[3:]
NEEDS = {
    "sweep a.toml": "threads", "optimize a.toml": "threads", "run demo.toml --seeds 3": "threads",
    "certify demo.toml --collisions 9": "MPFR", "prove demo.toml --collisions 9": "Arb",
    "sensitivity demo.toml --by contact.friction --events 3": "MPFR",
    "run demo.toml --precision mpfr50": "MPFR", "run demo.toml --digits 10": "MPFR",
    "run demo.toml --shadow float128": "MPFR", "run demo.toml --estimate": "MPFR",
    "run demo.toml --report": "pugixml", "report a": "pugixml", "demo": "pugixml",
    "check demo.toml --draw a.svg": "pugixml", "audit demo.toml faulty.csv.gz": "zlib"
}
SAME = [
    "check demo.toml", "machines", "variables", "audit demo.toml clean.csv",
    "audit demo.toml faulty.csv --examples 1", "audit demo.toml faulty.csv --identify",
    "audit demo.toml clean.csv --quiet", "compare clean.csv faulty.csv",
    "compare clean.csv clean.csv --events 100", "check clean.csv", "check missing.toml",
    "audit demo.toml missing.csv", "audit demo.toml demo.toml", "runn demo.toml",
    "run demo.toml --out", "audit demo.toml clean.csv --walls 1,1,1", "run broken.toml",
    "export demo.toml --to lammps --out deck", "compare clean.csv empty.csv", "new --balls 5x10mm"
]


def words(line):
    return line.split()


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        _, cls.tarball = build(FOLDER)
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="edmill-npm-"))
        os.chdir(cls.folder)
        subprocess.run(
            ["npm", "install", "--offline", "--silent", "--no-audit", "--no-fund", cls.tarball],
            check=True)
        shutil.copy(EXAMPLES / "demo.toml", ".")
        pathlib.Path("broken.toml").write_text("[run]\nend_time = 3\n[mill]\ntype = \"spex\"\n")
        log = [
            "--set", "run.max_collisions=3000", "--set", 'output=[{type="collisions",states=true}]'
        ]
        subprocess.run([EDMILL, "run", "demo.toml", "--quiet", "--out", "own", *log], check=True)
        shutil.copy("own/collisions.csv", "clean.csv")
        rows = pathlib.Path("clean.csv").read_text().splitlines()
        pathlib.Path("empty.csv").write_text(rows[0] + "\n")
        subprocess.run([
            EDMILL, "run", "demo.toml", "--quiet", "--out", "other", *log, "--set",
            "contact.restitution=0.6"
        ], check=True)
        shutil.copy("other/collisions.csv", "faulty.csv")
        subprocess.run("gzip -k faulty.csv", shell=True, check=True)

    @classmethod
    def tearDownClass(cls):
        os.chdir("/")
        shutil.rmtree(cls.folder)

    def npx(self, *arguments, node=None, **options):
        command = ["npx", "--offline", "edmill"
                  ] if node is None else [node, "node_modules/edmill/edmill.js"]
        return subprocess.run(
            [*command, *arguments],
            **({"capture_output": True, "text": True, "stdin": subprocess.DEVNULL} | options))

    def test_the_package_is_small_and_is_that_of_npm_pack(self):
        print(f"{self.tarball.stat().st_size / 1e6:.2f} MB")
        self.assertLess(self.tarball.stat().st_size, 3e6)
        done = subprocess.run(["npm", "pack", "--dry-run", "--json", FOLDER / "build/npm/package"],
                              capture_output=True, text=True, check=True)
        listed = {entry["path"] for entry in json.loads(done.stdout)[0]["files"]}
        ours = subprocess.run(["tar", "-tf", self.tarball], capture_output=True, text=True,
                              check=True).stdout.split()
        self.assertEqual(listed, {name.removeprefix("package/") for name in ours})

    def test_a_run_has_the_published_bits(self):
        for node in (None, *NODES):
            begin = time.monotonic()
            done = self.npx("run", "demo.toml", "--quiet", "--out", "bits", "--set",
                            "run.start_time=0 s", "--set", "run.max_collisions=20000", "--set",
                            'output=[{type="collisions"}]', node=node)
            self.assertEqual((done.returncode, done.stderr), (0, ""), node)
            print(f"{node or 'npx'}: 20 000 collisions in {time.monotonic() - begin:.2f} s")
            self.assertEqual(
                hashlib.sha256(pathlib.Path("bits/collisions.csv").read_bytes()).hexdigest(),
                published("demo"))

    def test_texts_and_exit_codes_are_those_of_the_program(self):
        for line in SAME:
            own = subprocess.run([EDMILL, *words(line)], capture_output=True, text=True)
            for node in (None, *NODES):
                done = self.npx(*words(line), node=node)
                self.assertEqual(
                    (done.returncode, done.stdout, done.stderr.replace(", certificate", "")),
                    (own.returncode, own.stdout, own.stderr), f"{node} {line}")

    def test_runs_of_all_examples_are_those_of_the_program(self):
        compared = 0
        for case in [
                *sorted(EXAMPLES.glob("*.toml")), *sorted(
                    (SOURCE / "regression/reference").glob("*.toml"))
        ]:
            options = [
                "run", case, "--quiet", "--set", "run.max_collisions=500", "--set",
                'output=[{type="collisions",states=true},{type="spectra"}]'
            ]
            own = subprocess.run([EDMILL, *options, "--out", "program"], capture_output=True,
                                 text=True)
            done = self.npx(*options, "--out", "package", node="node")
            self.assertEqual((done.returncode, done.stderr), (own.returncode, own.stderr), case)
            if own.returncode == 0:
                compared += 1
                for name in ("collisions.csv", "final_state.csv", "spectra.csv", "case.toml"):
                    self.assertEqual(
                        pathlib.Path("package", name).read_bytes(),
                        pathlib.Path("program", name).read_bytes(), f"{case} {name}")
        print(compared, "cases have the same files")
        self.assertGreater(compared, 18)

    def test_two_at_once_and_a_full_disk(self):
        running = [
            subprocess.Popen([
                "node", "node_modules/edmill/edmill.js", "run", "demo.toml", "--quiet", "--out",
                f"at-once-{k}"
            ]) for k in range(3)
        ]
        self.assertEqual([process.wait() for process in running], [0, 0, 0])
        self.assertEqual(
            len({pathlib.Path(f"at-once-{k}/final_state.csv").read_bytes() for k in range(3)}), 1)
        done = subprocess.run("node node_modules/edmill/edmill.js check demo.toml > /dev/full",
                              shell=True, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)

    def test_what_it_cannot_do_gets_one_sentence(self):
        pathlib.Path("a.toml").write_text('[sweep]\ncase = "demo.toml"\n')
        for line, need in NEEDS.items():
            done = self.npx(*words(line))
            self.assertEqual(done.returncode, 2, f"{line}: {done.stderr}")
            self.assertRegex(
                done.stderr,
                rf"^edmill: .* needs {need}, which this build of edmill does not contain\n$", line)

    def test_junit(self):
        for log, code, failures in (("clean.csv", 0, 0), ("faulty.csv", 6, 1)):
            done = self.npx("audit", "demo.toml", log, "--junit", "audit.xml", "--quiet")
            self.assertEqual(done.returncode, code, done.stderr)
            suite = ElementTree.parse("audit.xml").getroot()
            self.assertGreaterEqual(int(suite.get("failures")), failures)
            self.assertEqual(int(suite.get("failures")), len(suite.findall("testcase/failure")))
            subprocess.run([EDMILL, "audit", "demo.toml", log, "--junit", "own.xml", "--quiet"])
            self.assertEqual(
                pathlib.Path("audit.xml").read_bytes(),
                pathlib.Path("own.xml").read_bytes())

    def test_standard_input(self):
        with open("clean.csv") as log:
            done = self.npx("audit", "demo.toml", "-", "--quiet", stdin=log)
        self.assertEqual(done.returncode, 0, done.stderr)
        done = subprocess.run(
            "gunzip -c faulty.csv.gz | npx --offline edmill audit demo.toml - --quiet", shell=True)
        self.assertEqual(done.returncode, 6)
        done = subprocess.run("npx --offline edmill check - < demo.toml", shell=True,
                              capture_output=True, text=True)
        self.assertIn("- is a valid case", done.stdout)

    def test_memory_is_bounded(self):
        rng, sizes = random.Random(7), []
        for rows in (20_000, 400_000):
            with open("long.csv", "w") as log:
                log.write("time,ball,partner_kind,partner,approach_speed\n")
                for k in range(rows):
                    log.write(
                        f"{k * 1e-5},{rng.randrange(28)},wall,{rng.randrange(3)},{rng.random()}\n")
            script = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL); " \
                "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
            done = subprocess.run([
                sys.executable, "-c", script, "node", "node_modules/edmill/edmill.js", "audit",
                "demo.toml", "long.csv"
            ], capture_output=True, text=True, check=True)
            sizes.append(int(done.stdout) / 1024)
        print(f"memory for 20 000 and 400 000 rows: {sizes[0]:.0f} and {sizes[1]:.0f} MB")
        self.assertLess(sizes[1], 1.2 * sizes[0] + 20)

    def test_identify_and_certificate(self):
        done = self.npx("identify", "demo.toml", "faulty.csv")
        self.assertEqual(done.returncode, 6)
        self.assertIn("restitution = 0.6", done.stdout)
        certificate = SOURCE / "src/bindings/browser/three_balls.certificate"
        done = self.npx("certificate", certificate)
        self.assertEqual((done.returncode, done.stdout[:9]), (0, "accepted:"), done.stderr)
        text = certificate.read_text()
        place = text.index('"time":"') + 12  # a digit of the first time
        pathlib.Path("tampered").write_text(text[:place] + ("1" if text[place] != "1" else "2") +
                                            text[place + 1:])
        done = self.npx("certificate", "tampered")
        self.assertEqual((done.returncode, done.stdout[:9]), (6, "rejected:"), done.stderr)
        done = self.npx("certificate", "demo.toml")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))

    def test_module(self):
        script = """
            import {audit, run, check, compare, certificate, edmill, EdmillError} from 'edmill';
            const out = {};
            out.clean = await audit('demo.toml', 'clean.csv');
            out.faulty = await audit('demo.toml', 'faulty.csv', {gapTolerance: 1e-4, set: ['run.seed=1', 'run.end_time="5 s"'], quiet: true});
            out.run = await run('-', {input: (await import('fs')).readFileSync('demo.toml'), set: 'run.max_collisions=1000'});
            out.check = await check('demo.toml');
            out.compare = await compare('clean.csv', 'faulty.csv');
            out.version = await edmill(['--version']);
            try { await audit('demo.toml', 'missing.csv'); } catch (error) { out.error = [error instanceof EdmillError, error.code, error.message]; }
            try { await audit('demo.toml', 'clean.csv', {walks: 1}); } catch (error) { out.type = error.message; }
            console.log(JSON.stringify(out));"""
        pathlib.Path("module.mjs").write_text(script)
        for node in ("node", *NODES):
            done = subprocess.run([node, "module.mjs"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            out = json.loads(done.stdout)
            self.assertEqual((out["clean"]["code"], out["clean"]["verdict"], out["faulty"]["code"],
                              out["faulty"]["text"]), (0, "clean", 6, ""))
            self.assertEqual((out["run"]["impacts_since_start"], out["compare"]["code"]), (1000, 6))
            self.assertIn("vessel", out["check"])
            self.assertEqual(out["error"][:2], [True, 2])
            self.assertIn("no option walks", out["type"])
        self.assertEqual([
            name
            for name in os.listdir(tempfile.gettempdir()) if re.fullmatch(r"edmill-\w{6}", name)
        ], [])

    def test_types_name_the_options(self):
        types = (FOLDER / "build/npm/package/index.d.ts").read_text()
        for name in ("gapTolerance?: number", "set?: string | string[]", "quiet?: boolean",
                     "function audit(file: string, log: string",
                     "function compare(a: string, b: string", "function run(file: string"):
            self.assertIn(name, types)

    def test_the_script_for_continuous_integration(self):
        settings = dict(os.environ, EDMILL_CASE="demo.toml", EDMILL_PACKAGE=str(self.tarball),
                        npm_config_offline="true")
        script = EXAMPLES / "ci/judge.sh"
        for log, extra, code in (("clean.csv", {}, 0), ("faulty.csv", {
                "GITHUB_ACTIONS": "true"
        }, 6), ("clean.csv", {"EDMILL_REFERENCE": "own", "EDMILL_COMPARE_OPTIONS": "--events 500"},
                0), ("faulty.csv", {"EDMILL_REFERENCE": "own"}, 6)):
            begin = time.monotonic()
            done = subprocess.run(["bash", script], env=settings | {"EDMILL_LOG": log} | extra,
                                  capture_output=True, text=True)
            print(f"judge.sh {log} {extra}: {time.monotonic() - begin:.1f} s")
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            self.assertEqual("::error file=faulty.csv" in done.stdout, "GITHUB_ACTIONS" in extra and
                             code == 6)
            ElementTree.parse("audit.xml")


if __name__ == "__main__":
    if not shutil.which("npm"):
        print("skipped: needs npm")
        sys.exit(77)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    unittest.main(argv=sys.argv[:1])
