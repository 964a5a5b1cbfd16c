"""The judgements of the study's trends, and the places they look at, on data whose answers are known."""

import os
import sys
import tomllib
import unittest
from pathlib import Path
from types import SimpleNamespace
from typing import Any

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import numpy as np
from voussoir.figures import chains, points, q8, settlements, tensors, trends
from voussoir.figures.packings import Packing
from voussoir.figures.result import Result
from voussoir.files import Table

ROOT = Path(os.environ["VOUSSOIR_ROOT"])
LOSS = np.linspace(0, 0.2, 81)


class Settlements(unittest.TestCase):
    def test_growth_is_the_slope(self):
        np.testing.assert_allclose(settlements.growth(LOSS, 3 * LOSS + 0.1), 3, rtol=1e-9)
        parabola = settlements.growth(LOSS, LOSS**2)
        np.testing.assert_allclose(parabola[10:-10], 2 * LOSS[10:-10], rtol=1e-9)  # even windows

    def test_slowing(self):
        slows, straight = 5 * (1 - np.exp(-LOSS / 0.05)), 5 * LOSS
        self.assertEqual(trends.settlement_slows(LOSS, {0.0: slows, 1.0: straight}, 5.0).verdict, trends.SEEN)
        self.assertEqual(trends.settlement_slows(LOSS, {0.0: slows, 0.5: straight}, 5.0).verdict, trends.NOT_SEEN)
        self.assertEqual(trends.settlement_slows(LOSS[:30], {0.0: slows[:30]}, 5.0).verdict, trends.NOT_REACHED)

    def test_acceleration(self):
        late = np.where(LOSS < 0.14, LOSS, 0.14 + 3 * (LOSS - 0.14))
        self.assertEqual(trends.surface_accelerates(LOSS, late, 1.0).verdict, trends.SEEN)
        self.assertEqual(trends.surface_accelerates(LOSS, LOSS, 1.0).verdict, trends.NOT_SEEN)
        self.assertIn("1.000 at 10 %", trends.surface_accelerates(LOSS, late, 1.0).numbers)


class Troughs(unittest.TestCase):
    def test_surface_width(self):
        width = np.where(LOSS < 0.05, 0.6, 0.3)
        self.assertEqual(trends.surface_width_in_range(LOSS, width, 0.25, 0.45).verdict, trends.SEEN)
        self.assertEqual(trends.surface_width_in_range(LOSS, width + 0.2, 0.25, 0.45).verdict, trends.NOT_SEEN)

    def test_narrowing(self):
        self.assertEqual(trends.troughs_narrow(LOSS, {0.0: 6 - 10 * LOSS}).verdict, trends.SEEN)
        self.assertEqual(trends.troughs_narrow(LOSS, {0.0: 6 - 10 * LOSS, 1.0: 2 + LOSS}).verdict, trends.NOT_SEEN)

    def test_misfit(self):
        good, bad = {0.0: np.array([0.01, 0.02])}, {0.0: np.array([0.01, 0.02]), 1.0: np.array([0.01, 0.2])}
        self.assertEqual(trends.gauss_fits(good, {0.0: np.array([True, False])}).verdict, trends.SEEN)
        self.assertIn("bound in 50 %", trends.gauss_fits(good, {0.0: np.array([True, False])}).numbers)
        self.assertEqual(trends.gauss_fits(bad, {0.0: np.array([True, False])}).verdict, trends.NOT_SEEN)


