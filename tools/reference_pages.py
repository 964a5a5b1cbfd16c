#!/usr/bin/env python3
"""Writes the parts of docs/reference that are made from the program and from the tools: tools/reference_pages.py
[--program PROGRAM] [--check].

A part stands between the lines `<!-- made by tools/reference_pages.py: NAME -->` and `<!-- end -->` of its page.
--check writes nothing and ends with exit status 1 where a page does not agree with the program or the tools.
"""

import argparse
import re
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
import python_reference
from voussoir.figures import paper

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/openmp/host/voussoir"
COLUMNS = 100


def answer(program: Path, *words: str) -> str:
    """What the program prints, without the largest number of threads, which differs between builds."""
    text = subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout
    return re.sub(r"INT:INT in \[1 - \d+\]", "INT", text)


def wrapped(line: str) -> list[str]:
    """The line of a help text in several lines, the further ones below the explanation."""
    explained = re.match(r" +\S.*? {2,}| {20,}", line)
    indent = len(explained.group()) if explained else len(line) - len(line.lstrip()) + 2
    return textwrap.wrap(line, COLUMNS, subsequent_indent=" " * indent, break_long_words=False) or [""]


def block(text: str) -> str:
    lines = [short for line in text.strip().splitlines() for short in wrapped(line.rstrip())]
    return "\n".join(["```text", *lines, "```"])


def commands_of(program: Path) -> list[str]:
    """The names of the commands, in the order of `--help`."""
    listed = answer(program, "--help").split("Subcommands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines() if re.match(r"  \S", line)]


def command_line(program: Path) -> str:
    """The help of all commands without their common end, which is in the part `exit_status`."""
    parts = [f"### voussoir\n\n{block(answer(program, '--help').split('exit status:')[0])}"]
    for name in commands_of(program):
        text = answer(program, name, "--help").split("exit status:")[0]
        parts.append(f"### voussoir {name}\n\n{block(text)}")
    return "\n\n".join(parts)


def exit_status(program: Path) -> str:
    """The table at the end of `--help`."""
    table = answer(program, "--help").split("exit status:\n")[1]
    rows = re.findall(r"^  (\d+)\s+(.*)$", table, re.MULTILINE)
    return "\n".join(["| exit status | what happened |", "|---|---|", *(f"| {code} | {text} |" for code, text in rows)])


def paper_figures(_program: Path) -> str:
    lines = ["| in the paper | what it shows | our file | drawn from |", "|---|---|---|---|"]
    for figure in paper.FIGURES:
        number = figure.number if figure.number.startswith("Table") else f"figure {figure.number}"
        if figure.missing:
            lines.append(f"| {number} | {figure.what} | none: {figure.missing} | |")
        else:
            files = ", ".join(f"`{name}`" for name in figure.files)
            lines.append(f"| {number} | {figure.what} | {files} | {figure.of} |")
    return "\n".join(lines)


PARTS: dict[str, tuple[str, Callable[[Path], str]]] = {
    "command_line": ("docs/reference/command_line.md", command_line),
    "exit_status": ("docs/reference/exit_status.md", exit_status),
    "python": ("docs/reference/python.md", lambda _program: python_reference.page()),
    "paper_figures": ("docs/reference/figures.md", paper_figures),
}


def with_part(page: str, name: str, part: str) -> str:
    """The page with the part in its place."""
    begin = f"<!-- made by tools/reference_pages.py: {name} -->\n"
    before, found, rest = page.partition(begin)
    _, end, after = rest.partition("<!-- end -->")
    if not found or not end:
        raise ValueError(f"there is no place for the part {name}")
    return f"{before}{begin}\n{part}\n\n{end}{after}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--program", type=Path, default=PROGRAM, help="default: build/openmp/host/voussoir")
    parser.add_argument("--check", action="store_true", help="only say which pages do not agree")
    arguments = parser.parse_args()
    status = 0
    for name, (file, make) in PARTS.items():
        old = (ROOT / file).read_text()
        new = with_part(old, name, make(arguments.program))
        if new == old:
            continue
        if arguments.check:
            print(f"{file}: {name} is out of date; tools/reference_pages.py writes it anew", file=sys.stderr)
            status = 1
        else:
            (ROOT / file).write_text(new)
            print(f"{file}: written")
    return status


if __name__ == "__main__":
    sys.exit(main())
