#!/usr/bin/env python3
"""One file of the page: its text, style and scripts, the engine compressed within it, and the cases
of docs/examples.

usage: assemble_page.py ENGINE PAGE.html   where ENGINE.js and ENGINE.wasm are
"""
import base64
import gzip
import json
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PARTS = SOURCE / "src/bindings/browser"
VIEW = SOURCE / "src/pages/report/mill_view.js"
EXAMPLES = SOURCE / "docs/examples"
CASES = {
    "SPEX 8000, 28 balls": "demo.toml", "planetary mill": "planetary.toml",
    "shaken box": "shaken_box.toml", "steel and alumina, with a piston": "materials.toml",
    "stirred tank": "stirred.toml"
}


def main(engine, place):
    def read(name):
        return (PARTS / name).read_text(encoding="utf-8")  # or a whole path

    def script(name):
        """Without comments and indentation: the file is to stay small."""
        lines = (line.strip() for line in read(name).splitlines())
        return "\n".join(line for line in lines if not line.startswith("//")) + "\n"

    compressed = gzip.compress(pathlib.Path(engine + ".wasm").read_bytes(), 9, mtime=0)
    cases = {name: (EXAMPLES / file).read_text(encoding="utf-8") for name, file in CASES.items()}
    reference = SOURCE / "regression/reference"
    rows = [
        line.split(",")
        for line in (reference / "three_balls.events.csv").read_text(encoding="utf-8").splitlines()
        if not line.startswith("#")
    ]
    proven = {
        "case": (reference / "three_balls.toml").read_text(encoding="utf-8"),
        "events": [[row[1],
                    int(row[2]),
                    int(row[4]) if row[3] == "ball" else -1 - int(row[4])] for row in rows[1:201]]
    }
    worker = pathlib.Path(engine + ".js").read_text(encoding="utf-8") + script("worker.js")
    parts = {
        "style": read("page.css"),
        "script": "".join(map(script, ("engine.js", VIEW, "picture.js", "page.js", "lessons.js"))
                         ), "worker": json.dumps(worker).replace("</", "<\\/"),
        "cases": json.dumps(cases).replace("</", "<\\/"), "proven": json.dumps(proven),
        "certificate": json.dumps(read("three_balls.certificate")),
        "engine": base64.b64encode(compressed).decode()
    }
    page = read("page.html")
    for name, text in parts.items():
        page = page.replace("{{" + name + "}}", text)
    partial = pathlib.Path(place + ".partial")
    partial.write_text(page, encoding="utf-8")
    partial.replace(place)


if __name__ == "__main__":
    main(*sys.argv[1:])
