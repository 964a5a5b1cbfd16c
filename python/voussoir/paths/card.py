"""The data card: what a dataset is, how it was made, how it is read, and how far it can be trusted."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .dataset import Dataset
from .engine import FIRST_FAILURE, Engine
from .errors import Scatter, error_of_preset, scatter_between_packings
from .fields import BY_NAME, MOST_MEAN_OVERLAP
from .parts import write
from .rows import PARTS
from .tensors import pressure_of

Array = np.ndarray


def finish(made: Path, file: Path, packings: Sequence[Any], engine: Engine, reference_rows: int) -> None:
    """Measures the errors of a dataset that lies under the name `made`, writes its card into it, gives it the name
    `file` and writes the card beside it."""
    with Dataset(made) as data:
        scatter = scatter_between_packings(data)
        count = 0 if engine.preset == "reference" else reference_rows
        text = text_of(data, file.name, scatter, error_of_preset(data, packings, count))
    with h5py.File(made, "r+") as out:
        out.attrs["card"] = text
    made.rename(file)
    write(file.with_suffix(".md"), text.encode())


def text_of(data: Dataset, name: str, scatter: Scatter | None, preset: tuple[int, float] | None) -> str:
    """The card in Markdown. `preset`: the rows that were run again, and their error (errors.error_of_preset)."""
    trust = _trust(data, scatter, preset)
    return "\n\n".join([_head(data, name), _how(data), _fields(data), _reading(data, name), _split(data), trust]) + "\n"


def _head(data: Dataset, name: str) -> str:
    note = str(data.attrs["note"])
    lines = [
        f"# {name}",
        "",
        (
            "Stresses that packings of grains answered to paths of plane strain, computed by Voussoir "
            f"{data.attrs['version']} (voussoir.paths.generate), {data.attrs['made']}."
        ),
        f"{len(data)} rows (a path on a packing) of {data.points - 1} increments.",
    ]
    return "\n".join([*lines, note] if note else lines)


def _how(data: Dataset) -> str:
    plan = data.plan["engine"]
    changes = ", ".join(f"{key} = {value}" for key, value in plan["settings"].items()) or "no other settings"
    more = {name: plan[name] for name in ("accuracy", "precision", "backend") if plan[name] not in (None, "lanes")}
    words = "".join(f", {name} {value}" for name, value in more.items())
    lines = [
        "## How it was made",
        "",
        f"Engine: preset {plan['preset']}{words}, tangent {plan['tangent'] or 'none'}; {changes}.",
        _beginning(data),
        (
            "Strains are given, and the grains come to rest after each increment, so that there is no rate; inertia "
            "acts only as far as the preset lets it."
        ),
        "",
        "| family of paths | paths | rows | stresses that are held |",
        "|---|---|---|---|",
        *_families(data),
        "",
        "| packing | seed | grains | void ratio | pressure | part |",
        "|---|---|---|---|---|---|",
        *_packings(data),
        "",
        *_soils(data),
    ]
    return "\n".join(lines)


def _beginning(data: Dataset) -> str:
    first = pressure_of(data["stress"][:, 0])
    low, high = np.nanmin(first) / 1e3, np.nanmax(first) / 1e3
    if "consolidation" not in data:
        return f"Point 0 is a packing as it was made, at rest under p = {low:.4g} to {high:.4g} kPa."
    increments = data["consolidation"].shape[1]
    return (
        f"Before point 0 each row was brought to a pressure of its own, {low:.4g} to {high:.4g} kPa, in {increments} "
        "increments (`consolidation`)."
    )


def _families(data: Dataset) -> list[str]:
    family, held = data["path/family"].asstr()[:], data["path/held"][:]
    rows = data.family
    lines = []
    for name in dict.fromkeys(family):
        some = held[family == name].any(axis=0)
        which = ", ".join(np.array(["xx", "yy", "xy"])[some]) or "-"
        lines.append(f"| {name} | {(family == name).sum()} | {(rows == name).sum()} | {which} |")
    return lines


def _packings(data: Dataset) -> list[str]:
    columns = [data[f"packing/{name}"][:] for name in ("seed", "grains", "void_ratio", "pressure", "split")]
    return [
        f"| {k} | {seed} | {grains} | {void:.4f} | {pressure / 1e3:.4g} kPa | {PARTS[part]} |"
        for k, (seed, grains, void, pressure, part) in enumerate(zip(*columns))
    ]


def _soils(data: Dataset) -> list[str]:
    soils = dict.fromkeys(data["packing/soil"].asstr()[:])
    several = len(soils) > 1
    lines = [f"Soil{f' {k}' if several else ''}: {_words(soil)}." for k, soil in enumerate(soils)]
    return [line for line in lines if line]


def _words(soil: str) -> str:
    return ", ".join(f"{key} = {value}" for key, value in json.loads(soil).items()) or "the default of the program"


def _fields(data: Dataset) -> str:
    lines = [
        "## What is in it",
        "",
        (
            "Tension and extension are positive. Point 0 is the beginning; `gradient[:, k]` leads from point k to "
            "point k + 1 and counts from the state at point k. Values of type f4 were rounded from double precision."
        ),
        "",
        "| name | shape | type | unit | what |",
        "|---|---|---|---|---|",
    ]
    for name in data.fields:
        array = data[name]
        components = f" ({', '.join(BY_NAME[name].components)})" if name in BY_NAME and BY_NAME[name].components else ""
        about = array.attrs["meaning"] + components
        lines.append(f"| `{name}` | {array.shape} | {array.dtype} | {array.attrs['unit']} | {about} |")
    names = data.attrs["status_names"]
    words = ", ".join(f"{k} {name}" for k, name in enumerate(names))
    lines += [
        "",
        "The tables `row/`, `path/` and `packing/` say which path and packing each row has.",
        (
            f"Statuses: {words}; -1: behind a failed point. From {names[FIRST_FAILURE]} on a point has failed: "
            "its values and those of later points are NaN (integers: -1). `open`: no contacts, stress zero, which is "
            "an answer. `step_limit`: the grains were not quite at rest."
        ),
    ]
    return "\n".join(lines)


def _reading(data: Dataset, name: str) -> str:
    return f"""## How to read it

