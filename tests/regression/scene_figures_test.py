"""Figures of scenes: a tiny elastic scene has all that fit, their numbers are those of its table, dug-out elements are
left out, an opening's pressure is found from known forces, and a sweep's runs are drawn together."""

import os
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest import mock

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import h5py
import numpy as np
from figure_calls import call, copy
from program import PROGRAM, fresh, run
from tiny_scene import CASE
from voussoir.figures import __main__ as figures
from voussoir.figures import (
    catalogue,
    openings,
    panels,
    q8,
    regions,
    scene,
    scene_boundaries,
    scene_ground,
    scene_holds,
    scene_lines,
    scene_needs,
)
from voussoir.figures.result import Missing, Result, plain

OF_EVERY_SCENE = {
    *("mesh", "boundary_curves", "boundary_reactions", "record_points", "record_regions", "section_lines"),
    *("stage_fields", "displacement", "deviatoric_strain", "convergence"),
}


def setUpModule():
    """One scene, and a sweep of it with two stiffnesses."""
    fresh("runs").mkdir()
    Path("runs/tiny.toml").write_text(CASE)
    run([PROGRAM, "run", "runs/tiny.toml", "-o", "runs/tiny"])
    Path("runs/sweep.toml").write_text(
        'base = "tiny.toml"\n[grid]\nname = "doors"\n[grid.modulus]\nsoft = ["elastic.modulus=30 MPa"]\nhard = []\n'
    )
    run([PROGRAM, "sweep", "runs/sweep.toml", "-o", "runs/sweep"])


class Colours(unittest.TestCase):
    def test_ground(self):
        """Regions that are elastic on their own do not count for the colours, unless there are no others."""
        wall = {"name": "wall", "elastic": {"modulus": "30 GPa"}}
        result: Any = SimpleNamespace(
            case={"region": [{"name": "sand"}, wall]},
            region_names=["wall", "sand"],
            regions=np.array([0, 1, 1]),
            connectivity=np.zeros((3, 8), dtype=int),
        )
        self.assertEqual(regions.ground(result).tolist(), [False, True, True])
        result.case = {"region": [{"name": "sand", "elastic": {}}, wall]}
        self.assertEqual(regions.ground(result).tolist(), [True, True, True])
        result.regions = None
        self.assertEqual(regions.ground(result).tolist(), [True, True, True])


