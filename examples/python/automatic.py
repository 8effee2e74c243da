"""Occlusion in one call: houses hide what stands behind them, a gate while it is shut, and nothing is drawn by hand."""
import numpy as np
import sightline

# 65 x 65 lots of 20 m: a house on each, but none on the street that runs down the middle.
x, z = np.meshgrid(20 * np.arange(-32, 33), 20 * np.arange(-32, 33), indexing="ij")
centre = np.stack([x, np.zeros(x.shape), z], axis=-1).reshape(-1, 3)
half = np.where(centre[:, :1] == 0, [[0.5, 1, 0.5]], [[8, 12, 8]])
gate = np.flatnonzero((centre[:, 0] == 0) & (centre[:, 2] == 300))[0]
half[gate] = (9, 12, 1)
boxes = np.stack([centre - half, centre + half], axis=1)

world = sightline.World()
handles = world.insert(boxes)
# One box for all, which fills each house and the gate.
unit = world.add_solids(boxes=np.array([[[-1, -1, -1], [1, 1, 1]]], np.float32))
solid = (half[:, 1] > 1)
transforms = np.tile(np.eye(4, dtype=np.float32), (len(boxes), 1, 1))
transforms[:, [0, 1, 2], [0, 1, 2]], transforms[:, :3, 3] = half, centre
world.set_occluders(handles[solid], unit, transforms[solid])

view = sightline.camera(eye=(0, 1.7, 640), forward=(0.1, 0, -1), width=1280, height=720)
culler = sightline.Culler()
for frame, shut in enumerate([True, True, False]):
    world.set_occluding(handles[[gate]], np.array([shut]))
    drawn = culler.cull(world, view, occlusion="automatic", object_cost=20000)
    in_view = sightline.Culler().cull(world, view)
    print(f"frame {frame}: draw {len(drawn)} of {len(boxes)} things, {len(in_view)} are in view")
    # A renderer tells how long its frames take instead of an object_cost: culler.report_frame_time(0.008)
