"""Every sentence about meshes in the sources stands in docs/reference/meshes.md."""

import re
import sys

from log_lines_test import LITERAL, normalised, without_comments
from program import ROOT, check

PAGE = ROOT / "docs/reference/meshes.md"
SOURCES = (
    "fem/mesh_builder.cpp",
    "fem/mesh_file.cpp",
    "fem/mesh_file_checks.cpp",
    "fem/mesh_gmsh_child.cpp",
    "fem/mesh_gmsh_message.cpp",
    "fem/mesh_grid.cpp",
    "fem/mesh_ring.cpp",
    "fem/mesh_without_gmsh.cpp",
    "host/scene/scene_mesh.cpp",
)
NOT_SHOWN = {"/proc/self/statm", "a mesh of a shape that does not exist", "part: a ring is a quarter, half or whole"}


def sentences_of(file):
    """The texts of three words and more without the key before them; neighbouring literals are one text."""
    code = without_comments((ROOT / file).read_text())
    for found in re.finditer(f"{LITERAL}(?:\\s*{LITERAL})*", code):
        text = normalised("".join(part[1:-1] for part in re.findall(LITERAL, found.group())))
        if len(re.findall(r"[A-Za-z]{2,}", text)) >= 3 and text not in NOT_SHOWN:
            yield re.sub(r"^\w+: ", "", text).strip(" (:;,")


def main():
    page = normalised(PAGE.read_text())
    sentences = [(file, text) for file in SOURCES for text in sentences_of(file)]
    check(len(sentences) > 40, f"only {len(sentences)} sentences were found in the sources")
    missing = [(file, text) for file, text in sentences if text not in page]
    for file, text in missing:
        print(f"{file}: {text}", file=sys.stderr)
    check(not missing, f"{PAGE.name} lacks {len(missing)} sentences")
    print(f"{len(sentences)} sentences stand in {PAGE.name}")


if __name__ == "__main__":
    main()
