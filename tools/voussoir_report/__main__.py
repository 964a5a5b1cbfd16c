"""Makes one HTML page of a run, an ensemble or a sweep: tools/report DIR [-o FILE.html].

The page needs no server and no network. What a run lacks, the page and one line on the terminal tell; the exit status
is that of the figure scripts (voussoir_plots/README.md).
"""

import argparse
import sys
import time
from pathlib import Path

try:
    from voussoir_plots import guard, settings
    from voussoir_plots.output import make_folder, say, write
    from voussoir_plots.source import Source, open_source

    from voussoir_report import ensemble_page, run_page, sweep_page
    from voussoir_report.parts import Builder
except ModuleNotFoundError as missing:
    print(f"Python has no module {missing.name}; .prefix/venv/bin/python has it, after tools/setup", file=sys.stderr)
    sys.exit(2)


def options() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="tools/report", description=(__doc__ or "").splitlines()[0])
    parser.add_argument("result", type=Path, metavar="DIR", help="folder of a run, an ensemble, a sweep or packings")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="default: report.html in the folder")
    parser.add_argument(
        "--no-figures", action="store_true", help="without the figures of tools/figures.py: made sooner"
    )
    settings.add_options(parser)
    guard.add_option(parser)
    return parser


def built(source: Source, arguments: argparse.Namespace) -> Builder:
    with_figures = not arguments.no_figures
    if source.what == "a sweep":
        return sweep_page.make(source.data, arguments.result, with_figures)
    if source.what == "an ensemble":
        return ensemble_page.make(source.data, arguments.result, with_figures)
    return run_page.make(source, arguments.result, with_figures)


def main() -> int:
    arguments = options().parse_args()
    start = time.monotonic()
    folder = arguments.result if arguments.result.is_dir() else arguments.result.parent
    output = arguments.output or folder / "report.html"
    source = open_source([arguments.result], settings.parse(arguments))
    builder = built(source, arguments)
    page = builder.page.written()
    make_folder(output.parent)
    write(output, page)
    told = f"{len(page.encode()) / 1e6:.1f} MB, {time.monotonic() - start:.1f} s"
    lacking = f"; {len(builder.missing)} parts are missing, the page says which" if builder.missing else ""
    alarms = f"; {len(builder.page.warnings)} warnings at its top" if builder.page.warnings else ""
    say(f"wrote {output} ({told}{lacking}{alarms})")
    for line in builder.faults:
        say(f"FAULT in {line}; this is a fault of the tool, not of the run", error=True)
    return guard.FAULT if builder.faults else guard.UNREADABLE if builder.unreadable else guard.DRAWN


if __name__ == "__main__":
    sys.exit(guard.run(main))
