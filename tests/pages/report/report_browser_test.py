#!/usr/bin/env python3
"""A report in headless Chromium: no message on the console, no request, axes with units, a scene
that moves, a phone's width, dark colours; reports of every motion and vessel; and how fast a report
of 908 balls opens. Debian: chromium, chromium-driver, python3-selenium.

usage: PYTHONPATH=tests/support python3 report_browser_test.py EDMILL [FOLDER] [--long]
FOLDER keeps the runs and the screenshots; with --long only the reports of all mills and of
docs/examples
"""
import base64
import json
import pathlib
import re
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

from mills import MILLS, SOME, WITHOUT_DOSE
from page_checks import BAD_LABELS, FARTHEST
from program import EXAMPLES, edmill, sets
from report_in_browser import OpenReport, browser, discs, is_installed
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

FOLDER = None
# Whether the canvas has painted pixels, and how many are on its rim.
PAINTED_RIM = '''
    const canvas = document.querySelector('.stage canvas'), {width, height} = canvas;
    const {data} = canvas.getContext('2d').getImageData(0, 0, width, height);
    let all = false, rim = 0;
    for (let y = 0; y < height; ++y)
      for (let x = 0; x < width; ++x)
        if (data[4 * (y * width + x) + 3]) {
          all = true;
          rim += x == 0 || y == 0 || x == width - 1 || y == height - 1;
        }
    return [all, rim];'''


def run(folder, *settings):
    """The page of the demo with other settings."""
    edmill("run", EXAMPLES / "demo.toml", "--report", "--quiet", "--out", folder, *sets(*settings),
           code=0)
    return (folder / "report.html").as_uri()


