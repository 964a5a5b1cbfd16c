#!/usr/bin/env python3
"""Draws docs/explanation/architecture.svg from the include table and the includes: tools/draw_architecture.py [--check]

A box is a room, that is a sub-folder of host or kernels, or the whole of fem and io. The rows are the levels of the
table ROOMS in tools/check_includes.py; an arrow points from a room to one that its files include. Arrows that follow
from others are left out, except those of KEPT, and the arrows between two folders are drawn as one. An arrow to the
next level goes straight; a longer one runs beside the boxes in a lane of its own and ends at the side of its target. An
arrow in red points upwards or sideways, which the table does not allow. The texts beside the rooms of host are those of
the table in docs/explanation/architecture.md. --check only compares the picture with the file, so that a test can
notice an old picture.
"""

import argparse
import re
import sys
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.sax.saxutils import escape

from check_includes import ROOMS
from include_graph import FOLDERS, quotient, read_graph, reduced, room_of

ROOT = Path(__file__).resolve().parent.parent
FILE = ROOT / "docs/explanation/architecture.svg"
PAGE = ROOT / "docs/explanation/architecture.md"
BOX_WIDTH, BOX_HEIGHT, ROW, GAP, MARGIN = 144, 28, 58, 22, 34
HEAD = 30  # height of a folder's title
LANE = 16  # distance of two long arrows that run side by side
TEXT_COLUMNS, TEXT_WIDTH = 84, 540  # of the texts beside the rooms of host: characters of a line, and its width
BELOW = ("kernels", "fem", "io")  # the folders that host joins
FILL = {"host": "#fdf3e1", "kernels": "#e4effa", "fem": "#e6f4e6", "io": "#f3e8f6"}
TOP = {"host": "main", "kernels": "advance_rves", "fem": "mesh, Q8, Newton", "io": "cases, results"}  # files at the top
# Arrows that follow from others but say what a room does: the program starts the stages and the tests of elements.
KEPT = {"host/program": {"host/stages", "host/element_tests"}}

LEGEND = (
    "An arrow points to what is included. Numbers are levels within a folder; a room may include all levels below it,",
    "and most arrows that follow from others are left out.",
)
PREAMBLE = """\
<title>Folders, rooms, and who includes whom; made by tools/draw_architecture.py</title>
<style>.folder{font-weight:bold;font-size:16px}.small{fill:#666;font-size:12px}</style>
<defs><marker id="head" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="7" markerHeight="7" orient="auto"
 markerUnits="userSpaceOnUse"><path d="M0,0 L8,4 L0,8 z" fill="#444"/></marker></defs>"""

Graph = Mapping[str, set[str]]
Arrow = tuple[str, str]  # from a room to a room


def rooms_of(folder: str) -> dict[str, set[str]]:
    """The rooms of a folder, and for each room the other rooms that it includes."""
    graph = read_graph(ROOT, [folder])
    return quotient(graph, {path: room_of(path) for path in graph})


def rows_of(folder: str, graph: Graph) -> list[list[str]]:
    """Rooms by level, the ground first and the folder's own files last; a row is ordered by where its arrows lead."""
    table = [[f"{folder}/{room}" for room in level] for level in ROOMS.get(folder, ())]
    rows = [[room for room in level if room in graph] for level in [*table, [folder]]]
    rows = [row for row in rows if row]
    order = {room: (k + 0.5) / len(row) for row in rows for k, room in enumerate(row)}
    for row in rows[1:]:
        middle = {room: sum(order[o] for o in graph[room]) / max(1, len(graph[room])) for room in row}
        row.sort(key=lambda room: (middle[room], room))
        order |= {room: (k + 0.5) / len(row) for k, room in enumerate(row)}
    return rows


@dataclass
class Folder:
    """The boxes of one folder and the arrows between them, in a drawing whose middle column is x = 0."""

    name: str
    graph: Graph
    rows: list[list[str]]
    short: list[Arrow] = field(default_factory=list)  # to the next level
    lanes: dict[int, list[Arrow]] = field(default_factory=lambda: {-1: [], 1: []})  # long arrows: left and right
    wrong: list[Arrow] = field(default_factory=list)  # upwards or sideways

    def level(self, room: str) -> int:
        return next(level for level, row in enumerate(self.rows) if room in row)

    def place(self, room: str) -> tuple[float, float]:
        """The middle of a box."""
        level = self.level(room)
        row = self.rows[level]
        x = (row.index(room) - (len(row) - 1) / 2) * (BOX_WIDTH + GAP)
        return x, HEAD + (len(self.rows) - 1 - level) * ROW + BOX_HEIGHT / 2

    def side(self, room: str) -> int:
        """-1 for a room that stands on the left of its row, 1 on the right, 0 in the middle."""
        x, _ = self.place(room)
        return (x > 0) - (x < 0)

    def half_width(self) -> float:
        """Of the boxes alone."""
        return (max(len(row) for row in self.rows) * (BOX_WIDTH + GAP) - GAP) / 2

    def extent(self, side: int) -> float:
        """The distance from the middle to the folder's edge."""
        return self.half_width() + MARGIN + LANE * len(self.lanes[side])

    def height(self) -> float:
        return HEAD + len(self.rows) * ROW + MARGIN - (ROW - BOX_HEIGHT)


