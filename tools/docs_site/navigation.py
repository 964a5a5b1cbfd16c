"""The order of the pages: sections of docs in a fixed order, pages in the order in which the section's README.md links
them, at last the Markdown files of the sources by folder."""

import posixpath
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from docs_site.document import Document
from docs_site.tree import LinkError, is_external, target_of

HOME = "docs/README.md"
SECTIONS = ("tutorial", "how-to", "reference", "explanation", "validation", "measurements")
SOURCES = "Sources"  # the section of all files outside docs

Item = str | dict[str, Any]  # an entry of what MkDocs calls nav: a page, or a title with a page or a list of entries


def _linked(root: Path, document: Document) -> list[str]:
    """The files that a page links, each once, in order."""
    found: dict[str, None] = {}
    for link in document.links:
        if not is_external(link.href):
            try:
                found[target_of(root, document.path, link.href).path] = None
            except LinkError:
                continue  # told where links are checked
    return list(found)


def _section(root: Path, documents: Mapping[str, Document], name: str, problems: list[str]) -> list[Item]:
    folder = f"docs/{name}"
    index = f"{folder}/README.md"
    pages = [path for path in documents if path.startswith(f"{folder}/") and path != index]
    if index not in documents:
        problems.append(f"{index}: the index of its section is missing")
        return [*pages]
    order = [path for path in _linked(root, documents[index]) if path in pages]
    left = [path for path in pages if path not in order]
    problems += [f"{index}: does not link the page {posixpath.relpath(path, folder)} of its section" for path in left]
    return [index, *order, *left]


def _sources(paths: Sequence[str], folder: str) -> list[Item]:
    """The Markdown files below a folder of the sources: its README, other pages, then its folders."""
    inside = [path for path in paths if posixpath.dirname(path) == folder]
    items: list[Item] = [*sorted(inside, key=lambda path: (not path.endswith("README.md"), path))]
    prefix = f"{folder}/" if folder else ""
    for name in sorted({path[len(prefix) :].split("/")[0] for path in paths if "/" in path[len(prefix) :]}):
        below = [path for path in paths if path.startswith(f"{prefix}{name}/")]
        pages = _sources(below, f"{prefix}{name}")
        items.append({name: pages[0] if pages == [f"{prefix}{name}/README.md"] else pages})
    return items


def navigation(root: Path, documents: Mapping[str, Document], problems: list[str]) -> list[Item]:
    """The navigation; a page of docs that no README.md links is a problem, and so is an unknown folder of docs."""
    items: list[Item] = [{"Home": HOME}]
    for path in documents:
        folder = path.removeprefix("docs/").split("/")[0]
        if path.startswith("docs/") and path != HOME and folder not in SECTIONS:
            problems.append(f"{path}: the folder is no section of the navigation ({', '.join(SECTIONS)})")
    for name in SECTIONS:
        index = documents.get(f"docs/{name}/README.md")
        title = index.title if index else name.capitalize()
        if pages := _section(root, documents, name, problems):
            items.append({title: pages})
    if sources := _sources([path for path in documents if not path.startswith("docs/")], ""):
        items.append({SOURCES: sources})
    return items
