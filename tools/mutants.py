#!/usr/bin/env python3
"""Can the unit tests fail? Puts small faults into the law, Newton and the pool, one at a time, and runs the unit tests.

    tools/mutants.py [--seed 1] [--count 20] [--again] [--list] [--files GLOB ...] [--tests REGEX]

A mutant is one token changed: an operator, a sign, a constant or a bound. The seed chooses them; each group of GROUPS
gets its share. Mutants are built in a copy of the checkout, build/mutants/tree, with -O1 and assertions. Tests are
built and run in the order of their nearness to the mutated file, and the first that fails (or takes too long) kills the
mutant, so that most mutants cost the build of a library and of one or two tests.

Verdicts are kept in build/mutants/results.jsonl, so that a call after an interruption goes on with the other mutants.
--again repeats the mutants that survived; use it after you have added a test. Writes build/mutants/table.md. Exit
status: 0 all were killed (or are the same machine code as the original), 1 some survived, 2 the tests fail without any
mutant.
"""

import argparse
import dataclasses
import hashlib
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build/mutants"
TREE, BUILD, RESULTS = WORK / "tree", WORK / "build", WORK / "results.jsonl"
GROUPS = {
    "law": ["kernels/contact/*law*.hpp"],
    "Newton": ["fem/newton*.cpp", "fem/relaxation*.cpp", "fem/increment*.cpp"],
    "pool": ["host/material/rve_pool*.cpp"],
}

# First the text that is not mutated (comments, literals), then numbers, words and operators; the order matters.
TOKEN = re.compile(
    r"""(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#[^\n]*|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    |(?P<number>(?<![\w.])(?:\d+\.\d*(?:e[+-]?\d+)?|\d+(?:e[+-]?\d+)?)(?![\w.]))
    |(?P<word>[A-Za-z_]\w*)
    |(?P<operator><=>|<<=?|>>=?|<=|>=|==|!=|&&|\|\||\+=|-=|\*=|/=|\+\+|--|->|::|[-+*/<>!=?:;,.(){}\[\]&|%^~])""",
    re.VERBOSE | re.MULTILINE | re.DOTALL,
)
BINARY = {
    "<": ["<=", ">"],
    "<=": ["<", ">="],
    ">": [">=", "<"],
    ">=": [">", "<="],
    "==": ["!="],
    "!=": ["=="],
    "+": ["-"],
    "-": ["+"],
    "*": ["/"],
    "/": ["*"],
    "+=": ["-="],
    "-=": ["+="],
    "*=": ["/="],
    "/=": ["*="],
    "&&": ["||"],
    "||": ["&&"],
}
WORDS = {"true": "false", "false": "true", "min": "max", "max": "min", "floor": "ceil", "ceil": "floor"}


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str
    line: int
    start: int  # place in the file of the text that is replaced
    before: str
    after: str

    def key(self, tests: str) -> str:
        """The key under which the verdict is kept; `tests` names the tests on which the verdict rests."""
        text = (ROOT / self.path).read_bytes()
        return f"{self.path}:{self.start}:{self.after}:{hashlib.sha256(text).hexdigest()[:12]}:{tests}"

    def apply(self, text: str) -> str:
        assert text[self.start :].startswith(self.before)
        return text[: self.start] + self.after + text[self.start + len(self.before) :]

    def lines(self, text: str) -> tuple[str, str]:
        """The mutated line before and after, without its indentation."""
        return text.splitlines()[self.line - 1].strip(), self.apply(text).splitlines()[self.line - 1].strip()


@dataclasses.dataclass
class Verdict:
    verdict: str  # killed, survived, does not compile, same machine code
    by: str
    seconds: float


# --- Where a fault can be put -----------------------------------------------------------------------------------------


