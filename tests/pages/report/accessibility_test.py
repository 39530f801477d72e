#!/usr/bin/env python3
"""The pages of a run, a comparison, a sweep and an optimisation judged by axe-core against WCAG 2.2 AA, at two widths,
light and dark. axe-core is not part of Debian: its path is an argument.

usage: accessibility_test.py EDMILL AXE.MIN.JS [FOLDER]
FOLDER keeps the pages and a screenshot of each. Without axe.min.js the exit code is 77.
"""
import base64
import os
import pathlib
import subprocess
import sys
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

ROOT = pathlib.Path(__file__).resolve().parents[3]
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
JUDGE = """const done = arguments[1];
axe.run(document, {runOnly: {type: 'tag', values: arguments[0]}, resultTypes: ['violations']}).then(
  found => done(found.violations.map(v => [v.id, v.help, v.nodes.map(n => n.target.join(' ') + ': ' + n.failureSummary)])))"""


def browser(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = "/usr/bin/chromium"
    for flag in ("--headless", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                 "--hide-scrollbars", f"--user-data-dir={profile}"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def pages(edmill, folder):
    """Makes the pages in `folder`: their names and paths."""
    def call(*words):
        subprocess.run([edmill, *map(str, words)], check=True, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)

    demo = f'"{ROOT / "docs/examples/demo.toml"}"'
    outputs = ('output=[{type="treatment",share_per_impact=1e-4},{type="lyapunov",exponents=3},'
               '{type="lyapunov",exponents=2,interval="20 ms",file="growth.csv"}]')
    call("run", ROOT / "docs/examples/demo.toml", "--report", "--quiet", "--out", "run", "--target-dose", "10 kJ/g",
         "--set", "run.end_time=3 s", "--set", outputs)
    call("run", ROOT / "docs/examples/planetary.toml", "--report", "--quiet", "--out", "planetary", "--set", "run.end_time=2 s")
    call("run", ROOT / "docs/examples/demo.toml", "--quiet", "--out", "other", "--set", "run.end_time=3 s",
         "--set", "contact.restitution=0.6")
    call("report", "run", "other", "--out", "comparison.html")
    (folder / "sweep.toml").write_text(f"""[sweep]
case = {demo}
replicas = 2
[sweep.grid]
"contact.restitution" = [0.4, 0.6, 0.8]
""")
    call("sweep", "sweep.toml", "--quiet", "--out", "sweep")
    (folder / "optimum.toml").write_text(f"""[optimize]
case = {demo}
objective = "specific_milling_dose_rate"
runs_max = 12
replicas_first = 2
replicas_max = 3
points = 3
refinements = 1
[[optimize.variable]]
key = "balls.0.diameter"
low = "4 mm"
high = "9 mm"
""")
    call("optimize", "optimum.toml", "--quiet", "--out", "optimum")
    pages = {"run": "run/report.html", "planetary": "planetary/report.html", "comparison": "comparison.html",
            "sweep": "sweep/sweep.html", "optimum": "optimum/optimize.html"}
    mill = os.environ.get("EDMILL_PAGE")
    return dict(pages, mill=pathlib.Path(mill).resolve()) if mill else pages


def main():
    edmill, axe = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    if not axe.is_file():
        print(f"{axe} is absent")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        driver = browser(pathlib.Path(temporary) / "profile")
        driver.set_script_timeout(120)
        faults = 0
        for name, path in pages(edmill, folder).items():
            for width in (1200, 390):
                for scheme in ("light", "dark"):
                    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                        "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600})
                    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                        "features": [{"name": "prefers-color-scheme", "value": scheme}]})
                    driver.get((folder / path).as_uri())
                    picture = driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True})
                    (folder / f"{name}-{width}-{scheme}.png").write_bytes(base64.b64decode(picture["data"]))
                    driver.execute_script(axe.read_text())
                    found = driver.execute_async_script(JUDGE, RULES)
                    # The software renderer remarks on the screenshot itself.
                    said = [line for line in driver.get_log("browser") if "GPU stall due to ReadPixels" not in line["message"]]
                    print(f"{name}, {width} px, {scheme}: {len(found)} findings, {len(said)} messages on the console")
                    for rule, text, nodes in found:
                        print(f"  {rule}: {text}", *(f"\n    {node}" for node in nodes[:5]))
                    for message in said:
                        print(" ", message["message"])
                    faults += len(found) + len(said)
        driver.quit()
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
