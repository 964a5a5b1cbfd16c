"""The fields that the ground view offers: names, units, signs and colours."""

from dataclasses import asdict, dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from voussoir.figures import style

KILOPASCAL = 1e-3
DEGREE = 180 / np.pi

# The status of an RVE by its number (docs/reference/files.md) and a colour of the Okabe-Ito set.
STATUS = (
    ("at rest", "#d9e2ea"),
    ("step limit", "#E69F00"),
    ("open, no contacts", "#0072B2"),
    ("too many neighbours", "#CC79A7"),
    ("overlap limit", "#D55E00"),
    ("not finite", "#000000"),
)


@dataclass(frozen=True)
class Field:
    """A field of the Gauss points. `data` is its data set, from which the page shows factor × value."""

    name: str  # in the page
    label: str
    unit: str
    data: str = ""  # "gauss/NAME"; empty: the page computes the field itself
    component: int = 0
    factor: float = 1.0
    symmetric: bool = False  # colours run from -a to a
    bits: int = 16
    scale: float = 0.0  # of pack.pack


def _strain(name: str, label: str, symmetric: bool = False) -> Field:
    return Field(name, label, "%", f"gauss/{name}", factor=100, symmetric=symmetric)


def _stress(name: str, label: str, data: str, component: int = 0, sign: int = 1, symmetric: bool = False) -> Field:
    return Field(name, label, "kPa", data, component, sign * KILOPASCAL, symmetric, scale=1e3)


def _contacts(name: str, label: str) -> Field:
    return Field(name, label, "-", f"gauss/{name}", bits=12)


FIELDS = (
    Field("displacement", "displacement |u|", "m"),
    Field("settlement", "settlement −u_y", "m"),
    Field("sideways", "horizontal displacement u_x", "m", symmetric=True),
    _strain("deviatoric_strain", "deviatoric strain ε_q"),
    _strain("volumetric_strain", "volumetric strain ε_v, contraction positive", symmetric=True),
    Field("void_ratio", "void ratio e", "-", "gauss/void_ratio"),
    Field(
        "grain_rotation",
        "mean grain rotation, counter-clockwise positive",
        "deg",
        "gauss/grain_rotation",
        0,
        DEGREE,
        True,
    ),
    _stress("stress_xx", "stress σ_xx, compression positive", "gauss/stress", 0, -1),
    _stress("stress_yy", "stress σ_yy, compression positive", "gauss/stress", 1, -1),
    _stress("stress_xy", "shear stress τ_xy, sign as where tension is positive", "gauss/stress", 2, symmetric=True),
    _stress("mean_stress", "mean stress p", "gauss/mean_stress"),
    _stress("deviatoric_stress", "deviatoric stress q", "gauss/deviatoric_stress"),
    Field("stress_ratio", "stress ratio q/p", "-"),
    _contacts("coordination", "coordination Z"),
    _contacts("mechanical_coordination", "mechanical coordination Z_m"),
    _contacts("strong_coordination_2", "Z_m of the contacts with f_n ≥ 2⟨f_n⟩"),
    _contacts("fabric_anisotropy", "fabric anisotropy a"),
    Field("rve_status", "state of the RVE", "", "gauss/rve_status"),
)
COMPUTED = ("displacement", "settlement", "sideways", "stress_ratio")  # by the page, of other fields


def described(field: Field) -> dict[str, Any]:
    """What the page must know of a field."""
    kept = ("name", "label", "unit", "factor", "symmetric")
    told: dict[str, Any] = {key: value for key, value in asdict(field).items() if key in kept}
    sheared = field.name == "deviatoric_strain"
    told["map"] = style.DIVERGING if field.symmetric else style.STRAIN if sheared else style.SEQUENTIAL
    if field.name == "rve_status":
        told["levels"] = [{"name": name, "colour": colour} for name, colour in STATUS]
    return told


def colour_maps() -> dict[str, list[str]]:
    """256 colours of each map as #rrggbb."""
    found = {}
    for name in (style.SEQUENTIAL, style.STRAIN, style.DIVERGING):
        rgb = np.round(255 * plt.get_cmap(name)(np.linspace(0, 1, 256))[:, :3]).astype(int)
        found[name] = [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in rgb]
    return found
