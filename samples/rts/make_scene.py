#!/usr/bin/env python3
"""Writes the `rts` sample: two armies at a river at sunrise, seen from above.

    make_scene.py -o DIR [--check]

Output: DIR/rts.gltf, rts.bin, textures/*.png and sky.hdr (named by the scene's extras.burnish.environment).
Everything is procedural: no input, fixed seeds.

Plan, metres, seen from above (x to the right, z down), the river from the far left to the near right:

      z -100  lake            woods      north road
       -40  village . . .               RED (44, -40) on its hill
         0          . . river . bridge (1, -4)
        25   BLUE (-44, 24)          .   crystal mine (58, 14)
        60          south road           . river

Modules: shapes (palette), units, buildings, nature, terrain (ground and water), field, armies, places, layout (what stands where).
"""
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "common")]
import scenegen as sg  # noqa: E402
import buildings as b  # noqa: E402
import layout  # noqa: E402
from field import Field  # noqa: E402
import nature as n  # noqa: E402
import terrain  # noqa: E402
import units as u  # noqa: E402
from scenegen import Noise, Surface, blend, cavity, smooth  # noqa: E402
from shapes import coloured, block, DARK  # noqa: E402

EV100 = 7.3                     # the exposure this scene is lit for
SUN_ELEVATION, SUN_AZIMUTH = 23.0, 170.0    # degrees; azimuth from +x towards -z
SUN_LUX, SUN_COLOUR = 680.0, (1.0, 0.70, 0.40)


def sun_direction():
    """From the scene to the sun."""
    e, a = math.radians(SUN_ELEVATION), math.radians(SUN_AZIMUTH)
    return np.array([math.cos(e) * math.cos(a), math.sin(e), -math.cos(e) * math.sin(a)])


# ---------------------------------------------------------------- materials

def masonry():
    """Cut stone, 0.5 x 0.25 m over 2 m: courses, joints, each stone its own shade."""
    z = Noise(311, 256)
    row = np.floor(z.y * 8).astype(int)
    bx = z.x * 4 + 0.5 * (row % 2)
    col = np.floor(bx).astype(int) % 4
    d = np.minimum(0.25 - np.abs(bx % 1 - 0.5) * 0.5, 0.125 - np.abs(z.y * 8 % 1 - 0.5) * 0.25)
    face = smooth(0.006, 0.03, d)
    per = z.rng.random((8, 4))[row, col]
    height = 0.03 * face + 0.012 * per * face + 0.006 * z.fbm(16, octaves=3)
    colour = np.repeat(((0.55 + 0.45 * face) * (0.84 + 0.16 * per))[..., None], 3, 2)
    return Surface(2.0, height, colour, 0.9 - 0.1 * face, 0 * face, cavity(height, 0.05))


def boards():
    """Upright boards over 2 m, eight to the repeat."""
    z = Noise(312, 256)
    col = np.floor(z.x * 8).astype(int)
    face = smooth(0.004, 0.02, 0.125 - np.abs(z.x * 8 % 1 - 0.5) * 0.25)
    per = z.rng.random(8)[col]
    grain = z.fbm(40, 3, 2)
    height = 0.02 * face + 0.012 * per * face + 0.004 * grain
    colour = np.repeat(((0.6 + 0.4 * face) * (0.8 + 0.2 * per) * (0.9 + 0.1 * grain))[..., None], 3, 2)
    return Surface(2.0, height, colour, 0.85 + 0 * face, 0 * face, cavity(height, 0.04))


def panels():
    """Cast panels over 4 m with fine seams and corner bolts."""
    z = Noise(313, 256)
    seam = np.minimum(1.0 - np.abs(z.x * 2 % 1 - 0.5) * 2.0, 1.0 - np.abs(z.y * 2 % 1 - 0.5) * 2.0)
    face = smooth(0.012, 0.04, seam)
    per = z.rng.random((2, 2))[np.floor(z.y * 2).astype(int), np.floor(z.x * 2).astype(int)]
    bolt = smooth(0.05, 0.03, np.hypot(z.x * 2 % 1 - 0.5, 0) * 0 + np.hypot(np.abs(z.x * 2 % 1 - 0.5) - 0.4, np.abs(z.y * 2 % 1 - 0.5) - 0.4))
    height = 0.02 * face - 0.008 * bolt
    colour = np.repeat(((0.66 + 0.34 * face) * (0.93 + 0.07 * per) * (1 - 0.25 * bolt))[..., None], 3, 2)
    return Surface(4.0, height, colour, 0.55 + 0.1 * per, 0 * face, cavity(height, 0.03))