class OfAScene(unittest.TestCase):
    def setUp(self):
        self.result = Result("runs/tiny")
        self.stages = {stage.name: stage for stage in scene.stages(self.result)}

    def test_figures(self):
        """All figures that fit are drawn, as vectors, too; those that the scene cannot have are not mentioned."""
        status, said, errors = call(figures, "runs/tiny", "-o", "figures")
        self.assertEqual((status, errors), (0, []))
        self.assertEqual({Path(line.split()[-1]).stem for line in said if line.startswith("wrote")}, OF_EVERY_SCENE)
        self.assertEqual([line for line in said if not line.startswith("wrote")], [])
        _, said, _ = call(figures, "runs/tiny", "-o", "figures", "--only", "ground_reaction")
        self.assertEqual(said, ["skipped ground_reaction.png: there is no stage volume_loss"])
        status, said, _ = call(figures, "runs/tiny", "-o", "figures", "--only", "boundary_curves", "--format", "svg")
        self.assertEqual((status, len(said)), (0, 1))
        self.assertIn("<svg", Path("figures/boundary_curves.svg").read_text()[:600])

    def test_boundary_curves(self):
        """The door goes down by 4 mm, is pushed upwards at first, and has no reaction while it is released."""
        (motion,) = scene.motions(self.result)
        self.assertEqual((motion.name, motion.axis, motion.movement), ("door", "y", "downwards"))
        reaction, traction, release = scene_boundaries.curves_of(self.result, motion)
        self.assertIn("upwards", reaction.ylabel)
        lower, free = self.stages["lower"], self.stages["free"]
        np.testing.assert_allclose(reaction.x[lower.number], [0, 1, 2, 3, 4], atol=1e-9)
        raw = scene.column(lower.increments, "reaction_door_y")
        np.testing.assert_allclose(reaction.y[lower.number], raw / 1e3)
        self.assertGreater(raw[0], 0)
        self.assertLess(raw[-1], raw[0])
        np.testing.assert_allclose(traction.y[lower.number], scene.column(lower.increments, "traction_door_y") / 1e3)
        self.assertTrue(np.isnan(reaction.y[free.number]).all())
        np.testing.assert_allclose(release.y[free.number], [100, 75, 50])
        np.testing.assert_allclose(scene.progress(free), [3, 3.5, 4])

    def test_dug_out(self):
        """Half of the elements are dug out; the line between the regions stands while both sides do."""
        before, after = (self.stages[name].increments[-1] for name in ("weight", "dig"))
        self.assertTrue(regions.alive(self.result, before).all())
        there = regions.alive(self.result, after)
        centres = self.result.coordinates[self.result.connectivity].mean(axis=1)
        np.testing.assert_array_equal(there, centres[:, 1] < 1)
        self.assertEqual(self.result.region_names, ["sand", "cut"])
        between = regions.interfaces(self.result, regions.alive(self.result, before))
        self.assertEqual(len(between), 4)
        np.testing.assert_allclose(self.result.coordinates[between][..., 1], 1)
        self.assertEqual(len(regions.interfaces(self.result, there)), 0)
        _, axes = panels.draw_rows(self.result, scene_ground.FIELDS[:1], [before, after], ["", ""], (3, 3))
        self.assertEqual([len(axis.collections[0].get_paths()) for axis in axes[0]], [64, 32])

    def test_lines(self):
        """Rows of a line's table belong to their increments; a level line has x, an upright one y along it."""
        found = {line.name: line for line in scene_lines.lines(self.result)}
        self.assertEqual([found[name].along[0] for name in ("level", "wall")], ["x", "y"])
        last = self.result.increments[-1]
        rows = found["level"].at(last)
        places = np.column_stack([found["level"].table[axis][rows] for axis in ("x", "y")])
        moved = q8.sample(self.result.coordinates, self.result.connectivity, last.field("node/displacement"), places)
        np.testing.assert_allclose(found["level"].table["displacement_y"][rows], moved[:, 1], atol=1e-9)
        names = [name for _, name in scene_lines.chosen(self.result)]
        self.assertEqual(names, ["dig, 1", "lower, 1", "free, 0.5", "free, 1"])

    def test_sweep(self):
        status, said, errors = call(figures, "runs/sweep", "-o", "figures/sweep", "--only", "boundary_curves")
        self.assertEqual((status, errors, len(said)), (0, [], 1))
        self.assertTrue(said[0].startswith("wrote"), said)


