"""voussoir.paths: strain paths against their closed forms, and datasets of an elastic law, whose answers are known."""

import json
import os
import sys
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from program import check, fresh

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))
from python_paths_elastic import BULK, SHEAR, STIFFNESS, Batch, Packing
from voussoir import paths
from voussoir.paths import control, engine, parts, rows, tensors

FIELDS = ["tangent", "steps", "unbalanced", "void_ratio"]


def refused(error, call, *words, **more):
    """The call raises this error, whose text has the words."""
    try:
        call(**more)
    except error as raised:
        check(all(word in str(raised) for word in words), f"'{raised}' does not tell of {words}")
        return
    check(False, f"no {error.__name__} where one is due ({words})")


def near(first, second, tolerance, what):
    check(np.allclose(first, second, rtol=0, atol=tolerance), f"{what}: {np.abs(np.asarray(first) - second).max():.3g}")


def check_tensors():
    """Exponential and logarithm against each other, against series, and against LAPACK's symmetric eigenvectors."""
    strain = np.random.default_rng(1).uniform(-0.2, 0.2, (200, 3))
    f = np.eye(2) + tensors.gradient_of_strain(strain)
    near(tensors.strain_of_gradient(f - np.eye(2)), strain, 1e-15, "ln exp e")
    near(np.linalg.det(f), np.exp(strain[:, 0] + strain[:, 1]), 1e-15, "det exp e")
    matrix = np.stack([strain[:, 0], strain[:, 2] / 2, strain[:, 2] / 2, strain[:, 1]], axis=1).reshape(-1, 2, 2)
    value, vector = np.linalg.eigh(matrix)
    near(f, np.einsum("nik,nk,njk->nij", vector, np.exp(value), vector), 1e-15, "exp e")
    tiny = 1e-9 * strain
    near(tensors.gradient_of_strain(tiny), 1e-9 * matrix, 1e-19, "exp e - I of small strains")  # e^2 / 2 is 2e-20
    near(tensors.strain_of_gradient(tensors.gradient_of_strain(tiny)), tiny, 1e-24, "small strains")
    turn = np.array([[0.8, -0.6], [0.6, 0.8]])
    near(tensors.strain_of_gradient(f @ turn - np.eye(2)), strain, 1e-15, "a rotation before changes no ln V")
    zero = np.zeros((1, 2, 2))
    check((tensors.strain_of_gradient(zero) == 0).all(), "no strain")


def check_families():
    """Products of F, volumes, cycles that return, and axes that turn."""
    amplitude = np.array([0.01, 0.03])
    shear = paths.undrained(40, amplitude, [0.3, 2.0])
    near(np.linalg.det(np.eye(2) + shear), 1, 1e-15, "undrained volume")
    total = tensors.strain_of_gradient(paths.totals(shear))
    near(total[:, -1], tensors.strain_of_direction(amplitude, np.array([0.3, 2.0])), 1e-15, "undrained strain")
    test = paths.totals(paths.biaxial(25, -0.02, [0.0, 0.02]))[:, -1]
    near(test, [np.diag(np.expm1([0.0, -0.02])), np.diag(np.expm1([0.02, -0.02]))], 1e-15, "biaxial F")
    for one_way in (False, True):
        cycle = paths.cyclic(48, 0.01, 3, 0.7, volumetric=0.002, one_way=one_way)
        near(paths.totals(cycle)[:, -1], 0, 1e-15, "a cycle returns")
        reached = tensors.strain_of_gradient(paths.totals(cycle))
        size = np.hypot(0.5 * (reached[..., 0] - reached[..., 1]), 0.5 * reached[..., 2])
        check(abs(size.max() - 0.01) < 1e-14, "the amplitude of a cycle")
        check((reached[..., 0] + reached[..., 1]).min() > (-1e-15 if one_way else -0.00201), "the volume of a cycle")
    angle = 0.4
    turning = tensors.strain_of_gradient(paths.totals(paths.rotating(80, 0.01, 1.0, angle, radial=0.25)))[0]
    a, c = 0.5 * (turning[:, 0] - turning[:, 1]), 0.5 * turning[:, 2]
    near(np.hypot(a, c)[20:], 0.01, 1e-15, "the size of a turning strain")
    near(np.unwrap(np.arctan2(c, a)[20:], period=2 * np.pi), 2 * angle + 2 * np.pi * np.arange(61) / 60, 1e-12, "axes")
    near(turning[:, 0] + turning[:, 1], 0, 1e-15, "the volume of a turning strain")
    history = np.random.default_rng(2).normal(scale=0.01, size=(5, 9, 3)).cumsum(axis=1)
    history[:, 0] = 0
    near(tensors.strain_of_gradient(paths.totals(paths.prescribed(history))), history, 1e-15, "a prescribed strain")
    f = np.eye(2) + np.random.default_rng(3).normal(scale=0.1, size=(4, 6, 2, 2))
    near(paths.totals(paths.prescribed(f))[:, -1] + np.eye(2), f[:, -1] @ np.linalg.inv(f[:, 0]), 1e-13, "prescribed F")


