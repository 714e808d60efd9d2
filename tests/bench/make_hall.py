#!/usr/bin/env python3
"""Writes the benchmark scene `hall`: a colonnaded hall open to the sky, with 1 to 1024 point lights.

    make_hall.py -o DIR [--check]

Output: DIR/hall_L{1,16,64,256,1024}.gltf, which share hall.bin, textures/*.png and env.hdr.
The workload, kept comparable with the `atrium` scene that other renderers were timed on:
about 165,000 triangles in 110 draws; 29 materials, 8 of them with base, normal and
occlusion-roughness-metal maps of 512 x 512; a 256 x 128 sky; one directional light and L point
lights of range 2.5 m; no shadows. Camera `bench` stands at (-10.8, 2.3, 0.7) in the nave,
looks at (4, 2.5, -0.4), 60 degrees high: floor, two tiers of columns and arches, galleries,
drapes and spheres of every roughness fill most of the picture, each column over those behind it.
Light is in small units (2 lux, 8 cd): an exposure of 1 suits it, EV100 about -0.26.
"""
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "samples", "common"))
import scenegen as sg  # noqa: E402
from scenegen import Noise, Surface, blend, box, cavity, lathe, merge, plane, smooth, spline, stack  # noqa: E402

COUNTS = (1, 16, 64, 256, 1024)
BAYS = [-12 + 3 * k for k in range(9)]
REACH = 2.5
EV100 = -math.log2(1.2)


# ---------------------------------------------------------------- surfaces

def paving():
    """Pale slabs with dark lozenges at their corners."""
    z = Noise(201)
    u, v = z.x * 4 % 1 - 0.5, z.y * 4 % 1 - 0.5
    lozenge = smooth(0.79, 0.77, np.abs(u) + np.abs(v))
    joint = smooth(0.478, 0.492, np.maximum(np.abs(u), np.abs(v))) * lozenge
    joint = np.maximum(joint, smooth(0.012, 0.004, np.abs(np.abs(u) + np.abs(v) - 0.78)))
    n = z.fbm(4)
    colour = blend((0.13, 0.08, 0.06), (0.52, 0.46, 0.36), lozenge) * (0.7 + 0.6 * n)[..., None] * (1 - 0.6 * joint)[..., None]
    return Surface(2.0, 0.004 * (1 - joint) + 0.002 * n, colour, 0.16 + 0.36 * n + 0.4 * joint, 0 * n, 1 - 0.5 * joint)


def ashlar():
    """Courses of squared stone."""
    z = Noise(202)
    row = np.floor(z.y * 6)
    u, v = (z.x * 3 + 0.5 * (row % 2)) % 1 - 0.5, z.y * 6 % 1 - 0.5
    face = smooth(0.492, 0.47, np.abs(u)) * smooth(0.485, 0.45, np.abs(v))
    tone = z.rng.random((6, 3))[row.astype(int), np.floor(z.x * 3 + 0.5 * (row % 2)).astype(int) % 3]
    n = z.fbm(6, octaves=6)
    colour = blend((0.30, 0.26, 0.21), blend((0.40, 0.31, 0.21), (0.52, 0.43, 0.31), tone), face) * (0.65 + 0.7 * n)[..., None]
    height = 0.010 * face + 0.006 * n
    return Surface(2.4, height, colour, 0.72 + 0.22 * n, 0 * n, cavity(height, 0.02))


def marble():
    """Warm marble with veins, for columns and arches."""
    z = Noise(203)
    x, y = z.warped(3, 0.3)
    vein, n = smooth(0.82, 1.0, z.ridged(4, 2, x, y)), z.fbm(5, octaves=6)
    colour = blend((0.60, 0.53, 0.43), (0.30, 0.24, 0.19), 0.8 * vein) * (0.75 + 0.5 * n)[..., None]
    return Surface(1.5, 0.003 * n - 0.001 * vein, colour, 0.30 + 0.45 * n, 0 * n, 0.85 + 0.15 * n)


