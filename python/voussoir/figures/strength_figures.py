"""Figures of drained biaxial tests: stress-strain and volume curves, the p-q plane with the lines of peak failure and
critical state (the study's fig. 4), and the angles beside those of table 2."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .element_tests import Series, Test, labels
from .result import Missing
from .style import CYCLE, MARKERS, save
from .table_two import ANGLES, LABORATORY, STUDY

MOST_LINES = 12  # of packings that are drawn one by one


def valid_ones(all_series: Sequence[Series]) -> list[Series]:
    """The runs that have a valid test."""
    found = [series for series in all_series if series.valid]
    if not found:
        raise Missing(f"{all_series[0].run.folder} has no valid test")
    return found


def draw_curves(all_series: Sequence[Series], path: Path) -> None:
    all_series = valid_ones(all_series)
    rows = (
        ("q", 1e-3, "deviatoric stress  $q$  [kPa]"),
        ("q_over_p", 1.0, "stress ratio  $q/p$  [-]"),
        ("volumetric_strain", 100.0, r"$\varepsilon_v$, contraction positive  [%]"),
    )
    figure, axes = plt.subplots(
        len(rows), len(all_series), figsize=(5.2 * len(all_series) + 0.6, 10.4), squeeze=False, sharex="col"
    )
    for column, series, label in zip(axes.T, all_series, labels(all_series)):
        column[0].set_title(f"{label}: {_count(series)}", fontsize=11)
        for axis, (name, factor, text) in zip(column, rows):
            for k, pressure in enumerate(series.pressures):
                draw_mean(axis, series, series.of_pressure(pressure), name, factor, CYCLE[k], f"{pressure / 1e3:g} kPa")
            axis.set_ylabel(text)
            axis.set_xlim(left=0)
        column[0].set_ylim(0, 1.3 * column[0].get_ylim()[1])  # room for the legend
        column[1].set_ylim(bottom=0)
        column[2].axhline(0, color="0.4", linewidth=0.8)
        column[2].set_xlabel(r"axial strain  $\varepsilon_a$  [%]")
        column[0].legend(title="lateral stress", loc="upper right", ncol=3)
    _same_limits(axes)
    figure.suptitle(
        "Drained biaxial tests: mean over the packings (thick),\n± one standard deviation (band), packings (thin)",
        fontsize=11,
    )
    figure.tight_layout()
    save(figure, path)


def _count(series: Series) -> str:
    invalid = len(series.tests) - len(series.valid)
    more = f", {invalid} of {len(series.tests)} tests not valid" if invalid else ""
    return f"{len({test.seed for test in series.tests})} packings of {series.grains} grains{more}"


def _same_limits(axes: np.ndarray) -> None:
    """The ratio and the strains of all soils on the same scale."""
    for row in axes[1:]:
        limits = np.array([axis.get_ylim() for axis in row])
        for axis in row:
            axis.set_ylim(limits[:, 0].min(), limits[:, 1].max())


def draw_mean(
    axis: Axes,
    series: Series,
    tests: Sequence[Test],
    name: str,
    factor: float,
    colour: str,
    label: str,
    lines: bool = True,
) -> None:
    """Mean of tests over the axial strain, with their standard deviation and, of few packings, all of them."""
    if not tests:
        return
    strain = series.strain_grid()
    values = factor * np.array([test.at(strain, name) for test in tests])
    whole = np.isfinite(values).all(axis=0)  # a mean over fewer tests would jump
    strain, values = 100 * strain[whole], values[:, whole]
    mean = values.mean(axis=0)
    if len(tests) > 1:
        spread = values.std(axis=0, ddof=1)
        axis.fill_between(strain, mean - spread, mean + spread, color=colour, alpha=0.2, linewidth=0)
    if lines and 1 < len(tests) <= MOST_LINES:
        axis.plot(strain, values.T, color=colour, linewidth=0.5, alpha=0.45)
    axis.plot(strain, mean, color=colour, linewidth=2.0, label=label)


def draw_plane(all_series: Sequence[Series], path: Path) -> None:
    """Stress paths in the p-q plane, the tests' peaks and critical states, and the lines through them."""
    all_series = valid_ones(all_series)
    figure, axes = plt.subplots(1, len(all_series), figsize=(5.6 * len(all_series), 5.2), squeeze=False)
    for axis, series, label in zip(axes[0], all_series, labels(all_series)):
        _draw_plane(axis, series)
        axis.set_title(label)
    figure.tight_layout()
    save(figure, path)


