"""A disk that fails at a chosen call of a run: what the run has to say, and what `--resume` has to reach.

VOUSSOIR_DISK_FAULTS is the library of tests/faults, which makes the n-th call under a folder fail that writes, syncs,
renames, removes or makes something.
"""

import errno
import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

import h5py
from program import PROGRAM, ROOT, check, check_same, fresh

LIBRARY = os.environ["VOUSSOIR_DISK_FAULTS"]
# The reasons in turn; those that a disk gives from then on, and those that it gives once.
REASONS = [
    (errno.ENOSPC, "on"),
    (errno.EDQUOT, "on"),
    (errno.EROFS, "on"),
    (errno.EIO, "once"),
    (errno.EACCES, "once"),
    (errno.ENOENT, "on"),
    (errno.EFBIG, "once"),
]

COARSE = ["ground.mesh_size_opening=2.5 m", "ground.mesh_size_far=8 m", "column.elements=2", "gravity.ratio=10"]
STEPS = ["gravity.uniform_step=1", "volume_loss.total=0.5 %", "volume_loss.increments=2"]
GRAINS = ["packing.grains=60", "packing.candidates=1", "packing.variety=1"]
SPECIMEN = ["material=linear_elastic", "biaxial_bvp.strain=2 %", "biaxial_bvp.strain_step=0.5 %"]
TEST = ['biaxial.pressures=["100 kPa"]', "biaxial.strain=2 %", "biaxial.inertial_number=1e-3", "packing.seeds=[1, 2]"]
SEARCH = [
    "packing.seeds=[1]",
    "calibrate.rounds=0",
    "calibrate.confirm_grains=60",
    "calibrate.confirm_seeds=[1, 2]",
    'biaxial.pressures=["100 kPa"]',
    "biaxial.strain=3 %",
    "biaxial.window=0.5 %",
    "calibrate.rolling_stiffness=[0.06, 0.12]",
    'calibrate.thickness=["0.1 m"]',
    "biaxial.inertial_number=1e-3",
    "calibrate.confirm_inertial_number=1e-3",
]
SWEPT = [*COARSE, *STEPS]


def written(name, text):
    Path(name).write_text(text)
    return str(Path(name).absolute())


@dataclass
class Scenario:
    """One kind of run. Its root folder holds `result` and `packings`."""

    case: str
    settings: list[str]
    codes: tuple[int, ...] = (0,)  # of a run that nothing disturbs
    sweep: bool = False

    def words(self, root, resume=False):
        """A command for the working folder `root`, because the names of folders are part of a result."""
        if self.sweep:
            words = [PROGRAM, "sweep", self.file(), "-o", "result", "--threads", "1"]
            return [*words, "--resume"] if resume else words
        words = [PROGRAM, "run", self.file(), "-o", "result", "--threads", "1"]
        for setting in [*self.settings, "packing.folder=packings"]:
            words += ["--set", setting]
        if resume:
            words.append("--replace" if Path(root, "result/probe.csv").exists() else "--resume")
        return words

    def file(self):
        case = ROOT / "cases" / self.case / "case.toml"
        if self.sweep:
            runs = [f"[[run]]\nname = '{name}'\nset = {self.settings}\n" for name in ("one", "two")]
            return written("sweep.toml", f"base = '{case}'\n" + "".join(runs))
        if self.case == "path":
            path = "[[probe.path]]\ngradient = [0, 0, 0, -1e-4]\nincrements = 2\n"
            return written("path.toml", f'kind = "probe"\n[probe]\npressure = "100 kPa"\n{path}')
        return str(case)


SCENARIOS = {
    "tunnel": Scenario("tunnel_elastic", [*COARSE, *STEPS, "output.checkpoint_every=2"]),
    "grains": Scenario("tunnel_quick", [*COARSE, *STEPS, *GRAINS, "newton.tolerance=0.01", "output.rves=[3, 4]"]),
    "specimen": Scenario("biaxial_bvp", SPECIMEN),
    "pack": Scenario("pack", [*GRAINS, "packing.seeds=[1, 2]"]),
    "probe": Scenario("path", [*GRAINS, "packing.seeds=[1]"]),
    "biaxial": Scenario("biaxial", [*GRAINS, *TEST], codes=(0, 3)),
    "calibrate": Scenario("calibrate_cps_d", [*GRAINS, *SEARCH], codes=(0, 3)),
    "sweep": Scenario("tunnel_elastic", SWEPT, sweep=True),
}


