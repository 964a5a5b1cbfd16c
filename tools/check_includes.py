#!/usr/bin/env python3
"""Fails where the tree of the sources is not the architecture that the tables below describe.

Checks, over all files of the checkout (or of the folder given as the only argument):
  - an include stays within the lines of the table FOLDERS, for our folders and for third-party libraries;
  - within a folder of several rooms (the table ROOMS) an include points to a room on a lower level, never upwards or to
    a room beside it, and every sub-folder is one of these rooms;
  - an include of ours is written from the root of the repository and the file exists;
  - a source file has at most 400 lines;
  - a folder has a README.md.
Prints one line per finding, `file:line: what`, and exits with 1 when there is any.
"""

import os
import re
import sys
from pathlib import Path

OURS = ("kernels", "fem", "io", "host", "python", "tests")

# folder -> (our folders, third-party libraries) that it may include. Standard headers are free to all, and fmt stands
# in for std::format (not in g++ 12) everywhere but in kernels, which write no text.
FOLDERS = {
    "kernels": ({"kernels"}, {"Kokkos", "intrinsics", "CUDA", "POSIX"}),
    "fem": ({"fem"}, {"Eigen", "SuiteSparse", "Gmsh", "OpenMP", "fmt", "POSIX"}),
    "io": ({"io"}, {"HDF5", "toml++", "JSON", "fmt", "POSIX"}),
    # host joins the others, so it holds their types (Kokkos views, Eigen matrices) and starts Kokkos.
    "host": (
        {"kernels", "fem", "io", "host"},
        {"Kokkos", "Eigen", "CLI11", "spdlog", "fmt", "POSIX", "MPI", "OpenMP", "C"},
    ),
    # The Python module translates host/library; it stands beside host/main.cpp at the top.
    "python": ({"kernels", "fem", "io", "host", "python"}, {"nanobind", "POSIX"}),
    "tests": (set(OURS), None),  # None: all libraries
    "tools": (set(), {"CUDA"}),
}

# folder -> its rooms (sub-folders) level by level, the lowest first; rooms that stand on one level do not include one
# another. Files at the top of the folder stand above all of its rooms.
ROOMS = {
    "kernels": (("contact",), ("state",), ("course", "isa"), ("tangents",), ("lanes", "device")),
    "host": (
        ("process",),
        ("case",),
        ("packing",),
        ("material",),
        ("ranks", "library"),
        ("record",),
        ("stages", "element_tests"),
        ("scene",),
        ("kinds",),
        ("estimate", "ensemble"),
        ("sweep",),
        ("program",),
    ),
}

# Libraries that only a few files of their folder may include.
CONFINED = {
    "Gmsh": re.compile(r"fem/mesh\w*\.cpp|tests/.*"),
    # fem needs OpenMP to restore the number of threads, which Gmsh changes; host chooses their number
    "OpenMP": re.compile(r"fem/mesh\w*\.cpp|host/process/(cores|threads)\.cpp|tests/.*"),
    "MPI": re.compile(r"host/ranks/channel\.cpp"),
    # elsewhere the header of C++ is meant, such as <cmath>
    "C": re.compile(r"host/library/voussoir\.h|tests/package/.*\.c"),
    "Voussoir": re.compile(r"tests/package/.*"),
    # fem reads mesh files in a child process, because Gmsh crashes or hangs where they are damaged
    "POSIX": re.compile(r"fem/mesh_gmsh_child\.cpp|(kernels|io|host|python|tests)/.*"),
}

