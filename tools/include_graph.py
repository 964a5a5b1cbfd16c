"""The graph of includes in a tree of sources. Tools use it to draw the tree, to measure it and to choose files to
check."""

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

FOLDERS = ("kernels", "fem", "io", "host")
SUFFIXES = (".hpp", ".cpp")
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def included_by(path: Path) -> list[str]:
    """The headers that a file includes in quotation marks: our own ones, written from the root."""
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def read_graph(root: Path, folders: Iterable[str] = FOLDERS) -> dict[str, set[str]]:
    """{source file: our own files that it includes}, both written from the root."""
    files = {p.relative_to(root).as_posix(): p for f in folders for p in (root / f).rglob("*") if p.suffix in SUFFIXES}
    return {name: {h for h in included_by(path) if h in files} for name, path in sorted(files.items())}


def unit_of(path: str) -> str:
    """A header and its source are one unit."""
    return path.rsplit(".", 1)[0]


def room_of(path: str) -> str:
    """The sub-folder of host or kernels that a file lives in; the folder itself elsewhere and at its top."""
    parts = path.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def quotient(graph: Mapping[str, set[str]], part_of: Mapping[str, str]) -> dict[str, set[str]]:
    """The graph between parts, without the includes inside a part."""
    parts: dict[str, set[str]] = {part: set() for part in sorted(set(part_of.values()))}
    for path, headers in graph.items():
        parts[part_of[path]] |= {part_of[header] for header in headers}
    return {part: others - {part} for part, others in parts.items()}


def levels(graph: Mapping[str, set[str]]) -> dict[str, int]:
    """The level of each part: one more than the highest level that it includes; 0 where it includes no part.

    Parts that include one another, directly or through others, stand on one level.
    """
    group = cycles(graph)
    found: dict[str, int] = {}

    def level(part: str) -> int:
        if part not in found:
            members = group[part]
            below = {other for member in members for other in graph[member]} - members
            height = max((level(other) + 1 for other in below), default=0)
            for member in members:
                found[member] = height
        return found[part]

    for part in graph:
        level(part)
    return found


def reachable(graph: Mapping[str, set[str]], start: str) -> set[str]:
    """All parts that a part includes, directly or through others; the part itself only when it is in a circle."""
    seen: set[str] = set()
    waiting = list(graph[start])
    while waiting:
        part = waiting.pop()
        if part not in seen:
            seen.add(part)
            waiting += graph[part]
    return seen


def cycles(graph: Mapping[str, set[str]]) -> dict[str, set[str]]:
    """{part: the parts that it includes and that also include it, and the part itself}."""
    below = {part: reachable(graph, part) for part in graph}
    return {part: {part, *(other for other in below[part] if part in below[other])} for part in graph}


def reduced(graph: Mapping[str, set[str]]) -> dict[str, set[str]]:
    """The graph without the arrows that follow from others. The graph must have no circles."""
    return {
        part: {other for other in others if not any(other in reachable(graph, via) for via in others - {other})}
        for part, others in graph.items()
    }
