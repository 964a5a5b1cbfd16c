"""One program for all x86-64: no wide instruction outside the lanes' own sections; the sets give the same bits in a
whole run, also on ranks of unlike sets; the choice and its refusals."""

import os
import re
import shutil
import subprocess

import h5py
import numpy as np
from program import PROGRAM, check, check_same, command, fresh, run

SETTINGS = [
    "packing.grains=40",
    "packing.candidates=1",
    "packing.folder=packings",
    "column.elements=2",
    "gravity.ratio=2",
]

# Instructions beyond the baseline of x86-64 in code that a compiler makes. All of AVX begins with a v; verr, verw and
# the instructions of virtual machines do not occur in a program. tzcnt is missing since older processors take it for
# bsf.
BEYOND = re.compile(
    r"v[a-z0-9]+|andn|bextr|bls(i|r|msk)|bzhi|mulx|pdep|pext|rorx|s[ah][lr]x|lzcnt|popcnt|movbe|crc32[bwlq]?|lddqu"
    r"|round[sp][sd]|addsubp[sd]|h(add|sub)p[sd]|mov(ddup|shdup|sldup)|p(shufb|test|abs[bwd]|align?r|sign[bwd]|mulld)"
    r"|ph(add|sub)\w+|pmul(hrsw|dq)|pmaddubsw|p(min|max)(s[bd]|u[wd])|pcmp(eqq|gtq)|pmov[sz]x\w+|packusdw|pblend\w+"
    r"|blendv?p[sd]|dpp[sd]|(insert|extract)ps|p(ins|ext)r[bdq]|cmpxchg16b|mpsadbw|phminposuw|movntdqa"
)


def instructions(section):
    """Address and mnemonic of every instruction of a section, with the function in which it stands."""
    listing = subprocess.run(
        ["objdump", "-d", "--no-show-raw-insn", "-j", section, PROGRAM], check=True, capture_output=True, text=True
    ).stdout
    function = ""
    for line in listing.splitlines():
        if line.endswith(">:"):
            function = line[line.index("<") + 1 : -2]
        elif line.startswith(" ") and "\t" in line:
            text = line.split("\t", 1)[1]
            words = [w for w in text.split() if w not in ("rep", "repz", "repnz", "lock", "data16", "bnd", "notrack")]
            if words:
                yield function, words[0], text


def code_sections():
    headers = subprocess.run(["objdump", "-h", "-w", PROGRAM], check=True, capture_output=True, text=True).stdout
    return [line.split()[1] for line in headers.splitlines() if ", CODE" in line]


def check_program_code():
    sections = code_sections()
    check(".text" in sections, f"the program has no section .text: {sections}")
    wide = [s for s in sections if s.startswith("lanes_")]
    for section in sections:
        found = [(f, text) for f, name, text in instructions(section) if BEYOND.fullmatch(name)]
        if section in wide:
            check(len(found) > 1000, f"{section} holds {len(found)} wide instructions: is it what it says?")
        else:
            check(not found, f"{section} has {len(found)} instructions beyond the baseline, such as {found[:3]}")
    print(f"no instruction beyond the baseline outside {wide}")
    return wide


def check_starts(wide):
    """Nothing that runs before main or at its end stands in a wide section."""
    headers = subprocess.run(["readelf", "-SW", PROGRAM], check=True, capture_output=True, text=True).stdout
    ranges = {}
    for line in headers.splitlines():
        words = line.replace("[ ", "[").split()
        if len(words) > 5 and re.fullmatch(r"\[\d+\]", words[0]) and words[1] != "NULL":
            ranges[words[1]] = (int(words[3], 16), int(words[3], 16) + int(words[5], 16))
    moved = subprocess.run(["readelf", "-rW", PROGRAM], check=True, capture_output=True, text=True).stdout
    targets = 0
    for line in moved.splitlines():
        words = line.split()
        if len(words) == 4 and words[2] == "R_X86_64_RELATIVE":
            place, target = int(words[0], 16), int(words[3], 16)
            for array in (".init_array", ".fini_array", ".preinit_array"):
                first, end = ranges.get(array, (0, 0))
                if first <= place < end:
                    targets += 1
                    inside = [s for s in wide if ranges[s][0] <= target < ranges[s][1]]
                    check(not inside, f"{array} calls a function of {inside}")
    check(targets > 0, "no function is called before main: the relocations of .init_array were not found")


def info(**variables):
    return subprocess.run(
        [PROGRAM, "info", "--cpu"], check=False, capture_output=True, text=True, env=os.environ | variables
    )


