"""Puts a page together: parts as HTML, with the style and the scripts of `resources` inside."""

import html
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .pictures import Picture

RESOURCES = Path(__file__).parent / "resources"
SCRIPTS = ("blobs.js", "ground.js", "ground_draw.js", "charts.js", "points.js", "sweep.js", "main.js")  # in this order


def text(words: object) -> str:
    return html.escape(str(words))


def table(head: Sequence[str], rows: Iterable[Sequence[object]], of: str = "") -> str:
    """A table; a cell is text, or HTML where it begins with "<"."""

    def cell(value: object) -> str:
        return f"<td>{value if str(value).startswith('<') else text(value)}</td>"

    first = f"<tr>{''.join(f'<th>{text(name)}</th>' for name in head)}</tr>" if head else ""
    body = "".join(f"<tr>{''.join(cell(value) for value in row)}</tr>" for row in rows)
    return f'<div class="scroll"><table class="{of}">{first}{body}</table></div>'


def paragraphs(lines: Iterable[str], of: str = "") -> str:
    return "".join(f'<p class="{of}">{text(line)}</p>' for line in lines)


def folded(title: str, content: str) -> str:
    return f"<details><summary>{text(title)}</summary>{content}</details>"


def markdown(source: str) -> str:
    """The tables and lines of a Markdown text that our tools have written; emphasis is dropped."""
    parts: list[str] = []
    rows: list[list[str]] = []

    def close() -> None:
        if rows:
            parts.append(table(rows[0], rows[1:]))
            rows.clear()

    for line in source.replace("**", "").splitlines():
        if line.startswith("|"):
            cells = [cell.strip() for cell in line.strip("|").split("|")]
            if not all(set(cell) <= set("-: ") for cell in cells):
                rows.append(cells)
            continue
        close()
        if line.strip() and not line.startswith("# "):
            parts.append(paragraphs([line.lstrip("# ")]))
    close()
    return "".join(parts)


def figure(picture: Picture) -> str:
    """A picture with the study's number, what it shows and how it compares. A click makes it large."""
    width, height = picture.size
    name = picture.name.replace("_", " ")
    about = f"<b>{text(picture.number)}</b> {text(picture.what or name)}" if picture.number else f"<b>{text(name)}</b>"
    sentence = f" {text(picture.text)}" if picture.text else ""
    return (
        f'<figure id="figure-{text(picture.name)}"><img src="{picture.uri}" width="{width}" height="{height}" '
        f'alt="{text(name)}" title="click: large or small" loading="lazy">'
        f"<figcaption>{about}{sentence}</figcaption></figure>"
    )


@dataclass
class Page:
    """The parts of a page in their order, and the data of its scripts."""

    title: str
    subtitle: str = ""
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)  # below the warnings, without alarm
    sections: list[tuple[str, str]] = field(default_factory=list)  # title, HTML
    data: dict[str, Any] = field(default_factory=dict)

    def add(self, title: str, content: str) -> None:
        if content:
            self.sections.append((title, content))

    def chart(self, spec: dict[str, Any]) -> str:
        """Takes a chart into the page's data; returns its place in the HTML."""
        charts = self.data.setdefault("charts", [])
        charts.append(spec)
        return f'<div class="chart" data-chart="{len(charts) - 1}"></div>'

    def written(self) -> str:
        """The whole file."""
        style = (RESOURCES / "page.css").read_text()
        scripts = "\n".join((RESOURCES / name).read_text().replace('"use strict";\n', "") for name in SCRIPTS)
        data = json.dumps(self.data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
        links = "".join(f'<a href="#part-{k}">{text(title)}</a>' for k, (title, _) in enumerate(self.sections))
        parts = "".join(
            f'<section id="part-{k}"><h2>{text(title)}</h2>{content}</section>'
            for k, (title, content) in enumerate(self.sections)
        )
        alarm = f'<div class="warnings">{paragraphs(self.warnings)}</div>' if self.warnings else ""
        return (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            '<link rel="icon" href="data:,">'  # else a browser asks a server for one
            f"<title>{text(self.title)}</title><style>{style}</style></head><body>"
            f'<header><h1>{text(self.title)}</h1><p>{text(self.subtitle)}</p></header><div id="failed"></div>{alarm}'
            f"{paragraphs(self.notes, 'note')}<nav>{links}</nav><main>{parts}</main>"
            f'<script type="application/json" id="data">{data}</script>\n<script>\n"use strict";\n{scripts}\n</script>'
            "</body></html>\n"
        )
