"""Figures and table of a study of RVE sizes: the study's figures A1 and A2."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from . import output
from .element_tests import Series
from .rve_size import BOUND, LEAST, STRAINS, STUDY, SizeStudy, Variation, studies
from .strength_figures import draw_mean
from .style import CYCLE, MARKERS, colours, save
from .sweep import Sweep

METHOD = (
    "Coefficient of variation of q (95 % interval; number of packings, where some did not reach the strain or did not "
    "hold the lateral stress there)."
)


def draw_variation(sweep: Sweep, path: Path) -> None:
    """Fig. A1: the coefficient of variation of q against the number of grains."""
    found = studies(sweep)
    figure, axes = plt.subplots(1, len(found), figsize=(6.2 * len(found) + 2.6, 5.2), squeeze=False, sharey=True)
    for axis, study in zip(axes[0], found):
        _draw_variation(axis, study)
    axes[0, 0].set_ylabel("coefficient of variation of $q$  [-]")
    # One wide interval of few packings must not press all others to the axis.
    largest = max((one.cov for study in found for row in study.table for one in row if one.cov > 0), default=BOUND)
    axes[0, 0].set_ylim(0, 1.9 * max(largest, BOUND))
    entries = {text: drawn for axis in axes[0] for drawn, text in zip(*axis.get_legend_handles_labels())}
    axes[0, -1].legend(entries.values(), entries.keys(), loc="center left", bbox_to_anchor=(1.01, 0.5))
    figure.suptitle("Bars: 95 % intervals of the coefficient", fontsize=11)
    figure.tight_layout()
    save(figure, path)


def _draw_variation(axis: Axes, study: SizeStudy) -> None:
    sizes = np.array(study.sizes, dtype=float)
    apart = 0.008 * np.ptp(sizes)  # so that the bars of one size do not cover one another
    for k, strain in enumerate(STRAINS):
        column = [row[k] for row in study.table]
        there = np.array([np.isfinite(one.cov) for one in column])
        if not there.any():
            continue
        cov, low, high = (np.array([getattr(one, name) for one in column])[there] for name in ("cov", "low", "high"))
        at = sizes[there] + apart * (k - (len(STRAINS) - 1) / 2)
        bars = np.array([cov - low, np.where(np.isfinite(high), high, cov) - cov])
        axis.errorbar(
            at,
            cov,
            yerr=bars,
            fmt=f"{MARKERS[k]}-",
            color=CYCLE[k],
            linewidth=1.4,
            elinewidth=0.7,
            capsize=2,
            markersize=5,
            label=rf"$\varepsilon_a$ = {100 * strain:g} %",
        )
    axis.axhline(BOUND, color="black", linestyle="--", linewidth=1, label=f"{BOUND:g}, the bound of the study")
    smallest = study.smallest_from()
    if smallest is not None:
        axis.axvline(smallest, color="0.5", linestyle=":", linewidth=1.2)
    if study.soil in STUDY and sizes.min() <= STUDY[study.soil] <= sizes.max():
        axis.axvline(STUDY[study.soil], color="0.75", linewidth=5, alpha=0.6, zorder=0, label="size of the study")
    axis.set_title(f"{study.label}, {study.pressure / 1e3:g} kPa\n{_in_short(study)}", fontsize=11)
    axis.set_xlabel("number of grains  [-]")
    axis.set_xticks(study.sizes)


def _in_short(study: SizeStudy) -> str:
    smallest, possible = study.smallest_from(), study.smallest_not_excluded()
    if smallest is not None:
        return f"all strains meet {BOUND:g} from {smallest} grains on (dotted)"
    if possible is not None:
        return f"{possible} grains: the least of which no interval is above {BOUND:g}"
    return f"no size meets {BOUND:g} at all strains"


def draw_curves(sweep: Sweep, path: Path) -> None:
    """Fig. A2: stress-strain and volume curves by size, one row a soil."""
    found = studies(sweep)
    figure, axes = plt.subplots(len(found), 2, figsize=(13, 5 * len(found)), squeeze=False)
    for (stress, volume), study in zip(axes, found):
        for series, colour in zip(study.series, colours("viridis", len(study.series))):
            tests = study.whole_tests(series)
            label = f"{series.grains} grains, {len(tests)} of {len(study.tests(series))} packings"
            stress.plot([], [], color=colour, linewidth=2, label=label)
            draw_mean(stress, series, tests, "q", 1e-3, colour, "_", lines=False)
            draw_mean(volume, series, tests, "volumetric_strain", 100, colour, "_", lines=False)
        stress.set_ylabel("deviatoric stress  $q$  [kPa]")
        stress.set_ylim(bottom=0)
        volume.set_ylabel(r"$\varepsilon_v$, contraction positive  [%]")
        volume.axhline(0, color="0.4", linewidth=0.8)
        for axis in (stress, volume):
            axis.set_xlabel(r"axial strain  $\varepsilon_a$  [%]")
            axis.set_xlim(left=0)
            axis.set_title(f"{study.label}, {study.pressure / 1e3:g} kPa", fontsize=11)
        stress.legend(fontsize=8.5)
    figure.suptitle(
        "RVEs of several sizes: mean over the packings that came to the end, bands ± one standard deviation",
        fontsize=12,
    )
    figure.tight_layout()
    save(figure, path)


def write_table(sweep: Sweep, path: Path) -> None:
    lines = ["# Size of the RVE (the study's appendix A)", ""]
    for study in studies(sweep):
        lines += [
            f"## {study.label}, lateral stress {study.pressure / 1e3:g} kPa",
            "",
            METHOD,
            "",
            "| grains | packings | " + " | ".join(f"{100 * strain:g} %" for strain in STRAINS) + " | all met |",
            "|---|---|" + "---|" * (len(STRAINS) + 1),
        ]
        for k, series in enumerate(study.series):
            lines.append(_row(study, k, series))
        least = [study.smallest_at(column) for column in range(len(STRAINS))]
        cells = " | ".join("-" if size is None else str(size) for size in least)
        lines += [f"| smallest that meets {BOUND:g} | | {cells} | {study.smallest() or '-'} |", "", in_words(study), ""]
    output.write(path, "\n".join(lines[:-1]) + "\n")


def _row(study: SizeStudy, k: int, series: Series) -> str:
    made = len(study.tests(series))
    cells = [_cell(one, made) for one in study.table[k]]
    return f"| {series.grains} | {made} | " + " | ".join(cells) + f" | {'yes' if study.meets(k) else 'no'} |"


def _cell(one: Variation, made: int) -> str:
    if not np.isfinite(one.cov):
        return f"- ({one.n} packings)"
    high = f"{one.high:.3f}" if np.isfinite(one.high) else "∞"
    fewer = f"; {one.n}" if one.n != made else ""
    return f"{one.cov:.3f} ({one.low:.3f}–{high}{fewer})"


def in_words(study: SizeStudy) -> str:
    """The smallest size that meets the bound, and how sure that is."""
    smallest, lasting = study.smallest(), study.smallest_from()
    few = [size for size, row in zip(study.sizes, study.table) if any(one.n < LEAST for one in row)]
    parts = []
    if smallest is None:
        parts.append(f"No size meets a coefficient of variation of {BOUND:g} at all strains.")
        parts += _what_the_largest_misses(study)
        possible = study.smallest_not_excluded()
        if possible is not None:
            parts.append(
                f"The smallest one of which no interval lies above the bound as a whole has {possible} grains."
            )
    else:
        parts.append(f"The smallest size that meets {BOUND:g} at all strains has {smallest} grains.")
        row = study.table[study.sizes.index(smallest)]
        if any(one.high > BOUND for one in row):
            parts.append("Its intervals reach above the bound, so that another draw of packings may miss it.")
        if lasting != smallest:
            again = "no size" if lasting is None else f"{lasting} grains"
            parts.append(f"A larger one misses it again; from {again} on all meet it.")
    if few:
        parts.append(f"Fewer than {LEAST} packings came to some strain: {', '.join(map(str, few))} grains.")
    if study.soil in STUDY:
        parts.append(f"The study chose {STUDY[study.soil]} grains.")
    return " ".join(parts)


def _what_the_largest_misses(study: SizeStudy) -> list[str]:
    missed = [(strain, one) for strain, one in zip(STRAINS, study.table[-1]) if one.cov > BOUND]
    if not missed:
        return []
    said = ", ".join(f"{100 * strain:g} % ({one.cov:.3f})" for strain, one in missed)
    within = all(one.low <= BOUND for _, one in missed)
    return [f"The largest one misses it at {said}{', within the intervals there' if within else ''}."]
