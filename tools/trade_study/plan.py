"""The runs of the study: one knob at a time around the preset `standard`, and a reference solution, as cases of kind
`probe`."""

import json
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

# At 1 kPa a path takes thirty times its steps at 100 kPa, so that only the presets are run with every packing there.
FEWER_SEEDS_AT = {1: 4}  # for the other knobs: one packing in so many
REPLICAS = {
    True: 8,
    False: 2,
}  # True: of a path, which may be chaotic; False: of a single evaluation, which is hardly so
PRESSURES = {kpa: f"{kpa} kPa" for kpa in (1, 3, 10, 20, 30, 100, 200, 300, 800)}
USUAL_PRESSURES = (1, 100, 800)
PROBE_STRAIN = {kpa: 1e-4 if kpa == 1 else 1e-3 for kpa in PRESSURES}
PATH_STRAIN = 0.025  # axial, at constant lateral stress: a shear strain of 4 to 6 %
INCREMENTS = 25
# The reference solution is far more exact than the preset `reference`, which is one of the measured settings.
REFERENCE = {
    "precision": "double",
    "inertial_number": 1e-5,
    "hold_tolerance": 1e-4,
    "hold_cap": 20000,
    "minimum_steps": 500,
    "maximum_steps": 1000000,
}
# Paths at low pressures need up to ten times the steps.
REFERENCE_AT = {kpa: {"inertial_number": 3e-5} for kpa in PRESSURES if kpa <= 30}
# What `engine.accuracy` follows: the inertial number alone, with bounds on the steps that do not bind.
CURVE = {"preset": "standard", "minimum_steps": 10, "maximum_steps": 1000000}
CURVE_VALUES = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


@dataclass(frozen=True)
class Setting:
    """One column of the study."""

    knob: str
    label: str
    keys: dict = field(default_factory=dict, hash=False, compare=False)  # of [engine]; "table.key" for others
    increments: int = INCREMENTS

    @property
    def name(self):
        return f"{self.knob}_{self.label}".replace(" ", "_")

    @property
    def is_of_the_engine(self):
        """True where single evaluations depend on the setting and the packings do not."""
        return self.knob not in ("curve", "accuracy", "increments", "modulus", "grains")


def settings():
    """The presets, and around `standard` each knob by itself. A bound on steps has its effect where it binds: the lower
    bound in small increments, the upper one in large increments."""
    every = [Setting("preset", name, {"preset": name}) for name in ("fast", "standard", "reference")]
    knobs = {
        "inertial_number": (3e-3, 1e-3, 3e-4, 1e-4, 3e-5),
        "hold_tolerance": (1e-2, 3e-3, 1e-3, 3e-4, 1e-4),
        "precision": ("float", "double"),
        "hold_cap": (0, 100, 1000, 4000),
        "skin": (0.05, 0.1, 0.2),
    }
    every += [
        Setting(knob, f"{value:g}" if not isinstance(value, str) else value, {"preset": "standard", knob: value})
        for knob, values in knobs.items()
        for value in values
    ]
    every += [
        Setting("minimum_steps", str(n), {"preset": "standard", "minimum_steps": n}, 100)
        for n in (10, 20, 50, 100, 200)
    ]
    every += [
        Setting("maximum_steps", str(n), {"preset": "standard", "maximum_steps": n}, 5)
        for n in (500, 1000, 2000, 10000)
    ]
    every += [
        Setting(
            "floor_and_hold",
            f"{n} {hold:g} in {parts}",
            {"preset": "standard", "minimum_steps": n, "hold_tolerance": hold},
            parts,
        )
        for parts in (25, 100, 400)
        for n in (10, 20, 50)
        for hold in (1e-3, 3e-4)
    ]
    every += [Setting("curve", f"{value:g}", {**CURVE, "inertial_number": value}) for value in CURVE_VALUES]
    every += [Setting("accuracy", f"{value} %", {"accuracy": f"{value} %"}) for value in (3, 1, 0.3)]
    every += [Setting("increments", str(n), {"preset": "standard"}, n) for n in (5, 10, 25, 100)]
    every += [
        Setting("modulus", text, {"preset": "standard", "soil.modulus": text})
        for text in ("0.3 GPa", "3 GPa", "30 GPa")
    ]
    every += [Setting("grains", str(n), {"preset": "standard", "packing.grains": n}) for n in (100, 200, 300, 400, 700)]
    return every


def toml(value):
    return json.dumps(value)


# Velocity gradients of the paths, for an axial strain or shear strain of 1; sigma_xx stays constant.
PATHS = {"compression": (0, 0, 0, -1), "extension": (0, 0, 0, 1), "shear": (0, 1, 0, 0)}


