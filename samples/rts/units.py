"""Units of the rts sample: soldiers, tanks, trucks, guns and boats, each one mesh of a few hundred triangles.

Every function returns {material: mesh}; `flat` takes its colours from the vertices, `lamp` glows."""
import numpy as np

import scenegen as sg
from nature import flame
from shapes import DARK, FACTIONS, STEEL, WOOD, ball, block, coloured, drum, grounded, outline, pipe, polygon, profile, rectangle, solid, tint, wheel


def soldier(faction, heavy=False):
    """A stocky figure 2.5 m tall with a rifle, or a launcher on the shoulder."""
    f = FACTIONS[faction]
    parts = []
    for s in (-1, 1):
        parts.append((block((0.36, 0.34, 0.56), (0.24 * s, 0, 0.12 * s + 0.05), 0.9), f["dark"]))
        parts.append((block((0.32, 0.62, 0.36), (0.24 * s, 0.32, 0.10 * s), 1.05), f["cloth"]))
    torso = solid([rectangle(0.72, 0.5, 0.9), rectangle(0.98, 0.6, 1.45), rectangle(0.8, 0.5, 1.72)])
    parts.append((torso, f["main"]))
    parts.append((block((0.78, 0.16, 0.56), (0, 0.92, 0)), f["dark"]))
    parts.append((block((0.62, 0.62, 0.3), (0, 1.05, -0.4), 0.9), f["hull"]))
    parts.append((ball(0.29, (0, 1.93, 0.02), 8, 5), "#e0ab82"))
    helmet = sg.lathe([[(0.40, -0.06), (0.35, 0.06), (0.25, 0.27), (0.0, 0.36)]], 8).moved(0, 2.0, 0)
    parts.append((helmet, f["main"]))
    for s, reach in ((-1, 0.46), (1, 0.34)):
        parts.append((pipe((0.52 * s, 1.55, 0.0), (0.42 * s, 1.2, 0.18), 0.13, 5), f["main"]))
        parts.append((pipe((0.42 * s, 1.2, 0.18), (0.12 * s, 1.28, reach + 0.12), 0.10, 5), "#e0ab82"))
    if heavy:
        parts.append((pipe((0.46, 1.86, -0.75), (0.46, 1.86, 0.95), 0.15, 7), f["hull"]))
        parts.append((pipe((0.46, 1.86, 0.9), (0.46, 1.86, 1.05), 0.2, 7), f["trim"]))
    else:
        gun = sg.merge(block((0.11, 0.16, 1.05), (0.1, 1.22, 0.45)), block((0.09, 0.26, 0.16), (0.1, 1.02, 0.5)), pipe((0.1, 1.31, 0.95), (0.1, 1.31, 1.3), 0.045, 5))
        parts.append((gun, DARK))
    return {"flat": grounded(coloured(*parts), 0.45, 0.5)}


def tracks(length, height, width, gauge, wheels):
    """A pair of tracks with road wheels: (mesh, colour) pairs."""
    out, r = [], height / 2
    shape = [(-length / 2 + 0.3 * r, 0.0), (length / 2 - 0.75 * r, 0.0), (length / 2, 0.75 * r), (length / 2 - 0.35 * r, height), (-length / 2 + 0.35 * r, height), (-length / 2, 0.8 * r)]
    for s in (-1, 1):
        out.append((profile(shape, width).moved(s * gauge / 2, 0, 0), "#23262b"))
        for z in np.linspace(-length / 2 + 0.9 * r, length / 2 - 1.05 * r, wheels):
            out.append((wheel(0.66 * r, 0.08, s * (gauge / 2 + width / 2 - 0.01), 0.72 * r, z, 8), "#5d646d"))
    return out


