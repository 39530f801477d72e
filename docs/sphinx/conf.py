"""The manual as HTML: `cmake --build build/ci --target manual`, or `sphinx-build -c docs/sphinx docs DIR`."""
import os
import pathlib
import re

root = pathlib.Path(__file__).resolve().parents[2]
project = "edmill"
author = copyright = "the edmill developers"
release = re.search(r"project\(edmill VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "breathe"]
myst_heading_anchors = 4
source_suffix = {".md": "markdown"}
exclude_patterns = ["notebooks", "sphinx", "examples"]
breathe_projects = {"edmill": os.environ.get("EDMILL_DOXYGEN_XML", str(root / "build/manual/doxygen/xml"))}
breathe_default_members = ("members",)

html_theme = "furo"
html_title = f"edmill {release}"
highlight_language = "none"

# Links to files that are no pages become downloads; folders are named.
def link_to_sources(app, docname, source):
    page = pathlib.Path(app.srcdir) / f"{docname}.md"

    def target(match):
        text, path = match.groups()
        place = (page.parent / path.split("#")[0]).resolve()
        inside = place.is_relative_to(app.srcdir)
        if text.startswith("!") or re.match(r"[a-z]+:|#", path) or (place.suffix == ".md" and inside):
            return match.group(0)
        if not place.exists():
            raise FileNotFoundError(f"{docname}.md: a link to {path}, which does not exist")
        words = text[1:-1].replace("`", "")
        if place.is_dir():
            return f"{words} (`{place.relative_to(root)}`)"
        return f"{{download}}`{words} <{path.split('#')[0]}>`"

    source[0] = re.sub(r"(!?\[[^\]]*\])\(([^)\s]+)\)", target, source[0])


def setup(app):
    app.connect("source-read", link_to_sources)
