"""Runs the parts of the study and writes their tables."""

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from budget_study import plan, report

PARTS = {
    "draws": (plan.draws, report.draws),
    "draws_full": (plan.draws_full, report.draws),
    "knobs": (plan.knobs, report.knobs),
    "knobs_full": (plan.knobs_full, report.knobs),
}


def part_of(name: str) -> str:
    """A part as argparse takes it: `choices` would refuse the default, which is a list."""
    if name not in PARTS:
        raise argparse.ArgumentTypeError(f"is {name!r}, must be one of {', '.join(PARTS)}")
    return name


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/budget", description=__doc__)
    parser.add_argument("parts", nargs="*", default=["draws", "knobs"], type=part_of, metavar="PART",
                        help=f"{', '.join(PARTS)} (draws knobs)")  # fmt: skip
    parser.add_argument(
        "-n", "--draws", type=int, help="number of draws (default: draws 24, draws_full and knobs 3, knobs_full 1)"
    )
    parser.add_argument("-j", "--processes", type=int, default=2)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/budget"))
    parser.add_argument("--program", type=Path, default=Path("build/openmp/host/voussoir"))
    parser.add_argument("--tables", action="store_true", help="run nothing, write the tables of what is finished")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    for part in given.parts:
        make, write = PARTS[part]
        runs = make() if given.draws is None else make(given.draws)
        folder = given.output / part
        if not given.tables:
            sweep = given.output / f"{part}.toml"
            sweep.write_text(plan.sweep_text(runs))
            words = [given.program, "sweep", sweep, "-o", folder, "-j", str(given.processes), "--resume"]
            status = subprocess.run(words, check=False).returncode  # a run that fails is counted in the table
            if status in (2, 130):  # refused, or stopped on request
                return status
        table = given.output / f"{part}.md"
        table.write_text(write(runs, folder))
        print(f"wrote {table}")
    return 0


sys.exit(main())
