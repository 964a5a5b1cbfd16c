"""Batches of RVEs in Python: the same bits as the program, mirrored points, states, increments, failures, errors."""

import ast
import os
import pickle
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
from program import PROGRAM, check, fresh, run
from python_package import voussoir  # ends here where the module was not built

GRAINS = 60
FOLDER = fresh("python_batch").absolute()
FOLDER.mkdir()
SHEAR = np.array([[2e-4, 3e-4], [1e-4, -8e-4]])
PATH = "[[probe.path]]\ngradient = [2e-4, 3e-4, 1e-4, -8e-4]\nincrements = 2\n"
CASE = FOLDER / "probe.toml"
CASE.write_text(
    f"""kind = "probe"
[packing]
grains = {GRAINS}
seeds = [1, 2]
folder = "{FOLDER / "packings"}"
[probe]
pressure = "100 kPa"
{PATH}"""
)


def program(out, *settings):
    words = [PROGRAM, "run", str(CASE), "-o", str(FOLDER / out)]
    for setting in settings:
        words += ["--set", setting]
    return run(words)


def equal(a, b, what):
    a, b = np.asarray(a), np.asarray(b)
    check(a.shape == b.shape and a.tobytes() == b.tobytes(), f"{what} differs: {a.ravel()[:4]} and {b.ravel()[:4]}")


def raises(kind, work, *words):
    try:
        work()
    except kind as error:
        for word in words:
            check(word in str(error), f"{word!r} is not in: {error}")
        return error
    raise AssertionError(f"no {kind.__name__}")


def same_packing(a, b, what):
    for name in ("radius", "position", "rotation", "cell", "contacts", "history"):
        equal(getattr(a, name), getattr(b, name), f"{what}: {name}")


def check_packing_files():
    """The program and Python find each other's packings under one name, with the same bits."""
    by_python = voussoir.make_packings([1], grains=GRAINS, folder=FOLDER / "packings")
    check(by_python[0].seed == 1 and abs(by_python[0].pressure / 100e3 - 1) < 0.01, repr(by_python))
    said = program("first").stdout
    check("packing found: seed     1" in said and "packing made:  seed     2" in said, said)
    files = sorted((FOLDER / "packings").glob("packing_*.h5"))
    times = [file.stat().st_mtime_ns for file in files]
    found = voussoir.make_packings([2, 1], grains=GRAINS, folder=FOLDER / "packings")
    check([packing.seed for packing in found] == [2, 1], "the packings are in the order of the seeds")
    check(times == [file.stat().st_mtime_ns for file in files] and len(files) == 2, "packings were made again")
    for stored, fresh_one in zip(found, voussoir.make_packings([2, 1], grains=GRAINS), strict=True):
        same_packing(stored, fresh_one, f"seed {stored.seed}")
        check(stored.soil["soil.friction"] == "25 deg" and len(stored) == GRAINS, str(stored.soil))
    same_packing(
        voussoir.make_packings(np.int64(1), grains=GRAINS)[0], found[1], "a number of NumPy as number of seeds"
    )
    of_files = voussoir.RveBatch(voussoir.open_result(FOLDER / "packings").packings)
    same_packing(of_files.packing(0), voussoir.RveBatch(found[::-1]).packing(0), "a packing of a result")
    copy = FOLDER / "copy.h5"
    found[0].save(copy)
    same_packing(voussoir.load_packing(copy), found[0], "a saved packing")
    soft = voussoir.load_packing(copy, settings={"soil.modulus": "1 GPa"})
    check(soft.soil["soil.modulus"] == "1 GPa" and soft.soil["soil.friction"] == "25 deg", str(soft.soil))
    return found[::-1]


