"""The curves of biaxial specimens and of columns as the page's charts."""

from collections.abc import Callable

import numpy as np

from voussoir.figures.ensemble import Ensemble
from voussoir.figures.result import Missing, Result

from .curves import BLUE, GREY, ORANGE, Chart, banded, line
from .pack import numbers

TOP = "displacement of the top over the height [%]"


def of_specimen(result: Result) -> list[Callable[[], Chart]]:
    """q/p and the volumetric strain of the whole specimen, over the displacement of its top."""
    return [
        lambda: _specimen(result, "q_over_p", "Stress ratio of the specimen", "q/p [-]", 1),
        lambda: _specimen(
            result, "volumetric_strain", "Volumetric strain of the specimen", "ε_v, contraction positive [%]", 100
        ),
    ]


def _specimen(result: Result, name: str, title: str, label: str, factor: float) -> Chart:
    increments = result.stage("biaxial_bvp")
    load = np.array([i["load_parameter"] for i in increments])
    values = np.array([i[name] for i in increments], dtype=float)
    series = [line("specimen", 100 * load, values, BLUE, factor)]
    return {"title": title, "xlabel": TOP, "ylabel": label, "series": series, "marked": True, "xzero": True}


def of_specimens(ensemble: Ensemble) -> list[Callable[[], Chart]]:
    """q/p over the members of an ensemble of specimens."""

    def ratio() -> Chart:
        bands = ensemble.curve("q_over_p")
        single = [
            line("members", 100 * ensemble.load, one, GREY, width=0.8, silent=k > 0)
            for k, one in enumerate(bands.members)
        ]
        series = [*single, banded("mean", 100 * ensemble.load, bands, BLUE)]
        return {
            "title": "Stress ratio of the specimen",
            "xlabel": TOP,
            "ylabel": "q/p [-]",
            "series": series,
            "marked": True,
        }

    return [ratio]


def of_column(result: Result) -> list[Callable[[], Chart]]:
    """K0 against the vertical stress: rows of Gauss points, and the fitted table."""

    def k0() -> Chart:
        series = []
        if "column_rows" in result.tables:
            rows = result.tables["column_rows"]
            order = np.argsort(rows["vertical_stress"])
            measured = line("rows of Gauss points", rows["vertical_stress"][order] / 1e3, rows["ratio"][order], ORANGE)
            series.append({**measured, "points": "only"})
        if "k0" in result.tables:
            fit = result.tables["k0"]
            series.append(line("fitted", fit["vertical_stress"] / 1e3, fit["ratio"], BLUE))
        if not series:
            raise Missing("the column has no table of K0")
        stresses = np.concatenate([np.array(numbers(np.array([s["x"][0], s["x"][-1]]))) for s in series])
        return {
            "title": "K0 of the column",
            "xlabel": "vertical stress σ_yy [kPa]",
            "ylabel": "K0 = σ_xx/σ_yy [-]",
            "series": series,
            "logx": bool(np.all(stresses > 0)),
            "zero": True,
        }

    return [k0]