def tiles():
    """Rounded roof tiles in courses over 1.6 m."""
    z = Noise(314, 256)
    row = np.floor(z.y * 5).astype(int)
    bx = z.x * 6 + 0.5 * (row % 2)
    col = np.floor(bx).astype(int) % 6
    fall = z.y * 5 % 1
    bulge = np.sqrt(np.clip(1 - (2 * (bx % 1) - 1) ** 2, 0, 1))
    per = z.rng.random((5, 6))[row, col]
    height = 0.05 * fall * (0.4 + 0.6 * bulge) + 0.03 * bulge + 0.008 * per
    shade = (0.62 + 0.38 * smooth(0.0, 0.35, fall)) * (0.8 + 0.2 * per) * (0.75 + 0.25 * bulge)
    return Surface(1.6, height, np.repeat(shade[..., None], 3, 2), 0.8 + 0 * fall, 0 * fall, cavity(height, 0.06))


def make_materials(g, ground, contact):
    """Every material by name; most colour is in the vertices."""
    mats = {"flat": g.material("flat", rough=0.82)}
    for name, surface in (("stone", masonry()), ("plank", boards()), ("panel", panels()), ("tiles", tiles())):
        mats[name] = g.material(name, g.surface(name, surface))
    mats["lamp"] = g.material("lamp", base=(0, 0, 0), rough=0.9, emit=(1.0, 0.92, 0.72), nits=900.0)
    mats["glow_warm"] = g.material("glow_warm", base=(0, 0, 0), rough=0.9, emit=(1.0, 0.55, 0.16), nits=240.0)
    mats["glow_cool"] = g.material("glow_cool", base=(0, 0, 0), rough=0.9, emit=(0.32, 0.72, 1.0), nits=280.0)
    mats["fire"] = g.material("fire", {"emit": g.texture("fire_emission", n.fire_glow(), True)}, (0, 0, 0), 0.9, 0.0, (1, 1, 1), 260.0)
    mats["flash"] = g.material("flash", base=(0, 0, 0), rough=0.9, emit=(1.0, 0.62, 0.18), nits=900.0)
    mats["crystal_violet"] = g.material("crystal_violet", base=(0.40, 0.12, 0.75), rough=0.18, emit=(0.55, 0.16, 1.0), nits=260.0)
    mats["crystal_teal"] = g.material("crystal_teal", base=(0.08, 0.60, 0.50), rough=0.18, emit=(0.10, 1.0, 0.72), nits=210.0)
    mats["ground"] = g.material("ground", {"base": g.texture("ground_base", sg.to_srgb(terrain.painted(ground, contact)))}, rough=0.9, metal=0.0)
    g.materials[mats["ground"]]["occlusionTexture"] = {"index": g.texture("ground_occlusion", sg.to_u8(terrain.enlarge(contact, 2))[..., None])}
    mats["water"] = g.material("water", {"base": g.texture("water_base", sg.to_srgb(terrain.water_colour(ground)))}, rough=0.10, metal=0.0, substance="water")
    for name, image, repeats in (("ground", terrain.turf(), 128.0), ("water", terrain.ripples(), 51.0)):
        normal = {"index": g.texture(name + "_normal", image), "extensions": {"KHR_texture_transform": {"scale": [repeats, repeats]}}}
        g.materials[mats[name]]["normalTexture"] = normal
    g.used.add("KHR_texture_transform")
    return mats


# ---------------------------------------------------------------- kinds

def pieces():
    """Every kind of thing that stands on the ground: name to {material: mesh}."""
    out = {"pine_0": n.pine(), "pine_1": n.pine("#245c4a", "#7fb35a"), "leaf_0": n.leaf_tree(), "leaf_1": n.leaf_tree("#5c6a1f", "#d6c33c", 2), "leaf_2": n.leaf_tree("#8a4a1c", "#f0a03a", 3),
           "bush": n.bush(), "tuft": n.tuft(), "rock_0": n.rock(11), "rock_1": n.rock(12, "#8f8a96"), "rock_2": n.rock(13, "#b5a893"), "lamp_blue": n.lamp_post("blue"), "lamp_red": n.lamp_post("red"),
           "brazier": n.brazier(), "campfire": n.campfire(), "crate": n.crate(), "barrel_0": n.barrel(), "barrel_1": n.barrel("#a8452f"), "tent_blue": n.tent("#5b7fae"), "tent_red": n.tent("#a8613f"),
           "buoy": n.ball_buoy(), "lantern": {"flat": coloured((block((0.5, 0.25, 0.5)), DARK), (block((0.6, 0.2, 0.6), (0, 0.85, 0), 0.4), DARK)), "glow_warm": block((0.42, 0.6, 0.42), (0, 0.25, 0))},
           "lantern_cool": {"flat": coloured((block((0.5, 0.25, 0.5)), DARK), (block((0.6, 0.2, 0.6), (0, 0.85, 0), 0.8), DARK)), "glow_cool": block((0.42, 0.6, 0.42), (0, 0.25, 0))},
           "cottage": b.cottage(), "cottage_blue": b.cottage("#5a7d97"), "dropship": b.dropship(), "landing_pad": b.landing_pad(), "bridge": b.bridge(), "mill": b.mill(), "mill_sails": b.mill_sails()}
    for tone in ("violet", "teal"):
        for k in (0, 1):
            out["crystal_%s_%d" % (tone, k)] = n.crystal(21 + k, tone)
    for faction in ("blue", "red"):
        out.update({"soldier_" + faction: u.soldier(faction), "heavy_" + faction: u.soldier(faction, True), "tank_" + faction: u.tank(faction), "truck_" + faction: u.truck(faction),
                    "artillery_" + faction: u.artillery(faction), "boat_" + faction: u.boat(faction), "flag_" + faction: u.flag(faction)})
    out.update(wreck=u.wreck(), flash=u.flash())
    for name in ("hq", "barracks", "factory", "power", "tower", "wall"):
        out["blue_" + name] = getattr(b, "blue_" + name)()
    for name in ("keep", "longhouse", "foundry", "tower", "palisade"):
        out["red_" + name] = getattr(b, "red_" + name)()
    out.update(radar_base=b.radar_base(), radar_dish=b.radar_dish())
    return out


