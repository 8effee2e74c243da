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


if __name__ == "__main__":
    unittest.main()
