"""From the tables of the runs to errors in percent of the pressure: root mean squares, medians and the worst of all
samples. These measures differ where a packing rearranges suddenly: if the rearrangement comes before the end with one
setting and after the end with another one, the difference is larger than that of all other packings together.

The error of an evaluation (one increment from a given state) is e = |sigma - sigma_ref| / (sqrt(2) P), with |.| the
tensor's norm and P the larger pressure of before and after, so that an isotropic error of P is 100 %. sigma_ref is the
mean of the reference solution's replicas, the same seed, state and direction. The error of the tangent of eq. (4) after
the evaluation is |D - D_ref| / |D_ref|, with the norm of fourth-order tensors (`TANGENT_NORM`). The error of a path is
e = q/p - (q/p)_ref at the same axial strain (of a path of shear: shear strain), as the mean of replicas.
"""

import csv

import numpy as np

DIRECTIONS = ("xx", "yy", "xy", "-xx", "-yy")
NORM = np.sqrt(np.array([1.0, 1.0, 2.0]) / 2)  # (xx, yy, xy): |.| / sqrt(2)
TANGENT_NORM = np.sqrt(
    np.array([1.0, 2.0, 4.0, 1.0, 4.0, 4.0])
)  # xxxx xxyy xxxy yyyy yyxy xyxy: the number of times that each occurs in the sum
TANGENT = tuple(f"tangent_after_{name}_Pa" for name in ("xxxx", "xxyy", "xxxy", "yyyy", "yyxy", "xyxy"))
STRAINS = 0.004987 * np.arange(1, 6)  # axial strains that the increments of every size in the plan reach, either way


def read(file):
    """Columns of a table; a missing one (a run that failed) is empty."""
    if not file.exists():
        return {}
    with file.open(newline="") as opened:
        rows = list(csv.DictReader(opened))
    columns = {}
    for name in rows[0] if rows else ():
        values = [row[name] for row in rows]
        try:
            columns[name] = np.array([float(v) for v in values])
        except ValueError:
            columns[name] = np.array(values)
    return columns


def rms(values):
    return float(np.sqrt(np.mean(np.square(values)))) if np.size(values) else np.nan


def median(values):
    return float(np.median(values)) if np.size(values) else np.nan


def stresses(table):
    return np.stack([table["stress_xx_Pa"], table["stress_yy_Pa"], table["stress_xy_Pa"]], axis=-1)


def probes(folders):
    """{(seed, direction): (stress (replica, 3), change (replica, 3), steps, unbalanced, at rest, tangent (replica, 6))}
    of runs."""
    found = {}
    for folder in folders:
        table = read(folder / "probe.csv")
        if not table:
            continue
        stress = stresses(table)
        change = np.stack([table["change_xx_Pa"], table["change_yy_Pa"], table["change_xy_Pa"]], axis=-1)
        tangent = np.stack([table[name] for name in TANGENT], axis=-1)
        for seed in np.unique(table["seed"]):
            for direction in DIRECTIONS:
                rows = (table["seed"] == seed) & (table["probe"] == direction)
                found[int(seed), direction] = (
                    stress[rows],
                    change[rows],
                    table["steps"][rows],
                    table["unbalanced_ratio"][rows],
                    np.isin(table["status"][rows], ("converged", "open")),
                    tangent[rows],
                )
    return found


def pressure(stress):
    return -0.5 * (stress[..., 0] + stress[..., 1])


def evaluation_error(ours, reference):
    """Errors over all seeds and directions that came to rest, in percent of P. `flagged` is the share of the others,
    whose status says that they are not at rest: a packing that collapses or opens within the increment still moves when
    the hold ends."""
    total, bias, along, scatter, tangents, steps, flagged = [], [], [], [], [], [], []
    for key, (stress, _, count, _, at_rest, tangent) in ours.items():
        if key not in reference:
            continue
        theirs, their_change, *_, their_tangent = reference[key]
        steps.append(count.mean())
        flagged.append(1 - at_rest.mean())
        if not at_rest.all():
            continue
        mean = theirs.mean(axis=0)
        p = max(pressure(mean), pressure(mean - their_change.mean(axis=0)))
        off = (stress - mean) * NORM / p
        total.append(rms(np.linalg.norm(off, axis=1)))
        bias.append(np.linalg.norm(off.mean(axis=0)))
        step = their_change.mean(axis=0) * NORM / p
        along.append(off.mean(axis=0) @ step / max(np.linalg.norm(step), 1e-12))
        if their_tangent.any():  # a packing without contacts has no tangent
            tangents.append(tangent_error(tangent, their_tangent.mean(axis=0)))
        scatter.append(rms(np.linalg.norm((theirs - mean) * NORM / p, axis=1)))
    if not total:
        return {}
    return {
        "error": 100 * rms(total),
        "median": 100 * median(total),
        "bias": 100 * rms(bias),
        "along": 100 * float(np.mean(along)),
        "scatter": 100 * rms(scatter),
        "tangent": 100 * rms(tangents),
        "tangent_median": 100 * median(tangents),
        "worst": 100 * max(total),
        "steps": float(np.mean(steps)),
        "flagged": 100 * float(np.mean(flagged)),
        "samples": len(total),
    }


