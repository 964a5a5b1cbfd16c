"""The page of a sweep: how its runs ended, and the comparison over its axes."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from voussoir.figures.catalogue import figures_of
from voussoir.figures.result import Missing
from voussoir.figures.study import judging
from voussoir.figures.style import CYCLE
from voussoir.figures.sweep import Sweep
from voussoir.sweeps import COST, Run, SweepTable

from . import facts, markup, paper_sentences, pictures, sweep_grounds
from .fields import colour_maps
from .markup import Page
from .parts import Builder, name_of
from .sweep_points import CHARTS, Curves, Point, charts_of_scenes

STATES = ("unconverged increments", "cuts", "most RVEs at the step limit")
NOT_RUN = -1  # exit code of a run that nothing has begun (docs/reference/files.md, "A sweep")
REPORT = "report.html"  # of a point, to which the page links where it stands


def make(sweep: Sweep, folder: Path, only: list[str] | None = None) -> Builder:
    table = SweepTable(sweep)
    builder = Builder(Page(f"Sweep: {name_of(folder)}", _subtitle(table.runs)))
    _alarms(builder, table)
    for reason in sweep.left_out:
        builder.note(reason)
    points = [Point(table, name, runs, sweep.settings) for name, runs in table.points().items()]
    members = {p.name: p.members() if p.kind in ("tunnel", "scene", "biaxial_bvp", "column") else [] for p in points}
    curves = {p.name: p.curves(members[p.name]) for p in points}
    grounds, left_out = sweep_grounds.all_of(members)
    builder.missing += left_out
    known_failed = {run.name for run in table.runs if run.failed}
    for point in points:
        if known_failed.isdisjoint(run.name for run in point.runs):  # a failed run's gaps are told with its reason
            for fault in point.faults:
                builder.note(fault)
    builder.page.data |= {"sweep": _data(table, points, curves, grounds), "colourMaps": colour_maps()}
    _compare(builder, points, curves, grounds)
    drawn = pictures.draw_all(pictures.chosen(figures_of("a sweep"), only), sweep)
    study = paper_sentences.study_of_sweep(sweep)
    paper_sentences.apply(drawn.pictures, study)
    builder.figures(drawn)
    if study is not None:
        builder.judged("Trends between the tunnels", judging.between(study))
        rows = paper_sentences.all_figures(drawn.pictures, study)
        builder.page.add(
            "The paper's figures and tables", markup.table(("", "what it shows", "how ours compares"), rows)
        )
    _runs(builder, table)
    if table.input:
        builder.page.add("Input", markup.folded("the sweep file", f"<pre>{markup.text(table.input)}</pre>"))
    return builder


def points_of(sweep: Sweep) -> list[Path]:
    """The folders of a sweep's points that exist."""
    return [sweep.folder / name for name in SweepTable(sweep).points() if (sweep.folder / name).is_dir()]


def _subtitle(runs: Sequence[Run]) -> str:
    failed = sum(run.failed for run in runs)
    wall, steps = (float(np.nansum([run.cost.get(name, 0.0) for run in runs])) for name in ("wall_s", "particle_steps"))
    told = f"{len(runs)} runs, {failed} of them did not end well"
    return told + (f" · {wall / 3600:.3g} h of wall time in all, {steps:.3g} particle steps" if wall else "")


def _alarms(builder: Builder, table: SweepTable) -> None:
    """Failed runs and their reasons at the top."""
    if not table.gathered:
        builder.page.warnings.append(
            "The folder has no sweep.h5: the sweep is still computed, or was stopped. The page shows the runs that the "
            "folders hold, but not how they ended. `voussoir sweep FILE -o DIR --gather` makes the file."
        )
    for run in table.runs:
        if run.failed:
            reason = f": {run.reason}" if run.reason else ""
            how = f"FAILED: {run.name} ({run.status}, exit status {run.exit_code}){reason}"
            builder.page.warnings.append(f"{run.name} was not run" if run.exit_code == NOT_RUN else how)


def _data(
    table: SweepTable, points: Sequence[Point], curves: dict[str, Curves], grounds: dict[str, Any]
) -> dict[str, Any]:
    """What sweep.js needs."""
    told = []
    for point in points:
        link = f"{point.name}/{REPORT}" if (point.folder / REPORT).exists() else ""
        told.append(
            {
                "name": point.name,
                "group": _group(point),
                "axes": point.axes(),
                "results": point.results(),
                "curves": curves[point.name],
                "link": link,
            }
        )
    viridis = colour_maps()["viridis"]
    return {
        "points": told,
        "units": table.units,
        "grounds": grounds,
        "charts": {
            key: {"title": title, "xlabel": x, "ylabel": y, **further}
            for key, (title, x, y, further) in (CHARTS | charts_of_scenes(points)).items()
        },
        "colours": list(CYCLE),
        "many": [viridis[int(k)] for k in np.linspace(0, 225, 16)],
    }


def _group(point: Point) -> str:
    return f"{point.grid} ({point.kind})" if point.grid else point.kind


def _compare(builder: Builder, points: Sequence[Point], curves: dict[str, Curves], grounds: dict[str, Any]) -> None:
    """A place for each group of points that can be compared, and one for the small views of the ground."""
    for group in dict.fromkeys(_group(point) for point in points):
        inside = [point for point in points if _group(point) == group]
        if any(point.results() for point in inside) or any(curves[point.name] for point in inside):
            builder.page.add(f"Comparison: {group}", f'<div data-group="{markup.text(group)}"></div>')
    if grounds:
        builder.page.add("The ground of a point", '<div id="small"></div>')


def _runs(builder: Builder, table: SweepTable) -> None:
    """All runs, failed ones first, with their cost and the state of their increments."""
    axes = sorted({name for run in table.runs for name in run.axes})
    costs = [name for name in COST if any(name in run.cost for run in table.runs)]
    states = {run.name: _state(builder, table, run) for run in table.runs}
    with_states = any(states.values())
    head = ["run", "status", *axes, *(f"{name} [{COST[name]}]" for name in costs), *(STATES if with_states else ())]
    rows = []
    for run in sorted(table.runs, key=lambda run: not run.failed):
        status = f"<b>{markup.text(run.status)}</b>" if run.failed else run.status
        cost = [facts.amount(run.cost.get(name, np.nan)) for name in costs]
        state = (states[run.name] or ["–"] * len(STATES)) if with_states else []
        rows.append([run.name, status, *(run.axes.get(name, "–") for name in axes), *cost, *state])
    builder.page.add("Runs and their cost", markup.table(head, rows))


def _state(builder: Builder, table: SweepTable, run: Run) -> list[str]:
    """The numbers of STATES; unconverged increments are named at the top of the page. Empty without a run.h5."""
    try:
        of = facts.read(table.folder / run.name)
    except Missing as reason:
        if not run.failed:
            builder.note(reason)
        return []
    if not of.increments:
        return []
    unconverged = int((of.column("converged") == 0).sum())
    if unconverged:
        builder.page.warnings += [f"{run.name}: {line}" for line in facts.warnings(of) if line.startswith("NOT")]
    numbers = (unconverged, of.column("cuts").sum(), of.column("step_limit_points").max(initial=0))
    return [f"{number:.0f}" for number in numbers]
