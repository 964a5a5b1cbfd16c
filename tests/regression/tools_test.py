"""The tools that look after the sources: the picture is what the includes say, levels and circles have known answers,
clang-tidy is given the right files, and mutants are put into code alone."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "tools"))

import include_graph
import mutants
import tidy

ROOT = Path(os.environ["VOUSSOIR_ROOT"])


class Architecture(unittest.TestCase):
    def test_picture_is_what_the_includes_say(self):
        words = [sys.executable, str(ROOT / "tools/draw_architecture.py"), "--check"]
        done = subprocess.run(words, check=False, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_page_names_files_and_functions_that_exist(self):
        page = (ROOT / "docs/explanation/architecture.md").read_text()
        rows = re.findall(r"^\|.*\| `([\w/.]+)` \| `([\w()]+)` \|$", page, re.MULTILINE)
        self.assertGreater(len(rows), 20)
        for path, function in rows:
            self.assertTrue(
                (ROOT / path).is_file(), f"docs/explanation/architecture.md names {path}, which does not exist"
            )
            found = re.search(rf"\b{re.escape(function)}\s*\(", (ROOT / path).read_text())
            self.assertTrue(found, f"docs/explanation/architecture.md: {path} has no {function}")

    def test_levels_and_circles(self):
        graph = {"a": set(), "b": {"a"}, "c": {"a", "b"}, "d": {"c", "e"}, "e": {"d"}}
        self.assertEqual(include_graph.levels(graph), {"a": 0, "b": 1, "c": 2, "d": 3, "e": 3})
        self.assertEqual(include_graph.cycles(graph)["d"], {"d", "e"})
        self.assertEqual(include_graph.cycles(graph)["c"], {"c"})

    def test_arrows_that_follow_from_others_are_left_out(self):
        graph = {"a": set(), "b": {"a"}, "c": {"a", "b"}}
        self.assertEqual(include_graph.reduced(graph), {"a": set(), "b": {"a"}, "c": {"b"}})

    def test_rooms_and_units(self):
        self.assertEqual(include_graph.room_of("host/case/keys.cpp"), "host/case")
        self.assertEqual(include_graph.room_of("fem/mesh.hpp"), "fem")
        self.assertEqual(include_graph.unit_of("fem/mesh.hpp"), include_graph.unit_of("fem/mesh.cpp"))


class Tree(unittest.TestCase):
    """A small tree in which the tools work instead of in the checkout."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        for module in (tidy, mutants):
            patch = mock.patch.object(module, "ROOT", self.root)
            patch.start()
            self.addCleanup(patch.stop)
        tidy.includes.cache_clear()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)


class Tidy(Tree):
    def setUp(self):
        super().setUp()
        self.write("fem/a.hpp", "")
        self.write("fem/b.hpp", '#include "fem/a.hpp"\n')
        self.write("fem/c.hpp", '#include "fem/b.hpp"\n')
        self.write("fem/a.cpp", '#include "fem/a.hpp"\n')
        self.write("fem/d.cpp", '#include "fem/c.hpp"\n')
        self.write("tests/unit/fem/b_test.cpp", '#include "fem/b.hpp"\n')
        self.commands = dict.fromkeys(("fem/a.cpp", "fem/d.cpp", "tests/unit/fem/b_test.cpp"), "c++")

    def test_a_source_is_checked_itself(self):
        self.assertEqual(tidy.files_for(["fem/d.cpp"], self.commands), ["fem/d.cpp"])

    def test_a_header_is_checked_through_its_source_or_its_test(self):
        self.assertEqual(tidy.files_for(["fem/a.hpp"], self.commands), ["fem/a.cpp"])
        self.assertEqual(tidy.files_for(["fem/b.hpp"], self.commands), ["tests/unit/fem/b_test.cpp"])

    def test_a_header_of_its_own_is_checked_through_what_includes_it(self):
        self.assertEqual(tidy.files_for(["fem/c.hpp"], self.commands), ["fem/d.cpp"])
        self.assertEqual(tidy.files_for(["fem/c.hpp", "fem/d.cpp"], self.commands), ["fem/d.cpp"])

    def test_a_clean_file_is_checked_again_when_a_header_changes(self):
        self.write(".clang-tidy", "")
        self.write("tools/requirements-style.txt", "")
        before = tidy.stamp_of("fem/d.cpp", "c++")
        self.assertNotEqual(tidy.stamp_of("fem/d.cpp", "c++ -O2"), before)
        self.write("fem/a.hpp", "int a;\n")
        self.assertNotEqual(tidy.stamp_of("fem/d.cpp", "c++"), before)


class Mutants(Tree):
    def faults(self, line):
        """{line with a fault} of a file that holds this line alone."""
        self.write("a.cpp", line + "\n")
        return {mutant.lines(line + "\n")[1] for mutant in mutants.mutants_of("a.cpp")}

    def test_operators_signs_and_constants(self):
        self.assertEqual(
            self.faults("if (a < b) c += d;"), {"if (a <= b) c += d;", "if (a > b) c += d;", "if (a < b) c -= d;"}
        )
        self.assertEqual(self.faults("return -a * b;"), {"return a * b;", "return -a / b;"})
        self.assertEqual(self.faults("x = a && !b;"), {"x = a || !b;", "x = a && b;"})
        self.assertEqual(self.faults("f(2);"), {"f(1);", "f(3);"})
        self.assertEqual(self.faults("f(0.5);"), {"f(0.0);", "f(1.0);"})

    def test_bounds(self):
        self.assertEqual(
            self.faults("x = std::clamp(a, b(c, d), e);"),
            {"x = std::max(a, b(c, d));", "x = std::min(a, e);"},
        )
        self.assertEqual(self.faults("y = std::max(a, b);"), {"y = std::min(a, b);"})
        self.assertEqual(self.faults("t = clamp_to(a, cap);"), {"t = (a);"})

    def test_templates_pointers_texts_and_comments_are_left_alone(self):
        for line in (
            "std::vector<std::array<double, 3>> x;",
            "template <class V, bool Rolling>",
            "const Mesh& mesh, double* at, T&& moved",
            'say("a < b && 2 * c");  // a < b',
            '#include "fem/a.hpp"',
            "return a->b;",
        ):
            self.assertLessEqual(self.faults(line), {line.replace("3", n) for n in "24"}, line)

    def test_the_seed_chooses(self):
        self.write("a.cpp", "\n".join(f"x{k} = a + b;" for k in range(50)))
        first = mutants.chosen_mutants({"all": ["*.cpp"]}, 1, 5)
        self.assertEqual(first, mutants.chosen_mutants({"all": ["*.cpp"]}, 1, 5))
        self.assertNotEqual(first, mutants.chosen_mutants({"all": ["*.cpp"]}, 2, 5))
        self.assertEqual(len(first), 5)

    def test_nearest_tests_come_first(self):
        tests = ["io_units_test", "fem_mesh_test", "fem_newton_test"]
        order = sorted(tests, key=lambda test: mutants.nearness(test, "fem/newton.cpp"))
        self.assertEqual(order, ["fem_newton_test", "fem_mesh_test", "io_units_test"])


if __name__ == "__main__":
    unittest.main()
