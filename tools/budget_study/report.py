"""The tables of the study, as Markdown. Intervals are bootstrapped, since settlements need not be normal."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from .plan import Run, label_of
from .results import RESULTS, Measured, measured

HEAD_OF_DRAWS = (
    "| result | variety n | draws | mean | standard deviation (95 %) | over the mean | over that of n = 1 (95 %) "
    "| shift of the mean, p |"
)
RESAMPLES = 20000
CONFIDENCE = 0.95

Sample = np.ndarray  # (draw,)


def _interval(statistic: Callable[..., np.ndarray], *samples: Sample) -> tuple[float, float]:
    """The bootstrapped confidence interval of a statistic of independent samples; nan for a sample of less than 3.
    `statistic` takes arrays (resample, draw)."""
    if min(len(sample) for sample in samples) < 3:
        return float("nan"), float("nan")
    random = np.random.default_rng(1)
    resampled = [sample[random.integers(0, len(sample), (RESAMPLES, len(sample)))] for sample in samples]
    low, high = np.nanquantile(statistic(*resampled), [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    return float(low), float(high)


def _deviation(sample: np.ndarray) -> np.ndarray:
    return np.std(sample, axis=-1, ddof=1)


def _ratio_of_deviations(sample: np.ndarray, other: np.ndarray) -> np.ndarray:
    return _deviation(sample) / _deviation(other)


def _shift(sample: Sample, other: Sample) -> tuple[float, float]:
    """Difference of the means, and the probability of one as large between samples of one population (permutation)."""
    if min(len(sample), len(other)) < 3:
        return float(np.mean(sample) - np.mean(other)), float("nan")
    shift = float(np.mean(sample) - np.mean(other))
    random = np.random.default_rng(2)
    both = np.concatenate([sample, other])
    shuffled = random.permuted(np.tile(both, (RESAMPLES, 1)), axis=1)
    shifts = shuffled[:, : len(sample)].mean(axis=1) - shuffled[:, len(sample) :].mean(axis=1)
    return shift, float(np.mean(np.abs(shifts) >= abs(shift) - 1e-15))


def _groups(runs: Sequence[Run], folder: Path) -> dict[str, dict[int, Measured]]:
    """{group: {draw: what was measured}} of the runs that have come to their end, in the order of the plan."""
    found: dict[str, dict[int, Measured]] = {}
    for run in runs:
        numbers = measured(folder / run.name)
        found.setdefault(run.group, {})
        if numbers is not None:
            found[run.group][run.draw] = numbers
    return found


def _missing(groups: dict[str, dict[int, Measured]], runs: Sequence[Run]) -> str:
    done = sum(len(members) for members in groups.values())
    return "" if done == len(runs) else f"\n{len(runs) - done} of {len(runs)} runs have no result at V_l = 10 %.\n"


def _sample(members: dict[int, Measured], name: str) -> Sample:
    return np.array([m.values[name] for m in members.values()]) * RESULTS[name][2]


def draws(runs: Sequence[Run], folder: Path) -> str:
    """Scatter and mean at each variety; the ratio of the standard deviation to that of one packing, and the test of the
    means' difference from one packing."""
    groups = _groups(runs, folder)
    one = groups.get("k01", {})
    text = [HEAD_OF_DRAWS, "|---" * 8 + "|"]
    for name, (title, unit, _) in RESULTS.items():
        reference = _sample(one, name) if one else np.array([])
        for group, members in groups.items():
            sample = _sample(members, name)
            if len(sample) < 2:
                continue
            low, high = _interval(_deviation, sample)
            s, mean = float(_deviation(sample)), float(np.mean(sample))
            ratio = shift = "–"
            if group != "k01" and len(reference) > 1:
                least, most = _interval(_ratio_of_deviations, sample, reference)
                ratio = f"{s / float(_deviation(reference)):.2f} ({least:.2f}–{most:.2f})"
                difference, p = _shift(sample, reference)
                shift = f"{100 * difference / float(np.mean(reference)):+.1f} %, {p:.2f}"
            text.append(
                f"| {title} [{unit}] | {int(group[1:])} | {len(sample)} | {mean:.4g} | {s:.3g} ({low:.3g}–{high:.3g}) "
                f"| {100 * s / mean:.1f} % | {ratio} | {shift} |"
            )
    text += ["", "| K | draws | particle-steps | grains [s] | 10^6 steps a second | lanes' share in the loss |",
             "|---|---|---|---|---|---|"]  # fmt: skip
    for group, members in groups.items():
        if not members:
            continue
        steps = np.mean([m.particle_steps for m in members.values()])
        seconds = np.mean([m.seconds for m in members.values()])
        lanes = np.nanmean([m.lanes for m in members.values()])
        text.append(f"| {int(group[1:])} | {len(members)} | {steps:.3g} | {seconds:.0f} | {steps / seconds / 1e6:.0f} "
                    f"| {lanes:.2f} |")  # fmt: skip
    return "\n".join(text) + "\n" + _missing(groups, runs)


def knobs(runs: Sequence[Run], folder: Path) -> str:
    """The effect of each knob on each result: the mean over the draws of the difference from the base of the same draw,
    with its standard error, both as shares of the base's mean."""
    groups = _groups(runs, folder)
    base = groups.get("base", {})
    head = " | ".join(f"{title} [%]" for title, _, _ in RESULTS.values())
    text = [f"| knob | draws | {head} | particle-steps |", "|---" * (len(RESULTS) + 3) + "|"]
    if base:
        means = {name: float(np.mean(_sample(base, name))) for name in RESULTS}
        row = " | ".join(f"{means[name]:.4g} {unit}" for name, (_, unit, _) in RESULTS.items())
        steps = float(np.mean([m.particle_steps for m in base.values()]))
        text.append(f"| base | {len(base)} | {row} | {steps:.3g} |")
        if len(base) > 1:
            row = " | ".join(f"± {100 * float(_deviation(_sample(base, n))) / means[n]:.1f}" for n in RESULTS)
            text.append(f"| another draw (standard deviation) | {len(base)} | {row} | |")
    for group, members in groups.items():
        shared = sorted(set(members) & set(base))
        if group == "base" or not shared:
            continue
        cells = []
        for name in RESULTS:
            pairs = [members[k].values[name] - base[k].values[name] for k in shared]
            differences = 100 * RESULTS[name][2] * np.array(pairs) / means[name]
            error = f" ± {np.std(differences, ddof=1) / np.sqrt(len(shared)):.1f}" if len(shared) > 1 else ""
            cells.append(f"{np.mean(differences):+.1f}{error}")
        work = np.mean([members[k].particle_steps for k in shared]) / np.mean([base[k].particle_steps for k in shared])
        text.append(f"| {label_of(group)} | {len(shared)} | {' | '.join(cells)} | x {work:.2f} |")
    return "\n".join(text) + "\n" + _missing(groups, runs)