def tank(faction):
    """A battle tank, 6.6 m long without its gun, turret a little to one side."""
    f = FACTIONS[faction]
    parts = tracks(6.4, 1.25, 0.85, 2.75, 5)
    hull = profile([(-3.1, 0.55), (2.2, 0.45), (3.25, 1.0), (2.3, 1.55), (-3.2, 1.55), (-3.35, 1.1)], 2.1)
    parts.append((hull, f["main"]))
    for s in (-1, 1):
        parts.append((block((1.02, 0.14, 6.5), (1.36 * s, 1.24, -0.05), 0.96), f["hull"]))
        parts.append((block((0.5, 0.3, 1.3), (1.5 * s, 1.38, -2.0), 0.9), f["dark"]))
    turret = solid([rectangle(2.2, 2.6, 1.5, 0, -0.25), rectangle(2.4, 2.9, 1.95, 0, -0.25), rectangle(1.5, 1.8, 2.5, 0, -0.45)])
    gun = sg.merge(pipe((0, 2.0, 0.9), (0, 2.0, 4.1), 0.17, 7), pipe((0, 2.0, 3.75), (0, 2.0, 4.35), 0.25, 7))
    mantlet = block((0.9, 0.6, 0.5), (0, 1.7, 1.15), 0.85)
    hatch = drum(8, 0.45, 0.38, 0.2, (-0.3, 2.48, -0.5))
    stripe = solid([rectangle(2.43, 0.5, 1.7, 0, -0.9), rectangle(2.43, 0.5, 1.97, 0, -0.9)])
    aerial = pipe((0.75, 2.3, -1.1), (0.75, 4.2, -1.45), 0.035, 4)
    head = sg.merge(turret).turned((0, 1, 0), 0)
    parts += [(head, f["main"]), (gun, f["dark"]), (mantlet, f["hull"]), (hatch, f["dark"]), (stripe, f["trim"]), (aerial, DARK)]
    exhaust = sg.merge(*[block((0.5, 0.35, 0.3), (0.65 * s, 1.15, -3.3)) for s in (-1, 1)])
    parts.append((exhaust, "#23262b"))
    return {"flat": grounded(coloured(*parts), 0.55, 0.5), "lamp": lamps(0.8, 1.33, 2.78)}


def wreck():
    """A burnt-out tank, its turret askew, still burning."""
    hull = tank("red")["flat"]
    ash = 0.05 + 0.16 * np.random.Generator(np.random.PCG64(7)).random((len(hull.p), 1))
    hull.c = hull.c * 0.10 + ash * np.array((0.32, 0.27, 0.24))
    return {"flat": hull, "fire": sg.merge(flame(0.6, 1.9).moved(0.2, 2.2, -0.5), flame(0.45, 1.3).moved(-0.7, 1.4, -2.4), flame(0.35, 1.0).moved(0.9, 1.4, 1.2))}


def flash():
    """A muzzle flash along +z from the origin."""
    tongue = solid([polygon(6, 0.12, 0), polygon(6, 0.42, 0.55), np.tile([0.0, 2.1, 0.0], (6, 1))], 1.0, (False, False)).turned((1, 0, 0), 90)
    spikes = [solid([polygon(4, 0.14, 0), np.tile([0.0, 1.0, 0.0], (4, 1))], 1.0, (False, False)).turned((1, 0, 0), 48).moved(0, 0, 0.15).turned((0, 0, 1), 72 * k) for k in range(5)]
    return {"flash": sg.merge(tongue, *spikes)}


def lamps(x, y, z, size=0.24):
    """A pair of headlights."""
    return sg.merge(*[block((size, size, 0.16), (s * x, y - size / 2, z)) for s in (-1, 1)])


def truck(faction):
    """A supply truck under canvas, 7 m long."""
    f = FACTIONS[faction]
    parts = [(block((1.9, 0.35, 6.6), (0, 0.75, 0)), "#2b2e33")]
    cab = sg.merge(profile([(1.3, 1.0), (3.3, 1.0), (3.4, 1.75), (2.6, 1.95), (1.3, 1.95)], 2.3), profile([(1.3, 1.95), (2.5, 1.95), (2.15, 2.75), (1.3, 2.75)], 2.3))
    screen = profile([(2.28, 2.0), (2.56, 1.98), (2.26, 2.66), (2.1, 2.66)], 2.0)
    parts += [(cab, f["main"]), (screen, "#9fd3e6"), (block((2.36, 0.26, 0.25), (0, 0.8, 3.35)), f["dark"])]
    parts.append((block((2.5, 0.75, 4.3), (0, 1.05, -1.15)), f["hull"]))
    canvas = outline([(-1.25, 1.8), (1.25, 1.8), (1.25, 2.55), (0.75, 3.15), (-0.75, 3.15), (-1.25, 2.55)], 4.2).moved(0, 0, -1.15)
    parts.append((canvas, {"blue": "#5b7fae", "red": "#a8613f"}[faction]))
    for z in (-2.75, -0.6, -2.15):
        parts.append((outline([(-1.29, 1.75), (1.29, 1.75), (1.29, 2.57), (0.78, 3.2), (-0.78, 3.2), (-1.29, 2.57)], 0.16).moved(0, 0, z + (0.0 if z != -2.15 else 2.85)), f["trim"]))
    for s in (-1, 1):
        for z in (-2.5, -1.2, 2.2):
            parts.append((wheel(0.58, 0.34, s * 0.85, 0.58, z, 10), "#23262b"))
            parts.append((wheel(0.28, 0.37, s * 0.85, 0.58, z, 6), STEEL))
    return {"flat": grounded(coloured(*parts), 0.6, 0.5), "lamp": lamps(0.85, 1.5, 3.33, 0.3)}