class Report(OpenReport):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(FOLDER or cls.temporary.name)
        cls.folder.mkdir(parents=True, exist_ok=True)
        page = run(cls.folder / "run", "run.end_time=3 s")
        cls.browser = browser(cls.folder / "profile")
        cls.browser.set_script_timeout(120)
        cls.size(1280, 900)
        cls.browser.get_log("performance")  # what the browser does before
        cls.browser.get(page)

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.temporary.cleanup()

    def assert_silent(self):
        # The driver warns about rendering without a graphics card.
        ours = [
            entry for entry in self.browser.get_log("browser")
            if entry["level"] in ("WARNING",
                                  "SEVERE") and "GL Driver Message" not in entry["message"]
        ]
        self.assertEqual(ours, [])

    def assert_good_page(self, page, name):
        """Of any page: the console, its numbers, its labels at two widths."""
        self.browser.get_log("browser")  # of the page before
        # Paused: to draw without a graphics card takes most of the time.
        self.browser.execute_cdp_cmd(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-reduced-motion", "value": "reduce"}]})
        self.browser.get((self.folder / page).as_uri())
        self.assert_silent()
        text = self.script("return document.querySelector('main').outerHTML")
        self.assertEqual(
            re.findall(r"[^\w](?:nan|inf|infinity|undefined|null)[^\w]", text, re.IGNORECASE), [])
        for width in (1200, 390):
            self.size(width, 900)
            time.sleep(0.2)
            if FOLDER:
                self.keep(f"{name}-{width}.png")
            self.assertEqual(self.script(BAD_LABELS), [], f"at {width} px")
            self.assertEqual(self.script("return document.documentElement.scrollWidth"), width)
        links = self.script(
            "return [...document.querySelectorAll('.contents a')].map(a => !!document.getElementById(a.hash.slice(1)))"
        )
        self.assertTrue(links and all(links), links)

    def assert_good(self, name):
        """The report of a run, and where its scene is."""
        self.assert_good_page(f"{name}/report.html", name)
        farthest = self.script(FARTHEST)
        self.assertLess(farthest, 1, "all balls are in the picture at all times")
        self.assertGreater(farthest, 0.9, "and what they are in fills it")
        for share in (0, 0.2, 0.4, 0.6, 0.8):
            self.script('''
                const slider = document.getElementById('time');
                slider.value = arguments[0] * slider.max;
                slider.dispatchEvent(new Event('input'));''', share)
            time.sleep(0.15)
            self.assertEqual(self.script(PAINTED_RIM), [True, 0],
                             f"{name}: the jar is in the picture as it is drawn, at {share}")
        if name not in WITHOUT_DOSE:
            high = "return Math.max(...[...document.querySelectorAll('#energy-spectrum .curve')].map(c => c.getBBox().height))"
            self.assertGreater(self.script(high), 100,
                               "the spectrum shows the energies of this mill")
        self.assertIn("gravity", self.script("return document.getElementById('case').textContent"))

    def test_1_the_console_is_silent(self):
        self.assert_silent()

    def test_1_nothing_is_fetched(self):
        requests = []  # the browser's own pages have the scheme chrome:
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                requests.append(message["params"]["request"]["url"])
        self.assertTrue(any(url.startswith("file:") for url in requests),
                        "the log must hold the page itself")
        self.assertEqual(
            [url for url in requests if not url.startswith(("file:", "data:", "blob:", "chrome:"))],
            [])
        self.assertEqual(len([url for url in requests if url.startswith("file:")]), 1)

    def test_2_charts_have_axes_with_units(self):
        charts = self.script("""
            return [...document.querySelectorAll('figure.chart:not(.heat)')].map(f => ({
                id: f.id, titles: [...f.querySelectorAll('.axis-title')].map(t => t.textContent),
                x: f.querySelectorAll('.x-axis .label').length, y: f.querySelectorAll('.y-axis .label').length,
                curves: [...f.querySelectorAll('.curve')].map(c => c.getTotalLength()),
                named: !!f.querySelector('svg > title') && !!f.querySelector('svg > desc')}))""")
        self.assertEqual({chart["id"] for chart in charts}, {
            "dose-rate", "collision-rates", "approach-speeds", "slip-speeds", "energy-spectrum",
            "energy-parts", "ball-speeds-over-time", "ball-speeds", "dose-by-ball"
        })
        for chart in charts:
            with self.subTest(chart["id"]):
                self.assertEqual(len(chart["titles"]), 2)
                for title in chart["titles"]:
                    self.assertRegex(title, r"\[.+\]$|^number of the ball$")
                self.assertGreaterEqual(chart["x"], 2)
                self.assertGreaterEqual(chart["y"], 2)
                self.assertTrue(chart["named"])
                for length in chart["curves"]:
                    self.assertGreater(length, 50)

    def test_2_maps_have_a_scale_with_a_unit(self):
        maps = self.script("""
            return [...document.querySelectorAll('figure.heat')].map(f => ({id: f.id, text: f.textContent,
                colours: new Set([...f.querySelectorAll('.cells path')].map(p => p.getAttribute('fill'))).size}))"""
                          )
        self.assertEqual([m["id"] for m in maps], ["cylinder", "cap-0", "cap-1"])
        for m in maps:
            self.assertIn("[kW/m²]", m["text"])
            self.assertGreater(m["colours"], 10)

    def test_2_the_headline_has_intervals(self):
        intervals = self.script(
            "return [...document.querySelectorAll('.card .interval')].map(e => e.textContent)")
        self.assertEqual(len(intervals), 3)  # two dose rates, and impacts above 1 m/s
        for text in intervals:
            self.assertTrue(re.match(r"± [0-9.\u202f×⁻⁰¹²³⁴⁵⁶⁷⁸⁹ ]+ [A-Za-z/1]+$", text), text)

    def test_3_the_scene_moves(self):
        self.play(True)
        first, begin = self.scene_picture(), self.script(
            "return document.getElementById('time').valueAsNumber")
        time.sleep(1)
        self.assertNotEqual(first, self.scene_picture())
        self.assertNotEqual(begin,
                            self.script("return document.getElementById('time').valueAsNumber"))

    def test_3_balls_are_where_the_animation_has_them(self):
        size = self.canvas().size
        for fraction in (0, 0.31, 0.77, 1):
            with self.subTest(fraction):
                self.show(fraction)
                here = discs(self.folder / "run/report/animation.x3d", fraction, size["width"],
                             size["height"])
                self.assertEqual(len(here), 28)
                both, inside, balls = self.ball_pixels(here)
                self.assertGreater(inside, 3000)
                self.assertGreater(both, 0.96 * inside)
                self.assertGreater(both, 0.98 * balls)
                # 1 % of the playback away, 1.1 ms, they are elsewhere.
                near = abs(fraction - 0.01)
                both, inside, balls = self.ball_pixels(
                    discs(self.folder / "run/report/animation.x3d", near, size["width"],
                          size["height"]))
                self.assertLess(both, 0.7 * inside)

    def test_4_pause_stops_the_scene_and_its_drawing(self):
        self.play(True)
        time.sleep(0.3)
        self.play(False)
        self.script("""
            window.asked = 0;
            const ask = window.requestAnimationFrame;
            window.requestAnimationFrame = (f) => { ++window.asked; return ask(f); };""")
        time.sleep(0.7)
        first = self.scene_picture()
        time.sleep(0.7)
        self.assertEqual(first, self.scene_picture())
        self.assertEqual(self.script("return window.asked"), 0)
        self.play(True)
        time.sleep(0.7)
        self.assertGreater(self.script("return window.asked"), 2)

    def test_4_the_mouse_turns_and_enlarges_the_paused_scene(self):
        self.show(0.5)
        first = self.scene_picture()
        ActionChains(self.browser).drag_and_drop_by_offset(self.canvas(), 80, 30).perform()
        time.sleep(0.3)
        turned = self.scene_picture()
        self.assertNotEqual(first, turned)
        before = self.ball_pixels([])[2]
        self.script("""
            const canvas = document.querySelector('.stage canvas');
            canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -100, cancelable: true}));""")
        time.sleep(0.3)
        self.assertGreater(self.ball_pixels([])[2], 1.05 * before)

    def test_4_controls_have_names_and_take_the_keyboard(self):
        self.show(0.5)
        names = self.script("""
            return ['play', 'time'].map(id => document.getElementById(id)).map(e => [e.tabIndex, e.computedName ??
                e.getAttribute('aria-label') ?? e.textContent, e.getAttribute('aria-valuetext')])"""
                           )
        self.assertEqual(
            names, [[0, "Play", None], [0, "Time from the beginning of the animation", "56.9 ms"]])
        slider = self.browser.find_element("id", "time")
        slider.send_keys(Keys.ARROW_RIGHT)
        time.sleep(0.3)
        self.assertEqual(self.script("return document.getElementById('clock').textContent"),
                         "58.1 ms")

    def test_5_tables_fit_a_desktop(self):
        wide = "return [...document.querySelectorAll('.table')].filter(t => t.scrollWidth > t.clientWidth).map(t => t.textContent)"
        self.assertEqual(self.script(wide), [])

    def test_5_a_phone_shows_it_without_scrolling_sideways(self):
        self.keep("desktop.png")
        self.size(390, 844)
        time.sleep(0.5)
        self.keep("phone.png")
        self.assertEqual(self.script("return document.documentElement.scrollWidth"), 390)
        small = self.script("""
            return [...document.querySelectorAll('svg .label')].map(t => t.getBoundingClientRect().height).filter(h => h < 9)"""
                           )
        self.assertEqual(small, [], "labels of charts stay readable")
        self.size(1280, 900)

    def test_5_dark_mode_has_dark_colours(self):
        colours = "return ['background-color', 'color'].map(p => getComputedStyle(document.body).getPropertyValue(p))"
        curve = "return getComputedStyle(document.querySelector('.curve')).stroke"
        self.media("light")
        light, light_curve = self.script(colours), self.script(curve)
        self.media("dark")
        dark, dark_curve = self.script(colours), self.script(curve)
        time.sleep(0.3)
        self.keep("dark.png")
        self.media("light")
        brightness = [sum(map(int, re.findall(r"\d+", colour)[:3])) for colour in (*light, *dark)]
        self.assertGreater(brightness[0], 700)
        self.assertLess(brightness[1], 150)
        self.assertLess(brightness[2], 150)
        self.assertGreater(brightness[3], 600)
        self.assertNotEqual(light_curve, dark_curve)

    def test_6_paper_shows_the_mill_without_its_controls(self):
        self.media(kind="print")
        shown = self.shown(".stage canvas", "#player")
        pdf = self.browser.execute_cdp_cmd(
            "Page.printToPDF", {"printBackground": True, "paperWidth": 8.27, "paperHeight": 11.69})
        self.media()
        self.assertEqual(shown, [True, False])
        (self.folder / "report.pdf").write_bytes(base64.b64decode(pdf["data"]))

    def test_7_a_report_of_908_balls_opens(self):
        page = run(self.folder / "run-908", "balls.0.count=908", "balls.0.diameter=2.36 mm",
                   "balls.0.gap_ball=0.2 mm", "contact.restitution=0.8", "run.start_time=0.1 s",
                   "run.end_time=0.2 s")
        begin = time.monotonic()
        self.browser.get(page)
        self.scene_picture()
        seconds = time.monotonic() - begin  # a figure for docs/report.md, not a bound
        print(f"{seconds:.2f} s", end=" ", flush=True)
        size = self.canvas().size
        self.show(0.5)
        both, inside, balls = self.ball_pixels(
            discs(self.folder / "run-908/report/animation.x3d", 0.5, size["width"], size["height"]))
        self.assertGreater(both, 0.9 * inside)
        self.assertGreater(both, 0.9 * balls)

    def assert_good_runs(self, cases):
        for case in cases:
            with self.subTest(case.name):
                edmill("run", case, "--report", "--quiet", "--out", self.folder / case.stem, code=0)
                self.assert_good(case.stem)

    def mills(self, names):
        for name in names:
            case = self.folder / f"{name}.toml"
            case.write_text(MILLS[name])
            yield case

    def test_9_pages_of_several_runs_are_good(self):
        for balls in (7, 14):
            run(self.folder / f"of-{balls}", "run.end_time=2 s", f"balls.0.count={balls}",
                'powder.target_dose="10 kJ/g"')
        edmill("report", "--quiet", "--out", self.folder / "compared.html",
               *(self.folder / f"of-{n}" for n in (7, 14)), code=0)
        (self.folder / "speeds.sweep.toml").write_text(f'''[sweep]
case = "{EXAMPLES / "demo.toml"}"
replicas = 2
[sweep.grid]
"mill.speed" = ["900 rpm", "1100 rpm"]
"run.end_time" = ["1.5 s"]
''')
        edmill("sweep", self.folder / "speeds.sweep.toml", "--quiet", "--out",
               self.folder / "speeds", code=0)
        for page in ("compared.html", "speeds/sweep.html"):
            with self.subTest(page):
                self.assert_good_page(page, page.replace("/", "-"))

    def test_7_figures_are_saved_as_files(self):
        """What the buttons of a figure make, caught on its way to the disk."""
        self.browser.get((self.folder / "run/report.html").as_uri())
        made = self.browser.execute_async_script("""
            const done = arguments[0], made = {};
            const figure = document.getElementById('dose-rate'), buttons = [...figure.querySelectorAll('.files button')];
            HTMLAnchorElement.prototype.click = function () {
              const name = this.download;
              fetchBlob(this.href).then(text => { made[name] = text; if (Object.keys(made).length === buttons.length) done(made); });
            };
            const blobs = new Map(), create = URL.createObjectURL;
            URL.createObjectURL = (blob) => { const url = create.call(URL, blob); blobs.set(url, blob); return url; };
            const fetchBlob = async (url) => [blobs.get(url).type, (await blobs.get(url).text()).slice(0, 400000)];
            for (const button of buttons) button.click();""")
        self.assertEqual(set(made), {"dose-rate.svg", "dose-rate.png", "dose-rate.csv"})
        self.assertEqual(made["dose-rate.png"][0], "image/png")
        svg = ElementTree.fromstring(made["dose-rate.svg"][1])
        strokes = {node.get("style") for node in svg.iter() if "curve" in (node.get("class") or "")}
        self.assertTrue(strokes and all("stroke: rgb" in style for style in strokes), strokes)
        rows = made["dose-rate.csv"][1].splitlines()
        self.assertEqual(rows[0], "curve,x,y")
        self.assertGreater(len(rows), 20)

    def test_7_units_are_the_readers_choice(self):
        self.browser.get((self.folder / "run/report.html").as_uri())
        before, after, unit = self.script("""
            const card = document.querySelector('.card [data-unit=W]'), select = document.querySelector('.units select');
            const number = () => Number(card.querySelector('strong').textContent);
            const before = number();
            select.value = 'J/min';
            select.dispatchEvent(new Event('change'));
            return [before, number(), card.querySelector('.unit').textContent];""")
        self.assertAlmostEqual(after / before / 60, 1, 3)
        self.assertEqual(unit.strip(), "J/min")

    def test_9_reports_of_other_mills_are_good(self):
        self.assert_good_runs(self.mills(SOME))

    def test_9_reports_of_all_mills_are_good_long(self):
        self.assert_good_runs(self.mills(MILLS))

    def test_9_reports_of_the_examples_are_good_long(self):
        self.assert_good_runs(case for case in sorted(EXAMPLES.glob("*.toml"))
                              if ".sweep" not in case.name and ".optimize" not in case.name)


if __name__ == "__main__":
    if not is_installed():
        print("skipped: needs chromium and chromium-driver")
        sys.exit(77)
    long = "--long" in sys.argv
    if len(sys.argv) > 2 + long:
        FOLDER = sys.argv[2]
    names = [
        name for name in unittest.TestLoader().getTestCaseNames(Report)
        if name.endswith("_long") == long
    ]
    unittest.main(argv=[sys.argv[0], *(f"Report.{name}" for name in names)], verbosity=2)