class Bands(unittest.TestCase):
    def test_height_beside_and_at_the_axis(self):
        height, x = np.array([0.2, 0.5, 0.8, -0.3]), np.array([3.0, 0.1, 3.0, 3.0])
        strain = np.array([0.1, 0.1, 0.01, 0.5])
        self.assertEqual(trends.band_height(height, x, strain, 1.25, 0.05), (0.2, 0.5))
        self.assertEqual(trends.band_height(height, x, 0 * strain, 1.25, 0.05), (0.0, 0.0))

    def test_verdicts_by_cover(self):
        for ratio, reach, expected in (
            (2, (0.95, 1.0), trends.SEEN),
            (2, (0.6, 0.5), trends.NOT_SEEN),
            (3, (0.5, 0.6), trends.SEEN),
            (3, (1.0, 1.0), trends.NOT_SEEN),
            (3, (0.5, 0.0), trends.NOT_SEEN),
            (4, (0.4, 0.3), trends.SEEN),
            (4, (0.9, 0.3), trends.NOT_SEEN),
        ):
            self.assertEqual(trends.bands({0.1: (0.1, 0.1), 0.2: reach}, ratio, 0.05).verdict, expected, (ratio, reach))
        self.assertEqual(trends.bands({0.1: (0.1, 0.1)}, 2, 0.05).verdict, trends.NOT_REACHED)


class Stresses(unittest.TestCase):
    def test_above_and_beside(self):
        up, down = 1 + LOSS * 5, 1 - LOSS * 3
        self.assertEqual(trends.stresses_above(LOSS, up, down).verdict, trends.SEEN)
        self.assertEqual(trends.stresses_above(LOSS, down, up).verdict, trends.NOT_SEEN)
        self.assertEqual(trends.stresses_beside(LOSS, down, up).verdict, trends.SEEN)
        self.assertIn("1 %: 0.97 and 1.05", trends.stresses_beside(LOSS, down, up).numbers)

    def test_reaction(self):
        recovers = np.where(LOSS < 0.05, 1 - 18 * LOSS, 0.1 + (LOSS - 0.05))
        falls = np.exp(-LOSS / 0.02)
        self.assertEqual(trends.reaction(LOSS, recovers, "dense sand").verdict, trends.SEEN)
        self.assertIn("minimum 0.100 at V_l = 5 %", trends.reaction(LOSS, recovers, "dense sand").numbers)
        self.assertEqual(trends.reaction(LOSS, falls, "dense sand").verdict, trends.NOT_SEEN)
        self.assertEqual(trends.reaction(LOSS[:40], falls[:40], "dense sand").verdict, trends.NOT_REACHED)
        self.assertEqual(trends.reaction(LOSS, falls, "medium dense sand").verdict, trends.SEEN)
        self.assertEqual(trends.reaction(LOSS, recovers, "medium dense sand").verdict, trends.NOT_SEEN)
        self.assertEqual(trends.reaction(LOSS[:5], falls[:5], "medium dense sand").verdict, trends.NOT_REACHED)

    def test_principal_directions(self):
        vertical, horizontal, shear = np.array([[-1.0, -3, 0], [-3, -1, 0], [-2, -2, 1]])
        self.assertAlmostEqual(float(tensors.major_from_vertical(vertical)), 0)
        self.assertAlmostEqual(abs(float(tensors.major_from_vertical(horizontal))), np.pi / 2)
        # Tension positive: +xy shear compresses the other diagonal, the one from upper left to lower right.
        self.assertAlmostEqual(float(tensors.major_from_vertical(shear)), np.pi / 4)
        np.testing.assert_allclose(
            tensors.axis_angle(np.radians([95, -95, 90, -90])), np.radians([-85, 85, 90, 90]), atol=1e-12
        )

    def test_fabric_is_an_axis(self):
        angles = np.radians([88.0, 10, -89])
        same = {0.1: angles}, {0.1: tensors.axis_angle(angles + np.radians(6))}
        self.assertEqual(trends.follows_fabric(*same).verdict, trends.SEEN)
        self.assertIn("10 %: 6 deg, 1.00", trends.follows_fabric(*same).numbers)
        self.assertEqual(trends.follows_fabric({0.1: angles}, {0.1: angles + np.pi / 2}).verdict, trends.NOT_SEEN)


