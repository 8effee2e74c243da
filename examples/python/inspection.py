"""Draws what a cull looked at, from above, as an SVG: chunks that the camera sees whole, those that were opened, those
that were dropped, and what the camera sees. inspection.py FILE.svg"""
import sys

import numpy as np
import sightline

random = np.random.default_rng(7)
things = 6000
centres = random.uniform(-200, 200, (things, 3)) * [1, 0.02, 1]
halves = random.uniform(0.2, 1.5, (things, 1))
world = sightline.World()
world.insert(np.stack([centres - halves, centres + halves], 1), layers=(1 + (centres[:, 0] > 60)).astype(np.uint32))

camera = sightline.camera(eye=(-20, 3, 150), forward=(0.25, 0, -1), far=260)
view = sightline.CullView(camera, layers=1)
(stats,), boxes = sightline.CullInspector().inspect(world, view)

COLOURS = {"whole": "#2e8b57", "opened": "#e0a030", "dropped": "#b8c0c8"}
lines = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="-224 -210 536 444" role="img" '
         'font-family="sans-serif" font-size="9">',
         '<title>Chunks from above, and what a view does with them</title>',
         '<rect x="-224" y="-210" width="536" height="444" fill="#fff"/>']
for box in boxes[boxes["kind"] == sightline.DEBUG_CHUNK]:
    (x0, _, z0), (x1, _, z1) = box["box"]
    colour = COLOURS["whole" if box["whole"] else "opened" if box["seen"] else "dropped"]
    lines.append(f'<rect x="{x0:.1f}" y="{z0:.1f}" width="{x1 - x0:.1f}" height="{z1 - z0:.1f}" fill="{colour}" '
                 f'fill-opacity="0.25" stroke="{colour}"/>')
corners = sightline.view_corners(camera, 260)
outline = " ".join(f"{x:.1f},{z:.1f}" for x, _, z in corners[[0, 1, 5, 4]])
lines.append(f'<polygon points="{outline}" fill="none" stroke="#203040" stroke-width="1.5"/>')
for place, (name, colour) in enumerate(COLOURS.items()):
    count = stats["chunks"] - stats["chunks_whole"] - stats["chunks_opened"] if name == "dropped" else \
        stats[f"chunks_{name}"]
    lines.append(f'<rect x="{-200 + 135 * place}" y="217" width="10" height="10" fill="{colour}"/>'
                 f'<text x="{-186 + 135 * place}" y="226">{count} chunks {name}</text>')
lines.append("</svg>")
if len(sys.argv) > 1:
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")

print(f"{stats['visible']} of {things} things are seen; {stats['outside']} of {stats['objects']} looked at are outside, "
      f"{stats['by_layers']} in another layer")
