"""Files from elsewhere: each wrong one gives one line that says what is wrong, where, and what is expected, and exit
code 2, from `check` and from `run` alike. One input a line of a table."""

import json
import os
import re
import subprocess
from pathlib import Path

import h5py
from program import PROGRAM, ROOT, check, fresh

OUT = fresh("results")
SOURCE = ROOT / "tests/data/packings"
GRAINS = (SOURCE / "cps_d_150_particles.csv").read_text()
META = (SOURCE / "cps_d_150_meta.json").read_text()
HEADER, FIRST, *REST = GRAINS.splitlines()
Path("pack.toml").write_text('kind = "pack"\n[packing]\nfile = "a_particles.csv"\npressure = "1 kPa"\n')
tried: list[str] = []
faults: list[str] = []


def fault_of(done, fragments):
    """What is wrong with the refusal; empty where it is one line that holds the fragments."""
    said = done.stderr.decode(errors="replace")
    missing = [fragment for fragment in fragments if fragment not in said]
    for wrong, sentence in (
        (done.returncode != 2, f"exit {done.returncode} instead of 2"),
        (said.count("\n") != 1 or len(said) > 1200, "not one line"),
        (re.search(r"[\x00-\x09\x0b-\x1f]", said), "control characters"),
        (missing, f"{missing} missing"),
        (OUT.exists(), "something was written"),
    ):
        if wrong:
            return f"{sentence}: {said[:1200]!r}"
    return ""


def complain(words, *fragments):
    """The program refuses with one line that holds the fragments."""
    done = subprocess.run([PROGRAM, *map(str, words)], check=False, capture_output=True, timeout=60)
    note(f"{[str(word)[:80] for word in words]}", fault_of(done, fragments), done.stderr.decode(errors="replace"))


def note(what, fault, said=""):
    tried.append(what)
    if fault:
        faults.append(f"{what}: {fault}")
        print(f"FAULT {faults[-1]}", flush=True)
    else:
        print(f"ok: {said.strip()}")


def refuse(particles, meta, *fragments):
    write("a_particles.csv", particles)
    write("a_meta.json", meta)
    complain(["check", "pack.toml"], "packing.file", *fragments)
    if len(tried) % 10 == 1:  # the two commands share their way in
        complain(["run", "pack.toml", "-o", OUT], "packing.file", *fragments)


def accept(particles, meta, what):
    write("a_particles.csv", particles)
    write("a_meta.json", meta)
    done = subprocess.run([PROGRAM, "check", "pack.toml"], check=False, capture_output=True, text=True, timeout=60)
    good = done.returncode == 0 and "holds 150 grains" in done.stdout
    note(what, "" if good else f"{done.returncode}, {done.stderr}")


def write(name, content):
    path = Path(name)
    path.unlink(missing_ok=True)
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())


def rows(*changed):
    return "\n".join([HEADER, *changed]) + "\n"


def meta_with(**changed):
    return json.dumps({**json.loads(META), **changed})


def scaled(factor):
    lines = [line.split(",") for line in (FIRST, *REST)]
    return rows(
        *(
            ",".join([a, repr(float(x) * factor), repr(float(y) * factor), repr(float(r) * factor), t])
            for a, x, y, r, t in lines
        )
    )


def cell(factor, other=None):
    size = json.loads(META)["hSize"]
    size[0][0] *= factor
    size[1][1] *= factor if other is None else other
    return meta_with(hSize=size)


ALL = [FIRST, *REST]
FIELDS = FIRST.split(",")

