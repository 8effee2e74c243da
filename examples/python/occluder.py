"""An occluder of a mesh: a ring of 8,192 triangles, and the few inside it that hide what it hides."""
import numpy as np
import sightline

# A ring of 4 m, 1 m thick: a closed mesh of 128 × 32 quads.
around, across = np.meshgrid(np.arange(128), np.arange(32), indexing="ij")
u, v = 2 * np.pi * around / 128, 2 * np.pi * across / 32
reach = 4 + np.cos(v)
points = np.stack([reach * np.cos(u), np.sin(v), reach * np.sin(u)], axis=-1).reshape(-1, 3).astype(np.float32)
index = lambda i, j: i % 128 * 32 + j % 32
a, b = index(around, across), index(around, across + 1)
c, d = index(around + 1, across + 1), index(around + 1, across)
corners = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3).astype(np.uint32)

occluder = sightline.Occluder(points, corners)  # once, offline or when the mesh is loaded
print(f"{len(corners)} triangles: {len(occluder.indices)} occlude ({occluder.yields})")

view = sightline.camera(eye=(0, 9, 0), forward=(0, -1, 0), up=(0, 0, 1), width=640, height=640)
occlusion = sightline.Occlusion()
hidden = []
for mesh in (sightline.OccluderMesh(points, corners), occluder.mesh()):
    occlusion.begin(view)
    occlusion.draw_mesh(mesh)
    hidden.append(np.isfinite(occlusion.read_nearness()).mean())
print(f"the ring covers {100 * hidden[0]:.1f} % of the image, its occluder {100 * hidden[1]:.1f} %")
