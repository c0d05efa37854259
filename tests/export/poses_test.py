# SPDX-License-Identifier: MIT
"""Poses: nearest rotation, inverse, re-anchoring, spread of units."""

import unittest

import setting  # noqa: F401
import numpy as np
from contract.poses import (compose, inverse, log_median_ratio, nearest_rotation, reanchor,
                            unit_spread)


def turn(axis: int, angle: float) -> np.ndarray:
    """Rotation about one axis."""
    a, b = [k for k in range(3) if k != axis]
    matrix = np.eye(3)
    matrix[a, a] = matrix[b, b] = np.cos(angle)
    matrix[a, b], matrix[b, a] = -np.sin(angle), np.sin(angle)
    return matrix


def pose(rotation: np.ndarray, translation) -> np.ndarray:
    return np.concatenate([rotation, np.reshape(translation, (3, 1))], axis=1)


class Poses(unittest.TestCase):
    def test_a_stretched_rotation_becomes_that_rotation(self):
        rotation = turn(0, 0.3) @ turn(2, -1.1)
        np.testing.assert_allclose(nearest_rotation(1.7 * rotation), rotation, atol=1e-12)

    def test_a_mirrored_matrix_becomes_a_proper_rotation(self):
        found = nearest_rotation(np.diag([1.0, 1.0, -0.2]))
        self.assertAlmostEqual(np.linalg.det(found), 1.0)
        np.testing.assert_allclose(found, np.eye(3), atol=1e-12)

    def test_a_pose_after_its_inverse_is_the_identity(self):
        T = pose(turn(1, 0.7), [1.0, -2.0, 3.0])
        np.testing.assert_allclose(compose(inverse(T), T), np.eye(3, 4), atol=1e-12)

    def test_anchored_poses_do_not_depend_on_the_models_world(self):
        poses = np.stack([pose(turn(1, 0.1 * k), [k, 0.0, 2.0]) for k in range(3)])
        world = pose(turn(0, 1.2), [5.0, 6.0, 7.0])
        moved = compose(world[None], poses)
        np.testing.assert_allclose(reanchor(moved), reanchor(poses), atol=1e-12)

    def test_the_first_anchored_pose_is_exactly_the_identity(self):
        poses = np.stack([pose(turn(2, 0.4), [0.1, 0.2, 0.3])] * 2)
        self.assertTrue((reanchor(poses)[0] == np.eye(3, 4)).all())

    def test_a_camera_in_front_of_the_first_has_positive_z(self):
        poses = np.stack([pose(turn(1, np.pi), [0, 0, 0]), pose(turn(1, np.pi), [0, 0, -2])])
        np.testing.assert_allclose(reanchor(poses)[1, :, 3], [0, 0, 2], atol=1e-12)


class Units(unittest.TestCase):
    def test_the_ratio_of_two_depth_maps_ignores_pixels_without_depth(self):
        near = np.array([[1.0, 2.0], [0.0, 4.0]])
        far = np.array([[2.0, 4.0], [9.0, 0.0]])
        self.assertAlmostEqual(log_median_ratio(far, near), np.log(2))

    def test_maps_with_no_pixel_in_common_have_no_ratio(self):
        self.assertTrue(np.isnan(log_median_ratio(np.array([1.0, 0.0]), np.array([0.0, 1.0]))))

    def test_equal_units_do_not_spread(self):
        self.assertEqual(unit_spread([3.0, 3.0, 3.0]), 0.0)

    def test_the_spread_does_not_depend_on_the_unit(self):
        ratios = np.exp([0.0, 0.1, -0.1, 0.3, -0.3])
        self.assertAlmostEqual(unit_spread(ratios), 0.1)
        self.assertAlmostEqual(unit_spread(17 * ratios), 0.1)


if __name__ == "__main__":
    unittest.main()
