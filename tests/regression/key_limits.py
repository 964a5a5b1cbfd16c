"""Tries every key of every kind of case at both ends of its limits, one step outside, and with values of wrong forms.

What there is to try comes from `voussoir keys KIND`, so that a new key needs no line here. Used by key_limits_test.py
(every key once, with `check`) and key_limits_long_test.py (every key of every kind, with `run` as well).
"""

import csv
import io
import re
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import h5py
import numpy as np
from key_limits_scene import NEEDED, OR_ONE, scene_tables
from program import PROGRAM, check

KINDS = ("pack", "probe", "biaxial", "biaxial_bvp", "calibrate", "column", "tunnel", "scene")
UNITS = {"length": "m", "pressure": "Pa", "unit weight": "N/m3", "density": "kg/m3", "angle": "rad"}

# A case of each kind that is done in about a second, by table; the names of arrays of tables end in [].
GRAINS = {"packing": {"grains": "40", "folder": '"packings"'}, "engine": {"preset": '"fast"'}}
TESTS = {"pressures": '["100 kPa"]', "strain": '"2 %"', "window": '"1 %"', "samples": "100", "inertial_number": "3e-4"}
TINY = {
    "pack": GRAINS,
    "probe": GRAINS | {"probe.path[]": {"gradient": "[0, 0, 0, -1e-4]"}},
    "biaxial": GRAINS | {"biaxial": TESTS},
    "biaxial_bvp": GRAINS
    | {"biaxial_bvp": {"columns": "1", "rows": "1", "strain": '"0.2 %"', "strain_step": '"0.1 %"'}},
    "calibrate": GRAINS
    | {
        "biaxial": TESTS,
        "calibrate": {
            "rolling_stiffness": "[0.1, 0.2]",
            "rounds": "0",
            "confirm_grains": "40",
            "confirm_seeds": "[1, 2]",
            "confirm_inertial_number": "3e-4",
        },
    },
    "column": GRAINS | {"column": {"elements": "2"}, "gravity": {"ratio": "10", "uniform_step": "1"}},
    "tunnel": GRAINS
    | {
        "": {"material": '"linear_elastic"'},
        "column": {"elements": "2"},
        "ground": {
            "width": '"20 m"',
            "height": '"20 m"',
            "cover_ratio": "1",
            "mesh_size_opening": '"2.5 m"',
            "mesh_size_far": '"8 m"',
        },
        "gravity": {"ratio": "10", "uniform_step": "1"},
        "volume_loss": {"total": '"1 %"', "increments": "1"},
    },
    "scene": GRAINS
    | {
        "": {"material": '"linear_elastic"'},
        "gravity": {"ratio": "10", "uniform_step": "1"},
        "region[]": {"name": '"ground"'},
        "support[]": {"boundary": '["base", "cavity", "far", "left"]', "fix": '"xy"'},
        "stage[]": {"name": '"load"', "steps": "1"},
    },
}
# What a value at its limit needs beside it, so that no relation between keys forbids it; by key and limit, or by key.
SMALL_TUNNEL = {
    "ground.width": '"2 cm"',
    "ground.height": '"5 cm"',
    "ground.diameter": '"1 cm"',
    "ground.mesh_size_opening": '"5 mm"',
    "ground.mesh_size_far": '"1 cm"',
    "ground.unit_weight": '"1 MN/m3"',
    "ground.surcharge": '"100 Pa"',
    "packing.pressure": '"100 Pa"',
}
LARGE_TUNNEL = {
    "ground.width": '"10 km"',
    "ground.height": '"10 km"',
    "ground.diameter": '"1 km"',
    "ground.mesh_size_opening": '"500 m"',
    "ground.mesh_size_far": '"5 km"',
}
BESIDE = {
    ("ground.surcharge", "10 MPa"): {"packing.pressure": '"10 MPa"', "ground.unit_weight": '"1 MN/m3"'},
    ("ground.surcharge", "100 Pa"): {"packing.pressure": '"100 Pa"'},
    ("packing.pressure", "10 MPa"): {"ground.surcharge": '"10 MPa"', "ground.unit_weight": '"1 MN/m3"'},
    ("packing.pressure", "100 Pa"): {"ground.surcharge": '"100 Pa"'},
    ("ground.unit_weight", "1 N/m3"): {"ground.height": '"10 km"', "ground.mesh_size_far": '"5 km"'},
    ("ground.height", "1 cm"): SMALL_TUNNEL,
    ("ground.width", "1.5 cm"): SMALL_TUNNEL,
    ("ground.diameter", "1 cm"): SMALL_TUNNEL,
    ("ground.mesh_size_opening", "1 mm"): SMALL_TUNNEL,
    ("ground.mesh_size_far", "1 mm"): SMALL_TUNNEL | {"ground.mesh_size_opening": '"1 mm"'},
    ("ground.height", "10 km"): LARGE_TUNNEL,
    ("ground.width", "10 km"): LARGE_TUNNEL,
    ("ground.diameter", "1 km"): LARGE_TUNNEL,
    ("ground.mesh_size_opening", "500 m"): LARGE_TUNNEL,
    ("ground.mesh_size_far", "10 km"): LARGE_TUNNEL,
    ("ground.cover_ratio", "20"): {"ground.diameter": '"0.8 m"', "ground.mesh_size_opening": '"0.4 m"'},
    ("engine.minimum_steps", "10000000"): {"engine.maximum_steps": "10000000"},
    ("engine.maximum_steps", "1"): {"engine.minimum_steps": "1"},
    ("soil.size_minimum", "1 m"): {"soil.size_maximum": '"1 m"'},
    ("soil.size_minimum", "0.001 mm"): {"soil.size_maximum": '"0.002 mm"'},
    ("soil.size_maximum", "1 m"): {"soil.size_minimum": '"0.5 m"'},
    ("soil.sizes", "0.001 mm"): {"soil.passing": "[0, 1]"},
    ("soil.sizes", "1 m"): {"soil.passing": "[0, 1]"},
    ("soil.passing", "0"): {"soil.sizes": '["2 mm", "4 mm", "5 mm"]'},
    ("soil.passing", "1"): {"soil.sizes": '["2 mm", "4 mm", "5 mm"]'},
    ("soil.size_maximum", "0.001 mm"): {"soil.size_minimum": '"0.001 mm"'},
    ("soil.class[].size_to", "0.001 mm"): {"soil.size_minimum": '"0.001 mm"', "soil.size_maximum": '"0.001 mm"'},
    ("biaxial.strain", "1e-4"): {"biaxial.window": '"5e-5"'},
    ("biaxial.window", "1e-5"): {"biaxial.strain": "1e-4", "biaxial.samples": "100"},
    ("biaxial.window", "0.1"): {"biaxial.strain": '"20 %"'},
    ("biaxial.strain", "1"): {"biaxial.window": '"10 %"', "biaxial.samples": "100"},
    ("biaxial_bvp.strain", "1e-6"): {"biaxial_bvp.strain_step": "1e-6"},
    ("biaxial_bvp.strain", "0.5"): {"biaxial_bvp.strain_step": "0.05"},
    ("biaxial_bvp.strain_step", "1e-7"): {"biaxial_bvp.strain": "1e-6"},
    ("biaxial_bvp.strain_step", "0.05"): {"biaxial_bvp.strain": "0.05"},
    ("calibrate.peak_strain_minimum", "0.9"): {"calibrate.peak_strain_maximum": "1"},
    ("calibrate.peak_strain_maximum", "1e-5"): {"calibrate.peak_strain_minimum": "0"},
}
# Lists that need more than one entry, by key and limit, or by key; {} is the limit.
LISTS = {
    ("mesh.x", "10 km"): '["0 m", {}]',
    ("mesh.y", "10 km"): '["0 m", {}]',
    "mesh.x": '[{}, "1 m"]',
    "mesh.y": '[{}, "1 m"]',
    "stage[].press[].traction": '[{}, "0 Pa"]',
    ("soil.sizes", "0.001 mm"): '[{}, "0.002 mm"]',
    ("soil.sizes", "1 m"): '["0.5 m", {}]',
    ("calibrate.rolling_stiffness", "10"): "[0.1, {}]",
    "soil.passing": "[0, {}, 1]",
    "probe.path[].gradient": "[{}, 0, 0, 0]",
    "calibrate.rolling_stiffness": "[{}, 1]",
    "calibrate.confirm_seeds": "[{}, 5]",
}


