#!/usr/bin/env python3
"""Draws several tunnels beside one another and states the study's trends between them: tools/compare_tunnels.py RUN RUN
... -o DIR."""

import argparse
import sys
from pathlib import Path

from voussoir_plots import comparison, settings
from voussoir_plots.result import Missing, Result
from voussoir_plots.style import use_style


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("results", type=Path, nargs="+", metavar="RUN", help="folders of runs")
    parser.add_argument("-o", "--output", type=Path, required=True, help="folder for comparison.png and comparison.md")
    settings.add_options(parser)
    arguments = parser.parse_args()
    use_style()
    try:
        results = [Result(folder, settings.parse(arguments)) for folder in arguments.results]
        arguments.output.mkdir(parents=True, exist_ok=True)
        comparison.draw(results, arguments.output / "comparison.png")
        comparison.write(results, arguments.output / "comparison.md")
    except (OSError, Missing) as reason:
        print(f"cannot compare: {reason}", file=sys.stderr)
        return 2
    print(f"wrote {arguments.output / 'comparison.png'} and comparison.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
