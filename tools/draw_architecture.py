#!/usr/bin/env python3
"""Draws docs/architecture.svg from the include table and the includes: tools/draw_architecture.py [--check]

A box is a room, that is a sub-folder of host or kernels, or the whole of fem and io. The rows are the levels of the
table ROOMS in tools/check_includes.py; an arrow points from a room to one that its files include. Arrows that follow
from others are left out, and the arrows between two folders are drawn as one. An arrow in red points upwards or
sideways, which the table does not allow. --check only compares the picture with the file, so that a test can
notice an old picture.
"""

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path

from check_includes import ROOMS
from include_graph import FOLDERS, quotient, read_graph, reduced, room_of

ROOT = Path(__file__).resolve().parent.parent
FILE = ROOT / "docs/architecture.svg"
BOX_WIDTH, BOX_HEIGHT, ROW, GAP, MARGIN = 118, 28, 58, 22, 26
HEAD = 30  # height of a folder's title
FILL = {"host": "#fdf3e1", "kernels": "#e4effa", "fem": "#e6f4e6", "io": "#f3e8f6"}
TOP = {"host": "main", "kernels": "advance_rves", "fem": "one room", "io": "one room"}  # the files at the top

PREAMBLE = """\
<title>Folders, rooms, and who includes whom; made by tools/draw_architecture.py</title>
<style>.folder{font-weight:bold;font-size:16px}.level{fill:#888;font-size:12px}</style>
<defs><marker id="head" viewBox="0 0 8 8" refX="6" refY="4" markerWidth="7" markerHeight="7" orient="auto"
 markerUnits="userSpaceOnUse"><path d="M0,0 L8,4 L0,8 z" fill="#444"/></marker></defs>"""

Graph = Mapping[str, set[str]]
Places = dict[str, tuple[float, float]]  # middle of each box


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


def size_of(rows: list[list[str]]) -> tuple[float, float]:
    widest = max(len(row) for row in rows)
    return widest * (BOX_WIDTH + GAP) - GAP + 2 * MARGIN, HEAD + len(rows) * ROW + MARGIN - (ROW - BOX_HEIGHT)


def place(rows: list[list[str]], left: float, top: float, width: float) -> Places:
    """Boxes of a folder, the highest row on top; a row is shifted sideways so that arrows pass between boxes."""
    places: Places = {}
    for level, row in enumerate(reversed(rows)):
        used = len(row) * (BOX_WIDTH + GAP) - GAP
        start = left + (width - used) / 2 + BOX_WIDTH / 2
        for k, room in enumerate(row):
            places[room] = (start + k * (BOX_WIDTH + GAP), top + HEAD + level * ROW + BOX_HEIGHT / 2)
    return places


def arrow(begin: tuple[float, float], end: tuple[float, float], colour: str, width: float = 1.2) -> str:
    """An arrow from the lower edge of a box to the upper edge of another; it is bent around boxes between them."""
    (x1, y1), (x2, y2) = begin, end
    y1, y2 = y1 + BOX_HEIGHT / 2, y2 - BOX_HEIGHT / 2
    rows = round((y2 - y1 + BOX_HEIGHT) / ROW)
    aside = 0.0 if rows < 2 or abs(x2 - x1) > BOX_WIDTH / 2 else (BOX_WIDTH / 2 + GAP) * (1 if x1 >= x2 else -1)
    bend = max(12.0, 0.4 * (y2 - y1))
    path = (
        f"M{x1:.0f},{y1:.0f} C{x1 + aside:.0f},{y1 + bend:.0f} {x2 + aside:.0f},{y2 - bend:.0f} {x2:.0f},{y2 - 3:.0f}"
    )
    return f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width:g}" marker-end="url(#head)"/>'


def arrows(graph: Graph, places: Places) -> list[str]:
    def is_down(room: str, other: str) -> bool:
        return places[room][1] < places[other][1]

    down = {room: {other for other in others if is_down(room, other)} for room, others in graph.items()}
    wrong = [(room, other) for room, others in graph.items() for other in sorted(others) if not is_down(room, other)]
    drawn = [arrow(places[a], places[b], "#444") for a, others in reduced(down).items() for b in sorted(others)]
    return drawn + [arrow(places[a], places[b], "#c00") for a, b in wrong]


def folder_box(folder: str, left: float, top: float, width: float, height: float) -> list[str]:
    return [
        f'<rect x="{left:.0f}" y="{top:.0f}" width="{width:.0f}" height="{height:.0f}" rx="6" fill="{FILL[folder]}"/>',
        f'<text x="{left + 12:.0f}" y="{top + 20:.0f}" class="folder">{folder}</text>',
    ]


def room_boxes(places: Places) -> list[str]:
    drawn = []
    for room, (x, y) in sorted(places.items()):
        name = TOP.get(room, room.rsplit("/", maxsplit=1)[-1])
        drawn.append(
            f'<rect x="{x - BOX_WIDTH / 2:.0f}" y="{y - BOX_HEIGHT / 2:.0f}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" '
            'rx="4" fill="white" stroke="#444"/>'
        )
        drawn.append(f'<text x="{x:.0f}" y="{y + 4.5:.0f}" text-anchor="middle">{name}</text>')
    return drawn


def level_numbers(rows: list[list[str]], left: float, top: float) -> list[str]:
    x, y = left + 12, top + HEAD + BOX_HEIGHT / 2 + 4.5
    return [f'<text x="{x:.0f}" y="{y + k * ROW:.0f}" class="level">{len(rows) - k}</text>' for k in range(len(rows))]


def picture() -> str:
    rooms = {folder: rooms_of(folder) for folder in FOLDERS}
    rows = {folder: rows_of(folder, graph) for folder, graph in rooms.items()}
    sizes = {folder: size_of(r) for folder, r in rows.items()}
    below = ("kernels", "fem", "io")
    width = max(sizes["host"][0], sum(sizes[f][0] for f in below) + 2 * GAP)
    top = {"host": 0.0} | dict.fromkeys(below, sizes["host"][1] + 50)
    left, spare = {"host": 0.0}, (width - sum(sizes[f][0] for f in below)) / 2
    for k, folder in enumerate(below):
        left[folder] = sum(sizes[f][0] for f in below[:k]) + k * spare
    sizes["host"] = (width, sizes["host"][1])
    boxes: list[str] = []
    inside: list[str] = []
    for folder, graph in rooms.items():
        boxes += folder_box(folder, left[folder], top[folder], *sizes[folder])
        places = place(rows[folder], left[folder], top[folder], sizes[folder][0])
        inside += arrows(graph, places) + room_boxes(places)
        if len(rows[folder]) > 1:
            inside += level_numbers(rows[folder], left[folder], top[folder])
    whole = read_graph(ROOT)
    for folder in sorted(quotient(whole, {path: path.split("/")[0] for path in whole})["host"]):
        middle = left[folder] + sizes[folder][0] / 2
        boxes.append(
            f'<path d="M{middle:.0f},{sizes["host"][1]:.0f} V{top[folder] - 4:.0f}" stroke="#444" stroke-width="3" '
            'marker-end="url(#head)"/>'
        )
    height = max(top[f] + sizes[f][1] for f in FOLDERS)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-4 -4 {width + 8:.0f} {height + 8:.0f}" '
        'font-family="sans-serif" font-size="14" fill="#222">'
    )
    return "\n".join([head, PREAMBLE, *boxes, *inside, "</svg>", ""])


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
