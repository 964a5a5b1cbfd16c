"""The tables of the study, as Markdown."""

import math
from collections.abc import Mapping

from .definitions import DEFINITIONS, USUAL, Value
from .fit import OBSERVABLES, Measured, Optimum, target_of
from .plan import ANGLES, BOX, PEAK_STRAIN, SOILS, TARGETS, to_unit
from .results import Angles

NAMES = {soil: soil.upper() for soil in SOILS}
SYMBOLS = {"peak": "φ_p", "critical": "φ_cs", "dilatancy": "ψ_max"}
# The definitions that read smooth curves, as one does by eye from a figure.
SMOOTH = {**USUAL, "critical": "line, 10 to 20 %", "dilatancy": "curves averaged first, 4 %"}

ByName = Mapping[str, Mapping[str, Angles]]  # {set: {soil: angles}}


def number(value: Value) -> str:
    if not math.isfinite(value.mean):
        return "–"
    return f"{value.mean:.1f}" + (f" ± {value.error:.1f}" if math.isfinite(value.error) else "")


def is_met(value: Value, target: float) -> bool:
    """Within one standard error."""
    return math.isfinite(value.error) and abs(value.mean - target) <= value.error


def _mark(value: Value, target: float) -> str:
    return f"**{number(value)}**" if is_met(value, target) else number(value)


def score(soils: Mapping[str, Angles], choice: Mapping[str, str]) -> tuple[int, int, float]:
    """Of the nine numbers those that are met within one standard error; those within one standard deviation of a single
    packing, as Table 2 is of one packing; root mean square of the differences [degrees]."""
    met = scattered = 0
    squares = []
    for soil, angles in soils.items():
        for kind, target in zip(ANGLES, TARGETS[soil], strict=True):
            value = angles[kind][choice[kind]]
            met += is_met(value, target)
            scattered += math.isfinite(value.error) and abs(value.mean - target) <= value.deviation
            if math.isfinite(value.mean):
                squares.append((value.mean - target) ** 2)
    return met, scattered, math.sqrt(sum(squares) / len(squares)) if squares else float("nan")


def _wanted_row() -> str:
    cells = [f"{TARGETS[soil][k]:.1f}" for soil in SOILS for k in range(3)]
    return f"| wanted | {' | '.join(cells)} | | | | |"


def sets(results: ByName, choice: Mapping[str, str]) -> str:
    """One row a set: the nine numbers with standard errors, bold where met within one."""
    head = " | ".join(f"{NAMES[soil]} {SYMBOLS[kind]}" for soil in SOILS for kind in ANGLES)
    marks = "met: one standard error | met: scatter of one packing | rms [°] | peak at [%]: CPS_D, CPG_D"
    text = [f"| set | {head} | {marks} |", "|---" * 14 + "|", _wanted_row()]
    for name, soils in results.items():
        cells, strains = [], []
        for soil in SOILS:
            angles = soils.get(soil)
            for kind, target in zip(ANGLES, TARGETS[soil], strict=True):
                cells.append(_mark(angles[kind][choice[kind]], target) if angles else "–")
            if soil in PEAK_STRAIN:
                strains.append(f"{angles['strain'][USUAL['strain']].mean:.1f}" if angles else "–")
        met, scattered, off = score(soils, choice)
        text.append(f"| {name} | {' | '.join(cells)} | {met} | {scattered} | {off:.1f} | {', '.join(strains)} |")
    return "\n".join(text) + "\n"


def definitions(soils: Mapping[str, Angles]) -> str:
    """What each definition makes of the same curves of one set."""
    text = [f"| angle | definition | {' | '.join(NAMES[soil] for soil in soils)} | rms [°] |", "|---" * 6 + "|"]
    for k, kind in enumerate(ANGLES):
        wanted = " | ".join(f"{TARGETS[soil][k]:.1f}" for soil in soils)
        text.append(f"| {SYMBOLS[kind]} | wanted | {wanted} | |")
        for name in DEFINITIONS[kind]:
            values = {soil: angles[kind][name] for soil, angles in soils.items()}
            cells = [_mark(value, TARGETS[soil][k]) for soil, value in values.items()]
            off = [(v.mean - TARGETS[soil][k]) ** 2 for soil, v in values.items() if math.isfinite(v.mean)]
            rms = f"{math.sqrt(sum(off) / len(off)):.1f}" if off else "–"
            text.append(f"| | {name} | {' | '.join(cells)} | {rms} |")
    return "\n".join(text) + "\n"


