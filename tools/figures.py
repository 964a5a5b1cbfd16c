#!/usr/bin/env python3
"""Draws the figures of a run: tools/figures.py RESULT_DIR [-o DIR] [--only NAME ...] [further options: --help].

A figure whose data are missing is skipped, and a line says why. io/FORMAT.md describes the data sets,
voussoir_plots/README.md the figures.
"""

import argparse
import sys
from pathlib import Path

from voussoir_plots import settings, trend_table
from voussoir_plots.catalogue import FIGURES
from voussoir_plots.result import Missing, Result
from voussoir_plots.style import use_style

TRENDS = {"trends.md": trend_table.write}


def chosen(arguments):
    """The functions that write the wanted files, by the names of the files."""
    if arguments.trends:
        return TRENDS
    everything = {**FIGURES, **TRENDS}
    return {name: draw for name, draw in everything.items() if not arguments.only or Path(name).stem in arguments.only}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=Path, help="folder of a run")
    parser.add_argument("-o", "--output", type=Path, help="folder for the figures; default: the run's own")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="draw only these figures, named without .png")
    parser.add_argument(
        "--trends", action="store_true", help="write only trends.md: the study's trends, each seen or not"
    )
    settings.add_options(parser)
    arguments = parser.parse_args()
    output = arguments.output or arguments.result
    unknown = set(arguments.only or ()) - {Path(name).stem for name in (*FIGURES, *TRENDS)}
    if unknown:
        parser.error(f"there is no figure {', '.join(sorted(unknown))}")
    use_style()
    try:
        result = Result(arguments.result, settings.parse(arguments))
    except (OSError, Missing) as reason:
        print(f"{arguments.result}: no readable result: {reason}", file=sys.stderr)
        return 2
    output.mkdir(parents=True, exist_ok=True)
    for name, draw in chosen(arguments).items():
        try:
            draw(result, output / name)
        except Missing as reason:
            print(f"skipped {name}: {reason}")
        else:
            print(f"wrote {output / name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
