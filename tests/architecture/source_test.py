#!/usr/bin/env python3
"""What the sources of src/ have in common: no header includes itself by way of others; a room has
its own namespace, and adds to others only what it declares of them; rooms of the page in the
browser keep to the library that it is built with; judges do without the engine. Pages
of prose, comments and docstrings have lines of at most 100 columns. Files of more than 400
lines, functions of more than 60 and six equal lines in two places are listed for a reader to judge,
and fail nothing.

usage: source_test.py SOURCE"""
import ast
import collections
import io
import pathlib
import re
import sys
import tokenize

source = pathlib.Path(sys.argv[1]) / "src"
# By room: each library's folder is one of those that are searched for headers.
files = {
    str(pathlib.Path(*p.relative_to(source).parts[1:])): p.read_text(encoding="utf-8")
    for p in sorted(source.rglob("*.[ch]pp"))
}
problems, to_judge = [], []


def find_cycles():
    includes = {
        name: [i for i in re.findall(r'^#include "([^"]+)"', text, re.M) if i in files
              ] for name, text in files.items()
    }
    done, path = set(), []

    def visit(name):
        if name in path:
            problems.append("a cycle: " + " -> ".join(path[path.index(name):] + [name]))
            return
        if name in done:
            return
        path.append(name)
        for other in includes[name]:
            visit(other)
        path.pop()
        done.add(name)

    for name in includes:
        visit(name)


def find_long(name, lines):
    """Functions by their indent: from the line that opens the body to the brace below its first
    column."""
    if len(lines) > 400:
        to_judge.append(f"{name}: {len(lines)} lines")
    for k, line in enumerate(lines):
        if not re.search(r"\)[\w &:<>,*-]*( :.*)? ?\{$", line) or re.match(
                r"\s*(if|for|while|switch|else|struct|class|\})", line):
            continue
        begin = k
        while begin > 0 and re.match(r"\s{4,}\S|\s+:", lines[begin]) and not re.search(
                r"[;{}]$|:$|^$", lines[begin - 1]):
            begin -= 1
        indent = re.match(r" *", lines[begin]).group()
        end = next((n for n in range(k + 1, len(lines)) if re.match(indent + r"\}", lines[n])), k)
        if end - begin >= 60:
            to_judge.append(f"{name}:{begin + 1}: a function of {end - begin + 1} lines")


def find_ranges(name, text):
    """The page of the browser and the npm package have these rooms, and Emscripten's library of
    Debian 12 no algorithms of std::ranges."""
    if name.split("/")[0] in {
            "base", "model", "dynamics", "engine", "casefile", "io", "run", "tangent", "output",
            "core_alone", "browser", "node", "audit", "compare", "identify", "dem", "logs", "decks",
            "machines", "cli"
    } and "std::ranges::" in text:
        problems.append(f"{name}: std::ranges, which the page and the npm package cannot have")


# Pages that programs write.
GENERATED = {"reference.md", "variables.md", "machines.md", "dem_study.md", "test-times.md"}


def report_wide(path, number, line):
    if len(line) > 100:
        problems.append(f"{path.relative_to(source.parent)}:{number}: {len(line)} columns of prose, "
                        "at most 100 are expected")


def find_wide_pages():
    """A line may be longer in a table, a heading, an image, code and a single long word."""
    pages = [p for folder in ("docs", "verification", "regression", "release", "src")
             for p in (source.parent / folder).rglob("*.md")]
    for page in pages + list(source.parent.glob("*.md")):
        is_code = False
        if page.name in GENERATED:
            continue
        for k, line in enumerate(page.read_text(encoding="utf-8").splitlines()):
            if line.strip().startswith("```"):
                is_code = not is_code
            elif not is_code and not line.startswith(("|", "    ", "<", "#", "![")):
                if " " in line[:100].strip():
                    report_wide(page, k + 1, line)


