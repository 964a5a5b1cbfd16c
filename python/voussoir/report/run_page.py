"""The page of one run: a scene, a tunnel, a column, a specimen; biaxial tests, a calibration, a probe, packings."""

from pathlib import Path
from typing import Any

import numpy as np

from voussoir.figures import points
from voussoir.figures.catalogue import figures_for
from voussoir.figures.result import Missing, Result, RunIndex
from voussoir.figures.source import Source

from . import curves, element_curves, facts, ground, markup, paper_sentences, pictures, scene_curves
from .fields import colour_maps
from .markup import Page
from .parts import Builder, name_of

HINT = (
    "Click a point for its paths; drag moves the view, Ctrl and the wheel enlarge it, a double click shows all. "
    "Each Gauss point, one RVE, has one colour."
)


def make(source: Source, folder: Path, only: list[str] | None = None) -> Builder:
    """The page of a run of any kind, or of packings."""
    of = facts.read(folder) if folder.is_dir() else facts.Facts(folder)
    title = str(source.data.case.get("title", "")) if isinstance(source.data, RunIndex) else ""
    page = Page(f"{source.what.capitalize()}: {name_of(folder)}", subtitle(title, of))
    builder = Builder(page)
    page.warnings += facts.warnings(of)
    for reason in source.left_out:
        builder.note(reason)
    if source.note:
        page.notes.append(source.note)
    if isinstance(source.data, Result):
        page.warnings += facts.unfinished(source.data.case, of)
        _mesh_parts(builder, source.data, source.what)
    if source.what == "a tunnel":
        builder.trends(source.data)
    drawn = pictures.draw_all(pictures.chosen(figures_for(source.what, source.data), only), source.data, source.note)
    study = paper_sentences.study_of(folder, source.data.settings) if source.what == "a tunnel" else None
    paper_sentences.apply(drawn.pictures, study)
    builder.figures(drawn)
    builder.origin(of)
    return builder


def of_a_beginning(folder: Path, reason: Missing) -> Builder:
    """The page of a run that has nothing to draw yet: the reason, its case, where it comes from."""
    of = facts.read(folder)
    if not of.input:
        raise reason
    builder = Builder(Page(f"A run: {name_of(folder)}", subtitle("", of), [str(reason), *facts.warnings(of)]))
    builder.unreadable = True
    builder.origin(of)
    return builder


def subtitle(title: str, of: facts.Facts) -> str:
    told = [title, f"kind {of.kind}" if of.kind else "", str(of.provenance.get("date", ""))]
    version = of.provenance.get("version")
    told.append(f"voussoir {version} ({of.provenance.get('git_hash', 'unknown')})" if version else "")
    told.append(f"fingerprint {of.provenance['fingerprint']}" if "fingerprint" in of.provenance else "")
    return " · ".join(part for part in told if part)


def _mesh_parts(builder: Builder, result: Result, what: str) -> None:
    """The ground with its slider, the curves beside it, the clicked point."""
    try:
        stage, increments = ground.stage_of(result)
        kept = ground.thinned(len(increments), 4 * len(result.connectivity))
        shown = [increments[k] for k in kept]
        states = ground.states_of_run(shown, "this run", result)
    except Missing as reason:
        builder.note(reason)
        return
    packed = ground.shown(result, stage, ground.loads_of(stage, result, shown), [states])
    if what == "a scene":
        packed |= ground.parts_of_scene(result, shown)
    packed["tunnel"] = what == "a tunnel"
    packed["sets"][0]["followed"] = True
    if len(shown) < len(increments):
        builder.page.notes.append(
            f"The slider has {len(shown)} of {len(increments)} increments, so that the page stays small."
        )
    lacking = ground.missing_fields(states)
    if lacking and result.soil != "no grains":
        builder.missing.append(f"the run did not write these fields: {', '.join(lacking)} (output.fields)")
    title = {"a column": "The column", "a biaxial specimen": "The specimen"}.get(what, "The ground")
    add_ground(builder, packed, first_point(result, what), charts_of(builder, result, what, stage, shown), title)


def charts_of(builder: Builder, result: Result, what: str, stage: str, shown: list[Any]) -> str:
    if what == "a tunnel" and stage == "volume_loss":
        return builder.charts(curves.of_tunnel(result, shown))
    if what == "a scene":
        return builder.charts(scene_curves.of_scene(result, shown))
    if what == "a biaxial specimen":
        return builder.charts(element_curves.of_specimen(result))
    if what == "a column":
        return builder.charts(element_curves.of_column(result))
    return ""


def first_point(result: Result, what: str) -> int:
    """The point that is followed until the reader clicks another one: Aa just above a tunnel's crown, and in a scene
    the point that is sheared most at the end."""
    if what in ("a tunnel", "an ensemble"):
        try:
            return points.above_crown(result)[0].index
        except (Missing, IndexError):
            pass
    if what == "a scene" and "gauss/deviatoric_strain" in result.increments[-1].names:
        strain = result.increments[-1].field("gauss/deviatoric_strain").ravel()
        return int(np.nanargmax(strain)) if np.isfinite(strain).any() else 0
    return 0


def add_ground(builder: Builder, packed: dict[str, Any], first: int, beside: str, title: str = "The ground") -> None:
    """Takes the ground into the page."""
    page = builder.page
    page.data |= {"ground": packed, "colourMaps": colour_maps(), "first_point": first}
    views = f'<div class="views"><div id="ground"></div><div class="charts">{beside}</div></div>'
    sliding = '<div id="slider" class="controls sliding"></div>'
    page.add(title, f'<p class="note">{markup.text(HINT)}</p>{sliding}{views}<div id="point"></div>')