# ---------------------------------------------------------------- light and views

def sky(width=512, height=256):
    """Sunrise in cd/m2: a warm horizon towards the sun, blue above, soft ground light."""
    d = sg.sphere_directions(width, height)
    up, to_sun = d[..., 1], sun_direction()
    near = np.clip(d @ to_sun, 0, 1)
    flat = (d[..., 0] * to_sun[0] + d[..., 2] * to_sun[2]) / math.hypot(to_sun[0], to_sun[2])
    low = np.exp(-np.maximum(up, 0) / 0.24)
    dome = blend((24, 44, 92), (78, 84, 108), low)
    glow = (low * (0.5 + 0.5 * flat) ** 2)[..., None] * np.array((150.0, 82.0, 38.0))
    halo = (near ** 12)[..., None] * np.array((90.0, 60.0, 32.0)) + (near ** 200)[..., None] * np.array((600.0, 440.0, 260.0))
    z = Noise(315, 512)
    wrap = np.arange(width) * 512 // width
    cloud = smooth(0.52, 0.66, z.fbm(4, 12, 5)[np.arange(height) * 2][:, wrap]) * smooth(0.02, 0.18, up) * smooth(0.95, 0.5, up)
    lit = dome * 0.7 + glow * 0.8 + np.array((34.0, 22.0, 20.0))
    above = blend(dome + glow, lit, 0.8 * cloud) + halo * (1 - 0.4 * cloud)[..., None]
    earth = np.array((20.0, 21.0, 14.0)) * np.ones_like(up)[..., None]
    return blend(earth, above, smooth(-0.02, 0.02, up))


def build_views(g):
    """`hero` first: the three-quarter view over the bridge."""
    g.camera("hero", (12.0, 70.0, 84.0), (-4.0, 0.0, -7.0), 36.0, 1.0, 900.0)
    g.camera("close", (-7.0, 6.0, 20.5), (2.5, 3.2, -8.0), 42.0, 0.3, 900.0)
    g.camera("map", (0.0, 215.0, 92.0), (0.0, 0.0, -4.0), 40.0, 2.0, 900.0)


def build(folder):
    """Make everything and write it to the folder."""
    g = sg.Gltf("Burnish samples/rts/make_scene.py")
    build_views(g)
    to_sun = sun_direction()
    g.light("sun", "directional", 300.0 * to_sun, -to_sun, SUN_COLOUR, SUN_LUX, shadow=True)
    ground = terrain.Ground()
    parts = pieces()
    kinds = {}
    order = {}
    for name, kind in parts.items():                       # meshes are numbered now, their materials follow
        kinds[name] = len(order)
        order[name] = kind
    field = Field(g, ground, kinds)
    layout.furnish(field)
    mats = make_materials(g, ground, terrain.contact_map(field.spots))
    for name, kind in order.items():
        g.mesh(name, *[(mesh, mats[material]) for material, mesh in kind.items()])
    terrain.water_mesh.ground = ground
    g.node("ground", mesh=g.mesh("ground", (terrain.ground_mesh(ground), mats["ground"])))
    g.node("water", mesh=g.mesh("water", (terrain.water_mesh(), mats["water"])))
    sg.write_atomic(os.path.join(folder, "sky.hdr"), sg.hdr_bytes(sky()))
    g.save(folder, "rts", extras={"environment": "sky.hdr", "ev100": EV100, "fog": {"density": 0.0022, "falloff": 0.05, "height": 0.0, "albedo": [0.92, 0.94, 1.0]}})
    return [os.path.join(folder, "rts.gltf")], g.summary()


if __name__ == "__main__":
    sys.exit(sg.run(__doc__, build, "rts"))
