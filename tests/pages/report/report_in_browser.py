"""A report open in headless Chromium: its window, its pictures, and the balls in them."""
import base64
import bisect
import math
import pathlib
import time
import unittest
import xml.etree.ElementTree as ElementTree

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

FLAGS = (
    "--headless --no-sandbox --disable-gpu --use-angle=swiftshader --enable-unsafe-swiftshader --disable-quic --no-first-run "
    "--disable-background-networking --disable-component-update --disable-sync --hide-scrollbars"
).split()
CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"


def is_installed():
    return pathlib.Path(CHROMIUM).exists() and pathlib.Path(DRIVER).exists()


def browser(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in (*FLAGS, f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


def floats(text):
    return [float(word) for word in text.split()]


def discs(animation, fraction, width, height):
    """Circles (x, y, radius) in pixels where the balls of an X3D animation are seen at a fraction
    of its playback."""
    scene = ElementTree.parse(animation).getroot().find("Scene")
    paths = {node.get("DEF"): node for node in scene.iter("PositionInterpolator")}
    eye = floats(scene.find("Viewpoint").get("position"))  # looks along -Z
    pixels = height / 2 / math.tan(0.3)  # the field of view is 0.6 rad
    seen = []
    for ball in scene.findall("Transform"):
        path, sphere = paths.get(f"{ball.get('DEF')}_path"), ball.find("Shape/Sphere")
        if path is None or sphere is None:
            continue
        keys, values = floats(path.get("key")), floats(path.get("keyValue"))
        k = min(max(bisect.bisect_right(keys, fraction), 1), len(keys) - 1)
        share = (fraction - keys[k - 1]) / (keys[k] - keys[k - 1])
        x, y, z = (values[3 * k - 3 + c] + share * (values[3 * k + c] - values[3 * k - 3 + c]) -
                   eye[c] for c in range(3))
        radius = float(sphere.get("radius"))
        seen.append([width / 2 - pixels * x / z, height / 2 + pixels * y / z, -pixels * radius / z])
    return seen


class OpenReport(unittest.TestCase):
    """What the tests of a page use; `browser` and `folder` are the test's."""

    @classmethod
    def script(cls, text, *arguments):
        return cls.browser.execute_script(text, *arguments)

    @classmethod
    def size(cls, width, height):
        cls.browser.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})

    def media(self, scheme="light", kind="screen"):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "media": kind, "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def keep(self, name):
        """A picture of the whole page."""
        picture = self.browser.execute_cdp_cmd("Page.captureScreenshot",
                                               {"format": "png", "captureBeyondViewport": True})
        (self.folder / name).write_bytes(base64.b64decode(picture["data"]))

    def shown(self, *selectors):
        return self.script(
            "return arguments[0].map(s => getComputedStyle(document.querySelector(s)).display !== 'none')",
            selectors)

    def canvas(self):
        return self.browser.find_element("css selector", ".stage canvas")

    def scene_picture(self):
        canvas = self.canvas()
        self.script("arguments[0].scrollIntoView({block: 'center'})",
                    canvas)  # a picture is of what the window shows
        return canvas.screenshot_as_png

    def play(self, on):
        self.script(
            "const b = document.getElementById('play'); if (b.textContent !== arguments[0]) b.click()",
            "Pause" if on else "Play")

    def show(self, fraction):
        """The paused scene at a fraction of its playback."""
        self.play(False)
        self.script("""
            const slider = document.getElementById('time');
            slider.value = arguments[0] * slider.max;
            slider.dispatchEvent(new Event('input'));""", fraction)
        time.sleep(0.3)

    def ball_pixels(self, circles):
        """Counts pixels of the scene's picture: of balls in the circles, in the circles, of balls
        anywhere. Balls are blue, the vessel is yellow and the page white, so that balls alone have
        little red, behind the vessel's walls too."""
        return self.browser.execute_async_script(
            """
            const [png, circles, done] = arguments, image = new Image();
            image.onload = () => {
              const canvas = document.createElement('canvas'), context = canvas.getContext('2d');
              canvas.width = image.width; canvas.height = image.height;
              context.drawImage(image, 0, 0);
              const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
              let both = 0, inside = 0, balls = 0;
              for (let y = 0, k = 0; y < canvas.height; ++y)
                for (let x = 0; x < canvas.width; ++x, k += 4) {
                  const is_ball = data[k] < 160;
                  const is_inside = circles.some(c => Math.hypot(x + 0.5 - c[0], y + 0.5 - c[1]) < c[2]);
                  both += is_ball && is_inside; inside += is_inside; balls += is_ball;
                }
              done([both, inside, balls]);
            };
            image.src = 'data:image/png;base64,' + png;""",
            base64.b64encode(self.scene_picture()).decode(), circles)
