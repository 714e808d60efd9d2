#!/usr/bin/env python3
"""Writes the `fps` sample: a workshop hall, a corridor, a store and a vault at dusk.

    make_scene.py -o DIR [--check]

Output: DIR/fps.gltf, fps.bin, textures/*.png and sky.hdr (named by the scene's
extras.burnish.environment). Everything is procedural: no input, fixed seeds.

Plan, metres, seen from above (x to the right, z down):

      z -19  +--------vault-------+          vault     x -6..2   z -19..-12.3  height 4.4
             |       statue       |          corridor  x -3.1..-0.9 z -12.3..-6 height 2.8
     -12.3   +-----+      +-------+          hall      x -4..4   z -6..6       height 4.2
                   | corr.|                  store     x -10..-4.3 z -6..0     height 3.2
       -6  +-------+-+    +--------+
           | store  door  hall     =  door to the yard and the sun (x 4, z -2)
        0  +--------+              |
        6           +--------------+
"""
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))
import scenegen as sg  # noqa: E402
from scenegen import Noise, Surface, blend, blur, box, cavity, lathe, merge, plane, ring, smooth, spline, stack, tube  # noqa: E402

EV100 = 5.8                     # the exposure this scene is lit for
WALL = 0.3                      # thickness of the inner walls
GOLD, IRON = (1.0, 0.77, 0.34), np.array((0.56, 0.57, 0.58))
RUST = np.array((0.235, 0.088, 0.030))

# name: x0, x1, z0, z1, height, floor material, wall material
ROOMS = {
    "hall": (-4.0, 4.0, -6.0, 6.0, 4.2, "floor", "brick"),
    "corridor": (-3.1, -0.9, -12.3, -6.3, 2.8, "concrete", "plaster"),
    "store": (-10.0, -4.3, -6.0, 0.0, 3.2, "concrete", "brick"),
    "vault": (-6.0, 2.0, -19.0, -12.6, 4.4, "floor", "plaster"),
}
# the wall it is in, its centre along the wall, its width and height
OPENINGS = {
    "yard": ("x", 4.0, -2.0, 2.0, 2.7),
    "store": ("x", -4.3, -3.9, 1.4, 2.3),
    "corridor": ("z", -6.3, -2.0, 1.7, 2.35),
    "vault": ("z", -12.6, -2.0, 1.7, 2.35),
}
ARMILLARY_SPOT = (-0.7, 3.52, 0.12)
LAMPS = [(-2.0, 2.95, -3.7), (2.0, 2.95, -3.7), (-2.0, 2.95, 1.3), (2.0, 2.95, 1.3)]
WARM, TUNGSTEN = (1.0, 0.83, 0.62), (1.0, 0.64, 0.32)


# ---------------------------------------------------------------- surfaces

def brick_surface():
    """Running bond, 200 x 80 mm, every brick its own colour and set."""
    z = Noise(101)
    row = np.floor(z.y * 20).astype(int)
    bx = z.x * 8 + 0.5 * (row % 2)
    col = np.floor(bx).astype(int) % 8
    wobble = 0.03 * (z.fbm(16, octaves=3) - 0.5)
    dx = 0.1 - np.abs(bx % 1 - 0.5) * 0.2 + wobble * 0.1        # metres to the joint's middle
    dy = 0.04 - np.abs(z.y * 20 % 1 - 0.5) * 0.08 + wobble * 0.1
    face = smooth(0.003, 0.010, np.minimum(dx, dy))
    per = z.rng.random((20, 8, 3))[row, col]
    grit, stain = z.fbm(32, octaves=4), z.fbm(3, octaves=4)
    clay = blend((0.47, 0.205, 0.115), (0.29, 0.118, 0.078), per[..., 0])
    clay = blend(clay, (0.56, 0.345, 0.205), smooth(0.75, 0.95, per[..., 1]))
    clay = clay * (0.72 + 0.56 * grit)[..., None]
    mortar = np.array((0.50, 0.46, 0.40)) * (0.75 + 0.5 * grit)[..., None]
    colour = blend(mortar, clay, face) * (0.78 + 0.44 * stain)[..., None]
    height = 0.007 * face + 0.0022 * grit + 0.0025 * (per[..., 2] - 0.5) * face
    rough = 0.93 - 0.16 * face + 0.1 * (grit - 0.5)
    return Surface(1.6, height, colour, rough, 0 * face, cavity(height, 0.012))


def plaster_surface():
    """Old lime plaster: trowel marks and faint stains."""
    z = Noise(102)
    soft, grit = z.fbm(4, octaves=4), z.fbm(32, octaves=3)
    colour = blend((0.60, 0.54, 0.44), (0.70, 0.66, 0.58), smooth(0.3, 0.7, soft)) * (0.9 + 0.2 * grit)[..., None]
    height = 0.004 * soft + 0.0006 * grit
    return Surface(2.0, height, colour, 0.86 + 0.1 * grit, 0 * soft, cavity(height, 0.005))


def floor_surface():
    """Half-metre slabs of polished dark and pale marble, worn dull in places."""
    z = Noise(103)
    ix, iy = np.floor(z.x * 4).astype(int), np.floor(z.y * 4).astype(int)
    dark = ((ix + iy) % 2).astype(float)
    edge = 0.25 - np.maximum(np.abs(z.x * 4 % 1 - 0.5), np.abs(z.y * 4 % 1 - 0.5)) * 0.5
    slab = smooth(0.0015, 0.006, edge)
    shift = z.rng.random((4, 4, 2))[iy, ix]
    wx, wy = z.warped(4, 0.25)
    wx, wy = wx + shift[..., 0], wy + shift[..., 1]
    vein = np.maximum(smooth(0.945, 1.0, z.ridged(3, 1, wx, wy)), 0.5 * smooth(0.93, 1.0, z.ridged(8, 1, wx, wy)))
    cloud, wear = z.fbm(5, octaves=4), z.fbm(3, octaves=3)
    pale = blend((0.50, 0.45, 0.36), (0.63, 0.585, 0.50), cloud) * (1 - 0.40 * vein)[..., None]
    deep = blend((0.030, 0.042, 0.038), (0.065, 0.080, 0.072), cloud)
    deep = blend(deep, (0.30, 0.31, 0.27), 0.6 * vein)
    colour = blend(pale, deep, dark) * (0.85 + 0.3 * shift[..., :1])
    colour = blend((0.10, 0.09, 0.08), colour, slab)
    scuff = z.scratches(70, 0.2, 0.9)
    rough = 0.09 + 0.20 * smooth(0.42, 0.72, wear) + 0.05 * cloud + 0.07 * scuff
    rough = rough * slab + 0.8 * (1 - slab)
    tilt = (shift - 0.5) * 0.0022                               # slabs are never quite level
    height = 0.002 * slab + tilt[..., 0] * (z.x * 4 % 1) + tilt[..., 1] * (z.y * 4 % 1) + 0.00025 * wear
    return Surface(2.0, height, colour, rough, 0 * slab, 0.45 + 0.55 * slab)


def wood_surface():
    """Straight-grained oak; the grain runs along u."""
    z = Noise(104)
    bend = 0.05 * (z.fbm(2, 3, 3) - 0.5)
    rings = z.fbm(1, 24, 3, 0.5, z.x, z.y + bend)
    fibre = z.fbm(9, 176, 2, 0.6, z.x, z.y + bend)
    broad = z.fbm(2, 6, 3)
    grain = smooth(0.25, 0.75, rings)
    pore = smooth(0.62, 0.80, fibre)
    colour = blend((0.36, 0.195, 0.088), (0.185, 0.088, 0.037), grain) * (0.75 + 0.5 * broad)[..., None]
    colour = colour * (1 - 0.3 * pore)[..., None]
    height = 0.0012 * rings - 0.0006 * pore + 0.001 * broad
    return Surface(1.6, height, colour, 0.42 + 0.22 * pore + 0.12 * grain, 0 * grain, 1 - 0.35 * pore)


