#!/usr/bin/env python3
"""Draws the figures of a run or an ensemble: tools/figures.py DIR [-o DIR] [--only NAME ...] [more options: --help].

A figure whose data are missing is skipped, and a line says why. io/FORMAT.md describes the data sets,
voussoir_plots/README.md the figures and the exit status.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

try:
    from voussoir_plots import ensemble, guard, settings, trend_table
    from voussoir_plots.catalogue import FIGURES
    from voussoir_plots.output import make_folder, say
    from voussoir_plots.result import Missing, Result
    from voussoir_plots.style import set_note, use_style
except ModuleNotFoundError as missing:
    print(f"Python has no module {missing.name}; .prefix/venv/bin/python has it, after tools/setup", file=sys.stderr)
    sys.exit(2)

TRENDS = {"trends.md": trend_table.write}


def chosen(arguments, of_an_ensemble):
    """The functions that write the wanted files, by the names of the files."""
    if arguments.trends:
        if of_an_ensemble:
            raise Missing("the study's trends are judged for single runs, such as the members of this ensemble")
        return TRENDS
    everything = ensemble.FIGURES if of_an_ensemble else {**FIGURES, **TRENDS}
    for name in sorted(set(arguments.only or ()) - {Path(known).stem for known in everything}):
        say(f"skipped {name}: it is no figure of {'an ensemble' if of_an_ensemble else 'a single run'}")
    return {name: draw for name, draw in everything.items() if not arguments.only or Path(name).stem in arguments.only}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("result", type=Path, help="folder of a run or of an ensemble")
    parser.add_argument("-o", "--output", type=Path, help="folder for the figures; default: the run's own")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="draw only these figures, named without .png")
    parser.add_argument(
        "--trends", action="store_true", help="write only trends.md: the study's trends, each seen or not"
    )
    settings.add_options(parser)
    guard.add_option(parser)
    arguments = parser.parse_args()
    output = arguments.output or arguments.result
    unknown = set(arguments.only or ()) - {Path(name).stem for name in (*FIGURES, *TRENDS, *ensemble.FIGURES)}
    if unknown:
        parser.error(f"there is no figure {', '.join(sorted(unknown))}")
    use_style()
    figures = guard.Guard(arguments.traceback)
    of_an_ensemble = ensemble.is_ensemble(arguments.result)
    result = (ensemble.Ensemble if of_an_ensemble else Result)(arguments.result, settings.parse(arguments))
    for reason in result.left_out:
        say(f"left out: {reason}", error=True)
        figures.unreadable()
    wanted = chosen(arguments, of_an_ensemble)
    make_folder(output)
    set_note(result.draw_note() if isinstance(result, Result) else "")
    for name, draw in wanted.items():
        figures.make(name, output / name, partial(draw, result))
    return figures.status


if __name__ == "__main__":
    sys.exit(guard.run(main))
