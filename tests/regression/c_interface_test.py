"""The C interface as other languages meet it: programs in C and Fortran are compiled and run with libvoussoir.so of the
build, Python loads it by ctypes, and processes end in the ways that users end them."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from program import PROGRAM, ROOT, check, fresh, run

BUILD = Path(PROGRAM).parents[1]
LIBRARY = BUILD / "libvoussoir.so"
HEADER = ROOT / "host/library/voussoir.h"
SOURCES = ROOT / "tests/package/c"
CASE = ROOT / "tests/package/grains.toml"
PACKINGS = Path("packings").resolve()
LINK = [f"-L{BUILD}", "-lvoussoir", "-lm", f"-Wl,-rpath,{BUILD}"]
STRICT = ["-std=c99", "-D_POSIX_C_SOURCE=200809L", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]


def declared():
    """The functions of the header."""
    return set(re.findall(r"^[a-z].*?\b(voussoir_[a-z_]+)\(", HEADER.read_text(encoding="utf-8"), re.MULTILINE))


def check_names():
    lines = run(["nm", "-D", "--defined-only", str(LIBRARY)]).stdout.splitlines()
    exported = {line.split()[-1] for line in lines}
    check(exported == declared(), f"the library exports {exported ^ declared()} besides or in place of the header's")
    module = (ROOT / "host/library/voussoir.f90").read_text(encoding="utf-8")
    heads = "".join(re.findall(r"^ +(?:function|procedure).*bind\(c\).*$", module, re.MULTILINE))
    bound = set(re.findall(r"\bvoussoir_[a-z_]+", heads))
    check(len(bound) > 10 and bound <= declared(), f"voussoir.f90 names {bound - declared()}")


def check_c():
    run(["cc", *STRICT, f"-I{HEADER.parent}", str(SOURCES / "consumer.c"), "-o", "consumer", *LINK])
    said = run(["./consumer", str(CASE), str(PACKINGS)]).stdout
    check(" 0 failures" in said and "packing.grain" in said, f"the consumer said {said}")
    run(["cc", *STRICT[2:], "-std=c11", f"-I{HEADER.parent}", str(SOURCES / "batch_sizes.c"), "-o", "sizes", *LINK])
    said = run(["./sizes", str(CASE), f"packing.folder={PACKINGS},packing.variety=1", "2", "5", "5", "2", "1"]).stdout
    check(said.count("batches of") == 3, f"the sizes of batches: {said}")


def check_fortran():
    """The UMAT that answers by tangents errs by the first order of the increment; the exact one does not."""
    if shutil.which("gfortran") is None:
        print("there is no gfortran")
        return
    files = [ROOT / "host/library/voussoir.f90", SOURCES / "umat.f90", SOURCES / "umat_host.f90"]
    flags = ["-std=f2018", "-Wall", "-Wextra", "-Werror", "-Wno-unused-dummy-argument", "-fcheck=all"]
    run(["gfortran", *flags, *map(str, files), "-o", "umat_host", *LINK])
    axial, off = {}, {}
    for way, increments in (("single", 20), ("batch", 20), ("batch", 40)):
        said = run(["./umat_host", str(CASE), f"packing.folder={PACKINGS}", "2", str(increments), "2e-3", way]).stdout
        print(said)
        axial[way, increments] = float(re.findall(r"point 2: stress \[Pa\] +\S+ +(\S+),", said)[0])
        off[way, increments] = float(re.findall(r"out of balance +(\S+),", said)[0])
    exact = axial["single", 20]
    errors = [abs(axial["batch", n] / exact - 1) for n in (20, 40)]
    check(exact < -120e3, f"compression makes the stress more compressive: {exact}")
    check(off["single", 20] < 1e-3, f"the exact UMAT leaves {off['single', 20]} out of balance")
    check(errors[0] < 5e-3, f"the stresses differ by {errors[0]}")
    check(0.4 < off["batch", 40] / off["batch", 20] < 0.6, f"the error is not of the first order: {off}")


def load():
    library = ctypes.CDLL(str(LIBRARY))
    library.voussoir_last_error.restype = ctypes.c_char_p
    library.voussoir_size.restype = ctypes.c_int64
    library.voussoir_create.argtypes = (ctypes.c_char_p, ctypes.c_int64, ctypes.c_char_p, *[ctypes.c_void_p] * 3)
    for name in ("voussoir_evaluate", "voussoir_commit", "voussoir_size", "voussoir_destroy"):
        getattr(library, name).argtypes = [ctypes.c_void_p]
    library.voussoir_evaluate.argtypes = (ctypes.c_void_p, ctypes.c_int64, *[ctypes.c_void_p] * 4)
    return library


def start_and_evaluate(library):
    rves = ctypes.c_void_p()
    settings = f"packing.folder={PACKINGS}".encode()
    check(library.voussoir_start(2) == 0, library.voussoir_last_error())
    made = library.voussoir_create(os.fsencode(CASE), 2, settings, None, None, ctypes.byref(rves))
    check(made == 0 and library.voussoir_size(rves) == 2, library.voussoir_last_error())
    gradients, stress = (ctypes.c_double * 8)(), (ctypes.c_double * 6)()
    check(library.voussoir_evaluate(rves, 2, gradients, stress, None, None) == 0, library.voussoir_last_error())
    check(-101e3 < stress[0] < -99e3, f"the RVEs begin with {stress[0]} Pa")
    return rves


def end_by_nothing(library):
    """The RVEs live and the threads run when the process ends."""
    start_and_evaluate(library)


def end_by_stop(library):
    rves = start_and_evaluate(library)
    check(library.voussoir_stop() == 0, library.voussoir_last_error())
    check(library.voussoir_commit(rves) == 1, "a commit after the end was taken")
    check(library.voussoir_start(2) == 1, "the threads began twice")


def end_in_atexit(library):
    """A foreign program frees what it holds when its objects are destroyed."""
    import atexit  # noqa: PLC0415 (only this process needs it)

    rves = start_and_evaluate(library)
    atexit.register(lambda: check(library.voussoir_destroy(rves) == 0 and library.voussoir_stop() == 0, "the end"))


def end_by_fork(library):
    rves = start_and_evaluate(library)
    child = os.fork()
    if child == 0:
        os._exit(library.voussoir_destroy(rves))
    check(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 1, "a forked process was not refused")
    check(library.voussoir_destroy(rves) == 0, library.voussoir_last_error())


ENDS = (end_by_nothing, end_by_stop, end_in_atexit, end_by_fork)


def check_ends():
    for end in ENDS:
        ended = subprocess.run([sys.executable, __file__, end.__name__], capture_output=True, text=True, check=False)
        check(ended.returncode == 0 and not ended.stderr, f"{end.__name__}: {ended.returncode} {ended.stderr}")


def main():
    if not LIBRARY.exists():
        print("this build has no library")
        return 77
    if b"__asan_init" in LIBRARY.read_bytes():
        print("skipped: a program without sanitizers cannot load a library with them")
        return 77
    fresh(PACKINGS)
    check_names()
    check_c()
    check_fortran()
    check_ends()
    return 0


if __name__ == "__main__":
    if len(sys.argv) == 2:
        next(end for end in ENDS if end.__name__ == sys.argv[1])(load())
        sys.exit(0)
    sys.exit(main())
