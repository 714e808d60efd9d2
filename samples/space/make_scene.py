#!/usr/bin/env python3
"""Writes the `space` sample: ships and a station over a planet, a million metres from the origin.

    make_scene.py -o DIR [--check]

Output: DIR/space.gltf, space.bin, textures/*.png and stars.hdr (named by the scene's extras.burnish.environment).
Everything is procedural: no input, fixed seeds.

Everything hangs under one node, `sector`, that is some 1.2e6 m from the origin; meshes stay local, so only double
precision transforms see the distance. Seen from `hero`, -z is ahead and +x to the right:

      ahead, low and to the right    the planet, radius 6.2e5 m, its centre 1.35e6 m away
      ahead, 1.2 km                  the station, its wheel turning
      centre, 300 m                  the cruiser, going away towards the station
      near, right                    a wing of fighters; freighters farther on
      left                           asteroids, a mined one close by; the belt goes on to 40 km

Modules: surfaces (materials), hulls (ships), station, bodies (asteroids, planet, stars).
"""
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "common")]
import scenegen as sg  # noqa: E402
import bodies  # noqa: E402
import hulls  # noqa: E402
import station  # noqa: E402
import surfaces  # noqa: E402
from solids import block, drum, pipe  # noqa: E402

EV100 = 12.2                    # the exposure this scene is lit for
SECTOR = np.array([1.0e6, 2.4e5, -6.5e5])
PLANET_WAY, PLANET_FAR, PLANET_RADIUS = sg.unit(np.array([0.50, -0.40, -1.0])), 1.35e6, 6.2e5
TO_SUN = sg.unit(np.array([0.56, 0.42, 0.71]))
SUN_LUX, SUN_COLOUR = 20000.0, (1.0, 0.95, 0.88)
ENGINE_LIGHT = (0.34, 0.64, 1.0)


def heading(direction, roll=0.0):
    """The rotation that turns +z to a direction, rolled about it."""
    return sg.quaternion_product(sg.aim(-np.asarray(direction, float)), sg.quaternion((0, 0, 1), roll))


class Stage:
    """Meshes by kind and the nodes under the sector."""

    def __init__(self, g, mats):
        self.g, self.mats, self.kinds, self.counts = g, mats, {}, {}
        self.root = g.node("sector", SECTOR)

    def kind(self, name, parts):
        """Register {material: mesh}."""
        self.kinds[name] = self.g.mesh(name, *[(mesh, self.mats[material]) for material, mesh in parts.items()])

    def put(self, kind, name, at, turn=None, scale=None, parent=None):
        """Place an instance under the sector or another node."""
        return self.g.node(name, at, turn, scale, self.root if parent is None else parent, mesh=self.kinds[kind])

    def light(self, name, at, colour, candela, reach, parent=None):
        """A point light under the sector or another node."""
        self.g.light(name, "point", at, None, colour, candela, reach, parent=self.root if parent is None else parent)


def register(s):
    """Every kind of thing."""
    for name in ("cruiser", "fighter", "freighter", "shuttle"):
        s.kind(name, getattr(hulls, name)())
    box = hulls.container()
    for tone in ("orange", "teal", "sand", "grey"):
        s.kind("container_" + tone, {"hull_" + tone: box})
    s.kind("wheel", station.wheel())
    s.kind("spindle", station.spindle())
    s.kind("solar_wing", station.solar_wing())
    for k in range(3):
        s.kind("rock_fine_%d" % k, {"rock_red" if k == 1 else "rock": bodies.asteroid(510 + k, 36, 20, 9)})
        s.kind("rock_%d" % k, {"rock_red" if k == 1 else "rock": bodies.asteroid(520 + k, 16, 9, 4)})
    s.kind("rock_great", {"rock": bodies.asteroid(531, 96, 54, 14)})
    s.kind("moon", {"rock": bodies.asteroid(533, 72, 40, 40, 0.04)})
    s.kind("outpost", outpost())
    s.kind("planet", {"planet": bodies.near_side(), "ocean": bodies.far_side()})


