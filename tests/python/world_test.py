"""Worlds and their culling: arrays in and out, in place, and what is refused."""
import threading
import unittest

import numpy as np
import sightline
from support import Case, THING, boxes_of, read_only, row_of_things

AHEAD = sightline.camera(far=np.inf)
BEHIND = sightline.camera(forward=(0, 0, 1))


class Unreadable:
    """A sequence whose own methods raise."""
    def __len__(self):
        raise KeyError("length")

    def __getitem__(self, at):
        raise KeyError(at)


class Insert(Case):
    def test_every_form_puts_the_same_boxes_in(self):
        things = row_of_things(50)
        aligned = row_of_things(50, np.dtype(THING.descr, align=True))
        boxes = boxes_of(things)
        floats = boxes.astype(np.float32)
        columns = [np.ascontiguousarray(floats[:, i // 3, i % 3]) for i in range(6)]
        view = sightline.BoxView
        forms = {
            "array": boxes, "floats": floats, "rows": boxes.reshape(50, 6), "flat floats": floats.reshape(50, 6),
            "every second": np.repeat(boxes, 2, axis=0)[::2], "fortran rows": np.array(boxes)[:, :, :],
            "min_max": view.min_max(boxes), "two arrays": view.min_max(boxes[:, 0], boxes[:, 1]),
            "packed fields": view.centre_half(things["position"], things["half"]),
            "aligned fields": view.centre_half(aligned["position"], aligned["half"]),
            "exact fields": view.centre_half(things["exact_position"], things["exact_half"]),
            "arrays": view.arrays(*columns),
        }
        for name, form in forms.items():
            with self.subTest(name):
                world = sightline.World()
                handles = world.insert(form)
                self.assertEqual((handles.dtype, handles.shape, len(world)), (np.uint32, (50, 2), 50))
                np.testing.assert_allclose(world.boxes(handles), boxes, atol=1e-3)
                if isinstance(form, view):
                    self.assertEqual(len(form), 50)

    def test_single_precision_has_an_origin(self):
        things = row_of_things(3)
        floats = boxes_of(things).astype(np.float32)
        for form in (sightline.BoxView.centre_half(things["position"], things["half"], origin=(1e7, 0, 0)),
                     sightline.BoxView.min_max(floats, origin=(1e7, 0, 0)),
                     sightline.BoxView.min_max(floats.reshape(3, 6), origin=(1e7, 0, 0)),
                     sightline.BoxView.min_max(floats[:, 0], floats[:, 1], origin=(1e7, 0, 0))):
            world = sightline.World()
            np.testing.assert_allclose(world.boxes(world.insert(form))[:, :, 0], [[1e7 - 0.5, 1e7 + 0.5]] * 3, atol=1e-3)
        one = sightline.BoxView.min_max(floats)
        moved = world.boxes(world.insert(sightline.BoxView.min_max(one, origin=(1e7, 0, 0))))
        np.testing.assert_allclose(moved[:, :, 0], [[1e7 - 0.5, 1e7 + 0.5]] * 3, atol=1e-3)
        columns = [np.ascontiguousarray(floats[:, i // 3, i % 3]) for i in range(6)]
        for form in (sightline.BoxView.centre_half(things["position"], things["half"]),
                     sightline.BoxView.arrays(*columns), sightline.BoxView.min_max(floats[:, 0], floats[:, 1]),
                     sightline.BoxView.min_max(floats, origin=(1e7, 0, 0))):
            self.bad("origin: expected an array or two", sightline.BoxView.min_max, form, origin=(1, 0, 0))
            self.assertEqual(len(sightline.BoxView.min_max(form)), 3)
        self.bad("only boxes in float32", sightline.BoxView.min_max, boxes_of(things), origin=(1, 0, 0))
        self.bad("only boxes in float32", sightline.BoxView.centre_half, things["exact_position"],
                 things["exact_half"], origin=(1, 0, 0))

    def test_boxes_are_read_in_place_each_time(self):
        things = row_of_things(2)
        boxes = sightline.BoxView.centre_half(things["position"], things["half"])
        world = sightline.World()
        handles = world.insert(boxes)
        things["position"][:, 1] += 100
        world.move(handles, boxes)
        np.testing.assert_allclose(world.boxes(handles)[:, 0, 1], 99.5)

    def test_a_view_keeps_its_arrays(self):
        boxes = sightline.BoxView.min_max(np.tile([[-1.0] * 3, [1.0] * 3], (1000, 1, 1)))
        world = sightline.World()
        np.testing.assert_allclose(world.boxes(world.insert(boxes))[:, 1], 1)

    def test_handles_go_into_the_callers_structs(self):
        for field in ("handle", "pair"):
            things = row_of_things(9)
            world = sightline.World()
            written = world.insert(boxes_of(things), handles=things[field])
            self.assertTrue(np.shares_memory(written, things))
            self.assertTrue(world.contains(things[field]).all())
            world.remove(things[field][:4])
            self.assertEqual(list(world.contains(things[field])), [False] * 4 + [True] * 5)

    def test_columns(self):
        things = row_of_things(9)
        things["layer"][3] = 4
        world = sightline.World()
        handles = world.insert(boxes_of(things), layers=things["layer"], values=things["number"])
        self.assertEqual(list(world.layers(handles)), list(things["layer"]))
        self.assertEqual(list(world.values(handles)), list(things["number"]))
        self.assertTrue((world.handles(handles[:, 0].copy()) == handles).all())
        things["layer"], things["number"] = 2, 5
        world.set_layers(handles, things["layer"])
        world.set_values(handles, things["number"])
        self.assertEqual((set(world.layers(handles)), set(world.values(handles))), ({2}, {5}))
        self.assertTrue((world.distances(handles) == [0, np.inf]).all())
        ranges = np.stack([np.arange(9), np.arange(9) + 50], 1).astype(np.float32)
        world.set_distances(handles, ranges)
        self.assertTrue((world.distances(handles) == ranges).all())
        for wrong in (ranges[:, ::-1], ranges[:, :1], ranges.astype(float), -1 - ranges):
            with self.assertRaises(ValueError):
                world.set_distances(handles, wrong)
        world.remove(handles[:1])
        self.assertEqual((world.layers(handles)[0], world.values(handles)[0]), (0, sightline.NO_OBJECT))
        self.assertFalse(world.boxes(handles)[0].any())
        self.assertFalse(world.contains(world.handles(handles[:1, 0].copy()))[0])
        self.assertEqual((len(world), world.id_limit), (8, 9))

    def test_nothing_is_no_mistake(self):
        world = sightline.World()
        self.assertEqual(len(world.insert(np.zeros((0, 2, 3)))), 0)
        world.move(np.zeros((0, 2), np.uint32), np.zeros((0, 2, 3)))
        world.remove(np.zeros((0, 2), np.uint32))


class Refusals(Case):
    def setUp(self):
        self.things = row_of_things(4)
        self.boxes = boxes_of(self.things)
        self.world = sightline.World()

    def test_boxes_of_another_kind(self):
        for boxes in (np.zeros((3, 3)), np.zeros((4, 2, 4)), np.zeros((4, 6), np.int64), np.zeros((4, 6), np.float16),
                      self.boxes.astype(">f8"), self.things, np.asfortranarray(np.zeros((4, 2, 3))),
                      np.zeros((4, 2, 6))[:, :, ::2], [[0] * 6], None, "boxes"):
            self.bad("boxes: expected", self.world.insert, boxes)
        self.bad("negative stride", self.world.insert, self.boxes[::-1])
        overlapping = np.lib.stride_tricks.as_strided(self.boxes, (3, 2, 3), (16, 24, 8))
        self.bad("stride too short", self.world.insert, overlapping)
        self.bad("stride too short", self.world.insert, np.broadcast_to(self.boxes[:1], (4, 2, 3)))
        self.assertEqual(len(self.world), 0)

    def test_box_views_of_another_kind(self):
        centre, half = self.things["position"], self.things["half"]
        view = sightline.BoxView
        for args in ((centre, half[:3]), (centre, half.copy()), (centre, self.things["exact_half"]),
                     (centre[:, :2], half[:, :2]), (centre, half.astype(int)), (centre, None), (self.things, self.things)):
            self.bad("boxes: expected", view.centre_half, *args)
        self.bad("boxes: expected", view.min_max, self.boxes[:, 0], self.boxes[:2, 1])
        self.bad("negative stride", view.centre_half, centre[::-1], half[::-1])
        column = np.zeros(4, np.float32)
        self.bad("expected float32", view.arrays, column, column, column, column, column, np.zeros(4))
        self.bad("one length", view.arrays, column, column, column, column, column, column[:3])
        self.bad("contiguous", view.arrays, *[np.zeros(8, np.float32)[::2]] * 6)

    def test_boxes_that_are_none(self):
        for harm in (np.nan, np.inf, -np.inf, 1e12, 100):
            boxes = self.boxes.copy()
            boxes[2, 0, 1] = harm
            self.refused("bad_box", "a box is not valid", self.world.insert, boxes, index=2)
        self.things["half"][1, 2] = -1
        self.refused("bad_box", "a box is not valid", self.world.insert,
                     sightline.BoxView.centre_half(self.things["position"], self.things["half"]), index=1)
        self.assertEqual(len(self.world), 0)

    def test_handles(self):
        insert = self.world.insert
        for handles in (np.zeros((4, 2)), np.zeros((4, 2), np.int32), np.zeros(4, np.uint32), self.things,
                        np.zeros((4, 4), np.uint32)[:, ::2], np.zeros((4, 3), np.uint32), np.zeros(4, "u4,u8"),
                        np.zeros(4, "u4,f4"), [[0, 0]] * 4):
            self.bad("handles: expected uint32", insert, self.boxes, handles=handles)
        self.bad("read-only", insert, self.boxes, handles=read_only(self.things["pair"]))
        self.bad("negative stride", insert, self.boxes, handles=np.zeros((4, 2), np.uint32)[::-1])
        self.bad("one handle a box", insert, self.boxes, handles=np.zeros((3, 2), np.uint32))
        self.bad("too short", insert, self.boxes,
                 handles=np.lib.stride_tricks.as_strided(np.zeros(9, np.uint32), (4, 2), (4, 4)))
        handles = insert(self.boxes)
        stale = handles.copy()
        stale[1, 1] += 1
        for call in (self.world.remove, lambda h: self.world.move(h, self.boxes),
                     lambda h: self.world.set_layers(h, self.things["layer"])):
            self.refused("stale_handle", "names no object", call, stale, index=1)
        self.refused("stale_handle", "twice", self.world.remove, handles[[0, 1, 0]], index=2)
        self.bad("one box a handle", self.world.move, handles[:3], self.boxes)
        self.bad("handles: expected", self.world.contains, 5)
        self.bad("stride", self.world.contains, np.broadcast_to(handles[:1], (4, 2)))
        self.assertEqual(len(self.world), 4)

    def test_columns(self):
        insert = self.world.insert
        for layers in (np.zeros(4), np.zeros((4, 1), np.uint32), np.zeros(4, np.int64), 3):
            self.bad("layers: expected uint32", insert, self.boxes, layers=layers)
        self.bad("one element", insert, self.boxes, layers=np.zeros(3, np.uint32))
        self.bad("one element", insert, self.boxes, values=np.zeros(5, np.uint32))
        self.bad("values: expected uint32 of shape (n,) in ascending", insert, self.boxes,
                 values=self.things["number"][::-1])
        handles = insert(self.boxes)
        self.bad("one element", self.world.set_values, handles, self.things["number"][:3])
        self.bad("ids: expected uint32", self.world.handles, np.zeros(3))


class Cull(Case):
    def setUp(self):
        self.things = row_of_things(1000)
        self.things["layer"][:10] = 2
        self.boxes = sightline.BoxView.centre_half(self.things["position"], self.things["half"])
        self.world, self.culler = sightline.World(), sightline.Culler()
        self.handles = self.world.insert(self.boxes, layers=self.things["layer"], values=self.things["number"])

    def test_views(self):
        ids = self.culler.cull(self.world, AHEAD)
        self.assertEqual((ids.dtype, sorted(ids)), (np.uint32, list(range(1000))))
        self.assertEqual(len(self.culler.cull(self.world, [BEHIND])), 0)
        views = (BEHIND, AHEAD, sightline.CullView(AHEAD, layers=2))
        ids, masks = self.culler.cull(self.world, views, masks=True)
        self.assertEqual(masks.dtype, np.uint8)
        self.assertEqual(list(masks), [6 if i < 10 else 2 for i in ids])
        few = self.culler.cull(self.world, sightline.CullView(AHEAD, min_area=50))
        self.assertTrue(0 < len(few) < 1000)
        values = self.culler.cull(self.world, AHEAD, values=True)
        self.assertEqual(list(values), [1000 + i for i in self.culler.cull(self.world, AHEAD)])

    def test_far_out(self):
        self.world.move(self.handles, sightline.BoxView.centre_half(
            self.things["position"], self.things["half"], origin=(1e7, 0, 0)))
        self.assertEqual(len(self.culler.cull(self.world, AHEAD)), 0)
        far = sightline.camera(eye=(1e7, 0, 0), origin=(1e7, 0, 0), far=np.inf)
        self.assertEqual(len(self.culler.cull(self.world, far)), 1000)

    def test_occlusion(self):
        occlusion = sightline.Occlusion()
        view = sightline.CullView(AHEAD, occlusion=occlusion)
        self.refused("stale_buffer", "never begun", self.culler.cull, self.world, view, index=0)
        occlusion.begin(AHEAD)
        occlusion.draw_boxes(boxes_of(self.things)[:1])
        self.assertEqual(list(self.culler.cull(self.world, view)), [self.handles[0, 0]])
        view.view = sightline.camera(eye=(0, 0, 1), far=np.inf)
        self.refused("stale_buffer", "another view", self.culler.cull, self.world, [AHEAD, view], index=1)
        view.occlusion = None
        self.assertEqual(len(self.culler.cull(self.world, view)), 1000)

    def test_refusals(self):
        cull = self.culler.cull
        for count in (0, 9):
            self.bad(f"expected 1 to 8 views, got {count}", cull, self.world, [AHEAD] * count)
        for views in (None, 3, "view", [AHEAD, None], np.array(5), memoryview(boxes_of(self.things))):
            self.bad("expected a View, a CullView", cull, self.world, views)
        self.assertRaises(KeyError, cull, self.world, Unreadable())
        for area in (np.nan, -1, np.inf):
            self.bad("min_area", cull, self.world, [AHEAD, sightline.CullView(AHEAD, min_area=area)], index=1)
        view = sightline.CullView(AHEAD, layers=5, distance_view=0)
        for name in ("layers", "distance_view"):
            self.whole(name, lambda n: sightline.CullView(AHEAD, **{name: n}))
            self.whole(name, lambda n: setattr(view, name, n))
        self.assertEqual((view.layers, view.distance_view), (5, 0))
        view.layers, view.distance_view = np.uint32(6), None
        self.assertEqual((view.layers, view.distance_view), (6, None))
        for name in ("view", "key"):
            self.whole(name, lambda n: sightline.Levels(**{name: n}))
            self.bad(f"{name}: expected a whole number from 0 to 4294967295", sightline.Levels, **{name: 1 << 32})

    def test_threads_wait_for_each_other(self):
        occlusions = [sightline.Occlusion(), sightline.Occlusion()]
        failures = []

        def draw(which):
            for _ in range(20):
                which.begin(AHEAD)
                which.draw_boxes(boxes_of(self.things)[:1])

        def look(first, second):
            views = [sightline.CullView(AHEAD, occlusion=first), sightline.CullView(AHEAD, occlusion=second)]
            culler = sightline.Culler()
            for _ in range(20):
                if len(culler.cull(self.world, views)) < 1:
                    failures.append("nothing")

        def change():
            for _ in range(20):
                self.world.move(self.handles, self.boxes)
                self.world.remove(self.world.insert(boxes_of(self.things[:3])))

        for occlusion in occlusions:
            occlusion.begin(AHEAD)
        threads = [threading.Thread(target=draw, args=(o,)) for o in occlusions]
        threads += [threading.Thread(target=look, args=o) for o in (occlusions, occlusions[::-1])]
        threads.append(threading.Thread(target=change))
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failures, [])


if __name__ == "__main__":
    unittest.main()