def keys_of(kind):
    done = subprocess.run([PROGRAM, "keys", kind], check=False, capture_output=True, text=True, timeout=60)
    check(done.returncode == 0, f"keys {kind}: exit {done.returncode}: {done.stderr}")
    return list(csv.DictReader(io.StringIO(done.stdout)))


def lines_of(kind, settings):
    """The tiny case of a kind as TOML, with further settings, a dictionary of full keys. Returns text and, for each
    key, its line."""
    tables = {name: dict(keys) for name, keys in TINY[kind].items()}
    if kind == "scene":
        tables = scene_tables(settings, tables)
    known = {key["key"] for key in keys_of_kind(kind)}
    for key, value in settings.items():
        if key.rsplit(".", 1)[0] == key:
            tables.setdefault("", {})[key] = value
        elif key in known:
            table, name = key.rsplit(".", 1)
            tables.setdefault(table, dict(NEEDED.get(table, {})))[name] = value
            if key in ("stage[].move[].rotation", "stage[].move[].area"):
                tables[table] = {"boundary": '"top"', name: value, "about": '["0 m", "0 m"]'}
    lines, place = ["", f'kind = "{kind}"'], {"kind": 2}
    for table in sorted(tables, key=lambda name: (name != "", "[]" in name, name)):
        if table:
            plain = table.replace("[]", "")
            lines.append(f"[[{plain}]]" if table.endswith("[]") else f"[{plain}]")
        for name, value in tables[table].items():
            if table == "" and name == "kind":
                lines[1] = f"kind = {value}"
                continue
            lines.append(f"{name} = {value}")
            place[f"{table}.{name}" if table else name] = len(lines)
    return "\n".join(lines) + "\n", place


