"""Tables and figures of what moves three trends of the study: the recovery of the ground reaction, the contraction of
Ac, and the shape of the troughs. Writes sensitivity.md and three figures."""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import matplotlib.pyplot as plt
from voussoir.figures import output, style
from voussoir.figures.result import Missing

from sensitivity_study import figures, place_figure, runs, strength, tables

ROOT = Path(__file__).resolve().parent.parent.parent
LOW_PRESSURE, HIGH_PRESSURE = 20e3, 100e3  # of the biaxial tests [Pa]


def arguments(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/sensitivity", description=__doc__)
    parser.add_argument("folder", type=Path, nargs="?", help="folder of the sweep; none: runs at full size alone")
    parser.add_argument("--sweep", type=Path, default=ROOT / "cases/study/sensitivity.toml", help="its sweep file")
    parser.add_argument("--full", type=Path, nargs="+", default=[], metavar="RUN", help="runs of the whole tunnel")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/sensitivity_tables"))
    given = parser.parse_args(words)
    if given.folder is None and not given.full:
        parser.error("give the folder of a sweep, or --full")
    return given


def strengths(folder: Path, found: list[runs.Variation], pressure: float) -> dict[str, strength.Strength]:
    """The strength of the soil of each variation that has tests; tests that cannot be read are named and left out."""
    soils = {}
    for variation in found:
        try:
            if soil := strength.of_point(folder, variation.name, pressure):
                soils[variation.name] = soil
        except Missing as reason:
            output.say(f"left out: {reason}", error=True)
    return soils


def work(given: argparse.Namespace) -> None:
    found = [] if given.folder is None else list(runs.variations(given.folder, given.sweep))
    full = runs.at_full_size(given.full)
    if not found and not full.runs:
        raise runs.Fault(f"{given.folder or given.full[0]}: no run has come to V_l = 20 %")
    output.make_folder(given.output)
    style.use_style()
    plt.rcParams["savefig.dpi"] = 100  # the figures are kept with the documents
    soils, higher = (strengths(given.folder, found, pressure) for pressure in (LOW_PRESSURE, HIGH_PRESSURE))
    output.write(given.output / "sensitivity.md", tables.document(found, full) + tables.strengths(found, soils, higher))
    if found:
        rows = [*found, full] if full.runs else found
        figures.variations(rows, given.output / "unseen_trends_settings.png")
        figures.reaction(found, soils, given.output / "unseen_trends_reaction.png")
    if full.runs:
        place_figure.draw(full.runs, given.output / "unseen_trends_places.png")
    output.say(f"wrote {given.output}/sensitivity.md: {len(found)} variations, {len(full.runs)} runs at full size")


def main(words: list[str] | None = None) -> int:
    try:
        work(arguments(words))
    except (runs.Fault, Missing) as reason:
        output.say(f"tools/sensitivity: {reason}", error=True)
        return 2
    except output.CannotWrite as reason:
        output.say(f"tools/sensitivity: {reason}", error=True)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
