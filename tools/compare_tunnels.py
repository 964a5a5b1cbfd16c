#!/usr/bin/env python3
"""Draws several tunnels beside one another and states the study's trends between them: tools/compare_tunnels.py RUN RUN
... -o DIR."""

import argparse
import sys
from functools import partial
from pathlib import Path

try:
    from voussoir_plots import comparison, guard, settings, style
    from voussoir_plots.output import make_folder, say
    from voussoir_plots.result import Missing, Result
    from voussoir_plots.style import use_style
except ModuleNotFoundError as missing:
    print(f"Python has no module {missing.name}; .prefix/venv/bin/python has it, after tools/setup", file=sys.stderr)
    sys.exit(2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="+", metavar="RUN", help="folders of runs")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder for comparison.png and comparison.md")
    style.add_option(parser)
    settings.add_options(parser)
    guard.add_option(parser)
    arguments = parser.parse_args()
    use_style()
    figures = guard.Guard(arguments.traceback)
    results = []
    for folder in arguments.results:
        try:
            results.append(comparison.tunnel(Result(folder, settings.parse(arguments))))
        except Missing as reason:
            say(f"left out: {reason if str(folder) in str(reason) else f'{folder}: {reason}'}", error=True)
            figures.unreadable()
            continue
        for lost in results[-1].left_out:
            say(f"left out: {lost}", error=True)
            figures.unreadable()
    if not results:
        raise Missing("there is no tunnel with a volume loss to compare")
    make_folder(arguments.output)
    for name, draw in {"comparison.png": comparison.draw, "comparison.md": comparison.write}.items():
        file = style.file_name(name, arguments.format)
        figures.make(file, arguments.output / file, partial(draw, results))
    return figures.status


if __name__ == "__main__":
    sys.exit(guard.run(main))
