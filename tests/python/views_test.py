"""Cameras and their matrices, and the module itself."""
import unittest

import numpy as np
import sightline
from support import Case


class Module(Case):
    def test_says_what_it_is(self):
        self.assertRegex(sightline.__version__, r"^\d+\.\d+\.\d+$")
        self.assertTrue(issubclass(sightline.Refused, ValueError))
        self.assertEqual((sightline.handle_dtype.itemsize, sightline.MAX_VIEWS), (8, 8))
        for name in ("World", "Culler", "CullView", "BoxView", "SphereView", "View", "Occlusion", "OccluderMesh",
                     "OccludeeTriangles", "Frustum", "BoxBvh", "CellPvs"):
            self.assertTrue(getattr(sightline, name).__doc__, name)


class Camera(Case):
    def test_matrices_are_row_column(self):
        view = sightline.camera(eye=(1, 2, 3), width=64, height=48)
        self.assertEqual((view.width, view.height, view.origin), (64, 48, (0, 0, 0)))
        np.testing.assert_allclose(view.world_to_eye @ [1, 2, 3, 1], [0, 0, 0, 1], atol=1e-6)
        clip = view.eye_to_clip @ [0, 0, -0.1, 1]
        np.testing.assert_allclose(clip, [0, 0, 0, 0.1], atol=1e-6)
        same = sightline.View(view.world_to_eye, view.eye_to_clip, 64, 48)
        np.testing.assert_array_equal(same.world_to_eye, view.world_to_eye)
        np.testing.assert_array_equal(same.eye_to_clip, view.eye_to_clip)

    def test_projections(self):
        flat = sightline.camera(orthographic_height=20)
        np.testing.assert_allclose((flat.eye_to_clip @ [0, 10, -5, 1])[[1, 3]], [1, 1])
        reversed_depth = sightline.camera(reversed_depth=True, far=np.inf)
        clip = reversed_depth.eye_to_clip @ [0, 0, -0.1, 1]
        np.testing.assert_allclose(clip[2] / clip[3], 1)
        shifted = sightline.camera(shift=(0.5, 0))
        self.assertNotEqual(shifted.eye_to_clip[0, 2], 0)

    def test_far_out_is_as_precise_as_near(self):
        near, far = sightline.camera(eye=(0.25, 0, 0)), sightline.camera(eye=(1e7 + 0.25, 0, 0), origin=(1e7, 0, 0))
        np.testing.assert_array_equal(near.world_to_eye, far.world_to_eye)

    def test_refusals(self):
        camera = sightline.camera
        self.refused("bad_view", "eye is not finite", camera, eye=(np.nan, 0, 0))
        self.refused("bad_view", "direction is not finite", camera, forward=(np.inf, 0, 0))
        self.refused("bad_view", "parallel", camera, up=(0, 0, 1))
        self.refused("bad_view", "field of view", camera, fov=9)
        self.refused("bad_view", "near", camera, near=0)
        self.refused("bad_view", "near", camera, near=np.nan)
        self.refused("bad_view", "origin", camera, origin=(1e12, 0, 0), eye=(1e12, 0, 0))
        for width in (0, -1, 16385, 1 << 40):
            self.refused("bad_view", "pixels", camera, width=width)
        self.bad("eye: expected three numbers", camera, eye=(1, 2))
        self.bad("up: expected three numbers", camera, up="north")
        self.bad("shift: expected two numbers", camera, shift=(1, 2, 3))
        view, one = sightline.View, np.eye(4)
        self.bad("world_to_eye: expected shape (4, 4)", view, np.eye(3), one, 4, 4)
        self.bad("eye_to_clip: expected shape (4, 4)", view, one, None, 4, 4)
        self.refused("bad_view", "singular", view, one, np.zeros((4, 4)), 4, 4)
        self.refused("bad_view", "finite", view, np.full((4, 4), np.nan), one, 4, 4)
        self.refused("bad_view", "origin", view, one, one, 4, 4, origin=(1e12, 0, 0))


if __name__ == "__main__":
    unittest.main()
