"""Reads a Dockerfile and prints its steps for a shell, one step a line and its parts apart by tabs:

    stage NAME IMAGE | copy FROM TO | copy_from STAGE FROM TO | workdir FOLDER | user NAME | run COMMAND
    entrypoint COMMAND

An instruction or an option that is not known ends the program, so that no step is left out unnoticed.
"""

import json
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path


def instructions(text: str) -> Iterator[tuple[str, str]]:
    """Name and rest of each instruction; a line that ends with a backslash goes on in the next one."""
    lines = [line for line in text.splitlines() if not line.startswith("#")]
    for line in re.sub(r"\\\n\s*", "", "\n".join(lines)).splitlines():
        if line.strip():
            name, rest = line.split(maxsplit=1)
            yield name.upper(), rest


def copied(rest: str) -> list[str]:
    words = shlex.split(rest)
    options = [word for word in words if word.startswith("--")]
    places = [word for word in words if not word.startswith("--")]
    if len(places) != 2 or len(options) > 1:
        raise ValueError(f"COPY {rest}")
    if not options:
        return ["copy", *places]
    name, stage = options[0].split("=", 1)
    if name != "--from":
        raise ValueError(f"COPY {rest}")
    return ["copy_from", stage, *places]


def step(name: str, rest: str, stage: int) -> list[str]:
    """One instruction as the words of a step; empty for one that does nothing here."""
    if name == "FROM":
        words = rest.split()
        return ["stage", words[2] if len(words) == 3 else f"stage{stage}", words[0]]
    if name == "COPY":
        return copied(rest)
    if name in ("WORKDIR", "USER", "RUN"):
        return [name.lower(), rest]
    if name == "ENTRYPOINT":
        return ["entrypoint", shlex.join(json.loads(rest))]
    if name == "CMD":
        return []
    raise ValueError(f"{name} {rest}")


def main() -> int:
    stage = 0
    for name, rest in instructions(Path(sys.argv[1]).read_text(encoding="utf-8")):
        try:
            words = step(name, rest, stage)
        except ValueError as fault:
            print(f"{sys.argv[1]}: this instruction is not known here: {fault}", file=sys.stderr)
            return 1
        stage += name == "FROM"
        if words:
            print("\t".join(words))
    return 0


if __name__ == "__main__":
    sys.exit(main())
