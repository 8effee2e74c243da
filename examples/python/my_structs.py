"""A hundred thousand moving objects in a structured array: boxes are read, and handles written, where they lie."""
import numpy as np
import sightline

thing = np.dtype([("name", "S12"), ("position", "f4", 3), ("half", "f4", 3), ("speed", "f4", 3),
                  ("handle", sightline.handle_dtype)])
things = np.zeros(100_000, thing)
i = np.arange(len(things))
things["position"][:, 0] = 5 * (i % 400) - 1000
things["position"][:, 1] = 1
things["position"][:, 2] = -5 * (i // 400)
things["half"] = 1
things["speed"][:, 2] = np.where(i % 2, 2, -2)

boxes = sightline.BoxView.centre_half(things["position"], things["half"])
world = sightline.World()
world.insert(boxes, handles=things["handle"])

camera = sightline.camera(eye=(0, 2, 10))
culler = sightline.Culler()
for frame in range(3):
    things["position"] += things["speed"] / 60
    world.move(things["handle"], boxes)
    ids = culler.cull(world, camera)  # ids are rows: all were inserted at once into a new world
    nearest = 10 - things["position"][ids, 2].max()
    print(f"frame {frame}: draw {len(ids)} of {len(world)} things, the nearest {nearest:.2f} m ahead")
