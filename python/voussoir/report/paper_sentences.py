"""Which figure of the study a picture stands for, and one sentence how it compares (voussoir.figures/paper.py)."""

from collections.abc import Iterable
from pathlib import Path

from voussoir.figures import paper
from voussoir.figures.result import Missing
from voussoir.figures.settings import Settings
from voussoir.figures.study import catalogue
from voussoir.figures.study.data import Study, open_study
from voussoir.figures.sweep import Sweep

from .pictures import Picture

# The figures of single runs beside those of whole studies, which paper.FIGURES names: our file, the paper's number.
OF_RUNS = {
    "geostatic_stress": "6",
    "displacement": "8",
    "deviatoric_strain": "9",
    "settlement_growth": "10",
    "settlement_troughs": "11",
    "ensemble_trough": "11",
    "trough_widths": "12",
    "ensemble_trough_width": "12",
    "ensemble_settlement": "10",
    "ground_reaction": "15b",
    "ensemble_ground_reaction": "15b",
    "stress_profiles": "16",
    "stress_rotation": "18",
    "localisation": "19",
    "force_chains": "20",
    "rve_paths": "21",
    "rve_network": "23",
}


def number(figure: paper.PaperFigure) -> str:
    """ "Figure 6" or "Table 2"."""
    return figure.number if figure.number.startswith("Table") else f"Figure {figure.number}"


def study_of(folder: Path, settings: Settings) -> Study | None:
    """The tunnels of a folder, with which the sentences compare; None where there are none."""
    try:
        return open_study([folder], settings)
    except Missing:
        return None


def study_of_sweep(sweep: Sweep) -> Study | None:
    """The same for a sweep whose figures were drawn, and whose tunnels are read already."""
    try:
        return catalogue.study_of(sweep)
    except Missing:
        return None


def apply(pictures: Iterable[Picture], study: Study | None) -> None:
    """Gives pictures the number, the content and the sentence of the study's figure whose counterpart they are."""
    by_number = {figure.number: figure for figure in paper.FIGURES}
    by_file = {Path(file).stem: figure for figure in paper.FIGURES for file in figure.files}
    for picture in pictures:
        figure = by_file.get(picture.name) or by_number.get(OF_RUNS.get(picture.name, ""))
        if figure is None:
            continue
        picture.number, picture.what = number(figure), f"{figure.what}."
        if study is not None and figure.compare is not None:
            picture.text = paper.sentence(figure, study)


def all_figures(drawn: Iterable[Picture], study: Study | None) -> list[tuple[str, str, str]]:
    """(number, what it shows, how it compares or why there is no counterpart) of every figure of the paper."""
    there = {picture.name for picture in drawn}
    rows = []
    for figure in paper.FIGURES:
        if figure.missing or figure.compare is None:
            text = "" if there & {Path(file).stem for file in figure.files} else _elsewhere(figure)
        else:
            text = (
                paper.sentence(figure, study)
                if study is not None
                else "No data: the sweep has no tunnel that can be read."
            )
        rows.append((number(figure).replace(" ", "\u00a0"), figure.what, text))
    return rows


def _elsewhere(figure: paper.PaperFigure) -> str:
    if figure.missing:
        return f"No counterpart: {figure.missing}."
    return f"Not drawn here: {', '.join(figure.files)} of {figure.of} (tools/figures.py)."
