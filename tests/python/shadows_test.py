"""Who throws shadows in a thousand random worlds, held against NumPy."""
import unittest

import numpy as np
import sightline
from support import Case


def in_view(view, points):
    """Which points (n, 3) a view sees."""
    moved = np.c_[points - np.array(view.origin), np.ones(len(points))]
    clip = moved @ (view.eye_to_clip.astype(float) @ view.world_to_eye.astype(float)).T
    w = clip[:, 3]
    return (np.abs(clip[:, :2]) <= w[:, None]).all(1) & (clip[:, 2] >= 0) & (clip[:, 2] <= w)


def met(boxes, start, along):
    """bool (points, boxes): whether the segment from a point meets a box (n, 2, 3)."""
    with np.errstate(divide="ignore"):
        times = (boxes[None] - start[:, None, None]) / along[:, None, None]
    return np.maximum(times.min(2).max(2), 0) <= np.minimum(times.max(2).min(2), 1)


class Shadows(Case):
    def test_lose_nobody_between_a_point_in_view_and_the_light(self):
        casting = kept = could = 0
        for seed in range(1000):
            random = np.random.default_rng(seed)
            low = random.uniform(-60, 60, (80, 3))
            boxes = np.stack([low, low + random.uniform(0, 15, (80, 3))], 1)
            world = sightline.World()
            ids = world.insert(boxes)[:, 0]
            camera = sightline.camera(eye=tuple(random.uniform(-20, 20, 3)), forward=(random.uniform(-1, 1), 0, -1),
                                      far=80)
            kind = ("directional", "spot", "point")[seed % 3]
            direction, position = random.normal(size=3), random.uniform(-40, 40, 3)
            light = sightline.Light(kind, direction=tuple(direction), position=tuple(position))
            shadow = sightline.shadow_view(light, camera, 512, face=seed % 6 if kind == "point" else 0)
            casters = sightline.ShadowCasters()
            casters.begin(shadow, camera)
            culler = sightline.Culler()
            every = culler.cull(world, shadow)
            left = culler.cull(world, sightline.CullView(shadow, casters=casters))
            self.assertTrue(np.isin(left, every).all())
            points = random.uniform(-60, 60, (600, 3))
            points = points[in_view(camera, points) & in_view(shadow, points)]
            along = np.broadcast_to(-300 * direction, points.shape) if kind == "directional" else position - points
            casts = ids[met(boxes, points, along).any(0)]
            casts = casts[np.isin(casts, every)]
            self.assertTrue(np.isin(casts, left).all(), f"seed {seed}")
            casting, kept, could = casting + len(casts), kept + len(left), could + len(every)
            casters.receive(world, culler.cull(world, camera))
            self.assertTrue(np.isin(culler.cull(world, sightline.CullView(shadow, casters=casters)), left).all())
        self.assertGreater(casting, 1000)
        self.assertLess(kept, 0.95 * could)

    def test_cascades_follow_one_another(self):
        sun, camera = sightline.Light(direction=(1, -2, 0)), sightline.camera(far=500)
        cascades = sightline.split_cascades(sun, camera, 4, depths=(0.1, 200))
        self.assertEqual([near for _, (near, _) in cascades[1:]], [far for _, (_, far) in cascades[:-1]])
        self.assertEqual(cascades[0][0].width, 2048)

    def test_refusals(self):
        light, camera = sightline.Light(), sightline.camera(far=np.inf)
        self.bad("kind: expected", sightline.Light, "moon")
        self.bad("infinitely far", sightline.shadow_view, light, camera)
        self.bad("expected 1 to 16", sightline.split_cascades, light, camera, 17)
        self.whole("pixels", lambda n: sightline.shadow_view(light, sightline.camera(), n))
        self.whole("face", lambda n: sightline.shadow_view(light, sightline.camera(), face=n))
        self.whole("count", lambda n: sightline.split_cascades(light, sightline.camera(), n))
        self.whole("pixels", lambda n: sightline.split_cascades(light, sightline.camera(), 4, pixels=n))
        casters = sightline.ShadowCasters()
        self.assertIsNone(casters.view)
        view = sightline.CullView(camera, casters=casters)
        self.refused("stale_buffer", "never begun", sightline.Culler().cull, sightline.World(), view, index=0)
        casters.begin(sightline.camera(), sightline.camera())
        self.refused("stale_buffer", "another view", sightline.Culler().cull, sightline.World(), view, index=0)
        self.refused("bad_argument", "no object", casters.receive, sightline.World(), np.array([3], np.uint32), index=0)


if __name__ == "__main__":
    unittest.main()
