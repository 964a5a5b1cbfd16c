"""Pictures of a probe: responses to small strains beside the packing's tangent, and the path before them."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from .probes import COMPONENTS, STRAINED, Probe
from .result import Missing
from .style import CYCLE, LINES, MARKERS, save
from .tensors import deviatoric_strain

SAID = {
    "xx": "extension xx",
    "yy": "extension yy",
    "xy": r"shear $\gamma_{xy}$",
    "-xx": "compression xx",
    "-yy": "compression yy",
}


def draw_responses(probe: Probe, path: Path) -> None:
    """Change of stress over the size of the strain, in MPa: responses as symbols, tangents as bars."""
    strain, found = probe.strain()
    seeds = probe.seeds()
    figure, axes = plt.subplots(len(seeds), 1, figsize=(9.5, 4.4 * len(seeds) + 0.8), squeeze=False)
    for axis, seed in zip(axes.flat, seeds):
        rows = [row for row in probe.rows if row["seed"] == seed]
        _draw_seed(axis, probe, rows, strain)
        kinds = sorted({row.get("tangent", "") for row in rows} - {""})
        axis.set_title(f"packing of seed {seed}, tangent: {', '.join(kinds) or 'none'}")
    axes.flat[0].legend(loc="upper center", bbox_to_anchor=(0.5, 1.32), ncol=3)
    axes.flat[-1].set_xlabel(f"probe (size of the strain {strain:.3g}: {found})")
    figure.tight_layout()
    save(figure, path)


def _draw_seed(axis: Axes, probe: Probe, rows: list[dict[str, str]], strain: float) -> None:
    names = list(dict.fromkeys(row["probe"] for row in rows))
    for k, component in enumerate(COMPONENTS):
        symbol = rf"$\sigma_{{{component}}}$"
        for place, name in enumerate(names):
            here = [row for row in rows if row["probe"] == name]
            x = place + 0.26 * (k - 1)
            if name in STRAINED:
                axis.bar(x, probe.by_tangent(here[0])[k] / 1e6, width=0.24, color=CYCLE[k], alpha=0.45)
            values = np.array([probe.change(row)[k] for row in here]) / strain / 1e6
            axis.plot(np.full(len(values), x), values, MARKERS[k], color=CYCLE[k], markeredgecolor="black", zorder=3)
        axis.plot([], [], MARKERS[k], color=CYCLE[k], markeredgecolor="black", label=f"response {symbol}")
    for k, component in enumerate(COMPONENTS):
        axis.bar(0, 0, color=CYCLE[k], alpha=0.45, label=rf"by the tangent $\sigma_{{{component}}}$")
    axis.axhline(0, color="black", linewidth=0.8)
    axis.set_xticks(range(len(names)), [SAID.get(name, name) for name in names])
    axis.set_ylabel("change of stress over strain,\ntension positive  [MPa]")
    axis.grid(axis="x", visible=False)


def draw_path(probe: Probe, path: Path) -> None:
    if not probe.path:
        raise Missing("the probe had no path (path.csv)")
    figure, (stress, ratio, volume) = plt.subplots(1, 3, figsize=(16, 4.8))
    seeds = list(dict.fromkeys(row["seed"] for row in probe.path))
    for k, seed in enumerate(seeds):
        line = LINES[k % len(LINES)]
        # Compression and contraction are positive in the picture, extension and tension in the file.
        xx, yy = (-probe.path_of(seed, f"stress_{c}_Pa") for c in ("xx", "yy"))
        strain_xx, strain_yy = (-probe.path_of(seed, f"strain_{c}") for c in ("xx", "yy"))
        xy, strain_xy = probe.path_of(seed, "stress_xy_Pa"), probe.path_of(seed, "strain_xy")
        sheared = 100 * deviatoric_strain(np.stack([strain_xx, strain_yy, strain_xy], axis=-1))
        for j, (values, symbol) in enumerate(((xx, "xx"), (yy, "yy"), (np.abs(xy), "xy"))):
            label = rf"$|\sigma_{{{symbol}}}|$" if symbol == "xy" else rf"$\sigma_{{{symbol}}}$"
            stress.plot(sheared, values / 1e3, line, color=CYCLE[j], marker=".", label=label if k == 0 else None)
        p, q = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
        colour = CYCLE[k % len(CYCLE)]
        loaded = p > 0
        ratio.plot(sheared[loaded], q[loaded] / p[loaded], line, color=colour, marker=".", label=f"seed {seed}")
        volume.plot(sheared, 100 * (strain_xx + strain_yy), line, color=colour, marker=".", label=f"seed {seed}")
    stress.set_ylabel("stress, compression positive  [kPa]")
    ratio.set_ylabel("stress ratio  $q/p$  [-]")
    ratio.set_ylim(bottom=0)
    volume.set_ylabel(r"$\varepsilon_v$, contraction positive  [%]")
    volume.axhline(0, color="0.4", linewidth=0.8)
    for axis in (stress, ratio, volume):
        axis.set_xlabel(r"deviatoric strain  $\varepsilon_q$ since the start  [%]")
        axis.legend()
    figure.suptitle("Path before the probes, first replica of each packing", fontsize=12)
    figure.tight_layout()
    save(figure, path)
