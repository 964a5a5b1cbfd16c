#!/usr/bin/env python3
"""Sizes of folders and files, and the depth of the includes: tools/tree_sizes.py [--before REVISION] [--into FILE]

The tables are Markdown. --before adds tables of an earlier revision; --into writes all of them into a page between the
lines `<!-- sizes -->` and `<!-- end of sizes -->`, so that docs/measurements/rooms.md is brought up to date by

    tools/tree_sizes.py --before 902c57a --into docs/measurements/rooms.md
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from include_graph import FOLDERS, cycles, levels, quotient, read_graph, room_of, unit_of

ROOT = Path(__file__).resolve().parent.parent
BEGIN, END = "<!-- sizes -->\n", "<!-- end of sizes -->\n"


def rooms(root: Path) -> list[tuple[str, int, int, int, str]]:
    """(room, units, files, lines, longest file) of all rooms."""
    rows = []
    graph = read_graph(root)
    for room in sorted({room_of(path) for path in graph}):
        files = [path for path in graph if room_of(path) == room]
        lines = {path: len((root / path).read_text(encoding="utf-8").splitlines()) for path in files}
        longest = max(files, key=lambda path: lines[path])
        units = len({unit_of(path) for path in files})
        rows.append((room, units, len(files), sum(lines.values()), f"{Path(longest).name} ({lines[longest]})"))
    return rows


def depth(root: Path, folder: str) -> tuple[int, int, int]:
    """Levels of a folder's units, units that include one another in a circle, and pairs of rooms that do."""
    graph = read_graph(root, [folder])
    units = quotient(graph, {path: unit_of(path) for path in graph})
    between = quotient(graph, {path: room_of(path) for path in graph})
    circles = [sum(len(group) > 1 for group in cycles(g).values()) for g in (units, between)]
    return max(levels(units).values()) + 1, circles[0], circles[1]


def rooms_table(root: Path) -> str:
    text = "| room | units | files | lines | longest file |\n|---|---|---|---|---|\n"
    for room, units, files, lines, longest in rooms(root):
        text += f"| `{room}` | {units} | {files} | {lines} | {longest} |\n"
    return text


def depth_table(before: Path | None, after: Path) -> str:
    text = "| folder | | files in the largest folder | levels of units | units in circles | rooms in circles |\n"
    text += "|---|---|---|---|---|---|\n"
    for folder in FOLDERS:
        for name, root in (("before", before), ("now", after)):
            if root is not None:
                largest = max(files for room, _, files, _, _ in rooms(root) if room.split("/")[0] == folder)
                numbers = " | ".join(str(n) for n in depth(root, folder))
                text += f"| `{folder}` | {name} | {largest} | {numbers} |\n"
    return text


def unpack(revision: str, folder: Path) -> None:
    """The sources of a revision."""
    archive = folder / "sources.tar"
    subprocess.run(["git", "-C", ROOT, "archive", "-o", archive, revision, *FOLDERS], check=True)
    subprocess.run(["tar", "-xf", archive, "-C", folder], check=True)


def report(revision: str | None) -> str:
    text = "A unit is a header and its source. Now:\n\n" + rooms_table(ROOT)
    with tempfile.TemporaryDirectory() as folder:
        before = Path(folder) if revision else None
        if revision and before:
            unpack(revision, before)
            text += f"\nBefore the rooms ({revision}):\n\n" + rooms_table(before)
        text += "\nHow deep the includes go within a folder:\n\n" + depth_table(before, ROOT)
    return text


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--before", metavar="REVISION")
    parser.add_argument("--into", type=Path, metavar="FILE")
    given = parser.parse_args()
    text = report(given.before)
    if not given.into:
        print(text)
        return 0
    page = given.into.read_text(encoding="utf-8")
    if BEGIN not in page or END not in page:
        print(f"{given.into}: has no lines {BEGIN.strip()} and {END.strip()}", file=sys.stderr)
        return 2
    head, rest = page.split(BEGIN)
    given.into.write_text(head + BEGIN + text + END + rest.split(END)[1], encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
