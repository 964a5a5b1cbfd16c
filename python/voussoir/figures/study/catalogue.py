"""All figures of a study, by the name of their file, and study.md."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from .. import output, paper
from ..resolution import percent
from ..result import remembered
from ..sweep import Sweep
from . import fields, initial, judging, microstructure, paths, settlements, stresses
from .data import Study, Tunnel, open_study

STUDY_FIGURES: dict[str, Callable[[Study, Path], None]] = {
    "study_initial.png": initial.draw,
    "study_displacement.png": fields.draw_displacement,
    "study_shear_covers.png": fields.draw_shear_by_cover,
    "study_settlement_covers.png": settlements.draw_by_cover,
    "study_troughs.png": settlements.draw_troughs,
    "study_widths.png": settlements.draw_widths,
    "study_settlement_soils.png": settlements.draw_by_soil,
    "study_shear_soils.png": fields.draw_shear_by_soil,
    "study_reaction.png": stresses.draw_reaction,
    "study_stress_changes.png": stresses.draw_changes,
    "study_fabric.png": microstructure.draw_fabric,
    "study_rotation.png": stresses.draw_rotation,
    "study_localisation.png": microstructure.draw_localisation,
    "study_force_chains.png": microstructure.draw_chains,
    "study_rves.png": paths.draw_main,
    "study_rves_soils.png": paths.draw_soils,
    "study_connectivity.png": paths.draw_networks,
    "study_strong.png": microstructure.draw_strong,
}


def write(study: Study, path: Path) -> None:
    """study.md: the paper's figures with our files and sentences, and the trends judged over the members."""
    faults: list[Exception] = []
    lines = ["# The study", "", *_tunnels(study), "", *_figures(study), ""]
    tables = [("## Trends between tunnels", judging.between(study))]
    tables += [(f"## Trends: {_title(tunnel)}", judging.of_tunnel(tunnel)) for tunnel in study.tunnels]
    for heading, rows in tables:
        lines += [heading, "", "| trend | verdict | numbers |", "|---|---|---|"]
        for row in rows:
            lines.append(f"| {row.statement} | **{row.verdict}** | {_cell(row.numbers)} |")
            faults += row.faults
        lines.append("")
    output.write(path, "\n".join(lines))
    if faults:
        raise faults[0]  # the file is written, and the fault is told


def _title(tunnel: Tunnel) -> str:
    return f"{tunnel.name} ({tunnel.label.replace('$', '')})"


def _cell(text: str) -> str:
    return text.replace("|", "/")


def _tunnels(study: Study) -> list[str]:
    lines = [
        "Numbers are means over the members ± half width of the 95 % band of the mean. A number without ± is of a",
        "single run, or the members do not differ in it.",
        "",
        "| tunnel | soil | C/D | members | V_l to | member of the fields |",
        "|---|---|---|---|---|---|",
    ]
    for tunnel in study.tunnels:
        soil = tunnel.soil if tunnel.code == tunnel.soil else f"{tunnel.soil} ({tunnel.code})"
        members = str(tunnel.count) if tunnel.count > 1 else "a single run: no bands"
        lines.append(
            f"| {tunnel.name} | {soil} | {tunnel.cover_ratio:.3g} | {members} | "
            f"{percent(float(tunnel.loss[-1]))} | {tunnel.representative.folder.name} |"
        )
    if study.left_out:
        lines += ["", "Left out: " + "; ".join(str(reason) for reason in study.left_out) + "."]
    return lines


def _figures(study: Study) -> list[str]:
    lines = [
        "## The paper's figures and tables",
        "",
        "| paper | what | ours | how ours compares |",
        "|---|---|---|---|",
    ]
    for figure in paper.FIGURES:
        files = ", ".join(figure.files) or "-"
        number = figure.number if figure.number.startswith("Table") else f"Fig. {figure.number}"
        lines.append(f"| {number} | {figure.what} | {files} | {_cell(paper.sentence(figure, study))} |")
    return lines


def study_of(sweep: Sweep) -> Study:
    """The study of a sweep's tunnels, which is opened once and kept with the sweep."""
    sweep.of_kind("tunnel")
    return remembered(sweep, "study", lambda: open_study([sweep.folder], sweep.settings))


def _of_sweep(name: str, sweep: Sweep, path: Path) -> None:
    {**STUDY_FIGURES, "study.md": write}[name](study_of(sweep), path)


# For the catalogue of what a sweep holds.
OF_SWEEP: dict[str, Callable[[Sweep, Path], None]] = {
    name: partial(_of_sweep, name) for name in (*STUDY_FIGURES, "study.md")
}
