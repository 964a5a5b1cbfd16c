"""Voussoir's hub under the real Micro Manager, with a stand-in for preCICE (tests/precice_stand_in): it answers as its
batch does, whatever is taken back, and it refuses what one batch cannot do, with a sentence."""

import importlib.util
import json
import os
import pickle
import shutil
import subprocess
import sys
import time
import types
from pathlib import Path

import numpy as np
from elastic_batch import ElasticBatch
from launcher import on_ranks
from program import ROOT, check, fresh
from python_package import voussoir
from tutorial_pages import Reader, follow

NEEDED = ("micro_manager", "mpi4py", "psutil", "preciceadapterschema")
WRITTEN = ("Stress-X", "Stress-Y", "Tangent-22", "Status")
POINTS = 6


def skip_where_something_is_missing():
    sys.path.insert(0, str(ROOT / "tests/precice_stand_in"))
    missing = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    try:
        from mpi4py import MPI  # noqa: F401, PLC0415 - there may be no MPI on this machine
    except (ImportError, RuntimeError) as reason:
        missing.append(str(reason))
    if missing:
        print(f"skipped without {', '.join(missing)}")
        raise SystemExit(77)


def macro_side(windows=3, iterations=1, steps=1, total=False):
    """Gradients of a shear and a compression that grow, each iteration nearer to the last one."""
    one = 1e-4 * np.array([[0.5, 2.0], [1.0, -1.5]])
    nearer = 1 + 0.3 * (iterations - 1 - np.arange(iterations))[:, None, None, None] / iterations
    gradients = [
        nearer * (1 + np.arange(steps)[:, None, None] + steps * window * total) * one for window in range(windows)
    ]
    return {
        "points": POINTS,
        "windows": windows,
        "iterations": iterations,
        "steps": steps,
        "gradients": [g.tolist() for g in gradients],
    }


def configuration(name, **parameters):
    return {
        "participant_name": "Micro-Manager",
        "precice_config_file_path": "precice-config.xml",
        "interfaces": [
            {
                "mesh_name": "Macro-Mesh",
                "read_data": [{"name": name} for name in ("Gradient-X", "Gradient-Y")],
                "write_data": [{"name": name} for name in WRITTEN],
            }
        ],
        "micro_manager": {
            "micro_file_names": [name],
            "simulation_params": {
                "micro_dt": 1.0,
                "macro_domain_bounds": [0.0, 1.0, 0.0, 1.0],
                "decomposition": [1, 1],
                **parameters,
            },
        },
    }


def couple(name, macro, hub, flags=None, **parameters):
    """Runs the Micro Manager once; returns what it wrote, (window, iteration, step, name, values)."""
    import precice  # noqa: PLC0415 - only behind skip_where_something_is_missing
    from micro_manager import MicroManagerCoupling  # noqa: PLC0415
    from voussoir.precice import Point  # noqa: PLC0415

    output = {"output": lambda point: point.hub.output(f"{name}_grains")} if name.startswith("output") else {}
    sys.modules[name] = types.ModuleType(name)
    vars(sys.modules[name])["MicroSimulation"] = type("MicroSimulation", (Point,), {"hub": hub, **output})
    file = Path(f"{name}_macro.json").absolute()
    file.write_text(json.dumps(macro))
    os.environ["VOUSSOIR_MACRO"] = str(file)
    config = configuration(name, **parameters)
    config["micro_manager"] |= flags or {}
    Path(f"{name}.json").write_text(json.dumps(config))
    precice.log.clear()
    manager = MicroManagerCoupling(f"{name}.json", log_file=f"{name}.log")
    manager.initialize()
    manager.solve()
    return list(precice.log)


def expected(batch, macro, total=False):
    """The same from the batch directly: each iteration begins at the start of its window."""
    weights = 1 + 0.3 * np.arange(POINTS)[:, None, None] / POINTS
    written, deformation = [], np.zeros((POINTS, 2, 2))
    for window, iterations in enumerate(macro["gradients"]):
        state, start = batch.state(), deformation
        for iteration, steps in enumerate(iterations):
            if iteration and len(steps) > 1:
                batch.set_state(state)
            deformation = start
            for step, gradient in enumerate(steps):
                asked = weights * np.array(gradient)
                relative = (asked - deformation) @ np.linalg.inv(np.eye(2) + deformation) if total else asked
                answer = batch.evaluate(relative)
                values = (answer.stress[:, 0], answer.stress[:, 1], answer.tangent[:, 1, 1], answer.report["status"])
                written += [(window, iteration, step, n, v) for n, v in zip(WRITTEN, values)]
                deformation = asked if total else deformation
                if step + 1 < len(steps) or iteration + 1 == len(iterations):
                    batch.commit()
    return written


