"""`cmake --install` gives a tree that knows nothing of the build: the tree is moved before it is tried. The headers
compile one by one, and programs outside of the sources (tests/package) find the CMake package, are built and run: in
C++, and in C with the shared library."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from program import PROGRAM, ROOT, check, fresh, run

BUILD = Path(PROGRAM).parents[1]
CONSUMER = ROOT / "tests/package"


def cache():
    """The variables of the build's configuration."""
    lines = (BUILD / "CMakeCache.txt").read_text(encoding="utf-8").splitlines()
    pairs = (line.split("=", 1) for line in lines if "=" in line and not line.startswith(("#", "//")))
    return {name.split(":")[0]: value for name, value in pairs}


def installed():
    """The tree after installation, moved to another place."""
    first, tree = fresh("first").resolve(), fresh("tree").resolve()
    run(["cmake", "--install", str(BUILD), "--prefix", str(first)])
    first.rename(tree)
    return tree


def check_relocatable(tree):
    traces = [str(path).encode() + b"/" for path in (ROOT, BUILD, tree.parent / "first")]
    files = [path for path in tree.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    check(len(files) > 100, f"only {len(files)} files were installed")
    for path in files:
        content = path.read_bytes()
        check(not any(trace in content for trace in traces), f"{path} names a folder of the build or of the sources")
    dynamic = run(["readelf", "-d", str(tree / "bin/voussoir")]).stdout
    check(str(BUILD) not in dynamic, f"the program looks for libraries in the build: {dynamic}")


def check_programs(tree):
    version = run([str(tree / "bin/voussoir"), "--version"]).stdout
    check(version.startswith(f"voussoir {cache()['CMAKE_PROJECT_VERSION']} "), f"the version is {version}")
    run([str(tree / "bin/voussoir"), "check", str(tree / "share/voussoir/cases/tunnel_elastic/case.toml")])
    for command in ("figures", "report"):
        script = tree / "bin" / f"voussoir-{command}"
        check(os.access(script, os.X_OK), f"{script} cannot be executed")
        # The Python of the tests, because that of the system may lack the modules.
        said = run([sys.executable, str(script), "--help"]).stdout
        check(f"voussoir-{command}" in said, f"the help of voussoir-{command} does not name it: {said}")


def write_project(folder, headers):
    """A project with the consumer, and with one file for each header."""
    folder.mkdir()
    lines = [
        "cmake_minimum_required(VERSION 3.25)",
        "project(headers LANGUAGES C CXX)",
        f'add_subdirectory("{CONSUMER}" consumer)',
        "find_package(Voussoir 0.2 REQUIRED)",
    ]
    for k, header in enumerate(headers):
        (folder / f"header_{k}.cpp").write_text(f'#include "{header}"\n', encoding="utf-8")
        lines += [
            f"add_library(header_{k} OBJECT header_{k}.cpp)",
            f"target_link_libraries(header_{k} voussoir::voussoir)",
        ]
    (folder / "CMakeLists.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


def check_library(tree):
    include = tree / "include/voussoir"
    headers = sorted(path.relative_to(include).as_posix() for path in include.rglob("*.hpp"))
    page = (ROOT / "docs/reference/public_interface.md").read_text(encoding="utf-8")
    for header in headers:
        check(f"`{header}`" in page, f"docs/reference/public_interface.md does not name the header {header}")
    project = fresh("project").resolve()
    write_project(project, headers)
    known = cache()
    options = [f"-D{name}={known[name]}" for name in ("CMAKE_CXX_COMPILER", "Kokkos_DIR") if name in known]
    run(["cmake", "-S", str(project), "-B", str(project / "build"), f"-DCMAKE_PREFIX_PATH={tree}", *options])
    run(["cmake", "--build", str(project / "build"), "-j", "2"])
    said = run_consumer(project / "build/consumer/consumer", project)
    check("100 grains" in said and "packing.grain" in said, f"the consumer said {said}")
    print(said)
    static = run_consumer(project / "build/consumer/static_consumer", project)
    check(stresses(static) == stresses(said), f"the static library answers C with {static}")
    return said


def run_consumer(program, project):
    return run([str(program), str(CONSUMER / "grains.toml"), str(project / "packings")]).stdout


def stresses(said):
    return re.findall(r"^stress .*", said, re.MULTILINE)


def check_c(tree, said):
    """The CMake package for C, which needs neither C++ nor another package, and pkg-config. Answers as in C++."""
    build = fresh("project_c").resolve()
    run(["cmake", "-S", str(CONSUMER / "c"), "-B", str(build), f"-DCMAKE_PREFIX_PATH={tree}"])
    run(["cmake", "--build", str(build), "-j", "2"])
    shared = run_consumer(build / "consumer_c", build)
    check(len(stresses(said)) == 2 and stresses(shared) == stresses(said), f"the shared library answers {shared}")
    pc = next(tree.glob("lib*/**/voussoir.pc"))
    words = {**os.environ, "PKG_CONFIG_PATH": str(pc.parent)}
    if shutil.which("pkg-config") is None:
        print("there is no pkg-config")
        return
    flags = subprocess.run(
        ["pkg-config", "--cflags", "--libs", "voussoir"], env=words, check=True, capture_output=True, text=True
    ).stdout.split()
    program = build / "by_pkg_config"
    run(["cc", str(CONSUMER / "c/consumer.c"), "-o", str(program), *flags, "-lm", f"-Wl,-rpath,{pc.parents[1]}"])
    check(stresses(run_consumer(program, build)) == stresses(said), "the program of pkg-config answers otherwise")


def main():
    if not list((BUILD).glob("libvoussoir.a")):
        print("this build has no library")
        return 77
    tree = installed()
    check_relocatable(tree)
    check_programs(tree)
    check_c(tree, check_library(tree))
    size = subprocess.run(["du", "-sk", str(tree)], check=True, capture_output=True, text=True).stdout.split()[0]
    print(f"the installation has {int(size) / 1024:.1f} MiB")
    shutil.rmtree(tree)
    return 0


if __name__ == "__main__":
    sys.exit(main())
