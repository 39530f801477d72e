#!/usr/bin/env python3
"""The npm package: the engine, its command and module, and the options of its commands, which it
prints itself.

usage: assemble_package.py ENGINE FOLDER    where ENGINE.js and ENGINE.wasm are; makes
    FOLDER/edmill-VERSION.tgz
"""
import gzip
import io
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
PARTS = SOURCE / "src/bindings/node"
VERSION = re.search(r"project\(edmill VERSION (\S+)",
                    (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
FUNCTIONS = {
    "run": "Promise<Summary & Outcome>", "audit": "Promise<Judged & Outcome>",
    "compare": "Promise<Judged & Outcome>", "check": "Promise<string>"
}


def options_of(program, command):
    """What `edmill COMMAND --help` lists: its positionals and its options, with what each
    expects."""
    text = subprocess.run(["node", program, command, "--help"], check=True, capture_output=True,
                          text=True).stdout
    entries = re.findall(r"^  (\S.*?)(?: {2,}|\n {10,})(.*(?:\n {20,}.*)*)", text, re.M)
    places, options = [], {}
    for words, meaning in entries:
        meaning = re.sub(r"\s+", " ", meaning)
        option = re.match(r"(?:-\w,)?--([\w-]+)(?: ([A-Z]+))?", words)
        if option and option.group(1) != "help":
            options[option.group(1)] = {"expects": option.group(2) or "", "meaning": meaning}
        elif not option:
            places.append(words.split()[0])
    return {"places": places, "options": options}


def type_of(option):
    kind = {"": "boolean", "TEXT": "string"}.get(option["expects"], "number")
    return f"{kind} | {kind}[]" if "can be repeated" in option["meaning"] else kind


def declarations(commands):
    lines = [
        "export interface Process { input?: string | Uint8Array; cwd?: string }",
        "/** Its exit code, and what it printed. */",
        "export interface Outcome { code: number; text: string }",
        "/** summary.json: docs/files.md */",
        "export interface Summary { [name: string]: any; milling_dose_rate: number }",
        "/** The result of --json: docs/audit.md */",
        "export interface Judged { [name: string]: any; verdict: string }",
        "export class EdmillError extends Error { code: number }",
        "export function edmill(words: string[], process?: Process): Promise<{code: number; stdout: string; stderr: string}>;",
        "export function certificate(file: string, process?: Process): Promise<{accepted: boolean; text: string}>;"
    ]
    for name, result in FUNCTIONS.items():
        options = f"{name.capitalize()}Options"
        lines.append(f"export interface {options} extends Process {{")
        for option, what in commands[name]["options"].items():
            camel = re.sub("-(.)", lambda match: match.group(1).upper(), option)
            lines += [f"  /** {what['meaning']} */", f"  {camel}?: {type_of(what)};"]
        places = ", ".join(
            f"{place.lower()}: string" for place in commands[name]["places"]).replace(
                "case:", "file:")
        lines += ["}", f"export function {name}({places}, options?: {options}): {result};"]
    return "\n".join(lines) + "\n"


def pack(folder, place):
    """What `npm pack` makes, with the same bytes each time."""
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for file in sorted(folder.iterdir()):
            entry = tarfile.TarInfo(f"package/{file.name}")
            entry.size, entry.mode, entry.mtime = file.stat(
            ).st_size, 0o755 if file.name == "edmill.js" else 0o644, 499162500
            archive.addfile(entry, file.open("rb"))
    place.write_bytes(gzip.compress(tar.getvalue(), 9, mtime=0))


def main(engine, target):
    folder = pathlib.Path(target) / "package"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for ending in ("js", "wasm"):
        shutil.copyfile(f"{engine}.{ending}", folder / f"engine.{ending}")
    for file in (PARTS / "edmill.js", PARTS / "index.mjs", PARTS / "README.md", SOURCE / "LICENSE"):
        shutil.copyfile(file, folder / file.name)
    about = json.loads((PARTS / "package.json").read_text(encoding="utf-8"))
    (folder / "package.json").write_text(
        json.dumps({**about, "version": VERSION}, indent=2) + "\n", encoding="utf-8")
    program = folder / "edmill.js"
    listed = subprocess.run(["node", program, "--help"], check=True, capture_output=True,
                            text=True).stdout
    names = re.findall(r"^  ([a-z]+) {2,}",
                       listed[listed.index("Subcommands:"):listed.index("Exit codes")], re.M)
    commands = {name: options_of(program, name) for name in names}
    (folder / "commands.json").write_text(json.dumps(commands, indent=1) + "\n", encoding="utf-8")
    (folder / "index.d.ts").write_text(declarations(commands), encoding="utf-8")
    pack(folder, pathlib.Path(target) / f"edmill-{VERSION}.tgz")


if __name__ == "__main__":
    main(*sys.argv[1:])