def check_same(name, found, wanted):
    check(len(found) == len(wanted) > 0, f"{name}: {len(found)} data were written, not {len(wanted)}")
    for (*place, values), (*place_wanted, values_wanted) in zip(found, wanted):
        check(place == place_wanted and np.array_equal(values, values_wanted), f"{name}: {place} differs")


def check_answers():
    """Whatever is taken back, and wherever the gradients count from, the answers have the batch's own bits."""
    from voussoir.precice import Hub  # noqa: PLC0415

    for name, iterations, steps, total in (
        ("explicit", 1, 1, False),
        ("implicit", 3, 1, False),
        ("substeps", 1, 2, False),
        ("implicit_substeps", 2, 3, False),
        ("total", 2, 2, True),
        ("output", 2, 2, True),
    ):
        macro = macro_side(iterations=iterations, steps=steps, total=total)
        hub = Hub(lambda ids: ElasticBatch(len(ids)), gradients="total" if total else "window")
        found = couple(name, macro, hub)
        check_same(name, found, expected(ElasticBatch(POINTS), macro, total))
        evaluations = 3 * iterations * steps
        check(hub.evaluations == evaluations, f"{name}: {hub.evaluations} evaluations, not {evaluations}")
        check(list(hub.ids) == list(range(POINTS)), f"{name}: the batch has the points {hub.ids}")
    files = sorted(Path("output_grains").glob("*.npz"))
    check(len(files) == 3, f"there are fields of {len(files)} windows")
    last = np.load(files[-1])
    check(np.array_equal(last["stress"][:, 0], found[-4][-1]), "the fields of a window are those of its answers")


def fails(name, sentence, macro, hub, flags=None, **parameters):
    """The coupling ends with an exception that has this sentence."""
    try:
        couple(name, macro, hub, flags, **parameters)
    except (Exception, SystemExit) as reason:
        said = f"{reason}\n{Path(f'{name}.log').read_text() if Path(f'{name}.log').exists() else ''}"
        check(sentence in said, f"{name}: '{sentence}' is not in: {said}")
        return
    check(False, f"{name}: nothing failed")


def check_refusals():
    from voussoir.precice import Hub, Point  # noqa: PLC0415

    def elastic():
        return Hub(lambda ids: ElasticBatch(len(ids)))

    def breaking(ids):
        batch = ElasticBatch(len(ids))
        batch.fails = lambda h: h[:, 1, 1] < -3.55e-4
        return batch

    three = macro_side(windows=3, steps=2)
    fails("broken", "2 of 6 points found no answer, global ids 4, 5", three, Hub(breaking))
    adaptivity = {
        "type": "local",
        "data": ["Gradient-X"],
        "history_param": 0.1,
        "coarsening_constant": 0.9,
        "refining_constant": 0.01,
    }
    fails("adaptive", "no adaptivity", macro_side(), elastic(), adaptivity=True, adaptivity_settings=adaptivity)
    fails("one_for_all", "stateless", macro_side(), elastic(), {"micro_stateless_flags": [True]})

    def ask(point, compression=0.0):
        return point.solve({"Gradient-X": [0.0, 0.0], "Gradient-Y": [0.0, -compression]}, 1.0)

    def broken_pair():
        of_pair = type("MicroSimulation", (Point,), {"hub": Hub(breaking)})
        points = of_pair(3), of_pair(8)
        first, _ = [ask(point, compression) for point, compression in zip(points, (1e-4, 1e-3))]
        return first["Stress-X"]

    kind = type("MicroSimulation", (Point,), {"hub": elastic()})
    point = kind(0)
    answer = ask(point)
    lonely_kind = type("MicroSimulation", (Point,), {"hub": elastic()})
    lonely, silent = lonely_kind(3), lonely_kind(8)
    for name, deed, sentence in (
        ("late", lambda: kind(1), "load balancing"),
        ("state", lambda: pickle.dumps(point.get_state()), "cannot move"),
        ("answer", lambda: pickle.dumps(answer), "cannot move"),
        ("name", lambda: (answer["Stress-X"], answer["Stress-Z"]), "do not write Stress-Z"),
        ("shape", lambda: point.solve({"Gradient-X": [np.nan, 0.0], "Gradient-Y": [0.0, 0.0]}, 1.0), "finite"),
        ("number", lambda: point.set_global_id(3), "cannot become"),
        ("grains", Hub, "come from one of"),
        ("silent", lambda: ask(lonely)["Stress-X"], f"point {silent.global_id} was not asked (1 of 2)"),
        ("pair", broken_pair, "1 of 2 points found no answer, global ids 8:"),
    ):
        try:
            deed()
        except (RuntimeError, ValueError, KeyError) as reason:
            check(sentence in str(reason), f"{name}: {reason}")
        else:
            check(False, f"{name}: was not refused")


