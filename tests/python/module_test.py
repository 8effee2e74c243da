"""The Python module: arrays in and out, and what is refused."""
import numpy as np
import sightline


def refused(call, *args, **kwargs):
    try:
        call(*args, **kwargs)
    except ValueError as error:
        return str(error)
    raise AssertionError("not refused")


n = 1000
centres = np.zeros((n, 3))
centres[:, 2] = -5 - 2 * np.arange(n)
boxes = np.stack([centres - 0.5, centres + 0.5], axis=1)

world = sightline.World()
handles = world.insert(boxes)
assert handles.shape == (n, 2) and handles.dtype == np.uint32 and len(world) == n

culler = sightline.Culler()
ahead = sightline.camera(eye=(0, 0, 0))
behind = sightline.camera(eye=(0, 0, 0), forward=(0, 0, 1))
ids = culler.cull(world, [ahead])
assert sorted(ids) == list(range(n)) and ids.dtype == np.uint32
assert len(culler.cull(world, [behind])) == 0
ids, masks = culler.cull(world, [behind, ahead], masks=True)
assert len(ids) == n and (masks == 2).all()
assert 0 < len(culler.cull(world, [ahead], min_area=50)) < n

occlusion = sightline.Occlusion()
occlusion.begin(ahead)
occlusion.draw_boxes(boxes[:1])
assert list(culler.cull(world, [ahead], occlusion=[occlusion])) == [handles[0, 0]]
for bad in (np.nan, np.inf, -np.inf):
    assert "box 1 of 2" in refused(occlusion.draw_boxes, np.stack([boxes[0], np.full((2, 3), bad)]))
assert "box 0 of 1" in refused(occlusion.draw_boxes, boxes[:1, ::-1])

boxes += (1e7, 0, 0)
world.move(handles, boxes)
assert len(culler.cull(world, [ahead])) == 0
assert len(culler.cull(world, [sightline.camera(eye=(1e7, 0, 0))])) == n

world.remove(handles[:10])
assert len(world) == n - 10
assert "handle 0 of 10" in refused(world.remove, handles[:10])
assert "box 0 of 1" in refused(world.insert, np.full((1, 2, 3), np.nan))
assert "shape" in refused(world.insert, np.zeros((3, 3)))
assert "1 to 8 views" in refused(culler.cull, world, [])
assert "field of view" in refused(sightline.camera, eye=(0, 0, 0), fov=9)
assert "before begin" in refused(sightline.Occlusion().draw_boxes, boxes)
print("the Python module holds")
