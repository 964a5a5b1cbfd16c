"""The page of an ensemble: its mean and bands, and the member that represents it for the clicked points."""

import csv
from pathlib import Path

import numpy as np

from voussoir.ensembles import INDEX
from voussoir.figures.catalogue import Figures, figures_for
from voussoir.figures.ensemble import Ensemble
from voussoir.figures.result import Missing, Result
from voussoir.figures.study import judging

from . import curves, element_curves, facts, ground, markup, members, paper_sentences, pictures, run_page, scene_curves
from .markup import Page
from .members import Members
from .parts import Builder, name_of

SORTS = {
    "scene": "a scene",
    "volume_loss": "a tunnel",
    "biaxial_bvp": "a biaxial specimen",
    "gravity": "a tunnel",
    "column": "a column",
}


def make(ensemble: Ensemble, folder: Path, only: list[str] | None = None) -> Builder:
    of = facts.read(folder, INDEX)
    page = Page(f"Ensemble: {name_of(folder)}", run_page.subtitle(ensemble.title(), of))
    builder = Builder(page)
    group = Members(ensemble)
    each, failed = facts.readable([folder / name for name in group.names])
    page.warnings += _warnings(folder, each) + [f"Left out: {reason}." for reason in (*group.lost, *failed)]
    builder.unreadable = bool(group.lost or failed)
    name, result = _representative(builder, group)
    if result is not None:
        page.notes.append(
            f"Clicked points and the study's further figures are of {name}, whose curves lie nearest to the mean."
        )
        _ground(builder, group, name, result)
    study = paper_sentences.study_of(folder, ensemble.settings)
    drawn = pictures.draw_all(pictures.chosen(_figures(ensemble), only), ensemble)
    if result is not None:
        of_a_run = SORTS.get(ground.stage_of(result)[0], "a tunnel")
        further = pictures.draw_all(
            pictures.chosen(figures_for(of_a_run, result), only), result, f"One member: {name}."
        )
        drawn += further
        if of_a_run == "a tunnel":
            for tunnel in study.tunnels if study else []:
                builder.judged("The study's trends, judged over the members", judging.of_tunnel(tunnel))
    paper_sentences.apply(drawn.pictures, study)
    builder.figures(drawn)
    _origin(builder, of, each)
    return builder


def _figures(ensemble: Ensemble) -> Figures:
    """The ensemble's figures, without those of other kinds of runs."""
    other = {"ensemble_specimen.png"} if "surface_settlement" in ensemble.curves else set()
    return {name: draw for name, draw in figures_for("an ensemble", ensemble).items() if name not in other}


def _warnings(folder: Path, each: list[facts.Facts]) -> list[str]:
    """The members' warnings, each with the member's name, and members that are not reduced."""
    found = [f"{of.folder.name}: {line}" for of in each for line in facts.warnings(of)]
    lines = (folder / "members.csv").read_text().splitlines() if (folder / "members.csv").is_file() else []
    left_out = [
        f"{row['name']} is not in the means: {row['status']}."
        for row in csv.DictReader(lines)
        if {"name", "status", "reduced"} <= row.keys() and row["reduced"] != "1"
    ]
    return left_out + found


def _representative(builder: Builder, group: Members) -> tuple[str, Result | None]:
    try:
        return group.representative()
    except Missing as reason:
        builder.note(reason)
        return "", None


def _ground(builder: Builder, group: Members, name: str, result: Result) -> None:
    """The mean field, its band and the representative member on one slider."""
    ensemble = group.ensemble
    try:
        stage, _ = ground.stage_of(result)
        whole = stage == "scene"  # all stages on one slider
        rows = np.arange(len(ensemble.stage)) if whole else np.flatnonzero(ensemble.stage == stage)
        rows = rows[ground.thinned(len(rows), 3 * 4 * len(result.connectivity) // 2)]
        shown = members.increments_of_rows(result, ensemble, rows)
        loads = ground.loads_of(stage, result, shown)
        mean, half = members.mean_and_half_width(group, rows, stage)
        member = ground.states_of_run(shown, f"representative member ({name})", result)
    except Missing as reason:
        builder.note(reason)
        return
    member.bits = 14  # three sets are three times the bytes
    packed = ground.shown(result, stage, loads, [mean, half, member])
    packed["tunnel"] = stage == "volume_loss"
    if whole:
        packed |= ground.parts_of_scene(result, shown)
    packed["sets"][0]["mean"] = packed["sets"][2]["followed"] = True
    if stage == "volume_loss":
        beside = builder.charts(curves.of_ensemble(group, loads))
    elif whole:
        beside = builder.charts(scene_curves.of_ensemble(ensemble))
    else:
        beside = builder.charts(element_curves.of_specimens(ensemble) if stage == "biaxial_bvp" else [])
    run_page.add_ground(builder, packed, run_page.first_point(result, "an ensemble"), beside)


def _origin(builder: Builder, of: facts.Facts, each: list[facts.Facts]) -> None:
    """The cost of every member in one table, then input and provenance."""
    costs = [dict(facts.cost(one)) for one in each]
    names = list(dict.fromkeys(name for told in costs for name in told))
    head = ("", *(one.folder.name for one in each))
    builder.page.add(
        "Cost",
        markup.table(head, [(name, *(told.get(name, "–") for told in costs)) for name in names]) if names else "",
    )
    builder.origin(of)