def check_same_bits(packings):
    """A path of the program's probe against a batch: the grains at its end, bit for bit, and its tables."""
    with voussoir.RveBatch(packings, tangent="contact") as batch:
        first = batch.evaluate(np.broadcast_to(SHEAR, (2, 2, 2)))
        batch.commit()
        answer = batch.evaluate(np.broadcast_to(SHEAR, (2, 2, 2)))
        batch.commit()
        for seed in (1, 2):
            end = voussoir.load_packing(FOLDER / "first" / f"end_{seed}.h5")
            same_packing(batch.packing(seed - 1), end, f"end of the path of seed {seed}")
        rows = np.genfromtxt(FOLDER / "first" / "path.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        last = rows[rows["increment"] == 2]
        for k, row in enumerate(last):
            for name, value in (("xx", answer.stress[k, 0, 0]), ("yy", answer.stress[k, 1, 1]),
                                ("xy", answer.stress[k, 0, 1])):  # fmt: skip
                check(f"{value:.9g}" == f"{row[f'stress_{name}_Pa']:.9g}", f"stress {name} of seed {k + 1}")
            check(answer.report["steps"][k] == row["steps"], "steps")
    with voussoir.RveBatch(packings, tangent="contact", precision="double") as batch:
        other = batch.evaluate(np.broadcast_to(SHEAR, (2, 2, 2)))
        largest = np.abs(other.stress - first.stress).max() / 100e3
        check(0 < largest < 0.01, f"double answers as float does, up to {largest} of the pressure")


def check_tangents():
    """Every kind of tangent, against the program's digits."""
    for kind in ("contact", "elastic", "static", "loading"):
        settings = [f"packing.file={FOLDER / 'first' / 'end_1.h5'}", "probe.path=[]", "packing.seeds=[]",
                    f"probe.tangent={kind}", "probe.strain=2e-5"]  # fmt: skip
        program(kind, *settings)
        rows = np.genfromtxt(FOLDER / kind / "probe.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
        batch = voussoir.RveBatch.from_case(CASE, 6, settings)
        gradients = np.zeros((6, 2, 2))
        for k, (i, j, value) in enumerate(((0, 0, 1), (1, 1, 1))):
            gradients[k, i, j] = 2e-5 * value
        answer = batch.evaluate(gradients)
        for k in range(2):
            for stress, name in ((answer.stress[k, 0, 0], "xx"), (answer.stress[k, 1, 1], "yy")):
                check(f"{stress:.9g}" == f"{rows[f'stress_{name}_Pa'][k]:.9g}", f"{kind}: stress {name} of probe {k}")
            whole = rows[k]
            for (i, j), name, mirror in (((0, 0), "xxxx", "xxxx"), ((0, 1), "xxyy", "yyxx"), ((1, 2), "yyxy", "xyyy")):
                symmetric = 0.5 * (whole[f"tangent_after_{name}_Pa"] + whole[f"tangent_after_{mirror}_Pa"])
                ours = answer.tangent[k, i, j]
                check(
                    abs(ours - symmetric) < 1e-8 * whole["tangent_after_xxxx_Pa"], f"{kind} {name}: {ours} {symmetric}"
                )
        equal(answer.tangent, answer.tangent.transpose(0, 2, 1), f"{kind}: the transposed tangent")
        check(whole["tangent_after"] == kind, f"{whole['tangent_after']} in place of {kind}")


def check_mirrored(packings):
    mirror = np.array([[1, -1], [-1, 1]])
    flags = np.arange(4) % 3 == 1
    gradients = np.broadcast_to(SHEAR, (4, 2, 2))
    with (
        voussoir.RveBatch(packings, 4, mirrored=flags, microstructure=["fabric"]) as mirrored,
        voussoir.RveBatch(packings, 4, microstructure=["fabric"]) as plain,
    ):
        a = mirrored.evaluate(gradients)
        b = plain.evaluate(np.where(flags[:, None, None], mirror * gradients, gradients))
        equal(a.stress[flags], b.stress[flags] * mirror, "the mirrored stress")
        equal(a.stress[~flags], b.stress[~flags], "the stress of other points")
        signs = np.array([[1, 1, -1], [1, 1, -1], [-1, -1, 1]])
        equal(a.tangent[flags], b.tangent[flags] * signs, "the mirrored tangent")
        mirrored.commit()
        plain.commit()
        equal(mirrored.state(), plain.state(), "the state of grains, which are not mirrored")
        direction = mirrored.fields()["fabric_direction"]
        equal(direction[flags], -plain.fields()["fabric_direction"][flags], "the direction of the fabric")
        one, other = mirrored.snapshot(1), plain.snapshot(1)
        equal(one.force[:, 0], -other.force[:, 0], "forces of a mirrored snapshot")
        equal(one.force[:, 1], other.force[:, 1], "forces of a mirrored snapshot")
        check(one.contacts.shape == (len(one.branch), 2) and one._repr_png_()[:4] == b"\x89PNG", "a snapshot")


def check_states(packings):
    gradients = np.broadcast_to(SHEAR, (6, 2, 2)) * np.linspace(0.5, 1, 6)[:, None, None]
    with voussoir.RveBatch(packings, 6, packing_of=[0, 0, 1, 1, 0, 1]) as batch:
        start = batch.state()
        batch.evaluate(gradients)
        batch.commit()
        later, some = batch.state(), batch.state([5, 4])
        after = batch.evaluate(gradients)
        batch.set_state(later)
        equal(batch.evaluate(gradients).stress, after.stress, "stress after a state was put back")
        batch.set_state(start)
        batch.set_state(some, [2, 0])  # the packings of 5 and 4
        moved = batch.evaluate(gradients[[4, 1, 5, 3, 4, 5]])
        equal(moved.stress[[2, 0]], after.stress[[5, 4]], "stress of points with the states of others")
        equal(batch.committed().stress.shape, (6, 2, 2), "shape")
        raises(ValueError, lambda: batch.set_state(some, [0, 2]), "no state of these points")
        raises(ValueError, lambda: batch.set_state(later[:-3]), "no state of these points")
        raises(ValueError, lambda: batch.set_state(some, [2, 2]), "twice")
        check_damaged_states(batch)
        raises(IndexError, lambda: batch.state([6]), "6")
        raises(IndexError, lambda: batch.state([True, False]), "mask")
        raises(TypeError, lambda: batch.state(1.5), "a point must be an integer")
        equal(batch.state(np.arange(6) < 0), batch.state([]), "the state of no point")
        again = voussoir.RveBatch([batch.packing(5)], tangent="contact")
        near = np.abs(again.committed().stress[0] - batch.committed().stress[5]).max()
        check(near < 1e-3 * again.packing(0).pressure, f"a batch that starts from a point is off by {near} Pa")


def check_damaged_states(batch):
    """A wrong bit may stand behind records that are good: nothing may be taken over then."""
    before = batch.state()
    for bit in np.random.default_rng(1).integers(8 * len(before), size=300).tolist():
        wrong = bytearray(before)
        wrong[bit // 8] ^= 1 << bit % 8
        raises(ValueError, lambda: batch.set_state(bytes(wrong)), "no state of these points")  # noqa: B023 (called now)
        check(batch.state() == before, f"a state whose bit {bit} is wrong was taken over in part")
    last = bytearray(before)
    last[-1] ^= 1
    raises(ValueError, lambda: batch.set_state(bytes(last)), "RVE 5 is damaged: its checksum is wrong")


def check_increments(packings):
    small, large = np.full((2, 2, 2), 1e-5) * np.eye(2), -np.full((2, 2, 2), 4e-4) * np.eye(2)
    with voussoir.RveBatch(packings) as batch:
        raises(voussoir.Error, batch.commit, "needs an evaluation")
        frozen = batch.evaluate(large)
        check((batch.evaluate(small).report["steps"] >= frozen.report["steps"] / 2).all(), "steps are frozen")
        batch.begin_increment()
        first = batch.evaluate(small)
        check((first.report["steps"] < frozen.report["steps"]).all(), f"{first.report} after {frozen.report}")
        lost = large.copy()
        lost[1] = [[-0.9, 0], [0, -0.9]]
        answer = batch.evaluate(lost)
        check(not answer.usable and "RVE 1" in answer.message, answer.message)
        check(np.isnan(answer.stress[1]).all() and np.isnan(answer.tangent[1]).all(), "a failed point answers NaN")
        check(np.isfinite(answer.stress[0]).all(), "the other point answers")
        check(voussoir.status_names[answer.report["status"][1]] in answer.message, str(answer.report))
        raises(RuntimeError, batch.commit, "cannot be committed", answer.message)
        batch.begin_increment()
        equal(batch.evaluate(small).stress, first.stress, "the committed state after a failure")
        check(batch.evaluate(small, tangent=False).tangent is None, "no tangent")
        batch.commit()
        raises(RuntimeError, batch.commit, "needs an evaluation")
        check(np.allclose(batch.void_ratio, batch.fields()["void_ratio"], rtol=0, atol=0), "void ratio")
        check(set(batch.field_units()) == set(batch.fields()), "units")


def check_errors(packings):
    def batch(**more):
        return voussoir.RveBatch(packings, **more)

    error = raises(voussoir.InputError, lambda: voussoir.make_packings(settings={"soil": {"modulus": "-3 GPa"}}))
    check((error.file, error.line, error.key) == ("settings", 1, "soil.modulus"), str(vars(error)))
    check(isinstance(error, ValueError) and isinstance(error, voussoir.Error), "kinds of an InputError")
    error.folder = FOLDER
    sent = pickle.loads(pickle.dumps(error))
    check((str(sent), sent.folder) == (str(error), FOLDER), "an InputError can be sent to another process")
    misspelt = {"soil.damping": 0.2, "soil.modulu": "3 GPa"}
    raises(voussoir.InputError, lambda: voussoir.make_packings(settings=misspelt), "settings:2", 'mean "modulus"')
    raises(
        voussoir.InputError, lambda: voussoir.make_packings(settings={"engine.skin": 1}), "settings:1", "soil, packing"
    )
    raises(voussoir.InputError, lambda: voussoir.make_packings(grains=4), "packing.grains")
    raises(
        voussoir.InputError, lambda: voussoir.RveBatch.from_case(CASE, 2, ["packing.grain=3"]), "--set", "packing.grain"
    )
    raises(voussoir.InputError, lambda: batch(microstructure=["colour"]), "output.microstructure")
    check("fabric_anisotropy" in batch(microstructure="fabric").fields(), "one quantity of the microstructure")
    raises(RuntimeError, lambda: batch(backend="gpu"), "a device is asked for")
    raises(TypeError, lambda: batch(n=2.5), "integer")
    raises(ValueError, lambda: batch(packing_of=[0, 1, 2], n=3), "packing 2")
    raises(ValueError, lambda: batch(packing_of=[0, 1], n=3), "3 integers")
    raises(ValueError, lambda: voussoir.RveBatch([]), "at least one")
    raises(FileNotFoundError, lambda: voussoir.RveBatch(FOLDER / "none.h5"), "none.h5")
    raises(voussoir.Unreadable, lambda: voussoir.load_packing(FOLDER / "first" / "path.csv"))
    with batch() as open_one:
        raises(ValueError, lambda: open_one.evaluate(np.zeros((3, 2, 2))), "(2, 2, 2)")
        open_one.evaluate(np.zeros((2, 2, 2)))
        raises(ValueError, lambda: open_one.evaluate(np.full((2, 2, 2), np.nan)), "RVE 0 is not finite")
        raises(RuntimeError, open_one.commit, "refused or interrupted")
        mistaken = np.eye(2) + 0.09 * np.ones((2, 2, 2))
        raises(ValueError, lambda: open_one.evaluate(mistaken), "F minus identity")
        mistaken[1] = 0  # one point that is right: no mistake of all points
        answer = open_one.evaluate(mistaken)
        check(voussoir.status_names[answer.report["status"][0]] == "open", str(answer.report))
        raises(IndexError, lambda: open_one.snapshot(2), "2")
    raises(RuntimeError, lambda: open_one.evaluate(np.zeros((2, 2, 2))), "closed")
    raises(RuntimeError, open_one.fields, "closed")
    open_one.close()
    check("closed" in repr(open_one) and len(open_one) == 2, repr(open_one))
    flat = {"packing.void_ratio": 0.9}
    error = raises(
        voussoir.NoEquilibrium, lambda: voussoir.make_packings(1, grains=30, settings=flat), "none of the 1 packings"
    )
    check("out of reach" in error.__notes__[0], str(error.__notes__))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        (dense,) = voussoir.make_packings(2, grains=30, settings={"packing.void_ratio": 0.18})
    check(dense.seed == 1 and len(told) == 1 and told[0].category is voussoir.PackingWarning, str(told))
    reason = "packing of seed 2 does not come to rest (step_limit) and is left out"
    check(str(told[0].message) == f"1 of 2 packings are missing: {reason}", str(told[0].message))


def check_arguments(packings):
    """Slips in arguments: the message names the argument, and what can be meant is taken."""

    def batch(n=None, **more):
        return voussoir.RveBatch(packings, n, **more)

    error = raises(
        voussoir.InputError, lambda: batch(preset="best"), "preset (engine.preset)", "fast, standard, reference"
    )
    check((error.place, error.key, error.line) == ("preset", "engine.preset", None), str(vars(error)))
    raises(voussoir.InputError, lambda: batch(settings={"engine.preset": "best"}), "settings:1: engine.preset")
    raises(voussoir.InputError, lambda: batch(tangent="steep"), "tangent (newton.tangent)")
    raises(ValueError, lambda: batch(0), "at least one point", "n is 0")
    raises(TypeError, lambda: batch(2.5), "n must be an integer, is 2.5")
    raises(MemoryError, lambda: batch(10**12), "GiB")
    raises(ValueError, lambda: batch(mirrored=[True]), "2 of them")
    raises(ValueError, lambda: batch(mirrored="yes"), "2 of them")
    raises(TypeError, lambda: voussoir.RveBatch(4), "make_packings")
    raises(TypeError, lambda: voussoir.make_packings(2.5), "seeds must be an integer, is 2.5")
    raises(TypeError, lambda: voussoir.make_packings("3"), "seeds must be an integer, is '3'")
    raises(TypeError, lambda: voussoir.make_packings(pressure="100 kPa"), "a number in Pa")
    raises(TypeError, lambda: voussoir.make_packings(settings=["soil.modulus=1"]), "are a dictionary")
    with batch(packing_of=[0, 1, 1], microstructure="fabric") as three:
        check(len(three) == 3 and "fabric_anisotropy" in three.fields(), repr(three))
        raises(TypeError, lambda: three.evaluate(np.zeros((3, 2, 2)), tangent="loading"), "True or False")
        raises(TypeError, lambda: three.set_state("x"), "bytes")
        inside_out = np.zeros((3, 2, 2))
        inside_out[1, 0, 0] = -1.5
        answer = three.evaluate(inside_out)
        check("point 1 turns its cell inside out: det F is -0.5" in answer.message, answer.message)
    with voussoir.RveBatch.from_case(CASE, 2, {"packing": {"grains": np.int64(40)}}) as small:
        check(len(small.packing(0)) == 40, repr(small.packing(0)))


def check_device(packings):
    """RVEs on a device, here on the one that the host emulates: its library is found by an environment variable."""
    code = (
        "import sys, numpy as np, voussoir\n"
        "packing = voussoir.load_packing(sys.argv[1])\n"
        "for backend in ('gpu', 'lanes'):\n"
        "    with voussoir.RveBatch(packing, 4, backend=backend, tangent='contact') as batch:\n"
        "        print(batch._core.device())\n"
        "        f = np.broadcast_to(np.diag([0, -1e-4]), (4, 2, 2))\n"
        "        for _ in range(2): answer = batch.evaluate(f); batch.commit()\n"
        "        state = batch.state([2]); batch.set_state(state, [1])\n"
        "        print(answer.usable, answer.stress[:, 1, 1].round(-2), batch.packing(2).void_ratio)\n"
    )
    place = FOLDER / "of_device.h5"
    packings[0].save(place)
    environment = {**os.environ, "VOUSSOIR_GPU_LIBRARY": os.environ["VOUSSOIR_EMULATED_GPU"]}
    words = [sys.executable, "-c", code, str(place)]
    done = subprocess.run(words, check=False, capture_output=True, text=True, env=environment, timeout=120)
    check(done.returncode == 0, done.stderr)
    said, on_device, _, on_lanes = done.stdout.splitlines()
    check("device" in said and "emulated" in said, said)
    check(on_device == on_lanes, f"the device answers {on_device}, the lanes {on_lanes}")


def check_stub():
    """The stub of the compiled module has its functions, and these have the stub's arguments."""
    core = voussoir.engine.core()
    stub = ast.parse((Path(voussoir.__file__).parent / "_core.pyi").read_text())

    def functions(body):
        return {one.name: [a.arg for a in one.args.args] for one in body if isinstance(one, ast.FunctionDef)}

    def runtime(owner):  # a signature is not Python's grammar: ndarray[dtype=float64, ...]
        known = {name: getattr(owner, name) for name in dir(owner) if not name.startswith("__") or name == "__len__"}
        texts = {name: one.__nb_signature__[0][0] for name, one in known.items() if hasattr(one, "__nb_signature__")}
        return {name: ["self"] * ("(self" in text) + re.findall(r"(\w+):", text) for name, text in texts.items()}

    batch = next(one for one in stub.body if isinstance(one, ast.ClassDef))
    methods = functions(batch.body)
    check(methods.pop("is_open") == ["self"], "is_open is a property")
    check(functions(stub.body) == runtime(core), f"{functions(stub.body)} and {runtime(core)}")
    check(methods == runtime(core.Batch), f"{methods} and {runtime(core.Batch)}")


made = check_packing_files()
check_stub()
check_same_bits(made)
check_tangents()
check_mirrored(made)
check_states(made)
check_increments(made)
check_errors(made)
check_arguments(made)
if Path(os.environ["VOUSSOIR_EMULATED_GPU"]).exists():
    check_device(made)
check(voussoir.status_names == tuple(voussoir.engine.core().status_names()), "names of the statuses")
check(f"voussoir {voussoir.__version__}" in run([PROGRAM, "--version"]).stdout, "the version is the program's")