def folder_of(name: str) -> Folder:
    graph = rooms_of(name)
    folder = Folder(name, graph, rows_of(name, graph))
    arrows = [(a, b) for a, others in graph.items() for b in sorted(others)]
    folder.wrong = [(a, b) for a, b in arrows if folder.level(b) >= folder.level(a)]
    right = {a: {b for b in others if (a, b) not in folder.wrong} for a, others in graph.items()}
    drawn = [(a, b) for a, others in reduced(right).items() for b in sorted(others | (KEPT.get(a, set()) & right[a]))]
    folder.short = [(a, b) for a, b in drawn if folder.level(a) - folder.level(b) == 1]
    long = sorted((folder.level(a) - folder.level(b), a, b) for a, b in drawn if (a, b) not in folder.short)
    for _, a, b in long:
        side = folder.side(b) or folder.side(a) or (1 if len(folder.lanes[1]) < len(folder.lanes[-1]) else -1)
        folder.lanes[side].append((a, b))
    return folder


def spread(ends: list[str], own: str, length: float) -> float:
    """Where on an edge of this length, seen from its middle, the end called `own` of several ends stands."""
    return length * ((ends.index(own) + 1) / (len(ends) + 1) - 0.5)


def line(path: str, colour: str = "#444", width: float = 1.2) -> str:
    return f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width:g}" marker-end="url(#head)"/>'


def short_arrow(folder: Folder, arrow: Arrow, left: float, top: float) -> str:
    """Straight from the lower edge of a box to the upper edge of another; each end has a place of its own."""
    a, b = arrow

    def by_x(rooms: list[str]) -> list[str]:
        return sorted(rooms, key=lambda room: folder.place(room)[0])

    (xa, ya), (xb, yb) = folder.place(a), folder.place(b)
    xa += spread(by_x([y for x, y in folder.short if x == a]), b, BOX_WIDTH)
    xb += spread(by_x([x for x, y in folder.short if y == b]), a, BOX_WIDTH)
    ya, yb = ya + BOX_HEIGHT / 2, yb - BOX_HEIGHT / 2 - 2
    return line(f"M{left + xa:.0f},{top + ya:.0f} L{left + xb:.0f},{top + yb:.0f}")


def long_arrow(folder: Folder, side: int, number: int, left: float, top: float) -> str:
    """From the side of a box through a lane beside all boxes to the side of another box."""
    lanes = folder.lanes[side]

    def height(room: str, own: Arrow) -> float:
        ends = sorted(
            (y if x == room else x for x, y in lanes if room in (x, y)), key=lambda other: folder.place(other)[1]
        )
        return folder.place(room)[1] + spread(ends, own[1] if own[0] == room else own[0], BOX_HEIGHT)

    a, b = lanes[number]
    lane = left + side * (folder.half_width() + LANE * (number + 1))
    begin = left + folder.place(a)[0] + side * BOX_WIDTH / 2
    end = left + folder.place(b)[0] + side * (BOX_WIDTH / 2 + 2)
    ya, yb = top + height(a, (a, b)), top + height(b, (a, b))
    return line(f"M{begin:.0f},{ya:.0f} H{lane:.0f} V{yb:.0f} H{end:.0f}")


def wrong_arrow(folder: Folder, arrow: Arrow, left: float, top: float) -> str:
    (xa, ya), (xb, yb) = folder.place(arrow[0]), folder.place(arrow[1])
    return line(f"M{left + xa:.0f},{top + ya:.0f} L{left + xb:.0f},{top + yb:.0f}", "#c00", 2)


def frame(folder: Folder, x: float, y: float, width: float, height: float) -> list[str]:
    return [
        f'<rect x="{x:.0f}" y="{y:.0f}" width="{width:.0f}" height="{height:.0f}" rx="6" fill="{FILL[folder.name]}"/>',
        f'<text x="{x + 12:.0f}" y="{y + 20:.0f}" class="folder">{folder.name}</text>',
    ]


def box(folder: Folder, room: str, left: float, top: float) -> list[str]:
    x, y = folder.place(room)
    name = TOP.get(room, room.rsplit("/", maxsplit=1)[-1])
    corner = f'x="{left + x - BOX_WIDTH / 2:.0f}" y="{top + y - BOX_HEIGHT / 2:.0f}"'
    return [
        f'<rect {corner} width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="4" fill="white" stroke="#444"/>',
        f'<text x="{left + x:.0f}" y="{top + y + 4.5:.0f}" text-anchor="middle">{name}</text>',
    ]


def small(text: str, x: float, y: float) -> str:
    return f'<text x="{x:.0f}" y="{y:.0f}" class="small">{escape(text)}</text>'


def texts(folder: Folder, x: float, top: float) -> list[str]:
    """What the page says of each room, beside its row."""
    said = dict(re.findall(r"^\| `([\w/]+)` \| ([^|]*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE))
    drawn = []
    for row in folder.rows:
        lines: list[str] = []
        for room in row:
            text = said.get(room, "").replace("`", "")
            name = f"{room.rsplit('/', maxsplit=1)[-1]}: " if len(row) > 1 else ""
            lines += textwrap.wrap(name + text, TEXT_COLUMNS) if text else []
        middle = top + folder.place(row[0])[1]
        drawn += [small(t, x, middle + 4.5 + 14 * (k - (len(lines) - 1) / 2)) for k, t in enumerate(lines)]
    return drawn


def inside(folder: Folder, x: float, top: float) -> list[str]:
    """Arrows, boxes and level numbers of a folder whose left edge is x."""
    left = x + folder.extent(-1)
    drawn = [short_arrow(folder, arrow, left, top) for arrow in folder.short]
    drawn += [long_arrow(folder, side, k, left, top) for side in (-1, 1) for k in range(len(folder.lanes[side]))]
    drawn += [text for row in folder.rows for room in row for text in box(folder, room, left, top)]
    drawn += [wrong_arrow(folder, arrow, left, top) for arrow in folder.wrong]
    if len(folder.rows) > 1:
        levels = enumerate(folder.rows, 1)
        drawn += [small(str(level), x + 12, top + folder.place(row[0])[1] + 4.5) for level, row in levels]
    return drawn


def picture() -> str:
    folders = {name: folder_of(name) for name in FOLDERS}
    widths = {name: folder.extent(-1) + folder.extent(1) for name, folder in folders.items()}
    texts_at = widths["host"]
    width = max(widths["host"] + TEXT_WIDTH, sum(widths[f] for f in BELOW) + 2 * GAP)
    widths["host"] = width
    below = folders["host"].height() + 50
    at = {"host": (0.0, 0.0)}
    spare = (width - sum(widths[f] for f in BELOW)) / 2
    for k, name in enumerate(BELOW):
        at[name] = (sum(widths[f] for f in BELOW[:k]) + k * spare, below)
    boxes = [part for f, folder in folders.items() for part in frame(folder, *at[f], widths[f], folder.height())]
    whole = read_graph(ROOT)
    for name in sorted(quotient(whole, {path: path.split("/")[0] for path in whole})["host"]):
        middle = at[name][0] + widths[name] / 2
        boxes.append(line(f"M{middle:.0f},{folders['host'].height():.0f} V{below - 4:.0f}", width=3))
    parts = [part for name, folder in folders.items() for part in inside(folder, *at[name])]
    parts += texts(folders["host"], texts_at, 0)
    bottom = below + max(folders[f].height() for f in BELOW)
    parts += [small(text, 0, bottom + 24 + 16 * k) for k, text in enumerate(LEGEND)]
    size = f"-4 -4 {width + 8:.0f} {bottom + 24 + 16 * len(LEGEND):.0f}"
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{size}" font-family="sans-serif" font-size="14" fill="#222">'
    )
    return "\n".join([head, PREAMBLE, *boxes, *parts, "</svg>", ""])


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only compare with the file")
    given = parser.parse_args()
    drawn = picture()
    if given.check:
        if FILE.exists() and FILE.read_text(encoding="utf-8") == drawn:
            return 0
        print(f"{FILE.relative_to(ROOT)} does not agree with the includes; tools/draw_architecture.py draws it again")
        return 1
    FILE.write_text(drawn, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
