"""What stands where in the rts sample: the order in which the map fills, road lamps, crystals and woods."""
import math

import numpy as np

import scenegen as sg
from armies import camps, deploy, patrols
from field import BRIDGE_TURN, DECK, GLOWS, WARM, along, lamp
from places import blue_base, red_base, village
from terrain import ACROSS, BLUE, BRIDGE, CRATERS, MINE, RED, RIVER, ROADS, VILLAGE, samples


def mine(f):
    """The crystal field that both sides want, and smaller ones in the woods."""
    rng = f.rng
    for (cx, cz), count, spread in ((MINE, 18, 9.0), ((-18.0, 44.0), 8, 5.5), ((16.0, -52.0), 9, 6.0), ((-92.0, -50.0), 9, 7.0), ((30.0, 40.0), 8, 5.0), ((84.0, -14.0), 8, 6.0), ((-24.0, 76.0), 8, 6.0), ((-74.0, 60.0), 8, 6.0), ((-14.0, -60.0), 7, 6.0)):
        k = 0
        for _ in range(80):
            a, r = rng.random() * math.tau, spread * math.sqrt(rng.random())
            x, z = cx + r * math.sin(a), cz + r * math.cos(a)
            if k == count or not f.free(x, z, 1.2) or f.ground.at("road", x, z) < 4.6 or f.ground.at("river", x, z) < 14:
                continue
            tone = "violet" if cx > 40 or cz < -45 or cz > 70 else "teal"
            size = 0.75 + 0.75 * rng.random()
            f.put("crystal_%s_%d" % (tone, k % 2), x, z, 360 * rng.random(), 1.1 * size, size, shade=0.5)
            f.light("crystal_glow", (x, f.height(x, z) + 1.6 * size, z), GLOWS[tone])
            k += 1


def roadside(f):
    """Lamps along every road: steel on blue's side, lanterns elsewhere; lanterns and lights on the bridge."""
    for name, points in ROADS.items():
        for k, (x, z, turn) in enumerate(along(points, 4.0, 5.0, 60, 0.0)):
            side = 4.3 if k % 2 else -4.3
            a = math.radians(turn)
            px, pz = x - side * math.cos(a), z + side * math.sin(a)
            if abs(px) > 118 or abs(pz) > 118:
                continue
            blue = (np.array([px, pz]) - BRIDGE) @ ACROSS < 0 and name != "west"
            lamp(f, "blue" if blue else "red", px, pz, turn + (90 if side > 0 else -90))
    for style, (cx, cz) in (("blue", BLUE), ("red", RED)):               # around the bases
        for k in range(22):
            a = math.tau * k / 22
            x, z = cx + 32.0 * math.sin(a), cz + 32.0 * math.cos(a)
            if f.ground.at("road", x, z) > 4.0:
                lamp(f, style, x, z, math.degrees(a) + 180)
    for t in (-13.5, -6.8, 0.0, 6.8, 13.5):
        for s in (-1, 1):
            x = BRIDGE[0] + ACROSS[0] * t + s * 3.4 * -ACROSS[1]
            z = BRIDGE[1] + ACROSS[1] * t + s * 3.4 * ACROSS[0]
            f.g.node(f.name("bridge_lantern"), (x, DECK + 1.5, z), BRIDGE_TURN, mesh=f.kinds["lantern"])
            f.light("bridge_light", (x, DECK + 2.4, z), WARM)
    line = samples(RIVER, 24)
    for k in range(36, len(line) - 30, 9):
        d = sg.unit(line[k + 1] - line[k])
        x, z = line[k] + 4.2 * (1 if k % 2 else -1) * np.array([-d[1], d[0]])
        if math.hypot(x - BRIDGE[0], z - BRIDGE[1]) > 14 and f.height(x, z) < -1.5 and f.free(x, z, 1.0):
            f.put("buoy", x, z, 0, 0.7, y=0.0, shade=0)
            f.light("buoy_light", (x, 2.1, z), ((1.0, 0.45, 0.2), 1500.0, 6.5))