def check_draws():
    """Bounds, repetition, smoothness, and how evenly directions are spread."""
    walk = paths.random(300, 50, step=1e-3, deviatoric_limit=0.02, volumetric=(-0.003, 0.001), seed=4)
    check(
        (walk == paths.random(300, 50, step=1e-3, deviatoric_limit=0.02, volumetric=(-0.003, 0.001), seed=4)).all(),
        "seed",
    )
    strain = tensors.strain_of_gradient(walk)
    summed = strain.cumsum(axis=1)
    volume, size = summed[..., 0] + summed[..., 1], np.hypot(summed[..., 0] - summed[..., 1], summed[..., 2]) / 2
    check(-0.003001 < volume.min() < -0.0025 and volume.max() < 0.001001, f"volumes {volume.min()} to {volume.max()}")
    check(size.max() < 0.020001, f"deviatoric strains up to {size.max()}")
    rms = np.sqrt(((strain[..., 0] - strain[..., 1]) ** 2 + strain[..., 2] ** 2).mean(axis=1)) / 2
    check((rms < 1.0001e-3).all() and (rms > 0.9999e-3).mean() > 0.3, "steps of random paths")
    turn = np.linalg.norm(np.diff(strain, axis=1), axis=2).max(axis=1) / np.linalg.norm(strain, axis=2).max(axis=1)
    check(turn.max() < 0.4, f"random paths are smooth: {turn.max()}")
    for method in ("sobol", "latin"):
        drawn = tensors.strain_of_gradient(paths.stratified(64, 20, legs=1, amplitude=(0.01, 0.02), method=method))
        first = drawn[:, 0]
        angle = np.arctan2(first[:, 2] / 2, (first[:, 0] - first[:, 1]) / 2) % (2 * np.pi)
        counts = np.histogram(angle, 8, (0, 2 * np.pi))[0]
        check((counts == 8).all(), f"{method}: directions are not even: {counts}")
        size = np.hypot(drawn[..., 0] - drawn[..., 1], drawn[..., 2]).sum(axis=1) / 2
        check(
            0.01 <= size.min() < 0.0102 and 0.0196 < size.max() <= 0.02,
            f"{method}: amplitudes {size.min()}, {size.max()}",
        )
    check(np.ptp(paths.stratified(8, 20, legs=3), axis=1).max() > 0, "legs have corners")
    refused(ValueError, paths.random, "step", n=2, increments=5, step=0.0)
    refused(ValueError, paths.stratified, "sobol", n=2, increments=5, method="grid")


def check_arguments():
    refused(ValueError, paths.Paths, "shape", gradient=np.zeros((3, 2, 2)))
    refused(ValueError, paths.Paths, "path 1", gradient=np.full((2, 3, 2, 2), [[[[0.0]]], [[[np.nan]]]]))
    refused(ValueError, paths.Paths, "det", gradient=np.full((1, 1, 2, 2), -np.eye(2)))
    turned = np.full((1, 1, 2, 2), [[0, 1e-3], [-1e-3, 0]])
    refused(ValueError, paths.Paths, "rotation", gradient=turned, held=[True, False, False])
    refused(ValueError, paths.as_paths, "'a': 5", paths={"a": paths.undrained(5), "b": paths.undrained(6)})
    refused(ValueError, rows.deal, "turn", paths=3, packings=2, packing_of="each")
    refused(ValueError, rows.deal, "2", paths=2, packings=2, packing_of=np.array([0, 2]))
    refused(ValueError, rows.parts, "sum", count=3, split=(0.5, 0.1, 0.1), seed=0)
    both = paths.as_paths({"a": paths.undrained(5, [0.1, 0.2]), "b": paths.drained(5)})
    check(list(both.families()) == [("a", 2), ("b", 1)] and both.held.sum() == 1, f"{both!r}")
    check([list(one) for one in rows.deal(2, 2, "all")] == [[0, 0, 1, 1], [0, 1, 0, 1]], "every path on every packing")
    check(sorted(rows.parts(8, (0.75, 0.125, 0.125), 0)) == [0] * 6 + [1, 2], "eight packings")
    check(
        [sorted(rows.parts(n, (0.75, 0.125, 0.125), 0)) for n in (1, 2, 3)] == [[0], [0, 2], [0, 1, 2]], "few packings"
    )


