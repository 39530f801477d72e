#!/usr/bin/env python3
"""The synopsis of docs/usage.md has each command of the program, with the options that its --help
lists, and no others.

usage: PYTHONPATH=tests/support python3 usage_test.py EDMILL
"""
import collections
import re
import sys

from program import SOURCE, said


def helped():
    """Options by command, of --help."""
    listed = said("--help")
    names = re.findall(r"^  ([a-z]+) {2,}\S",
                       listed[listed.index("Subcommands:"):listed.index("Exit codes")], re.M)
    return {
        name: set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", said(name, "--help"), re.M)) - {"--help"}
        for name in names
    }


def synopsis():
    """The same of the page; a command may have several lines, and a line that is indented continues
    the one before."""
    block = (SOURCE / "docs/usage.md").read_text(encoding="utf-8").split("```")[1]
    found, commands = collections.defaultdict(set), []
    for line in block.splitlines()[1:]:
        begin = re.match(r"edmill ([a-z]+(?: \| [a-z]+)*)", line)
        if begin or not line.startswith(" "):
            commands = begin.group(1).split(" | ") if begin else []
        for command in commands:
            found[command] |= set(re.findall(r"--[\w-]+", line))
    return dict(found)


program, page = helped(), synopsis()
problems = [
    f"edmill {name}: --help has {sorted(options)}, docs/usage.md {sorted(page.get(name, []))}"
    for name, options in program.items() if page.get(name) != options
]
problems += [f"docs/usage.md: edmill {name} is no command" for name in page.keys() - program.keys()]
print(
    "\n".join(problems) or
    f"{len(program)} commands with {sum(map(len, program.values()))} options are those of docs/usage.md"
)
sys.exit(1 if problems or len(program) < 20 else 0)