def scatter(f):
    """Woods, boulders, bushes and grass wherever nothing else is."""
    rng, ground = f.rng, f.ground

    def sow(kinds, count, radius, wish, sizes=(0.8, 1.25), tries=40, limit=118.0, shade=0.55, road=5.2, tilt=0.0, stem=None):
        done = 0
        for _ in range(count * tries):
            if done == count:
                break
            x, z = (rng.random(2) * 2 - 1) * limit
            chance, pick, spin, grow = rng.random(4)
            if chance > wish(x, z) or ground.at("road", x, z) < road or ground.at("river", x, z) < 12.2 or ground.at("height", x, z) < 0.6:
                continue
            size = sizes[0] + (sizes[1] - sizes[0]) * grow
            if not f.free(x, z, radius * size):
                continue
            f.put(kinds[int(pick * len(kinds))], x, z, 360 * spin, radius * size, size, shade=shade, tilt=tilt, stem=stem)
            done += 1

    def away(x, z):
        d = min(math.hypot(x - c[0], z - c[1]) / r for c, r in ((BLUE, 34), (RED, 33), (VILLAGE, 16), (MINE, 12), (BRIDGE, 30)))
        return max(0.0, min(1.0, (d - 1.0) / 0.15))
    wood = lambda x, z: away(x, z) * float(sg.smooth(0.50, 0.58, ground.at("broad", x, z) + 0.1 * ground.at("fine", x, z)) * 0.9 + 0.02)
    meadow = lambda x, z: away(x, z) * float(sg.smooth(0.54, 0.44, ground.at("broad", x, z))) * 0.25
    sow(["pine_0", "pine_1", "pine_0"], 230, 1.5, wood, (0.75, 1.35))
    sow(["leaf_0", "leaf_1", "leaf_2"], 110, 2.0, lambda x, z: max(meadow(x, z), 0.25 * wood(x, z)), (0.75, 1.15))
    steep = lambda x, z: min(1.0, 0.05 + 2.5 * float(ground.at("slope", x, z)))
    sow(["rock_0", "rock_1", "rock_2"], 90, 0.9, steep, (0.5, 1.7), shade=0.6, tilt=0.6)
    near_water = lambda x, z: float(sg.smooth(19, 13, ground.at("river", x, z)))
    sow(["rock_0", "rock_1", "rock_2"], 40, 0.9, near_water, (0.4, 1.0), shade=0.6)
    sow(["bush"], 120, 0.9, lambda x, z: 0.5 * away(x, z) + 0.15, (0.6, 1.2), shade=0.5)
    sow(["tuft"], 260, 0.35, lambda x, z: 0.3 + near_water(x, z), (0.8, 1.5), 12, 90.0, 0.2, 4.4)


def furnish(f):
    """Everything, the large things first."""
    f.g.node("bridge", (BRIDGE[0], DECK, BRIDGE[1]), BRIDGE_TURN, mesh=f.kinds["bridge"])
    f.taken += [(BRIDGE[0] + ACROSS[0] * t, BRIDGE[1] + ACROSS[1] * t, 3.0) for t in np.linspace(-15, 15, 7)]
    f.taken += [(x, z, 0.8 * r) for x, z, r in CRATERS]
    blue_base(f)
    red_base(f)
    village(f)
    f.taken = [t for t in f.taken if not (abs(t[0] - BRIDGE[0]) < 16 and abs(t[1] - BRIDGE[1]) < 16 and t[2] == 3.0)]
    deploy(f)
    patrols(f)
    mine(f)
    camps(f)
    roadside(f)
    f.taken += [(BRIDGE[0] + ACROSS[0] * t, BRIDGE[1] + ACROSS[1] * t, 3.4) for t in np.linspace(-15, 15, 7)]
    scatter(f)