def paint_surfaces():
    """Painted sheet steel: paint (dielectric), bare iron (conductor) at the chips' rims, rust within."""
    z = Noise(105)
    wx, wy = z.warped(6, 0.10)
    chip = z.fbm(4, octaves=6, gain=0.58, x=wx, y=wy)
    drip = z.fbm(16, 3, 3)
    score = z.scratches(46, 0.22, 1.3)
    worn = chip + 0.07 * (drip - 0.5) + 0.16 * score
    bare = smooth(0.612, 0.622, worn)
    rust = smooth(0.626, 0.650, worn - 0.10 * score) * bare
    halo = smooth(0.50, 0.63, worn) * (1 - bare) * smooth(0.35, 0.65, drip)
    grit, cloud = z.fbm(48, octaves=3), z.fbm(5, octaves=4)
    oxide = blend(RUST * 0.55, RUST * 1.5, smooth(0.3, 0.7, grit))
    steel = np.broadcast_to(IRON, oxide.shape) * (0.85 + 0.25 * grit)[..., None]
    height = 0.0009 * (1 - bare) + 0.0012 * rust * grit + 0.0004 * cloud + 0.00006 * z.fbm(64, octaves=2)
    rough = (0.30 + 0.16 * cloud + 0.25 * halo) * (1 - bare) + bare * (0.34 + 0.1 * grit)
    rough = rough * (1 - rust) + (0.80 + 0.15 * grit) * rust
    out = {}
    for name, paint in (("green", (0.070, 0.145, 0.098)), ("red", (0.40, 0.045, 0.028)), ("blue", (0.052, 0.125, 0.215))):
        coat = np.asarray(paint) * (0.82 + 0.36 * cloud)[..., None]
        coat = blend(coat, RUST * 1.2, 0.55 * halo)
        out[name] = blend(blend(coat, steel, bare), oxide, rust)
    shared = Surface(1.5, height, None, rough, bare * (1 - rust), 1 - 0.35 * rust * (1 - grit))
    return shared, out


def steel_surface():
    """Mill-finished iron with rust blooms: the metallic map falls to 0 inside them."""
    z = Noise(106)
    wx, wy = z.warped(5, 0.15)
    bloom = z.fbm(4, octaves=6, gain=0.6, x=wx, y=wy)
    rust = smooth(0.54, 0.66, bloom)
    grit, brush = z.fbm(48, octaves=3), z.fbm(4, 128, 2)
    iron = np.broadcast_to(IRON, rust.shape + (3,)) * (0.80 + 0.2 * brush + 0.1 * grit)[..., None]
    oxide = blend(RUST * 0.5, RUST * 1.4, smooth(0.3, 0.7, grit))
    height = 0.0010 * rust * (0.4 + grit) + 0.00012 * brush
    rough = (0.30 + 0.18 * brush) * (1 - rust) + (0.82 + 0.12 * grit) * rust
    return Surface(1.0, height, blend(iron, oxide, rust), rough, 1 - rust, 1 - 0.4 * rust * (1 - grit))


def gold_surface():
    """Polished gold leaf: colour comes from the factor; fine scratches and hand polish."""
    z = Noise(107)
    cloud, fine = z.fbm(4, octaves=4), z.fbm(24, octaves=3)
    score = z.scratches(120, 0.12, 0.8)
    rough = 0.15 + 0.17 * smooth(0.35, 0.7, cloud) + 0.10 * score + 0.05 * (fine - 0.5)
    height = 0.0006 * cloud + 0.00010 * fine - 0.00004 * score
    return Surface(0.6, height, None, rough, 1 + 0 * cloud, 1 + 0 * cloud)


def stone_surface():
    """Honed travertine with small pits."""
    z = Noise(108)
    band, grit = z.fbm(2, 9, 5), z.fbm(24, octaves=3)
    pit = smooth(0.60, 0.72, z.fbm(26, 64, 2)) * smooth(0.45, 0.65, z.fbm(4, 12, 3))
    colour = blend((0.44, 0.37, 0.27), (0.62, 0.55, 0.44), smooth(0.3, 0.7, band)) * (0.88 + 0.24 * grit)[..., None]
    colour = colour * (1 - 0.35 * pit)[..., None]
    height = 0.0004 * grit - 0.0016 * pit
    return Surface(1.5, height, colour, 0.34 + 0.2 * grit + 0.35 * pit, 0 * pit, 1 - 0.55 * pit)


def concrete_surface():
    """Power-floated concrete, sealed: roughness wanders from satin to dull."""
    z = Noise(109)
    cloud, grit, wear = z.fbm(3, octaves=3), z.fbm(40, octaves=3), z.fbm(4, octaves=3)
    colour = blend((0.25, 0.24, 0.22), (0.37, 0.355, 0.33), smooth(0.25, 0.75, cloud)) * (0.9 + 0.2 * grit)[..., None]
    height = 0.0006 * cloud + 0.00015 * grit
    rough = 0.22 + 0.30 * smooth(0.30, 0.70, wear) + 0.06 * grit
    return Surface(2.5, height, colour, rough, 0 * cloud, 1 + 0 * cloud)


def chart_surface():
    """An old sea chart: land, shoals, a coast line, meridians and a compass rose's rays."""
    z = Noise(111)
    wx, wy = z.warped(5, 0.08)
    land = z.fbm(2, 3, 6, 0.52, wx, wy)
    age, grit = z.fbm(4, octaves=4), z.fbm(40, octaves=2)
    colour = blend((0.36, 0.40, 0.335), (0.47, 0.47, 0.36), smooth(0.40, 0.50, land))
    colour = blend(colour, blend((0.60, 0.45, 0.235), (0.40, 0.30, 0.15), smooth(0.55, 0.75, land)), smooth(0.510, 0.516, land))
    grid = np.minimum(np.abs(z.x * 12 % 1 - 0.5), np.abs(z.y * 12 % 1 - 0.5))
    rays = np.abs(np.sin(8 * np.arctan2(z.y - 0.36, z.x - 0.27))) * np.hypot(z.x - 0.27, z.y - 0.36)
    ink = 0.75 * smooth(0.008, 0.003, np.abs(land - 0.512)) + 0.25 * smooth(0.03, 0.012, grid) + 0.3 * smooth(0.020, 0.010, rays)
    colour = blend(colour, (0.09, 0.055, 0.03), np.clip(ink, 0, 0.85)) * (0.65 + 0.55 * age + 0.1 * grit)[..., None]
    return Surface(1.3, 0.0006 * age + 0.0002 * grit, colour, 0.62 + 0.2 * age, 0 * age, 1 + 0 * age)


def make_materials(g):
    """Every material of the scene by name."""
    surfaces = {"brick": brick_surface(), "plaster": plaster_surface(), "floor": floor_surface(), "wood": wood_surface(),
                "steel": steel_surface(), "gold": gold_surface(), "stone": stone_surface(), "concrete": concrete_surface(), "chart": chart_surface()}
    maps = {name: g.surface(name, s) for name, s in surfaces.items()}
    mats = {name: g.material(name, m, GOLD if name == "gold" else (1, 1, 1)) for name, m in maps.items()}
    shared, coats = paint_surfaces()
    common = g.surface("paint", shared)
    for name, colour in coats.items():
        base = g.texture("paint_%s_base" % name, sg.to_srgb(colour))
        mats["paint_" + name] = g.material("paint_" + name, dict(common, base=base))
    mats["wood_dark"] = g.material("wood_dark", maps["wood"], (0.60, 0.54, 0.50), rough=0.9)
    mats["brass"] = g.material("brass", maps["gold"], (0.91, 0.72, 0.38), rough=1.0)
    mats["enamel"] = g.material("enamel", base=(0.75, 0.73, 0.68), rough=0.35)
    mats["iron_black"] = g.material("iron_black", base=(0.035, 0.034, 0.033), rough=0.45)
    mats["bulb"] = g.material("bulb", base=(0.8, 0.8, 0.8), rough=0.4, emit=(1.0, 0.80, 0.55), nits=450.0)
    mats["flame"] = g.material("flame", base=(0.8, 0.8, 0.8), rough=0.4, emit=(1.0, 0.55, 0.20), nits=260.0)
    return mats


# ---------------------------------------------------------------- rooms

def grid_lines(length, step, cuts=()):
    """Grid lines at about `step`, finer near both ends, and at every cut."""
    near = [0.0, 0.08, 0.22, 0.45]
    lines = list(np.linspace(0, length, max(2, round(length / step) + 1)))
    lines += near + [length - x for x in near] + [c for c in cuts if 0 < c < length]
    lines = sorted(round(x, 4) for x in lines if 0 <= x <= length)
    kept = [lines[0]]
    exact = {round(c, 4) for c in cuts} | {0.0, round(length, 4)}
    for x in lines[1:]:
        if x - kept[-1] > 0.05:
            kept.append(x)
        elif x in exact and x > kept[-1]:
            kept[-1] = x if kept[-1] not in exact else kept[-1]
            if kept[-1] != x:
                kept.append(x)
    return np.array(kept)


def grime(distance, depth=0.38, reach=0.30):
    """How much a crease that far away darkens a surface."""
    return 1.0 - depth * np.exp(-np.maximum(distance, 0.0) / reach)