KNOWN: dict[str, list[dict[str, str]]] = {}


def keys_of_kind(kind):
    if kind not in KNOWN:
        KNOWN[kind] = keys_of(kind)
    return KNOWN[kind]


def parts(limit):
    """(number, unit) of a limit such as "100 kPa"."""
    number, _, unit = limit.partition(" ")
    return number, unit


def written(key, number, unit):
    value = f'"{number} {unit}"' if unit else f"{number}"
    if key["type"].endswith("place"):
        place = f'[{value}, "0 m"]'
        return f'[{place}, ["0 m", "0 m"]]' if key["type"].startswith("list") else place
    if not key["type"].startswith("list"):
        return value
    limit = f"{number} {unit}".strip()
    return LISTS.get((key["key"], limit), LISTS.get(key["key"], "[{}]")).format(value)


def step_outside(limit, integer, direction):
    number, unit = parts(limit)
    if integer:
        return str(int(number) + direction), unit
    value = float(number)
    return repr(value + direction * 1e-9 * (abs(value) or 1.0)), unit


def limits_of(key):
    """(value at the limit, other keys beside it, value outside, words of the refusal) for each limit of a key."""
    integer = "integer" in key["type"]
    for name, direction, words in (("at_least", -1, "must be at least"), ("at_most", 1, "must be at most")):
        limit = key[name]
        if limit and limit != "> 0":
            outside = step_outside(limit, integer, direction)
            beside = BESIDE.get((key["key"], limit), {})
            yield written(key, *parts(limit)), beside, written(key, *outside), f"{words} {limit}"


