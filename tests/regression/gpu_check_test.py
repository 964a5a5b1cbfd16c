"""tools/gpu_check where there is no device: parts that need none end well, all others say that there is none. On the
emulated device the engine agrees with the lanes. A part that fails, hangs or is missing stops no other one."""

import os
import subprocess
import time
from pathlib import Path

from program import PROGRAM, ROOT, check, fresh

AGREEMENT = Path(PROGRAM).parent.parent / "tests" / "device_agreement"
NOTHING = "/no/such/libvoussoir_gpu.so"


def folder_of(name, **programs):
    """A folder with programs: links to files, or scripts of the texts given."""
    folder = fresh(name)
    folder.mkdir()
    for program, content in programs.items():
        if isinstance(content, Path):
            (folder / program).symlink_to(content)
        else:
            (folder / program).write_text(f"#!/bin/bash\n{content}\n")
            (folder / program).chmod(0o755)
    return folder


def gpu_check(programs, parts, *further, library=NOTHING, code=0):
    """Runs some parts; returns what was shown while they ran, and the lines of the summary."""
    out = fresh("out")
    done = subprocess.run(
        ["bash", str(ROOT / "tools/gpu_check"), "--programs", str(programs), "--parts", parts, *further],
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"VOUSSOIR_GPU_LIBRARY": library, "OUT": str(out)},
    )
    check(done.returncode == code, f"{parts}: exit {done.returncode} instead of {code}: {done.stdout}{done.stderr}")
    check((out / "summary.txt").exists(), f"{parts}: the folder that OUT names has no summary")
    lines = (out / "summary.txt").read_text().splitlines()
    check(len(lines) == 10, f"{parts}: the summary has {len(lines)} lines")
    return done.stdout.split("\n\n")[0] + done.stderr, lines


real = folder_of("real", voussoir=Path(PROGRAM), device_agreement=AGREEMENT)
shown, summary = gpu_check(real, "machine,agreement,rates,memcheck,racecheck,counters")
check("machine            done" in shown, f"the machine is not described: {shown}")
check(
    shown.count(f"skipped: no device: there is no {NOTHING}") == 5, f"a missing device is not said five times: {shown}"
)
check(summary[1] == f"device: none: there is no {NOTHING}", f"the summary says {summary[1]}")

if AGREEMENT.exists():
    shown, summary = gpu_check(real, "agreement", library=os.environ["VOUSSOIR_EMULATED_GPU"])
    check("agreement          done" in shown, f"the emulated device: {shown}")
    check(summary[1].startswith("device: emulated device 0"), f"the device is not named: {summary[1]}")
    told = "in float: stress off by" in summary[2] and "good" in summary[2]
    check(told, f"the differences are not told: {summary[2]}")

# Programs that fail, hang or are missing, with a device that a script pretends.
pretend = 'case $1 in info) echo "device 0: pretended" ;; run) echo "no equilibrium was found"; exit 3 ;; esac'
failing = folder_of("failing", voussoir=pretend, device_agreement="echo wrong numbers; exit 1", device_rates="exit 0")
shown, summary = gpu_check(failing, "agreement,tunnel_quick,counters", code=1)
check("FAILED with 1: wrong numbers" in shown, f"what does not agree is not told: {shown}")
check(shown.count("FAILED with 3") == 2, f"runs that fail are not told: {shown}")
check("3 parts failed" in summary[9], f"failures are not counted: {summary[9]}")
hanging = folder_of("hanging", voussoir=pretend, device_agreement="sleep 100", device_rates="exit 0")
since = time.monotonic()
shown, _ = gpu_check(hanging, "agreement,machine", "--seconds", "16", code=1)
check(time.monotonic() - since < 20, "a part that hangs goes on beyond the time in all")
check("agreement          stopped after" in shown, f"a part that hangs is not stopped: {shown}")
check("machine            skipped: the time in all is over" in shown, f"the time in all is not kept: {shown}")

for words in (["--parts", "walk"], ["--programs"], ["--seconds", "soon"], ["--programs", "no_such_folder"]):
    done = subprocess.run(
        ["bash", str(ROOT / "tools/gpu_check"), *words], check=False, capture_output=True, text=True, timeout=60
    )
    check(done.returncode == 2 and done.stderr, f"{words}: exit {done.returncode}")
print("tools/gpu_check ends as it should")
