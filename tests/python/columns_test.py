"""Layers and distances of a thousand random worlds, held against NumPy."""
import unittest

import numpy as np
import sightline
from support import Case


def random_camera(random):
    forward = random.normal(size=3)
    return sightline.camera(eye=tuple(random.uniform(-60, 60, 3)), forward=tuple(forward / np.linalg.norm(forward)),
                            up=(1, 0, 0) if abs(forward[1]) > 0.9 * np.linalg.norm(forward) else (0, 1, 0),
                            fov=random.uniform(0.3, 2.4), far=np.inf)


def eye_of(camera):
    return np.linalg.inv(camera.world_to_eye.astype(float))[:3, 3]


class Columns(Case):
    def test_leave_what_numpy_leaves(self):
        kept = could = 0
        for seed in range(1000):
            random = np.random.default_rng(seed)
            n = int(random.integers(1, 120))
            centre = random.uniform(-100, 100, (n, 3))
            boxes = np.stack([centre - 1, centre + 1], 1)
            layers = random.integers(0, 16, n).astype(np.uint32)
            least = random.uniform(0, 60, n) * random.integers(0, 2, n)
            ranges = np.stack([least, least + random.uniform(0, 200, n)], 1).astype(np.float32)
            world, plain = sightline.World(), sightline.World()
            handles = world.insert(boxes, layers=layers, distances=ranges)
            plain.insert(boxes)
            half = random.random(n) < 0.5
            layers[half], ranges[half, 0] = 6, 0
            world.set_layers(handles[half], layers[half])
            world.set_distances(handles[half], ranges[half])
            cameras = [random_camera(random) for _ in range(3)]
            wanted, scales = [int(b) for b in random.integers(0, 16, 3)], random.uniform(0.5, 2, 3)
            sources = [None, 0, None]
            views = [sightline.CullView(c, layers=w, distance_scale=s, distance_view=v)
                     for c, w, s, v in zip(cameras, wanted, scales, sources)]
            culler = sightline.Culler()
            ids, masks = culler.cull(world, views, masks=True)
            every, all_masks = culler.cull(plain, cameras, masks=True)
            got = np.zeros(n, np.uint8)
            got[ids] = masks
            for v, source in enumerate(sources):
                d = np.linalg.norm(world.boxes(handles).mean(1) - eye_of(cameras[v if source is None else source]), axis=1)
                limits = scales[v] * ranges.astype(float)
                unsure = (np.abs(d[:, None] - limits) < 1e-3).any(1)
                seen = np.zeros(n, bool)
                seen[every] = all_masks >> v & 1 != 0
                expected = seen & (layers & wanted[v] != 0) & (d >= limits[:, 0]) & (d < limits[:, 1])
                wrong = (expected != (got >> v & 1 != 0)) & ~unsure
                self.assertFalse(wrong.any(), f"seed {seed}, view {v}")
                kept, could = kept + expected.sum(), could + seen.sum()
        self.assertTrue(could / 10 < kept < could * 0.6)

    def test_levels_are_those_of_numpy(self):
        for seed in range(1000):
            random = np.random.default_rng(seed)
            n = int(random.integers(1, 120))
            centre, half = random.uniform(-100, 100, (n, 3)), random.uniform(0.5, 3, (n, 3))
            world = sightline.World()
            handles = world.insert(np.stack([centre - half, centre + half], 1))
            sizes = np.sort(random.uniform(2, 40, int(random.integers(1, 8))).astype(np.float32))[::-1]
            table = world.add_levels(sizes.tolist())
            tables = table * random.integers(0, 2, n).astype(np.uint32)
            world.set_levels(handles, tables)
            camera = random_camera(random)
            ids, levels, fades = sightline.Culler().cull(world, camera, levels=sightline.Levels())
            boxes = world.boxes(handles)
            d = np.linalg.norm(boxes.mean(1) - eye_of(camera), axis=1)
            r = 0.5 * np.linalg.norm(boxes[:, 1] - boxes[:, 0], axis=1)
            pixels = max(1280 * camera.eye_to_clip[0, 0], 720 * camera.eye_to_clip[1, 1])
            size = np.where(d <= r, np.inf, pixels * r / d)
            expected = (size[:, None] < sizes.astype(float)).sum(1) * (tables > 0)
            unsure = (np.abs(size[:, None] / sizes - 1) < 1e-3).any(1)
            self.assertFalse(((levels != expected[ids]) & ~unsure[ids]).any(), f"seed {seed}")
            self.assertEqual(fades.sum(), 0)
        culler = sightline.Culler()
        culler.cull(world, camera, masks=True, levels=sightline.Levels(fade=1, hysteresis=0.1))
        self.bad("hysteresis", culler.cull, world, camera, levels=sightline.Levels(hysteresis=1))
        self.refused("bad_argument", "do not descend", world.add_levels, [1, 2], index=1)
        for sizes in (None, 3, "sizes", [[2, 1]], ["a"], object(), memoryview(np.ones((2, 2)))):
            self.bad("sizes: expected numbers", world.add_levels, sizes)
        self.assertEqual(world.add_levels(memoryview(np.array([2, 1]))), world.add_levels((2, 1)) - 1)

    def test_scales_and_places_that_are_none(self):
        world, camera = sightline.World(), sightline.camera()
        for view in (sightline.CullView(camera, distance_scale=0), sightline.CullView(camera, distance_scale=np.nan),
                     sightline.CullView(camera, distance_view=1)):
            self.refused("bad_argument", "cull: a view's distance", sightline.Culler().cull, world, view, index=0)


if __name__ == "__main__":
    unittest.main()
