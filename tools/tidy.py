#!/usr/bin/env python3
"""Runs the pinned clang-tidy on changed files: tools/tidy.py [--all | --since REVISION] [--seconds N] [FILE ...]

Without files and options it checks the files that differ from the last release, which is the latest tag `v*` among the
ancestors of HEAD that this checkout knows. Where there is no such tag (a shallow clone, or before the first release),
tools/tidy_clean_revision.txt names the revision that was clean as a whole; where this revision is unknown too, all
files are checked. A changed header is checked through its own .cpp or its own test; where it has none, through the file
that includes most of the changed headers. After a change of .clang-tidy all files are checked.

A file that was found clean is not checked again until it, a header of ours that it includes, its compile command or the
configuration changes (stamps in build/tidy). --seconds bounds the time: no further file is begun after this time, the
remaining files are counted, and the next call goes on with them. Needs a configured build (--build, default
build/openmp).

Tests are checked without clang's static analyzer and without the check of optionals.

Exit status: 0 nothing was found (some files may remain), 1 something was found, 2 clang-tidy cannot run.
"""

import argparse
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path

from include_graph import included_by

ROOT = Path(__file__).resolve().parent.parent
CLANG_TIDY = ROOT / ".prefix/venv/bin/clang-tidy"
# The file is named to clang-tidy, because version 20.1.0 says nothing about headers where it has found the file itself.
CONFIGURATION = ROOT / ".clang-tidy"
CLEAN_REVISION = ROOT / "tools/tidy_clean_revision.txt"
STAMPS = ROOT / "build/tidy"
SOURCES = (".cpp", ".hpp")
GCC_ONLY = ("-fno-gnu-unique", "-fno-tree-loop-vectorize")
# clang's analyzer follows all paths through the macros of GoogleTest, which takes six times as long as all other checks
# together. The sanitizers see these paths, because they run the tests. A test that reads an optional without a value
# fails, as it should.
TESTS, CHECKS_OF_TESTS = "tests/", "--checks=-clang-analyzer-*,-bugprone-unchecked-optional-access"
# The beginnings of findings. One that lies in a header of the system is no fault of ours, such as a "leak" of a library
# that keeps what it is given.
FINDING = re.compile(r"\n(?=\S+:\d+:\d+: (?:warning|error))")


