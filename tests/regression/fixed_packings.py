"""Packings that are always the same, as settings of a case.

A packing made from the recipe is another one wherever a last bit differs (tests/data/packings/README.md).
"""

from program import ROOT


def packing_file(name):
    return ROOT / "tests/data" / f"{name}_particles.csv"


def packing(name):
    return f"packing.file={packing_file(name)}"


SAND, LOOSE_SAND, GRAVEL = (packing(f"packings/{name}") for name in ("cps_d_150", "cps_md_150", "cpg_d_400"))
YADE = packing("yade/CPS_D")
TWO_SANDS = f'packing.file=["{packing_file("packings/cps_d_150")}", "{packing_file("packings/cps_md_150")}"]'
GRAVEL_FILE = packing_file("packings/cpg_d_400")  # for the key of a region