def shade(mesh, room, footprints=()):
    """Vertex colours: dirt where planes of the room meet and where things stand."""
    x0, x1, z0, z1, h = room[:5]
    p, n = mesh.p, np.abs(mesh.n)
    c = np.ones(len(p))
    for axis, lo, hi in ((0, x0, x1), (1, 0.0, h), (2, z0, z1)):
        d = np.minimum(p[:, axis] - lo, hi - p[:, axis])
        c *= np.where(n[:, axis] > 0.5, 1.0, grime(d))
    for fx0, fx1, fz0, fz1 in footprints:
        dx = np.maximum(np.maximum(fx0 - p[:, 0], p[:, 0] - fx1), 0)
        dz = np.maximum(np.maximum(fz0 - p[:, 2], p[:, 2] - fz1), 0)
        c *= np.where(p[:, 1] < 0.01, grime(np.hypot(dx, dz), 0.62, 0.16), 1.0)
    mesh.c = np.repeat(c[:, None], 3, 1)
    return mesh


def wall(start, right, height, metres, doors):
    """A wall seen from the front, with (centre, width, height) doors left open."""
    length = float(np.linalg.norm(right))
    cuts = [c + s * w / 2 for c, w, _ in doors for s in (-1, 1)]
    us, vs = grid_lines(length, 0.8, cuts), grid_lines(height, 0.8, [t for _, _, t in doors])

    def keep(u, v):
        solid = np.ones_like(u, bool)
        for c, w, t in doors:
            solid &= ~((np.abs(u - c) < w / 2) & (v < t))
        return solid
    return plane(start, right, (0, height, 0), metres, us, vs, keep)


def room_doors(room, axis, at):
    """The openings in the wall of a room at that coordinate, by position along +x or +z."""
    out = []
    for kind, where, centre, width, height in OPENINGS.values():
        if kind == axis and where - 0.01 <= at <= where + WALL + 0.01:
            out.append((centre, width, height))
    return out


def room_shell(room):
    """Floor, ceiling and walls of one room as meshes by material name."""
    x0, x1, z0, z1, h, floor, skin = room
    dx, dz = x1 - x0, z1 - z0
    metres = {"brick": 1.6, "plaster": 2.0}[skin]
    walls = []
    for start, right, axis, at in (((x0, 0, z0), (dx, 0, 0), "z", z0), ((x1, 0, z1), (-dx, 0, 0), "z", z1),
                                   ((x0, 0, z1), (0, 0, -dz), "x", x0), ((x1, 0, z0), (0, 0, dz), "x", x1)):
        doors = []
        for centre, width, height in room_doors(room, axis, at):
            origin, sign = (start[0], right[0]) if axis == "z" else (start[2], right[2])
            along = (centre - origin) * (1 if sign > 0 else -1)
            if 0 < along < max(abs(right[0]), abs(right[2])):
                doors.append((along, width, height))
        walls.append(wall(start, right, h, metres, doors))
    lines = lambda length: np.linspace(0, length, round(length / 0.25) + 1)
    ground = plane((x0, 0, z1), (dx, 0, 0), (0, 0, -dz), 2.0 if floor == "floor" else 2.5, lines(dx), lines(dz))
    top = plane((x0, h, z0), (dx, 0, 0), (0, 0, dz), 2.0, grid_lines(dx, 0.8), grid_lines(dz, 0.8))
    return {"walls": merge(*walls), "floor": ground, "ceiling": top}


def build_rooms(g, mats, footprints):
    """Shells, skirting and door frames."""
    for name, room in ROOMS.items():
        shell = room_shell(room)
        for part, material in (("floor", room[5]), ("walls", room[6]), ("ceiling", "plaster")):
            mesh = shade(shell[part], room, footprints if part == "floor" else ())
            g.node("%s_%s" % (name, part), mesh=g.mesh("%s_%s" % (name, part), (mesh, mats[material])))
    for name, opening in OPENINGS.items():
        frame = "paint_green" if name == "yard" else "wood_dark"
        mesh = g.mesh("frame_" + name, (door_frame(opening), mats[frame]))
        g.node("frame_" + name, opening_middle(opening), 0 if opening[0] == "x" else 90, mesh=mesh)


def opening_middle(opening):
    """The floor point in the middle of an opening's wall."""
    axis, at, centre = opening[:3]
    return (at + WALL / 2, 0, centre) if axis == "x" else (centre, 0, at + WALL / 2)


def door_frame(opening):
    """Jambs, head and sill lining an opening; the wall's thickness is along x."""
    width, height = opening[3:]
    t, d = 0.13, WALL + 0.10
    grow = lambda size, at, grain: box(size, at, 0.014, 1.6, grain)
    return merge(grow((d, height + 0.09, t), (0, (height + 0.09) / 2, -width / 2 - 0.02), 1),
                 grow((d, height + 0.09, t), (0, (height + 0.09) / 2, width / 2 + 0.02), 1),
                 grow((d + 0.03, 0.16, width + 0.30), (0, height + 0.03, 0), 2),
                 box((d, 0.02, width), (0, 0.004, 0), 0.006, 1.6, 2))


def wall_runs(room, inset):
    """Straight runs along a room's walls, broken at its doors: (x, z, length, along z?)."""
    x0, x1, z0, z1 = room[:4]
    for axis, at, lo, hi in (("x", x0, z0, z1), ("x", x1, z0, z1), ("z", z0, x0, x1), ("z", z1, x0, x1)):
        edges = [lo]
        for centre, width, _ in sorted(room_doors(room, axis, at)):
            if lo < centre < hi:
                edges += [centre - width / 2 - 0.09, centre + width / 2 + 0.09]
        edges.append(hi)
        shift = inset if at in (x0, z0) else -inset
        for a, b in zip(edges[::2], edges[1::2]):
            if axis == "x":
                yield at + shift, (a + b) / 2, b - a, True
            else:
                yield (a + b) / 2, at + shift, b - a, False


def moulding(room, y, height, depth, metres):
    """A bevelled strip along every wall at one height."""
    parts = []
    for x, z, length, along_z in wall_runs(room, depth / 2 - 0.002):
        size = (depth, height, length) if along_z else (length, height, depth)
        parts.append(box(size, (x, y, z), min(height, depth) * 0.3, metres, 2 if along_z else 0))
    return merge(*parts)


def build_trims(g, mats):
    """Skirting, dado rails and cornices."""
    for name, y, h, d, material, metres in (
            ("hall", 0.09, 0.18, 0.035, "wood_dark", 1.6), ("hall", 1.16, 0.055, 0.030, "gold", 0.6),
            ("hall", 4.13, 0.14, 0.10, "wood_dark", 1.6), ("vault", 0.11, 0.22, 0.05, "stone", 1.5),
            ("vault", 1.20, 0.05, 0.03, "gold", 0.6), ("vault", 4.20, 0.10, 0.09, "gold", 0.6),
            ("corridor", 0.07, 0.14, 0.03, "wood_dark", 1.6), ("store", 0.06, 0.12, 0.02, "concrete", 2.5)):
        label = "trim_%s_%d" % (name, round(y * 100))
        g.node(label, mesh=g.mesh(label, (moulding(ROOMS[name], y, h, d, metres), mats[material])))
    wains = moulding(ROOMS["vault"], 0.70, 0.94, 0.022, 1.6)
    g.node("vault_wainscot", mesh=g.mesh("vault_wainscot", (wains, mats["wood"])))


# ---------------------------------------------------------------- things

def rivet(radius=0.018):
    """A dome on Y = 0."""
    a = np.linspace(0, math.pi / 2, 3)
    q = radius * stack(np.cos(a), 0.7 * np.sin(a))
    q[-1, 0] = 0
    return lathe([q], 6, 0.5)


def steel_column(height):
    """A riveted I-section on a foot plate; flanges face x."""
    parts = [box((0.20, height, 0.03), (0, height / 2, 0), 0.004, 1.5, 1)]
    for s in (-1, 1):
        parts.append(box((0.025, height, 0.24), (s * 0.11, height / 2, 0), 0.007, 1.5, 1))
        for y in np.arange(0.45, height - 0.2, 0.34):
            for z in (-0.075, 0.075):
                parts.append(rivet(0.016).turned((0, 0, 1), -90 * s).moved(s * 0.1225, y, z))
    parts.append(box((0.42, 0.03, 0.42), (0, 0.015, 0), 0.008, 1.5))
    parts.append(box((0.36, 0.03, 0.36), (0, height - 0.015, 0), 0.008, 1.5))
    for x in (-0.17, 0.17):
        for z in (-0.17, 0.17):
            parts.append(rivet(0.024).moved(x, 0.03, z))
    return merge(*parts)


