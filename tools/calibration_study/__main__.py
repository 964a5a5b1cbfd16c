"""Searches rolling stiffness, rolling limit and thickness for the study's three soils at once, and writes what of Table
2 is met. Parts: readings (what the printed coefficient may mean), design (sets all over the box), chosen (the best of
them), confirm (the shipped, literal and chosen sets at full size), slow (the shipped sets at the study's inertial
number), compressed (the shipped sets with packings that are compressed from 1 kPa)."""

import argparse
import json
import shlex
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
from calibration_study import compressed, fit, pictures, plan, report, results
from calibration_study.definitions import USUAL
from calibration_study.plan import SOILS, Set
from calibration_study.runs import Programme, run_sets

PARTS = ("readings", "design", "chosen", "confirm", "slow", "compressed")
SHOWN = ("shipped", "stiffer_sand")  # readings that are shown with all definitions
SIZES = {"confirm": plan.CONFIRM, "slow": plan.SLOW}  # the others: plan.SEARCH


class Study:
    """The parts of the study below one folder. What `chosen` and `confirm` run follows from earlier parts; it is
    chosen once and kept in chosen.json, so that a study that is gone on with runs the same sets."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.places = folder / "chosen.json"

    def stored(self) -> dict[str, dict[str, list[float]]]:
        """What chosen.json has. Raises ValueError where it is damaged."""
        if not self.places.exists():
            return {}
        try:
            stored = json.loads(self.places.read_text())
            return {name: {k: [float(x) for x in v] for k, v in places.items()} for name, places in stored.items()}
        except (AttributeError, TypeError, ValueError) as error:
            raise ValueError(f"{self.places} is damaged ({error}); without it the places are chosen anew") from error

    def chosen(self, name: str, groups: Mapping[str, Sequence[str]], choice: fit.Choice) -> dict[str, list[float]]:
        """{purpose: place} stored under a name, or found from what the search gave for the soils of each purpose."""
        stored = self.stored()
        if name not in stored:
            data = self.measured(choice)
            stored[name] = {
                purpose: list(fit.optimum(data, soils, packings=plan.SEARCH.seeds).place)
                for purpose, soils in groups.items()
            }
            self.places.write_text(json.dumps(stored, indent=1) + "\n")
        return stored[name]

    def sets(self, part: str) -> list[Set]:
        if part == "readings":
            return plan.readings()
        if part == "design":
            return plan.design()
        by_name = {one.name: one for one in plan.readings()}
        if part == "slow":
            return [by_name["shipped"]]
        joint = plan.at(self.chosen("joint", {"all": SOILS}, USUAL)["all"])
        places = self.chosen("sand_and_gravel", {"sand": SOILS[:2], "gravel": SOILS[2:]}, report.SMOOTH)
        sand, gravel = plan.at(places["sand"]), plan.at(places["gravel"])
        apart = {soil: (gravel if soil == "cpg_d" else sand).soils[soil] for soil in SOILS}
        best = [Set("joint", joint.soils), Set("sand_and_gravel", apart)]
        return best if part == "chosen" else [by_name["shipped"], by_name["literal"], *best]

    def of(self, part: str) -> dict[str, dict[str, results.Angles]]:
        """What is finished of a part; nothing where its sets are not chosen yet."""
        if part in ("chosen", "confirm") and "sand_and_gravel" not in self.stored():
            return {}
        return results.of_group(self.folder / part, self.sets(part))

    def measured(self, choice: fit.Choice) -> fit.Measured:
        parts = ("readings", "design")
        found = {name: soils for part in parts for name, soils in self.of(part).items()}
        return fit.measured([one for part in parts for one in self.sets(part)], found, choice)

    def optima(self, choice: fit.Choice) -> tuple[fit.Measured, dict[str, fit.Optimum]]:
        data, n = self.measured(choice), plan.SEARCH.seeds
        found = {
            "all soils": fit.optimum(data, SOILS, packings=n),
            "all soils, any strain at the peak": fit.optimum(data, SOILS, packings=n, keep_peak=False),
            "both sands": fit.optimum(data, SOILS[:2], packings=n),
            **{report.NAMES[soil]: fit.optimum(data, (soil,), packings=n) for soil in SOILS},
        }
        return data, found


def tables(study: Study) -> str:
    """All tables of what is finished."""
    parts = []
    if readings := study.of("readings"):
        both = [report.sets(readings, USUAL), "Read from smooth curves:", "", report.sets(readings, report.SMOOTH)]
        parts.append(report.section("Readings of the printed coefficient", *both))
        parts += [
            report.by_definition(name, readings[name]) for name in SHOWN if len(readings.get(name, {})) == len(SOILS)
        ]
    for title, choice in (("", USUAL), (", read from smooth curves", report.SMOOTH)):
        try:
            data, found = study.optima(choice)
        except ValueError as few:
            parts.append(f"No search yet: {few}\n")
            break
        counts = ", ".join(f"{len(data.units[soil])} sets of {report.NAMES[soil]}" for soil in SOILS)
        parts.append(report.section(f"Optima{title} ({counts})", report.optima(found)))
        for name in ("all soils", "both sands"):
            table = report.sensitivities(found[name], data, plan.SEARCH.seeds)
            parts.append(report.section(f"Sensitivities at the optimum of {name}{title}", table))
    for part in ("chosen", "confirm", "slow"):
        if confirmed := study.of(part):
            parts += report.of_part(part, confirmed)
    other_way = {soil: tests for soil in SOILS if (tests := compressed.tests(study.folder, soil))}
    if other_way:
        shipped = {"compressed from 1 kPa": {soil: results.all_angles(tests) for soil, tests in other_way.items()}}
        reference = {"shipped": study.of("readings").get("shipped", {})}
        parts.append(report.section("Packings compressed from 1 kPa", report.sets(reference | shipped, USUAL)))
    return "\n".join(parts)


def draw(study: Study, folder: Path) -> None:
    data = study.measured(USUAL)
    if all(len(units) for units in data.units.values()):
        smooth = study.measured(report.SMOOTH)
        pictures.reached(data, smooth, plan.SEARCH.seeds, folder / "calibration_reached.png")
    readings = study.of("readings")
    shown: dict[str, dict[str, results.Angles]] = {
        name: readings[name] for name in ("shipped", "stiffer_sand", "soft_unlimited", "literal") if name in readings
    }
    shown |= study.of("chosen")
    if shown:
        pictures.nine_numbers(shown, USUAL, folder / "calibration_numbers.png")


def part_named(name: str) -> str:
    """The name of a part. argparse's own `choices` refuse a list of defaults."""
    if name not in PARTS:
        raise argparse.ArgumentTypeError(f"there is no part {name}; there are {', '.join(PARTS)}")
    return name


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/calibrate_soils", description=__doc__)
    parser.add_argument("parts", nargs="*", type=part_named, default=list(PARTS), metavar="PART",
                        help=f"{', '.join(PARTS)} (all)")  # fmt: skip
    parser.add_argument("-o", "--output", type=Path, default=Path("out/calibration_study"))
    parser.add_argument("--program", type=Path, default=Path("build/openmp/host/voussoir"))
    parser.add_argument("--prefix", default="", help="words before each run, such as 'nice -n 10'")
    parser.add_argument("--tables", action="store_true", help="run nothing, write the tables of what is finished")
    given = parser.parse_args()
    try:
        given.output.mkdir(parents=True, exist_ok=True)
        study = Study(given.output)
        how = Programme(given.program, given.output, shlex.split(given.prefix))
        for part in () if given.tables else given.parts:
            if part == "compressed":
                compressed.run(how, plan.readings()[0], plan.SEARCH)
            else:
                run_sets(how, part, study.sets(part), SIZES.get(part, plan.SEARCH))
        (given.output / "tables.md").write_text(tables(study))
        draw(study, given.output)
    except (OSError, ValueError) as error:  # ValueError: too few results for a search, or a damaged chosen.json
        print(f"calibrate_soils: {error}", file=sys.stderr)
        return 1
    print(f"wrote {given.output}/tables.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