# Grains as another program may write them.
accept(GRAINS, META, "as they are")
accept(b"\xef\xbb\xbf" + GRAINS.encode(), META, "with a byte-order mark")
accept(GRAINS, b"\xef\xbb\xbf" + META.encode(), "a meta file with a byte-order mark")
accept(GRAINS.replace("\n", "\r\n"), META.replace("\n", "\r\n"), "lines that end with CR LF")
accept(GRAINS.rstrip("\n"), META, "no line end at the end")
accept(GRAINS + "\n\n", META, "empty lines at the end")
accept(GRAINS.replace(",", ", ").replace(HEADER.replace(",", ", "), HEADER), META, "blanks behind commas")
PARTICLES: list[tuple[str | bytes | None, ...]] = [
    (GRAINS.encode("utf-16"), "UTF-16", "UTF-8"),
    (GRAINS.encode("utf-16-le"), "UTF-16"),
    (GRAINS.encode("utf-16-be"), "UTF-16"),
    (GRAINS.encode("utf-32"), "UTF-32"),
    (GRAINS.replace(",", ";"), "line 1", "semicolons"),
    (GRAINS.replace(",", "\t"), "line 1", "tabs"),
    (GRAINS.replace(",", " "), "line 1", "blanks"),
    (GRAINS.replace(".", ",").replace(HEADER, HEADER.replace(",", ";")), "line 1"),
    (rows(*[line.replace(",", ";") for line in ALL]), "line 2", "five numbers", "commas"),
    (rows(*[line.replace(".", ",") for line in ALL]), "line 2", "five numbers", "has"),
    (GRAINS.replace("\n", "\r"), "CR"),
    (scaled(1000), "pack.toml:3: packing.file", "1000 times those of [soil]", "millimetres"),
    (scaled(100), "100 times those of [soil]", "centimetres"),
    (scaled(0.001), "1/1000 times those of [soil]"),
    (b"", "is empty"),
    ("\n", "line 1"),
    (HEADER, "has no grains"),
    (HEADER + "\n", "has no grains"),
    ("\n".join(ALL) + "\n", "line 1", HEADER),
    (rows(*[line.rsplit(",", 1)[0] for line in ALL]), "line 2", "has 4 fields"),
    (rows(*[line + ",1" for line in ALL]), "line 2", "has 6 fields"),
    (rows(*[line + "," for line in ALL]), "line 2", "has 6 fields"),
    (rows(",".join(["", *FIELDS[1:]]), *REST), "line 2", "id must be a finite number"),
    (rows(FIRST, *REST, FIRST), "line 152", "id 0", "line 2"),
    (rows(",".join(["1", *FIELDS[1:]]), *REST), "line 3", "id 1"),
    (rows(",".join(["-1", *FIELDS[1:]]), *REST), "line 2", "id must be"),
    (rows(",".join(["0.5", *FIELDS[1:]]), *REST), "line 2", "id must be"),
    (rows(",".join(["0", "nan", *FIELDS[2:]]), *REST), "line 2", "x_m"),
    (rows(",".join(["0", FIELDS[1], "inf", *FIELDS[3:]]), *REST), "line 2", "y_m"),
    (rows(",".join([*FIELDS[:3], "0", "0"]), *REST), "line 2", "radius must be positive"),
    (rows(",".join([*FIELDS[:3], "-0.001", "0"]), *REST), "line 2", "radius must be positive"),
    (rows(",".join([*FIELDS[:3], "1e999", "0"]), *REST), "line 2", "r_m"),
    (rows(",".join([*FIELDS[:3], "1e-300", "0"]), *REST), "the largest grain is"),
    (rows(",".join(["0", "1e300", *FIELDS[2:]]), *REST), "grain 0", "cells away"),
    (rows(",".join(["150", *REST[0].split(",")[1:]]), *REST), "overlap by 100 %"),
    (rows(*REST), "N says 150 grains, but the particles file has 149"),
    (GRAINS[: len(GRAINS) - 60], "line 151"),
    (GRAINS.replace("id,", "#id,"), "line 1"),
    (rows("# a comment", *ALL), "line 2", "five numbers"),
    (GRAINS.replace(HEADER, ",".join(f'"{name}"' for name in HEADER.split(","))), "line 1", "quotes"),
    (rows(",".join(f'"{field}"' for field in FIELDS), *REST), "line 2", "id must be"),
    (rows("x" * 5_000_000), "line 2", "five numbers"),
    (rows("0" + "," * 1_000_000), "line 2", "fields"),
    (b"\x7fELF" + bytes(range(256)) * 20, "zero byte"),
    (b"\xff\xd8\xff\xe0JFIF" + bytes(range(1, 256)), "UTF-8"),
    (GRAINS.replace("0.0", "0.\u0660"), "line"),
    (rows(FIRST), "N says 150"),
    (None, "does not exist"),
]
for particles, *fragments in PARTICLES:
    refuse(particles, META, *fragments)
