#!/usr/bin/env python3
"""Writes the `chart` sample: what the substance code and roughness do, on spheres in a photographer's studio.

    make_scene.py -o DIR [--check]

Output: DIR/chart.gltf, chart.bin, textures/*.png and studio.hdr (named by the scene's
extras.burnish.environment). Everything is procedural: no input, no random numbers.

Left, one colour: substance from gem to metal across, perceptual roughness down. Right: named substances.
Lengths below are in cells of the grid; a cell is 10 cm. The chart hangs in the plane z = 0, its middle at the origin.
"""
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "common")]
import scenegen as sg  # noqa: E402
from lettering import Page  # noqa: E402
from scenegen import smooth  # noqa: E402

EV100 = 8.8                     # the exposure this scene is lit for
CELL = 0.1                      # metres

# ---------------------------------------------------------------- what the chart shows

COLOUR = (0.66, 0.095, 0.040)     # the one albedo of the grid
ROUGHNESS = (0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0)
WATER = 1.333                   # the dielectric that metals blend from: the code has no other
# heading, second line, index of refraction, metallic factor
COLUMNS = [("GEM", "0.25", 3.0, 0.0), ("DIAMOND", "0.17", 2.417, 0.0), ("RUBY", "0.08", 1.77, 0.0), ("PLASTIC", "0.04", 1.5, 0.0),
           ("WATER", "0.02", WATER, 0.0), ("", "25%", WATER, 0.25), ("", "50%", WATER, 0.5), ("", "75%", WATER, 0.75),
           ("METAL", "100%", WATER, 1.0)]
DIELECTRICS = 5                 # of the columns

# Named substances, row by row: name, F0 of a conductor or diffuse albedo, index of refraction (none: conductor), roughness.
# F0 and index are those of `burnish inspect --substance NAME`.
NAMED = [("gold", (1.000, 0.729, 0.364), None, 0.16), ("silver", (0.989, 0.984, 0.978), None, 0.16), ("copper", (0.929, 0.624, 0.522), None, 0.16),
         ("brass", (0.908, 0.779, 0.423), None, 0.24), ("aluminium", (0.908, 0.916, 0.922), None, 0.30), ("iron", (0.529, 0.513, 0.494), None, 0.34),
         ("chromium", (0.550, 0.556, 0.554), None, 0.05), ("titanium", (0.618, 0.580, 0.543), None, 0.30), ("platinum", (0.672, 0.637, 0.585), None, 0.16),
         ("plastic", (0.035, 0.19, 0.52), 1.5, 0.28), ("glass", (0.012, 0.016, 0.015), 1.5, 0.05), ("water", (0.008, 0.045, 0.070), WATER, 0.05),
         ("ruby", (0.33, 0.006, 0.022), 1.77, 0.05), ("emerald", (0.008, 0.20, 0.075), 1.58, 0.08), ("diamond", (0.34, 0.36, 0.40), 2.417, 0.05)]

# ---------------------------------------------------------------- layout, in cells

WIDTH, HEIGHT = 16.0, 9.0        # what the camera sees
SHEET = (56 / 3, 10.5)          # the printed sheet; it is wider, so that what the spheres hide fades out beyond the view
GRID_X, GRID_Y = -5.72, 2.42    # the first sphere's centre
NAMED_X, NAMED_Y = 4.22, 2.86   # the same of the named ones
NAMED_STEP = (1.36, 1.52)
GRID_RADIUS, NAMED_RADIUS = 0.45, 0.56
DEPTH = 0.66                    # from the backdrop to the spheres' centres
PAPER, INK = 0.034, 0.78        # albedo of the backdrop and of the labels
PAGE = (3840, 2160)


def grid_spheres():
    """(centre, radius, column, row) of the grid."""
    return [((GRID_X + c, GRID_Y - r), GRID_RADIUS, c, r) for r in range(len(ROUGHNESS)) for c in range(len(COLUMNS))]


