"""Worlds as bytes: loaded, streamed beside a thread, damaged."""
import threading
import unittest

import numpy as np
import sightline
from support import Case


def ground(count=3000):
    """A world on some hundred sectors, its handles, and the boxes."""
    random = np.random.default_rng(4)
    low = random.uniform(-16000, 16000, (count, 3)) * (1, 0.001, 1)
    boxes = np.stack([low, low + random.uniform(1, 20, (count, 3))], axis=1)
    world = sightline.World()
    return world, world.insert(boxes, layers=random.integers(1, 8, count).astype(np.uint32)), boxes


def looking(x, z, far=4000.0):
    return sightline.camera(eye=(x, 3, z), far=far, width=640, height=480)


class Snapshots(Case):
    def test_what_is_loaded_is_what_was_saved(self):
        world, handles, _ = ground()
        world.remove(handles[:100])
        world.move(handles[200:300], np.zeros((100, 2, 3)))
        bytes_ = world.save()
        loaded = sightline.load(bytes_)
        self.assertEqual(len(loaded), len(world))
        np.testing.assert_array_equal(loaded.boxes(handles), world.boxes(handles))
        np.testing.assert_array_equal(loaded.layers(handles), world.layers(handles))
        np.testing.assert_array_equal(loaded.contains(handles), world.contains(handles))
        view = sightline.CullView(looking(0, 0), layers=2)
        self.assertEqual(sorted(sightline.Culler().cull(world, view)), sorted(sightline.Culler().cull(loaded, view)))
        self.assertEqual(loaded.save(), bytes_)

    def test_sectors_come_and_go_beside_a_thread(self):
        world, handles, _ = ground()
        bytes_ = world.save()
        part = sightline.World()
        stream = sightline.WorldStream(bytearray(bytes_), part)
        self.assertGreater(len(stream), 80)
        done = threading.Event()

        def read():
            while not done.is_set():
                stream.work()

        thread = threading.Thread(target=read)
        thread.start()
        budget = sum(stream.sector(i)["memory"] for i in range(len(stream))) // 4
        self.assertEqual(stream.came().shape, (0, 2))
        here = set()

        def update(view):
            nonlocal here
            report = stream.update(view, budget=budget)
            here = here - set(map(tuple, stream.went())) | set(map(tuple, stream.came()))
            return report

        try:
            for z in range(14000, -14000, -700):
                view = looking(0, z)
                report = update(view)
                while report.coming:
                    report = update(view)
                self.assertEqual(here, set(map(tuple, handles[part.contains(handles)])))
                self.assertLessEqual(report.memory, budget)
                self.assertEqual(report.missing, 0)
                self.assertEqual(sorted(sightline.Culler().cull(part, view)),
                                 sorted(sightline.Culler().cull(world, view)))
                np.testing.assert_array_equal(stream.stand_out(handles), ~part.contains(handles))
        finally:
            done.set()
            thread.join()

    def test_what_is_damaged_is_named(self):
        world, _, _ = ground()
        bytes_ = bytearray(world.save())
        self.refused("bad_file", "truncated", sightline.load, bytes_[:-1], index=len(bytes_) - 1)
        self.refused("bad_file", "too short", sightline.load, b"", index=0)
        bytes_[20] ^= 1
        self.refused("bad_file", "checksum", sightline.load, bytes_, index=16)
        stream = sightline.WorldStream(bytes_, sightline.World())
        self.assertEqual(stream.sector(0)["state"], "out")
        view = looking(*[sum(stream.sector(0)["bounds"][i][axis] for i in (0, 1)) / 2 + add
                         for axis, add in ((0, 0), (2, 2000))])
        self.assertEqual(stream.bring_in(view).damaged, 1)
        self.assertEqual(stream.sector(0)["state"], "damaged")
        self.assertIn("checksum", stream.sector(0)["error"])
        self.bad("no such sector", stream.sector, len(stream))
        self.whole("index", stream.sector)
        self.whole("budget", lambda n: stream.update(view, budget=n))
        self.bad("in use", sightline.WorldStream, bytes_, world)
        self.bad("expected a World", sightline.WorldStream, bytes_, 3)


if __name__ == "__main__":
    unittest.main()