def cloth():
    """A plain weave with bands; the material's factor dyes it."""
    z = Noise(204)
    weave = 0.5 + 0.25 * np.sin(z.x * sg.TAU * 64) + 0.25 * np.sin(z.y * sg.TAU * 64)
    band, n = smooth(0.07, 0.05, np.abs(z.y * 3 % 1 - 0.5)), z.fbm(4)
    colour = blend((0.72, 0.72, 0.72), (0.45, 0.40, 0.22), band) * (0.65 + 0.35 * weave)[..., None] * (0.85 + 0.3 * n)[..., None]
    return Surface(1.0, 0.0015 * weave + 0.002 * n, colour, 0.82 + 0.14 * n, 0 * n, 0.8 + 0.2 * weave)


def bronze():
    """Cast bronze, green where it has weathered: the metallic map follows."""
    z = Noise(205)
    n = z.fbm(6, octaves=6)
    green = smooth(0.50, 0.62, n)
    colour = blend((0.71, 0.47, 0.27), (0.17, 0.34, 0.25), green) * (0.85 + 0.3 * z.fbm(24, octaves=3))[..., None]
    return Surface(1.0, 0.004 * n, colour, 0.22 + 0.6 * green, 1 - green, 1 - 0.2 * green)


def render_coat():
    """Lime render for the galleries."""
    z = Noise(206)
    n = z.fbm(8, octaves=6)
    return Surface(2.0, 0.006 * n, blend((0.50, 0.45, 0.36), (0.68, 0.64, 0.55), n), 0.80 + 0.15 * n, 0 * n, 0.88 + 0.12 * n)


def make_materials(g):
    """8 mapped materials and 21 plain ones for the spheres."""
    maps = {s.__name__: g.surface(s.__name__, s()) for s in (paving, ashlar, marble, cloth, bronze, render_coat)}
    mats = {"floor": g.material("floor", maps["paving"]), "wall": g.material("wall", maps["ashlar"]),
            "column": g.material("column", maps["marble"]), "gallery": g.material("gallery", maps["render_coat"]),
            "bronze": g.material("bronze", maps["bronze"])}
    for name, dye in (("crimson", (0.75, 0.09, 0.07)), ("ochre", (0.80, 0.50, 0.12)), ("teal", (0.08, 0.42, 0.44))):
        mats[name] = g.material("drape_" + name, maps["cloth"], dye, two_sided=True)
    for row, (name, colour, metal) in enumerate((("ivory", (0.80, 0.77, 0.70), 0.0), ("gold", (1.0, 0.77, 0.34), 1.0), ("lacquer", (0.55, 0.10, 0.06), 0.5))):
        for k in range(7):
            mats["ball", row, k] = g.material("%s_%d" % (name, k), None, colour, 0.05 + 0.95 * k / 6, metal)
    return mats


# ---------------------------------------------------------------- architecture

def column():
    """A barley-sugar shaft on a moulded base under a moulded cap, 3 m tall."""
    def shaft(u, v):
        r = 0.255 - 0.03 * v + 0.02 * np.cos(sg.TAU * 7 * u + 2.2 * math.pi * v)
        return stack(r * np.sin(u * sg.TAU), 0.30 + 2.42 * v, r * np.cos(u * sg.TAU))
    base = lathe([spline([(0.36, 0.14), (0.385, 0.18), (0.355, 0.215), (0.29, 0.235), (0.31, 0.27), (0.285, 0.305), (0.26, 0.32)], 2)], 24, 1.5)
    cap = lathe([spline([(0.22, 2.70), (0.26, 2.715), (0.235, 2.745), (0.30, 2.79), (0.345, 2.84), (0.36, 2.87)], 2)], 24, 1.5)
    return merge(sg.patch(shaft, 41, 18, 1, 2), base, cap, box((0.8, 0.14, 0.8), (0, 0.07, 0), 0.02, 1.5), box((0.76, 0.14, 0.76), (0, 2.93, 0), 0.02, 1.5))


