"""The places of the rts sample: both bases, the village with its mill."""
import math

import scenegen as sg
from field import COOL, FIRE, WARM, bearing, lamp, lantern, stores
from terrain import ACROSS, BLUE, RED, VILLAGE


def blue_base(f):
    """Around BLUE, looking over the river."""
    cx, cz = BLUE
    turn = bearing(*ACROSS) - 8
    place = lambda kind, dx, dz, half, extra=0.0: (f.local(cx, cz, turn, dx, dz), f.building(kind, *f.local(cx, cz, turn, dx, dz), turn + extra, half))
    place("blue_hq", 0, -8, (9, 8))
    place("blue_barracks", -15.5, -20, (4.8, 6.8))
    place("blue_barracks", -27, -18, (4.8, 6.8))
    place("blue_factory", 19, -12, (7.8, 6.3), -14)
    place("blue_power", 3, -24, (6.8, 4.0))
    (px, pz), y = place("landing_pad", -13, 12.5, (7, 7))
    f.put("dropship", px, pz, turn + 25, 1.0, y=y + 0.62, shade=0)
    for k in range(12):
        a = k * math.pi / 6 + math.radians(turn)
        f.light("pad_light", (px + 6.8 * math.sin(a), y + 1.2, pz + 6.8 * math.cos(a)), COOL)
    (px, pz), y = place("radar_base", 15, 3.0, (3, 3))
    radar = f.g.node("radar_dish", (px, y + 5.1, pz), turn + 30, mesh=f.kinds["radar_dish"])
    f.g.spin("radar", radar, (0, 1, 0), 8.0, 1, sg.quaternion((0, 1, 0), turn + 30))
    for dx, dz in ((-24, 20), (24, 19), (0, 26)):
        place("blue_tower", dx, dz, (1.7, 1.7))
        x, z = f.local(cx, cz, turn, dx, dz)
        f.light("tower_light", (x, f.height(x, z) + 6.2, z), COOL)
    for dx in (-20, -15.8, -11.6, 11.6, 15.8, 20):
        (x, z), y = place("blue_wall", dx, 25.0 if abs(dx) < 18 else 24.0, (2, 0.7), 12 * (dx < -18) - 12 * (dx > 18))
        f.g.node(f.name("wall_lantern"), (x, y + 2.45, z), turn, mesh=f.kinds["lantern_cool"])
        f.light("wall_light", (x, y + 3.2, z), COOL)
    for dx, dz in ((-6, 1.5), (6, 1.5), (-9, -8), (9.8, -6), (0, 12), (11, -20), (-10, -21), (-23, 4), (25, -3), (21, 10), (-6, 19), (7, 19)):
        lamp(f, "blue", *f.local(cx, cz, turn, dx, dz), turn + 90)
    for dx, dz in ((-3.4, -0.2), (3.4, -0.2), (19, -4.6), (14.6, -5.4), (-15.5, -11.8), (-27, -9.8)):
        x, z = f.local(cx, cz, turn, dx, dz)
        f.light("door_light", (x, f.height(x, z) + 2.4, z), COOL)
    stores(f, f.local(cx, cz, turn, 10, 8.5), 9)
    stores(f, f.local(cx, cz, turn, -9, 3), 6)


def red_base(f):
    """Around RED, on its hill."""
    cx, cz = RED
    turn = bearing(-32.5, 25.3)            # its gate looks down the road to the bridge
    place = lambda kind, dx, dz, half, extra=0.0: (f.local(cx, cz, turn, dx, dz), f.building(kind, *f.local(cx, cz, turn, dx, dz), turn + extra, half))
    place("red_keep", 0, -8, (8.6, 8.6))
    place("red_longhouse", -18, -4, (4.8, 7))
    place("red_longhouse", -15, 12, (4.8, 7), -20)
    place("red_foundry", 18, -7, (6.7, 5.2), 10)
    place("red_longhouse", 4, -25, (4.8, 7), 90)
    for dx, dz in ((-23, 20), (22, 19), (5.5, 25), (-6.5, 25), (-26, -14)):
        place("red_tower", dx, dz, (1.9, 1.9))
        x, z = f.local(cx, cz, turn, dx, dz)
        f.light("tower_fire", (x, f.height(x, z) + 7.2, z), FIRE)
    for dx in (-19, -14.9, -10.8, 9.8, 13.9, 18):
        place("red_palisade", dx, 25.2 - 0.012 * dx * dx, (2, 0.5), -1.4 * dx)
        x, z = f.local(cx, cz, turn, dx, 23.6 - 0.012 * dx * dx)
        if f.free(x, z, 0.4):
            lantern(f, x, z, turn)
    for dx, dz in ((-4.5, 4), (4.5, 4), (-10, -3), (10, 0.5), (0, 14), (12, 14), (-7, 19), (7, 19), (-24, 6), (25, 4), (12, -17), (-12, -16)):
        x, z = f.local(cx, cz, turn, dx, dz)
        if f.free(x, z, 0.7):
            f.put("brazier", x, z, 40 * dx, 0.7)
            f.light("brazier_fire", (x, f.height(x, z) + 2.9, z), FIRE)
    for dx, dz in ((0, 1.2), (20.6, -0.6), (-18, 3.6), (-12.6, 18.9)):
        x, z = f.local(cx, cz, turn, dx, dz)
        f.light("door_fire", (x, f.height(x, z) + 2.2, z), FIRE)
    stores(f, f.local(cx, cz, turn, 9, 9), 9)
    for k in range(4):
        x, z = f.local(cx, cz, turn, 6.5 + 4.6 * k, 17.0 - 1.5 * (k % 2))
        if f.free(x, z, 2.2):
            f.put("tent_red", x, z, turn + 10 * k, 2.0)
            lantern(f, *f.local(x, z, turn + 10 * k, 1.3, 2.5), 0.0)


def village(f):
    """Cottages and the mill on their hill west of the river, in nobody's hands."""
    cx, cz = VILLAGE
    mill_at = (cx - 4.0, cz - 7.0)
    turn = 152.0
    y = f.building("mill", *mill_at, turn - 110, (2.6, 2.6), 0.3)
    hub = f.local(*mill_at, turn - 110, 0, 2.75)
    base = sg.quaternion((0, 1, 0), turn - 110)
    sails = f.g.node("mill_sails", (hub[0], y + 8.4, hub[1]), base, mesh=f.kinds["mill_sails"])
    f.g.spin("mill", sails, (0, 0, 1), 12.0, -1, base)
    for k, (dx, dz, a) in enumerate(((7, 3, -30), (-1, 7, 20), (9, -6, -70), (-11, 2, 60), (3, 15, 10), (-10, -16, 100))):
        x, z = cx + dx, cz + dz
        if f.free(x, z, 3.6):
            y = f.building(("cottage", "cottage_blue")[k % 2], x, z, a, (3.1, 2.6), 0.2)
            lx, lz = f.local(x, z, a, 1.2, 4.0)
            f.light("window_light", (lx, y + 1.8, lz), WARM)
    for dx, dz in ((1, 0), (12, 1), (-5, 3), (2, -14), (-6, 12)):
        lamp(f, "red", cx + dx, cz + dz, 50 * dx)
    stores(f, (cx + 2.5, cz + 3.0), 4)
