"""The program on processors that this machine does not have, emulated by QEMU in user mode: it starts, takes the lanes
of the processor, computes a case without grains and a small packing. Skipped where qemu-x86_64 is missing, and for a
program that is made for a certain processor."""

import shutil
import subprocess

import h5py
from program import PROGRAM, ROOT, check, fresh

EMULATOR = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static") or ""
if not EMULATOR:
    print("skipped: there is no qemu-x86_64")
    raise SystemExit(77)
native = subprocess.run([PROGRAM, "info", "--cpu"], check=True, capture_output=True, text=True).stdout
if "holds the lanes scalar" not in native:
    print("skipped: the program is made for a certain processor")
    raise SystemExit(77)
has_v3 = "v3" in native.splitlines()[1]

# Emulated processor, and the lanes it shall take: no AVX, no fused operations; the same with SSE4.2; AVX2.
PROCESSORS = {"qemu64": "scalar", "Nehalem": "scalar", "Haswell": "v3" if has_v3 else "scalar"}
# At a higher pressure than the case's a packing comes to rest in an eighth of the steps.
PACKING = ["packing.grains=30", "packing.candidates=1", "packing.seeds=[1]", 'packing.pressure="100 kPa"']
# The whole of tunnel_elastic takes 16 s of an emulated processor.
COARSE = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "volume_loss.increments=1"]


def emulated(processor, *words, code=0):
    done = subprocess.run(
        [EMULATOR, "-cpu", processor, PROGRAM, *words], check=False, capture_output=True, text=True, timeout=250
    )
    check(done.returncode == code, f"{processor}: {words} ends with {done.returncode}: {done.stdout}{done.stderr}")
    return done


def settings(values):
    return [word for value in values for word in ("--set", value)]


def case(name):
    return str(ROOT / "cases" / name / "case.toml")


for processor, lanes in PROCESSORS.items():
    emulated(processor, "--version")
    said = emulated(processor, "info", "--cpu").stdout
    check(f"lanes: {lanes} (" in said, f"{processor}: {lanes} lanes are not taken: {said}")
    print(f"{processor}: {said.splitlines()[-1]}")
    errors = emulated(processor, "check", case("pack"), "--set", "engine.isa=v4", code=2).stderr.splitlines()
    refusal = [line for line in errors if not line.startswith("qemu-x86_64: ")]  # the emulator has warnings of its own
    check(len(refusal) == 1 and "engine.isa" in refusal[0] and "scalar" in refusal[0], str(refusal))
    print(refusal[0])

    folder = fresh(f"elastic_{processor}")
    emulated(processor, "run", case("tunnel_elastic"), "-o", str(folder), "--threads", "1", *settings(COARSE))
    with h5py.File(folder / "run.h5") as opened:
        lost = opened["table/area_loss"][-1]
    check(abs(lost - 0.02) < 1e-6, f"{processor}: tunnel_elastic loses {lost} of the opening instead of 0.02")

    folder = fresh(f"packings_{processor}")
    emulated(processor, "run", case("pack"), "--threads", "1", *settings([*PACKING, f'packing.folder="{folder}"']))
    check(len(list(folder.glob("packing_*.h5"))) == 1, f"{processor}: no packing was made")