class Paths(unittest.TestCase):
    @staticmethod
    def path(peak, softens):
        """q/p that falls until 2 %, then rises to 0.7 at the peak."""
        return np.interp(LOSS, [0, 0.02, peak, 0.2], [0.5, 0.1, 0.7, 0.5 if softens else 0.7])

    def test_linear_fall(self):
        self.assertEqual(trends.falls_linearly(LOSS, {"Aa": self.path(0.06, True)}).verdict, trends.SEEN)
        bent = np.interp(LOSS, [0, 0.01, 0.02, 0.2], [0.5, 0.1, 0.5, 0.5])
        self.assertEqual(trends.falls_linearly(LOSS, {"Aa": bent}).verdict, trends.NOT_SEEN)
        self.assertEqual(trends.falls_linearly(LOSS, {"Aa": 0.1 + LOSS}).verdict, trends.NOT_SEEN)

    def test_peaks(self):
        loss, value, fell = trends.peak_after_unloading(LOSS, self.path(0.06, True))
        self.assertAlmostEqual(loss, 0.06)
        self.assertAlmostEqual(value, 0.7)
        self.assertTrue(fell)
        self.assertFalse(trends.peak_after_unloading(LOSS, self.path(0.06, False))[2])
        opened = np.where((LOSS > 0.1) & (LOSS < 0.12), np.nan, self.path(0.06, True))
        self.assertAlmostEqual(trends.peak_after_unloading(LOSS, opened)[1], 0.7)

    def test_order(self):
        ordered = {"Aa": self.path(0.05, True), "Ab": self.path(0.1, True), "Ac": self.path(0.15, False)}
        self.assertEqual(trends.softening_order(LOSS, ordered).verdict, trends.SEEN)
        early = {name: ratio[:30] for name, ratio in ordered.items()}
        self.assertEqual(trends.softening_order(LOSS[:30], early).verdict, trends.NOT_REACHED)
        mixed = {**ordered, "Aa": self.path(0.12, True)}
        self.assertEqual(trends.softening_order(LOSS, mixed).verdict, trends.NOT_SEEN)
        self.assertEqual(trends.softening_order(LOSS, mixed).where(False, "elsewhere").verdict, trends.NOT_APPLICABLE)
        self.assertEqual(trends.no_softening(LOSS, ordered, "gravel").verdict, trends.NOT_SEEN)
        self.assertEqual(trends.no_softening(LOSS, {"Aa": self.path(0.05, False)}, "gravel").verdict, trends.SEEN)
        self.assertEqual(
            trends.no_softening(LOSS[:9], {"Aa": self.path(0.05, False)[:9]}, "gravel").verdict, trends.NOT_REACHED
        )

    def test_contraction_at_the_end(self):
        contracts, dilates = {"Ab": LOSS, "Ac": 2 * LOSS}, {"Ab": LOSS, "Ac": 0.02 - LOSS}
        self.assertEqual(trends.ends_contracted(LOSS, contracts).verdict, trends.SEEN)
        self.assertEqual(trends.ends_contracted(LOSS, dilates).verdict, trends.NOT_SEEN)
        self.assertEqual(
            trends.ends_contracted(LOSS[:9], {n: v[:9] for n, v in contracts.items()}).verdict, trends.NOT_REACHED
        )

    def test_soil_as_the_case_tells(self):
        """The name of the soil is the study's only where grading and density are; what the trends are compared with is
        the study's soil that is nearest."""

        def expect(name, nearest, **case):
            result = Result.__new__(Result)  # without a file
            result.case = case
            self.assertEqual((result.soil, result.nearest_soil), (name, nearest), case)

        expect("dense sand", "dense sand")
        expect("own gravel", "gravel", soil={"sizes": ["4 mm", "20 mm"], "passing": [0, 1]})
        expect("own gravel", "gravel", soil={"sizes": ["0.4 cm", "2 cm"], "passing": [0, 1]})
        expect("own sand", "dense sand", soil={"size_minimum": "1 mm"})
        expect("dense sand", "dense sand", soil={"sizes": ["2 mm", "0.475 cm"], "passing": [0, "100 %"]})
        expect("own sand", "dense sand", soil={"sizes": ["2 mm", "3 mm", "4.75 mm"], "passing": [0, 0.9, 1]})
        gravel = tomllib.loads((ROOT / "cases/soils/cpg_d.toml").read_text())
        expect("gravel", "gravel", **gravel)
        gravel["soil"]["passing"][2] = 0.4
        expect("own gravel", "gravel", **gravel)
        expect("medium dense sand", "medium dense sand", packing={"consolidation_friction": 0.45})
        rolling = {"consolidation_friction": 0.45, "consolidation_rolling": True}
        expect("own sand", "medium dense sand", packing=rolling)
        expect("own sand", "medium dense sand", packing={"consolidation_friction": 0.16})
        expect("own sand", "medium dense sand", packing={"void_ratio": 0.234})
        expect("medium dense sand", "medium dense sand", packing={"void_ratio": 0.25})
        expect("own sand", "dense sand", packing={"file": "some_particles.csv"})
        expect("no grains", "no grains", material="linear_elastic")

    def test_the_packing_tells_its_soil(self):
        def name(labels, void_ratio, **numbers):
            packing = Packing.__new__(Packing)  # without a file
            packing.radius, packing.cell = np.array([1.02e-3, 2.3e-3]), np.eye(2)
            packing.labels = {"soil.size_minimum": "2 mm", "soil.size_maximum": "4.75 mm"} if labels is None else labels
            packing.numbers = {"void_ratio": void_ratio, **numbers}
            return packing.soil

        self.assertEqual(name(None, 0.14, consolidation_friction=0), "dense sand")
        self.assertEqual(name(None, 0.21, consolidation_friction=0.45), "medium dense sand")
        self.assertEqual(name(None, 0.255, consolidation_friction=0.43), "medium dense sand")
        self.assertEqual(name(None, 0.234, consolidation_friction=0.3), "own sand")
        self.assertEqual(name(None, 0.234, consolidation_friction=0.45, consolidation_rolling=1), "own sand")
        self.assertEqual(name({}, 0.184), "own sand")
        curve = {"soil.sizes": "[2 mm, 4.75 mm]", "soil.passing": "[0, 1]"}
        self.assertEqual(name(curve, 0.184), "dense sand")
        self.assertEqual(name(curve | {"soil.passing": "[0.1, 1]"}, 0.184), "own sand")

    def test_the_foot_says_of_which_soil_the_scatter_is(self):
        result = Result.__new__(Result)
        scatter = {name: np.array([0.1]) for name in ("settlement", "reaction", "k0")}
        result.tables = {"draw_scatter": Table(scatter)}
        result.case = {}
        self.assertIn("K0 by 10 % (standard deviations, docs", result.draw_note())
        result.case = {"packing": {"void_ratio": 0.234}}
        self.assertIn("(standard deviations in dense sand, not in this soil, docs", result.draw_note())

    def test_contraction(self):
        until = lambda v: np.interp(LOSS, [0, v, 0.2], [0, 0.01, -0.01])  # noqa: E731
        self.assertEqual(trends.contracts_until(LOSS, until(0.15)).verdict, trends.SEEN)
        self.assertEqual(trends.contracts_until(LOSS, until(0.05)).verdict, trends.NOT_SEEN)
        self.assertEqual(trends.contracts_until(LOSS[:40], until(0.15)[:40]).verdict, trends.NOT_REACHED)

    def test_coarse_runs_reach_no_verdict(self):
        coarse = np.array([0, 0.025, 0.05, 0.075, 0.1])
        falls = {"Aa": 1 - coarse}
        for trend in (
            trends.falls_linearly(coarse, falls),
            trends.falls_linearly(np.array([0, 0.02, 0.1]), {"Aa": np.array([1, 0.9, 0.8])}),
            trends.settlement_slows(coarse, {0.0: coarse}, 5.0),
            trends.surface_accelerates(np.array([0, 0.1, 0.2]), np.array([0, 0.1, 0.3]), 5.0),
            trends.troughs_narrow(coarse[1:], {0.0: 6 - coarse[1:]}),
            trends.surface_width_in_range(np.array([0.2]), np.array([0.3]), 0.25, 0.45),
            trends.stresses_above(np.array([0, 0.2]), np.array([1.0, 2]), np.array([1.0, 0.5])),
            trends.stresses_beside(coarse, 1 - coarse, 1 + coarse),
            trends.reaction(np.array([0, 0.1, 0.2]), np.array([1, 0.1, 0.5]), "dense sand"),
            trends.softening_order(np.array([0, 0.1, 0.2]), {"Aa": np.array([0.5, 0.1, 0.7])}),
            trends.contracts_until(np.array([0, 0.2]), np.array([0, 0.1])),
        ):
            self.assertEqual(trend.verdict, trends.NOT_REACHED, trend)
        finer = trends.stresses_beside(np.array([0, 0.01, 0.02, 0.1]), np.array([1, 0.95, 0.9, 0.8]), np.full(4, 1.1))
        self.assertEqual(finer.verdict, trends.SEEN)
        self.assertNotIn("5 %", finer.numbers)  # 8 % lie between the states there

    def test_points_that_are_not_compressed(self):
        open_ = np.full_like(LOSS, np.nan)
        for ratios in ({}, {"Aa": open_}):
            self.assertEqual(trends.falls_linearly(LOSS, ratios).verdict, trends.NO_DATA)
            self.assertEqual(trends.softening_order(LOSS, ratios).verdict, trends.NO_DATA)
            self.assertEqual(trends.no_softening(LOSS, ratios, "gravel").verdict, trends.NO_DATA)
        self.assertEqual(trends.ends_contracted(LOSS, {}).verdict, trends.NO_DATA)
        both = trends.falls_linearly(LOSS, {"Aa": open_, "Ab": self.path(0.06, True)})
        self.assertEqual(both.verdict, trends.SEEN)
        self.assertIn("Aa: hardly compressed", both.numbers)

    def test_localisation(self):
        random = np.random.default_rng(1)
        strain = random.random(1000)
        self.assertEqual(trends.localise_together(strain, -strain, strain**3).verdict, trends.SEEN)
        self.assertEqual(
            trends.localise_together(strain, random.random(1000), random.random(1000)).verdict, trends.NOT_SEEN
        )


