"""Draws the figures of a run of any kind, of packings, of an ensemble or of a sweep: tools/figures.py DIR [-o DIR]
[--only NAME ...] [more options: --help].

Several files of packings are drawn together, and several runs of kind biaxial. A figure whose data are missing is
skipped, and a line says why. docs/reference/files.md describes the data sets, docs/reference/figures.md the
figures, docs/reference/exit_status.md the exit status.
"""

import argparse
import sys
from functools import partial
from pathlib import Path
from typing import Any

try:
    from . import guard, settings, style
    from .catalogue import TRENDS, Figures, figures_for, figures_of, stems
    from .output import make_folder, say
    from .result import Missing
    from .source import open_source
    from .style import set_note, use_style
except ModuleNotFoundError as missing:
    print(
        f"Python has no module {missing.name}; in a checkout .prefix/venv/bin/python has it, after tools/setup",
        file=sys.stderr,
    )
    sys.exit(2)


def chosen(arguments: argparse.Namespace, what: str, data: Any) -> Figures:
    """The functions that write the wanted files, by the names of the files. A figure that `--only` names is tried in
    any case, so that a line says why it does not exist."""
    if arguments.trends:
        if what != "a tunnel":
            raise Missing(f"the study's trends are judged for single runs of tunnels, and this is {what}")
        return TRENDS
    everything = figures_of(what) if arguments.only else figures_for(what, data)
    for name in sorted(set(arguments.only or ()) - {Path(known).stem for known in everything}):
        say(f"skipped {name}: it is no figure of {what}")
    return {name: draw for name, draw in everything.items() if not arguments.only or Path(name).stem in arguments.only}


def output_folder(arguments: argparse.Namespace, parser: argparse.ArgumentParser) -> Path:
    """Where the figures go: beside what they are drawn from, unless an option says otherwise."""
    if arguments.output:
        return arguments.output
    if len(arguments.results) > 1:
        parser.error("name a folder for figures of several files or runs by -o")
    (path,) = arguments.results
    return path.parent if path.is_file() else path


def options() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Draws the figures of a run, of packings, an ensemble or a sweep.")
    parser.add_argument(
        "results",
        type=Path,
        nargs="+",
        metavar="DIR",
        help="folder of a run, an ensemble, a sweep or packings; files of packings; several runs of kind biaxial",
    )
    parser.add_argument("-o", "--output", type=Path, help="folder for the figures; default: the run's own")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="draw only these figures, named without .png")
    parser.add_argument(
        "--trends", action="store_true", help="write only trends.md: the study's trends, each seen or not"
    )
    style.add_option(parser)
    settings.add_options(parser)
    guard.add_option(parser)
    return parser


def main() -> int:
    parser = options()
    arguments = parser.parse_args()
    output = output_folder(arguments, parser)
    unknown = set(arguments.only or ()) - stems()
    if unknown:
        parser.error(f"there is no figure {', '.join(sorted(unknown))}")
    use_style()
    figures = guard.Guard(arguments.traceback)
    source = open_source(arguments.results, settings.parse(arguments))
    for reason in source.left_out:
        say(f"left out: {reason}", error=True)
        figures.unreadable()
    wanted = chosen(arguments, source.what, source.data)
    make_folder(output)
    set_note(source.note)
    for name, draw in wanted.items():
        file = style.file_name(name, arguments.format)
        figures.make(file, output / file, partial(draw, source.data))
    return figures.status


if __name__ == "__main__":
    sys.exit(guard.run(main))
