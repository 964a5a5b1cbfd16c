"""Measures what docs/measurements/python_codes.md tells: grains in scikit-fem beside the program, what tangents and a
batch for each point cost, and the hub for preCICE's Micro Manager (where it is installed). Times are of the processor.

    PYTHONPATH=build/openmp/python VOUSSOIR=build/openmp/host/voussoir VOUSSOIR_ROOT=. \\
        .prefix/venv/bin/python tests/benchmark/python_codes.py   # from the checkout; writes into out/python_codes
"""

import importlib.util
import os
import resource
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(os.environ["VOUSSOIR_ROOT"]).absolute()
os.environ["VOUSSOIR_ROOT"], os.environ["VOUSSOIR"] = str(ROOT), str(Path(os.environ["VOUSSOIR"]).absolute())
os.environ["MPLBACKEND"] = "agg"
sys.path[:0] = [str(ROOT / folder) for folder in ("python/examples", "tests/regression", "tests/precice_stand_in")]

import voussoir  # noqa: E402 - its path and those below are set above
from program import command, fresh, run, table  # noqa: E402
from scikit_fem_biaxial import biaxial  # noqa: E402
from scikit_fem_footing import footing, in_turn  # noqa: E402

P0 = 100e3


def best(deed, repeats=5):
    """Least processor time of a call [s], and its wall time."""
    times = []
    for _ in range(repeats):
        wall, begin = time.perf_counter(), time.process_time()
        deed()
        times.append((time.process_time() - begin, time.perf_counter() - wall))
    return min(times)


def timed(batch, spent):
    """The same batch, whose evaluations add their processor time to spent[0]."""

    class Timed:
        def __getattr__(self, name):
            return getattr(batch, name)

        def evaluate(self, h, tangent):
            begin = time.process_time()
            answer = batch.evaluate(h, tangent)
            spent[0] += time.process_time() - begin
            return answer

    return Timed()


def compare_biaxial():
    """The biaxial test of 32 points of 300 grains by both, uniform and with mirrored points."""
    packing = voussoir.make_packings(grains=300, pressure=P0, folder="packings")
    for mirrored in (False, True):
        folder = fresh("program")
        settings = ["packing.grains=300", "packing.folder=packings", "newton.tolerance=1e-4"]
        settings += ["newton.relax_substeps=0", "biaxial_bvp.strain=1 %", f"packing.mirrored={str(mirrored).lower()}"]
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        run(command("biaxial_bvp", folder, settings))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        rows = table(folder)
        spent = [0.0]

        def make_batch(basis, mirrored=mirrored, spent=spent):
            return timed(
                voussoir.RveBatch(packing, basis.dx.size, mirrored=in_turn(basis) if mirrored else False), spent
            )

        begin, errors = time.process_time(), []
        for row, (stress, ground) in zip(rows, biaxial(make_batch, tolerance=1e-4)):
            errors.append(abs(stress / row["axial_stress"] - 1))
            evaluations = ground.evaluations
        total = time.process_time() - begin
        print(
            f"biaxial, mirrored={mirrored}: difference {max(errors):.1e} at most; "
            f"scikit-fem {evaluations} evaluations, "
            f"{total:.2f} s, {spent[0]:.2f} s of them in the grains; program {sum(r['evaluations'] for r in rows)} "
            f"evaluations, {after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime:.2f} s"
        )


def measure_footing():
    packings = voussoir.make_packings(seeds=4, grains=200, pressure=P0, folder="packings")
    spent, begin = [0.0], time.process_time()
    for settlement, pressure, ground in footing(
        lambda basis: timed(voussoir.RveBatch(packings, basis.dx.size, mirrored=in_turn(basis)), spent)
    ):
        last = settlement, pressure, ground.evaluations
    print(
        f"footing: {1e3 * last[0]:.1f} mm, {last[1] / 1e3:.0f} kPa, {len(ground.answer.stress)} points, {last[2]} "
        f"evaluations, {time.process_time() - begin:.1f} s, {spent[0]:.1f} s of them in the grains"
    )


def cost_of_calls():
    """Of an evaluation of 64 points of 300 grains: with and without tangents, and as a batch for each point."""
    packing = voussoir.make_packings(grains=300, pressure=P0, folder="packings")
    batch = voussoir.RveBatch(packing, 64)
    gradients = np.zeros((64, 2, 2))
    gradients[:, 1, 1] = -5e-4 * (1 + 0.3 * np.arange(64) / 64)
    batch.evaluate(gradients)
    single = [voussoir.RveBatch(packing, 1) for _ in range(64)]
    for name, deed in (
        ("one batch with tangents", lambda: batch.evaluate(gradients)),
        ("one batch without tangents", lambda: batch.evaluate(gradients, tangent=False)),
        ("64 batches with tangents", lambda: [one.evaluate(gradients[k : k + 1]) for k, one in enumerate(single)]),
    ):
        cpu, wall = best(deed)
        print(f"{name}: {1e3 * cpu:.1f} ms of the processor, {1e3 * wall:.1f} ms of wall")


def main():
    Path("out/python_codes").mkdir(parents=True, exist_ok=True)
    os.chdir("out/python_codes")
    compare_biaxial()
    measure_footing()
    cost_of_calls()
    if importlib.util.find_spec("micro_manager") and importlib.util.find_spec("mpi4py"):
        import precice_test  # noqa: PLC0415

        precice_test.POINTS = 64
        precice_test.check_grains(voussoir.make_packings(seeds=2, grains=300, pressure=P0, folder="packings"))


if __name__ == "__main__":
    main()
