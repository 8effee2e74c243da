"""A flight over a million boxes: how many are drawn from where, with and without what hides what."""
import time

import numpy as np
import sightline

rng = np.random.default_rng(1)
n = 1_000_000
centre = rng.uniform((-2000, 0, -2000), (2000, 0, 2000), (n, 3))
half = rng.uniform((0.5, 1, 0.5), (4, 12, 4), (n, 3))

world = sightline.World()
world.insert(sightline.BoxView.centre_half(centre, half))
culler, occlusion = sightline.Culler(), sightline.Occlusion()

print("height   in the frustum        and not hidden")
for height in (2, 20, 100, 500):
    view = sightline.camera(eye=(0, height, 0), forward=(0, -height / 600, -1))
    start = time.perf_counter()
    in_view = culler.cull(world, view)
    middle = time.perf_counter()
    # The nearest of what is in view occludes.
    near = in_view[np.argsort(np.linalg.norm(centre[in_view], axis=1))[:4000]]
    drawing = time.perf_counter()
    occlusion.begin(view)
    occlusion.draw_boxes(sightline.BoxView.centre_half(centre[near], half[near]))
    visible = culler.cull(world, sightline.CullView(view, occlusion=occlusion))
    end = time.perf_counter()
    times = 1e3 * (middle - start), 1e3 * (end - drawing)
    print(f"{height:4} m   {len(in_view):7,} {times[0]:6.2f} ms   {len(visible):7,} {times[1]:6.2f} ms")
