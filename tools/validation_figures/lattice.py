"""A square lattice of equal discs through the whole program, against its closed form.

Every disc touches four others, along x and y, and by symmetry no disc moves or turns against the homogeneous strain.
With the spacing b, the overlap delta = 2 r - b, the pressure p = k_n delta / (b t), k_n = E r (two equal discs) and
k_t = ratio k_n the stress of Love and Weber changes by

    d sigma_xx / d eps_xx   = k_n / t               d sigma_yy / d eps_xx = p
    d sigma_xy / d gamma_xy = (k_t / (2 t)) (2 r / b) - p

for small strains of the state under pressure; eq. (4) is k_n / t and k_t / (2 t).
"""

import csv
import json
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from voussoir.figures.style import CYCLE, save

from .program import Program

SIDE, RADIUS, THICKNESS, MODULUS, STRAIN = 6, 2e-3, 0.1, 3e9, 1e-6  # discs a side, [m], [m], [Pa], [-]
RATIOS = (0.2, 0.5, 0.8, 1.0)
CASE = f"""\
kind = "probe"
title = "square lattice"

[packing]
file = "lattice_particles.csv"

[engine]
precision = "double"
hold_tolerance = 1e-6
hold_cap = 200000

[probe]
pressure = "100 kPa"
strain = {STRAIN}
tangent = "contact"

[[probe.path]]
gradient = [0, 0, 0, 0]
"""


@dataclass
class Answer:
    """Stiffnesses [Pa]: of the probes by the program and by the closed form, and eq. (4) by the program."""

    ratio: float
    axial: float
    lateral: float
    shear: float
    axial_form: float
    lateral_form: float
    shear_form: float
    axial_equation_4: float
    shear_equation_4: float

    def largest_difference(self) -> float:
        pairs = ((self.axial, self.axial_form), (self.lateral, self.lateral_form), (self.shear, self.shear_form))
        return max(abs(found / form - 1) for found, form in pairs)


def write_case(folder: Path) -> Path:
    """The packing in the form of other codes' packings, and a case that reads it."""
    folder.mkdir(parents=True, exist_ok=True)
    spacing = 2 * RADIUS * (1 + 1e-5)  # the program brings the discs together
    rows = [f"{k},{(k % SIDE + 0.5) * spacing!r},{(k // SIDE + 0.5) * spacing!r},{RADIUS},0" for k in range(SIDE**2)]
    (folder / "lattice_particles.csv").write_text("\n".join(["id,x_m,y_m,r_m,theta_z_rad", *rows]) + "\n")
    length = SIDE * spacing
    cell = [[length, 0, 0], [0, length, 0], [0, 0, THICKNESS]]
    meta = {"tag": "lattice", "N": SIDE**2, "Lz": THICKNESS, "hSize": cell}
    (folder / "lattice_meta.json").write_text(json.dumps(meta))
    case = folder / "lattice.toml"
    case.write_text(CASE)
    return case


def answer(folder: Path, ratio: float) -> Answer:
    with (folder / "probe.csv").open() as file:
        rows = {row["probe"]: row for row in csv.DictReader(file)}
    with (folder / "path.csv").open() as file:
        start = next(csv.DictReader(file))
    pressure = -float(start["stress_xx_Pa"])
    stiffness = MODULUS * RADIUS
    overlap = pressure * THICKNESS / stiffness  # over the spacing b
    return Answer(
        ratio,
        float(rows["xx"]["change_xx_Pa"]) / STRAIN,
        float(rows["xx"]["change_yy_Pa"]) / STRAIN,
        float(rows["xy"]["change_xy_Pa"]) / STRAIN,
        stiffness / THICKNESS,
        pressure,
        ratio * stiffness / (2 * THICKNESS) * (1 + overlap) - pressure,
        float(rows["xx"]["tangent_xxxx_Pa"]),
        float(rows["xx"]["tangent_xyxy_Pa"]),
    )


def draw(program: Program, path: Path) -> list[str]:
    case = write_case(program.folder / "lattice")
    soil = (f"soil.modulus={MODULUS / 1e9:g} GPa", f"soil.thickness={THICKNESS} m")
    found = [
        answer(program.run(f"lattice_{ratio:g}", case, *soil, f"soil.stiffness_ratio={ratio}"), ratio)
        for ratio in RATIOS
    ]
    ratios = np.linspace(0, 1.1)
    stiffness = MODULUS * RADIUS / THICKNESS
    figure, axis = plt.subplots(figsize=(6.6, 4.4))
    axis.plot(ratios, np.full_like(ratios, stiffness / 1e6), "-", color=CYCLE[0])
    axis.plot(ratios, (ratios / 2 * stiffness * (1 + 1e5 / stiffness) - 1e5) / 1e6, "--", color=CYCLE[3])
    axis.plot(
        RATIOS, [a.axial / 1e6 for a in found], "o", color=CYCLE[0], label="axial: $d\\sigma_{xx}/d\\varepsilon_{xx}$"
    )
    axis.plot(RATIOS, [a.shear / 1e6 for a in found], "s", color=CYCLE[3], label="shear: $d\\sigma_{xy}/d\\gamma_{xy}$")
    axis.plot([], [], "-", color="0.4", label="closed form (lines)")
    axis.set_xlabel("ratio of the contact stiffnesses $k_t/k_n$ [-]")
    axis.set_ylabel("stiffness [MPa]")
    axis.set_ylim(0, 70)
    axis.set_xlim(0, 1.1)
    axis.legend(loc="center left", bbox_to_anchor=(0.0, 0.68))
    axis.set_title("Square lattice of equal discs at 100 kPa")
    figure.tight_layout()
    save(figure, path)
    return [
        f"k_t/k_n = {a.ratio:g}: axial {a.axial / 1e6:.5f} MPa (form {a.axial_form / 1e6:.5f}), lateral "
        f"{a.lateral / 1e3:.3f} kPa ({a.lateral_form / 1e3:.3f}), shear {a.shear / 1e6:.5f} MPa "
        f"({a.shear_form / 1e6:.5f}), largest relative difference {a.largest_difference():.1e}; eq. (4) "
        f"{a.axial_equation_4 / 1e6:.6f} and {a.shear_equation_4 / 1e6:.6f} MPa"
        for a in found
    ]