def pendant_lamp():
    """A conical shade hanging from the origin upwards: (shade, lining, bulb, rod)."""
    outer = lathe([spline([(0.27, 0.0), (0.24, 0.055), (0.14, 0.145), (0.065, 0.185)], 4),
                   spline([(0.065, 0.185), (0.055, 0.24), (0.03, 0.27)], 3)], 28, 1.5)
    lining = lathe([spline([(0.06, 0.17), (0.135, 0.135), (0.235, 0.048), (0.262, 0.0)], 4), [(0.262, 0.0), (0.27, 0.0)]], 28, 1.5)
    bulb = sg.sphere(0.058, 16, 10, 0.4).moved(0, 0.085, 0)
    rod = merge(lathe([[(0.014, 0.26), (0.014, 1.18)]], 10, 0.6),
                lathe([[(0.05, 1.16), (0.09, 1.20), (0.09, 1.25)], [(0.0, 1.16), (0.05, 1.16)]], 20, 0.6))
    return outer, lining, bulb, rod


def cage_lamp():
    """A bulkhead lamp facing down from a ceiling at the origin: (body, glass)."""
    body = [lathe([[(0.0, -0.05), (0.10, -0.05)], [(0.10, -0.05), (0.115, -0.03), (0.115, 0.0)]], 24, 0.6)]
    for k in range(4):
        a = np.linspace(-math.pi / 2, math.pi / 2, 13)
        arc = stack(0.085 * np.sin(a), -0.05 - 0.115 * np.cos(a), 0 * a)
        body.append(tube(arc, 0.006, 5, 0.6).turned((0, 1, 0), 45 * k))
    body.append(ring(0.083, 0.006, 24, 0.6).moved(0, -0.09, 0))
    glass = sg.sphere(0.065, 16, 10, 0.4).scaled(1, 1.35, 1).moved(0, -0.075, 0)
    return merge(*body), glass


def spot_can():
    """A short display spot at the origin, shining along -Z: (body, lens)."""
    body = lathe([[(0.0, 0.10), (0.05, 0.10)], [(0.05, 0.10), (0.062, 0.08), (0.062, -0.12)], [(0.062, -0.12), (0.054, -0.12)], [(0.054, -0.12), (0.054, -0.09)]][1:], 24, 0.6)
    back = lathe([[(0.05, 0.10), (0.0, 0.10)]], 24, 0.6)
    lens = lathe([[(0.0, 0.09), (0.054, 0.09)][::-1]], 24, 0.4)
    stem = tube([(0, 0, 0.0), (0, 0.28, 0.0)], 0.012, 8, 0.6)
    return merge(merge(body, back).turned((1, 0, 0), 90), stem), lens.turned((1, 0, 0), -90)


def wood_crate(size=0.9):
    """Boards held by a frame with a brace on each side, standing on Y = 0."""
    h, parts = size / 2, []
    for axis in range(3):
        for s in (-1, 1):
            for k in range(4):
                at, dims = np.zeros(3), np.full(3, size - 0.06)
                across = (axis + 2) % 3 if axis != 1 else 0
                dims[axis], at[axis] = 0.025, s * (h - 0.035)
                dims[across] = (size - 0.08) / 4 - 0.008
                at[across] = (k - 1.5) * (size - 0.08) / 4
                parts.append(box(dims, at, 0.0, 1.6, 3 - axis - across))
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sa in (-1, 1):
            for sb in (-1, 1):
                at, dims = np.zeros(3), np.full(3, 0.085)
                dims[axis], at[a], at[b] = size - (0.0 if axis == 1 else 0.17), sa * (h - 0.0425), sb * (h - 0.0425)
                parts.append(box(dims, at, 0.007, 1.6, axis))
    inner = size - 0.17
    brace = box((math.hypot(inner, inner) - 0.07, 0.075, 0.03), (0, 0, h - 0.02), 0.005, 1.6, 0).turned((0, 0, 1), 45)
    parts += [brace.turned((0, 1, 0), 90 * k) for k in range(4)]
    return merge(*parts).moved(0, h, 0)


def metal_crate():
    """A ribbed transport case with a lid and handles: (paint, fittings)."""
    paint = [box((1.1, 0.42, 0.66), (0, 0.25, 0), 0.03, 1.5), box((1.14, 0.14, 0.70), (0, 0.55, 0), 0.035, 1.5)]
    for x in (-0.38, -0.13, 0.13, 0.38):
        for s in (-1, 1):
            paint.append(box((0.06, 0.36, 0.03), (x, 0.25, s * 0.335), 0.01, 1.5, 1))
        paint.append(box((0.06, 0.02, 0.56), (x, 0.622, 0), 0.008, 1.5, 2))
    metal = [box((0.9, 0.05, 0.6), (0, 0.025, 0), 0.01, 1.0)]
    for s in (-1, 1):
        arc = np.linspace(0, math.pi, 9)
        path = stack(s * (0.545 + 0.07 * np.sin(arc)), 0.32 + 0 * arc, 0.12 * np.cos(arc))
        metal.append(tube(path, 0.012, 8, 1.0))
        metal.append(box((0.09, 0.10, 0.02), (s * 0.28, 0.50, 0.352), 0.006, 1.0))
    return merge(*paint), merge(*metal)


def barrel():
    """A steel drum with rolled hoops, standing on Y = 0."""
    side = [(0.285, 0.0), (0.30, 0.008), (0.30, 0.025), (0.288, 0.04)]
    for y in (0.29, 0.59):
        side += [(0.285, y - 0.03), (0.292, y - 0.016), (0.302, y), (0.292, y + 0.016), (0.285, y + 0.03)]
    side += [(0.288, 0.84), (0.30, 0.855), (0.30, 0.872), (0.29, 0.88)]
    lid = [(0.29, 0.88), (0.278, 0.876), (0.272, 0.855)]
    bung = lathe([[(0.035, 0.85), (0.035, 0.868)], [(0.035, 0.868), (0.0, 0.868)]], 12, 1.5).moved(0.16, 0, 0.05)
    return merge(lathe([side, lid, [(0.272, 0.855), (0.0, 0.855)]], 32, 1.5), bung)


def lockers():
    """Three narrow doors in one body, facing +x: (paint, fittings)."""
    paint, metal = [box((0.46, 1.86, 1.20), (0, 0.98, 0), 0.012, 1.5, 1)], []
    for z in (-0.395, 0.0, 0.395):
        paint.append(box((0.03, 1.74, 0.372), (0.24, 0.98, z), 0.010, 1.5, 1))
        for y in list(np.arange(1.52, 1.78, 0.05)) + list(np.arange(0.20, 0.40, 0.05)):
            paint.append(box((0.018, 0.016, 0.22), (0.257, y, z), 0.006, 1.5, 2).turned((0, 0, 1), 0))
        metal.append(box((0.02, 0.12, 0.035), (0.262, 1.0, z + 0.14), 0.006, 1.0, 1))
        metal.append(box((0.012, 0.06, 0.10), (0.258, 1.42, z), 0.004, 1.0, 2))
    metal.append(box((0.40, 0.05, 1.14), (0, 0.025, 0), 0.005, 1.0, 2))
    return merge(*paint), merge(*metal)


def table():
    """A plank table, 2.2 x 0.9 m, standing on Y = 0."""
    parts = []
    for k in range(5):
        plank = box((2.2 - 0.012 * (k % 3), 0.045, 0.174), (0.004 * k, 0.76, (k - 2) * 0.178), 0.007, 1.6, 0)
        plank.uv = plank.uv + np.array([0.37 * k, 0.23 * k])
        parts.append(plank)
    for x in (-0.96, 0.96):
        parts.append(box((0.08, 0.10, 0.72), (x, 0.685, 0), 0.006, 1.6, 2))
        for z in (-0.36, 0.36):
            parts.append(box((0.09, 0.735, 0.09), (x, 0.3675, z), 0.010, 1.6, 1))
    for z in (-0.36, 0.36):
        parts.append(box((1.84, 0.09, 0.03), (0, 0.685, z), 0.005, 1.6, 0))
    parts.append(box((1.84, 0.07, 0.05), (0, 0.2, 0), 0.006, 1.6, 0))
    parts += [box((0.05, 0.07, 0.66), (x, 0.2, 0), 0.006, 1.6, 2) for x in (-0.96, 0.96)]
    return merge(*parts)


