"""Draws from above which houses of a town throw a shadow on what a camera sees, as an SVG. shadows.py FILE.svg"""
import sys

import numpy as np
import sightline

random = np.random.default_rng(7)
places = np.arange(-195.0, 200, 15)
x, z = [axis.ravel() for axis in np.meshgrid(places, places)]
houses = np.zeros((len(x), 2, 3))
houses[:, 0, 0], houses[:, 0, 2] = x - 5, z - 5
houses[:, 1] = np.stack([x + 5, random.uniform(4, 18, len(x)), z + 5], 1)
houses = houses[np.abs(x) > 12]  # a street
world = sightline.World()
world.insert(houses)

camera = sightline.camera(eye=(0, 1.7, 150), forward=(0.1, 0, -1), far=220)
sun = sightline.Light(direction=(3, -1.5, 1), reach=150)
shadow = sightline.shadow_view(sun, camera, 1024)
casters = sightline.ShadowCasters()
casters.begin(shadow, camera)
culler = sightline.Culler()
depth = sightline.Occlusion()
depth.begin(camera)
depth.draw_boxes(houses)
steps = {"in the sun's map": culler.cull(world, shadow),
         "towards the sun": culler.cull(world, sightline.CullView(shadow, casters=casters))}
seen = culler.cull(world, sightline.CullView(camera, occlusion=depth))
casters.receive(world, seen, depth)
steps["shading what is visible"] = culler.cull(world, sightline.CullView(shadow, casters=casters))

COLOURS = ("#b8c0c8", "#e0a030", "#c03020")
fill = {}
for ids, colour in zip(steps.values(), COLOURS):
    fill.update(dict.fromkeys(ids.tolist(), colour))
lines = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="-212 -210 468 444" role="img" '
         'font-family="sans-serif" font-size="9">',
         '<title>A town from above, and which houses throw a shadow on what a camera sees</title>',
         '<rect x="-212" y="-210" width="468" height="444" fill="#fff"/>']
for house, ((x0, _, z0), (x1, _, z1)) in enumerate(houses):
    edge = ' stroke="#203040" stroke-width="2"' if house in seen else ""
    lines.append(f'<rect x="{x0:.0f}" y="{z0:.0f}" width="{x1 - x0:.0f}" height="{z1 - z0:.0f}" '
                 f'fill="{fill.get(house, "#eef0f2")}"{edge}/>')
corners = sightline.view_corners(camera, 220)
outline = " ".join(f"{x:.1f},{z:.1f}" for x, _, z in corners[[0, 1, 5, 4]])
lines.append(f'<polygon points="{outline}" fill="none" stroke="#203040" stroke-width="1.5"/>')
for place, ((name, ids), colour) in enumerate(zip(steps.items(), COLOURS)):
    lines.append(f'<rect x="{-200 + 135 * place}" y="217" width="10" height="10" fill="{colour}"/>'
                 f'<text x="{-186 + 135 * place}" y="226">{len(ids)} {name}</text>')
lines.append("</svg>")
if len(sys.argv) > 1:
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")

print(f"of {len(houses)} houses {len(seen)} are seen; " + ", ".join(f"{len(ids)} {name}" for name, ids in steps.items()))
