"""The trends of one run, as a table: writes trends.md."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from . import output, paths, points, profiles, rotation, settlements, trends, troughs, widths
from .reaction import curve
from .resolution import percent
from .result import Increment, Missing, Result
from .soils import NAMES

# Places and two stresses along a line, at an increment.
Profile = Callable[[Result, Increment], tuple[np.ndarray, np.ndarray, np.ndarray]]

BAND = 0.05  # eps_q from which soil counts as sheared


def write(result: Result, path: Path) -> None:
    (diameter,) = result.need("diameter")
    last = result.volume_loss[-1]
    rows, faults = table(result)
    about = (
        f"C/D = {result.cover / diameter:.3g}, D = {diameter:g} m, {result.soil}, {len(result.connectivity)} "
        f"elements; V_l to {percent(last)} in {len(result.loss_increments) - 1} increments. "
        "The trends are those of the study (docs/reference/figures.md says how each is judged)."
    )
    lines = [
        f"# Trends: {result.folder.resolve().name}",
        "",
        about,
        "",
        "| trend | verdict | numbers |",
        "|---|---|---|",
    ]
    lines += [f"| {row.statement} | **{row.verdict}** | {row.numbers} |" for row in rows]
    lines += ["", _solution(result)]
    lines += ["", f"Points: {_points(result)}."]
    output.write(path, "\n".join(lines) + "\n")
    if faults:
        raise faults[0]  # the table is written, and the fault is told


def _points(result: Result) -> str:
    try:
        return "; ".join(describe(result, p) for p in points.all_points(result))
    except Missing as reason:
        return str(reason)


def _solution(result: Result) -> str:
    """A sentence about the convergence of the increments, on which the trends rest."""
    found = result.increments

    def number(name: str) -> np.ndarray:
        return np.array([float(i.attributes.get(name, 0)) for i in found])

    evaluations = number("evaluations")[number("volume_loss") > 0]
    return (
        f"Of {len(found)} increments {number('converged').sum():.0f} converged, the largest residual "
        f"{number('residual').max():.2g} of the reference; {number('cuts').sum():.0f} cuts, "
        f"{(number('relaxations') > 0).sum()} increments relaxed; {np.median(evaluations):.3g} evaluations (median) "
        f"and at most {evaluations.max():.0f} an increment of the volume loss."
    )


def describe(result: Result, point: points.Point) -> str:
    (diameter,) = result.need("diameter")
    height = (point.position[1] - result.crown_height) / diameter
    return f"{point.name} = Gauss point {point.index} at x = {point.position[0]:.2f} m, {height:.2f} D above the crown"


def table(result: Result) -> tuple[list[trends.Trend], list[Exception]]:
    """All trends of a tunnel's run, and the faults of this tool. A trend whose data are missing says so."""
    rows: list[trends.Trend] = []
    faults: list[Exception] = []
    for make in (_settlements, _bands, _troughs, _stresses, _reaction, _paths, _rotation, _localisation):
        try:
            rows += make(result)
        except Missing as reason:
            rows.append(trends.Trend(make.__doc__ or "", trends.NO_DATA, str(reason)))
        except Exception as error:
            if output.is_of_the_machine(error):
                raise
            rows.append(trends.fault(make.__doc__ or "", error))
            faults.append(error)
    return rows, faults


def _cover_ratio(result: Result) -> float:
    (diameter,) = result.need("diameter")
    return result.cover / diameter


def _settlements(result: Result) -> list[trends.Trend]:
    """Settlement against V_l"""
    (diameter,) = result.need("diameter")
    found = {z: settlements.on_axis(result, z) for z in result.settings.depths}
    rows = [trends.settlement_slows(result.volume_loss, found, diameter)]
    if 0.0 in found:
        rows.append(
            trends.surface_accelerates(result.volume_loss, found[0.0], diameter).where(
                _cover_ratio(result) < 2.5, "reported for C/D = 2"
            )
        )
    return rows


def _bands(result: Result) -> list[trends.Trend]:
    """Shear bands"""
    (diameter,) = result.need("diameter")
    where = points.original_points(result)
    height = (where[:, 1] - result.crown_height) / result.cover
    reach = {
        i["volume_loss"]: trends.band_height(
            height, where[:, 0], i.field("gauss/deviatoric_strain").ravel(), result.settings.aside * diameter, BAND
        )
        for i in result.nearest(result.settings.field_losses)
    }
    if not reach:
        raise Missing("no increment is near the volume losses of the fields")
    return [
        trends.bands(reach, _cover_ratio(result), BAND).where(result.soil == "dense sand", "reported for dense sand")
    ]