def stool():
    """A round seat on four splayed legs."""
    parts = [lathe([[(0.0, 0.42), (0.16, 0.42)], [(0.16, 0.42), (0.175, 0.432), (0.175, 0.452), (0.165, 0.462)], [(0.165, 0.462), (0.0, 0.462)]], 28, 1.6)]
    for k in range(4):
        a = math.radians(45 + 90 * k)
        foot, head = (0.19 * math.sin(a), 0, 0.19 * math.cos(a)), (0.11 * math.sin(a), 0.43, 0.11 * math.cos(a))
        parts.append(tube([foot, head], 0.018, 10, 1.6))
    parts.append(ring(0.155, 0.010, 24, 1.6).moved(0, 0.18, 0))
    return merge(*parts)


def urn(height=0.5):
    """A turned vessel with a lip, open at the top."""
    outer = spline([(0.16, 0.0), (0.17, 0.03), (0.08, 0.08), (0.06, 0.14), (0.16, 0.26), (0.29, 0.48), (0.30, 0.64), (0.20, 0.84), (0.13, 0.92), (0.17, 1.0)], 4)
    inner = spline([(0.16, 1.0), (0.12, 0.92), (0.18, 0.83), (0.25, 0.7)], 3)
    handles = []
    for s in (-1, 1):
        path = spline([(s * 0.285, 0.62, 0), (s * 0.40, 0.74, 0), (s * 0.36, 0.90, 0), (s * 0.22, 0.88, 0), (s * 0.16, 0.88, 0)], 4)
        handles.append(tube(path, 0.022, 8, 0.6))
    whole = merge(lathe([outer, [(0.17, 1.0), (0.16, 1.0)], inner], 28, 0.6), *handles)
    return whole.scaled(height)


def armillary():
    """An armillary sphere 1.25 m tall: (gold rings and stand, iron globe)."""
    stand = spline([(0.20, 0.0), (0.205, 0.03), (0.11, 0.06), (0.05, 0.11), (0.035, 0.19), (0.065, 0.25), (0.03, 0.31), (0.028, 0.36), (0.05, 0.40)], 6)
    parts = [lathe([stand], 40, 0.6)]
    c = 0.82
    for radius, width, axis, tilt in ((0.43, 0.034, (1, 0, 0), 90), (0.425, 0.034, (0, 0, 1), 90), (0.40, 0.05, (1, 0, 0.25), 23), (0.36, 0.022, (0.3, 0, 1), -38), (0.33, 0.018, (1, 0, -0.6), 64)):
        parts.append(band(radius, width).turned(axis, tilt).moved(0, c, 0))
    axle = tube([(0, -0.52, 0), (0, 0.52, 0)], 0.011, 10, 0.6)
    tips = [sg.sphere(0.028, 14, 8, 0.3).moved(0, s * 0.53, 0) for s in (-1, 1)]
    parts += [m.turned((0, 0, 1), 23.4).moved(0, c, 0) for m in [axle] + tips]
    return merge(*parts), sg.sphere(0.13, 32, 18, 0.5).moved(0, c, 0)


def band(radius, width, thick=0.012):
    """A flat hoop about Y with a bevelled section."""
    w, t, b = width / 2, thick, 0.003
    outer = [(radius - b, -w), (radius, -w + b), (radius, w - b), (radius - b, w)]
    inner = [(radius - t + b, w), (radius - t, w - b), (radius - t, -w + b), (radius - t + b, -w)]
    return lathe([outer, [outer[-1], inner[0]], inner, [inner[-1], outer[0]]], 48, 0.6)


def plinth(width=0.7, height=0.8):
    """A stepped stone block."""
    return merge(box((width, 0.12, width), (0, 0.06, 0), 0.015, 1.5), box((width - 0.12, 0.06, width - 0.12), (0, 0.15, 0), 0.02, 1.5),
                 box((width - 0.18, height - 0.26, width - 0.18), (0, (height - 0.08) / 2 + 0.05, 0), 0.012, 1.5, 0),
                 box((width - 0.08, 0.08, width - 0.08), (0, height - 0.04, 0), 0.018, 1.5))


def bird():
    """A slender, bent spindle 1.9 m tall, in the manner of early modern bronzes."""
    ys = np.array([0.0, 0.10, 0.22, 0.40, 0.80, 1.15, 1.50, 1.75, 1.90])
    rs = np.array([0.13, 0.075, 0.045, 0.085, 0.165, 0.185, 0.135, 0.06, 0.004])
    xs = np.array([0.0, 0.0, 0.0, -0.015, -0.05, -0.045, 0.01, 0.06, 0.10])
    curve = spline(stack(ys, rs, xs), 5)
    arc = np.linspace(0, 1, len(curve))

    def fn(u, v):
        y, r, x = (np.interp(v, arc, curve[:, k]) for k in range(3))
        a = u * sg.TAU
        return stack(x + r * np.sin(a), y, 0.72 * r * np.cos(a))
    mesh = sg.patch(fn, 40, len(curve) - 1, 2, 4)
    return smooth_normals(mesh, 41)


def smooth_normals(mesh, row):
    """Normals of a lofted patch averaged over neighbouring rings, for piecewise-linear profiles."""
    n = mesh.n.reshape(-1, row, 3)
    m = n.copy()
    m[1:-1] = sg.unit(n[:-2] + 2 * n[1:-1] + n[2:])
    mesh.n = m.reshape(-1, 3)
    t = mesh.t[:, :3] - mesh.n * np.sum(mesh.t[:, :3] * mesh.n, -1, keepdims=True)
    mesh.t = np.concatenate([sg.unit(t), mesh.t[:, 3:]], 1)
    return mesh


def sunburst(rays=24):
    """A gold sun for a wall, facing +z: a dome, a rim and tapering rays."""
    a = np.linspace(0, math.pi / 2, 9)
    dome = stack(0.30 * np.cos(a), 0.16 * np.sin(a))
    dome[-1, 0] = 0
    parts = [lathe([dome], 48, 0.6), ring(0.34, 0.03, 48, 0.6).moved(0, 0.02, 0)]
    for k in range(rays):
        length = 0.62 if k % 2 == 0 else 0.40
        cone = lathe([[(0.038, 0.0), (0.0, length)]], 8, 0.6).scaled(1, 1, 0.55)
        parts.append(cone.turned((1, 0, 0), 90).moved(0, 0.025, 0.38).turned((0, 1, 0), 360 / rays * k))
    return merge(*parts).turned((1, 0, 0), 90)


def sliding_door():
    """A riveted steel leaf in the plane z-y, facing -x, hung on Y = 0: (paint, iron)."""
    w, h = 2.2, 2.78
    paint = [box((0.04, h, w), (0, h / 2, 0), 0.006, 1.5, 1)]
    for y in (0.10, 1.36, h - 0.10):
        paint.append(box((0.03, 0.16, w), (-0.03, y, 0), 0.008, 1.5, 2))
    for z in (-w / 2 + 0.08, 0.0, w / 2 - 0.08):
        paint.append(box((0.026, h - 0.02, 0.14), (-0.028, h / 2, z), 0.008, 1.5, 1))
        for y in np.arange(0.26, h - 0.2, 0.19):
            for s in (-0.045, 0.045):
                paint.append(rivet(0.013).turned((0, 0, 1), 90).moved(-0.041, y, z + s))
    iron = [box((0.03, 0.34, 0.05), (-0.085, 1.15, w / 2 - 0.22), 0.012, 1.0, 1)]
    iron += [box((0.05, 0.04, 0.05), (-0.06, 1.15 + s * 0.14, w / 2 - 0.22), 0.006, 1.0) for s in (-1, 1)]
    for z in (-0.7, 0.7):
        iron.append(box((0.02, 0.30, 0.10), (-0.035, h + 0.04, z), 0.006, 1.0, 1))
        wheel = lathe([[(0.0, -0.02), (0.085, -0.02)], [(0.085, -0.02), (0.085, 0.02)], [(0.085, 0.02), (0.0, 0.02)]], 24, 1.0)
        iron.append(wheel.turned((0, 0, 1), 90).moved(0.0, h + 0.12, z))
    return merge(*paint), merge(*iron)


def pipe(length, radius, flanges):
    """A pipe along +z with bolted flanges at the given distances."""
    parts = [tube([(0, 0, 0), (0, 0, length)], radius, 20, 1.5)]
    for z in flanges:
        disc = lathe([[(radius, -0.03), (radius + 0.05, -0.03)], [(radius + 0.05, -0.03), (radius + 0.055, -0.024), (radius + 0.055, 0.024), (radius + 0.05, 0.03)],
                      [(radius + 0.05, 0.03), (radius, 0.03)]], 28, 1.5)
        bolts = [rivet(0.012).moved((radius + 0.03) * math.sin(k), 0.03, (radius + 0.03) * math.cos(k)) for k in np.arange(8) * sg.TAU / 8]
        parts.append(merge(disc, *bolts).turned((1, 0, 0), 90).moved(0, 0, z))
    return merge(*parts)


