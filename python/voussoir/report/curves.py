"""The curves beside the ground as the page's charts: troughs, settlement, ground reaction.

A chart is a dictionary for `charts.js`. Settlement and compression are positive.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from voussoir.ensembles import Bands
from voussoir.figures import reaction, settlements, troughs
from voussoir.figures.result import Increment, Missing, Result
from voussoir.figures.study.bands import of_members
from voussoir.figures.style import colours

from .members import Members, increments_at
from .pack import numbers, pack

Chart = dict[str, Any]
BLUE, ORANGE, GREY = "#0072B2", "#E69F00", "#888888"
MILLI = 1e3
LOSS = "volume loss V_l [%]"


def hexadecimal(colour: np.ndarray) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour[:3])


def depth_name(ratio: float) -> str:
    return "surface" if ratio == 0 else "crown, z/C = 1" if ratio == 1 else f"z/C = {ratio:g}"


def line(name: str, x: np.ndarray, y: np.ndarray, colour: str, factor: float = 1.0, **further: Any) -> dict[str, Any]:
    return {"name": name, "x": numbers(x), "y": numbers(factor * y), "colour": colour, **further}


def banded(name: str, x: np.ndarray, bands: Bands, colour: str, factor: float = 1.0) -> dict[str, Any]:
    """The mean with the band of the mean, and the wider one of a further member."""
    half = {
        "band": numbers(factor * bands.mean_half_width),
        "further": numbers(factor * bands.prediction_half_width),
    }
    return line(name, x, bands.mean, colour, factor, **half)


def bands_note(members: Members) -> str:
    share = f"{100 * members.ensemble.confidence:g} %"
    return (
        f"Bands over {members.ensemble.count} members: dark, {share} of the mean; pale, {share} of one further member."
    )


def of_tunnel(result: Result, shown: Sequence[Increment]) -> list[Callable[[], Chart]]:
    """The charts of a tunnel; `shown` are the increments of the slider. Each function may raise Missing."""
    return [
        lambda: _troughs(result, shown),
        lambda: _settlements(result),
        lambda: _reaction(result),
    ]


def _coloured_depths(result: Result) -> list[tuple[float, str]]:
    depths = result.settings.depths
    return [(ratio, hexadecimal(colour)) for ratio, colour in zip(depths, colours("viridis", len(depths)))]


def _trough_chart(series: list[dict[str, Any]], highest: list[float], **further: Any) -> Chart:
    return {
        "title": "Settlement troughs at the slider's V_l",
        "xlabel": "distance from the tunnel's axis x [m]",
        "ylabel": "settlement S [mm]",
        "series": series,
        "down": True,
        "zero": True,
        "ylimits": numbers(np.array(highest), 4),
        **further,
    }


def _troughs(result: Result, shown: Sequence[Increment]) -> Chart:
    series, reached = [], [0.0]
    for ratio, colour in _coloured_depths(result):
        along = troughs.line_at(result, ratio)
        values = np.array([along.settlement(i) for i in shown])
        blob = pack(MILLI * values)
        series.append({"name": depth_name(ratio), "x": numbers(along.x), "y": blob, "colour": colour, "frames": True})
        reached += [MILLI * values.min(), MILLI * values.max()]
    return _trough_chart(series, [min(reached), max(reached)])


def _settlement_chart(series: list[dict[str, Any]], **further: Any) -> Chart:
    return {
        "title": "Settlement above the crown, x = 0",
        "xlabel": LOSS,
        "ylabel": "settlement S [mm]",
        "series": series,
        "marked": True,
        "zero": True,
        **further,
    }


def _settlements(result: Result) -> Chart:
    loss = 100 * result.volume_loss
    series = [
        line(depth_name(ratio), loss, settlements.on_axis(result, ratio), colour, MILLI)
        for ratio, colour in _coloured_depths(result)
    ]
    return _settlement_chart(series)


def _reaction_chart(series: list[dict[str, Any]], **further: Any) -> Chart:
    return {
        "title": "Ground reaction: vertical stress above the crown over its value at V_l = 0",
        "xlabel": LOSS,
        "ylabel": "σ_v / σ_v,0 [-]",
        "series": series,
        "marked": True,
        "zero": True,
        **further,
    }


def _reaction(result: Result) -> Chart:
    loss, ratio, _ = reaction.curve(result)
    least = int(np.argmin(ratio))
    note = f"Least {ratio[least]:.3f} at V_l = {100 * loss[least]:.3g} %, at the end {ratio[-1]:.3f}."
    return _reaction_chart([line("element above the crown", 100 * loss, ratio, BLUE)], note=note)


def of_ensemble(members: Members, loads: np.ndarray) -> list[Callable[[], Chart]]:
    """The same charts with bands, at the slider's volume losses."""
    return [
        lambda: _banded_troughs(members, loads),
        lambda: _banded_settlements(members, loads),
        lambda: _banded_reaction(members),
    ]


def _lines(members: Members, ratio: float, loads: np.ndarray) -> tuple[np.ndarray, Bands]:
    """Settlements of all members along a level line (member, increment, place) as bands. All members have one mesh."""
    results = members.all()
    x = troughs.line_at(results[0], ratio).x
    values = []
    for result in results:
        along = troughs.line_at(result, ratio)
        if len(along.x) != len(x) or not np.allclose(along.x, x):
            raise Missing("the members of the ensemble have different meshes")
        values.append(np.array([along.settlement(i) for i in increments_at(result, "volume_loss", loads)]))
    return x, of_members(values)


def _banded_troughs(members: Members, loads: np.ndarray) -> Chart:
    series, reached = [], [0.0]
    for ratio, colour in _coloured_depths(members.all()[0]):
        x, bands = _lines(members, ratio, loads)
        series.append(
            {
                "name": depth_name(ratio),
                "x": numbers(x),
                "y": pack(MILLI * bands.mean),
                "band": pack(MILLI * bands.mean_half_width, 12),
                "colour": colour,
                "frames": True,
            }
        )
        reached += [
            MILLI * (bands.mean - bands.mean_half_width).min(),
            MILLI * (bands.mean + bands.mean_half_width).max(),
        ]
    note = f"Mean of {members.ensemble.count} members with the band of the mean."
    return _trough_chart(series, [min(reached), max(reached)], note=note)


def _banded_settlements(members: Members, loads: np.ndarray) -> Chart:
    series = []
    for ratio, colour in _coloured_depths(members.all()[0]):
        _, bands = _lines(members, ratio, loads)
        at_axis = replace(bands, **{part: values[..., 0] for part, values in vars(bands).items() if part != "unit"})
        made = banded(depth_name(ratio), 100 * loads, at_axis, colour, MILLI)
        del made["further"]  # five pale bands would hide one another
        series.append(made)
    return _settlement_chart(series, note=f"Mean of {members.ensemble.count} members with the band of the mean.")


def _banded_reaction(members: Members) -> Chart:
    ensemble = members.ensemble
    rows = ensemble.losing()
    loss, bands = 100 * ensemble.load[rows], ensemble.curve("ground_reaction").part(rows)
    single = [line("members", loss, one, GREY, width=0.8, silent=k > 0) for k, one in enumerate(bands.members)]
    series = [*single, banded("mean", loss, bands, BLUE)]
    return _reaction_chart(series, note=bands_note(members))
