"""Pages of docs/tutorial as programs: their blocks of commands, of Python and of files, in order, with the outputs that
they promise. A comment of HTML before a block says how the test treats it (README.md, "The tutorial")."""

import contextlib
import io
import math
import os
import re
import subprocess
import sys
import traceback
from dataclasses import dataclass, field
from pathlib import Path

from program import ROOT, check

FENCE = re.compile(r"^```(\w*)\s*$")
MARK = re.compile(r"<!-- test: (\w+)\s*(.*?)\s*-->\s*\Z", re.DOTALL)
MARKS = {"", "checkout", "skip", "long", "instead", "add", "status", "file", "output"}
NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")


@dataclass
class Block:
    """A fenced block of a page, and the mark that stands before it."""

    language: str
    text: str
    place: str
    mark: str = ""
    words: str = ""


@dataclass
class Reader:
    """What a reader of the pages has in hand: a folder, a shell's environment, a Python session."""

    folder: Path
    whole: bool
    environment: dict = field(default_factory=lambda: dict(os.environ))
    names: dict = field(default_factory=dict)
    said: str = ""
    smaller: bool = False  # whether a command of the page was made smaller for the test
    smaller_now: bool = False  # whether what was said last comes from such a command

    def __post_init__(self):
        """The reader's `python` is the one that runs the test."""
        self.environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{self.environment['PATH']}"


def blocks_of(page):
    """The blocks of a page, each with its mark."""
    found, lines, before = [], page.read_text().splitlines(), []
    k = 0
    while k < len(lines):
        fence = FENCE.match(lines[k])
        if not fence:
            before.append(lines[k])
            k += 1
            continue
        end = next(n for n in range(k + 1, len(lines)) if lines[n] == "```")
        mark = MARK.search("\n".join(before))
        text = "\n".join(lines[k + 1 : end]) + "\n"
        found.append(Block(fence[1], text, f"{page.name}:{k + 1}", *(mark.groups() if mark else ("", ""))))
        check(found[-1].mark in MARKS, f"{found[-1].place}: a mark that no test knows: {found[-1].mark}")
        before, k = [], end + 1
    return found


def with_settings(text, settings):
    """The commands of a block, each call of the program with further settings."""
    joined = text.replace("\\\n", " ")
    more = " ".join(settings.split())
    return "".join(f"{line} {more}\n" if line.startswith("voussoir ") else f"{line}\n" for line in joined.splitlines())


def run_bash(block, reader, text):
    """Runs commands as one would type them; the first that fails ends them. Exports and the folder stay for the blocks
    that follow."""
    allowed = [int(code) for code in block.words.split()] if block.mark == "status" else [0]
    state = Path("shell_state").absolute()
    done = subprocess.run(
        ["bash", "-c", f"set -e -o pipefail\n{text}\nenv -0 >'{state}'\npwd >'{state}_folder'\n"],
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        cwd=reader.folder,
        env=reader.environment,
    )
    check(done.returncode in allowed, f"{block.place}: exit status {done.returncode}\n{text}\n{done.stdout}")
    if done.returncode == 0:
        entries = state.read_text().split("\0")
        reader.environment = dict(entry.split("=", 1) for entry in entries if "=" in entry)
        reader.folder = Path(Path(f"{state}_folder").read_text().strip())
    reader.said = done.stdout


def run_python(block, reader):
    """Runs a block in the page's Python session, whose working folder is the reader's."""
    said, here = io.StringIO(), Path.cwd()
    os.chdir(reader.folder)
    try:
        with contextlib.redirect_stdout(said):
            exec(compile(block.text, block.place, "exec"), reader.names)
    except Exception:
        check(False, f"{block.place}: {traceback.format_exc()}")
    finally:
        os.chdir(here)
    reader.said, reader.smaller_now = said.getvalue(), reader.smaller


def form(line):
    """The words of a line, with every number as #."""
    return " ".join(NUMBER.sub("#", line).split())


def is_like(said, promised):
    """Whether two lines have the same words; a promised line that ends in "..." is the beginning of what is said."""
    if promised.endswith("..."):
        return form(said).startswith(form(promised[:-3]))
    return form(said) == form(promised)


def agree(promised, said, tolerance):
    """Whether two numbers differ by no more than a share of the larger one, or by one in the last digit promised."""
    first, second = float(promised), float(said)
    digits = len(promised.split("e")[0].partition(".")[2])
    last = 0 if "e" in promised else 1.01 * 10.0**-digits
    return math.isclose(first, second, rel_tol=tolerance, abs_tol=last)


def check_output(block, reader):
    """Every line that a page promises is a line of what was said, in order. Where a command was made smaller for the
    test, only the words of the lines count."""
    tolerance = math.inf if reader.smaller_now else float(block.words or 0)
    left = reader.said.splitlines()
    for line in filter(str.strip, block.text.splitlines()):
        while left and not is_like(left[0], line):
            left.pop(0)
        check(left, f"{block.place}: no line like '{line}' in:\n{reader.said}")
        said = left.pop(0)
        if math.isinf(tolerance):
            continue
        for promised, number in zip(NUMBER.findall(line), NUMBER.findall(said), strict=False):
            check(agree(promised, number, tolerance), f"{block.place}: '{said}' where the page has '{line}'")


def check_there(block):
    """The scripts that a block calls are there and may be run."""
    for line in block.text.splitlines():
        script = ROOT / line.split()[0]
        check(os.access(script, os.X_OK), f"{block.place}: {script} cannot be run")


def do_bash(block, reader):
    if block.mark == "skip":
        return
    if block.mark in ("checkout", "long") and not reader.whole:
        if block.mark == "long":
            check_there(block)
        return
    text = block.text
    reader.smaller_now = not reader.whole and block.mark in ("instead", "add")
    if reader.smaller_now:
        reader.smaller = True
        text = block.words if block.mark == "instead" else with_settings(text, block.words)
    if block.mark == "checkout":
        text = text.replace("ADDRESS", f"'{ROOT}'")
    run_bash(block, reader, text)
    if block.mark == "checkout":  # so that tools/setup finds its work done
        (reader.folder / ".prefix").symlink_to((ROOT / ".prefix").resolve())


def do_file(block, reader):
    """Writes the file that a page shows."""
    file = reader.folder / block.words
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(block.text)


def follow(page, reader):
    """Does what a page says, as its reader."""
    reader.names, reader.smaller = {}, False
    blocks = blocks_of(page)
    check(any(block.language == "bash" for block in blocks), f"{page} has no commands")
    for block in blocks:
        if block.mark == "output":
            check_output(block, reader)
        elif block.mark == "file":
            do_file(block, reader)
        elif block.language == "bash":
            do_bash(block, reader)
        elif block.language == "python":
            run_python(block, reader)
    print(f"{page.name}: {len(blocks)} blocks")