Path("a_particles.csv").unlink(missing_ok=True)
Path("a_particles.csv").mkdir()
complain(["check", "pack.toml"], "packing.file", "is a folder")
Path("a_particles.csv").rmdir()
os.mkfifo("a_particles.csv")
complain(["check", "pack.toml"], "packing.file", "pipe")

SIZE = json.loads(META)["hSize"]
METAS: list[tuple[str | bytes | None, ...]] = [
    ("{}", "lacks the key hSize"),
    ("[]", "must be an object"),
    ("1", "must be an object"),
    (b"", "is empty"),
    (META[:100], "is no JSON"),
    (META + "x", "is no JSON"),
    (META + "{}", "is no JSON"),
    (META.encode("utf-16"), "UTF-16"),
    (META.replace('"Lz": 0.1', '"Lz": NaN'), "is no JSON"),
    (META.replace('"Lz": 0.1', '"Lz": 1e999'), "is no JSON"),
    (META.replace('"Lz": 0.1', '"Lz": 0.1, "Lz": 0.2'), "Lz", "twice"),
    (META.replace('"Lz": 0.1', '"Lz": "0.1"'), "Lz must be a finite number"),
    (META.replace('"Lz": 0.1', '"Lz": [0.1]'), "Lz must be a finite number"),
    (META.replace('"Lz": 0.1', '"Lz": null'), "Lz must be a finite number"),
    (META.replace('"Lz": 0.1', '"Lz": true'), "Lz must be a finite number"),
    (META.replace('"Lz": 0.1', '"Lz": -0.1'), "Lz", "positive"),
    (META.replace('"Lz": 0.1', '"Lz": 0'), "Lz", "positive"),
    (META.replace('"Lz": 0.1', '"Lz": 1e30'), "thickness"),
    (META.replace("0.1,", "'0.1',"), "is no JSON"),
    (meta_with(hSize=None), "hSize must be a matrix"),
    (meta_with(hSize="0.04 0 0"), "hSize must be a matrix"),
    (meta_with(hSize=[0.04, 0.04]), "hSize must be a matrix"),
    (meta_with(hSize=[[0.04, 0]]), "hSize must be a matrix"),
    (meta_with(hSize=[*SIZE, SIZE[0]]), "hSize must be a matrix"),
    (meta_with(hSize=[[SIZE[0][0]], SIZE[1], SIZE[2]]), "hSize must be a matrix"),
    (meta_with(hSize=[["0.04", 0, 0], SIZE[1], SIZE[2]]), "hSize[0][0] must be a finite number"),
    (meta_with(hSize=[SIZE[0], [0, None, 0], SIZE[2]]), "hSize[1][1] must be a finite number"),
    (meta_with(hSize=[[0, 0, 0], SIZE[1], SIZE[2]]), "hSize", "positive area"),
    (meta_with(hSize=[[-0.04, 0, 0], SIZE[1], SIZE[2]]), "hSize", "positive area"),
    (cell(1000), "fill", "unit of length"),
    (cell(0.001), "fill", "unit of length"),
    (cell(0.2, 5), "too narrow"),
    (meta_with(N=151), "N says 151"),
    (meta_with(N="150"), "N must be a finite number"),
    (meta_with(E="3e9"), "E must be a finite number"),
    ("[" * 100_000, "is no JSON"),
    (None, "does not exist"),
]
for meta, *fragments in METAS:
    refuse(GRAINS, meta, *fragments)

# More grains than a packing can have.
write("a_meta.json", json.dumps({"hSize": [[0.3, 0, 0], [0, 0.22, 0], [0, 0, 0.1]]}))
write("a_particles.csv", rows(*(f"{k},{(k % 300) * 1e-3},{(k // 300) * 1e-3},5e-4,0" for k in range(66_000))))
complain(["check", "pack.toml"], "packing.file", "66000 grains", "65535")

# Grains of which none can be a neighbour's image: the cell holds less than four of them.
write("a_meta.json", json.dumps({"hSize": [[0.007, 0, 0], [0, 0.007, 0], [0, 0, 0.1]]}))
write("a_particles.csv", rows("0,0,0,0.0019,0", "1,0.0035,0.0035,0.0019,0"))
complain(["check", "pack.toml"], "packing.file", "too narrow")

