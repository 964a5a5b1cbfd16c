"""The study's table 2, angles of strength and dilatancy, beside those of biaxial runs with their standard errors."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from . import output
from .element_tests import Series, labels
from .soils import NAMES

ANGLES = {
    "peak_angle": r"peak friction angle $\phi_p$",
    "critical_angle": r"critical friction angle $\phi_{cs}$",
    "dilatancy_angle": r"dilatancy angle $\psi_{max}$",
}
# Degrees: phi_p, phi_cs, psi_max. The sands of the laboratory as the study quotes them.
STUDY = {"dense sand": (39.1, 33.0, 14.0), "medium dense sand": (34.4, 32.7, 3.1), "gravel": (44.0, 33.7, 17.3)}
LABORATORY = {
    "Leighton Buzzard sand, dense": (39.4, 33.4, 12.3),
    "Hostun sand, dense": (41.9, 34.8, 13.3),
    "Hostun sand, loose": (34.4, 34.4, 0.0),
}
METHOD = (
    "Angles in degrees ± standard error over the packings; sin φ is the slope of q against p through the origin over "
    "all valid tests, sin ψ_max the mean of the tests' largest dilatancies."
)
MET = 2.0  # standard errors within which a value counts as met


def write(all_series: Sequence[Series], path: Path) -> None:
    lines = [
        "# Strength and dilatancy beside the study's table 2",
        "",
        METHOD,
        "",
        "| | φ_p | φ_cs | ψ_max | axial strain at the peak, % | contraction, % | valid tests |",
        "|---|---|---|---|---|---|---|",
    ]
    for series, label in zip(all_series, labels(all_series)):
        lines.append(_row(series, label))
        if series.soil in STUDY:
            lines.append(_plain_row(f"{NAMES[series.soil]}, the study", STUDY[series.soil]))
    lines += [_plain_row(f"{name} (laboratory, quoted by the study)", row) for name, row in LABORATORY.items()]
    lines += ["", *(_verdict(series, label) for series, label in zip(all_series, labels(all_series)))]
    output.write(path, "\n".join(lines) + "\n")


def _plain_row(name: str, angles: tuple[float, float, float]) -> str:
    return f"| {name} | " + " | ".join(f"{angle:.1f}" for angle in angles) + " | | | |"


def _row(series: Series, label: str) -> str:
    angles = [series.angle(name) for name in ANGLES]
    strain, contraction = series.mean_of("peak_strain"), series.mean_of("contraction")
    cells = [
        *(with_error(angle, 1, 180 / np.pi) for angle in angles),
        with_error(strain, 1, 100),
        with_error(contraction, 2, 100),
        f"{len(series.valid)} of {len(series.tests)}",
    ]
    return f"| **{label}, here** ({series.grains} grains) | " + " | ".join(cells) + " |"


def with_error(found: tuple[float, float], digits: int, factor: float) -> str:
    """ "39.1 ± 0.4" of a value and its standard error, times a factor."""
    value, error = factor * found[0], factor * found[1]
    if not np.isfinite(value):
        return "-"
    return f"{value:.{digits}f}" + (f" ± {error:.{digits}f}" if np.isfinite(error) else "")


def _verdict(series: Series, label: str) -> str:
    """Which of the three numbers of a soil are met within so many standard errors."""
    if series.soil not in STUDY:
        return f"{label}: the study has no such soil.\n"
    said = []
    for (name, _), wanted, short in zip(ANGLES.items(), STUDY[series.soil], ("φ_p", "φ_cs", "ψ_max")):
        angle, error = np.degrees(series.angle(name))
        if not np.isfinite(angle):
            said.append(f"{short} has no valid test")
        elif not np.isfinite(error):
            said.append(f"{short} is off by {angle - wanted:+.1f}°, of one packing")
        else:
            met = "met" if abs(angle - wanted) <= MET * error else "not met"
            errors = f" = {(angle - wanted) / error:+.1f} errors" if error > 1e-9 else ""
            said.append(f"{short} is {met}, off by {angle - wanted:+.1f}°{errors}")
    return f"{label}, within {MET:g} standard errors: " + "; ".join(said) + ".\n"
