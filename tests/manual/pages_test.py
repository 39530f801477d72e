#!/usr/bin/env python3
"""Runs the code blocks of a page of the manual, in their order, in an empty folder.

    console     lines after "$ " are commands, the others what they print; "..." stands for
    anything, in a line of its own for any lines sh          commands; they must succeed
    sh setup    commands that prepare a machine: other tests run them (see SETUP)
    sh long     commands of long studies: run with --long only
    python      Python, with the package edmill; blocks of a page share their variables. A comment
                with a number behind what prints, up to a colon, is what it prints: "# 5.8 ± 0.1:
                with its interval"
    toml        with "# NAME.toml" as first line, a file; otherwise sections of a case, which must
    be valid cpp         with "// NAME.cpp" as first line, the end of docs/examples/NAME.cpp cmake,
    diff, text, {directive}   not run here: an own test reads them, or they are no code

usage: pages_test.py EDMILL PYTHON_PACKAGE SOURCES FOLDER PAGE [--long] [--update]
--update writes what the commands print into the console blocks of the page."""
import argparse
import ast
import contextlib
import decimal
import fnmatch
import io
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tokenize
import tomllib

SETUP = {  # commands that this test does not run: which test does
    "./bootstrap.sh *": ".ci/run", "apt-get install *": "packages_test", "python3 -m venv *": "python_wheel_test",
    "venv/bin/pip install *": "python_wheel_test", "python3 -m pip wheel *": "python_wheel_test", "cmake --preset *": ".ci/run", "cmake -S . -B build/core *": "same_bits_long", "NODE_PATH=*": "browser_mill_long", "npx *": "npm_package_long", "npm *": "npm_package_long", "release/npm.sh *": "npm_package_long", "build/core/edmill-core *": "same_bits_long", "cmake --build *": ".ci/run",
    "ctest *": ".ci/run", "cpack*": "packages_test", "tests/architecture/debian_test.sh *": "debian_bookworm_long and debian_trixie_long",
    "PYTHONPATH=tests/support python3 tests/pages/report/report_browser_test.py *": "report_browser_test",
}
OTHERS = ("cmake", "diff", "text", "xml", "yaml", "csv", "js", "")
BASE = """[run]
end_time = "0.01 s"
[vessel]
diameter = "38 mm"
height = "57 mm"
[contact]
restitution = 0.5
friction = 0.4
[[balls]]
count = 2
diameter = "6 mm"
"""


