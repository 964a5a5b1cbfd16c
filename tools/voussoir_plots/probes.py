"""A probe's responses beside its tangents (probe.csv), and its path (path.csv)."""

from pathlib import Path

from .result import Missing


class Probe:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.left_out: list[Missing] = []


def is_probe(folder: Path) -> bool:
    return (folder / "probe.csv").exists()