def arguments_after(text: str, opening: int) -> tuple[list[str], int] | None:
    """The arguments of a call whose "(" stands at `opening`, and the place of its ")"."""
    depth, start, found = 0, opening + 1, []
    for k in range(opening, min(len(text), opening + 1000)):
        if text[k] in "([{":
            depth += 1
        elif text[k] in ")]}":
            depth -= 1
        if depth == 0 or (depth == 1 and text[k] == ","):
            found.append(text[start:k].strip())
            start = k + 1
        if depth == 0:
            return found, k
    return None


def without_bound(name: str, arguments: list[str]) -> list[str]:
    """Variants of a call that bounds or chooses, with one bound or the choice changed."""
    if name == "clamp" and len(arguments) == 3:
        value, low, high = arguments
        return [f"max({value}, {low})", f"min({value}, {high})"]
    if name in ("clamp_to", "larger", "smaller") and len(arguments) == 2:
        return [f"({arguments[0]})"]
    if name == "condition" and len(arguments) == 3:
        mask, yes, no = arguments
        return [f"condition({mask}, {no}, {yes})"]
    return []


def other_numbers(text: str) -> list[str]:
    value = float(text)
    if re.search(r"[.e]", text):
        return ["1.0"] if value == 0 else ["0.0", f"{2 * value!r}"]
    return ["1"] if value == 0 else [str(int(value) - 1), str(int(value) + 1)]


def mutants_of(path: str) -> Iterator[Mutant]:
    """All faults that can be put into a file.

    The layout of clang-format tells operators from template brackets, pointers and references: only an operator of two
    operands has a space on either side.
    """
    text = (ROOT / path).read_text(encoding="utf-8")
    previous = ""
    for match in TOKEN.finditer(text):
        token, start, kind = match[0], match.start(), match.lastgroup
        if kind == "skip":
            continue
        line = text.count("\n", 0, start) + 1
        spaced = text[start - 1].isspace() and text[match.end()].isspace()
        choices: list[tuple[str, str]] = []
        if kind == "operator" and spaced:
            choices = [(token, other) for other in BINARY.get(token, [])]
        elif token in ("-", "!") and previous in ("(", ",", "=", "return", "{", "?", ":", "&&", "||"):
            choices = [(token, "")]
        elif kind == "number" and previous != "<":
            choices = [(token, other) for other in other_numbers(token)]
        elif kind == "word" and token in WORDS and (token in ("true", "false") or previous == "::"):
            choices = [(token, WORDS[token])]
        elif kind == "word" and text[match.end() : match.end() + 1] == "(" and previous not in ("void", ">"):
            call = arguments_after(text, match.end())
            if call:
                choices = [(text[start : call[1] + 1], other) for other in without_bound(token, call[0])]
        previous = token
        for before, after in choices:
            yield Mutant(path, line, start, before, after)


def chosen_mutants(groups: dict[str, list[str]], seed: int, count: int) -> list[Mutant]:
    """The sample: a place is chosen first and then one of its faults, so that places count alike."""
    chooser = random.Random(seed)
    chosen: list[Mutant] = []
    for number, globs in enumerate(groups.values()):
        paths = sorted({p.relative_to(ROOT).as_posix() for glob in globs for p in ROOT.glob(glob)})
        places: dict[tuple[str, int], list[Mutant]] = {}
        for path in paths:
            for mutant in mutants_of(path):
                places.setdefault((path, mutant.start), []).append(mutant)
        share = count // len(groups) + (number < count % len(groups))
        sample = chooser.sample(sorted(places), min(share, len(places)))
        chosen += [chooser.choice(places[place]) for place in sorted(sample)]
    return chosen


# --- Building and testing ---------------------------------------------------------------------------------------------


def run(words: list[str | Path], log: str, timeout: float | None = None) -> bool:
    """True where a command succeeds in time; its output goes to build/mutants/LOG."""
    with (WORK / log).open("w") as file:
        try:
            done = subprocess.run(words, check=False, stdout=file, stderr=subprocess.STDOUT, timeout=timeout)
        except subprocess.TimeoutExpired:
            return False
    return done.returncode == 0