def faults(pattern="", at=0, reason=errno.ENOSPC, mode="on", count="", delay=0):
    """The environment of a program on whose disk the call of this number fails, or is late [ms]."""
    return os.environ | {
        "LD_PRELOAD": LIBRARY,
        "DISK_FAULTS_PATTERN": pattern,
        "DISK_FAULTS_AT": str(at),
        "DISK_FAULTS_ERRNO": str(reason),
        "DISK_FAULTS_MODE": mode,
        "DISK_FAULTS_COUNT": count,
        "DISK_FAULTS_DELAY": str(delay),
    }


def started(root, words, pattern="", **how):
    environment = faults(pattern, **how)
    return subprocess.run(words, check=False, capture_output=True, text=True, timeout=280, env=environment, cwd=root)


def calls_of(name, pattern):
    """A straight run in straight_NAME, and the calls that it makes under its folder."""
    scenario, root = SCENARIOS[name], fresh(f"straight_{name}")
    root.mkdir()
    list_of_calls = root / "calls"
    done = started(root, scenario.words(root), pattern.format(root=root.resolve()), count=str(list_of_calls.resolve()))
    check(done.returncode in scenario.codes, f"{name}: the straight run ended with {done.returncode}: {done.stderr}")
    calls = list_of_calls.read_text().splitlines()[1:]
    list_of_calls.unlink()
    return calls


def check_equal(straight, root):
    """The same datasets, the same tables of text, and no leftovers."""
    check_same(straight, root)
    for table in straight.rglob("*.csv"):
        other = root / table.relative_to(straight)
        if table.name != "summary.csv":
            check(other.read_bytes() == table.read_bytes(), f"{other} is not {table}")
        else:
            check(other.read_text().count("finished,0") == 2, f"{other}: {other.read_text()}")
    leftovers = list(root.rglob("*.tmp"))
    check(not leftovers, f"left behind: {leftovers}")


def check_readable(root):
    """What the failed run left can be read."""
    for file in root.rglob("*.h5"):
        with h5py.File(file, "r") as opened:
            opened.visititems(lambda _, item: item[()] if isinstance(item, h5py.Dataset) else None)


def try_fault(name, pattern, at, call):
    """The call of this number fails: one line, exit status 4, nothing lost; then the disk is mended."""
    scenario, root = SCENARIOS[name], fresh(f"faulty_{name}")
    root.mkdir()
    reason, mode = REASONS[at % len(REASONS)]
    what = f"{name}, call {at} ({call}), {errno.errorcode[reason]} {mode}"
    done = started(root, scenario.words(root), pattern.format(root=root.resolve()), at=at, reason=reason, mode=mode)
    if mode == "once" and call.startswith("open") and call.endswith("run.log"):
        check(done.returncode == 0, f"{what}: the log is not opened in a second try: {done.stderr}")
        check_equal(Path(f"straight_{name}"), root)
        return f"{what}: opened in a second try"
    check(done.returncode == 4, f"{what}: exit status {done.returncode}: {done.stderr}")
    check(done.stderr.count("\n") == 1, f"{what}: not one line: {done.stderr}")
    named = "result" in done.stderr or "packings" in done.stderr
    check(named and os.strerror(reason) in done.stderr, f"{what}: no file or no reason: {done.stderr}")
    check_readable(root)
    again = started(root, scenario.words(root, resume=True))
    check(again.returncode in scenario.codes, f"{what}: --resume ended with {again.returncode}: {again.stderr}")
    check_equal(Path(f"straight_{name}"), root)
    return done.stderr.strip()


def try_faults(name, every, first=1, pattern="{root}/*"):
    """Every `every`-th call of a run fails in turn."""
    calls = calls_of(name, pattern)
    check(len(calls) > 3, f"{name}: only {len(calls)} calls: the library was not loaded")
    tried = range(first, len(calls) + 1, every)
    for at in tried:
        print(try_fault(name, pattern, at, calls[at - 1]))
    shutil.rmtree(f"faulty_{name}")
    print(f"{name}: {len(tried)} of {len(calls)} calls failed in turn")
