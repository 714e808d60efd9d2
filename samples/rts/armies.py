"""Both armies of the rts sample: columns, lines along the banks, reserves, camps, and the patrol that moves."""
import math

import numpy as np

import scenegen as sg
from field import DECK, BRIDGE_TURN, FIRE, HEAD, WARM, along, bearing, lantern
from terrain import ACROSS, BLUE, BRIDGE, RED, RIVER, ROADS, samples


def vehicle(f, kind, x, z, turn, radius=3.6, lit=True, y=None):
    """A vehicle along the slope with one pool of headlight in front of it."""
    node = f.put(kind, x, z, turn, radius, tilt=0.0 if y is not None else 1.0, y=y, shade=0 if y is not None else 0.45)
    if lit:
        hx, hz = f.local(x, z, turn, 0.0, 4.6)
        f.light("headlight", (hx, (f.height(x, z) if y is None else y) + 1.3, hz), HEAD)
    return node


def fire(f, x, y, z, turn):
    """A tank that stands there has just fired: the flash at its gun, and its light."""
    tip = f.local(x, z, turn, 0.0, 4.4)
    f.g.node(f.name("flash"), (tip[0], y + 2.0, tip[1]), turn, mesh=f.kinds["flash"])
    tip = f.local(x, z, turn, 0.0, 5.2)
    f.light("flash_light", (tip[0], y + 2.2, tip[1]), ((1.0, 0.74, 0.36), 4200.0, 10.0))


def squad(f, faction, x, z, turn, rows=3, columns=4, gap=1.9, heavy_row=0):
    """Soldiers in rows that face the same way, one of them with a banner beside."""
    for r in range(rows):
        for c in range(columns):
            px, pz = f.local(x, z, turn, (c - (columns - 1) / 2) * gap, -(r - (rows - 1) / 2) * gap)
            px, pz = px + 0.25 * (f.rng.random() - 0.5), pz + 0.25 * (f.rng.random() - 0.5)
            if f.ground.at("river", px, pz) < 12.0 or f.ground.at("road", px, pz) < 3.4 or not f.free(px, pz, 0.5):
                continue
            kind = "heavy_" if r == rows - 1 - heavy_row else "soldier_"
            f.put(kind + faction, px, pz, turn + 8 * (f.rng.random() - 0.5), 0.55, shade=0.4)
    px, pz = f.local(x, z, turn, (columns / 2 + 0.4) * gap, 0.0)
    if f.free(px, pz, 0.3) and f.ground.at("river", px, pz) > 13.0:
        f.put("flag_" + faction, px, pz, turn - 60, 0.3, shade=0.3)
        lantern(f, *f.local(px, pz, turn, 0.0, 0.9), turn)


