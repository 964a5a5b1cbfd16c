"""Runs sets of parameters by the program's kind `biaxial`. A run that is finished is not repeated."""

import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .plan import PRESSURES, PRINTED, SOILS, Parameters, Set, Size

ROOT = Path(__file__).resolve().parent.parent.parent
# Table 1: where a class ends, its modulus, k_t/k_n and friction angle.
CLASSES = (("4.75 mm", "3 GPa", 0.5, "25 deg"), ("19 mm", "4 GPa", 0.7, "40 deg"), ("40 mm", "5 GPa", 0.8, "50 deg"))


@dataclass(frozen=True)
class Programme:
    """Where and by which words the runs are done."""

    program: Path
    folder: Path
    prefix: Sequence[str] = ()  # words before each run, such as `nice`


def _class_text(values: Parameters, k: int) -> str:
    size_to, modulus, ratio, friction = CLASSES[k]
    stiffness, limit = (x[k % len(x)] for x in (values.stiffness, values.limit))
    return (
        f'[[soil.class]]\nsize_to = "{size_to}"\nmodulus = "{modulus}"\nstiffness_ratio = {ratio}\n'
        f'friction = "{friction}"\nrolling_stiffness = {stiffness:.6g}\nrolling_limit = {limit:.6g}\n'
    )


def soil_text(soil: str, values: Parameters) -> str:
    """What a case of one soil has of a set."""
    text = f'extends = "{ROOT}/cases/soils/{soil}.toml"\n[soil]\nthickness = "{values.thickness} m"\n'
    if len(PRINTED[soil]) == 1:
        return text + f"rolling_stiffness = {values.stiffness[0]:.6g}\nrolling_limit = {values.limit[0]:.6g}\n"
    return text + "".join(_class_text(values, k) for k in range(len(CLASSES)))


def packing_text(soil: str, size: Size, packings: Path) -> str:
    seeds = ", ".join(str(seed) for seed in range(1, size.seeds + 1))
    return f'[packing]\ngrains = {size.grains[soil]}\nseeds = [{seeds}]\nfolder = "{packings}"\n'


def tests_text(soil: str, size: Size) -> str:
    pressures = ", ".join(f'"{kpa} kPa"' for kpa in PRESSURES)
    return (
        f"[biaxial]\npressures = [{pressures}]\nstrain = 0.2\nsamples = 400\n"
        f"inertial_number = {size.inertial_number[soil]:g}\n"
    )


def case_text(soil: str, values: Parameters, size: Size, packings: Path) -> str:
    """The case file of one soil with one set."""
    return 'kind = "biaxial"\n' + soil_text(soil, values) + packing_text(soil, size, packings) + tests_text(soil, size)


def folder_of(group: Path, soil: str, name: str) -> Path:
    return group / f"{soil}_{name}"


def run_one(how: Programme, folder: Path, text: str) -> str:
    """Empty where the run was there; the last line of what the program said where tests were lost."""
    case = folder.with_name(folder.name + ".toml")
    done = folder.with_name(folder.name + ".done")
    if case.exists() and case.read_text() == text and done.exists() and (folder / "run.h5").exists():
        return ""
    shutil.rmtree(folder, ignore_errors=True)
    done.unlink(missing_ok=True)
    case.write_text(text)
    words = [*how.prefix, str(how.program), "run", str(case), "-o", str(folder), "--replace", "--threads", "1"]
    try:
        said = subprocess.run(words, check=False, capture_output=True, text=True)
    except OSError as error:
        sys.exit(f"calibrate_soils: {words[0]} cannot be started: {error.strerror}")
    if said.returncode not in (0, 3):  # 3: some packings or tests did not hold; the others are there
        last = said.stderr.strip().splitlines()[-1:] or ["no message"]
        sys.exit(f"calibrate_soils: {case}: exit status {said.returncode}: {last[0]}")
    done.write_text(f"{said.returncode}\n")
    return f"{folder.name}: {'done' if said.returncode == 0 else 'done, not all tests held'}"


def run_sets(how: Programme, group: str, sets: Sequence[Set], size: Size) -> None:
    """Runs all sets of a group, the sands before the gravel, which takes longest."""
    folder = how.folder / group
    folder.mkdir(parents=True, exist_ok=True)
    for soil in SOILS:
        for one in sets:
            if soil not in one.soils:
                continue
            text = case_text(soil, one.soils[soil], size, how.folder.resolve() / "packings")
            if line := run_one(how, folder_of(folder, soil, one.name), text):
                print(line, flush=True)