def tangent_error(tangent, reference):
    return rms(np.linalg.norm((tangent - reference) * TANGENT_NORM, axis=1) / np.linalg.norm(reference * TANGENT_NORM))


def path(folders):
    """{seed: q/p and volumetric strain (replica, strain), steps and evaluations, share of increments at the step
    limit}"""
    found = {}
    for folder in folders:
        table = read(folder / "path.csv")
        for seed in np.unique(table["seed"]) if table else ():
            found[int(seed)] = path_of(table, seed)
    return found


def path_of(table, seed):
    stress = stresses(table)
    ratio = np.hypot(0.5 * (stress[:, 1] - stress[:, 0]), stress[:, 2]) / pressure(stress)
    volume = -(table["strain_xx"] + table["strain_yy"])  # compression positive
    curves, volumes, steps = [], [], []
    for replica in np.unique(table["replica"]):
        rows = (table["seed"] == seed) & (table["replica"] == replica)
        axial = np.maximum(np.abs(table["strain_yy"]), 2 * np.abs(table["strain_xy"]))[rows]
        curves.append(np.interp(STRAINS, axial, ratio[rows], right=np.nan))
        volumes.append(np.interp(STRAINS, axial, volume[rows], right=np.nan))
        steps.append(np.sum((table["steps"] * table["evaluations"])[rows]))
    rows = (table["seed"] == seed) & (table["increment"] > 0)
    return {
        "ratio": np.array(curves),
        "volume": np.array(volumes),
        "steps": float(np.mean(steps)),
        "evaluations": float(table["evaluations"][rows].mean()),
        "capped": float(np.mean(table["status"][rows] == "step_limit")),
    }


def path_error(ours, reference):
    """Errors over seeds and the path's strains: q/p in percent of p, volumetric strain in percent of strain."""
    seeds = sorted(set(ours) & set(reference))
    if not seeds:
        return {}
    off = np.array([ours[s]["ratio"].mean(axis=0) - reference[s]["ratio"].mean(axis=0) for s in seeds])
    each = np.array([rms(ours[s]["ratio"] - reference[s]["ratio"].mean(axis=0)) for s in seeds])
    volume = np.array([ours[s]["volume"].mean(axis=0) - reference[s]["volume"].mean(axis=0) for s in seeds])
    systematic = off.mean(axis=1)
    return {
        "error": 100 * rms(each),
        "median": 100 * median(each),
        "worst": 100 * each.max(),
        "bias": 100 * systematic.mean(),
        "bias_error": 100 * systematic.std(ddof=1) / np.sqrt(len(seeds)) if len(seeds) > 1 else np.nan,
        "volume": 100 * volume[:, -1].mean(),
        "volume_rms": 100 * rms(volume[:, -1]),
        "steps": float(np.mean([ours[s]["steps"] for s in seeds])),
        "evaluations": float(np.mean([ours[s]["evaluations"] for s in seeds])),
        "capped": float(np.mean([ours[s]["capped"] for s in seeds])),
        "samples": len(seeds),
    }


def path_scatter(curves):
    """The scatter of one setting, in percent of p: by chaos (replicas of a seed) and between packings (seeds); and
    means over seeds at the path's end."""
    chaos = rms([rms(c["ratio"] - c["ratio"].mean(axis=0)) for c in curves.values()])
    means = np.array([c["ratio"].mean(axis=0) for c in curves.values()])
    volumes = np.array([c["volume"].mean(axis=0)[-1] for c in curves.values()])
    return {
        "chaos": 100 * chaos,
        "packings": 100 * rms(means.std(axis=0, ddof=1)) if len(means) > 1 else np.nan,
        "ratio": float(means.mean(axis=0)[-1]),
        "cov": float(np.nanmean(means.std(axis=0, ddof=1) / means.mean(axis=0))) if len(means) > 1 else np.nan,
        "volume": 100 * float(volumes.mean()),
        "steps": float(np.mean([c["steps"] for c in curves.values()])),
    }


def noise_share(ours, at_rest):
    """The error of a stress component after an early end of the hold, over unbalanced ratio x pressure. The pool of
    RVEs assumes this share when it reports the noise of its stresses to Newton (host/material/answers.cpp). `at_rest`
    are the same evaluations with a longer hold."""
    off, expected = [], []
    for key, (stress, _, _, unbalanced, *_) in ours.items():
        if key in at_rest:
            off.append(rms(stress - at_rest[key][0]))
            expected.append(rms(unbalanced * np.maximum(pressure(stress), 100.0)))
    return rms(off) / rms(expected) if off else np.nan
