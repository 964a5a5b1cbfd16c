"""The tables of the study, as Markdown. A cell holds the mean of the draws and, in brackets, their range."""

from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np

from . import fits, measures
from .runs import HIGHER, LATE, Measured, Variation
from .strength import Strength


def number(value: float, digits: int) -> str:
    """So many significant digits, but never an exponent for a large number."""
    return f"{value:.0f}" if abs(value) >= 10**digits - 0.5 else f"{value:.{digits}g}"


def cell(values: Iterable[float], factor: float = 1.0, digits: int = 3) -> str:
    """Mean and range of the draws that have a value."""
    known = [factor * v for v in values if np.isfinite(v)]
    if not known:
        return "–"
    mean, low, high = (number(v, digits) for v in measures.spread(known))
    return f"{mean} ({low} to {high})" if len(known) > 1 else mean


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _of(variation: Variation, number: Callable[[Measured], float | None]) -> list[float]:
    found = [number(run) for run in variation.runs]
    return [v for v in found if v is not None]


def _named(variation: Variation) -> list[str]:
    return [f"{variation.name}: {variation.settings}" if variation.settings else variation.name,
            str(len(variation.runs))]  # fmt: skip


def reactions(variations: Sequence[Variation]) -> str:
    head = ("variation", "draws", "before the loss [kPa]", "minimum [-]", "at V_l [%]", "end [-]",
            "recovery: end less minimum [-]", "end over minimum, running means",
            "the same over the width of the opening")  # fmt: skip
    rows = [
        [
            *_named(v),
            cell(_of(v, lambda run: run.initial), 1e-3),
            cell(_of(v, lambda run: run.crown.least), digits=2),
            cell(_of(v, lambda run: run.crown.at), 100),
            cell(_of(v, lambda run: run.crown.end), digits=2),
            cell(_of(v, lambda run: run.crown.end - run.crown.least), digits=2),
            cell(_of(v, lambda run: run.crown.factor)),
            cell(_of(v, lambda run: run.opening.factor if run.opening else None)),
        ]
        for v in variations
    ]
    return table(head, rows)


def contractions(variations: Sequence[Variation]) -> str:
    head = ("variation", "draws", "Ac at 2 D: largest contraction [%]", "until V_l [%]",
            "first volume again at V_l [%]", f"at {HIGHER:g} D: largest contraction [%]",
            "until V_l [%]", f"heights that contract until V_l = {100 * LATE:g} % or longer [D]")  # fmt: skip
    rows = []
    for v in variations:
        higher = [run.levels[HIGHER].volume for run in v.runs if HIGHER in run.levels]
        found = [run.late_heights for run in v.runs]
        heights = "; ".join("none" if h is None else f"{h[0]:.3g}–{h[1]:.3g}" for h in found)
        rows.append(
            [
                *_named(v),
                cell(_of(v, lambda run: run.ac.most), 100, 2),
                cell(_of(v, lambda run: run.ac.at), 100),
                cell(_of(v, lambda run: run.ac.net_until), 100),
                cell([c.most for c in higher], 100, 2),
                cell([c.at for c in higher], 100),
                heights,
            ]
        )
    return table(head, rows)


def shares(variations: Sequence[Variation]) -> str:
    depths = sorted({ratio for v in variations for run in v.runs for ratio in run.fits})
    head = ("variation", "draws", "alpha at its bound, all depths [%]", *(f"z/C = {z:g} [%]" for z in depths),
            "largest misfit [% of S_max]")  # fmt: skip
    rows = [
        [
            *_named(v),
            cell(_of(v, lambda run: fits.share_at_bound(run.fits)), 100, 2),
            *(cell([run.fits[z].at_bound for run in v.runs if z in run.fits], 100, 2) for z in depths),
            cell(_of(v, lambda run: max(f.misfit for f in run.fits.values())), 100, 2),
        ]
        for v in variations
    ]
    return table(head, rows)


def by_place(runs: Sequence[Measured]) -> str:
    """Recovery at each place where the stress can be read."""
    head = ("place", "minimum [-]", "at V_l [%]", "end [-]", "end over minimum, running means")
    rows = []
    for label in runs[0].reactions:
        found = [measures.recovery(run.loss, run.reactions[label]) for run in runs if label in run.reactions]
        rows.append([label, cell((r.least for r in found), digits=2), cell((r.at for r in found), 100),
                     cell((r.end for r in found), digits=2), cell(r.factor for r in found)])  # fmt: skip
    return table(head, rows)