def elastic(batches, **settings):
    """Batches of the elastic law in place of grains."""

    def make(_, packings, packing_of, __):
        batches.append(Batch(packings, packing_of, **settings))
        return batches[-1]

    return mock.patch.multiple(engine, make_batch=make, version=lambda: "0.0", packings_from=list)


def check_dataset():
    """Every number of a set of the elastic law, its tables, its card and its copies."""
    folder, batches = fresh("elastic"), list[Batch]()
    sets = {"walk": paths.random(20, 12, seed=1), "shear": paths.undrained(12, [0.01, 0.02], 0.5)}
    grains = [Packing(seed) for seed in (1, 2, 3)]
    with elastic(batches):
        data = paths.generate(folder / "set.h5", sets, grains, packing_of="all", fields=FIELDS, points_at_once=32)
        again = paths.generate(folder / "set.h5", sets, grains, packing_of="all", fields=FIELDS, points_at_once=32)
        refused(
            FileExistsError, paths.generate, "overwrite", file=folder / "set.h5", paths=sets["walk"], packings=grains
        )
    check(len(batches) == 3 and all(batch.closed for batch in batches), f"{len(batches)} batches")
    check(len(data) == 66 and data.points == 13 and len(again) == 66, f"{data!r}")
    gradient = paths.as_paths(sets).gradient[data["row/path"][:]]
    check((data["gradient"][:] == gradient).all(), "gradients are not what was asked for")
    near(data["strain"][:], tensors.strain_of_gradient(paths.totals(gradient)), 1e-8, "strain")
    factor = (1 + 0.01 * (data["row/packing"][:] + 1))[:, None, None]
    answer = factor * (tensors.strain_of_gradient(gradient).cumsum(axis=1) @ STIFFNESS) - 100e3 * np.array([1, 1, 0])
    near(data["stress"][:, 1:], answer, 1e-7 * np.abs(answer).max(), "stress")
    near(data["stress"][:, 0], [-100e3, -100e3, 0], 0, "the first stress")
    near(data["tangent"][:], [BULK + SHEAR, BULK - SHEAR, 0, BULK + SHEAR, 0, SHEAR], 10, "tangent")
    near(data["void_ratio"][:], 0.2 - tensors.pressure_of(data["stress"][:].astype(float)) / BULK, 1e-7, "void ratio")
    check(not (folder / "set.h5.parts").exists() and not list(folder.glob("*.new")), "what is not needed is left")
    check((folder / "set.md").read_text() == data.card and "(22 paths)" in data.card, "the card")
    check(len(data.rows(packing="test")) == 22 and len(data.rows(family="shear")) == 6, "rows")
    train, test = data.rows("train", "train"), data.rows("test", "test")
    check(not set(data["row/path"][:][train]) & set(data["row/path"][:][test]), "paths of the training in the test")
    refused(KeyError, data.__getitem__, "void_ratio", name="porosity")
    data.export_npz(folder / "set.npz", rows=test, fields=["stress"])
    with np.load(folder / "set.npz") as copy:
        check((copy["stress"] == data["stress"][:][test]).all() and (copy["row_path"] >= 0).all(), "npz")
    table = data.to_xarray(["stress", "status"])
    check(float(table.stress.sel(stress_component="xx").isel(row=3, point=2)) == data["stress"][3, 2, 0], "xarray")