def values_inside(key):
    """Values that a key must take, apart from the limits."""
    kind = key["type"]
    if kind == "choice" and key["key"] != "kind":
        return [f'"{choice}"' for choice in key["choices"].split("|")]
    if kind == "boolean":
        return ["true", "false"]
    if kind.startswith("list") and key["key"] != "probe.path[].gradient":
        return []
    return []


def wrong_forms(key):
    """Values of wrong forms. Each must be refused with one line that names the key."""
    kind, listed = key["type"], key["type"].startswith("list")
    forms = ["nan", "inf", "-inf", "{}", "{a = 1}", "1979-05-27", '"1e400"', "[[1]]"]
    if "quantity" in kind:
        unit = UNITS.get(key["dimension"], "")
        other = "GPa" if key["dimension"] == "length" else "mm"
        forms += [
            "true",
            '""',
            '"x"',
            '"1 parsec"',
            f'"1 {other}"',
            f'"nan {unit}"',
            f'"1e400 {unit}"',
            f'"1 {unit} 2"',
        ]
        forms += ['"1,5"', f'"0x10 {unit}"', '"1e-400"', "9" * 400 + ".0"]
        forms += ["1"] if unit else ['"1 Pa"']
    elif "integer" in kind:
        forms += ["1.0", "1e3", '"1"', "true", "99999999999999999999", "0.5"]
    elif kind == "boolean":
        forms += ["1", '"true"', "[true]"]
    elif kind.endswith("place"):
        forms += ["1", "true", '""', '["1 m"]', '["1 m", "2 m", "3 m"]', "[1, 2]", '["1 Pa", "1 m"]']
    elif kind == "list of list of text":
        return ["1", "true", '"x"', "[]", "[[]]", '["x"]', "[[1]]", "{}"]
    else:
        forms += ["1", "true", '"a\\nb"', '"a\\u0000b"', '"\\u001b[31m"', '"' + "x" * 3000 + '"']
    if kind == "choice":
        forms += ['""', '"no_such_choice"', '"' + "x" * 300 + '"', '"Ω"']
    if kind == "path":
        forms += ['""', '"no_such_file.csv"', '"."', '"/dev/null"', '"' + "x" * 300 + '"']
    if not listed:
        return [*forms, *([] if kind == "place" else ["[1]"])]
    one = [] if key["key"] in OR_ONE else ["1", '"x"']
    return [f"[{form}]" for form in forms if form != "[[1]]"] + one


