"""What culls did in random worlds, as numbers and boxes, held against the culls themselves."""
import unittest

import numpy as np
import sightline
from support import Case


class Inspect(Case):
    def test_counts_are_those_of_the_cull(self):
        inspector, culler = sightline.CullInspector(), sightline.Culler()
        dropped = 0
        for seed in range(300):
            random = np.random.default_rng(seed)
            world, plain = sightline.World(), sightline.World()
            low = random.uniform(-40, 40, (200, 3))
            boxes = np.stack([low, low + random.uniform(0, 6, (200, 3))], 1)
            world.insert(boxes, layers=(1 << random.integers(0, 3, 200)).astype(np.uint32))
            plain.insert(boxes)
            camera = sightline.camera(eye=tuple(random.uniform(-30, 30, 3)), forward=tuple(random.normal(size=3)))
            view = sightline.CullView(camera, layers=int(random.integers(1, 8)))
            (stats,), shapes = inspector.inspect(world, view)
            self.assertEqual(stats["visible"], len(culler.cull(world, view)))
            self.assertEqual(stats["visible"] + stats["by_layers"], len(culler.cull(plain, camera)))
            self.assertEqual(stats["objects"], stats["outside"] + stats["by_layers"] + stats["visible"])
            kinds = shapes["kind"]
            self.assertEqual((kinds == sightline.DEBUG_SECTOR).sum(), stats["sectors"])
            self.assertEqual((kinds == sightline.DEBUG_CHUNK).sum(), stats["chunks"])
            chunks = shapes[kinds == sightline.DEBUG_CHUNK]
            self.assertEqual(chunks["objects"].sum(), stats["objects"])
            self.assertEqual((chunks["whole"] == 1).sum(), stats["chunks_whole"])
            self.assertTrue((chunks["box"][:, 0] <= chunks["box"][:, 1]).all())
            dropped += stats["by_layers"]
        self.assertGreater(dropped, 1000)

    def test_shapes_of_views_and_buffers(self):
        camera = sightline.camera(far=50)
        corners = sightline.view_corners(camera, 1e9)
        self.assertEqual(corners.shape, (8, 3))
        self.assertTrue(np.allclose(corners[4:, 2], -50, rtol=1e-4))
        self.bad("not beyond its near plane", sightline.view_corners, camera, 0)
        buffer = sightline.Occlusion()
        self.refused("stale_buffer", "never begun", sightline.depth_image, buffer)
        buffer.begin(camera)
        buffer.draw_boxes(np.array([[[-1, -1, -9], [1, 1, -8]]], np.float32))
        picture = sightline.depth_image(buffer)
        self.assertEqual((picture.min(), picture.max(), picture[0, 0]), (0, 255, 0))
        culler = sightline.Culler()
        self.refused("stale_buffer", "has drawn no occluders", sightline.culler_depth_image, culler, 0, (64, 64))
        self.bad("expected a Culler", sightline.CullInspector().inspect, sightline.World(), camera, 3)

    def test_a_cullers_picture_has_the_size_of_its_view(self):
        world, culler, picture = sightline.World(), sightline.Culler(), sightline.culler_depth_image
        wall = np.array([[[-50, -50, -5.5], [1, 50, -4.5]]], np.float32)
        behind = [[[-1, -1, -8 - i], [1, 1, -7.5 - i]] for i in range(200)]
        handles = world.insert(np.concatenate([wall, np.array(behind, np.float32)]))
        world.set_occluders(handles[:1], world.add_solids(boxes=wall))

        def cull(*views):
            culler.cull(world, views, occlusion="automatic", object_cost=100000)

        cull(sightline.camera(width=40, height=30), sightline.camera(width=160, height=120))
        for size in (None, (160, 120), [160, 120], np.array([160, 120])):
            image = picture(culler, 1, size)
            self.assertEqual((image.shape, image[60, 0], image[60, 159]), ((120, 160), 255, 0))
        self.assertEqual(picture(culler, 1).shape, (120, 160))
        for size in ((120, 160), (161, 120), (160, 121), (159, 120), (500, 500), (-1, 5), (0, 0), (np.nan, 120)):
            self.bad("size: expected (160, 120)", picture, culler, 1, size)
        for size in ((160,), 160, "ab"):
            self.bad("size: expected two numbers", picture, culler, 1, size)
        self.whole("place", lambda n: picture(culler, n))
        self.assertEqual(picture(culler, 0).shape, (30, 40))
        for place in (2, 7, 8, 1 << 20):
            self.refused("stale_buffer", "has drawn no occluders", picture, culler, place)
        # For two equal views one is drawn, whatever size the second's place had before.
        for width, height in ((80, 60), (320, 240)):
            cull(*[sightline.camera(width=width, height=height)] * 2)
            self.assertEqual(picture(culler, 1).shape, (height, width))
            np.testing.assert_array_equal(picture(culler, 1), picture(culler, 0))


if __name__ == "__main__":
    unittest.main()
