"""Occlusion: drawing and asking in every way, and what is refused."""
import unittest

import numpy as np
import sightline
from support import Case, boxes_of, row_of_things

VIEW = sightline.camera(width=64, height=48)
WALL = np.array([(-9, -9, -5), (9, -9, -5), (9, 9, -5), (-9, 9, -5)], np.float32)
INDICES = np.array([(0, 1, 2), (0, 2, 3)], np.uint32)
# One before the wall and one behind it.
SPHERES = np.array([(0, 0, -3, 0.5), (0, 0, -7, 0.5)], np.float32)
BOXES = np.array([[(-0.5, -0.5, z - 0.5), (0.5, 0.5, z + 0.5)] for z in (-3, -7)])
TRIANGLES = np.array([[(-1, -1, z), (1, -1, z), (0, 1, z)] for z in (-3, -7)], np.float32)


class Draw(Case):
    def setUp(self):
        self.occlusion = sightline.Occlusion()
        self.wall = sightline.OccluderMesh(WALL, INDICES)
        self.assertIsNone(self.occlusion.view)
        self.occlusion.begin(VIEW)

    def test_a_mesh_hides_what_is_behind_it(self):
        self.assertEqual(self.wall.triangles, 2)
        aside = np.eye(4)
        aside[0, 3] = 1000
        for transform, behind in ((None, False), (aside, True)):
            self.occlusion.begin(VIEW)
            self.occlusion.draw_mesh(self.wall, transform)
            self.assertEqual(list(self.occlusion.may_see_boxes(BOXES)), [True, behind])
            self.assertEqual(list(self.occlusion.may_see_spheres(SPHERES)), [True, behind])
            self.assertEqual([self.occlusion.may_see_triangles(t) for t in TRIANGLES], [True, behind])
            self.assertTrue(self.occlusion.may_see_triangles(TRIANGLES))
        self.assertEqual(self.occlusion.may_see_boxes(BOXES).dtype, bool)
        flat = sightline.OccluderMesh(WALL[:, :], INDICES.ravel())
        self.assertEqual(flat.triangles, 2)

    def test_a_wall_seen_from_behind_hides_only_what_its_back_is_drawn_over(self):
        turned = INDICES[:, ::-1].copy()
        for indices, sides, seen in ((INDICES, "front", False), (turned, "front", True), (turned, "both", False),
                                     (turned, np.array([True, False]), True), (turned, np.zeros(2, bool), False)):
            self.occlusion.begin(VIEW)
            self.occlusion.draw_mesh(sightline.OccluderMesh(WALL, indices, sides))
            self.assertEqual(self.occlusion.may_see_boxes(BOXES[1:] * (9, 5, 1))[0], seen)

    def test_occluders_are_made_of_meshes(self):
        steps = np.linspace(-9, 9, 10)
        wall = np.array([(x, y, -5) for y in steps for x in steps], np.float32)
        quads = [(10 * y + x, 10 * y + x + 1, 10 * y + x + 11, 10 * y + x + 10) for y in range(9) for x in range(9)]
        indices = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32)
        made = sightline.Occluder(wall, indices, "front")
        self.assertEqual((made.positions.shape, made.indices.shape, made.boxes.shape), ((4, 3), (2, 3), (0, 2, 3)))
        self.assertEqual((made.solid_triangles, list(made.front_only)), (0, [True, True]))
        self.assertIn("as it is", made.yields)
        self.occlusion.begin(VIEW)
        self.occlusion.draw_mesh(made.mesh())
        self.assertFalse(self.occlusion.may_see_boxes(BOXES[1:])[0])
        # A cube of one box.
        cube = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
        sides = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
        made = sightline.Occluder(cube, sides[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3).astype(np.uint32), most_boxes=1)
        self.assertEqual((len(made.indices), len(made.boxes)), (12, 1))
        self.assertTrue((made.boxes > 0).all() and (made.boxes < 1).all())
        self.assertIn("no triangle", sightline.Occluder(cube[:0], indices[:0]).yields)
        self.refused("bad_mesh", "names no position", sightline.Occluder, cube, indices, index=2)
        self.bad("at most 4096", sightline.Occluder, wall, indices, most_triangles=5000)
        self.bad("positions: expected float32", sightline.Occluder, cube.astype(float), indices)
        for name in ("most_triangles", "most_boxes"):
            self.whole(name, lambda n: sightline.Occluder(wall, indices, **{name: n}))

    def test_boxes_and_spheres_hide_too(self):
        columns = [np.ascontiguousarray(SPHERES[:, i]) for i in range(4)]
        fields = np.zeros(2, [("radius", "f4"), ("centre", "f4", 3)])
        fields["centre"], fields["radius"] = SPHERES[:, :3], SPHERES[:, 3]
        spheres = (SPHERES, sightline.SphereView(SPHERES), sightline.SphereView.arrays(*columns),
                   sightline.SphereView(fields["centre"], fields["radius"]))
        for form in spheres:
            self.occlusion.begin(VIEW)
            self.occlusion.draw_boxes(BOXES[:1])
            self.assertEqual(list(self.occlusion.may_see_spheres(form)), [True, False])
        for nearest in (SPHERES[:1], sightline.SphereView(SPHERES[:1])):
            self.occlusion.begin(VIEW)
            self.occlusion.draw_spheres(nearest)
            self.assertFalse(self.occlusion.may_see_boxes((BOXES[1:] * (0.1, 0.1, 1)))[0])

    def test_what_is_no_box_is_left_out(self):
        for harm in (np.nan, np.inf, -np.inf, 1e12):
            boxes = BOXES.copy()
            boxes[0, 0, 0] = harm
            self.occlusion.draw_boxes(boxes[:1])
            self.assertTrue(self.occlusion.may_see_boxes(BOXES).all())

    def test_objects(self):
        triangles = sightline.OccludeeTriangles()
        triangles.assign(TRIANGLES, np.array([1, 0, 1], np.uint32))
        self.assertEqual((len(triangles), triangles.triangles(2), triangles.triangles(9)), (3, 1, 0))
        self.occlusion.draw_mesh(self.wall)
        objects = np.array([2, 1, 7, 0], np.uint32)
        self.assertEqual(list(self.occlusion.keep_seen(triangles, objects)), [7, 0])
        self.assertEqual(list(objects), [2, 1, 7, 0])
        triangles.set(2, TRIANGLES[0])
        self.assertEqual(list(self.occlusion.keep_seen(triangles, objects)), [2, 7, 0])
        self.refused("bad_mesh", "three corners", triangles.set, 2, TRIANGLES)
        self.refused("bad_argument", "no such object", triangles.set, 3, TRIANGLES[0], index=3)
        self.refused("bad_mesh", "three corners", triangles.assign, TRIANGLES, np.array([3], np.uint32))
        self.bad("corners: expected float32", triangles.assign, TRIANGLES.astype(float), np.array([2], np.uint32))
        self.bad("triangles_per_object: expected uint32", triangles.assign, TRIANGLES, np.array([2]))
        self.whole("object", lambda n: triangles.set(n, TRIANGLES[0]))
        self.whole("object", triangles.triangles)
        self.bad("objects: expected uint32", self.occlusion.keep_seen, triangles, np.array([2.0]))

    def test_nearness(self):
        self.assertTrue(np.isneginf(self.occlusion.read_nearness()).all())
        self.occlusion.draw_mesh(self.wall)
        pixels = self.occlusion.read_nearness()
        self.assertEqual((pixels.shape, pixels.dtype), ((48, 64), np.float32))
        np.testing.assert_allclose(pixels, 0.2, rtol=1e-3)

    def test_every_place_of_the_image_and_coarser_pixels(self):
        for coverage in ("centres", "area"):
            for scale in (1, 2, 4):
                self.occlusion.begin(VIEW, coverage, scale)
                self.occlusion.draw_mesh(self.wall)
                self.assertEqual(list(self.occlusion.may_see_boxes(BOXES)), [True, False])
                self.assertEqual(self.occlusion.read_nearness().shape, (48, 64))
        self.bad("coverage: expected", self.occlusion.begin, VIEW, "all")
        self.refused("bad_argument", "scale", self.occlusion.begin, VIEW, "area", 3)
        self.whole("scale", lambda n: self.occlusion.begin(VIEW, "area", n))

    def test_before_begin(self):
        fresh = sightline.Occlusion()
        for call, arg in ((fresh.draw_boxes, BOXES), (fresh.draw_spheres, SPHERES), (fresh.draw_mesh, self.wall)):
            self.refused("stale_buffer", "never begun", call, arg)
        self.refused("stale_buffer", "never begun", fresh.read_nearness)
        self.assertTrue(fresh.may_see_boxes(BOXES).all() and fresh.may_see_spheres(SPHERES).all())
        self.refused("bad_view", "too large", fresh.begin, sightline.camera(width=8193, height=2))
        self.assertIsNone(fresh.view)
        fresh.begin(VIEW)
        np.testing.assert_array_equal(fresh.view.eye_to_clip, VIEW.eye_to_clip)

    def test_refusals(self):
        mesh = sightline.OccluderMesh
        self.bad("positions: expected float32", mesh, WALL.astype(float), INDICES)
        self.bad("positions: expected float32", mesh, WALL.ravel(), INDICES)
        self.bad("positions: expected float32", mesh, None, INDICES)
        self.bad("indices: expected uint32", mesh, WALL, INDICES.astype(int))
        self.bad("sides: expected", mesh, WALL, INDICES, "back")
        self.bad("sides: expected", mesh, WALL, INDICES, np.array([1, 0]))
        self.refused("bad_mesh", "as many sides", mesh, WALL, INDICES, np.ones(3, bool), index=3)
        self.refused("bad_mesh", "names no position", mesh, WALL[:3], INDICES, index=5)
        broken = WALL.copy()
        broken[1, 2] = np.nan
        self.refused("bad_mesh", "not finite", mesh, broken, INDICES, index=1)
        # A copy that nobody has memory for: NumPy's own error.
        self.assertRaises(MemoryError, mesh, np.broadcast_to(np.zeros(3, np.float32), (1 << 58, 3)), INDICES)
        self.assertRaises(MemoryError, mesh, WALL, np.broadcast_to(np.uint32(0), 1 << 58))
        self.assertRaises(MemoryError, self.occlusion.draw_mesh, self.wall, np.broadcast_to(np.eye(4), (1 << 54, 4, 4)))
        with self.assertRaisesRegex(ValueError, "three indices"):
            mesh(WALL, INDICES.ravel()[:5])
        for transform in (np.full((4, 4), np.nan), np.diag([1, 1, 1, 2])):
            self.bad("affine", self.occlusion.draw_mesh, self.wall, transform)
        self.bad("transform: expected shape (4, 4)", self.occlusion.draw_mesh, self.wall, np.eye(3))
        for call in (self.occlusion.draw_spheres, self.occlusion.may_see_spheres):
            for spheres in (SPHERES.astype(float), SPHERES[:, :3], SPHERES[::-1], np.asfortranarray(SPHERES), BOXES, None,
                            SPHERES.ravel(), SPHERES[0, 0], np.array(1)):
                self.bad("spheres: expected", call, spheres)
            self.bad("stride too short", call, np.broadcast_to(SPHERES[:1], (3, 4)))
        for call in (self.occlusion.draw_boxes, self.occlusion.may_see_boxes):
            self.bad("boxes: expected", call, SPHERES)
            self.bad("stride too short", call, np.broadcast_to(BOXES[:1], (3, 2, 3)))
        self.bad("spheres: expected", sightline.SphereView, SPHERES[:, :3], SPHERES[:1, 3])
        self.bad("spheres: expected", sightline.SphereView, SPHERES[:, :3], SPHERES[:, 3].copy())
        self.bad("arrays: expected", sightline.SphereView.arrays, *[np.zeros(2)] * 4)
        self.bad("corners: expected float32", self.occlusion.may_see_triangles, TRIANGLES.astype(float))


if __name__ == "__main__":
    unittest.main()
