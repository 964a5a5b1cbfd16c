"""Checks the built site: every link leads to a file and every anchor to an element, and nothing is asked for from a
network."""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADED = {("script", "src"), ("img", "src"), ("link", "href"), ("iframe", "src"), ("source", "src"), ("use", "href")}
SCHEME = re.compile(r"^(?:[a-z]+:|//)")


class _Page(HTMLParser):
    """The ids of a page and what it refers to: (element, attribute, value)."""

    def __init__(self, file: Path):
        super().__init__()
        self.ids: set[str] = set()
        self.references: list[tuple[str, str, str]] = []
        self.feed(file.read_text())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value and name in ("id", "name"):
                self.ids.add(value)
            elif value and name in ("href", "src"):
                self.references.append((tag, name, value))


def _check_reference(site: Path, file: Path, value: str, pages: dict[Path, _Page]) -> str:
    """What is wrong with a reference within the site, or nothing."""
    parts = urlsplit(value)
    target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
    if not target.is_relative_to(site):
        return "leads out of the site"
    if not target.is_file():
        return "leads to no file"
    if parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].ids:
        return "leads to no element of its page"
    return ""


def check_site(site: Path) -> tuple[list[str], int]:
    """The problems of a built site, and the number of links that were followed."""
    site = site.resolve()
    pages = {file: _Page(file) for file in sorted(site.rglob("*.html"))}
    problems, count = [], 0
    for file, page in pages.items():
        for tag, name, value in page.references:
            wrong = ""
            if not SCHEME.match(value):
                wrong, count = _check_reference(site, file, value, pages), count + 1
            elif (tag, name) in LOADED and not value.startswith("data:"):
                wrong = "is asked for from a network"
            if wrong:
                problems.append(f"{file.relative_to(site)}: <{tag} {name}={value!r}> {wrong}")
    for file in site.rglob("*.css"):
        loaded = re.findall(r"url\(['\"]?((?:https?:)?//[^)'\"]+)", file.read_text())
        problems += [f"{file.relative_to(site)}: {value} is asked for from a network" for value in loaded]
    return problems, count
