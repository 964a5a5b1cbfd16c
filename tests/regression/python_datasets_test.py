"""Datasets of grains: the bits of the batches that they come from, a process that is killed and goes on, stresses that
are held, and the commands of a shell."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
from program import check, fresh, run, wait_until
from python_package import voussoir  # ends here where the module was not built
from voussoir import paths

GRAINS, INCREMENTS = 60, 16
MAKE = """
import sys
from voussoir import make_packings, paths

packings = make_packings(2, grains={grains}, folder="packings")
sets = {{"walk": paths.random(9, {increments}, seed=3), "drained": paths.drained({increments}, [-0.01, -0.02])}}
paths.generate(
    sys.argv[1], sets, packings, pressure=[80e3] * 5 + [150e3] * 6, points_at_once=8, checkpoint_every={every}
)
"""


def script(every):
    return [sys.executable, "-c", MAKE.format(grains=GRAINS, increments=INCREMENTS, every=every)]


def parts_of(file):
    return len(list(Path(f"{file}.parts").glob("block*_point*.npz")))


def check_killed(folder):
    """Killed without a warning or stopped by Ctrl-C, at several moments, a set has the bits of one that was not."""
    os.chdir(folder)
    run([*script(60), "whole.h5"])
    for parts, every, way in (
        (4, 60, signal.SIGKILL),
        (9, 0, signal.SIGKILL),
        (14, 60, signal.SIGINT),
        (25, 0, signal.SIGKILL),
    ):
        process = subprocess.Popen([*script(every), "killed.h5"], stderr=subprocess.PIPE, text=True)
        wait_until(lambda parts=parts: parts_of("killed.h5") >= parts, process, f"part {parts}")
        process.send_signal(way)
        told = process.communicate(timeout=30)[1]
        check(process.returncode in (-way, 128 + way), f"{way}: exit status {process.returncode}\n{told}")
        if way == signal.SIGINT:
            check("KeyboardInterrupt" in told and list(Path("killed.h5.parts").glob("*_state.npz")), told)
        check(not Path("killed.h5").exists(), "the set was done before it was killed")
    run([*script(60), "killed.h5"])
    with paths.open_dataset("whole.h5") as whole, paths.open_dataset("killed.h5") as killed:
        for name in whole.fields:
            check(whole[name][:].tobytes() == killed[name][:].tobytes(), f"{name} has other bits after the kills")
    check(not Path("killed.h5.parts").exists(), "parts are left")


def check_bits(packings):
    """A set has what a batch answers, to the last bit that a float32 keeps, also in the mirror image."""
    walks = paths.random(5, 6, seed=1)
    turn, mirrored = np.arange(5) % 2, np.arange(5) == 3
    data = paths.generate("bits.h5", walks, packings, mirrored=mirrored, reference_rows=2)
    with voussoir.RveBatch(packings, 5, packing_of=turn, mirrored=mirrored, microstructure=("fabric",)) as batch:
        for k in range(walks.shape[1]):
            answer = batch.evaluate(walks[:, k])
            batch.commit()
            stress = answer.stress[:, [0, 1, 0], [0, 1, 1]].astype("f4")
            check((data["stress"][:, k + 1] == stress).all(), f"stresses of increment {k}")
            check((data["tangent"][:, k + 1, 0] == answer.tangent[:, 0, 0].astype("f4")).all(), f"tangents of {k}")
            check((data["steps"][:, k + 1] == answer.report["steps"]).all(), f"steps of {k}")
            for name, values in batch.fields().items():
                if name in data.fields:
                    check((data[name][:, k + 1] == values.astype("f4")).all(), f"{name} of {k}")
    again = paths.replay(data, packings, np.arange(5))
    check((again.astype("f4") == data["stress"][:]).all(), "a replay has other bits")
    check("2 rows that took the same strains" in data.card, "the card does not tell the error of the preset")


def check_held():
    """Drained tests of the set of check_killed: the stress is held, and the sample is compressed at first."""
    with paths.open_dataset("whole.h5") as data:
        drained = data.rows(family="drained")
        stress, strain = data["stress"][:][drained], data["strain"][:][drained]
        near = np.abs(stress[:, :, 0] / stress[:, :1, 0] - 1)
        check(near.max() < 0.02 and np.median(near) < 0.005, f"held stresses are off by {near.max():.3f}")
        check(
            np.allclose(data["control_error"][:][drained][:, 1:], np.abs(stress[:, 1:, 0] - stress[:, :1, 0]), atol=1),
            "told",
        )
        check(np.allclose(strain[:, -1, 1], [-0.01, -0.02], rtol=1e-6, atol=0), f"axial strains {strain[:, -1, 1]}")
        check((stress[:, -1, 1] < 2 * stress[:, 0, 1]).all(), f"axial stresses {stress[:, -1]}")
        first = paths.pressure_of(data["stress"][:, 0])
        check(np.allclose(first, data["row/pressure"][:], rtol=0.006), f"consolidated to {first}")


def check_crushed(packings):
    """Grains that are crushed, out of range or without contacts are told as such, and change no bit of other rows."""
    good = paths.random(3, 20, seed=5)
    bad = np.concatenate([good, paths.biaxial(20, [-0.3, -0.6]), paths.biaxial(20, 0.2, 0.2)])
    data = paths.generate("crushed.h5", bad, packings, reference_rows=0)
    others = paths.generate("sound.h5", good, packings, reference_rows=0)
    for name in others.fields:
        check(data[name][:3].tobytes() == others[name][:].tobytes(), f"{name} of sound rows changed")
    status, overlap, stress = (data[name][:] for name in ("status", "mean_overlap", "stress"))
    end = int(np.argmax(status[4] == 4))
    check(end > 1 and (status[4, end + 1 :] == -1).all() and np.isnan(stress[4, end:]).all(), f"crushed: {status[4]}")
    check((status[5, 2:] == 2).all() and (stress[5, 2:] == 0).all(), f"without contacts: {status[5]}")
    check((status[3] == 0).all() and 0.06 < overlap[3].max() < 0.15, f"pressed: {overlap[3].max()}")
    check((data.rows(complete=True) == [0, 1, 2]).all() and "1 of 6 rows failed" in data.card, "rows that are complete")


def check_shell():
    words = [sys.executable, "-m", "voussoir.paths"]
    size = ["--increments", "8", "--packings", "2", "--grains", "60", "--folder", "packings"]
    done = run([*words, "make", "shell.h5", "stratified:4", "rotating:2", *size, "--every-packing"])
    check("12 rows" in done.stdout and "100 %" in done.stderr, f"{done.stdout}{done.stderr}")
    check("## Split" in run([*words, "card", "shell.h5"]).stdout, "no card")
    run([*words, "export", "shell.h5", "shell.npz", "--packing", "test"])
    with np.load("shell.npz") as arrays:
        check(len(arrays["stress"]) == 6, "rows of the test")
    refused = run([*words, "make", "other.h5", "circle:4"], code=1)
    check("'circle:4' is not FAMILY:N" in refused.stderr, refused.stderr)


def main():
    folder = fresh("datasets").absolute()
    folder.mkdir()
    check_killed(folder)
    packings = voussoir.make_packings(2, grains=GRAINS, folder="packings")
    check_bits(packings)
    check_held()
    check_crushed(packings)
    check_shell()


main()
