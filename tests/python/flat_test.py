"""Frusta, rays and visible sets: what they answer, and what is refused."""
import itertools
import unittest

import numpy as np
import sightline
from support import Case, boxes_of, row_of_things

VIEW = sightline.camera(width=64, height=48)


class Frustum(Case):
    def setUp(self):
        self.things = row_of_things(100)
        self.things["position"][3, 2] = self.things["exact_position"][3, 2] = 50

    def test_keeps_what_is_in_view(self):
        frustum = sightline.Frustum(VIEW)
        expected = [i for i in range(100) if i != 3]
        boxes = boxes_of(self.things)
        for form in (boxes, boxes.astype(np.float32),
                     sightline.BoxView.centre_half(self.things["position"], self.things["half"])):
            ids = frustum.cull_boxes(form)
            self.assertEqual((ids.dtype, list(ids)), (np.uint32, expected))
        spheres = sightline.SphereView(self.things["position"], self.things["half"][:, 0])
        self.assertEqual(list(frustum.cull_spheres(spheres)), expected)
        self.assertEqual(frustum.planes.shape, (6, 4))
        np.testing.assert_allclose(np.linalg.norm(frustum.planes[:, :3], axis=1), 1, rtol=1e-5)

    def test_refusals(self):
        frustum = sightline.Frustum(VIEW)
        self.bad("boxes: expected", frustum.cull_boxes, np.zeros((4, 5)))
        self.bad("too short", frustum.cull_boxes, np.broadcast_to(np.zeros((1, 6)), (9, 6)))
        self.bad("spheres: expected", frustum.cull_spheres, np.zeros((4, 4)))
        self.bad("too short", frustum.cull_spheres, np.broadcast_to(np.zeros((1, 4), np.float32), (9, 4)))


class Rays(Case):
    def setUp(self):
        self.things = row_of_things(100)
        self.boxes = sightline.BoxView.centre_half(self.things["position"], self.things["half"])
        self.bvh = sightline.BoxBvh()
        self.bvh.build(self.boxes)
        self.origins = np.zeros((3, 3), np.float32)
        self.directions = np.array([(0, 0, -2), (0, 1, 0), (np.nan, 0, 0)], np.float32)

    def test_meet_the_nearest(self):
        self.assertEqual(len(self.bvh), 100)
        objects, distances = self.bvh.cast(self.origins, self.directions)
        self.assertEqual(list(objects), [0, sightline.NO_OBJECT, sightline.NO_OBJECT])
        self.assertEqual(list(distances), [2.25, -1, -1])
        for longest in (2, np.array([2, 9, 9], np.float32)):
            self.assertEqual(self.bvh.cast(self.origins, self.directions, longest)[0][0], sightline.NO_OBJECT)
        self.assertEqual(list(self.bvh.visible_set(VIEW, 9, 9)), [0])
        self.things["position"][0, 0] = 50
        self.bvh.refit(self.boxes)
        self.assertEqual(self.bvh.cast(self.origins, self.directions)[0][0], 1)
        self.assertEqual(list(sightline.BoxBvh().cast(self.origins, self.directions)[1]), [-1, -1, -1])

    def test_far_out(self):
        far = boxes_of(self.things) + (1e7, 0, 0)
        self.bvh.build(far, origin=(1e7, 0, 0))
        self.assertEqual(self.bvh.cast(self.origins, self.directions)[0][0], 0)

    def test_refusals(self):
        boxes = boxes_of(self.things)
        boxes[7, 0, 0] = np.nan
        self.refused("bad_box", "not valid", self.bvh.build, boxes, index=7)
        self.refused("bad_box", "not valid", self.bvh.refit, boxes, index=7)
        self.bad("as many boxes", self.bvh.refit, boxes[:5])
        self.bad("boxes: expected", self.bvh.build, np.zeros(3))
        self.bad("origin: expected three", self.bvh.build, self.boxes, origin=(1, 2))
        self.bad("as many directions", self.bvh.cast, self.origins, self.directions[:2])
        self.bad("origins: expected float32", self.bvh.cast, self.origins.astype(float), self.directions)
        self.bad("max_distances: expected", self.bvh.cast, self.origins, self.directions, np.zeros(2, np.float32))
        self.bad("max_distances: expected", self.bvh.cast, self.origins, self.directions, "far")
        self.bad("rays", self.bvh.visible_set, VIEW, 0, 4)
        self.bad("rays", self.bvh.visible_set, VIEW, 4097, 4096)
        self.whole("columns", lambda n: self.bvh.visible_set(VIEW, n, 5))
        self.whole("rows", lambda n: self.bvh.visible_set(VIEW, 5, n))
        self.assertEqual(self.bvh.cast(self.origins, self.directions)[0][0], 0)