class Trial:
    """A case with one key changed."""

    def __init__(self, number, kind, key, value, beside=None):
        self.kind, self.key, self.value = kind, key, value
        text, place = lines_of(kind, {**(beside or {}), key["key"]: value})
        self.file = Path(f"case_{number}.toml")
        self.file.write_text(text)
        self.line = place[key["key"]]
        self.name = f"{kind}: {key['key']} = {value[:60]}"

    def do(self, *words, timeout=60):
        try:
            return subprocess.run(
                [PROGRAM, *words], check=False, capture_output=True, text=True, timeout=timeout, errors="replace"
            )
        except subprocess.TimeoutExpired:
            return None

    def check(self):
        return self.do("check", str(self.file))

    def refused(self, *words):
        """Whether `check` says one line that names file, line and key, and `words`; else what it says."""
        done = self.check()
        if done is None:
            return f"{self.name}: `check` hangs"
        said, name = done.stderr, re.sub(r"\[\]", "", self.key["key"])
        plain = re.sub(r"\[\d+\]", "", said)
        good = done.returncode == 2 and said.count("\n") == 1 and f"{self.file}:{self.line}: {name}" in plain
        return None if good and all(word in said for word in words) else f"{self.name}: {done.returncode}, {said!r}"

    def accepted(self):
        """Whether `check` takes the value, or refuses a relation between keys with one line; else what it says."""
        done = self.check()
        if done is None:
            return f"{self.name}: `check` hangs"
        related = (
            done.returncode == 2
            and done.stderr.count("\n") == 1
            and not re.search("must be at (least|most)", done.stderr)
        )
        if re.search(r"\bnan\b|\binf\b", done.stdout):
            return f"{self.name}: `check` shows {re.findall('.*(?:nan|inf).*', done.stdout)}"
        if related:
            print(f"relation: {self.name}: {done.stderr.strip()}")
        return None if done.returncode == 0 or related else f"{self.name}: {done.returncode}, {done.stderr!r}"

    def too_long(self, said):
        """Whether `check` foretells more work than a test can wait for."""
        steps = [float(found) for found in re.findall(r"about ([0-9.e+-]+) particle-steps", said)]
        increments = [int(found) for found in re.findall(r"(\d+) increments are planned", said)]
        packings = [int(a) * int(b) for a, b in re.findall(r"(\d+) packings of (\d+) grains", said)]
        points = [int(found) for found in re.findall(r"(\d+) Gauss points", said)]
        return (
            max(steps, default=0) > 5e8
            or max(increments, default=0) > 500
            or max(packings, default=0) > 1000
            or max(points, default=0) > 2000
        )

    def runs(self):
        """Whether a run ends with an honest status, the same verdict as `check`, and no number that is none."""
        checked = self.check()
        if checked is None:
            return f"{self.name}: `check` hangs"
        if checked.returncode == 0 and (self.too_long(checked.stdout) or self.name in LONG_BY_NATURE):
            print(f"foretold to be long: {self.name}")
            return None
        folder = Path("out_" + self.file.stem)
        shutil.rmtree(folder, ignore_errors=True)
        done = self.do("run", str(self.file), "-o", str(folder), "--threads", "1", timeout=600)
        if done is None:
            return f"{self.name}: `run` hangs"
        try:
            return self.verdict(checked, done, folder)
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def verdict(self, checked, done, folder):
        if done.returncode not in (0, 2, 3) or (done.returncode == 2) != (checked.returncode == 2):
            return f"{self.name}: `check` {checked.returncode}, `run` {done.returncode}: {done.stderr!r}"
        if done.returncode == 0 and re.search(r"\b-?nan\b|\binf\b", done.stdout):
            return f"{self.name}: `run` prints {re.findall('.*(?:nan|inf).*', done.stdout)[:3]}"
        wrong = [name for name in folder.glob("increments/*.h5") if not all_finite(name)] if folder.exists() else []
        if done.returncode != 0:
            print(f"{done.returncode}: {self.name}: {done.stderr.strip()[-150:]}")
        return f"{self.name}: {wrong[0]} holds a number that is none" if wrong else None


# Packings of so many grains take longer to make than all else, which `check` does not foretell.
LONG_BY_NATURE = {"calibrate: calibrate.confirm_grains = 20000"}


def all_finite(file):
    bad = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and not np.all(np.isfinite(item[()])):
            bad.append(name)

    with h5py.File(file, "r") as opened:
        opened.visititems(visit)
    return not bad


def try_all(jobs, at_once=2):
    """Calls all jobs; the test fails with all that they say."""

    def told(job):
        fault = job()
        if fault:
            print(f"FAULT {fault}", flush=True)
        return fault

    with ThreadPoolExecutor(at_once) as pool:
        faults = [fault for fault in pool.map(told, jobs) if fault]
    check(not faults, f"{len(faults)} of {len(jobs)} trials went wrong")
    print(f"{len(jobs)} trials")


def number_has_limits(key):
    """A number without limits could be one that no run can use."""
    numeric = "quantity" in key["type"] or "integer" in key["type"]
    if not numeric or (key["at_least"] and key["at_most"]):
        return None
    return f"{key['key']} has no limits on both sides"