def check_scatter():
    """The scatter between packings: the stiffnesses are 1.01, 1.02 and 1.03 times that of the law."""
    folder = fresh("scatter")
    with elastic([]):
        data = paths.generate(
            folder / "set.h5", paths.undrained(10, 0.01), [Packing(k) for k in (1, 2, 3)], packing_of="all", fields=[]
        )
    found = paths.scatter_between_packings(data)
    assert found is not None
    q = 2 * SHEAR * 0.01 * np.arange(11) / 10 * 0.01  # standard deviation of s_xx = - s_yy
    near(found.by_point, np.sqrt(2 / 3) * q / 100e3, 1e-5, "scatter")
    near(found.value, np.sqrt((found.by_point**2).mean()), 1e-12, "scatter of the set")


def check_held():
    """Drained tests: the lateral stress stays, and the strain is that of the closed form, also where the tangent that
    the law tells has four times its shear modulus."""
    folder = fresh("drained")
    for told, most in ((1.0, 1.0), (4.0, 1.3)):
        batches: list[Batch] = []
        with elastic(batches, told=told):
            data = paths.generate(folder / f"{told}.h5", paths.drained(20, -0.01), [Packing(0)], fields=["tangent"])
        near(data["stress"][:, :, 0], -100e3, 500, "held stress")
        check(data["control_error"][:].max() <= 500, "the error that is told")
        lateral = -(BULK - SHEAR) / (BULK + SHEAR) * np.linspace(0, -0.01, 21)
        near(data["strain"][0, :, 0], lateral, 5e-6, "lateral strain")
        check(batches[0].evaluations <= 20 * most, f"{batches[0].evaluations} evaluations for 20 increments")
    pressure = np.array([50e3, 400e3])
    with elastic([]):
        data = paths.generate(
            folder / "p.h5", paths.undrained(5, [0.001, 0.001]), [Packing(0)], pressure=pressure, fields=[]
        )
        near(data["stress"][:, 0, :2], -pressure[:, None] * [1, 1], 0.005 * pressure[:, None], "consolidation")
        check(data["consolidation"].shape[1] == 10, f"{data['consolidation'].shape[1]} increments of consolidation")
        repeated = paths.replay(data, [Packing(0)], np.array([1, 0]))
        near(repeated, data["stress"][:], 0.05, "a replay")
    with elastic([], limit=1e-3):
        lost = paths.generate(
            folder / "lost.h5", paths.undrained(5, [0.001, 0.001]), [Packing(0)], pressure=[50e3, 4e6], fields=[]
        )
    check((lost["status"][:] == [[0] * 6, [5] + [-1] * 5]).all(), f"lost before point 0: {lost['status'][:]}")


def check_best_iterate():
    """Where the iteration ends without success, the best of its strains is what is committed; a path whose grains fail
    under a strain goes back as well."""
    for third in (60e3, np.nan):
        calls: list[np.ndarray] = []

        def evaluate(gradient, tangent, calls=calls, third=third):
            calls.append(gradient.copy())
            stress = -1e5 * np.eye(2) - np.diag([(40e3, 10e3, third, 10e3)[len(calls) - 1], 0.0])
            return mock.Mock(stress=stress[None], tangent=STIFFNESS[None] if tangent else None)

        start = control.State(np.array([[-1e5, -1e5, 0]]), STIFFNESS[None])
        held, target = np.array([[True, False, False]]), start.stress.copy()
        given, limits = tensors.gradient_of_strain(np.array([[0, -0.001, 0]])), control.StressControl(iterations=3)
        done = control.evaluate(mock.Mock(evaluate=evaluate), start, given, held, target, True, limits)
        check(len(calls) == 4 and (calls[1] == calls[3]).all() and (done.gradient == calls[1]).all(), "not the best")
        check((done.state.tangent == STIFFNESS).all(), "what did not help is kept")
        check(done.error[0] == 10e3 and (calls[2] != calls[1]).any(), f"the error that is told: {done.error}")