def arch():
    """A low pointed arch between two columns, springing at Y = 0."""
    offset = 0.3

    def fn(u, v):
        x = -1.40 * np.cos((0.01 + 0.98 * u) * math.pi)
        y = 0.50 * np.sqrt(np.maximum((1.40 + offset) ** 2 - (np.abs(x) + offset) ** 2, 0.0))
        s = 1.0 + 0.115 * np.cos(v * sg.TAU)
        return stack(x * s, y * s, -0.21 * np.sin(v * sg.TAU))
    return sg.patch(fn, 24, 10, 3, 1)


def drape():
    """A hanging of 1.8 x 2.6 m with folds, its top at Y = 0."""
    def fn(u, v):
        down = 1 - v
        fold = (0.05 + 0.15 * down) * np.sin(sg.TAU * 4 * u + 0.9 * np.sin(3 * down)) + 0.04 * np.sin(7 * down + 2 * u)
        return stack((u - 0.5) * (1.8 - 0.12 * np.sin(math.pi * down)), -2.6 * down - 0.06 * np.sin(math.pi * u), fold)
    return sg.patch(fn, 32, 18, 2, 2.9)


def wreath():
    """A closed knot of bronze rope, about 1.3 m across."""
    a = np.linspace(0, sg.TAU, 128, endpoint=False)
    r = 0.46 + 0.17 * np.cos(2.5 * 2 * a)
    return sg.tube(stack(r * np.cos(2 * a), r * np.sin(2 * a), 0.2 * np.sin(5 * a)), 0.085, 12, 1.0, True)


def gallery():
    """A slab along the whole hall, subdivided, with a lip over the nave (towards +z)."""
    x = np.linspace(0, 24, 25)
    return merge(plane((-12, 4.1, 0), (24, 0, 0), (0, 0, -2.4), 2.0, x, np.linspace(0, 2.4, 4)),
                 plane((-12, 3.8, -2.4), (24, 0, 0), (0, 0, 2.4), 2.0, x, np.linspace(0, 2.4, 4)),
                 plane((-12, 3.8, 0), (24, 0, 0), (0, 0.3, 0), 2.0, x),
                 box((24, 0.10, 0.08), (0, 4.03, 0.04), 0.015, 2.0, 0))


def build_shell(g, mats):
    """Floor, four walls, two galleries."""
    cut = lambda length, n: np.linspace(0, length, n + 1)
    sheets = {"floor": plane((-12, 0, 5), (24, 0, 0), (0, 0, -10), 2.0, cut(24, 48), cut(10, 20))}
    for name, start, right in (("north", (-12, 0, -5), (24, 0, 0)), ("south", (12, 0, 5), (-24, 0, 0)),
                               ("east", (12, 0, -5), (0, 0, 10)), ("west", (-12, 0, 5), (0, 0, -10))):
        length = abs(right[0]) + abs(right[2])
        sheets["wall_" + name] = plane(start, right, (0, 8, 0), 2.4, cut(length, 2 * length), cut(8, 16))
    for name, mesh in sheets.items():
        g.node(name, mesh=g.mesh(name, (mesh, mats["floor" if name == "floor" else "wall"])))
    slab = g.mesh("gallery", (gallery(), mats["gallery"]))
    g.node("gallery_north", (0, 0, -2.6), mesh=slab)
    g.node("gallery_south", (0, 0, 2.6), 180, mesh=slab)


