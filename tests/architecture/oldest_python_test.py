#!/usr/bin/env python3
"""The Python that users run, modules, scripts, notebooks and pages, keeps to the oldest Python that
pyproject.toml declares: to its grammar, and to what it has when a module is imported or a function
called.

usage: oldest_python_test.py SOURCE"""
import ast
import json
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
# What is newer than 3.9: modules, names of builtins, what modules and objects have, and keywords of
# calls.
MODULES = {"tomllib": 11}
NAMES = {
    "aiter": 10, "anext": 10, "EncodingWarning": 10, "ExceptionGroup": 11, "BaseExceptionGroup": 11
}
MEMBERS = {
    10: "bit_count pairwise hardlink_to UnionType NoneType EllipsisType TypeAlias TypeGuard ParamSpec Concatenate KW_ONLY covariance "
        "linear_regression orig_argv stdlib_module_names get_annotations packages_distributions",
    11: "Self Never LiteralString NotRequired Required Unpack TypeVarTuple assert_never assert_type reveal_type UTC file_digest chdir StrEnum cbrt exp2 add_note",
    12: "batched sumprod with_segments is_junction",
}
MEMBER = {name: minor for minor, names in MEMBERS.items() for name in names.split()}
OF_OS = {"chdir"}  # old there
KEYWORDS = {("zip", "strict"): 10, ("dataclass", "slots"): 10, ("dataclass", "kw_only"): 10,
            ("field", "kw_only"): 10, ("bisect", "key"): 10, ("bisect_left", "key"): 10,
            ("bisect_right", "key"): 10, ("insort", "key"): 10, ("write_text", "newline"): 10,
            ("glob", "root_dir"): 10, ("TemporaryDirectory", "ignore_cleanup_errors"): 10,
            ("NamedTemporaryFile", "delete_on_close"): 12}
TYPES = {
    "bool", "int", "float", "complex", "str", "bytes", "list", "tuple", "dict", "set", "frozenset",
    "object", "type", "None"
}


def last(node):
    return node.attr if isinstance(node,
                                   ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def is_type(node):
    """None, int, list[int], pathlib.Path, Mapping, but no CONSTANT and no re.M."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
        return is_type(node.left) or is_type(node.right)
    if isinstance(node, ast.Subscript):
        return is_type(node.value)
    name = "None" if isinstance(node, ast.Constant) and node.value is None else last(node)
    return name in TYPES or re.fullmatch(r"[A-Z]+[a-z]\w*", name) is not None


def problems_of(text, oldest):
    try:
        tree = ast.parse(text, feature_version=(3, oldest))
    except SyntaxError as error:
        return [(error.lineno or 0, error.msg)]
    postponed = any(
        isinstance(n, ast.ImportFrom) and n.module == "__future__" and any(a.name == "annotations"
                                                                           for a in n.names)
        for n in tree.body)
    shown = [
        x for n in ast.walk(tree)
        for x in (getattr(n, "annotation", None), getattr(n, "returns", None)) if x is not None
    ]
    unevaluated = {m for annotation in shown for m in ast.walk(annotation)} if postponed else set()
    found = []
    for n in ast.walk(tree):
        if n in unevaluated:
            continue
        new = {}
        if isinstance(n, ast.BinOp) and isinstance(n.op, ast.BitOr) and is_type(n):
            new[f"{ast.unparse(n)}: a union of types"] = 10
        elif isinstance(n, ast.Call):
            new = {
                f"{last(n.func)}({k.arg}=)": KEYWORDS.get((last(n.func), k.arg), 0)
                for k in n.keywords
            }
        elif isinstance(n, ast.Import):
            new = {a.name: MODULES.get(a.name, 0) for a in n.names}
        elif isinstance(n, ast.ImportFrom):
            new = {
                f"{n.module}.{a.name}": max(MEMBER.get(a.name, 0), MODULES.get(n.module, 0))
                for a in n.names
            }
        elif isinstance(n, ast.Attribute) and not (n.attr in OF_OS and last(n.value) == "os"):
            new[n.attr] = MEMBER.get(n.attr, 0)
        elif isinstance(n, ast.Name):
            new[n.id] = NAMES.get(n.id, 0)
        found += [(n.lineno, f"{what} needs Python 3.{minor}") for what, minor in new.items()
                  if minor > oldest]
    return found


def oldest_of(file):
    """The tools of the project itself run with the Python of Debian 12; the suite is for users of
    other codes."""
    own = file.relative_to(source).parts[0] in (
        "regression", "verification") and not file.name.startswith("compare")
    return 11 if own else declared


def blocks():
    """Names and texts of everything that users run; those of a page at their lines."""
    for folder in ("src/bindings/python", "cmake", "docs", "regression", "verification"):
        for file in sorted((source / folder).rglob("*.py")):
            yield file, file.read_text(encoding="utf-8")
        for file in sorted((source / folder).rglob("*.ipynb")):
            cells = json.loads(file.read_text(encoding="utf-8"))["cells"]
            yield file, "\n".join(
                re.sub(r"(?m)^(\s*)[%!].*", r"\1pass", "".join(c["source"])) for c in cells
                if c["cell_type"] == "code")
        for file in sorted((source / folder).rglob("*.md")):
            text = file.read_text(encoding="utf-8")
            for block in re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S):
                yield file, "\n" * (text[:block.start()].count("\n") + 1) + block.group(1)


# The test finds each kind, and lets alone what is old.
NEW = [
    "Number = float | None", "isinstance(x, int | pathlib.Path)", "match x:\n  case 1: pass",
    "zip(a, b, strict=True)", "import tomllib", "from typing import Self",
    "def f(x: int | None): pass", "x.bit_count()", "except_ = ExceptionGroup",
    "try: pass\nexcept* ValueError: pass", "class A:\n  x: list[int] | None = None"
]
OLD = [
    "a | b", "re.M | re.S", "x.keys() | {1}",
    "from __future__ import annotations\ndef f(x: int | None): pass", "os.walk(folder)", "zip(a, b)"
]
assert all(problems_of(text, 9) for text in NEW), [text for text in NEW if not problems_of(text, 9)]
assert not any(problems_of(text, 9) for text in OLD), [problems_of(text, 9) for text in OLD]

declared = int(
    re.search(r'^requires-python = ">=3\.(\d+)"$',
              (source / "pyproject.toml").read_text(encoding="utf-8"), re.M).group(1))
texts = list(blocks())
problems = [
    f"{file.relative_to(source)}:{line}: {what}" for file, text in texts
    for line, what in problems_of(text, oldest_of(file))
]
if len(texts) < 40:
    problems.append(f"{len(texts)} texts found, expected those of the project")
print("\n".join(problems) or f"{len(texts)} texts keep to Python 3.{declared}")
sys.exit(1 if problems else 0)