def optima(found: Mapping[str, Optimum]) -> str:
    """Places and expected numbers of the optima."""
    sides = " | ".join(("β", "η over printed", "t [m]"))
    text = [f"| for | {sides} | χ² of numbers | expected φ_p, φ_cs, ψ_max of each soil |", "|---" * 6 + "|"]
    for name, best in found.items():
        places = [f"{x:.3g} ({low:.2g}–{high:.2g})" for x, (low, high) in zip(best.place, best.intervals, strict=True)]
        numbers = []
        for soil in SOILS:
            if (soil, "peak") in best.expected:
                three = [best.expected[soil, kind] for kind in ANGLES]
                numbers.append(f"{NAMES[soil]} " + ", ".join(f"{m:.1f} ± {e:.1f}" for m, e in three))
        text.append(
            f"| {name} | {' | '.join(places)} | {best.chi_squared:.1f} of {best.numbers} | {'; '.join(numbers)} |"
        )
    return "\n".join(text) + "\n"


def sensitivities(best: Optimum, data: Measured, packings: int) -> str:
    """What doubling a parameter changes at the optimum, with standard errors, and the scatter that hides it."""
    unit = to_unit(best.place)
    names = ("β doubled", "η doubled", "t doubled")
    text = [f"| number | wanted | expected | {' | '.join(names)} | scatter of one packing | error of a set left out |",
            "|---" * 8 + "|"]  # fmt: skip
    for observable in OBSERVABLES:
        if observable not in best.surfaces:
            continue
        soil, kind = observable
        surface = best.surfaces[observable]
        cells = ["{:+.1f} ± {:.1f}".format(*surface.per_doubling(unit, k)) for k in range(len(BOX))]
        wanted = f"{target_of(observable):.1f}" if kind != "strain" else ""
        label = f"{NAMES[soil]} {SYMBOLS[kind]} [°]" if kind != "strain" else f"{NAMES[soil]} strain at the peak [%]"
        mean, error = best.expected[observable]
        linear = ", linear" if surface.order == 1 else ""
        scatter = f"{data.packing_deviation(observable, packings):.1f} | {surface.left_out:.1f}{linear}"
        text.append(f"| {label} | {wanted} | {mean:.1f} ± {error:.1f} | {' | '.join(cells)} | {scatter} |")
    return "\n".join(text) + "\n"


def chosen_definitions(soils: Mapping[str, Angles]) -> dict[str, str]:
    """For each angle the definition that is nearest to Table 2 over the three soils."""

    def off(kind: str, name: str) -> float:
        k = ANGLES.index(kind)
        values = [(angles[kind][name].mean - TARGETS[soil][k]) ** 2 for soil, angles in soils.items()]
        return sum(values) if all(math.isfinite(v) for v in values) else math.inf

    def nearest(kind: str) -> str:
        return min(DEFINITIONS[kind], key=lambda name: off(kind, name))

    return {**USUAL, **{kind: nearest(kind) for kind in ANGLES}}


def section(title: str, *parts: str) -> str:
    return "\n".join([f"## {title}", "", *parts])


def by_definition(title: str, soils: Mapping[str, Angles]) -> str:
    """What each definition makes of one set, and what is met by the nearest of them."""
    choice = chosen_definitions(soils)
    met, scattered, off = score(soils, choice)
    nearest = (
        f"Nearest: {'; '.join(choice[kind] for kind in ANGLES)}. With these {met} are met within one standard error, "
        f"{scattered} within the scatter of one packing, rms {off:.1f}°.\n"
    )
    return section(f"Definitions: {title}", definitions(soils), nearest)


def of_part(part: str, confirmed: ByName) -> list[str]:
    """The numbers of the sets of a part, and what each definition makes of each set."""
    smooth = ["Read from smooth curves:", "", sets(confirmed, SMOOTH)]
    whole = {name: soils for name, soils in confirmed.items() if len(soils) == len(SOILS)}
    return [
        section(f"Sets: {part}", sets(confirmed, USUAL), *smooth),
        *(by_definition(f"{part}, {name}", soils) for name, soils in whole.items()),
    ]
