"""Instances in a thousand random worlds and views, held against NumPy, each object by itself."""
import unittest

import numpy as np
import sightline
from support import Case


def turned(random, count):
    """Rotations times scales, and translations: (n, 4, 4)."""
    matrices = np.zeros((count, 4, 4), np.float32)
    for matrix in matrices:
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        turn *= np.linalg.det(turn)  # no mirror
        matrix[:3, :3] = turn * np.exp(random.uniform(-1, 1))
        matrix[:3, 3] = random.uniform(-60, 60, 3)
        matrix[3, 3] = 1
    return matrices


def depths_in(view, matrix, origin, boxes):
    """Of boxes (n, 2, 3), as a matrix places them, the least distance of their best corners over the planes."""
    placed = matrix.astype(float)
    placed[:3, 3] += origin - np.array(view.origin)
    rows = view.eye_to_clip.astype(float) @ view.world_to_eye.astype(float) @ placed
    planes = np.array([rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[2],
                       rows[3] - rows[2]])
    planes /= np.linalg.norm(planes[:, :3], axis=1)[:, None]
    corners = np.where(planes[None, :, :3] >= 0, boxes[:, None, 1], boxes[:, None, 0])
    return ((corners * planes[None, :, :3]).sum(2) + planes[None, :, 3]).min(1)


class Instances(Case):
    @staticmethod
    def names(*names):
        return np.array(names, np.uint32)

    def test_equal_brute_force(self):
        seen = 0
        culler = sightline.InstanceCuller()
        for seed in range(1000):
            random = np.random.default_rng(seed)
            instances, worlds, boxes, layers = sightline.Instances(), [], [], []
            for _ in range(2):
                low = random.uniform(-20, 20, (30, 3))
                boxes.append(np.stack([low, low + random.uniform(0, 6, (30, 3))], 1))
                layers.append((1 << random.integers(0, 3, 30)).astype(np.uint32))
                worlds.append(sightline.World())
                worlds[-1].insert(boxes[-1], layers=layers[-1])
                instances.add_world(worlds[-1])
            names = random.integers(0, 2, 5).astype(np.uint32)
            matrices, origins = turned(random, 5), random.uniform(-5, 5, (5, 3))
            placed = instances.insert(names, matrices, origins)
            self.assertEqual((len(instances), instances.objects), (5, 150))
            eye, forward = random.uniform(-30, 30, 3), random.normal(size=3)
            camera = sightline.camera(eye=tuple(eye), forward=tuple(forward), far=200)
            view = sightline.CullView(camera, layers=int(random.integers(1, 8)))
            ranges, ids, masks = culler.cull(instances, view, masks=True)
            self.assertTrue((masks == 1).all())
            found = np.zeros((5, 30), int)
            for instance, first, count in ranges:
                np.add.at(found[instance], ids[first:first + count], 1)
            for i in range(5):
                depths = depths_in(camera, matrices[i], origins[i], boxes[names[i]])
                counts, asked = found[placed[i, 0]], (layers[names[i]] & view.layers) != 0
                self.assertTrue((counts[(depths >= 0) & asked] == 1).all(), f"seed {seed}")
                self.assertTrue((counts[(depths < -0.02) | ~asked] == 0).all(), f"seed {seed}")
            seen += found.sum()
        self.assertGreater(seen, 10000)

    def test_values_levels_and_sharing(self):
        world, instances = sightline.World(), sightline.Instances()
        world.insert(np.array([[[-1, -1, -1], [1, 1, 1]]], float), values=np.array([77], np.uint32))
        name = instances.add_world(world)
        matrices = np.tile(np.eye(4, dtype=np.float32), (2, 1, 1))
        handles = instances.insert(self.names(name, name), matrices, [(0, 0, -10), (0, 0, -20)])
        culler = sightline.InstanceCuller()
        ranges, ids = culler.cull(instances, sightline.camera(), values=True)
        self.assertEqual(ids.tolist(), [77])
        self.assertEqual(ranges[:, 1:].tolist(), [[0, 1], [0, 1]])
        everything = culler.cull(instances, sightline.camera(), masks=True, levels=sightline.Levels(fade=0.1))
        self.assertEqual(len(everything), 5)
        matrices[:, 2, 3] = 30
        instances.move(handles, self.names(name, name), matrices)
        self.assertEqual(len(culler.cull(instances, sightline.camera())[0]), 0)
        instances.remove(handles)
        instances.remove_world(name)

    def test_refusals(self):
        world, instances = sightline.World(), sightline.Instances()
        name = instances.add_world(world)
        one = np.eye(4, dtype=np.float32)[None]
        self.bad("expected a World", instances.add_world, 3)
        self.bad("none that was added", instances.insert, self.names(5), one, index=0)
        self.bad("uniform scale", instances.insert, self.names(name), 2 * one, index=0)
        self.bad("expected one for each", instances.insert, self.names(name, name), one)
        self.bad("origins: expected", instances.insert, self.names(name), one, [(0, 0)])
        handles = instances.insert(self.names(name), one)
        self.bad("while an instance shows it", instances.remove_world, name)
        world.insert(np.array([[[-1, -1, -6], [1, 1, -5]]], float))
        culler = sightline.InstanceCuller()
        self.bad("expected an update", culler.cull, instances, sightline.camera(), index=name)
        instances.update()
        self.assertEqual(len(culler.cull(instances, sightline.camera())[0]), 1)
        casters = sightline.ShadowCasters()
        self.bad("casters", culler.cull, instances, sightline.CullView(sightline.camera(), casters=casters), index=0)
        self.bad("hysteresis", culler.cull, instances, sightline.camera(), levels=sightline.Levels(hysteresis=0.1))
        self.whole("name", instances.remove_world)
        self.whole("most_objects", lambda n: culler.cull(instances, sightline.camera(), most_objects=n))
        self.refused("too_many", "most_objects", culler.cull, instances, sightline.camera(), most_objects=0)
        instances.set_layers(handles, np.array([0], np.uint32))
        self.assertEqual(len(culler.cull(instances, sightline.camera())[0]), 0)


if __name__ == "__main__":
    unittest.main()