class Places(unittest.TestCase):
    """Two elements side by side, 2 m wide and 2 m high."""

    def setUp(self):
        xy: dict[tuple, int] = {}
        corners = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(2, 0), (4, 0), (4, 2), (2, 2)]]
        connectivity = []
        for quad in corners:
            middle = [tuple((np.array(a) + b) / 2) for a, b in zip(quad, quad[1:] + quad[:1])]
            connectivity.append([xy.setdefault(tuple(map(float, p)), len(xy)) for p in (*quad, *middle)])
        self.result: Any = SimpleNamespace(coordinates=np.array(list(xy)), connectivity=np.array(connectivity))

    def test_level_line(self):
        line = points.LevelLine(self.result, 1.2)
        np.testing.assert_allclose(line.x, [1, 3], atol=0.11)
        gauss = q8.gauss_coordinates(self.result.coordinates, self.result.connectivity)
        np.testing.assert_allclose(line.of(gauss)[:, 1], 1.2, atol=1e-6)  # a field linear in y
        self.assertEqual(len(points.LevelLine(self.result, 1.2, width=2.0).x), 1)

    def test_points_on_a_level(self):
        chosen = points.on_level(self.result, 0.3)
        where = points.original_points(self.result)[chosen]
        self.assertEqual(len(chosen), 4)
        self.assertTrue(np.all(where[:, 1] < 1) and np.all(np.diff(where[:, 0]) > 0))

    def test_fields_are_held_outside_the_points(self):
        np.testing.assert_allclose(q8.gauss_weights([[-1, -1], [0, 0]]), np.array([[1, 0, 0, 0], [0.25] * 4]))


class Chains(unittest.TestCase):
    def test_compression_is_positive(self):
        # Grain j lies to the right of i and pushes i to the left.
        snapshot = {"branch": np.array([[2.0, 0.0]]), "force": np.array([[-3.0, 0.5]])}
        np.testing.assert_allclose(chains.normal_forces(snapshot), [3.0])


if __name__ == "__main__":
    unittest.main()
