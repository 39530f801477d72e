#!/usr/bin/env python3
"""A report in headless Chromium: no message on the console, no request, axes with units, a scene that moves, a phone's width,
dark colours. Debian: chromium, chromium-driver, python3-selenium.

usage: report_browser_test.py EDMILL [FOLDER]    FOLDER keeps the run and the screenshots
"""
import base64
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

ROOT = pathlib.Path(__file__).resolve().parents[2]
FLAGS = ("--headless --no-sandbox --disable-gpu --use-angle=swiftshader --enable-unsafe-swiftshader --disable-quic --no-first-run "
         "--disable-background-networking --disable-component-update --disable-sync --hide-scrollbars").split()
EDMILL, FOLDER = sys.argv[1], None


def browser(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for flag in (*FLAGS, f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(FOLDER or cls.temporary.name)
        cls.folder.mkdir(parents=True, exist_ok=True)
        subprocess.run([EDMILL, "run", ROOT / "docs/examples/demo.toml", "--report", "--quiet", "--out", cls.folder / "run",
                        "--set", "run.end_time=3 s"], check=True)
        cls.browser = browser(cls.folder / "profile")
        cls.browser.set_script_timeout(120)
        cls.size(1280, 900)
        cls.browser.get_log("performance")  # what the browser does before
        cls.browser.get((cls.folder / "run/report.html").as_uri())
        cls.wait_for_scene()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.temporary.cleanup()

    @classmethod
    def script(cls, text, *arguments):
        return cls.browser.execute_script(text, *arguments)

    @classmethod
    def size(cls, width, height):
        cls.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})

    @classmethod
    def wait_for_scene(cls):
        for _ in range(600):
            if cls.script("return !!document.querySelector('x3d canvas') && !!document.querySelector('x3d').runtime"):
                break
            time.sleep(0.1)
        time.sleep(1)

    def media(self, scheme="light", kind="screen"):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": kind, "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def keep(self, name):
        """A picture of the whole page."""
        picture = self.browser.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True})
        (self.folder / name).write_bytes(base64.b64decode(picture["data"]))

    def scene_picture(self):
        return self.browser.find_element("css selector", ".stage").screenshot_as_png

    def test_1_the_console_is_silent(self):
        # The driver warns about rendering without a graphics card.
        ours = [entry for entry in self.browser.get_log("browser")
                if entry["level"] in ("WARNING", "SEVERE") and "GL Driver Message" not in entry["message"]]
        self.assertEqual(ours, [])

    def test_1_nothing_is_fetched(self):
        requests = []  # the browser's own pages have the scheme chrome:
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                requests.append(message["params"]["request"]["url"])
        self.assertTrue(any(url.startswith("file:") for url in requests), "the log must hold the page itself")
        self.assertEqual([url for url in requests if not url.startswith(("file:", "data:", "blob:", "chrome:"))], [])
        self.assertEqual(len([url for url in requests if url.startswith("file:")]), 1)

    def test_2_charts_have_axes_with_units(self):
        charts = self.script("""
            return [...document.querySelectorAll('figure.chart:not(.heat)')].map(f => ({
                id: f.id, titles: [...f.querySelectorAll('.axis-title')].map(t => t.textContent),
                x: f.querySelectorAll('.x-axis .label').length, y: f.querySelectorAll('.y-axis .label').length,
                curves: [...f.querySelectorAll('.curve')].map(c => c.getTotalLength()),
                named: !!f.querySelector('svg > title') && !!f.querySelector('svg > desc')}))""")
        self.assertEqual({chart["id"] for chart in charts},
                         {"dose-rate", "collision-rates", "approach-speeds", "slip-speeds", "energy-spectrum", "energy-parts",
                          "ball-speeds-over-time", "ball-speeds"})
        for chart in charts:
            with self.subTest(chart["id"]):
                self.assertEqual(len(chart["titles"]), 2)
                for title in chart["titles"]:
                    self.assertRegex(title, r"\[.+\]$")
                self.assertGreaterEqual(chart["x"], 2)
                self.assertGreaterEqual(chart["y"], 2)
                self.assertTrue(chart["named"])
                for length in chart["curves"]:
                    self.assertGreater(length, 50)

    def test_2_maps_have_a_scale_with_a_unit(self):
        maps = self.script("""
            return [...document.querySelectorAll('figure.heat')].map(f => ({id: f.id, text: f.textContent,
                colours: new Set([...f.querySelectorAll('.cells path')].map(p => p.getAttribute('fill'))).size}))""")
        self.assertEqual([m["id"] for m in maps], ["cylinder", "cap-0", "cap-1"])
        for m in maps:
            self.assertIn("[kW/m²]", m["text"])
            self.assertGreater(m["colours"], 10)

    def test_2_the_headline_has_intervals(self):
        intervals = self.script("return [...document.querySelectorAll('.card .interval')].map(e => e.textContent)")
        self.assertEqual(len(intervals), 5)
        for text in intervals:
            self.assertTrue(re.match(r"± [0-9.\u202f×⁻⁰¹²³⁴⁵⁶⁷⁸⁹ ]+ [A-Za-z/1]+$", text), text)

    def test_3_the_scene_renders_and_moves(self):
        # In its own picture, without the page around it.
        drawn = self.script("""
            const picture = document.querySelector('x3d').runtime.getScreenshot();
            return new Promise((done, failed) => {
              const image = new Image();
              image.onerror = failed;
              image.onload = () => {
                const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
                canvas.width = image.width; canvas.height = image.height;
                context.drawImage(image, 0, 0);
                const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
                let blue = 0;
                for (let k = 0; k < data.length; k += 4) blue += data[k + 3] > 0 && data[k + 2] > data[k] + 40;
                done(blue / (data.length / 4));
              };
              image.src = picture;
            });""")
        self.assertGreater(drawn, 0.01, "blue balls")
        first = self.scene_picture()
        time.sleep(3)
        self.assertNotEqual(first, self.scene_picture())

    def test_4_pause_stops_the_scene(self):
        self.script("document.getElementById('play').click()")
        time.sleep(0.7)
        first = self.scene_picture()
        time.sleep(0.7)
        self.assertEqual(first, self.scene_picture())
        self.script("document.getElementById('play').click()")

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
            return [...document.querySelectorAll('svg .label')].map(t => t.getBoundingClientRect().height).filter(h => h < 9)""")
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

    def test_6_paper_shows_the_still_picture(self):
        self.media(kind="print")
        shown = self.script("""
            return ['.still', 'x3d', '#play'].map(s => getComputedStyle(document.querySelector(s)).display !== 'none')""")
        pdf = self.browser.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "paperWidth": 8.27, "paperHeight": 11.69})
        self.media()
        self.assertEqual(shown, [True, False, False])
        (self.folder / "report.pdf").write_bytes(base64.b64decode(pdf["data"]))


if __name__ == "__main__":
    if len(sys.argv) > 2:
        FOLDER = sys.argv[2]
    unittest.main(argv=sys.argv[:1], verbosity=2)
