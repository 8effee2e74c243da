"""Occlusion in one call: what objects carry, and what is refused."""
import unittest

import numpy as np
import sightline
from support import Case

AHEAD = sightline.camera(width=160, height=120)
WALL = np.array([[-50, -50, -5.5], [50, 50, -4.5]])
QUAD = np.array([[-50, -50, -5], [50, -50, -5], [50, 50, -5], [-50, 50, -5]], np.float32)
CORNERS = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)


def walled():
    """A wall, and 200 boxes behind it."""
    boxes = np.array([WALL] + [[[-1, -1, -8 - i], [1, 1, -7.5 - i]] for i in range(200)])
    world = sightline.World()
    return world, world.insert(boxes)


def left(culler, world, view=AHEAD):
    return len(culler.cull(world, view, occlusion="automatic", object_cost=100000))


class Automatic(Case):
    def test_what_hides(self):
        world, handles = walled()
        culler = sightline.Culler()
        self.assertEqual(left(culler, world), 201)
        names = [world.add_solids(boxes=WALL[None].astype(np.float32)), world.add_surface(QUAD, CORNERS),
                 world.add_surface(QUAD, CORNERS, sides="front"),
                 world.add_occluder(sightline.Occluder(QUAD, CORNERS))]
        for name in names:
            world.set_occluders(handles[:1], name)
            self.assertEqual(left(culler, world), 1)
            some = culler.cull(world, AHEAD, occlusion="automatic", object_cost=100000, coverage="area", scale=2)
            self.assertEqual(len(some), 1)
        world.set_occluding(handles[:1], np.array([False]))
        self.assertEqual(left(culler, world), 201)
        world.set_occluders(handles[:1], sightline.NO_OCCLUDER)
        world.remove_occluder(names[0])
        ball = world.add_solids(spheres=np.array([[0, 0, -5, 0.5]], np.float32))
        world.set_occluders(handles[:1], ball)
        self.assertLess(left(sightline.Culler(), world), 201)

    def test_transforms(self):
        world, handles = walled()
        unit = world.add_solids(boxes=np.array([[[0, 0, 0], [1, 1, 1]]], np.float32))
        transform = np.diag([100, 100, 1, 1]).astype(np.float32)
        transform[:3, 3] = WALL[0]
        for given in (transform, transform[None], transform.astype(float)):
            world.set_occluders(handles[:1], np.array([unit], np.uint32), given)
            self.assertEqual(left(sightline.Culler(), world), 1)
        world.set_occluders(handles[:1], unit, transform, origin=(0, 0, -1000))
        self.assertEqual(left(sightline.Culler(), world), 201)

    def test_triangles(self):
        world, handles = walled()
        world.set_occluders(handles[:1], world.add_solids(boxes=WALL[None].astype(np.float32)))
        tall = world.insert(np.array([[[-1, -1, -9], [1, 300, -7.0]]]))
        view = sightline.camera(forward=(0, 1, -1), width=160, height=120)
        before = left(sightline.Culler(), world, view)
        world.set_triangles(tall, np.array([[-1, -1, -8], [1, -1, -8], [0, 1, -8]], np.float32))
        self.assertEqual(left(sightline.Culler(), world, view), before - 1)

    def test_refusals(self):
        world, handles = walled()
        culler = sightline.Culler()
        self.bad("'none' or 'automatic'", culler.cull, world, AHEAD, occlusion="on")
        self.bad("'centres' or 'area'", culler.cull, world, AHEAD, occlusion="automatic", coverage="all")
        self.bad("the buffer's scale", culler.cull, world, AHEAD, occlusion="automatic", scale=3)
        self.bad("a cost", culler.cull, world, AHEAD, occlusion="automatic", object_cost=-1)
        self.bad("frame's time", culler.report_frame_time, -1)
        self.refused("bad_argument", "no occluder of this name", world.remove_occluder, 3, index=3)
        self.refused("bad_argument", "names no occluder", world.set_occluders, handles[:1], 3, index=0)
        self.whole("scale", lambda n: culler.cull(world, AHEAD, scale=n))
        self.whole("name", world.remove_occluder)
        for number in (-1, 1 << 32, 1 << 99):
            self.bad("occluders: expected a whole number from 0 to 4294967295", world.set_occluders, handles[:1], number)
        name = world.add_surface(QUAD, CORNERS)
        self.bad("one a handle", world.set_occluders, handles[:3], np.array([name, name], np.uint32))
        self.bad("one a handle", world.set_occluders, handles[:3], name, np.zeros((2, 4, 4)))
        self.refused("bad_argument", "not affine", world.set_occluders, handles[:1], name, np.zeros((4, 4)), index=0)
        self.refused("bad_mesh", "three points", world.set_triangles, handles[:1], np.zeros((2, 3), np.float32))
        for sides in ("back", [True, False], np.array([True]), "\ud800", None):
            self.bad("sides: expected 'both' or 'front'", world.set_triangles, handles[:1],
                     np.zeros((3, 3), np.float32), sides=sides)
        self.bad("expected one", world.set_triangles, handles[:2], np.zeros((3, 3), np.float32))


if __name__ == "__main__":
    unittest.main()