def deploy(f):
    """Both armies: columns on the road to the bridge, lines along the banks, reserves in the bases."""
    for k, (x, z, turn) in enumerate(along(ROADS["main"], 17.0, 8.8, 3)):
        vehicle(f, ("tank_blue", "truck_blue", "tank_blue")[k], x, z, turn)
    for t in (-7.5, 1.6):                                               # two tanks on the bridge itself
        vehicle(f, "tank_blue", BRIDGE[0] + ACROSS[0] * t, BRIDGE[1] + ACROSS[1] * t, BRIDGE_TURN, y=DECK)
    fire(f, BRIDGE[0] + ACROSS[0] * 1.6, DECK, BRIDGE[1] + ACROSS[1] * 1.6, BRIDGE_TURN)
    normal = np.array([-ACROSS[1], ACROSS[0]])                          # along the river, to the right of blue's advance
    for a, s, turn in ((15.6, -7.6, 200.0), (-15.5, 19.5, 100.0), (17.5, 16.0, 310.0)):
        x, z = np.array(BRIDGE) + a * ACROSS + s * normal
        f.put("wreck", x, z, turn, 3.4, tilt=1.0, shade=0.6)
        f.light("wreck_fire", (x, f.height(x, z) + 4.6, z), FIRE)
    back = [p[::-1] for p in (ROADS["main"],)][0]
    for k, (x, z, turn) in enumerate(along(back, 9.0, 8.6, 4)):
        vehicle(f, ("truck_red", "tank_red", "tank_red", "tank_red")[k], x, z, turn)
    face = bearing(*ACROSS)
    for faction, sign in (("blue", -1), ("red", 1)):
        turn = face if sign < 0 else face + 180
        for s in (-30, -22, 13, 21, 31, 40):
            p = np.array(BRIDGE) + sign * 21.0 * ACROSS + s * normal
            if f.ground.at("river", *p) > 15.0 and f.ground.at("road", *p) > 4.5 and f.free(p[0], p[1], 3.4):
                vehicle(f, ("tank_" if s % 2 else "artillery_") + faction, p[0], p[1], turn + 6 * (f.rng.random() - 0.5))
        for s, rows, columns in ((-38, 3, 4), (-13, 3, 3), (-26, 3, 5), (9, 2, 4), (26, 3, 5), (36, 3, 4)):
            p = np.array(BRIDGE) + sign * (28.5 if s in (-26, 26) else 16.5) * ACROSS + s * normal
            squad(f, faction, p[0], p[1], turn, rows, columns)
    for faction, (cx, cz), turn in (("blue", BLUE, face), ("red", RED, face + 180)):
        for dx, dz, kind in ((-6, 14, "truck_"), (-1.5, 14, "truck_"), (3, 14, "tank_"), (8, 13, "tank_"), (14, -2, "artillery_"), (14, 4, "tank_")):
            px, pz = f.local(cx, cz, turn, dx, dz)
            if f.free(px, pz, 3.2) and f.ground.at("road", px, pz) > 3.6:
                vehicle(f, kind + faction, px, pz, turn, lit=kind != "artillery_")
        for dx, dz in ((-17, 9), (-19, 1), (18, 12), (0, 22), (-9, 22), (10, 21)):
            px, pz = f.local(cx, cz, turn, dx, dz)
            squad(f, faction, px, pz, turn, 3, 4)
    for k, (t, faction) in enumerate(((0.30, "blue"), (0.405, "red"), (0.56, "blue"), (0.64, "red"))):
        line = samples(RIVER, 24)
        i = int(t * (len(line) - 1))
        d = line[i + 1] - line[i]
        turn = bearing(*(d if faction == "blue" else -d))
        x, z = line[i]
        f.put("boat_" + faction, x, z, turn, 4.0, y=0.0, shade=0)
        f.light("boat_lamp", (x, 2.6, z), WARM)


def camps(f):
    """Fires with soldiers around them, tents behind."""
    for k, (x, z, faction) in enumerate(((-24, 36, "blue"), (-4, 26, "blue"), (-30, -2, "blue"), (-62, 42, "blue"), (8, 40, "blue"), (26, -12, "red"), (62, -18, "red"), (30, -60, "red"), (8, -40, "red"), (70, -44, "red"))):
        if not f.free(x, z, 1.4) or f.ground.at("road", x, z) < 5 or f.ground.at("river", x, z) < 14:
            continue
        f.put("campfire", x, z, 30 * k, 1.1, shade=0.3)
        f.light("campfire_light", (x, f.height(x, z) + 2.3, z), FIRE)
        for j in range(6):
            a = 1.047 * j + 0.4 * k
            px, pz = x + 2.6 * math.sin(a), z + 2.6 * math.cos(a)
            if f.free(px, pz, 0.5):
                f.put("soldier_" + faction, px, pz, math.degrees(a) + 180, 0.55, shade=0.4)
        for j in (-1, 1):
            a = 0.9 * j + k
            px, pz = x + 6.5 * math.sin(a), z + 6.5 * math.cos(a)
            if f.free(px, pz, 2.4) and f.ground.at("road", px, pz) > 5 and f.ground.at("river", px, pz) > 14:
                f.put("tent_" + faction, px, pz, math.degrees(a) + 180, 2.0)
                lx, lz = f.local(px, pz, math.degrees(a) + 180, 1.3, 2.5)
                lantern(f, lx, lz, 0.0)


def patrols(f):
    """Units that move when the animation plays; at rest they stand at the start of their beats."""
    line = along(ROADS["south"], 22.0, 2.0, 24)
    keys = [(x, f.height(x, z) + 0.02, z, turn) for x, z, turn in line[::4]]
    x, y, z, turn = keys[0]
    node = f.g.node("patrol_truck", (x, y, z), turn, mesh=f.kinds["truck_blue"])
    f.taken.append((x, z, 3.6))
    there = [(k[:3], k[3]) for k in keys]
    beat = there + [(there[-1][0], there[-1][1] + 180)] + [(p, t + 180) for p, t in there[-2::-1]] + [there[0]]
    times = np.concatenate([np.arange(len(there)) * 1.6, (len(there) - 1) * 1.6 + 1.0 + np.arange(len(there)) * 1.6, [2 * (len(there) - 1) * 1.6 + 2.0]])
    f.g.animate("patrol", node, "translation", times, [p for p, _ in beat])
    f.g.animate("patrol", node, "rotation", times, [sg.quaternion((0, 1, 0), t) for _, t in beat])
