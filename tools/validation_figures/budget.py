"""The error budget as bars, from the numbers of error_budget.csv."""

import csv
from pathlib import Path

import matplotlib.pyplot as plt
from voussoir.figures.style import CYCLE, save

from .program import Program

DATA = Path(__file__).with_name("error_budget.csv")
KINDS = {
    "draw": ("standard deviation between draws, 95 % interval", CYCLE[0], ""),
    "remade": ("change, with other packings or places: holds their scatter", CYCLE[1], "//"),
    "change": ("change with the same packings at the same places", CYCLE[2], ""),
}


def rows() -> list[dict[str, str]]:
    with DATA.open() as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def draw(_: Program, path: Path) -> list[str]:
    found = rows()
    figure, axis = plt.subplots(figsize=(9.5, 6.6))
    for y, row in enumerate(found):
        value, low, high = (float(row[name]) for name in ("value", "low", "high"))
        colour, hatch = KINDS[row["kind"]][1:]
        axis.barh(y, value, color=colour, hatch=hatch, edgecolor="white", height=0.7)
        axis.plot([low, high], [y, y], color="black", linewidth=1.3)
        axis.plot([low, high], [y, y], "|", color="black", markersize=7)
    for label, colour, hatch in KINDS.values():
        axis.barh(0, 0, color=colour, hatch=hatch, edgecolor="white", label=label)
    axis.plot([], [], color="black", label="interval (draws), one standard error (changes)")
    axis.set_yticks(range(len(found)), [row["source"] for row in found])
    axis.set_ylim(len(found) - 0.4, -0.6)
    axis.axvline(0, color="0.3", linewidth=0.8)
    axis.set_xlabel("settlement of the surface at $V_l$ = 10 % [%]")
    axis.set_title("cases/tunnel_quick: what moves the settlement")
    axis.legend(loc="upper center", bbox_to_anchor=(0.4, -0.11), ncols=2, fontsize=8.5)
    figure.tight_layout()
    save(figure, path)
    return [f"{row['source']}: {row['value']} ({row['low']} to {row['high']}) %" for row in found]
