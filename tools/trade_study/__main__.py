"""Runs the study and writes its tables and curves."""

import argparse
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from trade_study.plan import PATHS, PRESSURES, USUAL_PRESSURES, Study, settings
from trade_study.report import write


def main():
    parser = argparse.ArgumentParser(prog="tools/trade", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="two packings at 100 kPa")
    parser.add_argument("--seeds", type=int, default=8, help="number of packings (8)")
    parser.add_argument(
        "--pressures",
        type=int,
        nargs="+",
        choices=list(PRESSURES),
        default=list(USUAL_PRESSURES),
        help="[kPa] (1 100 800)",
    )
    parser.add_argument("--knobs", nargs="+", help="run only these knobs (default: all)")
    parser.add_argument("--first-seed", type=int, default=1, help="of the packings (1)")
    parser.add_argument("--path", choices=list(PATHS), default="compression", help="of the strain; use another folder")
    parser.add_argument("-j", "--processes", type=int, default=2)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/trade"))
    parser.add_argument("--program", type=Path, default=Path("build/openmp/host/voussoir"))
    given = parser.parse_args()
    seeds, pressures = (2, [100]) if given.quick else (given.seeds, given.pressures)
    seeds = range(given.first_seed, given.first_seed + seeds)
    study = Study(given.program, given.output, seeds, pressures, given.processes, way=given.path)
    chosen = [s for s in settings() if given.knobs is None or s.knob in given.knobs]
    study.run(study.packing_jobs(chosen))
    study.run(study.path_jobs(chosen))
    study.run(study.probe_jobs([s for s in chosen if s.is_of_the_engine]))
    write(study, given.output)
    print(f"{given.output}/tables.md, trade_errors.png, trade_paths.png")


main()