def case_text(setting, kpa, seed, packings, *, path, file=None, way="compression"):
    tables = {
        "packing": {"grains": 300, "folder": str(packings)},
        "engine": {},
        "soil": {},
        "probe": {"pressure": PRESSURES[kpa], "strain": PROBE_STRAIN[kpa], "replicas": REPLICAS[path]},
    }
    tables["packing"].update({"file": str(file)} if file else {"seeds": [seed]})
    for key, value in setting.keys.items():
        table, _, name = key.rpartition(".")
        tables[table or "engine"][name] = value
    text = 'kind = "probe"\n'
    for name, keys in tables.items():
        text += f"\n[{name}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in keys.items())
    if path:
        gradient = ", ".join(f"{part * PATH_STRAIN / setting.increments:.9g}" for part in PATHS[way])
        text += f"\n[[probe.path]]\ngradient = [{gradient}]\nincrements = {setting.increments}\nconstant_xx = true\n"
    return text


class Study:
    """Runs cases below one folder, several at a time. A case whose results are there with the same text is not
    repeated."""

    def __init__(self, program, folder, seeds, pressures, processes, *, way="compression"):
        self.program, self.folder, self.way = Path(program), Path(folder), way
        self.seeds, self.pressures, self.processes = seeds, pressures, processes

    def reference(self, kpa):
        return Setting("reference", "solution", {**REFERENCE, **REFERENCE_AT.get(kpa, {})})

    def seeds_of(self, setting, kpa):
        every = 1 if setting.knob in ("reference", "preset", "curve") else FEWER_SEEDS_AT.get(kpa, 1)
        return self.seeds[: max(1, len(self.seeds) // every)]

    def seeds_needed(self, chosen, kpa):
        """The seeds of the reference solution: no more than the runs have that are compared with it."""
        return {seed for setting in chosen for seed in self.seeds_of(setting, kpa)}

    def path_folders(self, setting, kpa):
        return {seed: self.folder / f"path_{kpa}" / f"{setting.name}_{seed}" for seed in self.seeds_of(setting, kpa)}

    def probe_folders(self, setting, kpa, state):
        return {seed: self.folder / f"{state}_{kpa}" / f"{setting.name}_{seed}" for seed in self.seeds_of(setting, kpa)}

    def run(self, jobs):
        with ThreadPoolExecutor(self.processes) as pool:
            for line in pool.map(lambda job: self.run_one(*job), jobs):
                if line:
                    print(line, flush=True)

    def run_one(self, folder, text):
        case = folder.parent / (folder.name + ".toml")
        if case.exists() and case.read_text() == text and (folder / "probe.csv").exists():
            return ""
        shutil.rmtree(folder, ignore_errors=True)
        case.parent.mkdir(parents=True, exist_ok=True)
        case.write_text(text)
        done = subprocess.run(
            [self.program, "run", case, "-o", folder, "--replace", "--threads", "1"],
            check=False,
            capture_output=True,
            text=True,
        )
        if done.returncode not in (0, 3):
            sys.exit(f"{case}: exit {done.returncode}\n{done.stderr}")
        return f"{folder.relative_to(self.folder)}" + (f" ({done.stderr.strip()})" if done.returncode else "")

    def packing_jobs(self, chosen):
        """Makes each packing once, before the processes that need it start, since two of them would both make it."""
        jobs = {}
        for kpa in self.pressures:
            for setting in (self.reference(kpa), *chosen):
                keys = {k: v for k, v in setting.keys.items() if "." in k}
                plain = Setting(
                    "packing", "_".join(str(v) for v in keys.values()) or "standard", {"preset": "fast", **keys}
                )
                for seed in sorted(self.seeds_needed(chosen, kpa) & set(self.seeds_of(setting, kpa))):
                    jobs[self.folder / f"packing_{kpa}" / f"{plain.name}_{seed}"] = self.text(
                        plain, kpa, seed, path=False
                    )
        return jobs.items()

    def path_jobs(self, chosen):
        for setting, kpa in self.with_reference(chosen):
            for seed, folder in self.path_folders(setting, kpa).items():
                if seed in self.seeds_needed(chosen, kpa):
                    yield folder, self.text(setting, kpa, seed, path=True)

    def probe_jobs(self, chosen):
        """Runs evaluations from the isotropic packing and from the end of the reference solution's path."""
        for setting, kpa in self.with_reference(chosen):
            ends = self.path_folders(self.reference(kpa), kpa)
            isotropic, sheared = (self.probe_folders(setting, kpa, state) for state in ("isotropic", "sheared"))
            for seed in sorted(self.seeds_needed(chosen, kpa) & set(isotropic)):
                yield isotropic[seed], self.text(setting, kpa, seed, path=False)
                yield (
                    sheared[seed],
                    self.text(setting, kpa, seed, path=False, file=(ends[seed] / f"end_{seed}.h5").resolve()),
                )

    def with_reference(self, chosen):
        return [(setting, kpa) for kpa in self.pressures for setting in (self.reference(kpa), *chosen)]

    def text(self, setting, kpa, seed, **what):
        return case_text(setting, kpa, seed, (self.folder / "packings").resolve(), way=self.way, **what)
