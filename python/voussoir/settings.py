"""Settings as text of a case file: a dictionary {"soil.modulus": "3 GPa"} becomes one line for each entry, so that the
line in a message is the number of the entry."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from voussoir.errors import InputError

Settings = Mapping[str, Any]

name = "settings"  # of the text in messages


def toml(value: Any) -> str:
    """A value as TOML. Texts carry units ("5 mm"); a list may hold dictionaries, such as those of soil.class."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    return json.dumps(str(value), ensure_ascii=False)  # a path


def flat(settings: Settings | None, prefix: str = "") -> dict[str, Any]:
    """Tables within the dictionary as keys with dots: {"soil": {"modulus": 1}} is {"soil.modulus": 1}.

    Raises:
        TypeError: it is no dictionary
    """
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"settings are a dictionary, such as {{'soil.friction': '30 deg'}}, not {settings!r}")
    out: dict[str, Any] = {}
    for key, value in (settings or {}).items():
        if isinstance(value, Mapping):
            out |= flat(value, f"{prefix}{key}.")
        else:
            out[f"{prefix}{key}"] = value
    return out


def as_texts(settings: Settings | Sequence[str]) -> list[str]:
    """Settings as --set of the program takes them: {"packing.grains": 300} is ["packing.grains=300"]."""
    if isinstance(settings, str):
        return [settings]
    if isinstance(settings, Mapping):
        return [f"{key}={value if isinstance(value, str) else toml(value)}" for key, value in flat(settings).items()]
    return list(settings)


def text_of(kind: str, settings: Settings | None, tables: Sequence[str], defaults: Settings | None = None) -> str:
    """The text of a case of this kind.

    Args:
        kind: of the case
        settings: those of the caller
        tables: tables or keys that the settings may have, such as "soil" or "newton.tangent"
        defaults: further settings, which those of the caller override

    Raises:
        InputError: a key is of another table, or its name is no key
    """
    given = flat(settings)
    for number, key in enumerate(given, 1):
        if not all(part.replace("_", "").isalnum() and part.isascii() for part in key.split(".")):
            raise _input_error(number, key, "is no name of a key")
        if not any(key == table or key.startswith(f"{table}.") for table in tables):
            raise _input_error(number, key, f"is not used here, where settings are of {', '.join(tables)}")
    lines = [f"{key} = {toml(value)}" for key, value in given.items()]
    lines += [f"{key} = {toml(value)}" for key, value in (defaults or {}).items() if key not in given]
    return "\n".join([*lines, f'kind = "{kind}"']) + "\n"


@contextmanager
def told_by_argument(settings: Settings | None, arguments: Mapping[str, str]) -> Iterator[None]:
    """Names the argument in place of the line in a message about a key that the caller did not write.

    Args:
        settings: those of the caller
        arguments: the argument of each key, such as {"packing.grains": "grains"}
    """
    try:
        yield
    except InputError as fault:
        argument = arguments.get(fault.key.partition("[")[0])
        if argument is None or fault.key in flat(settings):
            raise
        message = f"{argument} ({fault.key}): {fault.sentence}"
        raise InputError(message, argument, fault.key, fault.sentence) from None


def whole_number(value: Any, what: str) -> int:
    """An int of Python or NumPy, or a number without a fraction.

    Raises:
        TypeError: it is another number or no number; the message begins with `what`
    """
    number = np.asarray(value)
    if number.ndim == 0 and number.dtype.kind in "iuf" and number == np.floor(number) and np.isfinite(number):
        return int(number)
    raise TypeError(f"{what} must be an integer, is {value!r}")


def _input_error(number: int, key: str, sentence: str) -> InputError:
    place = f"{name}:{number}"
    return InputError(f"{place}: {key}: {sentence}", place, key, sentence)
