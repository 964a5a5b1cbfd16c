"""Makes one HTML page of a run, an ensemble or a sweep: tools/report DIR [-o FILE.html].

The page needs no server and no network. What a run lacks, the page and one line on the terminal tell; the exit status
is that of the figure scripts (docs/reference/exit_status.md).
"""

import argparse
import sys
import time
from pathlib import Path

try:
    from voussoir.figures import guard, settings
    from voussoir.figures.output import make_folder, say, write
    from voussoir.figures.result import Missing
    from voussoir.figures.source import open_source
    from voussoir.report import sweep_page
    from voussoir.report.making import page_of
except ModuleNotFoundError as missing:
    print(
        f"Python has no module {missing.name}; in a checkout .prefix/venv/bin/python has it, after tools/setup",
        file=sys.stderr,
    )
    sys.exit(2)


def options() -> argparse.ArgumentParser:
    # Where the page is installed, a command with a name of its own calls this module.
    called = Path(sys.argv[0]).name
    prog = "tools/report" if called == "__main__.py" else called
    parser = argparse.ArgumentParser(prog=prog, description="Makes one HTML page of a run, an ensemble or a sweep.")
    parser.add_argument("result", type=Path, metavar="DIR", help="folder of a run, an ensemble, a sweep or packings")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="default: report.html in the folder")
    parser.add_argument(
        "--only", nargs="*", metavar="NAME", help="only these figures, named without .png; no name: none"
    )
    parser.add_argument(
        "--points", action="store_true", help="of a sweep: also report.html in the folder of each point"
    )
    settings.add_options(parser)
    guard.add_option(parser)
    return parser


def report(path: Path, output: Path, arguments: argparse.Namespace) -> int:
    """Makes one page, tells it in one line, and returns the exit status."""
    start = time.monotonic()
    builder = page_of(path, settings.parse(arguments), arguments.only)
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


def reports_of_points(path: Path, arguments: argparse.Namespace) -> int:
    """The pages of a sweep's points, to which its own page links; one that cannot be made loses no other one."""
    source = open_source([path], settings.parse(arguments))
    status = guard.DRAWN
    for folder in sweep_page.points_of(source.data) if source.what == "a sweep" else []:
        try:
            status = status or report(folder, folder / sweep_page.REPORT, arguments)
        except Missing as reason:
            say(str(reason), error=True)
            status = status or guard.UNREADABLE
    return status


def main() -> int:
    arguments = options().parse_args()
    folder = arguments.result if arguments.result.is_dir() else arguments.result.parent
    status = reports_of_points(arguments.result, arguments) if arguments.points else guard.DRAWN
    return report(arguments.result, arguments.output or folder / sweep_page.REPORT, arguments) or status


if __name__ == "__main__":
    sys.exit(guard.run(main))