def build_hall(g, mats):
    """The arcades, and what stands and hangs in them."""
    shaft, bow = g.mesh("column", (column(), mats["column"])), g.mesh("arch", (arch(), mats["column"]))
    for z in (-2.6, 2.6):
        for y in (0.0, 4.1):
            for x in BAYS:
                g.node("column", (x, y, z), mesh=shaft)
            for x in BAYS[:-1]:
                g.node("arch", (x + 1.5, y + 2.97, z), mesh=bow)
    ball = sg.sphere(0.32, 32, 20, 0.5)
    for row in range(3):
        for k in range(7):
            g.node("ball", (-6.0 + 2 * k, 0.32, 1.4 * (row - 1)), mesh=g.mesh("ball", (ball, mats["ball", row, k])))
    hanging, dyes = drape(), ("crimson", "ochre", "teal")
    kinds = [g.mesh("drape_" + d, (hanging, mats[d])) for d in dyes]
    for k in range(5):
        g.node("drape", (-9 + 4.5 * k, 6.95, -2.5), mesh=kinds[k % 3])
        g.node("drape", (-9 + 4.5 * k, 6.95, 2.5), 180, mesh=kinds[(k + 1) % 3])
    knot = g.mesh("wreath", (wreath(), mats["bronze"]))
    for k, x in enumerate((-7.5, -1.5, 4.5, 10.5)):
        g.node("wreath", (x, 5.5, -3.8 if k % 2 else 3.8), 30 * k, mesh=knot)


# ---------------------------------------------------------------- light

def point_lights():
    """1024 (position, colour); the first stands in view."""
    rng = np.random.Generator(np.random.PCG64(2101))
    at = rng.uniform((-11.5, 0.3, -4.6), (11.5, 7.5, 4.6), (max(COUNTS), 3))
    hue = rng.random(max(COUNTS))[:, None] * 6 + np.array([0.0, 4.0, 2.0])
    colour = 0.3 + 0.7 * np.clip(np.abs(hue % 6 - 3) - 1, 0, 1)
    at[0], colour[0] = (-7.0, 2.2, 0.3), (1.0, 0.85, 0.6)
    return np.round(at, 4), np.round(colour, 4)


def add_lights(g, count, at, colour):
    """The sun and the first `count` points; more lights are each dimmer."""
    candela = 8.0 / max(1.0, count / 64.0) ** 0.6
    g.light("sun", "directional", (0, 12, 0), (-0.35, -1.0, -0.28), (1.0, 0.94, 0.84), 2.0)
    for k in range(count):
        g.light("point_%d" % k, "point", at[k], None, colour[k], candela, REACH)


def sky(width=256, height=128):
    """A clear sky with a soft glow about the sun, and warm ground."""
    d = sg.sphere_directions(width, height)
    up = d[..., 1]
    near = np.clip(d @ sg.unit(np.array([0.35, 1.0, 0.28])), 0, 1)
    above = blend((0.46, 0.50, 0.55), (0.10, 0.20, 0.46), np.clip(up, 0, 1) ** 0.5)
    above = above + (near ** 48)[..., None] * np.array((2.4, 2.0, 1.4))
    below = blend((0.22, 0.20, 0.17), (0.08, 0.07, 0.06), np.clip(-up, 0, 1))
    return blend(below, above, smooth(-0.02, 0.02, up))


def build(folder):
    """Make everything and write one file per light count."""
    g = sg.Gltf("Burnish tests/bench/make_hall.py")
    g.camera("bench", (-10.8, 2.3, 0.7), (4.0, 2.5, -0.4), 60.0, 0.1, 100.0)
    mats = make_materials(g)
    build_shell(g, mats)
    build_hall(g, mats)
    sg.write_atomic(os.path.join(folder, "env.hdr"), sg.hdr_bytes(sky()))
    at, colour = point_lights()
    nodes, paths = len(g.nodes), []
    for count in COUNTS:
        add_lights(g, count, at, colour)
        name = "hall_L%d" % count
        g.save(folder, name, "hall.bin", {"environment": "env.hdr", "ev100": EV100}, shared=not paths)
        paths.append(os.path.join(folder, name + ".gltf"))
        summary = g.summary()
        del g.nodes[nodes:], g.lights[:]
    return paths, summary


if __name__ == "__main__":
    sys.exit(sg.run(__doc__, build, "hall"))
