#!/usr/bin/env python3
"""Draws the paper's comparisons of tunnels: tools/compare_tunnels.py RUN ENSEMBLE ... [-o DIR] [--only NAME ...].

Runs and ensembles of tunnels that are named one by one, with the bands of members; study.md says which of the paper's
figures has which file, and how our results compare. Of a sweep tools/figures.py draws the same.
docs/reference/figures.md describes it.
"""

import argparse
import sys
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))
try:
    from voussoir.figures import comparison, guard, settings
    from voussoir.figures.output import make_folder, say
    from voussoir.figures.result import Unreadable
    from voussoir.figures.study.catalogue import STUDY_FIGURES, write
    from voussoir.figures.study.data import open_study
    from voussoir.figures.style import add_option, file_name, use_style
except ModuleNotFoundError as missing:
    print(f"Python has no module {missing.name}; .prefix/venv/bin/python has it, after tools/setup", file=sys.stderr)
    sys.exit(2)


def draw_overview(study, path):
    """Curves of all tunnels in one picture, each by the member that stands for it."""
    comparison.draw([tunnel.representative for tunnel in study.tunnels], path)


FILES = {"comparison.png": draw_overview, **STUDY_FIGURES, "study.md": write}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "folders", type=Path, nargs="+", metavar="DIR", help="a sweep, or runs and ensembles of tunnels"
    )
    parser.add_argument("-o", "--output", type=Path, help="folder for the figures; default: the sweep's own")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="write only these files, named without their ending")
    add_option(parser)
    settings.add_options(parser)
    guard.add_option(parser)
    arguments = parser.parse_args()
    if len(arguments.folders) > 1 and not arguments.output:
        parser.error("name a folder for the figures of several runs by -o")
    unknown = set(arguments.only or ()) - {Path(name).stem for name in FILES}
    if unknown:
        parser.error(f"there is no figure {', '.join(sorted(unknown))}")
    use_style()
    figures = guard.Guard(arguments.traceback)
    study = open_study(arguments.folders, settings.parse(arguments))
    for reason in study.left_out:
        say(f"left out: {reason}", error=True)
        if isinstance(reason, Unreadable):
            figures.unreadable()
    output = arguments.output or arguments.folders[0]
    make_folder(output)
    for name, draw in FILES.items():
        if not arguments.only or Path(name).stem in arguments.only:
            written = file_name(name, arguments.format)
            figures.make(written, output / written, partial(draw, study))
    return figures.status


if __name__ == "__main__":
    sys.exit(guard.run(main))