class Page:
    def __init__(self, arguments):
        self.a, self.problems, self.ran = arguments, [], 0
        self.page = pathlib.Path(arguments.sources) / arguments.page
        self.lines = self.page.read_text(encoding="utf-8").splitlines()
        self.variables = {"__name__": "__main__"}
        self.environment = dict(
            os.environ, PYTHONPATH=arguments.package, PYTHONDONTWRITEBYTECODE="1", COLUMNS="120",
            PATH=f"{pathlib.Path(arguments.edmill).parent}:/usr/bin:{os.environ['PATH']}")

    def prepare(self):
        self.folder = pathlib.Path(self.a.folder)
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        for name in ("docs", "regression", "verification", "tests", "build"):
            if (pathlib.Path(self.a.sources) / name).exists():
                (self.folder / name).symlink_to(pathlib.Path(self.a.sources).resolve() / name)
        os.chdir(self.folder)

    def problem(self, line, text):
        self.problems.append(f"{self.a.page}:{line + 1}: {text}")

    def blocks(self):
        """Yields the language, the first line and the number of lines of each fenced block."""
        k = 0
        while k < len(self.lines):
            fence = re.fullmatch(r"(`{3,})(.*)", self.lines[k])
            k += 1
            if not fence:
                continue
            begin = k
            while self.lines[k] != fence.group(1):
                k += 1
            yield fence.group(2).strip(), begin, k - begin
            k += 1

    def shell(self, command):
        return subprocess.run(["bash", "-c", command], env=self.environment, capture_output=True,
                              text=True, timeout=3600)

    def run(self):
        self.prepare()
        shift, blocks = 0, list(self.blocks())
        for kind, begin, count in blocks:
            lines = self.lines[begin + shift:begin + shift + count]
            language = kind.split()[0] if kind else ""
            place = begin + shift
            if language == "console":
                shown = self.console(lines, place)
                if self.a.update:
                    self.lines[place:place + count] = shown
                    shift += len(shown) - count
            elif kind == "sh setup":
                for line in lines:
                    command = line.split("#")[0].strip()
                    if command and not any(fnmatch.fnmatch(command, known) for known in SETUP):
                        self.problem(place, f"'{command}' is run by no test")
                    self.ran += 1
            elif language == "sh":
                if kind != "sh long" or self.a.long:
                    self.succeed("set -e\n" + "\n".join(lines), place)
            elif language == "python":
                self.python("\n".join(lines), place)
            elif language == "toml":
                self.toml(lines, place)
            elif language == "cpp":
                self.cpp(lines, place)
            elif language not in OTHERS and not language.startswith("{"):
                self.problem(place, f"a block in '{language}', which this test does not know")
        if self.a.update:
            self.page.write_text("\n".join(self.lines) + "\n", encoding="utf-8")
        return self.problems

    def cpp(self, lines, place):
        """The end of an example, which another test builds."""
        name = lines[0].removeprefix("// ")
        example = pathlib.Path(self.a.sources) / "docs/examples" / name
        self.ran += 1
        if not example.is_file() or not example.read_text(encoding="utf-8").rstrip().endswith(
                "\n".join(lines[1:])):
            self.problem(place, f"not the end of docs/examples/{name}")

    def succeed(self, command, place):
        done = self.shell(command)
        self.ran += 1
        if done.returncode != 0:
            self.problem(
                place,
                f"exit code {done.returncode}:\n{command}\n{done.stdout[-1500:]}{done.stderr[-1500:]}"
            )

    def console(self, lines, place):
        """Runs the commands; what they print must be there. Returns the block with what they
        print."""
        shown, k = [], 0
        while k < len(lines):
            if not lines[k].startswith("$ "):
                self.problem(place + k, "a console block that does not begin with a command")
                return lines
            command, first = lines[k][2:], k
            while lines[k].endswith("\\"):
                k += 1
                command = command[:-1] + lines[k].strip()
            shown += lines[first:k + 1]
            k += 1
            expected = []
            while k < len(lines) and not lines[k].startswith("$ "):
                expected.append(lines[k])
                k += 1
            done = self.shell(command)
            self.ran += 1
            text = (done.stdout + done.stderr).replace(str(self.folder), "").rstrip("\n")
            printed = [line.rstrip() for line in text.splitlines()]
            if "Traceback (most recent call last):" in printed:
                self.problem(place + first, f"'{command}' fails:\n{text}")
            if not self.matches(expected, printed):
                if not self.a.update:
                    self.problem(
                        place + first, f"'{command}' prints\n" + "\n".join(printed) +
                        "\nwhere the page has\n" + "\n".join(expected))
                shown += printed
            else:
                shown += expected
        return shown

    @staticmethod
    def matches(expected, printed):
        pattern = "\n".join(
            "(?s:.*)" if line == "..." else re.escape(line.rstrip()).replace(r"\.\.\.", ".*")
            for line in expected)
        return re.fullmatch(pattern, "\n".join(printed)) is not None

    def python(self, text, place):
        self.ran += 1
        tokens = tokenize.generate_tokens(io.StringIO("\n" * place + text + "\n").readline)
        shown = {token.start[0]: token.string for token in tokens if token.type == tokenize.COMMENT}
        for statement in ast.parse("\n" * place + text).body:
            out = io.StringIO()
            try:
                with contextlib.redirect_stdout(out):
                    exec(compile(ast.Module([statement], []), self.a.page, "exec"), self.variables)
            except Exception as error:  # noqa: BLE001: whatever a block raises is a finding
                return self.problem(statement.lineno - 1, f"{type(error).__name__}: {error}")
            comment = shown.get(statement.end_lineno, "").lstrip("# ").split(": ")[0]
            if out.getvalue() and re.search(
                    r"\d", comment) and not self.is_output(comment, out.getvalue()):
                self.problem(statement.end_lineno - 1,
                             f"prints {out.getvalue()!r}, where the page has {comment!r}")

    @staticmethod
    def is_output(comment, printed):
        """Whether a comment with numbers, up to a colon, is what the line prints: the same words,
        and numbers to the comment's digits."""
        pairs = list(itertools.zip_longest(comment.split(), printed.split(), fillvalue=""))
        number = re.compile(r"-?\d+(\.\d*)?(e-?\d+)?")
        return all(
            abs(float(a) - float(b)) <= 0.501 * 10 ** decimal.Decimal(a).as_tuple().exponent
            if number.fullmatch(a) and number.fullmatch(b) else a == b for a, b in pairs)

    def toml(self, lines, place):
        self.ran += 1
        named = re.fullmatch(r"# ([\w.]+\.toml)", lines[0]) if lines else None
        text = "\n".join(lines) + "\n"
        if named:
            pathlib.Path(named.group(1)).write_text(text, encoding="utf-8")
            return
        given = tomllib.loads(text)
        if "sweep" in given or "optimize" in given:
            file, command = "study.toml", "edmill {} study.toml --quiet --out study"
            self.problem(place, "a study without a name: begin with '# NAME.toml'")
            return
        for part in re.split(r"(?m)^(?=\[)", BASE):
            name = part.split("]")[0].strip("[")
            typed = given.get(name, {}).get(
                "type", "cylinder") if name == "vessel" and name in given else None
            if part and name not in given and not (name == "balls" and "ball" in given):
                text += part
            elif typed == "cylinder" and "diameter" not in given["vessel"]:
                text = text.replace("[vessel]\n", part, 1) if "[vessel]\n" in text else part + text
        pathlib.Path("fragment.toml").write_text(text, encoding="utf-8")
        done = self.shell("edmill check fragment.toml")
        if done.returncode != 0:
            self.problem(place, f"edmill check: {done.stderr}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    for name in ("edmill", "package", "sources", "folder", "page"):
        parser.add_argument(name)
    parser.add_argument("--long", action="store_true")
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    arguments.edmill, arguments.package = (
        str(pathlib.Path(p).resolve()) for p in (arguments.edmill, arguments.package))
    arguments.folder = str(pathlib.Path(arguments.folder).resolve())
    arguments.sources = str(pathlib.Path(arguments.sources).resolve())
    sys.path.insert(0, arguments.package)
    page = Page(arguments)
    problems = page.run()
    for problem in problems:
        print(problem)
    print(f"{arguments.page}: {page.ran} commands and blocks run, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