class WhatASceneCanHave(unittest.TestCase):
    def test_a_figure_without_its_data_is_tried(self):
        """The case records lines, but the run has not written their tables: the figure's own reason is told."""
        folder = copy("cut", "tiny")
        with h5py.File(folder / "run.h5", "r+") as file:
            for name in ("line_level", "line_wall"):
                del file[f"tables/{name}"]
        result = Result(folder)
        draw = catalogue.figures_for("a scene", result)["section_lines.png"]
        self.assertRaisesRegex(Missing, "run.h5 has no table of a line", draw, result, Path("cut.png"))

    def test_by_the_case(self):
        """Tunnels are those that lose area, grains are in regions without an elastic material."""
        loss = {"name": "loss", "move": [{"boundary": "opening", "area": "-5 %", "about": "invert"}]}
        rest = {"name": "gravity", "press": [{"boundary": "opening", "at_rest": True}]}
        case = {"region": [{"name": "sand"}], "stage": [rest, loss]}

        def figures_of(more, diameter=True):
            result: Any = SimpleNamespace(case={**case, **more}, geometry={"diameter": 5.0} if diameter else {})
            return set(catalogue.figures_for("a scene", result))

        tunnel, grains = {"ground_reaction.png", "settlement_troughs.png"}, {"void_ratio.png", "grain_rotation.png"}
        self.assertLessEqual(tunnel | grains | {"rve_paths.png", "k0.png"}, figures_of({}))
        self.assertFalse((tunnel | {"rve_paths.png"}) & figures_of({}, diameter=False))
        grown = figures_of({"stage": [{"name": "grow", "move": [{"boundary": "opening", "area": "5 %"}]}]})
        self.assertFalse((tunnel | {"k0.png"}) & grown)
        for elastic in ({"material": "linear_elastic"}, {"region": [{"name": "wall", "elastic": {}}]}):
            self.assertFalse((grains | {"rve_paths.png"}) & figures_of(elastic))
            self.assertLessEqual(tunnel, figures_of(elastic))
        self.assertEqual(
            figures_of({"record": [{"name": "a", "region": ["sand"]}]}) - figures_of({}), {"record_regions.png"}
        )

    def test_of_an_ensemble(self):
        """Ensembles of scenes have no figures of tunnels and specimens, those of other kinds keep all."""
        stages = [{"name": "lower", "move": [{"boundary": "door", "y": "-1 mm"}]}]
        ensemble: Any = SimpleNamespace(case={"kind": "scene", "stage": stages})
        self.assertEqual(set(catalogue.figures_for("an ensemble", ensemble)), {"ensemble_boundaries.png"})
        ensemble.case["kind"] = "tunnel"
        self.assertEqual(len(catalogue.figures_for("an ensemble", ensemble)), 7)

    def test_a_new_figure(self):
        """A figure for which no rule is written yet is tried, of runs as of ensembles."""
        data: Any = SimpleNamespace(case={"kind": "scene", "stage": []})
        self.assertTrue(scene_needs.can_have(data, "new.png"))
        self.assertTrue(scene_needs.ensemble_can_have(data, "ensemble_new.png"))


class OfLaterHolds(unittest.TestCase):
    def test_words(self):
        """From the start, from a stage on, until a stage releases it; points are known by their place."""
        corner = ["4 m", "3 m"]
        case: dict[str, Any] = {
            "support": [{"boundary": ["left", "right"], "fix": "x"}, {"point": "foot", "fix": "xy"}],
            "stage": [
                {"name": "dig", "move": [{"boundary": "face", "x": "0 m"}, {"boundary": "right", "y": "0 m"}]},
                {"name": "prop", "move": [{"point": corner, "x": "0 m"}, {"boundary": "hole", "area": "1 %"}]},
                {"name": "free", "release": [{"point": corner}, {"boundary": "right"}, {"boundary": "left"}]},
                {"name": "again", "move": [{"point": "foot", "y": "1 mm"}]},
            ],
        }
        result: Any = SimpleNamespace(
            case=case, coordinates=np.array([[0.0, 0.0], [4.0, 3.0]]), points={"foot": 0}, boundaries={}
        )
        names = [stage["name"] for stage in case["stage"]]
        found = {hold.name: (hold.words(names), hold.from_start) for hold in scene_holds.holds(result)}
        self.assertEqual(
            found,
            {
                "left": ("held x until stage free", True),
                "right": ("held x until stage free, y from stage dig until stage free", True),
                "point foot": ("held x and y", True),
                "face": ("held x from stage dig on", False),
                "point (4, 3) m": ("held x from stage prop until stage free", False),
                "hole": ("held x and y from stage prop on", False),
            },
        )

    def test_again(self):
        """What is held again after its release has both times; a stage that releases and holds has not let go."""
        hold, free = [{"boundary": "right", "x": "0 m"}], [{"boundary": "right"}]
        stages: list[dict[str, Any]] = [
            {"name": "prop", "move": hold},
            {"name": "out", "release": free},
            {"name": "late", "move": [{"boundary": "right", "x": "0 m", "y": "0 m"}]},
            {"name": "push", "move": hold},
            {"name": "renew", "release": free, "move": hold},
            {"name": "end", "release": free},
        ]

        def words(supports, number):
            case = {"support": supports, "stage": stages[:number]}
            result: Any = SimpleNamespace(case=case, boundaries={}, points={})
            (found,) = scene_holds.holds(result)
            return found.words([stage["name"] for stage in stages]), found.from_start

        fixed = [{"boundary": "right", "fix": "x"}]
        self.assertEqual(words(fixed, 2), ("held x until stage out", True))
        self.assertEqual(words(fixed, 4), ("held x until stage out and from stage late on, y from stage late on", True))
        again = "held x from stage prop until stage out and from stage late"
        self.assertEqual(words([], 4), (f"{again} on, y from stage late on", False))
        self.assertEqual(words([], 5), (f"{again} on, y from stage late until stage renew", False))
        self.assertEqual(words([], 6), (f"{again} until stage end, y from stage late until stage renew", False))

    def test_picture(self):
        """What a later stage holds is hollow: a white line on the boundary, a white triangle."""
        folder = copy("later", "tiny")
        with h5py.File(folder / "run.h5", "r+") as file:
            text = plain(file["input"][()])
            del file["input"]
            more = 'move = [{boundary = "top", y = "0 m"}, {point = ["1 m", "0 m"], x = "0 m"}]'
            file["input"] = f'{text}\n[[stage]]\nname = "late"\nsteps = 1\n{more}\n'
        result = Result(folder)
        with mock.patch.object(scene_ground, "save") as save:
            scene_ground.draw_mesh(result, Path("later.png"))
        figure = save.call_args.args[0]
        labels = {text.get_text() for text in figure.legends[0].get_texts()}
        self.assertLessEqual(
            {
                "door, held y until stage free",
                "top, held y from stage late on",
                "point (1, 0) m, held x from stage late on",
            },
            labels,
        )
        (axis,) = figure.axes
        white = [lines for lines in axis.collections if np.all(lines.get_edgecolor() == 1)]
        self.assertEqual(len(white), 1)
        self.assertEqual({float(y) for path in white[0].get_paths() for y in path.vertices[:, 1]}, {2.0})
        (triangle,) = [line for line in axis.lines if line.get_marker() == "^"]
        self.assertEqual(triangle.get_markerfacecolor(), "white")