# Recipes whose cell or whose number of grains is no use.
Path("wide.toml").write_text(
    'kind = "pack"\n[soil]\nsizes = ["2 mm", "4.75 mm", "19 mm", "40 mm"]\npassing = [0, 0.16, 0.6, 1]\n'
)
complain(["check", "wide.toml", "--set", "packing.grains=60"], "packing.grains", "needs at least")
complain(["run", "wide.toml", "-o", OUT, "--set", "packing.grains=60"], "packing.grains", "needs at least")
complain(["check", "wide.toml", "--set", "packing.folder=pack.toml"], "packing.folder", "must name a folder")
complain(["check", "wide.toml", "--set", "packing.folder="], "packing.folder", "must name a folder")

# Case files.
CASE = 'kind = "pack"\n[packing]\ngrains = 40\n'
CASES: list[tuple[str | bytes | None, ...]] = [
    (CASE.encode("utf-16"), "UTF-16", "UTF-8"),
    (CASE.encode("utf-16-le"), "UTF-16"),
    (CASE.encode("utf-16-be"), "UTF-16"),
    (b"", "is empty"),
    (b"\x00" * 100, "bad.toml"),
    (CASE + "\x00", "bad.toml:4", "zero byte"),
    (CASE.encode() + b"title = '\xff'\n", "bad.toml:4", "UTF-8"),
    (CASE + "grains = 50\n", "bad.toml:4", "grains"),
    (CASE + "[packing]\nseed = 1\n", "bad.toml:4", "packing"),
    ("packing = 1\n" + 'kind = "pack"\n', "bad.toml:1: packing: must be a table"),
    ('kind = "pack"\n[[packing]]\ngrains = 40\n', "packing: must be a table, is an array"),
    ('kind = "pack"\n[soil.class]\nsize_to = "1 m"\n', "soil.class: must be an array, is a table"),
    ('kind = "pack"\n[soil]\nclass = [1]\n', "soil.class[0]: must be a table, is an integer"),
    ('kind = "pack"\nkind.x = 1\n', "bad.toml:2"),
    ("kind = ['pack']\n", "bad.toml:1: kind: must be text, is an array"),
    ("kind = pack\n", "bad.toml:1"),
    ("{" * 1000, "bad.toml:1"),
    ("x = " + "[" * 100_000, "bad.toml:1"),
    (".".join("a" * 1) + "=1\n" + ".".join("a" for _ in range(100_000)) + " = 1\n", "bad.toml:2", "parts"),
    ("x = {" + ".".join("a" for _ in range(100_000)) + " = 1}\n", "bad.toml:1", "parts"),
    ("#" * 5_000_000, "larger than"),
    ('extends = "bad.toml"\n', "bad.toml:1: extends", "circle"),
    ('extends = "no.toml"\n', "bad.toml:1: extends", "does not exist"),
    ('extends = "."\n', "bad.toml:1: extends", "folder"),
    ('extends = ""\n', "bad.toml:1: extends"),
    ("extends = [1]\n", "bad.toml:1: extends", "name of a case file"),
    ('kind = "pack"\ntitle = ""\n', "bad.toml:2: title"),
    ('kind = "pack"\ntitle = ".."\n', "bad.toml:2: title"),
    (f'kind = "pack"\ntitle = "{"x" * 300}"\n', "bad.toml:2: title", "200"),
    ('kind = "pack"\ntitle = "a\\nb"\n', "bad.toml:2: title", "control"),
    (json.dumps({"kind": "pack"}), "bad.toml:1"),
]
for content, *fragments in CASES:
    write("bad.toml", content)
    complain(["check", "bad.toml"], *fragments)
Path("bad.toml").unlink()
for content in (
    b"\xef\xbb\xbf" + CASE.encode(),
    CASE.replace("\n", "\r\n").encode(),
    CASE.replace(" = ", "\t=\t").encode(),
):
    write("good.toml", content)
    done = subprocess.run([PROGRAM, "check", "good.toml"], check=False, capture_output=True, text=True, timeout=60)
    note(f"{content!r}", done.stderr)
Path("fifo.toml").unlink(missing_ok=True)
os.mkfifo("fifo.toml")
for name, fragment in (
    (".", "folder"),
    ("/dev/null", "device"),
    ("fifo.toml", "pipe"),
    ("x" * 5000, "cannot be"),
    ("", "cannot be"),
):
    complain(["check", name], fragment)
    complain(["sweep", name, "-o", OUT], fragment)
