"""A member of an ensemble that is done and whose run.h5 vanishes before the reduction: the reduction ends with the name
of the member, and what docs/reference/log_lines.md advises is right: --resume makes the results anew, and the means are
those of an ensemble that was left alone."""

import shutil
import subprocess
import time

from program import PROGRAM, ROOT, check, fresh, run

COLUMN = ROOT / "cases/column/case.toml"
SETTINGS = ["packing.grains=60", "packing.folder=packings", "packing.candidates=1", "column.elements=2",
            "gravity.ratio=4"]  # fmt: skip


def ensemble(folder, *words):
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    return [PROGRAM, "ensemble", str(COLUMN), "-n", "2", "-o", str(folder), *words, *settings]


def members(folder):
    return [folder / "member_000", folder / "member_001"]


fresh("packings")
whole = fresh("whole")
run(ensemble(whole))
curves = (whole / "curves.csv").read_bytes()

# run.h5 of the first member vanishes while the second one runs: the first has ended, and nothing has read it yet.
lost = fresh("lost")
first, second = members(lost)
process = subprocess.Popen(ensemble(lost), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
deadline = time.monotonic() + 60
while not (second / "run.lock").exists():
    check(process.poll() is None and time.monotonic() < deadline, "the second member did not begin")
    time.sleep(0.002)
(first / "run.h5").unlink()
_, said = process.communicate(timeout=100)
wanted = f"voussoir: {first}: the run is done, but its results are missing\n"
check((process.returncode, said) == (4, wanted), f"exit {process.returncode}: {said}")
check(not (lost / "ensemble.h5").exists() and not (lost / "curves.csv").exists(), "means without the member")


def resumed(what):
    done = run(ensemble(lost, "--resume"))
    check("means and bands of 2 members" in done.stdout and not done.stderr, f"{what}: {done.stdout}{done.stderr}")
    check((lost / "curves.csv").read_bytes() == curves, f"{what}: other means than those of a whole ensemble")
    check(all((folder / "run.h5").exists() for folder in members(lost)), f"{what}: a member lacks its run.h5")


resumed("without run.h5")
check("it is made anew from the increments" in (first / "run.log").read_text(), "run.h5 did not come of the increments")

# Without its checkpoints, too, the member has to be removed; the sentence says that nothing can go on.
(first / "run.h5").unlink()
shutil.rmtree(first / "checkpoints")
refusal = run(ensemble(lost, "--resume"), code=2).stderr
check(str(first) in refusal and "there is no checkpoint from which the run could go on" in refusal, refusal)
shutil.rmtree(first)
resumed("without its folder")
print("the results of a member were lost twice and made anew")