def named_spheres():
    """(centre, radius, index) of the named substances, three a row."""
    return [((NAMED_X + NAMED_STEP[0] * (k % 3), NAMED_Y - NAMED_STEP[1] * (k // 3)), NAMED_RADIUS, k) for k in range(len(NAMED))]


# ---------------------------------------------------------------- backdrop

def labels():
    """Everything that is written, as ink on a page that covers the sheet."""
    page = Page((-SHEET[0] / 2, -SHEET[1] / 2, SHEET[0] / 2, SHEET[1] / 2), PAGE)
    top, head, names, values = 3.86, 3.62, 3.34, 3.08
    last = GRID_X + len(COLUMNS) - 1
    split = GRID_X + DIELECTRICS - 0.5
    wide = 2 * NAMED_STEP[0] + 2 * NAMED_RADIUS
    for text, x0, x1 in (("DIELECTRIC  F0", GRID_X - 0.45, split - 0.05), ("METALNESS", split + 0.05, last + 0.45),
                         ("NAMED SUBSTANCES", NAMED_X - NAMED_RADIUS, NAMED_X - NAMED_RADIUS + wide)):
        page.text(text, x0, top, 0.15, 0.0, 0.62)
        page.rule(x0, x1, head, 0.016, 0.30)
    for c, (name, value, _, _) in enumerate(COLUMNS):
        page.text(name, GRID_X + c, names, 0.15)
        page.text(value, GRID_X + c, values, 0.15, 0.5, 0.62)
    page.text("ROUGHNESS", GRID_X - 0.72, values, 0.15, 1.0, 0.62)
    for r, value in enumerate(ROUGHNESS):
        page.text("%.2f" % value, GRID_X - 0.72, GRID_Y - r - 0.09, 0.18, 1.0)
    for (x, y), radius, k in named_spheres():
        page.text(NAMED[k][0].upper(), x, y - radius - 0.265, 0.15)
    return page.ink


def occlusion(width=800, height=450):
    """How much of the studio the backdrop sees past the spheres: a sphere hides (r/d)² cos of it."""
    x = ((np.arange(width) + 0.5) / width - 0.5) * SHEET[0]
    y = (0.5 - (np.arange(height) + 0.5) / height) * SHEET[1]
    open_ = np.ones((height, width))
    for (cx, cy), radius, *_ in grid_spheres() + named_spheres():
        d2 = (x[None] - cx) ** 2 + (y[:, None] - cy) ** 2 + DEPTH ** 2
        open_ *= 1.0 - radius ** 2 * DEPTH / d2 ** 1.5
    edge = np.minimum(SHEET[0] / 2 - np.abs(x)[None], SHEET[1] / 2 - np.abs(y)[:, None])
    return 1.0 - (1.0 - open_) * smooth(0.0, 1.2, edge)         # the sheets around have none


def build_backdrop(g):
    """The printed sheet behind the spheres and plain sheets around it, for views wider than the chart."""
    w, h = SHEET[0] * CELL, SHEET[1] * CELL
    grey = sg.to_srgb(PAPER + (INK - PAPER) * labels())[..., None]
    ao = sg.to_u8(np.repeat(occlusion()[..., None], 3, 2))
    printed = g.material("backdrop", {"base": g.texture("labels", grey)}, metal=0.0, rough=0.9)
    g.materials[printed]["occlusionTexture"] = {"index": g.texture("occlusion", ao)}
    sheet = sg.plane((-w / 2, -h / 2, 0), (w, 0, 0), (0, h, 0), 1.0)
    sheet.uv = sheet.p[:, :2] / (w, -h) + 0.5
    g.node("backdrop", mesh=g.mesh("backdrop", (sheet, printed)))
    plain = g.material("surround", base=[float(PAPER)] * 3, rough=0.9)
    far = 40 * CELL
    sheets = [sg.plane((x0, y0, 0), (x1 - x0, 0, 0), (0, y1 - y0, 0), 1.0)
              for x0, y0, x1, y1 in ((-far, -far, far, -h / 2), (-far, h / 2, far, far), (-far, -h / 2, -w / 2, h / 2), (w / 2, -h / 2, far, h / 2))]
    g.node("surround", mesh=g.mesh("surround", (sg.merge(*sheets), plain)))


# ---------------------------------------------------------------- spheres

def substance_material(g, name, colour, ior, metallic, rough, substance=None):
    """A material without textures: dielectrics by their index of refraction, metals by the metallic factor."""
    index = g.material(name, base=colour, rough=rough, metal=metallic)
    if ior is not None and metallic < 1:
        g.materials[index]["extensions"] = {"KHR_materials_ior": {"ior": ior}}
        g.used.add("KHR_materials_ior")
    if substance:
        g.materials[index]["extras"] = {"burnish": {"substance": substance}}
    return index


def build_spheres(g):
    """One ball of unit radius, drawn once a material."""
    ball = sg.sphere(1.0, 96, 56, sg.TAU)

    def place(name, centre, radius, material):
        at = (centre[0] * CELL, centre[1] * CELL, DEPTH * CELL)
        g.node(name, at, scale=radius * CELL, mesh=g.mesh(name, (ball, material)))

    for centre, radius, c, r in grid_spheres():
        heading, value, ior, metallic = COLUMNS[c]
        name = "%s_%.2f" % ("metal_" + value.rstrip("%") if c >= DIELECTRICS else heading.lower(), ROUGHNESS[r])
        place(name, centre, radius, substance_material(g, name, COLOUR, ior, metallic, ROUGHNESS[r]))
    for centre, radius, k in named_spheres():
        name, colour, ior, rough = NAMED[k]
        place(name, centre, radius, substance_material(g, name, colour, ior, 0.0 if ior else 1.0, rough, name))


# ---------------------------------------------------------------- studio

KEY = (-0.45, 0.80, 0.50)       # toward the key light; no box is there, so that its highlights stand alone
KEY_LUX = 1300.0


class Studio:
    """A lat-long picture in cd/m² to which lamps are added."""

    def __init__(self, width=1024, height=512):
        self.d = sg.sphere_directions(width, height)
        up = self.d[..., 1]
        walls = sg.blend((88, 90, 94), (140, 143, 148), smooth(-0.05, 0.60, up))           # dim, paler toward the ceiling
        floor = sg.blend((26, 25, 24), (120, 117, 113), np.exp(np.minimum(up, 0) / 0.20))   # darker toward the feet
        self.rgb = sg.blend(floor, walls, smooth(-0.02, 0.02, up))
        self.rgb *= (0.40 + 0.60 * smooth(-0.9, 0.5, self.d[..., 2]))[..., None]        # the backdrop's side is darkest

    def _facing(self, toward):
        """Tangent-plane coordinates about a direction, right and up as seen from the middle; behind it nothing."""
        f = sg.unit(np.asarray(toward, float))
        right = sg.unit(np.cross(f, (0.0, 1.0, 0.0) if abs(f[1]) < 0.99 else (0.0, 0.0, -1.0)))
        upward = np.cross(right, f)
        depth = self.d @ f
        depth = np.where(depth > 1e-3, depth, np.inf)
        x, y = self.d @ right / depth, self.d @ upward / depth
        behind = np.isinf(depth)
        return np.where(behind, 99.0, x), np.where(behind, 99.0, y)

    def box(self, toward, half, nits, colour=(1, 1, 1), panes=(1, 1), fall=0.35):
        """A soft box: half its width and height at distance 1, brightest in the middle, with bars between panes."""
        x, y = self._facing(toward)
        u, v = x / half[0], y / half[1]
        edge = 0.008
        mask = smooth(edge, -edge, np.maximum(np.abs(x) - half[0], np.abs(y) - half[1]))
        for w, count, size in ((u, panes[0], half[0]), (v, panes[1], half[1])):
            for k in range(1, count):
                mask = mask * smooth(0.012, 0.024, np.abs(w - (2 * k / count - 1)) * size)
        glow = nits * (1.0 - fall * np.clip((u * u + v * v) / 2, 0, 1))
        self.rgb = sg.blend(self.rgb, glow[..., None] * np.asarray(colour), mask)


def studio():
    """Boxes from large to small, so that a lobe of any width shows its size on one of them."""
    s = Studio()
    s.box((0.0, 1.0, 0.12), (0.75, 0.36), 900, (1.0, 0.98, 0.95))                        # overhead
    s.box((-0.86, 0.34, 0.80), (0.36, 0.36), 2600, (1.0, 0.985, 0.96), (2, 2))         # window, left of the camera
    s.box((1.0, 0.16, 0.42), (0.10, 0.62), 2000, (0.94, 0.97, 1.0))                       # tall strip, right
    for k, half in enumerate((0.075, 0.045, 0.022)):                                      # three small ones, right of the camera and low
        s.box((0.30 + 0.20 * k, -0.30, 1.0), (half, half), 2600, (1.0, 0.97, 0.92), fall=0.1)
    s.box((-0.92, 0.10, -0.62), (0.16, 0.75), 1500, (0.90, 0.95, 1.0))                    # rims, behind on both sides
    s.box((0.80, 0.25, -0.80), (0.20, 0.60), 1300, (1.0, 0.93, 0.85))
    return s.rgb


# ---------------------------------------------------------------- views

def build_views(g):
    """`chart` first: parallel rays, so that all spheres look the same; then close-ups with a lens."""
    g.cameras.append({"name": "chart", "type": "orthographic",
                      "orthographic": {"xmag": WIDTH * CELL / 2, "ymag": HEIGHT * CELL / 2, "znear": 0.01, "zfar": 10.0}})
    g.node("chart", (0, 0, 2.0), camera=0)
    x, y = (NAMED_X + 0.4) * CELL, (NAMED_Y - NAMED_STEP[1] - 0.1) * CELL
    g.camera("metals", (x + 0.60, y - 0.17, 2.60), (x, y, 0.03), 10.6)
    x, y = (GRID_X + 5.5) * CELL, (GRID_Y - 1.10) * CELL
    g.camera("gloss", (x + 0.30, y - 0.10, 2.20), (x, y, 0.05), 11.9)


def build(folder):
    """Make everything and write it to the folder."""
    g = sg.Gltf("Burnish samples/chart/make_scene.py")
    build_views(g)
    build_backdrop(g)
    build_spheres(g)
    g.light("key", "directional", (0, 1, 1), [-k for k in KEY], (1.0, 0.97, 0.93), KEY_LUX)
    sg.write_atomic(os.path.join(folder, "studio.hdr"), sg.hdr_bytes(studio()))
    g.save(folder, "chart", extras={"environment": "studio.hdr", "ev100": EV100})
    return [os.path.join(folder, "chart.gltf")], g.summary()


if __name__ == "__main__":
    sys.exit(sg.run(__doc__, build, "chart"))