if os.geteuid() != 0:  # root may open every file
    Path("closed.toml").write_text(CASE)
    Path("closed.toml").chmod(0)
    complain(["check", "closed.toml"], "may not be opened")

# --set, of every wrong form.
Path("good.toml").write_text(CASE)
for setting, fragment in (
    ("", "table.key=value"),
    ("=", "table.key=value"),
    ("packing", "table.key=value"),
    ("=5", "table.key=value"),
    (".grains=5", "table.key=value"),
    ("packing.=5", "table.key=value"),
    ("packing..grains=50", "table.key=value"),
    ("packing.grains", "table.key=value"),
    ("packing.grains=", "packing.grains: must be an integer"),
    ("packing=50", "packing: must be a table"),
    ("packing.grains.x=50", "packing.grains: must be an integer, is a table"),
    ("packing.grains[0]=50", "packing.grains: has no entry"),
    ("packing.seeds[0]=1", "packing.seeds: has no entry"),
    ("soil.class[0].size_to=1 m", "soil.class: has no entry"),
    ("packing.grain=50", 'did you mean "grains"'),
    ("packing.grains=50\n[soil]", "packing.grains"),
    ("packing.grains=50\nseed=1", "more than one value"),
    ("a." * 2000 + "b=1", "table.key=value"),
    ("packing.grains=[50]", "must be an integer, is an array"),
    ("packing.grains={a=1}", "must be an integer, is a table"),
    ("title=a/b", "title"),
    ("kind=probe\x1b", "kind"),
    ("soil.sizes=[]]", 'soil.sizes: "[]]" is no TOML'),
    ("packing.grains=" + "9" * 400, "packing.grains"),
    ("x" * 100_000 + "=1", "unknown key"),
):
    complain(["check", "good.toml", "--set", setting], fragment)
complain(["check", "good.toml", "--set", b"packing.folder=\xff".decode(errors="surrogateescape")], "UTF-8")

# A kind of which there are no keys.
complain(["keys", "tunel"], "is no kind of case, no table and no key; did you mean tunnel?")

# Sweeps.
for content, *fragments in (
    ("", "is empty"),
    ("base = 1\n", "base: must be text"),
    ('[[run]]\nname = "a"\n', "base: is missing"),
    ('base = "good.toml"\n', "run"),
    ('base = "."\n[[run]]\nname = "a"\n', "sweep.toml:1: base", "folder"),
    ('base = "no.toml"\n[[run]]\nname = "a"\n', "sweep.toml:1: base", "does not exist"),
    ('base = "good.toml"\nrun = 1\n', "run: must be an array"),
    ('base = "good.toml"\n[run]\nname = "a"\n', "run: must be an array, is a table"),
    ('base = "good.toml"\n[[run]]\nname = 1\n', "run[0].name: must be text"),
    ('base = "good.toml"\n[[run]]\nname = "a"\nset = "x"\n', "run[0].set: must be an array"),
    ('base = "good.toml"\n[[run]]\nname = "a"\nset = [1]\n', "run[0].set[0]: must be text"),
    ('base = "good.toml"\n[[run]]\nname = "a"\nset = ["x"]\n', "table.key=value"),
    ('base = "good.toml"\n[[run]]\nname = ".."\n', "run[0].name"),
    ('base = "good.toml"\n[[run]]\nname = "a"\nsets = []\n', "run[0].sets: unknown key"),
):
    write("sweep.toml", content)
    complain(["sweep", "sweep.toml", "-o", OUT], *fragments)

# `info` and stored packings: what is no result, or is one no longer.
write("text.h5", "no HDF5")
write("empty.h5", b"")
with h5py.File("other.h5", "w") as other:
    other["x"] = [1.0]
with h5py.File("named.h5", "w") as named:
    named.attrs["format"] = "voussoir packing"
for name in ("text.h5", "empty.h5", "other.h5", "named.h5", ".", "/dev/null", "none.h5", "fifo.toml", "x" * 300):
    complain(["info", name])
    Path("probe.toml").write_text(f'kind = "probe"\n[packing]\nfile = "{name}"\n')
    complain(["check", "probe.toml"], "packing.file")
print(f"{len(tried)} inputs")
check(not faults, f"{len(faults)} inputs went wrong")