def check_failures():
    """A row that fails keeps what it has, is masked from there on, and changes no bit of the others."""
    folder, batches = fresh("failed"), list[Batch]()
    some = paths.random(6, 8, seed=3)
    bad = some.copy()
    bad[4, 6] = tensors.gradient_of_strain(np.array([0, -0.06, 0]))
    bad[2, 4] = tensors.gradient_of_strain(np.array([0.06, 0, 0]))
    with elastic(batches):
        good = paths.generate(folder / "good.h5", some, [Packing(1)], fields=FIELDS)
        data = paths.generate(folder / "bad.h5", bad, [Packing(1)], fields=FIELDS)
    status = data["status"][:]
    check((status[2] == [0] * 5 + [5] + [-1] * 3).all() and (status[[0, 1, 3, 5]] == 0).all(), f"statuses {status}")
    check(np.isnan(data["stress"][2, 5:]).all() and np.isfinite(data["stress"][2, :5]).all(), "stress of a failed row")
    check(np.isnan(data["strain"][2, 5:]).all() and (data["steps"][2, 5:] == -1).all(), "fields of a failed row")
    check(np.isnan(data["gradient"][2, 5:]).all() and (data["gradient"][2, 4] == bad[2, 4]).all(), "its gradients")
    check((status[4] == [0] * 7 + [5, -1]).all(), f"statuses {status[4]}")
    others = np.array([0, 1, 3, 5])
    check((data["stress"][:][others] == good["stress"][:][others]).all(), "the other rows changed")
    check(batches[1].evaluations == 10 and list(data.rows(complete=True)) == list(others), "two evaluations more")
    check("2 of 6 rows failed" in data.card, "the card does not tell of the failure")


def check_interruption():
    """Stopped anywhere, the same call goes on; other calls are refused; two processes do not meet."""
    folder = fresh("stopped")
    some = {"walk": paths.random(7, 9, seed=5), "drained": paths.drained(9, [-0.004, -0.008])}
    call: dict[str, Any] = {"paths": some, "packings": [Packing(1), Packing(2)], "fields": FIELDS, "points_at_once": 4}

    def stop_at(count):
        def hear(done, _):
            if done >= count:
                raise KeyboardInterrupt

        return hear

    with elastic([]):
        whole = paths.generate(folder / "whole.h5", **call)
        for count in (1, 5, 30, 50, 75):
            refused(KeyboardInterrupt, paths.generate, file=folder / "set.h5", progress=stop_at(count), **call)
        refused(FileNotFoundError, paths.open_dataset, "not finished", file=folder / "set.h5")
        other = {**call, "fields": []}
        refused(FileExistsError, paths.generate, "differs in fields", file=folder / "set.h5", **other)
        busy = parts.Parts(folder / "set.h5", json_of(folder / "set.h5.parts"), True)
        parts.PATIENCE = 0.1
        refused(RuntimeError, paths.generate, "another process", file=folder / "set.h5", **call)
        busy.leave()
        data = paths.generate(folder / "set.h5", **call)
    for name in whole.fields:
        check((whole[name][:].tobytes() == data[name][:].tobytes()), f"{name} differs after the stops")


def check_interruption_within():
    """Stopped while an answer is written, or between the two evaluations of an increment in which a row fails."""
    folder, some = fresh("stopped_within"), paths.random(4, 6, seed=7)
    some[2, 3] = tensors.gradient_of_strain(np.array([0.06, 0, 0]))
    call: dict[str, Any] = {"paths": some, "packings": [Packing(1)], "fields": FIELDS}

    def stopping(work, count):
        calls = iter(range(count))

        def stopped(batch, *given, **named):
            if next(calls, None) is None:
                raise KeyboardInterrupt
            return work(batch, *given, **named)

        return stopped

    with elastic([]):
        whole = paths.generate(folder / "whole.h5", **call)
        for count in (2, 3):
            with mock.patch.object(Batch, "void_ratio", property(stopping(vars(Batch)["void_ratio"].fget, count))):
                refused(KeyboardInterrupt, paths.generate, file=folder / "set.h5", **call)
        with mock.patch.object(Batch, "evaluate", stopping(Batch.evaluate, 4)):
            refused(KeyboardInterrupt, paths.generate, file=folder / "set.h5", **call)
        data = paths.generate(folder / "set.h5", **call)
    for name in whole.fields:
        check((whole[name][:].tobytes() == data[name][:].tobytes()), f"{name} differs after a stop within an increment")


def json_of(folder):
    return json.loads((folder / "plan.json").read_text())


def main():
    check_tensors()
    check_families()
    check_draws()
    check_arguments()
    check_dataset()
    check_scatter()
    check_held()
    check_best_iterate()
    check_failures()
    check_interruption()
    check_interruption_within()


main()
