"""Results as pandas and xarray have them. Both are optional: without them an ImportError says what to install."""

import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import Missing
from .files import Table
from .increments import Increment

if TYPE_CHECKING:
    from .results import Result

KEYS = ("stage", "stage_index", "load_parameter", "volume_loss", "converged")  # of increments, beside the fields
PLACES = {"node": ("node",), "gauss": ("element", "point"), "element": ("element",), "rve": ("rve",)}
COMPONENTS = {2: ("axis", ["x", "y"]), 3: ("component", ["xx", "yy", "xy"])}


def needed(name: str) -> Any:
    """A module that may be missing."""
    try:
        return importlib.import_module(name)
    except ImportError:
        raise ImportError(f"this needs {name}, which is not installed; `pip install {name}` installs it") from None


def frame_of(table: Table) -> Any:
    """A pandas.DataFrame whose `attrs["units"]` has the units of the columns."""
    frame = needed("pandas").DataFrame(dict(table))
    frame.attrs["units"] = dict(table.units)
    return frame


def dataset_of(result: "Result", names: Sequence[str], increments: Sequence[Increment]) -> Any:
    """An xarray.Dataset of fields over increments; not a number where an increment does not have a field. A field has
    its name without its place, and its unit as the attribute `units`."""
    wanted = [_place_in(name, increments) for name in names] or result.fields
    variables: dict[str, Any] = {}
    coordinates: dict[str, Any] = {"increment": [int(i["index"]) for i in increments]}
    for place in wanted:
        values = _stacked(place, increments)
        group, name = place.split("/")
        dimensions = ("increment", *PLACES[group])
        if values.ndim > len(dimensions):
            axis, labels = COMPONENTS.get(values.shape[-1], (f"{name}_component", list(range(values.shape[-1]))))
            dimensions, coordinates[axis] = (*dimensions, axis), labels
        variables[name] = (dimensions, values, {"units": _unit(place, increments)})
    for key in KEYS:
        coordinates[key] = ("increment", np.array([i.attributes.get(key, np.nan) for i in increments]))
    for k, axis in enumerate(("x", "y")):
        coordinates[f"node_{axis}"] = ("node", result.coordinates[:, k], {"units": "m"})
        coordinates[f"gauss_{axis}"] = (("element", "point"), result.gauss_points[..., k], {"units": "m"})
    attributes = {"title": result.title, "kind": result.kind, "folder": str(result.folder)}
    return needed("xarray").Dataset(variables, coordinates, attributes)


def _place_in(name: str, increments: Sequence[Increment]) -> str:
    for increment in increments:
        try:
            return increment.place_of(name)
        except Missing as reason:
            missing = reason
    raise missing


def _unit(place: str, increments: Sequence[Increment]) -> str:
    return next(increment.unit(place) for increment in increments if place in increment.names)


def _stacked(place: str, increments: Sequence[Increment]) -> np.ndarray:
    found = [increment.field(place) if place in increment.names else None for increment in increments]
    shape = next(values.shape for values in found if values is not None)
    return np.stack([np.full(shape, np.nan) if values is None else values for values in found])


def dataset_of_curves(table: Table, members: Mapping[str, np.ndarray]) -> Any:
    """An xarray.Dataset of an ensemble's curves over its increments, and their members (member, increment)."""
    variables: dict[str, Any] = {
        name: ("increment", values, {"units": table.units[name]}) for name, values in table.items()
    }
    variables |= {name: (("member", "increment"), values) for name, values in members.items()}
    return needed("xarray").Dataset(variables).set_coords(["stage", "load_parameter"])