def _draw_plane(axis: Axes, series: Series) -> None:
    for test in series.valid:
        axis.plot(test.curve["p"] / 1e3, test.curve["q"] / 1e3, color="0.75", linewidth=0.6, zorder=1)
    axis.plot([], [], color="0.75", label="stress paths")
    for name, colour, marker, line, text, symbols in (
        ("peak_angle", CYCLE[3], "^", "-", r"peak failure line, $\phi_p$", "peaks of the tests"),
        ("critical_angle", CYCLE[0], "o", "--", r"critical state line, $\phi_{cs}$", "their critical states"),
    ):
        sine = np.sin([test.row[name] for test in series.valid])
        p = np.array([test.row["pressure"] for test in series.valid]) / (1 - sine) / 1e3
        axis.plot(p, p * sine, marker, color=colour, markersize=5, fillstyle="none", zorder=3, label=symbols)
        angle, error = series.angle(name)
        axis.axline(
            (0, 0),
            slope=np.sin(angle),
            color=colour,
            linestyle=line,
            label=f"{text} = {degrees(angle, error)}",
        )
    axis.set_xlim(0, 1.08 * max(test.curve["p"].max() for test in series.valid) / 1e3)
    axis.set_ylim(0, 1.15 * max(test.curve["q"].max() for test in series.valid) / 1e3)
    axis.set_xlabel("mean stress  $p$  [kPa]")
    axis.set_ylabel("deviatoric stress  $q$  [kPa]")
    axis.legend(loc="upper left")


def degrees(angle: float, error: float) -> str:
    """ "39.1 ± 0.4°", without the error where it is not known."""
    if not np.isfinite(angle):
        return "-"
    text = f"{np.degrees(angle):.1f}"
    return f"{text} ± {np.degrees(error):.1f}°" if np.isfinite(error) else f"{text}°"


def draw_angles(all_series: Sequence[Series], path: Path) -> None:
    """Peak, critical and dilatancy angle of each run with its standard error, the study's value, and the sands of the
    laboratory that the study quotes."""
    all_series = valid_ones(all_series)
    columns = len(all_series) + len(LABORATORY)
    figure, axis = plt.subplots(figsize=(1.5 * columns + 1.6, 5.0))
    for k, (name, text) in enumerate(ANGLES.items()):
        aside, colour, marker = 0.22 * (k - 1), CYCLE[(0, 3, 2)[k]], MARKERS[k]
        for j, series in enumerate(all_series):
            angle, error = np.degrees(series.angle(name))
            known = error if np.isfinite(error) else None
            axis.errorbar(j + aside - 0.04, angle, yerr=known, fmt=marker, capsize=4, color=colour)
            if series.soil in STUDY:
                axis.plot(j + aside + 0.06, STUDY[series.soil][k], marker, color=colour, fillstyle="none")
        for j, sand in enumerate(LABORATORY.values(), len(all_series)):
            axis.plot(j + aside, sand[k], marker, color=colour, fillstyle="none")
        axis.plot([], [], marker, color=colour, label=text)
    axis.plot([], [], "o", color="0.3", label="here, ± standard error")
    axis.plot([], [], "o", color="0.3", fillstyle="none", label="table 2 of the study")
    axis.axvspan(len(all_series) - 0.5, columns - 0.5, color="0.94", zorder=0)
    names = [*labels(all_series), *(name.replace(" sand, ", "\n") + "\n(laboratory)" for name in LABORATORY)]
    axis.set_xticks(range(columns), [name.replace("Leighton Buzzard", "Leighton\nBuzzard") for name in names])
    axis.set_xlim(-0.5, columns - 0.5)
    axis.set_ylim(bottom=-1)
    axis.set_ylabel("angle  [deg]")
    axis.grid(axis="x", visible=False)
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, 1.2), ncol=3)
    save(figure, path)
