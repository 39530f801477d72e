#!/usr/bin/env python3
"""The pages of a run, a comparison, a sweep and an optimisation judged by axe-core against WCAG 2.2
AA, at two widths, light and dark. axe-core is not part of Debian: its path is an argument.

usage: PYTHONPATH=tests/support python3 accessibility_test.py EDMILL AXE.MIN.JS [FOLDER]
FOLDER keeps the pages and a screenshot of each. Without axe.min.js the exit code is 77.
"""
import base64
import os
import pathlib
import sys
import tempfile

from program import EXAMPLES, said
from report_in_browser import browser

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
JUDGE = """const done = arguments[1];
axe.run(document, {runOnly: {type: 'tag', values: arguments[0]}, resultTypes: ['violations']}).then(
  found => done(found.violations.map(v => [v.id, v.help, v.nodes.map(n => n.target.join(' ') + ': ' + n.failureSummary)])))"""


def pages(folder):
    """Makes the pages in `folder`: their names and paths."""
    def call(*words):
        said(*words, cwd=folder)

    demo = f'"{EXAMPLES / "demo.toml"}"'
    outputs = ('output=[{type="treatment",share_per_impact=1e-4},{type="lyapunov",exponents=3},'
               '{type="lyapunov",exponents=2,interval="20 ms",file="growth.csv"}]')
    call("run", EXAMPLES / "demo.toml", "--report", "--quiet", "--out", "run", "--target-dose",
         "10 kJ/g", "--set", "run.end_time=3 s", "--set", outputs)
    call("run", EXAMPLES / "planetary.toml", "--report", "--quiet", "--out", "planetary", "--set",
         "run.end_time=2 s")
    call("run", EXAMPLES / "demo.toml", "--quiet", "--out", "other", "--set", "run.end_time=3 s",
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
    pages = {
        "run": "run/report.html", "planetary": "planetary/report.html",
        "comparison": "comparison.html", "sweep": "sweep/sweep.html",
        "optimum": "optimum/optimize.html"
    }
    mill = os.environ.get("EDMILL_PAGE")
    return dict(pages, mill=pathlib.Path(mill).resolve()) if mill else pages


def main():
    axe = pathlib.Path(sys.argv[2]).resolve()
    if not axe.is_file():
        print(f"{axe} is absent")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else temporary).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        driver = browser(pathlib.Path(temporary) / "profile")
        driver.set_script_timeout(120)
        faults = 0
        for name, path in pages(folder).items():
            for width in (1200, 390):
                for scheme in ("light", "dark"):
                    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
                        "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600
                    })
                    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
                        "features": [{"name": "prefers-color-scheme", "value": scheme}]})
                    driver.get((folder / path).as_uri())
                    picture = driver.execute_cdp_cmd(
                        "Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True})
                    (folder / f"{name}-{width}-{scheme}.png").write_bytes(
                        base64.b64decode(picture["data"]))
                    driver.execute_script(axe.read_text())
                    found = driver.execute_async_script(JUDGE, RULES)
                    # The software renderer remarks on the screenshot itself.
                    messages = [
                        line for line in driver.get_log("browser")
                        if "GPU stall due to ReadPixels" not in line["message"]
                    ]
                    print(
                        f"{name}, {width} px, {scheme}: {len(found)} findings, {len(messages)} messages on the console"
                    )
                    for rule, text, nodes in found:
                        print(f"  {rule}: {text}", *(f"\n    {node}" for node in nodes[:5]))
                    for message in messages:
                        print(" ", message["message"])
                    faults += len(found) + len(messages)
        driver.quit()
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
