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