def copy_tree() -> None:
    """Brings build/mutants/tree up to date. Unchanged files keep their time, so that little is built again."""
    listed = subprocess.run(
        ["git", "-C", ROOT, "ls-files", "-co", "--exclude-standard"], check=True, capture_output=True, text=True
    ).stdout.splitlines()
    wanted = {name for name in listed if (ROOT / name).is_file()}
    for path in TREE.rglob("*"):
        if path.is_file() and path.relative_to(TREE).as_posix() not in wanted and ".prefix" not in path.parts:
            path.unlink()
    for name in wanted:
        write_if_new(TREE / name, (ROOT / name).read_bytes())
    if not (TREE / ".prefix").exists():
        (TREE / ".prefix").symlink_to(ROOT / ".prefix")


def write_if_new(path: Path, content: bytes) -> None:
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def build(targets: list[str]) -> bool:
    words: list[str | Path] = ["cmake", "--build", BUILD, "--parallel", str(os.cpu_count() or 1), "--target", *targets]
    return run(words, "build.log")


def machine_code(path: str) -> bytes | None:
    """The machine code that a .cpp of the libraries was compiled to."""
    folder, rest = path.split("/", 1)
    found = [p for p in (BUILD / folder).rglob(f"{Path(path).name}.o") if p.as_posix().endswith(f".dir/{rest}.o")]
    return found[0].read_bytes() if len(found) == 1 else None


def passes(test: str, limit: float) -> bool:
    """True where a unit test passes in time [s]."""
    words: list[str | Path] = ["ctest", "--test-dir", BUILD, "-R", f"^{test}$", "--timeout", f"{limit:.0f}"]
    return run([*words, "--no-tests=error"], "test.log", limit + 60)


def unit_tests(pattern: str) -> list[str]:
    """The tests whose names contain a match of the regular expression, and which are programs of the same name."""
    commands: list[list[str | Path]] = [
        ["ctest", "--test-dir", BUILD, "-N", "-L", "^unit$"],
        ["cmake", "--build", BUILD, "--target", "help"],
    ]
    shown, targets = (subprocess.run(words, check=True, capture_output=True, text=True).stdout for words in commands)
    programs = set(re.findall(r"^(\w+): phony", targets, re.MULTILINE))
    return [test for test in re.findall(r"Test +#\d+: (\S+)", shown) if test in programs and re.search(pattern, test)]


def prepare(pattern: str) -> dict[str, float]:
    """Builds and runs the tests without a mutant: their times [s]."""
    TREE.mkdir(parents=True, exist_ok=True)
    copy_tree()
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1", *launcher]
    tests = unit_tests(pattern) if run(["cmake", "-S", TREE, "-B", BUILD, *options], "build.log") else []
    if not tests or not build(tests):
        print((WORK / "build.log").read_text()[-2000:], file=sys.stderr)
        sys.exit(2)
    times = {}
    for test in tests:
        start = time.monotonic()
        if not passes(test, 1200):
            print(f"mutants: {test} fails without any mutant, see build/mutants/test.log", file=sys.stderr)
            sys.exit(2)
        times[test] = time.monotonic() - start
    return times


def nearness(test: str, path: str) -> tuple[bool, bool, bool]:
    """A key for sorting: first the test of the file's own name, then the tests of its folders, then all others."""
    parts = Path(path).with_suffix("").parts
    return parts[-1] not in test, not test.startswith("_".join(parts[:-1])), not test.startswith(parts[0])