def find_wide_comments():
    """Comments and docstrings of all sources and scripts."""
    marks = {".py": "#", ".sh": "#", ".cmake": "#", ".txt": "#", ".pyi": "#",
             ".cpp": "//", ".hpp": "//", ".def": "//", ".js": "//", ".mjs": "//"}
    folders = ("src", "include", "tests", "verification", "regression", "docs", "cmake", "release")
    paths = [p for folder in folders for p in (source.parent / folder).rglob("*")]
    for path in [p for p in paths + list(source.parent.glob("*")) if p.suffix in marks]:
        if path.suffix == ".txt" and path.name != "CMakeLists.txt":
            continue
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".py":
            for token in tokenize.generate_tokens(io.StringIO(text).readline):
                if token.type == tokenize.COMMENT and token.line.strip().startswith("#"):
                    report_wide(path, token.start[0], token.line.rstrip("\n"))
            for node in ast.walk(ast.parse(text)):
                if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and \
                        ast.get_docstring(node, clean=False):
                    place = node.body[0]
                    for k in range(place.lineno, place.end_lineno + 1):
                        report_wide(path, k, text.splitlines()[k - 1])
            continue
        for k, line in enumerate(text.splitlines()):
            if line.strip().startswith(marks[path.suffix]):
                report_wide(path, k + 1, line)


# The declarations of instances that two sources need, each by itself.
SHARED = {"namespace edmill {"}


def find_twice():
    places = collections.defaultdict(list)
    for name, text in files.items():
        lines = [
            (k + 1, re.sub(r"\s+", " ", line.strip())) for k, line in enumerate(text.splitlines())
        ]
        lines = [(k, line) for k, line in lines
                 if line and not line.startswith(("//", "#include")) and line not in (
                     "{", "}", "};", "public:", "private:")]
        for k in range(len(lines) - 5):
            places[tuple(line for _, line in lines[k:k + 6])].append(f"{name}:{lines[k][0]}")
    for lines, where in places.items():
        if len(where) > 1 and not SHARED & set(lines):
            to_judge.append("six lines twice: " + ", ".join(where))


def own_namespaces(room):
    """In run stands what programs include, too."""
    own = {"edmill", "edmill::numerics"
          } if room == "base" else {f"edmill::{room}", f"edmill::{room}::detail"}
    return own | {"edmill"} if room == "run" else own


def find_foreign_namespaces(name, text):
    own = own_namespaces(name.split("/")[0])
    for block in re.finditer(r"^namespace (edmill[\w:]*) \{\n(.*?)^\}  // namespace \1$", text,
                             re.M | re.S):
        # The registry defines what casefile declares, the types of outputs; the core alone, the
        # page and the npm package stand for what they leave out.
        if block.group(1) in own or name == "output/registry.cpp" or name.startswith(
            ("core_alone/", "browser/exports", "node/")):
            continue
        declared = re.sub(
            r"//.*|extern template [^;]*;|template <[^>]*>|(class|struct) \w+;|namespace \w+ \{|\}",
            "", block.group(2))
        if declared.strip():
            problems.append(
                f"{name}: namespace {block.group(1)}, expected {' or '.join(sorted(own))}: {declared.split()[:6]}"
            )


def find_engine(name, text):
    """A judge that shares the engine's code proves nothing; the engine tells a proof only where to
    look."""
    room = name.split("/")[0]
    for other, judges in (("engine", {"audit", "compare", "identify", "dem",
                                      "prove"}), ("run", {"audit", "compare", "dem"})):
        if room in judges and f'#include "{other}/' in text:
            problems.append(f"{name}: includes {other}")


find_cycles()
find_twice()
for name, text in files.items():
    find_long(name, text.splitlines())
    find_foreign_namespaces(name, text)
    find_ranges(name, text)
    find_engine(name, text)
if len(files) < 100:
    problems.append(f"{len(files)} files found in {source}, expected those of the project")
find_wide_pages()
find_wide_comments()
print("\n".join(to_judge + problems +
                [f"{len(files)} files, {len(problems)} problems, {len(to_judge)} places to judge"]))
sys.exit(1 if problems else 0)
