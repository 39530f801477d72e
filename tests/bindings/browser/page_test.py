#!/usr/bin/env python3
"""The mill in a browser: the page is built by Emscripten, then used in headless Chromium as a
reader would: a run to 20 000 impacts has the published digest, impacts one by one, wrong cases, a
log with a mistake and one without, two widths, light and dark, no request, an empty console.
Debian: emscripten, node-acorn, chromium-driver, python3-selenium.

usage: PYTHONPATH=tests/support python3 page_test.py EDMILL FOLDER
FOLDER keeps the build, the page edmill.html and screenshots
"""
import base64
import gzip
import hashlib
import json
import math
import pathlib
import re
import shutil
import sys
import time
import unittest

from emscripten import build, published
from program import EXAMPLES, SOURCE, edmill, sets
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select

FOLDER = pathlib.Path(sys.argv[2]).resolve()


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        FOLDER.mkdir(parents=True, exist_ok=True)
        cls.page, _ = build(FOLDER)
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                     "--no-first-run", "--disable-background-networking",
                     f"--user-data-dir={FOLDER / 'profile'}"):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        cls.browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        cls.browser.set_script_timeout(120)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()

    def setUp(self):
        self.size(1200)
        self.browser.get(self.page.as_uri())
        self.wait(lambda: self.text("said") == "Running." and "impacts" in self.facts(), 60)
        self.element("stop").click()

    def tearDown(self):
        self.assertEqual([line["message"] for line in self.browser.get_log("browser")], [])

    def wait(self, condition, seconds):
        end = time.time() + seconds
        while not condition():
            self.assertLess(time.time(), end,
                            f"{self.text('said')} {self.text('problems')} {self.text('facts')}")
            time.sleep(0.05)

    def element(self, name):
        return self.browser.find_element("id", name)

    def text(self, name):
        return self.element(name).get_attribute("textContent")

    def facts(self):
        script = "return [...document.querySelectorAll('#facts dt')].map(dt => [dt.textContent, dt.nextElementSibling.textContent])"
        return dict(self.browser.execute_script(script))

    def fill(self, **values):
        for name, value in values.items():
            if name in ("case", "pace", "vessel-kind"):
                Select(self.element(name)).select_by_visible_text(value)
            else:
                self.element(name).clear()
                self.element(name).send_keys(str(value))

    def size(self, width, scheme="light"):
        self.browser.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.execute_cdp_cmd(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def keep(self, name):
        picture = self.browser.execute_cdp_cmd("Page.captureScreenshot",
                                               {"format": "png", "captureBeyondViewport": True})
        (FOLDER / name).write_bytes(base64.b64decode(picture["data"]))

    def test_the_file_is_small(self):
        content = self.page.read_bytes()
        print(f"{len(content) / 1e6:.2f} MB, {len(gzip.compress(content)) / 1e6:.2f} MB compressed")
        self.assertLess(len(content), 4e6)
        self.assertLess(len(gzip.compress(content)), 1.5e6)

    def test_a_mill_moves_by_itself(self):
        for width in (1200, 390):
            self.size(width)
            self.browser.get("about:blank")
            self.browser.get(self.page.as_uri())
            moved = "const done = arguments[0], look = () => frame && frame.time > 0 ? done(performance.now()) : setTimeout(look, 10); look()"
            print(
                f"{width} px: the mill moves after {self.browser.execute_async_script(moved):.0f} ms"
            )
            picture = self.element("mill").screenshot_as_png
            self.wait(lambda: self.element("mill").screenshot_as_png != picture, 10)
            place = {name: self.element(name).rect["y"] for name in ("mill", "choices")}
            self.assertLess(place["mill"], place["choices"])
            self.assertLess(place["mill"], 900)
            self.assertLessEqual(
                self.browser.execute_script("return document.documentElement.scrollWidth"), width)
            self.keep(f"begin-{width}.png")
        shown = {
            name: self.element(name).get_attribute("placeholder")
            for name in ("count", "diameter", "restitution", "friction", "speed")
        }
        self.assertEqual(
            shown, {
                "count": "28", "diameter": "4.76 mm", "restitution": "0.53", "friction": "0.4",
                "speed": "1054 rpm"
            })
        self.element("stop").click()

    def test_mills_that_are_sold(self):
        wanted = dict(jar="250ml", charge="15mm", fill="50%", powder="50 g", target="10 kJ/g")
        self.fill(case="Retsch PM 100 planetary ball mill", pace="as fast as it can", **wanted,
                  speed="300 rpm", most=2000)
        self.run_to_the_end()
        text = self.browser.execute_async_script(
            "const done = arguments[0]; ask({what: 'case'}).then(done)")["answer"]["case"]
        made = edmill("new", "--mill", "pm100", "--jar", "250ml", "--balls", "15mm", "--fill",
                      "50%", "--powder", "50 g", "--target-dose", "10 kJ/g", "--speed", "300 rpm",
                      code=0).stdout
        saved, own = FOLDER / "page.toml", FOLDER / "new.toml"
        saved.write_text(text)
        own.write_text(made)
        digest = lambda *words: re.search(r"digest +(\w+)",
                                          edmill("check", *words, code=0).stdout).group(1)
        self.assertEqual(
            digest(saved),
            digest(own, *sets("run.max_collisions=2000", 'output=[{type="collisions"}]')))
        self.assertEqual(self.element("restitution").get_attribute("placeholder"), "0.53")
        self.fill(charge="10x10mm:stele")
        self.element("run").click()
        self.wait(lambda: "stele" in self.text("problems"), 30)

    def test_results_in_the_words_of_a_miller(self):
        self.fill(case="SPEX 8000 Mixer/Mill", pace="as fast as it can", charge="10x10mm",
                  powder="4 g", target="10 kJ/g")
        self.run_to_the_end()
        facts = self.facts()
        self.assertRegex(facts["milling time"], r"^[\d.]+ ± [\d.]+ min$")
        self.assertRegex(facts["impact energy"],
                         r"^half of the impacts' dose below [\d.]+ mJ, 90 % below [\d.]+ mJ$")
        self.assertRegex(facts["impacts above 1 m/s"], r"^\d+ ± \d+ per second$")
        self.assertRegex(facts["mean impact speed"], r"^[\d.]+ m/s$")

    def test_a_run_has_the_published_bits_and_is_fast(self):
        case = FOLDER / "from_the_start.toml"
        case.write_text(
            re.sub(r'start_time = .*', 'start_time = "0 s"', (EXAMPLES / "demo.toml").read_text()))
        self.fill(pace="as fast as it can")
        self.element("open").send_keys(str(case))
        self.wait(
            lambda: self.text("said") == "The run has ended." or self.facts().get("impacts", "0") !=
            "0", 30)
        self.fill(most=20000)
        self.element("run").click()
        self.wait(lambda: self.text("said") == "The run has ended.", 60)
        facts = self.facts()
        self.assertEqual(facts["SHA-256 of collisions.csv"], published("demo"))
        self.assertEqual(facts["impacts"], "20000")

    def test_the_demo_runs_ten_times_as_fast_as_the_mill(self):
        self.fill(pace="as fast as it can")
        self.element("keep").click()
        begin = time.time()
        self.element("run").click()
        self.wait(lambda: self.text("said") == "The run has ended.", 120)
        spent = time.time() - begin
        self.assertNotIn("SHA-256 of collisions.csv", self.facts())
        edmill("run", EXAMPLES / "demo.toml", "--quiet", "--out", FOLDER / "demo", code=0)
        rate = re.search(r'"milling_dose_rate": ([\d.e+-]+)',
                         (FOLDER / "demo/summary.json").read_text()).group(1)
        print(f"10 s simulated in {spent:.2f} s")
        self.assertTrue(self.facts()["milling dose rate"].startswith(f"{float(rate):.4g}"),
                        self.facts())
        self.assertIn("±", self.facts()["milling dose rate"])
        for width in (1200, 390):
            for scheme in ("light", "dark"):
                self.size(width, scheme)
                self.keep(f"run-{width}-{scheme}.png")
                wide = self.browser.execute_script("return document.documentElement.scrollWidth")
                self.assertLessEqual(wide, width)

    def test_impacts_one_by_one_and_the_view_by_keyboard(self):
        self.element("run").click()
        self.wait(lambda: "impacts" in self.facts(), 30)
        self.element("step").click()
        time.sleep(0.5)
        before = int(self.facts()["impacts"])
        picture = self.element("mill").screenshot_as_png
        for _ in range(5):
            self.element("step").click()
            self.wait(lambda: int(self.facts()["impacts"]) > before, 10)
            after = int(self.facts()["impacts"])
            self.assertLessEqual(
                after, before +
                2)  # two within a thousandth of the mean time between them are shown together
            before = after
            self.assertIn("last impact", self.facts())
        self.assertNotEqual(self.element("mill").screenshot_as_png, picture)
        picture = self.element("mill").screenshot_as_png
        self.element("mill").send_keys(Keys.ARROW_LEFT)
        self.assertNotEqual(self.element("mill").screenshot_as_png, picture)

    def test_to_the_end_after_a_while(self):
        """The chart has a point for each small step, whatever pace the run had before."""
        self.element("run").click()
        self.wait(lambda: "impacts" in self.facts(), 30)
        time.sleep(3)
        before = self.browser.execute_script("return frame.time")
        self.element("end").click()
        self.wait(lambda: self.text("said") == "The run has ended.", 120)
        points, end, finite = self.browser.execute_script(
            "return [rates.length, frame.time, rates.flat().every(Number.isFinite)]")
        self.assertGreater(end, before)
        self.assertGreater(points, 20)
        self.assertTrue(finite)

    def run_to_the_end(self):
        self.browser.execute_script("$('said').textContent = ''")  # of an earlier run
        self.element("run").click()
        self.wait(lambda: self.text("said") == "The run has ended.", 60)

    def test_a_saved_case_is_the_run_of_the_page(self):
        for vessel in ("as in the case", "box", "sphere", "rounded cylinder"):
            for case in ("SPEX 8000, 28 balls", "shaken box"):
                with self.subTest(f"{case}, {vessel}"):
                    self.fill(case=case, pace="as fast as it can")
                    self.fill(**{"vessel-kind": vessel}, count=15, diameter=5, restitution=0.6,
                              friction=0.1, most=400)
                    if "SPEX" in case:
                        self.fill(speed=900)
                    self.run_to_the_end()
                    text = self.browser.execute_async_script(
                        "const done = arguments[0]; ask({what: 'case'}).then(done)"
                    )["answer"]["case"]
                    self.assertNotIn("# --set", text)
                    saved = FOLDER / "saved.toml"
                    saved.write_text(text)
                    edmill("run", saved, "--quiet", "--out", FOLDER / "saved", code=0)
                    content = (FOLDER / "saved/collisions.csv").read_bytes()
                    self.assertEqual(
                        hashlib.sha256(content).hexdigest(),
                        self.facts()["SHA-256 of collisions.csv"])
                    self.assertIn("count = 15", text)

    def test_saving_does_not_end_a_run(self):
        self.browser.execute_cdp_cmd("Browser.setDownloadBehavior",
                                     {"behavior": "allow", "downloadPath": str(FOLDER)})
        (FOLDER / "case.toml").unlink(missing_ok=True)
        self.element("run").click()
        self.wait(lambda: int(self.facts().get("impacts", 0)) > 0, 30)
        self.element("pause").click()
        self.element("save").click()
        self.wait(lambda: (FOLDER / "case.toml").exists(), 20)
        self.assertEqual(self.text("said"), "Paused.")
        before = int(self.facts()["impacts"])
        self.element("pause").click()
        self.wait(lambda: int(self.facts()["impacts"]) > before, 20)
        # A wrong value ends it, and nothing can go on.
        self.fill(restitution=1.5)
        self.element("run").click()
        self.wait(lambda: self.element("problems").is_displayed(), 20)
        self.assertFalse(
            any(
                self.element(name).is_enabled()
                for name in ("pause", "step", "end", "save", "stop")))
        self.fill(restitution=0.5)
        self.element("run").click()
        self.wait(lambda: self.text("said") == "Running.", 20)

    def test_files_in_the_wrong_place(self):
        log = FOLDER / "long.csv"
        for rows, said in ((40_000, "invalid TOML"), (200_000, "a case file (TOML) is shorter")):
            log.write_text("time,ball,partner_kind,partner\n" + "0.001,1,wall,0\n" * rows)
            for name in ("judged-case", "log"):
                self.element(name).send_keys(str(log))
            self.element("audit").click()
            self.wait(lambda: self.text("verdict").startswith("No verdict"), 30)
            self.assertIn(said, self.text("verdict") + self.text("table"))
            self.element("open").send_keys(str(log))
            self.wait(lambda: said in self.text("problems"), 30)
        self.fill(case="SPEX 8000, 28 balls", most=100, pace="as fast as it can")
        self.run_to_the_end()
        wide = FOLDER / "wide.toml"
        for key in ('precision = "float128"', "digits = 12"):
            wide.write_text((EXAMPLES / "demo.toml").read_text().replace("[run]", f"[run]\n{key}"))
            self.element("open").send_keys(str(wide))
            self.wait(lambda: "expected a run in double" in self.text("problems"), 30)
            self.browser.execute_script("problems([])")

    def test_no_impact_comes(self):
        lone = FOLDER / "lone.toml"
        lone.write_text(
            '[run]\nmax_collisions = 5\n[mill]\ntype = "still"\n[vessel]\ntype = "sphere"\ndiameter = "50 mm"\n[contact]\nrestitution = 0.5\n'
            'friction = 0.1\n[[ball]]\ndiameter = "5 mm"\nposition = [0, 0, 0]\n')
        lone.write_text(lone.read_text().replace("[run]", '[run]\ngravity = "0 m/s2"'))
        self.element("open").send_keys(str(lone))
        self.wait(lambda: self.text("said") == "Running.", 30)
        self.element("step").click()
        self.wait(lambda: self.text("said") == "No impact in the next hundred drive periods.", 30)
        self.fill(case="SPEX 8000, 28 balls", most=100, pace="as fast as it can")
        self.run_to_the_end()

    def test_what_takes_long_can_be_stopped(self):
        self.fill(count=100_000, diameter=0.1)
        self.element("run").click()
        self.wait(lambda: "too many" in self.text("problems"), 10)
        self.fill(count=820, diameter=4.76)
        self.element("run").click()
        self.wait(lambda: self.text("said") == "Placing the balls.", 10)
        self.element("stop").click()
        self.assertEqual(self.text("said"), "Stopped.")
        self.fill(count="", diameter="", most=100, pace="as fast as it can")
        self.run_to_the_end()
        # The mill goes on while a log is judged.
        case = EXAMPLES / "demo.toml"
        edmill(
            "run", case, "--quiet", "--out", FOLDER / "long",
            *sets("run.max_collisions=3000", "contact.restitution=0.6", "contact.friction=0.3",
                  'output=[{type="collisions",states=true}]'), code=0)
        self.element("judged-case").send_keys(str(case))
        self.element("log").send_keys(str(FOLDER / "long/collisions.csv"))
        self.element("identify").click()
        self.element("audit").click()
        self.wait(lambda: "Searching" in self.text("verdict"), 60)
        self.fill(most="", pace="ten times slower")
        self.element("run").click()
        self.wait(lambda: int(self.facts().get("impacts", 0)) > 200, 30)
        self.element("judge-stop").click()
        self.wait(lambda: self.text("verdict") == "No verdict:", 10)

    def test_laws_by_materials_are_not_overridden(self):
        self.fill(case="steel and alumina, with a piston")
        self.assertFalse(
            self.element("restitution").is_enabled() or self.element("friction").is_enabled())
        self.fill(case="shaken box")
        self.assertTrue(
            self.element("restitution").is_enabled() and self.element("friction").is_enabled())

    def test_each_case_runs_with_other_balls(self):
        for case in ("planetary mill", "shaken box", "steel and alumina, with a piston",
                     "stirred tank"):
            with self.subTest(case):
                self.fill(case=case, most=300, pace="as fast as it can")
                self.element("run").click()
                self.wait(lambda: self.text("said") == "The run has ended.", 60)
                self.assertEqual(self.facts()["impacts"], "300")
        # The shaft and the arms of the tank are in the picture, in their own colour, and turn.
        drawn = """const {data} = view.canvas.getContext('2d').getImageData(0, 0, view.canvas.width, view.canvas.height);
            const grey = data.filter((part, k) => k % 4 === 0 && [0, 1, 2].every(c => data[k + c] === 128)).length;
            return [Object.keys(scene.bodies).length, frame.bodies[1][1], grey]"""
        count, axis, grey = self.browser.execute_script(drawn)
        self.assertEqual(count, 5)
        self.assertGreater(grey, 1000)
        self.fill(most=600)
        self.run_to_the_end()
        self.assertNotEqual(self.browser.execute_script("return frame.bodies[1][1]"), axis)

    def test_wrong_wishes_are_told(self):
        for values, words in (({"restitution": "1.5"}, "contact.restitution"),
                              ({"count": "1000000"}, ""), ({"diameter": "12,7"}, "balls")):
            with self.subTest(values):
                self.fill(count="", restitution="", diameter="")
                self.fill(**values)
                self.element("run").click()
                self.wait(lambda: self.element("problems").is_displayed(), 30)
                self.assertIn(words, self.text("problems"))

    def test_a_log_with_a_mistake_is_told_from_a_right_one(self):
        case = EXAMPLES / "demo.toml"
        edmill("run", case, "--quiet", "--out", FOLDER / "log",
               *sets("run.max_collisions=1500", 'output=[{type="collisions",states=true}]'), code=0)
        right = FOLDER / "log/collisions.csv"
        wrong = FOLDER / "wrong.toml"
        wrong.write_text(case.read_text().replace("restitution = 0.53", "restitution = 0.6"))
        self.assertNotEqual(wrong.read_text(), case.read_text())
        for name, verdict in ((case, "Verdict: clean"), (wrong, "Verdict: violations")):
            self.element("judged-case").send_keys(str(name))
            self.element("log").send_keys(str(right))
            self.element("audit").click()
            self.wait(lambda: self.text("verdict").startswith(("Verdict", "No")), 60)
            self.assertEqual(self.text("verdict"), verdict, self.text("table"))
        self.assertIn("normal_restitution", self.text("table"))
        cause = r"contact\.restitution = 0\.53\d* ± [0-9.e-]+ in place of 0\.6"
        self.assertRegex(self.text("table"), cause)
        self.element("identify").click()
        self.element("audit").click()
        self.wait(lambda: not self.text("verdict").startswith("Verdict"), 30)
        self.wait(lambda: self.text("verdict").startswith("Verdict"), 300)
        self.assertRegex(self.text("table"), cause)
        self.element("reference").send_keys(str(right))
        self.element("compare").click()
        self.wait(
            lambda: self.text("verdict") != "Verdict: violations" and self.text("verdict") !=
            "Reading.", 60)
        self.assertIn("Verdict: ", self.text("verdict"))

    def test_the_five_steps(self):
        for _ in range(40):
            self.element("gap-step").click()
        low, high = map(
            float,
            re.search(r"between ([\d.]+) and ([\d.]+) s", self.text("gap-said")).groups())
        table = lambda t: 0.55 - 9.81 / 9 * t * t / 2 - 0.12 * math.sin(2 * math.pi * 1.4 * t)
        self.assertLess(high - low, 1e-6)
        self.assertGreaterEqual(table(low - 1e-9), 0)
        self.assertLessEqual(table(high + 1e-9), 0)
        self.assertGreater(min(table(low * k / 1000) for k in range(1000)),
                           0)  # nothing was missed before
        self.assertIn("e_t = -0.607", self.text("law-said"))  # (2.24'): 1 - 0.4 3.5 1.5 1.53 / 2
        self.element("diverge").click()
        self.wait(lambda: "bodies meet" in self.text("divergence-said"), 30)
        common = int(re.search(r"meet (\d+) times", self.text("divergence-said")).group(1))
        self.assertTrue(200 < common < 2000, common)
        self.element("prove").click()
        self.wait(lambda: "are those" in self.text("prove-said"), 30)
        self.assertIn("200 of 200 impacts", self.text("prove-said"))

    def test_certificates_are_checked(self):
        shipped = SOURCE / "src/bindings/browser/three_balls.certificate"
        told = edmill("check", SOURCE / "regression/reference/three_balls.toml", code=0)
        self.assertIn(json.loads(shipped.read_text().splitlines()[0])["digest"], told.stdout)
        checked = lambda: self.wait(lambda: self.text("certificate-said") not in
                                    ("", "Checking."), 60) or self.text("certificate-said")
        self.element("certificate").click()
        self.assertRegex(checked(), r"^accepted: 40 events of 3 balls in 224 bits \([\d.]+ s\)$")
        self.element("forged").click()
        self.wait(lambda: "accepted" not in self.text("certificate-said"), 60)
        self.assertRegex(checked(), r"^rejected: event \d+: rule \d: ")
        for name, text, said in (("good", shipped.read_text(), "accepted: 40 events"),
                                 ("cut", shipped.read_text()[:20000], "No certificate|rejected"),
                                 ("other", "time,ball\n", "No certificate: ")):
            own = FOLDER / name
            own.write_text(text)
            self.browser.execute_script(
                "document.getElementById('certificate-said').textContent = ''")
            self.element("own-certificate").send_keys(str(own))
            self.assertRegex(checked(), said)

    def test_it_asks_no_server(self):
        self.element("run").click()
        self.wait(lambda: "impacts" in self.facts(), 30)
        asked = [
            json.loads(line["message"])["message"] for line in self.browser.get_log("performance")
        ]
        asked = [
            line["params"]["request"]["url"] for line in asked
            if line["method"] == "Network.requestWillBeSent"
        ]
        self.assertEqual([
            url[:80] for url in asked if not url.startswith(("file:", "blob:", "data:", "chrome:"))
        ], [])


if __name__ == "__main__":
    if not shutil.which("em++"):
        print("Emscripten is absent")
        sys.exit(77)
    sys.argv[1:] = sys.argv[3:]
    unittest.main()