```python
from voussoir import paths

data = paths.open_dataset("{name}")
train = data.rows(packing="train", path="train", complete=True)
strain, stress = data["strain"][:][train], data["stress"][:][train]   # ({len(data)} rows at most, {data.points}, 3)
```

h5py, or any other reader of HDF5, reads the file as well."""


def _split(data: Dataset) -> str:
    parts = {table: data[f"{table}/split"][:] for table in ("packing", "path")}
    lines = [
        "## Split",
        "",
        (
            "Rows of one packing are alike, whatever their paths: a model must be judged on packings from which it "
            "learned nothing. Paths are split as well, so that both can be asked for."
        ),
        "",
        "| part | packings | paths | rows with both |",
        "|---|---|---|---|",
    ]
    for k, part in enumerate(PARTS):
        both = len(data.rows(packing=part, path=part))
        lines.append(f"| {part} | {(parts['packing'] == k).sum()} | {(parts['path'] == k).sum()} | {both} |")
    if not (parts["packing"] == 2).any():
        lines += ["", "There is no packing for a test: a model of this set cannot be judged on unknown grains."]
    return "\n".join(lines)


def _trust(data: Dataset, scatter: Scatter | None, preset: tuple[int, float] | None) -> str:
    status = data["status"][:]
    pressure = pressure_of(data["stress"][:])
    low, middle, high = np.nanpercentile(pressure, [1, 50, 99]) / 1e3
    beyond = (data["mean_overlap"][:] > MOST_MEAN_OVERLAP).mean()
    failed = (status >= FIRST_FAILURE).any(axis=1).sum()
    lines = [
        "## Errors to expect",
        "",
        (
            f"- {failed} of {len(data)} rows failed before their end; {100 * (status == 2).mean():.2g} % of all points "
            f"are open, {100 * (status == 1).mean():.2g} % ended at the limit of steps."
        ),
        (
            f"- Mean stress p: 1 % of the points are below {low:.3g} kPa, half below {middle:.3g} kPa, 99 % below "
            f"{high:.4g} kPa."
        ),
        (
            f"- {100 * beyond:.2g} % of the points have a mean overlap above {100 * MOST_MEAN_OVERLAP:.0f} %: their "
            "grains are pressed beyond the range of the contact law, and their stresses are not those of grains."
        ),
        _scatter_line(scatter),
        _preset_line(preset),
    ]
    if "control_error" in data:
        lines.append(_control_line(data))
    return "\n".join(lines)


def _scatter_line(scatter: Scatter | None) -> str:
    if scatter is None:
        return (
            "- Scatter between packings: not in this set, because no path ran on two packings. It is usually many "
            'times the error of the engine; packing_of="all" shows it.'
        )
    return (
        f"- Scatter between packings of the same recipe that take the same path ({scatter.paths} paths): the stress "
        f"has a standard deviation of {100 * scatter.value:.2g} % of the mean p. A model that does not know the "
        "packing cannot be better than this."
    )


def _preset_line(preset: tuple[int, float] | None) -> str:
    if preset is None:
        return (
            "- Error of the preset: not measured in this set (reference_rows). The how-to guide on choosing the "
            "accuracy has it for other paths."
        )
    return (
        f'- Error of the preset: {preset[0]} rows that took the same strains with the preset "reference" differ by '
        f"{100 * preset[1]:.2g} % of the mean p (rms)."
    )


def _control_line(data: Dataset) -> str:
    share = data["control_error"][:] / np.maximum(pressure_of(data["stress"][:]), 1.0)
    held = data["path/held"][:].any(axis=1)[data["row/path"][:]]
    share = share[held] if held.any() else share[:, :1]
    return (
        f"- Held stresses miss their values by {100 * np.nanpercentile(share, 50):.2g} % of p in half of the points "
        f"and by {100 * np.nanpercentile(share, 99):.2g} % in 1 % of them (`control_error`). "
        "The numbers of time steps were chosen by the first evaluation of an increment, and the committed one may "
        "differ by about 0.1 % of the stress from one that is made alone."
    )