def git(*words: str) -> str | None:
    """The output of git, or None when git fails."""
    done = subprocess.run(["git", "-C", str(ROOT), *words], check=False, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else None


def base_revision() -> tuple[str | None, str]:
    """The revision to compare with, and how it was chosen."""
    tag = git("describe", "--tags", "--abbrev=0", "--match", "v*")
    if tag:
        return tag, f"the last release, {tag}"
    lines = CLEAN_REVISION.read_text().splitlines() if CLEAN_REVISION.exists() else []
    recorded = next((line.strip() for line in lines if line.strip() and not line.startswith("#")), "")
    if recorded and git("cat-file", "-e", recorded + "^{commit}") is not None:
        return recorded, f"{recorded[:12]}, the last revision known to be clean"
    return None, "neither a release nor a clean revision is known here"


def changed_since(revision: str) -> list[str] | None:
    """Files that differ from a revision, and files that git does not track yet; None when git fails."""
    differ = git("diff", "--name-only", "--diff-filter=d", revision, "--")
    new = git("ls-files", "--others", "--exclude-standard")
    return None if differ is None or new is None else sorted({*differ.splitlines(), *new.splitlines()})


def compile_commands(build: Path) -> dict[str, str]:
    """{file: its compile command} of our own sources."""
    try:
        entries = json.loads((build / "compile_commands.json").read_text())
    except OSError:
        sys.exit(f"tidy: {build} is not configured; cmake --preset openmp does it")
    ours = {}
    for entry in entries:
        path = Path(entry["directory"], entry["file"]).resolve()
        if path.is_relative_to(ROOT) and not path.is_relative_to(build.resolve()):
            ours[path.relative_to(ROOT).as_posix()] = entry["command"]
    return ours


def commands_for_clang(build: Path) -> Path:
    """A folder with the compile commands without the options that g++ alone knows, which clang takes for errors."""
    text = (build / "compile_commands.json").read_text()
    for option in GCC_ONLY:
        text = text.replace(f" {option} ", " ")
    STAMPS.mkdir(parents=True, exist_ok=True)
    target = STAMPS / "compile_commands.json"
    if not target.exists() or target.read_text() != text:
        target.write_text(text)
    return STAMPS


@cache
def includes(path: str) -> frozenset[str]:
    """Our own headers that a file includes directly or through others."""
    found: set[str] = set()
    waiting = [path]
    while waiting:
        new = {name for name in included_by(ROOT / waiting.pop()) if (ROOT / name).is_file()} - found
        found |= new
        waiting += new
    return frozenset(found)


def own_files(header: str, commands: Iterable[str]) -> list[str]:
    """The .cpp and the test of a header's own name, as far as they are compiled and include the header."""
    path = Path(header)
    named = (path.with_suffix(".cpp"), Path("tests/unit") / path.parent / f"{path.stem}_test.cpp")
    return [p.as_posix() for p in named if p.as_posix() in commands and header in includes(p.as_posix())]


def files_for(changed: Iterable[str], commands: dict[str, str]) -> list[str]:
    """The compiled files through which all changed sources are seen, the changed ones first."""
    chosen = [path for path in changed if path in commands]
    headers = {path for path in changed if path.endswith(".hpp") and (ROOT / path).is_file()}
    for header in sorted(headers):
        chosen += own_files(header, commands)[:1]
    headers -= set().union(*(includes(path) for path in chosen))
    while headers:
        best = min(
            commands, key=lambda path: (-len(headers & includes(path)), path.startswith("tests/"), len(includes(path)))
        )
        seen = headers & includes(best)
        if not seen:  # no compiled file includes the header, for example one for CUDA only
            print(f"tidy: {', '.join(sorted(headers))}: these files are not part of this build and were not checked")
            break
        chosen.append(best)
        headers -= seen
    return list(dict.fromkeys(chosen))


def openmp_header(command: str) -> list[str]:
    """Arguments that let clang find <omp.h> where the compiler is g++, without seeing g++'s other built-in headers.

    clang gets a copy, in which an attribute lacks the arguments that only g++ knows.
    """
    compiler = next(word for word in shlex.split(command) if "ccache" not in word)
    asked = subprocess.run([compiler, "-print-file-name=include/omp.h"], check=False, capture_output=True, text=True)
    original = Path(asked.stdout.strip())
    if asked.returncode != 0 or not original.is_absolute() or not original.exists():
        return []
    folder = STAMPS / "include"
    folder.mkdir(parents=True, exist_ok=True)
    text = re.sub(r"__malloc__\s*\([^()]*\)", "__malloc__", original.read_text())
    if not (folder / "omp.h").exists() or (folder / "omp.h").read_text() != text:
        (folder / "omp.h").write_text(text)
    return [f"--extra-arg=-isystem{folder}"]


def stamp_of(path: str, command: str) -> Path:
    """The stamp of a file: it exists when the present version of `path` has been found clean."""
    digest = hashlib.sha256()
    for name in (".clang-tidy", "tools/requirements-style.txt", path, *sorted(includes(path))):
        digest.update(name.encode() + b"\0" + (ROOT / name).read_bytes())
    return STAMPS / f"{Path(path).stem}-{hashlib.sha256(digest.digest() + command.encode()).hexdigest()[:20]}"


class Run:
    """clang-tidy over files, several at a time, until the time is spent."""

    def __init__(self, commands: dict[str, str], build: Path, seconds: float) -> None:
        self.commands = commands
        self.build = commands_for_clang(build)
        self.deadline = time.monotonic() + seconds
        # The commands are g++'s, which knows warnings that clang does not know.
        self.arguments = ["--extra-arg=-Wno-unknown-warning-option", *openmp_header(next(iter(commands.values())))]
        self.clean, self.left = 0, 0
        self.printed: set[str] = set()

    def check(self, path: str) -> tuple[str, int | None, str]:
        """Path, exit status (None: not begun) and findings."""
        if time.monotonic() > self.deadline:
            return path, None, ""
        extra = [CHECKS_OF_TESTS] if path.startswith(TESTS) else []
        done = subprocess.run(
            [CLANG_TIDY, "-p", self.build, "--quiet", f"--config-file={CONFIGURATION}", *self.arguments, *extra, path],
            check=False,
            capture_output=True,
            text=True,
            cwd=ROOT,
        )
        # Where the standard output is empty, the error stands among the counts on the standard error.
        if not done.stdout:
            return path, done.returncode, done.stderr if done.returncode else ""
        ours = [finding for finding in FINDING.split(done.stdout.strip()) if not finding.startswith("/usr/")]
        return path, done.returncode if ours else 0, "\n".join(ours)

    def report(self, path: str, status: int | None, findings: str) -> None:
        if status is None:
            self.left += 1
        elif status == 0:
            self.clean += 1
            stamp_of(path, self.commands[path]).touch()
        for finding in FINDING.split(findings.strip()):
            # A finding in a header appears once for each file that includes the header.
            if finding and finding not in self.printed:
                self.printed.add(finding)
                print(finding.replace(f"{ROOT}/", ""), flush=True)


def chosen_files(arguments: argparse.Namespace, commands: dict[str, str]) -> tuple[list[str], str]:
    """The files to check, and the reason in words."""
    if arguments.files:
        named = [path.resolve().relative_to(ROOT).as_posix() for path in arguments.files]
        return files_for(named, commands), "the files named"
    revision, reason = (arguments.since, arguments.since) if arguments.since else base_revision()
    changed = changed_since(revision) if revision and not arguments.all else None
    if changed is None:
        return sorted(commands), "all files" if arguments.all else f"all files, since {reason}"
    if ".clang-tidy" in changed:
        return sorted(commands), f"all files, since .clang-tidy has changed since {reason}"
    return files_for([path for path in changed if path.endswith(SOURCES)], commands), f"files changed since {reason}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("files", type=Path, nargs="*", metavar="FILE")
    parser.add_argument("--all", action="store_true", help="all files of the build")
    parser.add_argument("--since", metavar="REVISION", help="files that differ from this revision")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no further file after this time")
    parser.add_argument("--build", type=Path, default=ROOT / "build/openmp", help="configured build (build/openmp)")
    parser.add_argument("--list", action="store_true", help="only name the files")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count() or 1)
    arguments = parser.parse_args()
    if not CLANG_TIDY.exists():
        print("tidy: clang-tidy is missing; tools/setup --test installs it", file=sys.stderr)
        return 2
    commands = compile_commands(arguments.build)
    chosen, reason = chosen_files(arguments, commands)
    STAMPS.mkdir(parents=True, exist_ok=True)
    waiting = [path for path in chosen if not stamp_of(path, commands[path]).exists()]
    print(f"tidy: {len(chosen)} files ({reason}), {len(chosen) - len(waiting)} of them known to be clean", flush=True)
    if arguments.list:
        print("\n".join(waiting))
        return 0
    run = Run(commands, arguments.build, arguments.seconds)
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for result in pool.map(run.check, waiting):
            run.report(*result)
    if run.left:
        print(f"tidy: {run.left} files were not checked for lack of time; tools/tidy.py goes on with them")
    found = len(waiting) - run.clean - run.left
    print(f"tidy: something was found in {found} files" if found else f"tidy: {run.clean} files checked, nothing found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
