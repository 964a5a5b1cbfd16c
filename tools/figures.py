#!/usr/bin/env python3
"""Draws the figures of a run: tools/figures.py RESULT_DIR [-o DIR] [--volume-loss 5 10 20].

What a result does not hold is skipped with a line saying why. Dataset names: io/FORMAT.md.
"""

import argparse
import sys
from pathlib import Path

from voussoir_plots import convergence, fields, reaction, stresses, troughs
from voussoir_plots.result import Missing, Result
from voussoir_plots.style import use_style

FIGURES = [
    ("settlement_troughs.png", troughs.draw),
    ("displacement.png", fields.draw_displacement),
    ("deviatoric_strain.png", fields.draw_deviatoric_strain),
    ("void_ratio.png", fields.draw_void_ratio),
    ("grain_rotation.png", fields.draw_grain_rotation),
    ("ground_reaction.png", reaction.draw),
    ("geostatic_stress.png", stresses.draw),
    ("convergence.png", convergence.draw),
]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=Path, help="folder of a run")
    parser.add_argument("-o", "--output", type=Path, help="folder for the figures; default: the run's own")
    parser.add_argument("--volume-loss", type=float, nargs="+", metavar="PERCENT",
                        help="volume losses of the troughs; default: quarters of the largest one")
    arguments = parser.parse_args()
    output = arguments.output or arguments.result
    use_style()
    try:
        result = Result(arguments.result, arguments.volume_loss)
    except (OSError, Missing) as reason:
        print(f"{arguments.result}: no readable result: {reason}", file=sys.stderr)
        return 2
    output.mkdir(parents=True, exist_ok=True)
    for name, draw in FIGURES:
        try:
            draw(result, output / name)
        except Missing as reason:
            print(f"skipped {name}: {reason}")
        else:
            print(f"wrote {output / name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
