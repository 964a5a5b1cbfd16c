"""The figures' own arithmetic: eq. (21) puts the inflection at x = i, the fit finds known troughs, Q8 sampling is
exact."""

import os
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(os.environ["VOUSSOIR_ROOT"]) / "python"))

import numpy as np
from voussoir.figures import q8, trough_fit


class ModifiedGauss(unittest.TestCase):
    def test_inflection_is_at_i(self):
        inflection, step = 4.0, 1e-3
        for alpha in (0.1, 0.3, 0.5, 1.0, 2.0, 5.0):

            def curvature(x, alpha=alpha):
                s = trough_fit.modified_gauss(x + step * np.array([-1, 0, 1]), 1.0, inflection, alpha)
                return (s[0] - 2 * s[1] + s[2]) / step**2

            # Differences of second order: curvature is exact to about 1e-6, its slope here is above 1e-3.
            self.assertLess(curvature(inflection - 0.05), 0)
            self.assertGreater(curvature(inflection + 0.05), 0)

    def test_half_is_the_gauss_curve(self):
        x = np.linspace(0, 20, 50)
        np.testing.assert_allclose(trough_fit.modified_gauss(x, 0.2, 6.0, 0.5), 0.2 * np.exp(-(x**2) / 72), rtol=1e-12)

    def test_fit_finds_known_troughs_on_uneven_points(self):
        x = 35 * np.linspace(0, 1, 40) ** 1.7
        for largest, inflection, alpha in ((0.3, 6.0, 0.5), (0.05, 9.0, 0.2), (1.2, 2.5, 3.0), (-0.01, 5.0, 1.0)):
            fit = trough_fit.fit(x, trough_fit.modified_gauss(x, largest, inflection, alpha))
            np.testing.assert_allclose(
                (fit.largest, fit.inflection, fit.alpha), (largest, inflection, alpha), rtol=1e-3
            )
            self.assertLess(fit.misfit, 1e-5)

    def test_a_plug_with_a_foot_is_told(self):
        x = np.linspace(0, 35, 80)
        gauss, plug = trough_fit.modified_gauss(x, 0.1, 6.0, 0.5), 0.5 * (x < 2.5) + 0.1 * np.exp(-x / 10)
        self.assertTrue(trough_fit.fit(x, gauss).good)
        self.assertFalse(trough_fit.fit(x, plug).good)
        pointed = trough_fit.fit(x, np.exp(-np.sqrt(x)))
        self.assertTrue(pointed.at_bound and not pointed.good)

    def test_a_flat_surface_is_no_error(self):
        fit = trough_fit.fit(np.linspace(0, 35, 20), np.zeros(20))
        self.assertEqual(fit.largest, 0)


class Q8(unittest.TestCase):
    # One element with straight, skew sides.
    corners = np.array([[0, 0], [2, 0.3], [2.4, 2], [-0.2, 1.5]])
    coordinates = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
    connectivity = np.arange(8)[None]

    def test_linear_fields_are_sampled_exactly(self):
        values = 3 + 2 * self.coordinates[:, :1] - self.coordinates[:, 1:]
        points = np.array([[1.0, 1.0], [0.1, 0.2], [2.0, 0.3]])
        np.testing.assert_allclose(
            q8.sample(self.coordinates, self.connectivity, values, points)[:, 0],
            3 + 2 * points[:, 0] - points[:, 1],
            atol=1e-9,
        )

    def test_outside_is_nan(self):
        outside = np.array([[-0.15, 0.1], [5.0, 5.0]])
        self.assertTrue(np.isnan(q8.sample(self.coordinates, self.connectivity, np.ones((8, 1)), outside)).all())

    def test_patches_cover_the_element_and_hold_their_points(self):
        def area(p):
            return 0.5 * np.sum(p[:, 0] * np.roll(p[:, 1], -1) - np.roll(p[:, 0], -1) * p[:, 1])

        patches = q8.gauss_patches(self.coordinates, self.connectivity)[0]
        self.assertAlmostEqual(sum(area(p) for p in patches), area(self.corners), places=12)
        points = q8.gauss_coordinates(self.coordinates, self.connectivity)[0]
        for patch, point, corner in zip(patches, points, self.corners):
            np.testing.assert_array_equal(patch[0], corner)
            edges = np.roll(patch, -1, axis=0) - patch
            to_point = point - patch
            self.assertTrue(np.all(edges[:, 0] * to_point[:, 1] - edges[:, 1] * to_point[:, 0] > 0))


if __name__ == "__main__":
    unittest.main()