def refused(words, *parts, **variables):
    done = subprocess.run(words, check=False, capture_output=True, text=True, env=os.environ | variables)
    lines = done.stderr.splitlines()
    check(done.returncode == 2, f"{words[1:]} {variables}: exit {done.returncode}: {done.stderr}")
    check(len(lines) == 1 and all(p in lines[0] for p in parts), f"{words[1:]}: {lines} lacks one of {parts}")
    print(lines[0])


told = info(VOUSSOIR_ISA="")
check(told.returncode == 0, f"info --cpu ends with {told.returncode}: {told.stderr}")
print(told.stdout)


def said_after(words):
    check(words in told.stdout, f"info --cpu does not say {words}")
    return told.stdout.split(words)[1].splitlines()[0]


held = said_after("holds the lanes ").split(", ")
if "scalar" not in held:
    print("skipped: the compiler's flags ask for a certain processor, so that the program runs on no other")
    raise SystemExit(77)
check_starts(check_program_code())

offered = said_after("which offers ").split()[0]
order = ["scalar", "v3", "v4"]
takeable = [s for s in held if order.index(s) <= order.index(offered)]
check(f"lanes: {takeable[-1]} (" in told.stdout, f"the largest set of {takeable} is not taken")

# The choice by the variable and by the key, which comes first; what cannot be taken is refused, and says what can be.
for name in takeable:
    said = info(VOUSSOIR_ISA=name).stdout
    check(f"lanes: {name} (" in said and "VOUSSOIR_ISA asks for it" in said, f"VOUSSOIR_ISA={name}: {said}")
refused([PROGRAM, "info", "--cpu"], "VOUSSOIR_ISA", '"avx2"', "scalar, v3 or v4", VOUSSOIR_ISA="avx2")
check_words = command("column", "none", [*SETTINGS, 'engine.isa="avx512"'])
check_words[1:2] = ["check"]
check_words = [w for w in check_words if w not in ("-o", "none")]
refused(check_words, "engine.isa", "avx512", "scalar")
for name in set(order) - set(takeable):
    refused([PROGRAM, "info", "--cpu"], "VOUSSOIR_ISA", name, takeable[0], VOUSSOIR_ISA=name)
    refused([w.replace("avx512", name) for w in check_words], "engine.isa", name, takeable[0])


# A whole run with each set: the same bits. The log and run.h5 say which set was taken, and a run resumes with another.
def run_with(name, folder, *further):
    os.environ["VOUSSOIR_ISA"] = name
    run(command("column", folder, SETTINGS, "--threads", "1", *further))
    del os.environ["VOUSSOIR_ISA"]


first = fresh(takeable[0])
run_with(takeable[0], first)
for name in takeable[1:]:
    folder = fresh(name)
    run_with(name, folder)
    check_same(first, folder)
    log = (folder / "run.log").read_text()
    check(f"lanes: {name} (" in log and "VOUSSOIR_ISA asks for it" in log, f"the log does not say {name}: {log}")
    with h5py.File(folder / "run.h5") as opened:
        origin = {key: np.asarray(value).astype(str).item() for key, value in opened["provenance"].attrs.items()}
    check(origin["lanes"].startswith(name), f"run.h5 says {origin['lanes']}")
    check(len(origin["processor"]) > 2, f"run.h5 says of the processor: {origin['processor']}")
    said = run([PROGRAM, "info", str(folder / "run.h5")]).stdout
    check(f"lanes: {name} (" in said and "processor: " in said, f"info does not say {name}: {said}")
    # The key engine.isa makes no other case of it: a resumed run is not refused.
    run(command("column", folder, [*SETTINGS, f"engine.isa={takeable[0]!r}"], "--resume"))

# Ranks of unlike sets: each takes its own.
if "no MPI" not in run([PROGRAM, "--version"]).stdout and shutil.which("mpirun") and len(takeable) > 1:
    os.environ |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}

    def unlike(folder, *settings):
        words = ["mpirun", "--oversubscribe", "--bind-to", "none"]
        for name in (takeable[-1], takeable[0]):
            words += ["-n", "1", "env", f"VOUSSOIR_ISA={name}"]
            words += [*command("column", folder, [*SETTINGS, *settings], "--threads", "1"), ":"]
        return words[:-1]

    spread = fresh("unlike_ranks")
    run(unlike(spread))
    check_same(first, spread)
    log = (spread / "run.log").read_text()
    for name in (takeable[0], takeable[-1]):
        check(f"1 threads and {name} lanes" in log, f"the log does not say which rank has {name} lanes: {log}")