def _troughs(result: Result) -> list[trends.Trend]:
    """Settlement troughs"""
    found = troughs.all_troughs(result)
    by_depth = {z: [t for (ratio, _), t in found.items() if ratio == z] for z in result.settings.depths}
    loss = np.array([t.loss for t in next(iter(by_depth.values()))])
    low, high = result.settings.range_of_k
    return [
        trends.gauss_fits(
            {z: np.array([t.fit.misfit for t in ts]) for z, ts in by_depth.items()},
            {z: np.array([t.fit.at_bound for t in ts]) for z, ts in by_depth.items()},
        ),
        trends.troughs_narrow(loss, {z: np.array([t.fit.inflection for t in ts]) for z, ts in by_depth.items()}),
        trends.surface_width_in_range(*widths.surface_width(result)[:2], low, high),
    ]


def _stresses(result: Result) -> list[trends.Trend]:
    """Stresses above the crown and beside the tunnel"""
    (diameter,) = result.need("diameter")

    def means(profile: Profile, near: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
        """Both stresses over the volume loss, over their values at V_l = 0."""
        rows = []
        for increment in (result.start, *result.loss_increments[1:]):
            place, xx, yy = profile(result, increment)
            inside = near(place)
            if not inside.any():
                raise Missing("no point lies within D of the opening")
            rows.append((xx[inside].mean(), yy[inside].mean()))
        if not np.all(np.array(rows[0]) > 0):
            raise Missing("the ground at the opening is not compressed before the volume loss")
        return np.array(rows).T / np.array(rows[0])[:, None]

    above = means(profiles.above, lambda height: height <= diameter)
    beside = means(profiles.beside, lambda x: x <= 1.5 * diameter)
    return [
        trends.stresses_above(result.volume_loss, *above),
        trends.stresses_beside(result.volume_loss, *beside),
    ]


def _reaction(result: Result) -> list[trends.Trend]:
    """Ground reaction curve"""
    loss, ratio, _ = curve(result)
    is_own = result.soil not in NAMES and result.soil != "no grains"
    return [trends.reaction(loss, ratio, result.nearest_soil).where(not is_own, "reported for the soils of the study")]


def _paths(result: Result) -> list[trends.Trend]:
    """RVEs above the crown"""
    loss, followed = result.volume_loss, points.above_crown(result)
    ratios = {p.name: paths.stress_ratio(result, p) for p in followed}
    volumes = {p.name: points.history(result, "gauss/volumetric_strain", p) for p in followed}
    dense_sand = result.soil == "dense sand"
    rows = [
        trends.falls_linearly(loss, ratios),
        trends.softening_order(loss, ratios).where(dense_sand, "reported for dense sand"),
    ]
    if "Ac" in volumes:
        rows.append(trends.contracts_until(loss, volumes["Ac"]).where(dense_sand, "reported for dense sand"))
    if result.soil == "medium dense sand":
        rows.append(trends.ends_contracted(loss, {name: v for name, v in volumes.items() if name != "Aa"}))
    if result.soil in ("gravel", "medium dense sand"):
        rows.append(trends.no_softening(loss, ratios, result.soil))
    return rows


def _rotation(result: Result) -> list[trends.Trend]:
    """Principal stresses above the crown turn with the RVEs' fabric"""
    stress = {i["volume_loss"]: rotation.stress_angles(result, i)[1] for i in result.losses}
    fabric = {i["volume_loss"]: rotation.fabric_angles(result, i) for i in result.losses}
    return [trends.follows_fabric(stress, fabric)]


def _localisation(result: Result) -> list[trends.Trend]:
    """Localisation of strain, rotation and void ratio"""
    first, last = result.start, result.loss_increments[-1]
    rotation_ = (last.field("gauss/grain_rotation") - first.field("gauss/grain_rotation")).ravel()
    dilation = (last.field("gauss/void_ratio") - first.field("gauss/void_ratio")).ravel()
    return [trends.localise_together(last.field("gauss/deviatoric_strain").ravel(), rotation_, dilation)]