def elbow(radius, bend=0.22):
    """A quarter bend from +z (at the origin) to -y."""
    a = np.linspace(0, math.pi / 2, 11)
    path = stack(0 * a, -bend * (1 - np.cos(a)), bend * np.sin(a))
    return tube(path, radius, 20, 1.5)


def valve():
    """A hand wheel facing +x on its stem: (red, iron)."""
    wheel = [ring(0.14, 0.016, 36, 1.5)]
    for k in range(5):
        a = sg.TAU * k / 5
        wheel.append(tube([(0, 0, 0), (0.14 * math.sin(a), 0, 0.14 * math.cos(a))], 0.009, 8, 1.5))
    wheel.append(lathe([[(0.0, -0.02), (0.03, -0.02)], [(0.03, -0.02), (0.03, 0.02)], [(0.03, 0.02), (0.0, 0.02)]], 16, 1.5))
    iron = [lathe([[(0.016, -0.26), (0.016, 0.03)], [(0.016, 0.03), (0.0, 0.03)]], 12, 1.0),
            lathe([[(0.055, -0.30), (0.055, -0.20)], [(0.055, -0.20), (0.03, -0.16)], [(0.03, -0.16), (0.016, -0.16)]], 20, 1.0)]
    return merge(*wheel).turned((0, 0, 1), -90).moved(0.26, 0, 0), merge(*iron).turned((0, 0, 1), -90).moved(0.26, 0, 0)


def lantern():
    """A table lantern: (brass, flame glass)."""
    brass = [lathe([[(0.0, 0.0), (0.085, 0.0)], [(0.085, 0.0), (0.09, 0.02), (0.07, 0.05), (0.062, 0.06)], [(0.062, 0.06), (0.0, 0.06)]], 28, 0.6),
             lathe([[(0.0, 0.235), (0.07, 0.235)], spline([(0.07, 0.235), (0.072, 0.25), (0.045, 0.285), (0.03, 0.30), (0.03, 0.32), (0.0, 0.325)], 3)], 28, 0.6)]
    for k in range(4):
        a = math.radians(45 + 90 * k)
        brass.append(tube([(0.062 * math.sin(a), 0.05, 0.062 * math.cos(a)), (0.062 * math.sin(a), 0.245, 0.062 * math.cos(a))], 0.005, 8, 0.6))
    arc = np.linspace(-math.pi / 2, math.pi / 2, 15)
    brass.append(tube(stack(0.085 * np.sin(arc), 0.25 + 0.14 * np.cos(arc), 0 * arc), 0.004, 8, 0.6))
    glass = lathe([spline([(0.0, 0.075), (0.03, 0.085), (0.036, 0.12), (0.022, 0.18), (0.0, 0.215)], 5)], 20, 0.4)
    return merge(*brass), glass


def shelf():
    """Steel shelving, 1.8 m long along z, facing +x."""
    parts = []
    for x in (-0.22, 0.22):
        for z in (-0.88, 0.88):
            parts.append(box((0.04, 2.0, 0.04), (x, 1.0, z), 0.004, 1.5, 1))
    for y in (0.15, 0.75, 1.35, 1.95):
        parts.append(box((0.48, 0.03, 1.8), (0, y, 0), 0.006, 1.5, 2))
    return merge(*parts)


def picture(width=1.3, height=0.95):
    """A framed panel facing +x on Y = 0 at its middle: (gold frame, chart)."""
    frame = []
    for s in (-1, 1):
        frame.append(box((0.05, 0.09, width + 0.18), (0.028, s * (height / 2 + 0.045), 0), 0.02, 0.6, 2))
        frame.append(box((0.05, height, 0.09), (0.028, 0, s * (width / 2 + 0.045)), 0.02, 0.6, 1))
        frame.append(box((0.03, 0.03, width), (0.018, s * (height / 2 - 0.012), 0), 0.01, 0.6, 2))
    return merge(*frame), plane((0.02, -height / 2, width / 2), (0, 0, -width), (0, height, 0), width)


# ---------------------------------------------------------------- furnishing

class Stage:
    """Places things and remembers where they stand, for the dirt on the floor."""

    def __init__(self, g, mats):
        self.g, self.mats, self.footprints, self.kinds = g, mats, [], {}

    def kind(self, name, **parts):
        """Register a thing as one mesh: material name = Mesh."""
        meshes = [(m, self.mats[material]) for material, m in parts.items()]
        every = np.concatenate([m.p for m, _ in meshes])
        self.kinds[name] = (self.g.mesh(name, *meshes), np.abs(every).max(0))

    def put(self, kind, name, at, turn=0, scale=None, stands=False):
        """Place one; `stands` adds its footprint."""
        mesh, half = self.kinds[kind]
        self.g.node(name, at, turn if np.any(turn) else None, scale, mesh=mesh)
        if stands:
            s = scale if np.isscalar(scale) else 1.0
            turn = turn if np.isscalar(turn) else 0
            c, n = abs(math.cos(math.radians(turn))), abs(math.sin(math.radians(turn)))
            hx, hz = s * (half[0] * c + half[2] * n), s * (half[0] * n + half[2] * c)
            shrink = 1.0 if turn % 90 == 0 else 0.8
            self.footprints.append((at[0] - hx * shrink, at[0] + hx * shrink, at[2] - hz * shrink, at[2] + hz * shrink))


def register(stage):
    """Every kind of thing in the scene."""
    shade_, lining, bulb, rod = pendant_lamp()
    stage.kind("pendant", paint_green=shade_, enamel=lining, bulb=bulb, iron_black=rod)
    body, glass = cage_lamp()
    stage.kind("cage_lamp", iron_black=body, bulb=glass)
    stage.kind("column", paint_green=steel_column(4.2))
    stage.kind("wood_crate", wood=wood_crate())
    for colour in ("blue", "red", "green"):
        paint, metal = metal_crate()
        stage.kind("case_" + colour, **{"paint_" + colour: paint, "steel": metal})
    drum = barrel()
    for colour in ("red", "blue", "green"):
        stage.kind("barrel_" + colour, **{"paint_" + colour: drum})
    paint, metal = lockers()
    stage.kind("lockers", paint_blue=paint, steel=metal)
    stage.kind("table", wood=table())
    stage.kind("stool", wood=stool())
    stage.kind("urn", gold=urn())
    rings, globe = armillary()
    stage.kind("armillary", gold=rings, steel=globe)
    stage.kind("plinth", stone=plinth())
    stage.kind("plinth_large", stone=plinth(1.2, 0.6))
    stage.kind("bird", gold=bird())
    stage.kind("sunburst", gold=sunburst())
    leaf, iron = sliding_door()
    stage.kind("sliding_door", paint_blue=leaf, steel=iron)
    stage.kind("pipe_wide", paint_red=pipe(5.4, 0.085, (0.02, 1.8, 3.6, 5.38)))
    stage.kind("pipe_thin", steel=pipe(5.4, 0.045, (0.02, 2.7, 5.38)))
    stage.kind("pipe_drop", paint_red=pipe(2.8, 0.085, (0.02, 1.75)))
    stage.kind("elbow", paint_red=elbow(0.085))
    wheel, stem = valve()
    stage.kind("valve", paint_green=wheel, steel=stem)
    brass, flame = lantern()
    stage.kind("lantern", brass=brass, flame=flame)
    stage.kind("shelf", paint_green=shelf())
    frame, panel = picture()
    stage.kind("picture", gold=frame, chart=panel)
    can, lens = spot_can()
    stage.kind("spot_can", iron_black=can, bulb=lens)
    stage.kind("beam", wood_dark=box((8.0, 0.30, 0.24), (0, 0, 0), 0.02, 1.6, 0))
    stage.kind("purlin", wood_dark=box((0.14, 0.16, 12.0), (0, 0, 0), 0.012, 1.6, 2))
    stage.kind("rail", steel=box((0.03, 0.10, 4.9), (0, 0, 0), 0.006, 1.0, 2))
    stage.kind("ingot", gold=box((0.24, 0.055, 0.09), (0, 0.0275, 0), 0.012, 0.6, 0))


