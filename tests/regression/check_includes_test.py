"""tools/check_includes.py fails on each kind of fault put into a small clean tree."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(os.environ["VOUSSOIR_ROOT"])


def check(folder):
    done = subprocess.run(
        [sys.executable, ROOT / "tools/check_includes.py", folder], check=False, capture_output=True, text=True
    )
    return done.returncode, done.stdout


class CheckIncludes(unittest.TestCase):
    def found(self, path, text):
        """What the check says of a tree that is clean but for the file `path`."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in ("kernels", "fem", "io", "host", "tests"):
                (root / name).mkdir()
                (root / name / "README.md").write_text("")
                (root / name / "a.hpp").write_text("#pragma once\n#include <vector>\n")
            for room in (
                "kernels/contact",
                "kernels/lanes",
                "kernels/device",
                "host/case",
                "host/stages",
                "host/program",
            ):
                (root / room).mkdir()
                (root / room / "README.md").write_text("")
                (root / room / "a.hpp").write_text("#pragma once\n#include <vector>\n")
            (root / "README.md").write_text("")
            self.assertEqual(check(root)[0], 0)
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
            status, output = check(root)
            self.assertEqual(status == 0, "nothing found" in output)
            return output

    def test_folders_do_not_cross(self):
        self.assertIn("kernels may not include fem", self.found("kernels/b.hpp", '#include "fem/a.hpp"\n'))
        self.assertIn("fem may not include kernels", self.found("fem/b.cpp", '\n # include "kernels/a.hpp"\n'))
        self.assertIn("io may not include host", self.found("io/b.cpp", "#include <host/a.hpp>\n"))
        self.assertIn("host may not include tests", self.found("host/b.cpp", '#include "tests/a.hpp"\n'))

    def test_rooms_include_downwards_only(self):
        upwards = {
            "kernels/contact/b.hpp": "kernels/lanes/a.hpp",
            "kernels/lanes/b.cpp": "kernels/a.hpp",  # the folder's own top stands above all rooms
            "host/case/b.cpp": "host/stages/a.hpp",
            "host/stages/b.hpp": "host/program/a.hpp",
            "host/program/b.cpp": "host/a.hpp",
        }
        for path, header in upwards.items():
            output = self.found(path, f'\n#include "{header}"\n')
            self.assertIn(f"{path}:2: ", output)
            self.assertIn(f"may not include {header}, which stands above it", output)

    def test_rooms_of_one_level_stay_apart(self):
        output = self.found("kernels/lanes/b.hpp", '#include "kernels/device/a.hpp"\n')
        self.assertIn("may not include kernels/device/a.hpp, which stands beside it", output)

    def test_a_room_without_a_level_is_refused(self):
        for path in ("host/attic/a.hpp", "kernels/attic/a.hpp"):
            self.assertIn("is in no room of", self.found(path, "#pragma once\n"))

    def test_rooms_include_downwards_and_themselves(self):
        downwards = {
            "kernels/lanes/b.cpp": ("kernels/contact/a.hpp", "kernels/lanes/a.hpp"),
            "kernels/b.cpp": ("kernels/lanes/a.hpp", "kernels/device/a.hpp", "kernels/a.hpp"),
            "host/stages/b.cpp": ("host/case/a.hpp", "kernels/a.hpp", "fem/a.hpp"),
            "host/main.cpp": ("host/program/a.hpp",),
        }
        for path, headers in downwards.items():
            text = "".join(f'#include "{header}"\n' for header in headers)
            self.assertIn("nothing found", self.found(path, text))

    def test_libraries_stay_home(self):
        self.assertIn("fem may not include Kokkos", self.found("fem/b.cpp", "#include <Kokkos_Core.hpp>\n"))
        self.assertIn("kernels may not include Eigen", self.found("kernels/b.hpp", "#include <Eigen/Dense>\n"))
        self.assertIn("host may not include HDF5", self.found("host/b.cpp", "#include <hdf5.h>\n"))
        self.assertIn("Gmsh may be included by", self.found("fem/newton.cpp", "#include <gmsh.h>\n"))
        self.assertIn("no library known", self.found("io/b.cpp", "#include <boost/any.hpp>\n"))

    def test_includes_are_written_from_the_root(self):
        self.assertIn("from the root", self.found("fem/b.cpp", '#include "a.hpp"\n'))
        self.assertIn("no such file", self.found("fem/b.cpp", '#include "fem/missing.hpp"\n'))

    def test_length_and_readme(self):
        self.assertIn("longer than 400", self.found("fem/b.cpp", "\n" * 401))
        self.assertIn("no README.md", self.found("fem/new/b.cpp", "\n"))

    def test_allowed_includes_pass(self):
        allowed = '#include "fem/a.hpp"\n#include "kernels/a.hpp"\n#include <CLI/CLI.hpp>\n#include <fmt/format.h>\n'
        self.assertIn("nothing found", self.found("host/b.cpp", allowed))
        self.assertIn("nothing found", self.found("fem/mesh.cpp", "#include <gmsh.h>\n#include <cholmod.h>\n"))


if __name__ == "__main__":
    unittest.main()
