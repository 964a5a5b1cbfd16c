"""A probe's responses and tangents (probe.csv) and its path (path.csv); columns: docs/reference/files.md."""

from pathlib import Path

import numpy as np

from ..errors import Missing, Unreadable
from ..files import Row, read_rows

COMPONENTS = ("xx", "yy", "xy")
STRAINED = {"xx": ("xx", 1), "yy": ("yy", 1), "xy": ("xy", 1), "-xx": ("xx", -1), "-yy": ("yy", -1)}

LEAST_DIFFERENCE = 0.05  # of the normal stresses, over their sum, by which a rotation is told


class Probe:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.left_out: list[Missing] = []
        stresses = [f"{what}_{c}_Pa" for what in ("stress", "change") for c in COMPONENTS]
        needed = ["seed", "replica", "probe", *stresses, "tangent_xxxx_Pa"]
        self.rows = read_rows(folder / "probe.csv", needed)
        if not self.rows:
            raise Unreadable(f"{folder / 'probe.csv'} has no row")
        self.path: list[Row] = []
        if (folder / "path.csv").exists():
            try:
                self.path = read_rows(
                    folder / "path.csv", ["seed", "replica", "increment", "strain_yy", "stress_yy_Pa"]
                )
            except Missing as reason:
                self.left_out.append(reason)

    def number(self, row: Row, column: str) -> float:
        try:
            return float(row[column])
        except (KeyError, TypeError, ValueError):
            raise Missing(f"{self.folder}: a row of the probe has no number {column}") from None

    def seeds(self) -> list[str]:
        return list(dict.fromkeys(row["seed"] for row in self.rows))

    def change(self, row: Row) -> np.ndarray:
        """Change of the stress (xx, yy, xy) by the probe [Pa], tension positive."""
        return np.array([self.number(row, f"change_{c}_Pa") for c in COMPONENTS])

    def before(self, row: Row) -> np.ndarray:
        """The stress before the probe."""
        return np.array([self.number(row, f"stress_{c}_Pa") for c in COMPONENTS]) - self.change(row)

    def by_tangent(self, row: Row) -> np.ndarray:
        """The same by the tangent before the probe, for a strain of 1; the third strain is gamma_xy. To tangents other
        than `loading` belongs what the strain makes of the stress itself (docs/explanation/tangents.md)."""
        strained, sign = STRAINED[row["probe"]]
        further = 0 if row.get("tangent") == "loading" else carried(self.before(row), strained)
        return sign * (np.array([self._tangent(row, c, strained) for c in COMPONENTS]) + further)

    def _tangent(self, row: Row, stressed: str, strained: str) -> float:
        """tangent_yyxx_Pa is the change of sigma_yy by the strain xx. Static tangents are symmetric, and their files
        may lack the lower half."""
        name, mirrored = f"tangent_{stressed}{strained}_Pa", f"tangent_{strained}{stressed}_Pa"
        return self.number(row, name if row.get(name) else mirrored)

    def strain(self) -> tuple[float, str]:
        """(size of the probes' strain [-], how it was found). No file holds it, but the probe `rotation` turns the
        stress by it: the change of sigma_xy is its size times sigma_xx - sigma_yy. Where these are nearly equal, it is
        the one for which the tangents explain most of the responses (least squares)."""
        turned = []
        for row in self.rows:
            if row["probe"] == "rotation":
                xx, yy, _ = self.before(row)
                if abs(xx - yy) > LEAST_DIFFERENCE * abs(xx + yy):
                    turned.append(self.change(row)[2] / (xx - yy))
        if turned and np.median(turned) > 0:
            return float(np.median(turned)), "by the probe that rotates"
        pairs = [(self.change(row), self.by_tangent(row)) for row in self.rows if row["probe"] in STRAINED]
        pairs = [(a, b) for a, b in pairs if np.isfinite(a).all() and np.isfinite(b).all()]
        below = sum(float(b @ b) for _, b in pairs)
        if not below > 0:
            raise Missing("no probe has a response and a tangent")
        return sum(float(a @ b) for a, b in pairs) / below, "the one that fits the tangents best"

    def path_of(self, seed: str, column: str) -> np.ndarray:
        """A column of the path of a packing's first replica."""
        rows = [row for row in self.path if row["seed"] == seed]
        first = rows[0]["replica"] if rows else ""
        return np.array([self.number(row, column) for row in rows if row["replica"] == first])


def carried(stress: np.ndarray, strained: str) -> np.ndarray:
    """sym(sigma e) - tr(e) sigma as (xx, yy, xy) for a unit strain e: branches follow it, and the volume changes."""
    xx, yy, xy = stress
    sigma = np.array([[xx, xy], [xy, yy]])
    e = {"xx": np.diag([1.0, 0.0]), "yy": np.diag([0.0, 1.0]), "xy": np.array([[0, 0.5], [0.5, 0]])}[strained]
    moved = sigma @ e
    change = (moved + moved.T) / 2 - np.trace(e) * sigma
    return np.array([change[0, 0], change[1, 1], change[0, 1]])