def furnish_hall(s):
    """The workshop: columns, lamps, the armillary sphere in the sun, lockers, pipes, a table."""
    for k, z in enumerate((-4.8, -0.2, 4.6)):
        for side in (-1, 1):
            if (side, k) != (-1, 0) and (side, k) != (1, 0):
                s.put("column", "column_%d%s" % (k, "we"[side > 0]), (side * 3.70, 0, z), stands=True)
    for k, z in enumerate(np.linspace(-5.0, 5.0, 5)):
        s.put("beam", "beam_%d" % k, (0, 3.86, z))
    for x in (-2.0, 2.0):
        s.put("purlin", "purlin_%s" % "we"[x > 0], (x, 4.10, 0))
    for k, at in enumerate(LAMPS):
        s.put("pendant", "pendant_%d" % k, at)
    s.put("plinth", "armillary_plinth", (0.75, 0, -2.7), stands=True)
    s.put("armillary", "armillary", (0.75, 0.8, -2.7), 25, 1.25)
    s.put("spot_can", "armillary_can", ARMILLARY_SPOT, sg.aim(np.subtract((0.75, 1.7, -2.7), ARMILLARY_SPOT)))
    s.put("sliding_door", "sliding_door", (3.90, 0.03, -4.22))
    s.put("rail", "sliding_door_rail", (3.90, 2.86, -3.1))
    for k, z in enumerate((0.65, 1.86)):
        s.put("lockers", "lockers_%d" % k, (-3.74, 0, z), stands=True)
    s.put("pipe_wide", "pipe_west", (-3.86, 3.15, -2.95))
    s.put("elbow", "pipe_west_elbow", (-3.86, 3.15, 2.45))
    s.put("pipe_drop", "pipe_west_drop", (-3.86, 2.93, 2.67), sg.quaternion((1, 0, 0), 90))
    s.put("pipe_thin", "pipe_west_thin", (-3.92, 3.42, -2.95))
    s.put("valve", "valve_west", (-3.80, 1.45, 2.67))
    s.put("table", "table", (1.95, 0, 2.35), 14, stands=True)
    s.put("lantern", "lantern", (1.35, 0.783, 2.42), 30)
    s.put("urn", "urn_table", (2.15, 0.783, 2.22), 60, 0.75)
    for k, (x, z, turn) in enumerate(((1.72, 2.62, 20), (1.74, 2.50, 32), (2.62, 2.3, 80))):
        s.put("ingot", "ingot_%d" % k, (x, 0.783, z), turn)
    s.put("stool", "stool_0", (1.05, 0, 1.55), 10, stands=True)
    s.put("stool", "stool_1", (2.3, 0, 3.3), 40, stands=True)
    s.put("barrel_red", "barrel_0", (-3.30, 0, -5.45), stands=True)
    s.put("barrel_blue", "barrel_1", (-3.55, 0, -2.55), 100, stands=True)
    s.put("barrel_red", "barrel_2", (-3.40, 0, -1.85), 200, stands=True)
    s.put("wood_crate", "crate_0", (3.30, 0, 0.75), 8, stands=True)
    s.put("wood_crate", "crate_1", (3.28, 0.9, 0.78), -14, 0.7)
    s.put("wood_crate", "crate_2", (0.55, 0, -5.40), -6, stands=True)
    s.put("case_red", "case_0", (1.75, 0, -5.45), 4, stands=True)
    s.put("case_blue", "case_1", (1.72, 0.622, -5.45), -5)
    s.put("urn", "urn_hall", (0.55, 0.9, -5.40), 0, 1.0)
    s.put("picture", "picture_north", (0.9, 2.35, -5.99), -90)
    s.put("picture", "picture_south", (-0.4, 2.1, 5.99), 90, 1.3)
    s.put("case_green", "case_2", (-2.6, 0, 5.3), 3, stands=True)


def furnish_corridor(s):
    """Pipes overhead, two bulkhead lamps, drums along one wall."""
    for k, z in enumerate((-7.8, -10.9)):
        s.put("cage_lamp", "cage_lamp_%d" % k, (-2.0, 2.8, z))
    for x in (-1.05, -1.28):
        s.put("pipe_thin", "pipe_corridor_%d" % round(-100 * x), (x, 2.55, -12.0))
    s.put("pipe_wide", "pipe_corridor", (-2.96, 2.52, -12.0))
    s.put("case_red", "case_corridor", (-2.72, 0, -10.4), 90, stands=True)
    s.put("barrel_green", "barrel_corridor", (-1.28, 0, -8.2), stands=True)


