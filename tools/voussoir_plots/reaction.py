"""Ground reaction curve: vertical stress just above the crown against the volume loss."""

import matplotlib.pyplot as plt
import numpy as np

from .result import Missing
from .style import save


def crown_element(result):
    """The element just above the crown: of those that hold the crown's node, the one whose centre lies highest."""
    holders = np.flatnonzero(np.any(result.connectivity == result.crown(), axis=1))
    heights = result.coordinates[result.connectivity[holders]].mean(axis=1)[:, 1]
    return holders[np.argmax(heights)]


def vertical_stress(increment, element):
    """Mean over the element's four points [Pa], compression positive."""
    return -increment.field("gauss/stress")[element, :, 1].mean()


def draw(result, path):
    element = crown_element(result)
    losses = result.stage("volume_loss")
    before = [i for i in losses if i["volume_loss"] == 0] or result.stage("gravity")[-1:]
    start = vertical_stress(before[-1], element)
    if not start > 0:
        raise Missing("the crown is not compressed before the volume loss")
    after = [i for i in losses if i["volume_loss"] > 0]
    loss = np.array([0.0] + [100 * i["volume_loss"] for i in after])
    stress = np.array([start] + [vertical_stress(i, element) for i in after])
    figure, axis = plt.subplots(figsize=(6.6, 4.6))
    axis.plot(loss, stress / start, "o-", color="C0", markersize=3.5)
    axis.set_xlabel("volume loss  $V_l$  [%]")
    axis.set_ylabel(r"vertical stress above the crown  $\sigma_v / \sigma_{v,0}$  [-]")
    axis.set_xlim(left=0)
    axis.set_ylim(min(0, 1.05 * stress.min() / start), 1.05 * max(1, stress.max() / start))
    axis.set_title(rf"Ground reaction curve,  $\sigma_{{v,0}}$ = {start / 1e3:.4g} kPa")
    save(figure, path)
