"""Width parameters of the troughs: K against V_l and depth, beside Mair and Taylor's range."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from . import troughs
from .resolution import percent
from .result import Result
from .style import colours, save


def surface_width(result: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """V_l, K_s and whether the trough has the curve's shape, over the volume loss."""
    found = [t for (ratio, _), t in troughs.all_troughs(result).items() if ratio == 0]
    return (
        np.array([t.loss for t in found]),
        np.array([t.width for t in found]),
        np.array([t.fit.good for t in found]),
    )


def draw(result: Result, path: Path) -> None:
    found = troughs.all_troughs(result)
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 4.6))
    depths = result.settings.depths
    for ratio, colour in zip(depths, colours("cividis", len(depths))):
        along = [t for (z, _), t in found.items() if z == ratio]
        loss, width = np.array([100 * t.loss for t in along]), np.array([t.width for t in along])
        good = np.array([t.fit.good for t in along])
        left.plot(loss, width, color=colour, linewidth=1.0, label=f"{ratio:g}" + ("  ($K_s$)" if ratio == 0 else ""))
        left.plot(loss[good], width[good], "o", color=colour, markersize=3.5)
    left.legend(title="$z/C$")
    left.set_xlim(left=0)
    left.set_xlabel("volume loss  $V_l$  [%]")
    left.set_title(r"symbols: $\alpha$ within its bounds, misfit below 3 %", fontsize=11)
    for increment, colour in zip(result.losses, colours("viridis", len(result.losses))):
        at = [found[ratio, increment["volume_loss"]] for ratio in depths]
        right.plot([t.width for t in at], depths, "-", color=colour, linewidth=1)
        right.plot(
            [t.width for t in at if t.fit.good],
            [t.ratio for t in at if t.fit.good],
            "o",
            color=colour,
            markersize=5,
            label=percent(increment["volume_loss"]),
        )
    right.invert_yaxis()
    right.set_xlabel("width parameter  $K = i / (z_t - z)$  [-]")
    right.set_ylabel("depth over cover  $z/C$  [-]")
    right.legend(title="$V_l$")
    low, high = result.settings.range_of_k
    left.axhspan(low, high, color="0.88", zorder=0)
    right.axvspan(low, high, color="0.88", zorder=0)
    left.set_ylabel("width parameter  $K$  [-]")
    left.set_ylim(bottom=0)
    right.set_xlim(left=0)
    figure.suptitle(
        f"Widths of the settlement troughs; grey: Mair and Taylor's range for cohesionless soils, {low:g} to {high:g}",
        fontsize=12,
    )
    figure.tight_layout()
    save(figure, path)
