"""Ranges of an order in random worlds, held against NumPy and against ids, while objects come and go."""
import unittest

import numpy as np
import sightline
from support import Case


class Ranges(Case):
    def follow(self, buffer, order, world):
        for slot, object_id in order.update(world):
            buffer[int(slot)] = int(object_id)
        self.assertEqual([buffer[slot] for slot in range(len(order))], order.objects.tolist())

    def test_equal_ids_and_brute_force(self):
        seen = excess = 0
        culler, ids = sightline.RangeCuller(), sightline.Culler()
        for seed in range(500):
            random = np.random.default_rng(seed)
            world, order, buffer = sightline.World(), sightline.ObjectOrder(), {}
            low = random.uniform(-40, 40, (120, 3))
            boxes = np.stack([low, low + random.uniform(0, 6, (120, 3))], 1)
            layers = (1 << random.integers(0, 3, 120)).astype(np.uint32)
            handles = world.insert(boxes, layers=layers)
            for _ in range(2):
                self.follow(buffer, order, world)
                slots = order.slots(world, handles)
                self.assertEqual([buffer[int(s)] for s in slots], handles[:, 0].tolist())
                camera = sightline.camera(eye=tuple(random.uniform(-30, 30, 3)),
                                          forward=tuple(random.normal(size=3)), far=200)
                other = sightline.camera(eye=(0, 0, 90), far=200)
                views = [sightline.CullView(camera, layers=int(random.integers(1, 8))), sightline.CullView(other)]
                ranges, masks = culler.cull(world, order, views, masks=True)
                found = {int(i): int(m) for (first, count), m in zip(ranges, masks)
                         for i in order.objects[first:first + count]}
                expected, expected_masks = ids.cull(world, views, masks=True)
                self.assertEqual(found, dict(zip(expected.tolist(), expected_masks.tolist())))
                rows = other.eye_to_clip.astype(float) @ other.world_to_eye.astype(float)
                planes = np.array([rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                                   rows[2], rows[3] - rows[2]])
                planes /= np.linalg.norm(planes[:, :3], axis=1)[:, None]
                corners = np.where(planes[None, :, :3] >= 0, boxes[:, None, 1], boxes[:, None, 0])
                depths = ((corners * planes[None, :, :3]).sum(2) + planes[None, :, 3]).min(1)
                kept = np.array([found.get(int(h), 0) >> 1 & 1 for h in handles[:, 0]])
                self.assertTrue((kept[depths >= 0.01] == 1).all() and (kept[depths < -0.01] == 0).all())
                whole = culler.cull(world, order, views, whole_chunks=True)
                self.assertGreaterEqual(whole[:, 1].sum(), len(found))
                seen, excess = seen + len(found), excess + whole[:, 1].sum() - len(found)
                world.remove(handles[:30])
                boxes, handles = boxes[30:], handles[30:]
        self.assertGreater(seen, 10000)
        self.assertGreater(excess, 1000)

    def test_refuse_an_order_of_before(self):
        world, order, culler = sightline.World(), sightline.ObjectOrder(), sightline.RangeCuller()
        world.insert(np.array([[[-1, -1, -9], [1, 1, -8]]], float))
        camera = sightline.camera()
        self.refused("stale_buffer", "expected an update", culler.cull, world, order, camera)
        self.assertEqual(order.renumber(world).tolist(), [[0, 0]])
        self.assertEqual(culler.cull(world, order, camera).tolist(), [[0, 1]])
        world.insert(np.array([[[-1, -1, -19], [1, 1, -18]]], float))
        self.refused("stale_buffer", "expected an update", culler.cull, world, order, camera)
        self.assertEqual(order.update(world)[:, 1].tolist()[-1:], [1])


if __name__ == "__main__":
    unittest.main()
