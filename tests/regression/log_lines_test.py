"""docs/reference/log_lines.md quotes every message of the places below, and every name of a status.

A message is a text of at least three words in one of the files of SOURCES; what fills a placeholder stands as "…" in
the page. Texts of errors within the program (std::logic_error, std::invalid_argument) are no messages: the user sees
them behind one sentence, which the page has. A text that no user sees is in NOT_SHOWN, with the reason.
"""

import re
import sys

from program import ROOT, check

PAGE = ROOT / "docs/reference/log_lines.md"
SOURCES = (
    "host/record/*.cpp",
    "host/stages/*.cpp",
    "host/packing/*.cpp",
    "host/material/*.cpp",
    "host/ranks/pool.cpp",
    "host/ranks/service.cpp",
    "host/process/*.cpp",
    "host/estimate/*.cpp",
    "host/element_tests/biaxial_run.cpp",
    "host/element_tests/calibrate_run.cpp",
    "host/element_tests/calibrate_tests.cpp",
    "host/element_tests/pack.cpp",
    "host/element_tests/probe.cpp",
    "host/element_tests/strain_path.cpp",
    "host/program/ensemble*.cpp",
    "host/program/failure.cpp",
    "host/program/run_*.cpp",
    "host/program/sweep*.cpp",
    "host/case/accuracy.cpp",
    "host/case/packing_origin.cpp",
    "fem/load_stepper.cpp",
    "fem/mesh_gmsh.cpp",
    "fem/mesh_without_gmsh.cpp",
    "kernels/device/device_library.cpp",
    "kernels/isa/choose_lanes.cpp",
    "io/atomic_file.cpp",
    "io/case_idle.cpp",
    "io/checkpoint.cpp",
    "io/file_lock.cpp",
    "io/hdf5_read.cpp",
    "io/increment_file.cpp",
    "io/outcome_file.cpp",
    "io/result_file.cpp",
    "io/text_file.cpp",
)
# Names of statuses: the texts that one function returns.
STATUSES = (
    ("kernels/state/rve_batch.cpp", "const char* name_of(RveStatus"),
    ("fem/newton.cpp", "const char* to_string(NewtonStatus"),
)
NOT_SHOWN = {
    "recipe … d … damping … t … grains … mu_t … p … seed …": "the text from which a recipe's fingerprint is made",
    "a point is dug out that does not exist": "a fault of the program: stages name elements of the mesh",
    "there is no Gauss point of this number": "a fault of the program: `check` refuses such a point before",
    'checkpoint: "…" has … bytes, which is no multiple of …': "a fault of the program: a checksum is compared before",
    'checkpoint: "…" has … bytes and not …': "the same",
    'checkpoint: it has no "…"': "the same",
    "…host … machine … process … since … born …": "the content of a lock file",
}
LITERAL = r'"(?:[^"\\\n]|\\.)*"'
OF_THE_PROGRAM = re.compile(r"\b(logic_error|invalid_argument|require)\(")


def normalised(text):
    """The text with "…" for every placeholder of fmt and printf, in one line without quotes of Markdown."""
    text = text.replace('\\"', '"').replace("\\n", " ").replace("\\|", "|")
    text = re.sub(r"%[-+0-9.]*(?:zu|td|l*d|s|[efg])", "…", text).replace("%%", "%")
    text = re.sub(r"\{[^{}]*\}", "…", text)
    text = re.sub("…[… ]*…", "…", text)
    return " ".join(text.replace("`", "").split())


def without_comments(code):
    return re.sub(r"(?m)^\s*(?:#include.*|//.*)$", "", code)


def texts_of(code):
    """The texts of C++ code but for errors within the program: neighbouring literals are one text, as the compiler has
    it."""
    for found in re.finditer(f"{LITERAL}(?:\\s*{LITERAL})*", code):
        statement = code[code.rfind(";", 0, found.start()) + 1 : found.start()]
        if OF_THE_PROGRAM.search(statement):
            continue
        yield normalised("".join(part[1:-1] for part in re.findall(LITERAL, found.group())))


def messages_of(pattern):
    files = sorted(ROOT.glob(pattern))
    check(bool(files), f"there is no {pattern}")
    for file in files:
        for text in texts_of(without_comments(file.read_text())):
            words = re.findall(r"[A-Za-z]{2,}", text.replace("_", ""))
            if len(words) >= 3 and " " in text:
                yield file.relative_to(ROOT).as_posix(), text


def names_of(file, function):
    """The texts that a function returns."""
    code = (ROOT / file).read_text()
    start = code.index(function)
    names = re.findall(r'return "(\w+)"', code[start : code.index("\n}\n", start)])
    check(len(names) > 2, f"{file}: {function} returns no names any more")
    return [(file, name) for name in names if name != "unknown"]


def main():
    page = normalised(PAGE.read_text())
    messages = [message for pattern in SOURCES for message in messages_of(pattern)]
    names = [name for file, function in STATUSES for name in names_of(file, function)]
    check(len(messages) > 100, f"only {len(messages)} messages were found in the sources")
    missing = [(file, text) for file, text in messages if text not in page and text not in NOT_SHOWN]
    missing += [(file, name) for file, name in names if f"| {name} |" not in page]
    for file, text in missing:
        print(f"{file}: {text}", file=sys.stderr)
    check(not missing, f"{PAGE.name} lacks {len(missing)} messages or names of statuses")
    print(f"{len(messages)} messages and {len(names)} names of statuses stand in {PAGE.name}")


if __name__ == "__main__":
    main()
