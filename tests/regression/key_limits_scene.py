"""The meshes of the scenes in which key_limits.py tries keys, and what entries of arrays of tables need."""

# A scene has one of these as [mesh]: the first that has the key in question or, for keys with a default, one like it.
MESHES = {
    "grid": {"x": '["0 m", "1 m"]', "columns": "1", "y": '["0 m", "1 m"]', "rows": "1"},
    "tunnel": {
        "width": '"40 m"',
        "height": '"20 m"',
        "diameter": '"5 m"',
        "cover_ratio": "1",
        "size_opening": '"2.5 m"',
        "size_far": '"8 m"',
    },
    "ring": {"radius": '"1 m"', "outer": '"2 m"', "columns": "2", "rows": "2"},
}
LIKE = {"interfaces": "width", "ratio": "radius", "part": "radius"}
HELD = {"grid": '"base"', "tunnel": '["base", "left", "right"]', "ring": '["x0", "y0"]'}
MOVED = {"grid": '"top"', "tunnel": '"top"', "ring": '"far"'}
NEEDED = {  # what an entry of an array of tables cannot be without
    "soil.class[]": {"size_to": '"1 m"'},
    "region[].soil.class[]": {"size_to": '"1 m"'},
    "stage[].press[]": {"boundary": '"top"'},
    "stage[].release[]": {"boundary": '"base"'},
    "stage[].excavate[]": {"region": '"ground"'},
    "stage[].move[]": {},
    "record[]": {"name": '"record"'},
}
# Lists in whose place one value may stand, and texts or numbers that are such values.
OR_ONE = {
    f"mesh.{name}" for name in ("columns", "rows", "x_ratio", "y_ratio", "layers", "base", "top", "left", "right")
}
OR_ONE |= {"support[].boundary", "region[].name", "stage[].excavate[].region", "record[].region"}


def scene_tables(settings, tiny):
    """The tiny scene whose shape has these keys. Its move is left out where another table of the stage has a key."""
    names = [key.removeprefix("mesh.") for key in settings if key.startswith("mesh.")]
    wanted = LIKE.get(names[0], names[0]) if names else "x"
    shape = next((one for one, keys in MESHES.items() if wanted in keys), "grid")
    tables = {"mesh": {"shape": f'"{shape}"', **MESHES[shape]}}
    tables |= {name: dict(keys) for name, keys in tiny.items()}
    tables["support[]"]["boundary"] = HELD[shape]
    if not any(key.startswith("stage[].") and key.count(".") == 2 and ".move" not in key for key in settings):
        tables["stage[].move[]"] = {"boundary": MOVED[shape], "y": '"1 mm"'}
    return tables
