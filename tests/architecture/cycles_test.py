#!/usr/bin/env python3
"""No header of src/ includes itself by way of others, and no file is longer than 400 lines.

usage: cycles_test.py SOURCE"""
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1]) / "src"
files = {str(p.relative_to(source)): p.read_text(encoding="utf-8") for p in sorted(source.rglob("*.[ch]pp"))}
includes = {name: [i for i in re.findall(r'^#include "([^"]+)"', text, re.M) if i in files] for name, text in files.items()}
problems = [f"{name}: {text.count(chr(10))} lines, at most 400" for name, text in files.items() if text.count("\n") > 400]
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
if len(files) < 100:
    problems.append(f"{len(files)} files found in {source}, expected those of the project")
print("\n".join(problems) or f"{len(files)} files: no cycle of includes, none longer than 400 lines")
sys.exit(1 if problems else 0)