class OfAnOpening(unittest.TestCase):
    """A quarter of a hole of radius 2 with the centre (1, 1), whose sides are parabolas."""

    def setUp(self):
        angle = np.linspace(0, np.pi / 2, 9)
        self.points = np.column_stack([1 + 2 * np.cos(angle), 1 + 2 * np.sin(angle)])
        self.centre = np.array([1.0, 1.0])

    def forces(self, pressure):
        """Nodal forces of a pressure on the sides, by three Gauss points a side."""
        found = np.zeros_like(self.points)
        for k in range(0, len(self.points) - 2, 2):
            for s, weight in zip((-np.sqrt(0.6), 0.0, np.sqrt(0.6)), (5 / 9, 8 / 9, 5 / 9)):
                shape = np.array([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2])
                slope = np.array([s - 0.5, -2 * s, s + 0.5]) @ self.points[k : k + 3]
                found[k : k + 3] += weight * pressure * np.outer(shape, [slope[1], -slope[0]])
        return found

    def test_area(self):
        self.assertAlmostEqual(openings.enclosed(self.points, self.centre), np.pi, delta=2e-4)

    def test_pressure(self):
        reaction = self.forces(200e3)
        reaction[-1] += [7e4, 0]  # what holds the symmetry at x = 1 does no work
        fields = {"node/displacement": np.zeros_like(self.points), "node/reaction": reaction}
        result: Any = SimpleNamespace(boundaries={"hole": np.arange(9)}, coordinates=self.points)
        increment: Any = SimpleNamespace(field=lambda name: fields[name])
        motion = scene.Motion("hole", "x", True, ["1 m", "1 m"])
        (found,) = openings.pressure(result, motion, [increment])
        self.assertAlmostEqual(found, 200e3, delta=1)
        result.coordinates = np.vstack([self.points, self.centre])
        result.points = {"eye": 9}
        fields.update({name: np.vstack([values, np.zeros(2)]) for name, values in fields.items()})
        (found,) = openings.pressure(result, scene.Motion("hole", "x", True, "eye"), [increment])
        self.assertAlmostEqual(found, 200e3, delta=1)
        self.assertRaises(Missing, openings.pressure, result, scene.Motion("gap", "x", True), [])


if __name__ == "__main__":
    unittest.main()