def outpost():
    """A mine's head frame: domes, a tower, floodlights; stands on y = 0."""
    out = [("hull_grey", drum(10, 9, 7.5, 5, (0, -2, 0), 0.5, hulls.PANEL)), ("windows", sg.lathe([[(8.45, 0.2), (8.1, 2.2)]], 10, 16.0)), ("hull_orange", drum(10, 7.6, 7.0, 1.2, (0, 3, 0), 0.5, hulls.PANEL)),
           ("metal", pipe((0, 4, 0), (0, 24, 0), 0.7, 6)), ("nav_red", block((1, 1, 1), (0, 24, 0))), ("hull_sand", block((10, 7, 14), (17, -2, 3), 0.9, hulls.PANEL)),
           ("hull_grey", drum(8, 4, 4, 9, (-14, -2, 4), 0.5, hulls.PANEL)), ("hull_orange", drum(8, 4.2, 4.2, 1.0, (-14, 5.5, 4), 0.5, hulls.PANEL)), ("metal", pipe((-14, 6, 4), (0, 4, 0), 0.5, 6)), ("metal", pipe((17, 3, 3), (0, 3, 0), 0.6, 6))]
    for k in range(4):
        a = math.tau * k / 4 + 0.4
        at = np.array([13 * math.sin(a), 0, 13 * math.cos(a)])
        out += [("metal", pipe(at + (0, -3, 0), at + (0, 9, 0), 0.3, 5)), ("flood", block((1.6, 1.0, 0.5), at + (0, 8.6, 0)))]
    return hulls.collect(out)


# ---------------------------------------------------------------- ships and station

