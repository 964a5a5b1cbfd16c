"""Draws the pictures of docs/validation from output of the program, and prints the numbers that the pages state."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import matplotlib.pyplot as plt
from voussoir.errors import Error
from voussoir.figures import output, style

from validation_figures import (
    both_halves,
    budget,
    elastic_ground,
    ground_reaction,
    lattice,
    scenes,
    trapdoor_bands,
    yade_test,
)
from validation_figures.program import ROOT, Program

FIGURES: dict[str, Callable[[Program, Path], list[str]]] = {
    "closed_forms_ground": elastic_ground.draw,
    "closed_forms_lattice": lattice.draw,
    "yade_biaxial": yade_test.draw,
    "error_budget": budget.draw,
    "scenes": scenes.draw,
    "scenes_trapdoor": ground_reaction.draw,
    "scenes_trapdoor_bands": trapdoor_bands.draw,
    "scenes_full_tunnel": both_halves.draw,
}


def arguments(words: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/validation", description=__doc__)
    parser.add_argument("figure", nargs="*", choices=[[], *FIGURES], help=f"one or more of {', '.join(FIGURES)}; all")
    parser.add_argument("--program", type=Path, default=ROOT / "build/openmp/host/voussoir")
    parser.add_argument("--runs", type=Path, default=Path("out/validation"), help="the folder of the program's runs")
    parser.add_argument("-o", "--output", type=Path, default=Path("out/validation"), help="the folder of the pictures")
    return parser.parse_args(words)


def main(words: list[str] | None = None) -> int:
    given = arguments(words)
    program = Program(given.program, given.runs)
    style.use_style()
    plt.rcParams["savefig.dpi"] = 100  # the pictures are kept with the documents
    try:
        output.make_folder(given.output)
        for name in given.figure or FIGURES:
            for line in FIGURES[name](program, given.output / f"{name}.png"):
                output.say(f"{name}: {line}")
    except Error as reason:
        output.say(f"tools/validation: {reason}", error=True)
        return 2
    except output.CannotWrite as reason:
        output.say(f"tools/validation: {reason}", error=True)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