def artillery(faction):
    """A tracked gun with a long raised barrel."""
    f = FACTIONS[faction]
    parts = tracks(5.4, 1.1, 0.7, 2.5, 4)
    parts.append((profile([(-2.6, 0.5), (2.2, 0.5), (2.7, 1.0), (2.2, 1.35), (-2.7, 1.35)], 1.9), f["hull"]))
    parts.append((drum(8, 1.1, 1.0, 0.35, (0, 1.35, -0.6)), f["dark"]))
    shield = solid([rectangle(2.3, 0.5, 1.6, 0, 0.3), rectangle(1.7, 0.25, 2.8, 0, -0.05)])
    parts.append((shield, f["main"]))
    tip = np.array([0.0, 4.3, 4.1])
    parts.append((pipe((0, 1.95, -1.4), (0, 1.95, -1.4) + 0.62 * (tip - (0, 1.95, -1.4)), 0.27, 8), f["hull"]))
    parts.append((pipe((0, 1.95, -1.4) + 0.6 * (tip - (0, 1.95, -1.4)), tip, 0.17, 8), f["dark"]))
    parts.append((pipe(tip - 0.08 * (tip - (0, 1.95, -1.4)), tip + 0.01 * (tip - (0, 1.95, -1.4)), 0.27, 8), f["trim"]))
    for s in (-1, 1):
        parts.append((block((0.45, 1.2, 1.4), (0.75 * s, 1.5, -0.9), 0.8), f["main"]))
        parts.append((block((0.3, 0.2, 1.8), (0.9 * s, 0.12, -3.1), 0.9), f["dark"]))
    return {"flat": grounded(coloured(*parts), 0.55, 0.5), "lamp": lamps(0.7, 1.25, 2.35, 0.22)}


def boat(faction):
    """A patrol boat, 9 m long; its water line is y = 0."""
    f = FACTIONS[faction]
    deck = [(-1.35, 0.9, -4.2), (1.35, 0.9, -4.2), (1.5, 0.95, 1.2), (0.75, 1.15, 3.5), (0.0, 1.3, 4.6), (-0.75, 1.15, 3.5), (-1.5, 0.95, 1.2)]
    keel = [(-1.1, -0.6, -4.0), (1.1, -0.6, -4.0), (1.15, -0.6, 1.0), (0.5, -0.6, 2.8), (0.0, -0.6, 3.6), (-0.5, -0.6, 2.8), (-1.15, -0.6, 1.0)]
    parts = [(solid([keel, deck], 2.0, (False, True)), f["hull"])]
    parts.append((block((2.2, 0.1, 6.0), (0, 0.93, -1.2), 0.97), WOOD))
    parts.append((block((1.7, 1.3, 2.4), (0, 1.0, -1.2), 0.85), f["main"]))
    parts.append((block((1.5, 0.4, 1.9), (0, 1.75, -1.1), 0.9), "#9fd3e6"))
    parts.append((block((1.7, 0.15, 2.3), (0, 2.15, -1.2)), f["trim"]))
    parts.append((drum(8, 0.55, 0.45, 0.6, (0, 1.0, 1.8)), f["dark"]))
    parts.append((pipe((0, 1.45, 2.0), (0, 1.6, 3.7), 0.12, 6), f["dark"]))
    parts.append((pipe((0, 2.2, -1.8), (0, 4.2, -1.9), 0.06, 4), DARK))
    return {"flat": coloured(*parts), "lamp": block((0.3, 0.3, 0.3), (0, 2.3, -0.6))}


def flag(faction):
    """A banner on a pole, 6 m tall."""
    f = FACTIONS[faction]
    pole = sg.merge(pipe((0, 0, 0), (0, 6.0, 0), 0.09, 5), ball(0.18, (0, 6.05, 0), 6, 4))
    wave = lambda u, v: sg.stack(0.05 + 2.2 * u, 4.4 + 1.5 * v - 0.15 * u, 0.22 * np.sin(5.0 * u) * u)
    cloth = sg.patch(wave, 6, 1, 1, 1)
    back = sg.patch(lambda u, v: wave(1 - u, v) + np.array([0, 0, -0.02]), 6, 1, 1, 1)
    band = sg.patch(lambda u, v: wave(u, 0.38 + 0.24 * v) + np.array([0, 0, 0.012]), 6, 1, 1, 1)
    behind = sg.patch(lambda u, v: wave(1 - u, 0.38 + 0.24 * v) + np.array([0, 0, -0.032]), 6, 1, 1, 1)
    return {"flat": grounded(sg.merge(tint(pole, STEEL), tint(cloth, f["main"]), tint(back, f["main"]), tint(band, f["trim"]), tint(behind, f["trim"])))}