def fleet(s):
    """The cruiser, its fighters, two freighters and a shuttle; they drift when played."""
    way = sg.unit(np.array([0.50, 0.05, -0.86]))
    ship = s.put("cruiser", "cruiser", (-48, -6, 96), heading(way, -6))
    for k, (x, y, r) in enumerate(hulls.CRUISER_ENGINES):
        s.light("cruiser_engine_%d" % k, (x, y, -104), ENGINE_LIGHT, 2.4e6, 46.0, ship)
    for k, x in enumerate((-38, 38)):
        s.light("cruiser_pod_%d" % k, (x, -4, -80), ENGINE_LIGHT, 1.4e6, 34.0, ship)
    for k, (x, y, z, colour) in enumerate(((-17, 21, -40, (1, 0.8, 0.5)), (12, 21, -38, (1, 0.8, 0.5)), (0, 18, 2, (0.7, 0.85, 1)), (0, -17, 30, (0.7, 0.85, 1)), (46, -4, -32, (1, 0.1, 0.05)), (-46, -4, -32, (0.1, 1, 0.3)))):
        s.light("cruiser_lamp_%d" % k, (x, y, z), colour, 2.0e5, 16.0, ship)
    drift(s, ship, (-48, -6, 96), way * 24.0)
    wing = [(-22, 16, 268), (0, 18, 250), (-2, 4, 251), (33, 26, 222), (27, -3, 225), (-150, 40, 130), (-132, 52, 112)]
    flight = sg.unit(np.array([0.16, 0.10, -0.98]))
    for k, at in enumerate(wing):
        craft = s.put("fighter", "fighter_%d" % k, at, heading(flight, -14 + 5 * (k % 3)))
        s.light("fighter_engine_%d" % k, (0, 0, -8.4), ENGINE_LIGHT, 4.0e4, 10.0, craft)
        drift(s, craft, at, flight * (14.0 + 3 * (k % 4)))
    for k, (at, way) in enumerate((((420, 20, -520), (-0.72, 0.10, -0.69)), ((-330, 190, -760), (0.86, -0.06, -0.5)), ((700, 210, -1500), (-0.9, -0.05, 0.4)))):
        hauler = s.put("freighter", "freighter_%d" % k, at, heading(way, 4 * k))
        for j, place in enumerate(hulls.racks()):
            if (j * 7 + k) % 5:
                s.put("container_" + ("orange", "teal", "sand", "grey")[(j * 5 + j // 3 + k) % 4], "container_%d_%02d" % (k, j), place, parent=hauler)
        for j, x in enumerate((-4, 4)):
            s.light("freighter_engine_%d%d" % (k, j), (x, 0, -75), ENGINE_LIGHT, 6.0e5, 26.0, hauler)
        drift(s, hauler, at, sg.unit(np.array(way)) * 40.0)
    for k, (at, way) in enumerate((((120, 66, -330), (0.2, 0.1, -1)), ((250, 130, -620), (-0.3, -0.1, -1)), ((-20, 110, -560), (0.5, 0.0, -0.8)))):
        s.light("shuttle_engine_%d" % k, (0, 0, -14), ENGINE_LIGHT, 2.0e5, 14.0, s.put("shuttle", "shuttle_%d" % k, at, heading(way, 10 * k)))


def drift(s, node, at, by, seconds=48.0):
    """A slow slide along a heading and back, eased, so that it can be played round and round."""
    at, t = np.asarray(at, float), np.linspace(0.0, 1.0, 13)
    s.g.animate("drift", node, "translation", t * seconds, at + (0.5 - 0.5 * np.cos(math.tau * t))[:, None] * by)


def build_station(s, at=(205, 118, -980)):
    """Hub, turning wheel, solar wings, lights in the docks and on the rim."""
    tilt = sg.quaternion_product(sg.quaternion((0, 0, 1), -17), sg.quaternion((1, 0, 0), 24))
    hub = s.g.node("station", at, tilt, parent=s.root)
    s.put("spindle", "station_spindle", (0, 0, 0), parent=hub)
    ring = s.put("wheel", "station_wheel", (0, 0, 0), parent=hub)
    s.g.spin("wheel", ring, (0, 1, 0), 60.0)
    face = math.degrees(math.atan2(TO_SUN[0], TO_SUN[2])) - 8.0
    for k, (x, y, z, up) in enumerate(station.wing_places()):
        turn = sg.quaternion((0, 1, 0), face)
        if up:
            turn = sg.quaternion_product(turn, sg.quaternion((0, 0, 1), 180))
        s.put("solar_wing", "solar_wing_%02d" % k, (x, y, z), turn, parent=hub)
    for k in range(8):
        a = math.tau * k / 8
        s.light("dock_light_%d" % k, (44 * math.cos(a), -110, 44 * math.sin(a)), (1.0, 0.86, 0.62), 9.0e5, 40.0, hub)
    for k in range(12):
        a = math.tau * k / 12
        s.light("rim_light_%02d" % k, ((station.RADIUS - 44) * math.cos(a), 0, (station.RADIUS - 44) * math.sin(a)), (1.0, 0.80, 0.55), 8.0e5, 60.0, ring)
    s.light("mast_light", (0, 234, 0), (1, 0.1, 0.05), 2.0e5, 30.0, hub)


# ---------------------------------------------------------------- asteroids

def great_radius(way, turn):
    """How far the great rock's surface is from its middle along a world direction."""
    local = matrix_of(turn).T @ way
    p = bodies.asteroid(531, 96, 54, 14).p
    return float(np.linalg.norm(p[np.argmax(sg.unit(p) @ local)]))


def belt(s):
    """One great rock with a mine, a few near ones, and hundreds on to the horizon of the belt."""
    rng = np.random.Generator(np.random.PCG64(540))
    middle = np.array((-330.0, 30.0, -210.0))
    turn = sg.quaternion((0.3, 1, 0.2), 40)
    s.put("rock_great", "asteroid_great", middle, turn, (104, 104, 104))
    out = sg.unit(np.array((0.62, 0.42, 0.66)))
    mine = s.put("outpost", "mine", middle + 104 * great_radius(out, turn) * out, sg.quaternion_product(sg.aim(-out), sg.quaternion((1, 0, 0), 90)), 1.3)
    for k in range(4):
        a = math.tau * k / 4 + 0.4
        s.light("mine_flood_%d" % k, (13 * math.sin(a), 7, 13 * math.cos(a)), (1.0, 0.86, 0.62), 3.0e5, 30.0, mine)
    for k, (x, y, z, r) in enumerate(((-120, -74, 250, 13), (-78, 60, 60, 9), (-520, 150, -660, 46), (-190, 120, -90, 14), (-190, -130, 60, 16), (-620, 20, -720, 60), (-20, -130, -120, 22), (150, 150, -60, 7), (-205, 30, 190, 8))):
        spin = sg.quaternion(rng.normal(size=3), 360 * rng.random())
        node = s.put("rock_fine_%d" % (k % 3), "asteroid_near_%d" % k, (x, y, z), spin, r * (0.8 + 0.4 * rng.random(3)))
        if k < 6:
            s.g.spin("tumble_%d" % k, node, rng.normal(size=3), 90.0 + 20 * k, 1, spin)
    count = 0
    while count < 300:
        t, a, b, size = rng.random(4)
        depth = 300.0 * (40000.0 / 300.0) ** t                  # 300 m to 40 km ahead
        at = np.array([-0.62 + 0.95 * a + 0.10 * rng.normal(), 0.11 + 0.10 * rng.normal() + 0.16 * (0.5 - a), -1.0]) * depth + np.array([0, 0, 300.0])
        radius = (0.004 + 0.014 * size ** 3) * depth ** 0.92
        if np.linalg.norm(at - (205, 118, -980)) < 420 + radius or np.linalg.norm(at - (-48, -6, 96)) < 220 or (b > 0.55 and at[0] > 0):
            continue
        kind = "rock_fine_%d" % (count % 3) if radius / depth > 0.0075 else "rock_%d" % (count % 3)
        s.put(kind, "asteroid_%03d" % count, at, sg.quaternion(rng.normal(size=3), 360 * rng.random()), radius * (0.75 + 0.5 * rng.random(3)))
        count += 1


# ---------------------------------------------------------------- sky

def heavens(s):
    """The planet, the glow of its air, its moon."""
    g, centre = s.g, PLANET_WAY * PLANET_FAR
    g.node("planet", centre, sg.aim(PLANET_WAY), PLANET_RADIUS, s.root, mesh=s.kinds["planet"])
    g.node("planet_air", centre, sg.aim(PLANET_WAY), PLANET_RADIUS, s.root, mesh=s.kinds["air"])
    s.put("moon", "moon", (-2.35e5, 3.05e5, -1.02e6), sg.quaternion((0.2, 1, 0), 150), 5.5e4)


def matrix_of(q):
    """The rotation matrix of a quaternion."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def planet_materials(g, mats):
    """The planet's own maps and the limb of its air; both are painted for eyes near the sector's middle."""
    frame = matrix_of(sg.aim(PLANET_WAY))
    maps = {kind: g.texture("planet_" + kind, image, True) for kind, image in bodies.planet_maps(frame.T @ sg.unit(np.array((0.35, 0.90, 0.25)))).items()}
    mats["planet"] = g.material("planet", maps, metal=0.0, emit=(1, 1, 1), nits=3200.0, substance="water")
    del g.materials[mats["planet"]]["occlusionTexture"]
    mats["ocean"] = g.material("ocean", base=(0.03, 0.06, 0.12), rough=0.6)
    mesh, glow = bodies.limb(PLANET_FAR / PLANET_RADIUS, frame.T @ TO_SUN)
    mats["air"] = g.material("air", {"emit": g.texture("planet_air_emission", glow, True)}, (0, 0, 0), 1.0, 0.0, (1, 1, 1), 4200.0)
    return mesh


def build_views(s):
    """`hero` first. Cameras see without a far plane."""
    cam = lambda name, eye, target, fov, near: s.g.camera(name, eye, target, fov, near, None, s.root)
    cam("hero", (-44, 32, 346), (10, 12, -200), 42.0, 0.5)
    cam("close", (-17, 18, 121), (-5, 1, 29), 46.0, 0.2)
    cam("far", (-760, 380, 1480), (90, 20, -620), 36.0, 1.0)


def build(folder):
    """Make everything and write it to the folder."""
    g = sg.Gltf("Burnish samples/space/make_scene.py")
    mats = surfaces.make_materials(g)
    air = planet_materials(g, mats)
    s = Stage(g, mats)
    build_views(s)
    g.light("sun", "directional", 5000.0 * TO_SUN, -TO_SUN, SUN_COLOUR, SUN_LUX, shadow=True, parent=s.root)
    g.light("planet_shine", "directional", 5000.0 * PLANET_WAY, -PLANET_WAY, (0.42, 0.62, 1.0), 1300.0, parent=s.root)
    register(s)
    s.kind("air", {"air": air})
    heavens(s)
    build_station(s)
    fleet(s)
    belt(s)
    sg.write_atomic(os.path.join(folder, "stars.hdr"), sg.hdr_bytes(bodies.star_map(sun=TO_SUN), packed=False))
    g.save(folder, "space", extras={"environment": "stars.hdr", "ev100": EV100})
    return [os.path.join(folder, "space.gltf")], g.summary()


if __name__ == "__main__":
    sys.exit(sg.run(__doc__, build, "space"))
