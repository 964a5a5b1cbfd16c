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

# Settings of cases/trapdoor/case.toml, a scene: (those of one call, parts of the complaint, reason).
SCENES = [
    (["mesh.shape=gird"], ["mesh.shape", "grid", "is gird"], ""),
    (["mesh.rows=0"], ["mesh.rows", "at least 1"], ""),
    (["mesh.rows=[14, 14]"], ["mesh.rows", "each of the 1 intervals of y"], RELATION),
    (['mesh.x=["0 m", "3 m", "2 m", "5 m"]'], ["mesh.x", "must ascend"], RELATION),
    (['mesh.base=["floor", "door"]'], ["mesh.base", "each of the 3 intervals of x"], RELATION),
    (["mesh.x_ratio=0"], ["mesh.x_ratio", "at least 0.1"], ""),
    (["mesh.radius=1 m"], ["mesh.radius", "of the shape ring", "is a grid"], RELATION),
    (["mesh.file=no_such_file.msh"], ["mesh.file", "does not exist"], FILE),
    (["mesh.clumns=[10]"], ["mesh.clumns", 'did you mean "columns"?'], ""),
    (["region[0].name=grund"], ["region[0].name", "no region 'grund'", "did you mean 'ground'?"], RELATION),
    (["region[0].name=['ground', 'ground']"], ["region[0].name", 'names "ground" twice'], ""),
    (["region[0].unit_weight=20 kPa"], ["region[0].unit_weight", "is a pressure", "unit weight"], ""),
    (["region[0].unit_weight=-1 kN/m3"], ["region[0].unit_weight", "at least 0 N/m3"], ""),
    (["region[0].packing.grains=1"], ["region[0].packing.grains", "at least 30"], ""),
    (["region[0].elastic.poisson=0.5"], ["region[0].elastic.poisson", "at most 0.49"], ""),
    (["region=[]"], ["stage[0].gravity", "no region has a unit_weight"], RELATION),
    (["support[1].boundary=dor"], ["support[1].boundary", "no boundary 'dor'", "did you mean 'door'?"], RELATION),
    (["support[1].fix=z"], ["support[1].fix", "x, y, xy", "is z"], ""),
    (["support=[]"], ["support", "nothing holds the ground along x"], RELATION),
    (["stage=[]"], ["stage", "at least one [[stage]]"], RELATION),
    (["stage[1].name=gravity"], ["stage[1].name", "'gravity' is the name of an earlier one"], RELATION),
    (["stage[1].steps=0"], ["stage[1].steps", "at least 1"], ""),
    (["stage[1].tilt=100 deg"], ["stage[1].tilt", "at most 80 deg"], UNIT),
    (["stage[1].geometry=fixed_mesh"], ["stage[1].geometry", "only weights and tractions at rest"], RELATION),
    (["stage[1].dig=[]"], ["stage[1].dig", "unknown key"], ""),
    (["stage[1].move[0].y=-5"], ["stage[1].move[0].y", "has no unit", "length"], ""),
    (["stage[1].move[0].y=3 m"], ["stage[1].steps", "an element's edge a step", "more steps"], RELATION),
    (["stage[1].move[0].area=-100 %"], ["stage[1].move[0].area", "at least -0.9"], UNIT),
    (["stage[1].move[0].area=-10 %"], ["stage[1].move[0].y", "given beside area"], RELATION),
    (["stage[1].move=[{boundary='door'}]"], ["stage[1].move[0]", "needs x, y, rotation or area"], RELATION),
    (["stage[1].press=[{boundary='door', pressure='1 kPa'}]"], ["press[0].boundary", "door is held along y"], RELATION),
    (["stage[1].press=[{boundary='top'}]"], ["stage[1].press[0]", "pressure, traction and at_rest"], RELATION),
    (["stage[1].release=[{boundary='top'}]"], ["stage[1].release[0].boundary", "nothing holds top"], RELATION),
    (["stage[1].release=[{point='top_left'}]"], ["release[0].point", "nothing holds top_left as a point"], RELATION),
    (["stage[1].release=[{boundary='floor', share='120 %'}]"], ["release[0].share", "at most 1"], UNIT),
    (["stage[1].excavate=[{region='ground'}]"], ["excavate[0].region", "nothing of the ground is left"], RELATION),
    (["stage[1].excavate=[{region='bank'}]"], ["excavate[0].region", "no region 'bank'; it has ground"], RELATION),
    (["record[0].region=ground"], ["record[0]", "one of point, line and region"], RELATION),
    (["record[0].line=[['0 m', '2 m']]"], ["record[0].line", "2 entries"], ""),
    (["record[0].points=1"], ["record[0].points", "at least 2"], ""),
    (["record=[{name='far', point=['9 m', '1 m']}]"], ["record[0].point", "lies outside the ground"], RELATION),
    (["record=[{name='far', point='crown'}]"], ["record[0].point", "no point 'crown'", "base_left"], RELATION),
    (["stage[5].name=a"], ["stage", "has no entry [5]"], TOML),
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
