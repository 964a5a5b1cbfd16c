"""Another way to the confining pressure. The study's packings rest at 1 kPa; the program consolidates a packing for
each test at the test's pressure, still without friction. Here packings of 1 kPa are compressed to the pressures with
their working friction and rolling resistance instead."""

import json
from dataclasses import replace
from pathlib import Path

from voussoir.errors import Missing, Unreadable
from voussoir.packing_files import PackingFile

from .definitions import Test
from .plan import Set, Size
from .results import say_once, tests_of
from .runs import Programme, packing_text, run_one, soil_text, tests_text


def _write_packing(source: Path, target: Path) -> None:
    """A packing file as a table of grains, the form in which packings of other codes are read: the program brings such
    a packing to rest at each test's pressure with the soil's own contact law."""
    packing = PackingFile(source)
    columns = [packing.x, packing.y, packing.radius, packing.rotation]
    ((xx, xy), (yx, yy)), thickness = packing.cell.tolist(), packing.thickness
    rows = [",".join([str(k), *(repr(float(v)) for v in row)]) for k, row in enumerate(zip(*columns, strict=True))]
    target.write_text("\n".join(["id,x_m,y_m,r_m,theta_z_rad", *rows]) + "\n")
    meta = {"N": len(rows), "hSize": [[xx, xy, 0], [yx, yy, 0], [0, 0, thickness]], "Lz": thickness}
    target.with_name(target.name.replace("_particles.csv", "_meta.json")).write_text(json.dumps(meta))


def run(how: Programme, one: Set, size: Size) -> None:
    """Packings of one set at 1 kPa, and a run for each of them, since a case of this kind takes one file."""
    folder = how.folder / "compressed"
    folder.mkdir(parents=True, exist_ok=True)
    for soil, values in one.soils.items():
        packings = (folder / f"{soil}_packings").resolve()
        text = 'kind = "pack"\n' + soil_text(soil, values) + packing_text(soil, size, packings) + 'pressure = "1 kPa"\n'
        run_one(how, folder / f"{soil}_pack", text)
        for source in sorted(packings.glob("packing_*.h5")):
            seed = PackingFile(source).seed
            grains = packings / f"seed{seed}_particles.csv"
            _write_packing(source, grains)
            text = f'kind = "biaxial"\n{soil_text(soil, values)}[packing]\nfile = "{grains}"\n{tests_text(soil, size)}'
            if line := run_one(how, folder / f"{soil}_seed{seed}", text):
                print(line, flush=True)


def tests(folder: Path, soil: str) -> list[Test]:
    """The tests of all packings of a soil. A packing from a file has no seed; here it gets that of its name."""
    found: list[Test] = []
    for run_folder in sorted((folder / "compressed").glob(f"{soil}_seed*/")):
        seed = int(run_folder.name.rpartition("seed")[2])
        try:
            found += [replace(test, seed=seed) for test in tests_of(run_folder)]
        except Unreadable as damaged:
            say_once(f"calibrate_soils: left out: {damaged}")
        except Missing:  # it is not finished, or no test of it was held
            continue
    return found
