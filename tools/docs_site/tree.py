"""Which files of the checkout become pages or files of the site, and where a link from one file to another leads.

Every Markdown file is a page; any other file becomes a page (text) or a file (pictures, data) when a page links to it.
docs/ lies at the top of the site and all other files below source/, so that every relative link that works in the
repository has a target in the site.
"""

import os
import posixpath
from dataclasses import dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from urllib.parse import unquote, urlsplit

SKIPPED = ("build", "out")  # folders at the top that hold generated files
PICTURES = (".png", ".svg", ".jpg", ".webp", ".gif")


class Kind(Enum):
    MARKDOWN = "a page that Markdown makes"
    TEXT = "a page that shows the text of a file"
    FILE = "a file that is copied"


@dataclass(frozen=True)
class Target:
    """Where a link leads: a path from the root of the checkout (empty for a link that leaves it) and an anchor."""

    path: str
    anchor: str


class LinkError(Exception):
    pass


def markdown_files(root: Path) -> list[str]:
    """All Markdown files of the checkout, by their paths from its root."""
    found = []
    for folder, folders, names in os.walk(root):
        top = Path(folder) == root
        folders[:] = [name for name in folders if not name.startswith(".") and not (top and name in SKIPPED)]
        found += [Path(folder, name).relative_to(root).as_posix() for name in names if name.endswith(".md")]
    return sorted(found)


@cache
def kind_of(file: Path) -> Kind:
    if file.suffix == ".md":
        return Kind.MARKDOWN
    if file.suffix in PICTURES:
        return Kind.FILE
    try:
        file.read_bytes().decode()
    except UnicodeDecodeError:
        return Kind.FILE
    return Kind.TEXT


def place_of(path: str) -> str:
    """Where a copy of a file lies in the site: docs/a/b.png at a/b.png, cases/c.toml at source/cases/c.toml."""
    return path.removeprefix("docs/") if path.startswith("docs/") else f"source/{path}"


def page_of(path: str) -> str:
    """Where the page of a file lies in the site; the README of a folder is the folder's index."""
    place = place_of(path)
    if place.endswith(".md"):
        folder, name = posixpath.split(place)
        return posixpath.join(folder, "index.html" if name == "README.md" else f"{name.removesuffix('.md')}.html")
    return f"{place}.html"


def is_external(href: str) -> bool:
    return bool(urlsplit(href).scheme)


def target_of(root: Path, path: str, href: str) -> Target:
    """The target of a link that stands in the file `path`; a folder means its README."""
    parts = urlsplit(href)
    if not parts.path:
        return Target(path, parts.fragment)
    target = posixpath.normpath(posixpath.join(posixpath.dirname(path), unquote(parts.path)))
    if href.startswith("/"):
        raise LinkError("a link within the repository is relative")
    if target.startswith(".."):
        raise LinkError("the link leaves the repository")
    if not (root / target).exists():
        raise LinkError("there is no such file")
    if (root / target).is_dir():
        target = posixpath.normpath(posixpath.join(target, "README.md"))
        if not (root / target).is_file():
            raise LinkError("the folder has no README.md")
    return Target(target, parts.fragment)