def by_height(runs: Sequence[Measured]) -> str:
    """Contraction and stress on the axis at each height."""
    shown = (0.0, 0.02, 0.15)
    head = ("height above the crown [D]", "largest contraction [%]", "until V_l [%]", "first volume again at V_l [%]",
            "volumetric strain at 20 % [%]", "q/p is least at V_l [%]",
            *(f"p at V_l = {100 * v:g} % [kPa]" for v in shown),
            *(f"q/p at {100 * v:g} %" for v in shown))  # fmt: skip
    rows = []
    for height in runs[0].levels:
        found = [(run, run.levels[height]) for run in runs if height in run.levels]
        volumes = [level.volume for _, level in found]
        rows.append([
            f"{height:.3g}",
            cell((v.most for v in volumes), 100, 2), cell((v.at for v in volumes), 100),
            cell((v.net_until for v in volumes), 100), cell((v.end for v in volumes), 100, 2),
            cell((run.loss[np.argmin(level.ratio)] for run, level in found), 100),
            *(cell((np.interp(s, run.loss, level.pressure) for run, level in found), 1e-3, 2) for s in shown),
            *(cell((np.interp(s, run.loss, level.ratio) for run, level in found), digits=2) for s in shown),
        ])  # fmt: skip
    return table(head, rows)


def by_reach(runs: Sequence[Measured]) -> str:
    """Fits of the troughs within several distances from the axis."""
    depths = list(runs[0].fits)
    head = ("fitted within", "all depths [%]", *(f"z/C = {z:g}: at bound [%]; median alpha; largest misfit [%]"
                                                 for z in depths))  # fmt: skip
    rows = []
    for reach in fits.RANGES:
        found = [fits.of_all_depths(run.result, reach) for run in runs]
        cells = [
            "; ".join(
                (
                    f"{100 * np.mean([f[z].at_bound for f in found]):.0f}",
                    f"{np.mean([f[z].alpha for f in found]):.2f}",
                    f"{100 * np.max([f[z].misfit for f in found]):.1f}",
                )
            )
            if all(z in f for f in found)
            else "–"
            for z in depths
        ]
        rows.append(["the whole line" if reach == fits.WHOLE else f"x ≤ {reach:g} D",
                     cell((fits.share_at_bound(f) for f in found), 100, 2), *cells])  # fmt: skip
    return table(head, rows)


def document(variations: Sequence[Variation], full: Variation) -> str:
    parts = []
    if full.runs:
        parts += [
            f"## At full size, {len(full.runs)} draws",
            "Ground reaction by the place where the stress is read:",
            by_place(full.runs),
            "Volume on the axis by height:",
            by_height(full.runs),
            "Share of the fits with alpha at its lower bound, by the part of the trough that is fitted:",
            by_reach(full.runs),
        ]
    if variations:
        rows = [*variations, full] if full.runs else list(variations)
        parts += [
            "## Variations",
            "Ground reaction of the element above the crown:",
            reactions(rows),
            "Volume on the axis:",
            contractions(rows),
            "Modified Gauss fits:",
            shares(rows),
        ]
    return "\n\n".join(part.rstrip("\n") for part in parts) + "\n"


def strengths(variations: Sequence[Variation], low: Mapping[str, Strength], high: Mapping[str, Strength]) -> str:
    """Strength of the soils at two pressures, with standard errors."""

    def of(soil: Strength | None) -> list[str]:
        if soil is None:
            return ["–"] * 4
        peak, critical = (
            f"{np.degrees(angle):.1f} ± {np.degrees(error):.1f}"
            for angle, error in ((soil.peak, soil.peak_error), (soil.critical, soil.critical_error))
        )
        return [peak, critical, f"{100 * soil.peak_strain:.1f}", f"{100 * soil.contraction:.2f}"]

    if not low and not high:
        return ""
    numbers = ("peak angle [°]", "critical angle [°]", "axial strain at the peak [%]", "largest contraction [%]")
    head = ("soil", *(f"20 kPa: {n}" for n in numbers), *(f"100 kPa: {n}" for n in numbers))
    rows = [[v.name, *of(low.get(v.name)), *of(high.get(v.name))] for v in variations if v.name in {*low, *high}]
    return "\n## Strength of the soils\n\n" + table(head, rows)