def check_grains(packings):
    """A hub has the bits of its batch, and of a batch for each point, which takes longer."""
    from voussoir.precice import Hub  # noqa: PLC0415

    class OneByOne:
        """A batch for each point behind the interface of one: what a micro simulation without a hub would have."""

        def __init__(self, ids):
            self.batches = [voussoir.RveBatch(packings[g % len(packings)], 1) for g in ids]

        def evaluate(self, h, tangent):
            answers = [batch.evaluate(h[k : k + 1], tangent) for k, batch in enumerate(self.batches)]
            parts = (np.concatenate(part) for part in zip(*(answer[:3] for answer in answers)))
            return voussoir.Answer(*parts, True, "")

        def commit(self):
            for batch in self.batches:
                batch.commit()

    macro = macro_side(2, 2)
    hubs = {"hub": Hub(packings=packings), "one_by_one": Hub(OneByOne)}
    written, seconds = {}, {}
    for name, hub in hubs.items():
        begin = time.perf_counter()
        written[name] = couple(name, macro, hub)
        seconds[name] = time.perf_counter() - begin
    check_same("grains", written["hub"], expected(voussoir.RveBatch(packings, POINTS), macro))
    images = np.arange(POINTS) // len(packings) % 2 == 1
    mirrored = couple("mirrored", macro, Hub(packings=packings, mirrored=True))
    check_same("mirrored", mirrored, expected(voussoir.RveBatch(packings, POINTS, mirrored=images), macro))
    check_same("one by one", written["one_by_one"], written["hub"])
    print(f"{POINTS} points: hub {seconds['hub']:.2f} s, a batch for each point {seconds['one_by_one']:.2f} s")


def check_ranks(packings):
    """Two ranks with a batch each give the bits of one."""
    files = []
    for k, packing in enumerate(packings):
        files.append(f"packing_{k}.h5")
        packing.save(files[-1])
    script = str(ROOT / "tests/regression/precice_ranks.py")
    environment = dict(os.environ)  # as it was before MPI of this process made mpirun take itself for a rank
    found = {}
    for size in (1, 2):
        words = on_ranks(size, [sys.executable, "-m", "mpi4py", script, *files])  # a rank that fails ends all
        done = subprocess.run(words, check=False, capture_output=True, text=True, timeout=100, env=environment)
        check(done.returncode == 0, f"{size} ranks end with {done.returncode}: {done.stdout}{done.stderr}")
        parts = [np.load(f"rank_{rank}_of_{size}.npz") for rank in range(size)]
        check(all(part["evaluations"] == 4 for part in parts), f"{size} ranks: more than four evaluations")
        found[size] = np.concatenate([part["stress"] for part in parts], axis=1)
        check(list(np.concatenate([part["ids"] for part in parts])) == list(range(POINTS)), f"{size} ranks: points")
    check(np.array_equal(found[1], found[2]), "two ranks differ from one")


def follow_page():
    """The files of the page run, in two threads that the stand-in couples."""
    environment = {name: value for name, value in os.environ.items() if name != "VOUSSOIR_MACRO"}
    stand_in = ROOT / "tests/precice_stand_in"
    environment["STAND_IN"] = str(stand_in)
    environment["PYTHONPATH"] = f"{stand_in}:{ROOT / 'python/examples'}:{environment.get('PYTHONPATH', '')}"
    folder = fresh("page").absolute()
    folder.mkdir()
    follow(ROOT / "docs/how-to/couple_with_precice.md", Reader(folder, whole=False, environment=environment))


def main():
    skip_where_something_is_missing()
    packings = voussoir.make_packings(seeds=2, grains=60, pressure=100e3)
    check_answers()
    check_refusals()
    check_grains(packings)
    follow_page()
    if shutil.which("mpirun"):
        check_ranks(packings)


if __name__ == "__main__":
    main()