class Pvs(Case):
    SETS = [np.array(s, np.uint32) for s in ((1, 8), (0, 1, 9), (), ())]

    def bytes_of(self, **changes):
        given = dict(bounds=[[0, 0, 0], [4, 1, 1]], counts=(4, 1, 1), objects=10, open=[1, 1, 0, 1], sets=self.SETS,
                     scene=77)
        return sightline.write_pvs(**{**given, **changes})

    def test_is_read_as_it_was_written(self):
        pvs = sightline.read_pvs(self.bytes_of())
        self.assertEqual((len(pvs), pvs.counts, pvs.objects, pvs.scene), (4, (4, 1, 1), 10, 77))
        self.assertEqual([list(pvs.seen_from(c)) for c in range(4)], [list(s) for s in self.SETS])
        self.assertEqual([pvs.is_open(c) for c in range(4)], [True, True, False, True])
        self.assertEqual((pvs.cell_at((1.5, 0.5, 0.5)), pvs.cell_at((2.5, 0.5, 0.5))), (1, None))
        self.assertIsNone(pvs.cell_at((np.nan, 0, 0)))
        np.testing.assert_array_equal(pvs.cell_bounds(2), [[2, 0, 0], [3, 1, 1]])
        np.testing.assert_array_equal(pvs.bounds, [[0, 0, 0], [4, 1, 1]])
        sightline.read_pvs(bytearray(self.bytes_of()))

    def test_sets_outlive_the_reader(self):
        seen = sightline.read_pvs(self.bytes_of()).seen_from(1)
        self.assertEqual(list(seen), [0, 1, 9])
        with self.assertRaises(ValueError):
            seen[0] = 5

    def test_refusals(self):
        written = self.bytes_of()
        self.refused("too_many", "too many objects, expected at most 1073741824", self.bytes_of, objects=2**31)
        damaged = written[:-1] + bytes([written[-1] ^ 1])
        for data in (damaged, written[:50], b"", b"no such file"):
            with self.assertRaises(sightline.Refused) as caught:
                sightline.read_pvs(data)
            self.assertEqual(caught.exception.status, "bad_file")
        self.bad("pvs: expected bytes", sightline.read_pvs, "text")
        self.bad("pvs: expected bytes", sightline.read_pvs, 5)
        pvs = sightline.read_pvs(written)
        for call in (pvs.seen_from, pvs.cell_bounds, pvs.is_open):
            for cell in (-1, 4, 1 << 40):
                self.bad("no such cell", call, cell)
        for changes in (dict(counts=(5, 1, 1)), dict(objects=9), dict(open=[1, 1, 0]), dict(sets=self.SETS[:3]),
                        dict(sets=self.SETS[:3] + [np.array([2, 1], np.uint32)]),
                        dict(open=itertools.repeat(True))):  # without an end
            with self.assertRaises(sightline.Refused, msg=str(changes)) as caught:
                self.bytes_of(**changes)
            self.assertEqual(caught.exception.status, "bad_argument")
        self.bad("sets: expected uint32", self.bytes_of, sets=[np.array([1.5])] * 4)
        self.bad("bounds: expected", self.bytes_of, bounds=[1, 2, 3])
        for flags in ("ab", [1, "b", 0, 1], [[1, 1]] * 4, 5):
            self.bad("open: expected a sequence of flags", self.bytes_of, open=flags)
        for counts in (4, (4, 1), (4, 1, 1, 1), None):
            self.bad("counts: expected three numbers", self.bytes_of, counts=counts)
        self.bad("sets: expected a sequence", self.bytes_of, sets=5)
        self.whole("counts", lambda n: self.bytes_of(counts=(4, 1, n)))
        self.whole("objects", lambda n: self.bytes_of(objects=n))
        self.whole("scene", lambda n: self.bytes_of(scene=n))


if __name__ == "__main__":
    unittest.main()
