"""The manual as HTML: `docs/sphinx/make.sh DIR`."""
import os
import pathlib
import re

from mdit_py_plugins.anchors.index import slugify

root = pathlib.Path(__file__).resolve().parents[2]
project = "edmill"
author = copyright = "the edmill authors"
release = re.search(r"project\(edmill VERSION ([0-9.]+)",
                    (root / "CMakeLists.txt").read_text()).group(1)

extensions = ["myst_parser", "breathe"]
myst_heading_anchors = 4
source_suffix = {".md": "markdown"}
exclude_patterns = ["notebooks", "sphinx", "examples"]
breathe_projects = {
    "edmill": os.environ.get("EDMILL_DOXYGEN_XML", str(root / "build/manual/doxygen/xml"))
}
breathe_default_members = ("members",)

html_theme = "furo"
html_title = f"edmill {release}"
highlight_language = "none"

# Links to files that are no pages become downloads; folders are named; verification is a page.
link = re.compile(r"(!?\[[^\]]*\])\(([^)\s]+)\)")
verification = root / "verification"


def slug_of(text):
    """The anchor of the first heading."""
    return slugify(re.match(r"#+ (.*)", text).group(1))


def linked(text, folder, docs):
    """The text with its links as seen from `docs`, where it stood in `folder`."""

    def target(match):
        words, path = match.groups()
        place = (folder / path.split("#")[0]).resolve()
        if re.match(r"[a-z]+:|#", path):
            return match.group(0)
        if not place.exists():
            raise FileNotFoundError(f"{folder}: a link to {path}, which does not exist")
        seen = os.path.relpath(place, docs)
        if words.startswith("!") or (place.suffix == ".md" and place.is_relative_to(docs)):
            return f"{words}({seen}{path[len(path.split('#')[0]):]})"
        if place.name == "README.md" and place.is_relative_to(verification):
            anchor = "" if place.parent == verification else "#" + slug_of(place.read_text())
            return f"{words}(verification.md{anchor})"
        plain = words[1:-1].replace("`", "")
        if place.is_dir():
            return f"{plain} (`{place.relative_to(root)}`)"
        return f"{{download}}`{plain} <{seen}>`"

    return link.sub(target, text)


def page_of_paper(text, bib):
    """The paper, in the form of the Journal of Open Source Software, as a page: its title is the
    heading, its citations lead to the references of paper.bib."""
    header, text = re.match(r"---\n(.*?)\n---\n(.*)", text, re.S).groups()
    title = re.search(r"^title: '(.*)'$", header, re.M).group(1)
    works = {key: dict(re.findall(r"^  (\w+) = \{(.*)\},?$", fields, re.M))
             for key, fields in re.findall(r"^@\w+\{(\w+),\n(.*?)\n\}$", bib, re.M | re.S)}

    def cited(match):
        keys = re.findall(r"@(\w+)", match.group(0))
        return "(" + ", ".join(
            f"[{re.match('[A-Za-z]+', key).group()} {works[key]['year']}](#references)"
            for key in keys) + ")"

    def reference(work):
        venue = next(work[key] for key in ("journal", "booktitle", "publisher", "howpublished")
                     if key in work)
        place = " ".join([venue, *(work[key] for key in ("volume",) if "journal" in work)])
        pages = f", {work['pages']}" if "pages" in work else ""
        doi = f", <https://doi.org/{work['doi']}>" if "doi" in work else ""
        authors = work["author"].replace(" and ", "; ")
        return re.sub(
            r"[{}]", "",
            f"- {authors}: *{work['title']}*. {place}{pages} ({work['year']}){doi}").replace(
                "--", "-")

    text = re.sub(r"\[@\w+(; @\w+)*\]", cited, re.sub("^#", "##", text, flags=re.M))
    return f"# {title}\n\n{text}\n" + "\n".join(map(reference, works.values())) + "\n"


def source_of(app, docname, source):
    docs = pathlib.Path(app.srcdir)
    if docname == "paper":
        source[0] = page_of_paper(source[0], (docs / "paper.bib").read_text(encoding="utf-8"))
    if docname != "verification":
        source[0] = linked(source[0], (docs / docname).parent, docs)
        return
    parts = [linked((verification / "README.md").read_text(), verification, docs)]
    for readme in sorted(verification.glob("*/README.md")):
        below = re.sub(r"^(#+ )", r"#\1", readme.read_text(), flags=re.MULTILINE)
        parts.append(linked(below, readme.parent, docs))
    source[0] = "\n\n".join(parts)


def setup(app):
    app.connect("source-read", source_of)
