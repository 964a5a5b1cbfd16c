"""The package as a stranger installs it: a source distribution, the wheel that is built of it outside the checkout, a
fresh environment; what the wheel holds, links and shows; and the same bits on emulated older processors.

Needs a Kokkos (Kokkos_ROOT, or that of tools/setup) and the packages build, nanobind and scikit-build-core of the
environment of tools/setup. A wheel as the only argument is tried in place of a new one. The fresh environment sees the
NumPy and h5py of that environment, so that no network is needed.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import time
import venv
import zipfile
from pathlib import Path

from program import ROOT, check, fresh

EMULATOR = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
PROCESSORS = ("Nehalem", "Haswell")  # without AVX; with AVX2. NumPy itself needs SSE4.2.
NEEDED = {"libgomp", "libstdc++", "libgcc_s", "libm", "libc", "ld-linux-x86-64"}
TRIAL = """
import numpy as np, voussoir
voussoir.initialize(1)
packing = voussoir.make_packings(grains=30, folder="packings")[0]
with voussoir.RveBatch(packing, 3, mirrored=[False, True, False]) as batch:
    f = np.zeros((3, 2, 2)); f[:, 1, 1] = -1e-4
    answer = batch.evaluate(f); batch.commit()
    print(voussoir.__file__); print(answer.stress.tobytes().hex(), answer.tangent.tobytes().hex())
"""


def run(*words, cwd, **environment):
    done = subprocess.run(
        words, check=False, capture_output=True, text=True, cwd=cwd, env={**os.environ, **environment}
    )
    check(done.returncode == 0, f"{words} ends with {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def source_distribution(folder):
    start = time.monotonic()
    run(sys.executable, "-m", "build", "--sdist", "--no-isolation", "-o", str(folder), str(ROOT), cwd=folder)
    archive = next(folder.glob("voussoir-*.tar.gz"))
    print(f"source distribution: {archive.stat().st_size / 1e6:.2f} MB in {time.monotonic() - start:.1f} s")
    with tarfile.open(archive) as opened:
        names = {name.split("/", 1)[1] for name in opened.getnames() if "/" in name}
        opened.extractall(folder)
    for wanted in ("LICENSE", "python/voussoir/_core.pyi", "host/library/grain_batch.cpp", "tools/setup", "PKG-INFO"):
        check(wanted in names, f"{wanted} is not in the source distribution")
    foreign = [name for name in names if name.startswith((".prefix", "build", "docs", "tests", "cases"))]
    check(not foreign, f"the source distribution has {foreign[:5]}")
    return folder / archive.name.removesuffix(".tar.gz")


def wheel_of(sources, folder):
    start = time.monotonic()
    kokkos = os.environ.get("Kokkos_ROOT", str(ROOT / ".prefix" / "kokkos"))  # noqa: SIM112 - CMake's name
    run(sys.executable, "-m", "build", "--wheel", "--no-isolation", "-o", str(folder), str(sources), cwd=folder,
        Kokkos_ROOT=kokkos)  # fmt: skip
    wheel = next(folder.glob("voussoir-*.whl"))
    print(f"wheel: {wheel.stat().st_size / 1e6:.2f} MB in {time.monotonic() - start:.1f} s")
    return wheel


def check_module(wheel, folder):
    with zipfile.ZipFile(wheel) as opened:
        names = opened.namelist()
        module = next(name for name in names if name.startswith("voussoir/_core.") and name.endswith(".so"))
        opened.extract(module, folder)
    for wanted in ("voussoir/py.typed", "voussoir/_core.pyi", "voussoir/batch.py"):
        check(wanted in names, f"{wanted} is not in the wheel")
    check(all(name.startswith("voussoir") for name in names), f"the wheel has {names}")
    file = folder / module
    said = run("readelf", "-d", str(file), cwd=folder)
    needed = {line.split("[")[1].split(".so")[0] for line in said.splitlines() if "(NEEDED)" in line}
    check(needed <= NEEDED, f"the module needs {sorted(needed)}")
    check("RUNPATH" not in said and "RPATH" not in said, "the module names folders of this machine")
    shown = {line.split()[-1] for line in run("nm", "-D", "--defined-only", str(file), cwd=folder).splitlines()}
    check(shown == {"PyInit__core"}, f"the module shows {shown}")
    print(f"module: {file.stat().st_size / 1e6:.2f} MB, needs {' '.join(sorted(needed))}")


def environment_with(wheel, folder):
    place = folder / "environment"
    venv.create(place, with_pip=True)
    python = place / "bin" / "python"
    run(str(python), "-m", "pip", "install", "-q", "--no-deps", "--no-index", str(wheel), cwd=folder)
    packages = Path(sysconfig.get_paths()["purelib"])
    own = next((place / "lib").glob("python3.*")) / "site-packages"
    (own / "others.pth").write_text(f"{packages}\n")  # NumPy and h5py; those of the fresh environment come first
    return python


folder = fresh("python_package").absolute()
folder.mkdir()
built = Path(sys.argv[1]).absolute() if sys.argv[1:] else wheel_of(source_distribution(folder), folder)
check_module(built, folder)
python = environment_with(built, folder)
place, bits = run(str(python), "-c", TRIAL, cwd=folder, PYTHONPATH="").split("\n", 1)
check(str(folder) in place, f"the package of {place} was tried")
check(len(list((folder / "packings").glob("packing_*.h5"))) == 1, "a packing was stored")
for processor in PROCESSORS if EMULATOR else ():
    shutil.rmtree(folder / "packings")
    words = [EMULATOR, "-cpu", processor, str(python), "-c", TRIAL]
    # NumPy's OpenBLAS chooses a kernel that the emulated processor does not have, unless it is told.
    emulated = run(*words, cwd=folder, PYTHONPATH="", OPENBLAS_CORETYPE="Nehalem").split("\n", 1)[1]
    check(emulated == bits, f"{processor}: other bits than on this processor")
    print(f"{processor}: the same bits")
