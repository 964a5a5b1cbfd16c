"""Tables (Markdown) and curves of the study."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter
from voussoir.figures.style import save, use_style

from .errors import STRAINS, evaluation_error, noise_share, path, path_error, path_scatter, probes
from .plan import INCREMENTS, PRESSURES, Setting, settings

STATES = ("isotropic", "sheared")
# Knobs whose paths have the increments of the reference solution. The search for sigma_xx is then the same in both, so
# that its error cancels.
LINES = {"inertial_number": ("C0", "o"), "hold_tolerance": ("C1", "s"), "hold_cap": ("C2", "v")}
PRESETS = {"fast": ("C3", "X"), "standard": ("black", "P"), "reference": ("C5", "D")}


class Findings:
    """All errors, read once: evaluation[kpa, state][setting name] and path[kpa][setting name]."""

    def __init__(self, study):
        self.study = study
        self.chosen = settings()  # settings of all knobs, so that a study made in parts shows all its results
        self.evaluation, self.paths, self.scatter, self.curves = {}, {}, {}, {}
        for kpa in study.pressures:
            reference = study.reference(kpa)
            every = (reference, *self.chosen)
            for state in STATES:
                theirs = probes(study.probe_folders(reference, kpa, state).values())
                self.evaluation[kpa, state] = {
                    s.name: evaluation_error(probes(study.probe_folders(s, kpa, state).values()), theirs) for s in every
                }
            theirs = path(study.path_folders(reference, kpa).values())
            self.curves[kpa] = {s.name: path(study.path_folders(s, kpa).values()) for s in every}
            self.paths[kpa] = {name: path_error(ours, theirs) for name, ours in self.curves[kpa].items() if ours}
            self.scatter[kpa] = {name: path_scatter(ours) for name, ours in self.curves[kpa].items() if ours}


def figure_of(value, digits=2):
    if value is None or not np.isfinite(value):
        return "–"
    return f"{value:.{digits}g}" if abs(value) < 100 else f"{value:.0f}"


def row(cells):
    return "| " + " | ".join(cells) + " |\n"


def head(cells):
    return row(cells) + row(["---"] * len(cells))


def table_of_presets(findings):
    """Errors as root mean square | median | worst sample."""
    three = lambda found: " | ".join(figure_of(found.get(key, np.nan)) for key in ("error", "median", "worst"))  # noqa: E731
    triple = ("rms", "median", "worst")
    text = head(
        [
            "preset",
            "p",
            *(f"isotropic: {t}" for t in triple),
            *(f"sheared: {t}" for t in triple),
            "at rest, %",
            "tangent, isotropic",
            "sheared",
            "steps",
            *(f"path: {t}" for t in triple),
            "of it systematic",
            "volumetric strain",
            "steps an increment",
        ]
    )
    for name in PRESETS:
        setting = f"preset_{name}"
        for kpa in findings.study.pressures:
            isotropic, sheared = (findings.evaluation[kpa, state].get(setting, {}) for state in STATES)
            way = findings.paths[kpa].get(setting, {})
            cell = lambda found, key: figure_of(found.get(key, np.nan))  # noqa: E731
            text += row(
                [
                    name,
                    PRESSURES[kpa],
                    three(isotropic),
                    three(sheared),
                    figure_of(100 - sheared.get("flagged", np.nan), 3),
                    cell(isotropic, "tangent_median"),
                    cell(sheared, "tangent_median"),
                    cell(sheared, "steps"),
                    three(way),
                    f"{cell(way, 'bias')} ± {cell(way, 'bias_error')}",
                    cell(way, "volume_rms"),
                    figure_of(way.get("steps", np.nan) / INCREMENTS),
                ]
            )
    return text


def table_of_scatter(findings):
    text = head(
        [
            "p",
            "evaluation: replicas",
            "path: replicas of the reference solution",
            "path: replicas of `standard`",
            "path: packings",
            "q/p at the end",
            "volumetric strain at the end",
        ]
    )
    for kpa in findings.study.pressures:
        reference, standard = (
            findings.scatter[kpa].get("reference_solution", {}),
            findings.scatter[kpa].get("preset_standard", {}),
        )
        cell = lambda found, key, digits=2: figure_of(found.get(key, np.nan), digits)  # noqa: E731
        text += row(
            [
                PRESSURES[kpa],
                cell(findings.evaluation[kpa, "sheared"].get("reference_solution", {}), "scatter"),
                cell(reference, "chaos"),
                cell(standard, "chaos"),
                cell(reference, "packings"),
                cell(reference, "ratio", 3),
                cell(reference, "volume", 3),
            ]
        )
    return text


def table_of_knob(findings, knob):
    """A table of medians: in a mean, one packing that rearranges suddenly would hide what the knob does to all
    others."""
    text = head(
        [
            f"`{knob}`",
            *(
                f"{PRESSURES[kpa]}: {what}"
                for kpa in findings.study.pressures
                for what in ("evaluation", "tangent", "path", "steps")
            ),
        ]
    )
    for setting in (s for s in findings.chosen if s.knob == knob):
        cells = [setting.label]
        for kpa in findings.study.pressures:
            once, way = (
                findings.evaluation[kpa, "sheared"].get(setting.name, {}),
                findings.paths[kpa].get(setting.name, {}),
            )
            cells += [
                figure_of(found.get(key, np.nan))
                for found, key in ((once, "median"), (once, "tangent_median"), (way, "median"))
            ]
            cells.append(figure_of(way.get("steps", np.nan) / setting.increments))
        text += row(cells)
    return text


def table_of_matter(findings, knob):
    """A table of the knobs that change the material itself: their differences are not errors."""
    text = head(
        [
            f"`{knob}`",
            *(
                f"{PRESSURES[kpa]}: {what}"
                for kpa in findings.study.pressures
                for what in ("q/p", "scatter of packings, %", "volumetric strain, %", "steps")
            ),
        ]
    )
    for setting in (s for s in findings.chosen if s.knob == knob):
        cells = [setting.label]
        for kpa in findings.study.pressures:
            found = findings.scatter[kpa].get(setting.name, {})
            cells += [
                figure_of(found.get("ratio", np.nan), 3),
                figure_of(100 * found.get("cov", np.nan)),
                figure_of(found.get("volume", np.nan), 3),
                figure_of(found.get("steps", np.nan) / setting.increments),
            ]
        text += row(cells)
    return text


def table_of_noise(findings):
    study, every = findings.study, {s.name: s for s in findings.chosen}
    text = head(["ended by", *(f"{PRESSURES[kpa]}, {state}" for kpa in study.pressures for state in STATES)])
    for name in ("hold_cap_0", "hold_tolerance_0.01", "hold_tolerance_0.003", "hold_tolerance_0.001"):
        cells = [name.replace("_0", " 0")]
        for kpa in study.pressures:
            for state in STATES:
                ours, still = (
                    probes(study.probe_folders(every[n], kpa, state).values()) for n in (name, "hold_tolerance_0.0001")
                )
                cells.append(figure_of(noise_share(ours, still)))
        text += row(cells)
    return text


def table_of_paths(findings, knob):
    """Errors of paths: root mean square, median and worst over packings, and the steps of an increment."""
    text = head([f"`{knob}`", *(PRESSURES[kpa] for kpa in findings.study.pressures)])
    for setting in (s for s in findings.chosen if s.knob == knob):
        cells = [setting.label]
        for kpa in findings.study.pressures:
            way = findings.paths[kpa].get(setting.name, {})
            errors = ", ".join(figure_of(way.get(key, np.nan)) for key in ("error", "median", "worst"))
            cells.append(f"{errors}; {figure_of(way.get('steps', np.nan) / setting.increments)}")
        text += row(cells)
    return text


def tables(findings):
    """All tables of the settings that were run."""
    done = {s.knob for s in findings.chosen if any(s.name in findings.paths[kpa] for kpa in findings.study.pressures)}
    parts = [("Presets", table_of_presets(findings))] if "preset" in done else []
    parts.append(("Scatter", table_of_scatter(findings)))
    parts += [
        (f"{knob}: paths, rms, median, worst; steps", table_of_paths(findings, knob))
        for knob in ("curve", "accuracy", "floor_and_hold")
        if knob in done
    ]
    parts += [
        (knob, table_of_knob(findings, knob))
        for knob in (
            "inertial_number",
            "hold_tolerance",
            "hold_cap",
            "minimum_steps",
            "maximum_steps",
            "skin",
            "precision",
            "increments",
        )
        if knob in done
    ]
    parts += [(knob, table_of_matter(findings, knob)) for knob in ("modulus", "grains") if knob in done]
    if {"hold_cap", "hold_tolerance"} <= done:
        parts.append(("Noise share", table_of_noise(findings)))
    return "".join(f"## {title}\n\n{text}\n" for title, text in parts)


def points(findings, knob, measure):
    """Steps and errors along one knob."""
    found = [measure(s) for s in findings.chosen if s.knob == knob]
    found = sorted((steps, error) for steps, error in found if np.isfinite(steps * error) and error > 0)
    return np.array(found).reshape(-1, 2)


def _evaluation(findings, setting, kpa, key):
    found = findings.evaluation[kpa, "sheared"].get(setting.name, {})
    return found.get("steps", np.nan), found.get(key, np.nan)


def _path(findings, setting, kpa):
    found = findings.paths[kpa].get(setting.name, {})
    return found.get("steps", np.nan) / setting.increments, found.get("median", np.nan)


ROWS = (
    ("one evaluation, sheared state", "median error of stress, % of p", lambda f, s, k: _evaluation(f, s, k, "median")),
    ("tangent (4) after it", "median error of tangent, %", lambda f, s, k: _evaluation(f, s, k, "tangent_median")),
    ("path to 5 % shear", "median error of q/p, % of p", _path),
)


def draw_errors(findings, file):
    pressures = findings.study.pressures
    figure, axes = plt.subplots(
        len(ROWS), len(pressures), figsize=(4.1 * len(pressures), 3.3 * len(ROWS)), sharex="col", squeeze=False
    )
    for column, kpa in enumerate(pressures):
        for axis, (what, _, measure) in zip(axes[:, column], ROWS, strict=True):
            draw_knobs(axis, findings, lambda s, k=kpa, of=measure: of(findings, s, k))
            axis.set_title(f"{PRESSURES[kpa]}, {what}")
        scatter = findings.scatter[kpa].get("reference_solution", {})
        axes[-1][column].axhline(
            scatter.get("packings", np.nan), color="0.5", linestyle=":", label="scatter of packings"
        )
        axes[-1][column].axhline(scatter.get("chaos", np.nan), color="0.5", linestyle="--", label="scatter of replicas")
        axes[-1][column].set_xlabel("steps of an increment (all its evaluations)")
        axes[-1][column].xaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        low, high = axes[-1][column].get_xlim()
        axes[-1][column].xaxis.set_minor_formatter("{x:g}" if high < 100 * low else NullFormatter())
        axes[-1][column].xaxis.set_major_formatter("{x:g}")
    for axis, (_, label, _) in zip(axes[:, 0], ROWS, strict=True):
        axis.set_ylabel(label)
    handles, labels = axes[-1][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=4 if len(pressures) > 1 else 2, fontsize=9)
    figure.tight_layout(rect=(0, 0.06 if len(pressures) > 1 else 0.1, 1, 1))
    save(figure, file)


def draw_knobs(axis, findings, measure):
    for knob, (color, marker) in LINES.items():
        axis.loglog(
            *points(findings, knob, measure).T, marker=marker, color=color, markersize=5, label=knob.replace("_", " ")
        )
    for name, (color, marker) in PRESETS.items():
        axis.loglog(
            *measure(Setting("preset", name)),
            marker=marker,
            color=color,
            markersize=10,
            linestyle="",
            label=f"preset {name}",
            zorder=5,
        )


def draw_paths(findings, file):
    """The first packing's path with each preset, and the range of all packings with the reference solution."""
    pressures = findings.study.pressures
    figure, axes = plt.subplots(2, len(pressures), figsize=(4.1 * len(pressures), 6.2), sharex=True, squeeze=False)
    for column, kpa in enumerate(pressures):
        for line, (key, scale) in enumerate((("ratio", 1), ("volume", 100))):
            axis = axes[line][column]
            curves = findings.curves[kpa]
            spread = np.array([c[key].mean(axis=0) for c in curves.get("reference_solution", {}).values()]) * scale
            if spread.size:
                axis.fill_between(
                    100 * STRAINS, spread.min(axis=0), spread.max(axis=0), color="0.85", label="all packings"
                )
            for name, (color, marker) in PRESETS.items():
                found = curves.get(f"preset_{name}", {})
                if found:
                    axis.plot(
                        100 * STRAINS,
                        scale * found[min(found)][key].mean(axis=0),
                        color=color,
                        marker=marker,
                        markersize=6,
                        label=f"preset {name}",
                    )
        axes[0][column].set_title(PRESSURES[kpa])
        axes[1][column].set_xlabel("axial strain, %")
    axes[0][0].set_ylabel("q/p")
    axes[1][0].set_ylabel("volumetric strain, %")
    axes[1][-1].legend(fontsize=8)
    figure.tight_layout()
    save(figure, file)


def write(study, folder):
    use_style()
    findings = Findings(study)
    (folder / "tables.md").write_text(tables(findings))
    draw_errors(findings, folder / "trade_errors.png")
    draw_paths(findings, folder / "trade_paths.png")