def judge(mutant: Mutant, times: dict[str, float], original: bytes | None) -> Verdict:
    """Builds and runs the tests with a mutant; `original` is the machine code of its file without it."""
    start = time.monotonic()

    def verdict(what: str, by: str = "") -> Verdict:
        return Verdict(what, by, time.monotonic() - start)

    path = TREE / mutant.path
    text = (ROOT / mutant.path).read_text(encoding="utf-8")
    path.write_text(mutant.apply(text), encoding="utf-8")
    try:
        tests = sorted(times, key=lambda test: (*nearness(test, mutant.path), times[test]))
        step = os.cpu_count() or 1
        for k in range(0, len(tests), step):
            if not build(tests[k : k + step]):
                return verdict("does not compile")
            for test in tests[k : k + step]:
                if not passes(test, 20 + 5 * times[test]):
                    return verdict("killed", test)
            if original and machine_code(mutant.path) == original:
                return verdict("same machine code")
        return verdict("survived")
    finally:
        path.write_text(text, encoding="utf-8")


def table(judged: list[tuple[Mutant, Verdict]], seed: int) -> str:
    lines = [
        f"Seed {seed}: "
        + ", ".join(
            f"{sum(v.verdict == what for _, v in judged)} {what}"
            for what in ("killed", "survived", "same machine code", "does not compile")
        )
        + ".",
        "",
        "| place | before | after | verdict | killed by | s |",
        "|---|---|---|---|---|---|",
    ]
    for mutant, verdict in judged:
        before, after = (
            "`" + line.replace("|", "\\|") + "`" for line in mutant.lines((ROOT / mutant.path).read_text())
        )
        cells = (f"{mutant.path}:{mutant.line}", before, after, verdict.verdict, verdict.by, f"{verdict.seconds:.0f}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20, help="mutants in all (20)")
    parser.add_argument("--again", action="store_true", help="repeat the mutants that survived")
    parser.add_argument("--list", action="store_true", help="only show the mutants")
    parser.add_argument(
        "--files", nargs="+", metavar="GLOB", help="mutate these files instead of the law, Newton and the pool"
    )
    parser.add_argument("--tests", default="", metavar="REGEX", help="run only the unit tests whose names match")
    given = parser.parse_args()
    mutants = chosen_mutants({"files": given.files} if given.files else GROUPS, given.seed, given.count)
    if given.list:
        for mutant in mutants:
            before, after = mutant.lines((ROOT / mutant.path).read_text())
            print(f"{mutant.path}:{mutant.line}\n  - {before}\n  + {after}")
        return 0
    WORK.mkdir(parents=True, exist_ok=True)
    known = {}
    for line in RESULTS.read_text().splitlines() if RESULTS.exists() else ():
        entry = json.loads(line)
        key = entry.pop("key")
        known[key] = Verdict(**entry)
    if given.again:
        known = {key: verdict for key, verdict in known.items() if verdict.verdict != "survived"}
    waiting = [mutant for mutant in mutants if mutant.key(given.tests) not in known]
    print(f"mutants: {len(mutants)} with seed {given.seed}, {len(mutants) - len(waiting)} of them judged before")
    times = prepare(given.tests) if waiting else {}
    originals = {mutant.path: machine_code(mutant.path) for mutant in waiting}
    for mutant in waiting:
        known[mutant.key(given.tests)] = verdict = judge(mutant, times, originals[mutant.path])
        with RESULTS.open("a") as file:
            file.write(json.dumps({"key": mutant.key(given.tests), **dataclasses.asdict(verdict)}) + "\n")
        before, after = mutant.lines((ROOT / mutant.path).read_text())
        print(f"{mutant.path}:{mutant.line}: {verdict.verdict} {verdict.by} ({verdict.seconds:.0f} s)", flush=True)
        print(f"  - {before}\n  + {after}", flush=True)
    text = table([(mutant, known[mutant.key(given.tests)]) for mutant in mutants], given.seed)
    (WORK / "table.md").write_text(text)
    print(f"\n{text}")
    return 1 if any(known[mutant.key(given.tests)].verdict == "survived" for mutant in mutants) else 0


if __name__ == "__main__":
    sys.exit(main())