LIBRARIES = {
    "Kokkos": r"Kokkos(Exp)?_\w+\.hpp|desul/.*",
    "Eigen": r"(unsupported/)?Eigen/\w+",
    "SuiteSparse": r"(suitesparse/)?(cholmod|umfpack|amd|colamd|SuiteSparse_config)\w*\.h",
    "Gmsh": r"gmsh(c)?\.h(_cwrap)?",
    "HDF5": r"(hdf5|H5\w+|hdf5_hl)\.h|H5Cpp\.h|highfive/.*",
    "toml++": r"toml\.hpp|toml\+\+/.*",
    "JSON": r"nlohmann/json(_fwd)?\.hpp",
    "OpenMP": r"omp\.h",
    "MPI": r"mpi\.h",
    "CLI11": r"CLI/\w+\.hpp",
    "spdlog": r"spdlog/.*",
    "fmt": r"fmt/.*",
    "nanobind": r"nanobind/.*",
    "GoogleTest": r"(gtest|gmock)/.*",
    "Google Benchmark": r"benchmark/.*",
    "CUDA": r"cuda\w*\.h",
    "intrinsics": r"(immintrin|cpuid)\.h",
    "POSIX": r"(sys/\w+|unistd|fcntl|dlfcn|fnmatch|poll|signal|spawn|termios|malloc|pthread)\.h",
    "C": r"(math|stdint|stdio|stdlib|string|time)\.h",
    "Voussoir": r"voussoir\.h",  # as it is installed
    "standard": r"[a-z_0-9]+",
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SOURCES = {".cpp", ".hpp", ".h", ".c", ".cu", ".py", ".sh"}
LONGEST = 400
NOT_OURS = {"build", "out"}


def folders_of(root):
    """Every folder of the checkout with its files; hidden and generated ones are left out."""
    for folder, children, files in os.walk(root):
        top = Path(folder) == root
        children[:] = sorted(c for c in children if not (c.startswith((".", "__")) or (top and c in NOT_OURS)))
        yield Path(folder), sorted(f for f in files if not f.startswith("."))


def library_of(header):
    return next((name for name, pattern in LIBRARIES.items() if re.fullmatch(pattern, header)), None)


def room_of(path):
    """Room and level of a file in a folder of rooms; (None, level) at the folder's top, None where it has no rooms."""
    levels = ROOMS.get(path.parts[0])
    if levels is None:
        return None
    if len(path.parts) == 2:
        return None, len(levels)
    return next(((path.parts[1], level) for level, rooms in enumerate(levels) if path.parts[1] in rooms), None)


def level_fault(path, header):
    """The fault of an include of `header` from the file `path` of the same folder, or None."""
    folder = path.parts[0]
    if folder not in ROOMS:
        return None
    source, target = room_of(path), room_of(Path(header))
    if target is None:
        return f"{header} is in no room of {folder} that tools/check_includes.py knows"
    if source[0] == target[0] or target[1] < source[1]:
        return None
    where = f"{folder}/{source[0]}" if source[0] else f"the top of {folder}"
    sense = "beside it" if target[1] == source[1] else "above it"
    return f"{where} may not include {header}, which stands {sense}"


def include_fault(root, path, quote, header):
    """The fault of one include in the file `path` (relative to root), or None."""
    folder = path.parts[0]
    if folder not in FOLDERS:
        return f"source files belong into one of {', '.join(FOLDERS)}"
    ours, libraries = FOLDERS[folder]
    if header.split("/")[0] in OURS and library_of(header) is None:
        other = header.split("/")[0]
        if other not in ours:
            return f"{folder} may not include {other} ({header})"
        if not (root / header).is_file():
            return f"no such file: {header}"
        return level_fault(path, header) if other == folder else None
    library = library_of(header)
    if library is None and quote == '"':
        return f'write "{header}" from the root of the repository'
    if library is None:
        return f"<{header}> is of no library known to tools/check_includes.py"
    if library != "standard" and libraries is not None and library not in libraries:
        return f"{folder} may not include {library} ({header})"
    if library in CONFINED and not CONFINED[library].fullmatch(path.as_posix()):
        return f"{library} may be included by {CONFINED[library].pattern} only ({header})"
    return None


def file_findings(root, path):
    lines = (root / path).read_text(encoding="utf-8").splitlines()
    if len(lines) > LONGEST:
        yield f"{path}:{len(lines)}: longer than {LONGEST} lines"
    if path.suffix == ".py":
        return
    if path.suffix in SOURCES and path.parts[0] in ROOMS and room_of(path) is None:
        yield f"{path}:1: is in no room of {path.parts[0]} that tools/check_includes.py knows"
        return
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        fault = match and include_fault(root, path, *match.groups())
        if fault:
            yield f"{path}:{number}: {fault}"


def findings(root):
    for folder, files in folders_of(root):
        if files and "README.md" not in files:
            yield f"{folder.relative_to(root)}/: no README.md"
        for name in files:
            path = (folder / name).relative_to(root)
            if path.suffix in SOURCES or name == "CMakeLists.txt" or (path.parts[0] == "tools" and not path.suffix):
                yield from file_findings(root, path)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent).resolve()
    found = list(findings(root))
    print("\n".join(found) if found else "check_includes: nothing found")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