def furnish_store(s):
    """Crates, drums and shelving."""
    s.put("cage_lamp", "cage_lamp_store", (-7.1, 3.2, -3.0))
    for k, (x, y, z, turn, size) in enumerate(((-9.2, 0, -5.2, 5, 1), (-8.15, 0, -5.25, -4, 1), (-8.7, 0.9, -5.2, 12, 0.9), (-7.0, 0, -5.3, 9, 0.8), (-9.3, 0, -4.1, -12, 0.8), (-5.1, 0, -0.7, 20, 1))):
        s.put("wood_crate", "store_crate_%d" % k, (x, y, z), turn, size, y == 0)
    for k, (x, z, colour) in enumerate(((-6.3, -0.5, "green"), (-6.95, -0.55, "red"), (-6.62, -1.1, "blue"), (-5.7, -5.5, "red"))):
        s.put("barrel_" + colour, "store_barrel_%d" % k, (x, 0, z), 70 * k, stands=True)
    s.put("shelf", "shelf_0", (-9.72, 0, -1.2), stands=True)
    s.put("shelf", "shelf_1", (-9.72, 0, -3.05), stands=True)
    s.put("case_red", "shelf_case_0", (-9.72, 0.765, -1.3), 90, 0.75)
    s.put("case_green", "shelf_case_1", (-9.72, 0.165, -2.9), 90, 0.75)
    s.put("urn", "shelf_urn", (-9.72, 1.365, -0.8), 10, 0.7)
    for k in range(8):
        s.put("ingot", "shelf_ingot_%d" % k, (-9.70, 1.365 + 0.055 * (k // 4), -2.6 - 0.11 * (k % 4)))
    s.put("case_blue", "store_case", (-8.3, 0, -0.5), stands=True)
    s.put("lantern", "lantern_store", (-5.1, 0.9, -0.7), 15)


def furnish_vault(s):
    """The gold: a statue under two spots, a sunburst behind it, urns on plinths."""
    s.put("plinth_large", "bird_plinth", (-2.0, 0, -16.2), stands=True)
    s.put("bird", "bird", (-2.0, 0.6, -16.2), 20)
    s.put("sunburst", "sunburst", (-2.0, 2.75, -18.97), 0, 1.5)
    for k, (x, z) in enumerate(((-4.6, -18.0), (0.6, -18.0), (-5.2, -14.2), (1.2, -14.2))):
        s.put("plinth", "vault_plinth_%d" % k, (x, 0, z), stands=True)
        s.put("urn", "vault_urn_%d" % k, (x, 0.8, z), 45 * k, 1.3)
    for k, x in enumerate((-5.97, 1.97)):
        s.put("picture", "vault_picture_%d" % k, (x, 2.4, -16.2), 180 * k, 1.2)
    for k, x in enumerate((-4.2, 0.2)):
        s.put("pendant", "vault_pendant_%d" % k, (x, 3.15, -15.9))
    for k in range(6):
        s.put("ingot", "vault_ingot_%d" % k, (-3.5 + 0.02 * k, 0.055 * (k // 3), -15.2 - 0.12 * (k % 3)), 7 * k)


def build_yard(g, mats):
    """What the doorway shows: paving, a low wall, posts, a tank against the sky."""
    ground = plane((4.3, -0.03, 20), (60, 0, 0), (0, 0, -80), 2.5, np.linspace(0, 60, 21), np.linspace(0, 80, 27))
    g.node("yard_ground", mesh=g.mesh("yard_ground", (ground, mats["concrete"])))
    facade = wall((4.3, -0.03, 6.3), (0, 0, -12.6), 4.8, 1.6, [(8.3, 2.0, 2.73)])
    g.node("yard_facade", mesh=g.mesh("yard_facade", (facade, mats["brick"])))
    low = merge(box((0.4, 0.9, 30), (21, 0.42, -6), 0.02, 1.6, 2), box((0.5, 0.08, 30.1), (21, 0.91, -6), 0.02, 1.6, 2))
    g.node("yard_wall", mesh=g.mesh("yard_wall", (low, mats["brick"])))
    posts = [box((0.12, 2.3, 0.12), (20.6, 1.1, z), 0.01, 1.5, 1) for z in np.arange(-20, 9, 3.0)]
    posts += [box((0.05, 0.05, 28), (20.6, y, -6), 0.0, 1.5, 2) for y in (1.5, 2.1)]
    g.node("yard_fence", mesh=g.mesh("yard_fence", (merge(*posts), mats["paint_green"])))
    tank = lathe([[(1.6, 3.0), (1.6, 5.6)], [(1.6, 5.6), (0.0, 6.4)]], 32, 1.5)
    shed = merge(box((6, 3.2, 9), (36, 1.6, -13), 0.02, 1.6), box((0.9, 9, 0.9), (35, 4.5, -10.5), 0.02, 1.6, 1))
    g.node("yard_shed", mesh=g.mesh("yard_shed", (shed, mats["brick"])))
    legs = [box((0.14, 3.1, 0.14), (x, 1.5, z), 0.0, 1.5, 1) for x in (-1, 1) for z in (-1, 1)]
    base = lathe([[(0.0, 3.0), (1.6, 3.0)]], 32, 1.5)
    g.node("yard_tank", (30, 0, -28.5), mesh=g.mesh("yard_tank", (merge(tank, base, *legs), mats["paint_red"])))


# ---------------------------------------------------------------- light

# Stand-ins for bounced light: off while the rooms' probes have light.
FILLS = [("hall_north", (0.0, 2.5, -3.2), 95.0, 5.6), ("hall_south", (-0.4, 2.5, 4.3), 120.0, 6.4), ("corridor", (-2.0, 1.9, -9.3), 22.0, 3.6),
         ("store", (-7.1, 2.0, -3.0), 75.0, 4.4), ("vault", (-2.0, 2.6, -14.6), 120.0, 6.2)]

SUN_ELEVATION, SUN_AZIMUTH = 23.0, 24.0         # degrees; azimuth from +x towards -z
SUN_COLOUR = (1.0, 0.80, 0.56)


def sun_direction():
    """From the scene to the sun."""
    e, a = math.radians(SUN_ELEVATION), math.radians(SUN_AZIMUTH)
    return np.array([math.cos(e) * math.cos(a), math.sin(e), -math.cos(e) * math.sin(a)])


def build_lights(g):
    """Candela throughout. There is no directional light: without shadows it would pass the walls. Four spots ask for shadows.

    The sun is a narrow spot far out in the yard whose cone just fills the doorway."""
    for k, (x, y, z) in enumerate(LAMPS):
        g.light("lamp_%d" % k, "spot", (x, y + 0.02, z), (0, -1, 0), WARM, 1100.0, 5.5, (16, 43), shadow=k > 0)
    to_sun, door = sun_direction(), np.array([4.15, 1.35, -2.0])
    g.light("sun_shaft", "spot", door + 16.0 * to_sun, -to_sun, SUN_COLOUR, 330000.0, 30.0, (2.7, 3.7), shadow=True)
    g.light("sun_yard", "spot", (23.0, 9.0, -9.0), (-10.0, -9.0, 4.0), SUN_COLOUR, 24000.0, 19.0, (28, 40))
    g.light("sky_door", "point", (4.6, 2.2, -2.0), None, (0.75, 0.86, 1.0), 90.0, 5.0, stand_in=True)
    at = np.array(ARMILLARY_SPOT)
    g.light("armillary_spot", "spot", at, np.array((0.75, 1.5, -2.7)) - at, WARM, 1500.0, 5.5, (10, 20))
    for name, at, cd, reach in FILLS:
        g.light("fill_" + name, "point", at, None, (1.0, 0.86, 0.70), cd, reach, stand_in=True)
    g.light("lantern_light", "point", (1.35, 0.92, 2.42), None, TUNGSTEN, 60.0, 3.4)
    for k, z in enumerate((-7.8, -10.9)):
        g.light("cage_lamp_light_%d" % k, "spot", (-2.0, 2.70, z), (0, -1, 0), WARM, 380.0, 3.6, (30, 62))
    g.light("store_lamp_light", "spot", (-7.1, 3.08, -3.0), (0, -1, 0), WARM, 800.0, 4.6, (25, 60))
    g.light("lantern_store_light", "point", (-5.1, 1.04, -0.7), None, TUNGSTEN, 60.0, 2.8)
    bird_at = np.array([-2.0, 1.6, -16.2])
    for name, at, cd in (("left", (-4.2, 3.15, -14.0), 1500.0), ("right", (0.3, 3.15, -14.2), 1200.0)):
        g.light("statue_spot_" + name, "spot", at, bird_at - at, WARM, cd, 7.0, (12, 24))
    g.light("vault_lamp_light_0", "spot", (-4.2, 3.17, -15.9), (0, -1, 0), WARM, 700.0, 5.5, (20, 48))
    g.light("vault_lamp_light_1", "spot", (0.2, 3.17, -15.9), (0, -1, 0), WARM, 700.0, 5.5, (20, 48))
    g.light("sunburst_glow", "point", (-2.0, 2.75, -18.2), None, TUNGSTEN, 40.0, 3.0)


def sky(width=512, height=256):
    """Dusk in cd/m2: a low glow towards the sun's side, a dim blue dome, dark ground."""
    d = sg.sphere_directions(width, height)
    up = d[..., 1]
    to_sun = sg.unit(sun_direction() * np.array([1, 0.55, 1]))  # lower than the shaft: the glow hugs the horizon
    near = np.clip(d @ to_sun, 0, 1)
    flat = np.clip((d[..., 0] * to_sun[0] + d[..., 2] * to_sun[2]) / max(1e-6, math.hypot(to_sun[0], to_sun[2])), -1, 1)
    low = np.exp(-np.maximum(up, 0) / 0.22)
    dome = blend((2.6, 4.4, 8.6), (8.0, 8.2, 9.5), low)
    glow = (low * (0.5 + 0.5 * flat) ** 3)[..., None] * np.array((19.0, 9.4, 4.2))
    halo = (near ** 24)[..., None] * np.array((34.0, 19.0, 8.5)) + (near ** 400)[..., None] * np.array((420.0, 300.0, 170.0))
    z = Noise(110, 512)
    wrap = np.arange(width) * 512 // width
    cloud = smooth(0.50, 0.72, z.fbm(5, 14, 5)[np.arange(height) * 2][:, wrap])
    cloud = cloud * smooth(0.03, 0.2, up) * smooth(0.95, 0.5, up)
    lit = dome * 0.5 + glow * 0.62 + np.array((2.6, 1.7, 2.0))
    above = blend(dome + glow, lit, 0.85 * cloud) + halo * (1 - 0.5 * cloud)[..., None]
    ground = np.array((1.7, 1.45, 1.2)) * (1.0 + 0.8 * np.exp(np.minimum(up, 0) / 0.1) * (0.4 + flat.clip(0)))[..., None]
    return blend(ground, above, smooth(-0.012, 0.012, up))


# ---------------------------------------------------------------- cameras and probes

def build_views(g):
    """`hero` first, then one camera a room; a probe in the middle of each."""
    g.camera("hero", (-2.75, 1.62, 5.35), (0.62, 1.27, -3.2), 52.0)
    g.camera("hall", (3.0, 1.70, -5.2), (-1.5, 1.25, 3.5), 58.0)
    g.camera("corridor", (-1.75, 1.60, -5.2), (-2.05, 1.50, -14.0), 50.0)
    g.camera("store", (-4.9, 1.65, -4.6), (-8.6, 0.95, -1.9), 62.0)
    g.camera("vault", (-1.0, 1.60, -13.0), (-2.3, 1.45, -17.0), 60.0)
    g.camera("doorway", (-2.6, 1.55, 0.6), (3.2, 1.05, -2.2), 50.0)
    for name, (x0, x1, z0, z1, h, _, _) in ROOMS.items():
        half = [(x1 - x0) / 2, h / 2, (z1 - z0) / 2]
        g.node("probe_" + name, ((x0 + x1) / 2, h / 2, (z0 + z1) / 2), extras={"burnish": {"probe": {"box_half_size": half}}})


def build(folder):
    """Make everything and write it to the folder."""
    g = sg.Gltf("Burnish samples/fps/make_scene.py")
    build_views(g)
    mats = make_materials(g)
    stage = Stage(g, mats)
    register(stage)
    for furnish in (furnish_hall, furnish_corridor, furnish_store, furnish_vault):
        furnish(stage)
    build_rooms(g, mats, stage.footprints)
    build_trims(g, mats)
    build_yard(g, mats)
    build_lights(g)
    sg.write_atomic(os.path.join(folder, "sky.hdr"), sg.hdr_bytes(sky()))
    g.save(folder, "fps", extras={"environment": "sky.hdr", "ev100": EV100})
    return [os.path.join(folder, "fps.gltf")], g.summary()


if __name__ == "__main__":
    sys.exit(sg.run(__doc__, build, "fps"))
