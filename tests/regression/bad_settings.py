"""Wrong values of cases and sweep files, with what the program says of them. bad_input_test.py gives them to the
program, and keys_test.py to the schemas for editors. Each entry ends with the reason why a schema cannot refuse it,
which is empty where it must."""

RELATION = "a relation to other keys"
UNIT = "a limit of a quantity in a text"
FILE = "a file"
TOML = "no TOML"
NAME = "a name that the sweep itself uses"
OVERRIDE = "a key within an override"
SIZE = "the size of the computation"

# Lines below cases/tunnel_elastic/case.toml: (text, parts of the complaint, reason).
LINES = [
    ("[soil]\nfrictoin = '30 deg'", ["frictoin"], ""),
    ("[soil]\nsize_minimum = '-2 mm'", ["size_minimum", "at least 0.001 mm"], ""),
    ("[soil]\nmodulus = '3 mm'", ["modulus", "length"], ""),
    ("[soil]\nmodulus = 3", ["modulus"], ""),
    ("[soil]\nsizes = ['1 mm', '2 mm']\npasing = [0, 1]", ["soil.pasing", 'did you mean "passing"?'], ""),
    ("this is no TOML", [], TOML),
]

# Settings of the same case: (those of one call, parts of the complaint, reason).
SETTINGS = [
    (["ground.diameter=-5 m"], ["ground.diameter", "at least 1 cm"], ""),
    (["ground.diameter=5 kPa"], ["ground.diameter", "pressure"], ""),
    (["ground.depth=5 m"], ["ground.depth", "unknown"], ""),
    (["ground.cover_ratio=6"], ["ground.cover_ratio", "invert"], RELATION),
    (["ground.surcharge=2 kPa"], ["ground.surcharge", "packing.pressure"], RELATION),
    (["elastic.poisson=0.5"], ["elastic.poisson"], ""),
    (["volume_loss.increments=0"], ["volume_loss.increments"], ""),
    (["volume_loss.total=100 %"], ["volume_loss.total"], UNIT),
    (["packing.grains=two"], ["packing.grains"], ""),
    (["output.rves=[3, 3]"], ["output.rves", "twice"], ""),
    (["output.rves=[1000000]"], ["output.rves", "1000000"], RELATION),
    (['output.fields=["stress", "strian"]'], ["output.fields", "strian"], ""),
    (["title=../elsewhere"], ["title"], ""),
    (["title="], ["title", "must not be empty"], ""),
    (["kind=tunel"], ["kind", "tunnel", "is tunel"], ""),
    (["kind="], ["kind", "tunnel", "is empty"], ""),
    (["ground.diameter=5 deg"], ["ground.diameter", "is an angle"], ""),
    (["packing.file=no_such_file.h5"], ["packing.file", "does not exist"], FILE),
    (["ground={width='40 m',width='50 m'}"], ["--set ground", "is no TOML"], TOML),
    (["volume_loss.increments=9223372036854775808"], ["volume_loss.increments", "is no TOML"], ""),
    (["ground.height=" + "[" * 3000 + "]" * 3000], ["--set", "open brackets"], TOML),
    (
        ["ground.width=10 km", "ground.height=10 km", "ground.mesh_size_opening=1 m", "ground.mesh_size_far=1 m"],
        ["ground.mesh_size_far", "Gauss points", "this machine allows"],
        SIZE,
    ),
]

# Sweep files behind their line `base`: (text, parts of the complaint, reason).
SWEEPS = [
    ("[[run]]\nname = 'a'\nset = ['ground.diametre=4 m']\n", ["sweep.toml:4", "run a", "ground.diametre"], OVERRIDE),
    ("[[run]]\nname = 'summary.csv'\n", ["sweep.toml:3", "name", "itself writes"], NAME),
    ("[[run]]\nname = 'run.lock'\n", ["sweep.toml:3", "name", "itself writes"], NAME),
    (f"[[run]]\nname = '{'x' * 256}'\n", ["sweep.toml:3", "name", "at most 200"], ""),
    ("[[run]]\nname = 'a'\n[[run]]\nname = 'a'\n", ["name"], RELATION),
    ("[[run]]\nname = 'a,b'\n", ["name", "letters"], ""),
    ("[[run]]\nset = []\n", ["run[0].name", "is missing"], ""),
    ("[[run]]\nnmae = 'a'\n", ["sweep.toml:3: run[0].nmae", 'unknown key; did you mean "name"?'], ""),
    ("[grid]\n'ground.cover_ratio' = [2]\nmembers = 0\n", ["grid.members", "at least 1"], ""),
    ("[grid]\n'ground.cover_ratio' = []\n", ["has no values"], ""),
]
