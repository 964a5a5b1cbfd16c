"""The numbers that a run must give: lines of an expected.csv, and where each is measured.

A line is `stage,stage_index,column,value,tolerance`; the tolerance is absolute, in the value's SI unit. What a
line speaks of:

    gravity,-1,residual            run.h5:/table, the increment of that number in its stage; -1: the stage's last
    gravity,-1,mean void_ratio     the mean over all Gauss points of a field (its first component) after that increment
    tables/k0,-1,ratio             a row of run.h5:/tables/k0; -1: the last one
    probe.csv,0,tangent_xxxx_Pa    a row of a file of comma-separated values
    packings,3,pressure            the stored packing of seed 3, as packing_numbers measures it; -1: the mean of all
"""

import csv
from pathlib import Path

import h5py
import numpy as np
from program import check, table

# Contact moduli of the study's Table 1 by the largest diameter of their class [m], [Pa]. They stand here again, so that
# a program that reads, combines or uses them otherwise is found out.
MODULI = ((4.75e-3, 3e9), (19e-3, 4e9), (40e-3, 5e9))


def packing_numbers(file):
    """Numbers of a packing from its grains' places alone: all pairs are tried, forces follow from overlaps."""
    with h5py.File(file) as stored:
        x = np.column_stack([stored["x"][()], stored["y"][()]])
        radius, cell, thickness = stored["radius"][()], stored["cell"][()], float(stored.attrs["thickness"])
        seed = int(stored["numbers"].attrs["seed"])
    inside = x @ np.linalg.inv(cell).T
    apart = inside[None, :, :] - inside[:, None, :]
    branch = (apart - np.round(apart)) @ cell.T  # nearest images: the cell is hardly sheared
    i, j = np.triu_indices(len(radius), 1)
    length = np.hypot(branch[i, j, 0], branch[i, j, 1])
    overlap = radius[i] + radius[j] - length
    touching = overlap > 0
    stiffness = radius * np.array([next(e for size, e in MODULI if 2 * r <= size * (1 + 1e-9)) for r in radius])
    force = (2 * stiffness[i] * stiffness[j] / (stiffness[i] + stiffness[j]) * overlap)[touching]
    area, solid = abs(np.linalg.det(cell)), np.pi * np.sum(radius**2)
    return seed, {
        "void_ratio": area / solid - 1,
        "coordination": 2 * np.count_nonzero(touching) / len(radius),
        "pressure": np.sum(force * length[touching]) / (2 * area * thickness),
        "mean_diameter": 2 * np.mean(radius),
        "diameter_by_area": 2 * np.sum(radius**3) / np.sum(radius**2),
    }


def of_packings(folder, seed, column):
    packings = dict(packing_numbers(file) for file in sorted(Path(folder).glob("packing_*.h5")))
    check(packings and (seed < 0 or seed in packings), f"{folder} has no packing of seed {seed}")
    return float(np.mean([numbers[column] for numbers in packings.values()]) if seed < 0 else packings[seed][column])


def of_field(folder, row, name):
    with h5py.File(Path(folder) / "increments" / f"{row['index']:04d}.h5") as increment:
        return float(np.mean(increment[f"gauss/{name}"][..., 0]))


def measured(folder, packings, line):
    """The number that a line speaks of."""
    where, wanted, column = line["stage"], int(line["stage_index"]), line["column"]
    if where == "packings":
        return of_packings(packings, wanted, column)
    if where.endswith(".csv"):
        with (Path(folder) / where).open(newline="") as opened:
            return float(list(csv.DictReader(opened))[wanted][column])
    if where.startswith("tables/"):
        with h5py.File(Path(folder) / "run.h5", "r") as opened:
            check(f"{where}/{column}" in opened, f"{folder}: run.h5 has no {where}/{column}")
            return float(opened[f"{where}/{column}"][wanted])
    stage = [row for row in table(folder) if row["stage"] == where]
    matches = stage[-1:] if wanted < 0 else [row for row in stage if row["stage_index"] == wanted]
    check(matches, f"{folder}: no increment {wanted} of {where}")
    mean = "mean "
    if column.startswith(mean):
        return of_field(folder, matches[0], column.removeprefix(mean))
    return float(matches[0][column])


def check_expected(folder, expected, packings="packings"):
    """Every line of the file holds. All are measured before the first that does not is complained of."""
    with Path(expected).open(newline="") as opened:
        lines = list(csv.DictReader(row for row in opened if not row.startswith("#")))
    check(lines, f"{expected} expects nothing")
    missed = []
    for line in lines:
        value = measured(folder, packings, line)
        sentence = (
            f"{line['stage']} {line['stage_index']} {line['column']}: {value:.7g}, "
            f"expected {line['value']} +- {line['tolerance']}"
        )
        print(sentence)
        if not abs(value - float(line["value"])) <= float(line["tolerance"]):  # true for a NaN
            missed.append(sentence)
    check(not missed, f"{folder}: " + "; ".join(missed))
