"""Buildings of the rts sample. Blue builds in panels: white blocks, domes, blue bands, cool light. Red builds in stone and
timber: battered walls, steep red roofs, forges, fire. Every function returns {material: mesh}; doors face +z."""
import numpy as np

import scenegen as sg
from nature import burning, flame
from shapes import DARK, STEEL, WOOD, WOOD_PALE, ball, block, coloured, drum, grounded, outline, pipe, polygon, profile, rectangle, solid

WHITE, BLUE, NAVY, TRIM = "#e3e7ea", "#2767d6", "#27405f", "#6fb1ff"
RED, ROOF, WALL, IRON = "#cf2f25", "#c2402c", "#b09a80", "#3d302b"


def gather(**parts):
    """{material: mesh} from lists of (mesh, colour), with the occlusion of the ground; None colours stay as they are."""
    out = {}
    for name, pairs in parts.items():
        if name.startswith("glow") or name == "fire":
            out[name] = sg.merge(*pairs)
        else:
            out[name] = grounded(coloured(*pairs), 1.0, 0.45)
    return out


def windows(count, width, y, z, x0, x1, height=0.5):
    """A row of lit panes on a wall that faces +z."""
    return [block((width, height, 0.12), (x, y, z)) for x in np.linspace(x0, x1, count)]


def all_round(mesh):
    """The mesh and its copies at right angles."""
    return [mesh.turned((0, 1, 0), 90 * k) for k in range(4)]


def blue_hq():
    """Command centre, 18 m wide: stepped blocks, a band of windows, a dome and a mast."""
    panel = [(block((18, 1.2, 16), (0, 0, 0), 0.98), NAVY), (block((15, 4.2, 13), (0, 1.2, 0), 0.95), WHITE), (block((10.5, 3.6, 9), (-1.0, 5.4, -0.8), 0.93), WHITE)]
    for x in (-1, 1):
        panel.append((block((2.6, 6.6, 4.4), (7.1 * x, 0.6, 3.4), 0.86), WHITE))
        panel.append((block((2.75, 0.6, 4.55), (7.1 * x, 4.6, 3.4), 0.97), BLUE))
    panel += [(block((15.0, 0.7, 13.0), (0, 3.7, 0), 1.0), BLUE), (block((10.6, 0.5, 9.1), (-1.0, 8.0, -0.8), 0.99), BLUE)]
    panel.append((block((5.4, 3.4, 2.2), (0, 0.6, 6.6), 0.9), WHITE))
    flat = [(block((3.4, 2.5, 0.3), (0, 1.2, 7.62), 1.0), DARK), (ball(2.5, (-1.0, 8.9, -0.8), 14, 8).scaled(1, 1, 1), "#9fb6cc")]
    flat += [(pipe((4.6, 5.3, -3.8), (4.6, 14.5, -3.8), 0.16, 6), STEEL), (pipe((4.6, 12.0, -3.8), (4.6, 12.0, -2.2), 0.07, 4), STEEL), (pipe((3.6, 13.2, -3.8), (5.6, 13.2, -3.8), 0.07, 4), STEEL)]
    flat += [(block((1.6, 1.0, 1.6), (3.5, 9.0 - 3.6, 4.0), 0.85), NAVY), (drum(8, 0.8, 0.8, 0.7, (-5.2, 5.4, 4.6)), NAVY)]
    glow = windows(5, 1.2, 6.3, 3.6, -4.6, 2.6, 0.8) + [block((0.14, 0.5, 1.6), (4.12, 6.4, z)) for z in (-3.2, -0.8, 1.6)]
    glow += windows(3, 1.3, 2.1, 6.36, -6.0, -3.6, 0.7)[:2] + windows(3, 1.3, 2.1, 6.36, 3.6, 6.0, 0.7)[1:]
    glow += [block((2.4, 0.18, 0.16), (0, 3.75, 7.66)), block((0.16, 0.6, 8.0), (7.35, 2.3, -1.6))]
    return gather(panel=panel, flat=flat, glow_cool=glow)


def blue_barracks():
    """A vaulted hall, 9 x 13 m."""
    a = np.linspace(0, np.pi, 8)
    arch = [(4.5 * np.cos(t), 0.4 + 3.9 * np.sin(t)) for t in a]
    rib = [(4.62 * np.cos(t), 0.4 + 4.05 * np.sin(t)) for t in a]
    panel = [(block((9.6, 0.5, 13.6), (0, 0, 0)), NAVY), (outline(arch, 12.6), WHITE)]
    panel += [(outline(rib, 0.7).moved(0, 0, z), BLUE) for z in (-5.6, -1.9, 1.9, 5.6)]
    flat = [(outline([(-1.5, 0.5), (1.5, 0.5), (1.5, 2.4), (1.1, 2.9), (-1.1, 2.9), (-1.5, 2.4)], 0.3).moved(0, 0, 6.35), DARK)]
    flat += [(block((0.9, 0.6, 0.9), (0, 4.2, z)), STEEL) for z in (-3.8, 0.0)]
    glow = [block((0.9, 0.5, 0.14), (s * 2.5, 1.9, 6.3)) for s in (-1, 1)] + [block((2.0, 0.16, 0.14), (0, 3.15, 6.35))]
    return gather(panel=panel, flat=flat, glow_cool=glow)


def blue_factory():
    """A vehicle works, 15 x 12 m, with a north-light roof and a wide door."""
    panel = [(block((15.6, 0.5, 12.6), (0, 0, 0)), NAVY), (block((15, 4.4, 12), (0, 0.5, 0), 0.985), WHITE), (block((15.05, 0.6, 12.05), (0, 3.6, 0), 0.985), BLUE)]
    for k in range(3):
        panel.append((outline([(-2.4, 0.0), (2.4, 0.0), (2.4, 0.3), (-2.2, 2.0)], 11.4).moved(-4.9 + 4.9 * k, 4.9, 0), "#8fa3b6"))
    flat = [(block((6.0, 3.3, 0.3), (-2.6, 0.5, 5.95)), "#43505e")]
    flat += [(block((6.1, 0.14, 0.2), (-2.6, 0.9 + 0.7 * k, 6.08)), STEEL) for k in range(4)]
    flat += [(block((0.35, 3.7, 0.5), (-2.6 + 3.2 * s, 0.5, 6.05)), "#f2b632") for s in (-1, 1)]
    flat += [(drum(9, 0.9, 0.75, 6.5, (5.6, 3.0, -4.0)), "#8fa3b6"), (drum(9, 0.95, 0.95, 0.6, (5.6, 8.2, -4.0)), BLUE)]
    glow = windows(2, 1.3, 2.0, 5.95, 3.0, 5.4, 0.8) + [block((0.12, 0.9, 9.0), (-7.15 + 4.9 * k, 5.3, 0)) for k in range(3)] + [block((5.4, 0.2, 0.2), (-2.6, 4.0, 6.05))]
    return gather(panel=panel, flat=flat, glow_cool=glow)


def blue_power():
    """Two cooling towers and a block."""
    curve = [(2.9, 0.0), (2.3, 2.2), (1.95, 4.4), (2.15, 6.4)]
    tower = sg.merge(sg.lathe([sg.spline(curve, 2), [(2.15, 6.4), (1.85, 6.4)], [(1.85, 6.4), (1.7, 5.0)], [(1.7, 5.2), (0.0, 5.2)]], 12))
    band = sg.lathe([[(2.09, 5.6), (2.19, 6.1)]], 12)
    panel = [(block((13.5, 0.5, 8.0), (0, 0, 0)), NAVY), (block((3.6, 3.6, 6.0), (5.0, 0.5, 0), 0.93), WHITE), (block((3.6, 0.5, 6.0), (5.0, 3.0, 0), 0.95), BLUE)]
    flat = []
    for x in (-4.2, 0.6):
        flat += [(tower.moved(x, 0.5, 0), "#cfd8df"), (band.moved(x, 0.5, 0), BLUE)]
    flat += [(pipe((-1.9, 1.4, 1.6), (3.4, 1.4, 1.6), 0.28, 6), STEEL), (pipe((-1.9, 2.2, 1.0), (3.4, 2.2, 1.0), 0.2, 6), STEEL)]
    glow = [block((0.9, 0.6, 0.14), (5.0 + x, 1.8, 2.92)) for x in (-0.9, 0.9)] + [sg.lathe([[(1.55, 5.72), (0.0, 5.72)]], 12).moved(x, 0.02, 0) for x in (-4.2, 0.6)]
    return gather(panel=panel, flat=flat, glow_cool=glow)


def blue_tower():
    """A gun tower 8 m tall."""
    panel = [(block((3.4, 0.6, 3.4), (0, 0, 0)), NAVY), (block((2.6, 4.8, 2.6), (0, 0.6, 0), 0.72), WHITE), (solid([rectangle(1.9, 1.9, 5.2), rectangle(3.2, 3.2, 5.9), rectangle(3.2, 3.2, 6.6)]), WHITE),
             (block((3.24, 0.35, 3.24), (0, 6.0, 0)), BLUE)]
    flat = [(drum(8, 1.0, 0.75, 0.9, (0, 6.6, 0)), NAVY)] + [(pipe((x, 7.1, 0.5), (x, 7.25, 2.7), 0.14, 6), STEEL) for x in (-0.35, 0.35)]
    glow = [block((0.8, 0.3, 0.1), (0, 4.3, 1.0))] + all_round(block((1.6, 0.16, 0.1), (0, 6.42, 1.62)))
    return gather(panel=panel, flat=flat, glow_cool=glow)


def blue_wall():
    """Four metres of wall along x with a light on top."""
    panel = [(block((4.0, 0.4, 1.4), (0, 0, 0)), NAVY), (solid([rectangle(4.0, 0.95, 0.4), rectangle(4.0, 0.6, 2.3)]), WHITE), (block((4.0, 0.25, 0.8), (0, 2.2, 0)), BLUE)]
    panel.append((block((0.7, 2.7, 1.2), (-1.65, 0, 0), 0.9), "#aab6c1"))
    return gather(panel=panel)


def landing_pad():
    """A round pad 14 m wide with lights around its edge; the craft on it is the dropship."""
    flat = [(drum(16, 7.4, 7.0, 0.5), "#4a5663"), (drum(16, 6.6, 6.6, 0.06, (0, 0.5, 0)), "#5d6b7a"), (drum(16, 4.2, 4.2, 0.04, (0, 0.56, 0)), "#e9c23a"), (drum(16, 3.8, 3.8, 0.04, (0, 0.59, 0)), "#5d6b7a")]
    flat += [(block((0.8, 0.04, 4.4), (x, 0.625, 0)), "#e7edf2") for x in (-1.3, 1.3)] + [(block((1.8, 0.04, 0.8), (0, 0.625, 0)), "#e7edf2")]
    glow = [block((0.3, 0.22, 0.3), (6.8 * np.sin(a), 0.5, 6.8 * np.cos(a))) for a in np.arange(12) * np.pi / 6]
    return gather(flat=flat, glow_cool=glow)


def radar_base():
    """The radar's foot; its dish is a mesh of its own that turns."""
    panel = [(block((6.0, 0.5, 6.0), (0, 0, 0)), NAVY), (block((4.6, 3.0, 4.6), (0, 0.5, 0), 0.85), WHITE), (block((4.5, 0.4, 4.5), (0, 2.6, 0), 0.93), BLUE)]
    flat = [(drum(8, 1.0, 0.8, 1.6, (0, 3.5, 0)), NAVY)]
    glow = [block((0.9, 0.5, 0.12), (x, 1.5, 2.16)) for x in (-1.0, 1.0)]
    return gather(panel=panel, flat=flat, glow_cool=glow)


def radar_dish():
    """A dish on a fork, turning about y; it stands on its bearing at y = 0."""
    arc = np.linspace(0.0, 0.62, 5)
    inner = np.stack([4.6 * np.sin(arc), 4.6 - 4.6 * np.cos(arc)], 1)[::-1]
    outer = np.stack([4.6 * np.sin(arc), 4.45 - 4.6 * np.cos(arc)], 1)
    dish = sg.lathe([outer, [outer[-1], inner[0]], inner], 14)
    horn = sg.merge(pipe((0, 0, 0), (0, 2.6, 0), 0.08, 5), drum(6, 0.26, 0.16, 0.5, (0, 2.4, 0)))
    tilt = lambda m: m.turned((1, 0, 0), 62).moved(0, 2.0, 0.4)
    return gather(flat=[(drum(8, 0.85, 0.6, 0.5), NAVY), (block((0.5, 2.0, 0.7), (0, 0.3, 0.1), 0.8), STEEL), (tilt(dish), WHITE), (tilt(horn), BLUE)])


def dropship():
    """A squat transport with four engine pods, standing on skids."""
    hull = solid([rectangle(2.2, 5.4, 0.7), rectangle(3.0, 6.6, 1.5), rectangle(2.6, 5.8, 2.4), rectangle(1.7, 3.6, 2.9)])
    flat = [(hull, "#aebccb"), (block((3.04, 0.35, 6.4), (0, 1.45, 0), 0.99), BLUE), (profile([(1.5, 1.9), (3.35, 1.6), (2.95, 2.1), (1.9, 2.75)], 1.5), "#9fd3e6")]
    for x in (-1, 1):
        for z in (-2.0, 1.9):
            flat += [(drum(9, 0.75, 0.85, 1.3, (2.7 * x, 1.0, z)), NAVY), (drum(9, 0.88, 0.88, 0.25, (2.7 * x, 1.9, z)), TRIM), (block((1.2, 0.3, 0.7), (1.8 * x, 1.55, z)), STEEL)]
        flat += [(block((0.25, 0.2, 5.0), (1.1 * x, 0, 0)), DARK), (block((0.2, 0.7, 0.2), (1.1 * x, 0.15, 1.6)), DARK), (block((0.2, 0.7, 0.2), (1.1 * x, 0.15, -1.6)), DARK)]
    flat.append((profile([(-3.2, 2.2), (-1.8, 2.4), (-2.9, 4.2), (-3.5, 4.2)], 0.3), BLUE))
    return {"flat": coloured(*flat), "lamp": block((0.5, 0.3, 0.2), (0, 1.2, 3.28))}


def hip_roof(width, depth, y, height, over=0.7, ridge=0.35):
    """A steep hipped roof with eaves."""
    lower = [(x * (width / 2 + over), y - 0.25, z * (depth / 2 + over)) for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    edge = [(p[0], y, p[2]) for p in lower]
    top = [(x * ridge * width / 2, y + height, z * ridge * depth / 2) for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return solid([lower, edge, top], 1.6)


def red_keep():
    """The fortress, 18 m wide: battered stone, four corner towers, a great hall on top."""
    stone = [(block((16, 1.0, 16), (0, 0, 0), 0.97), "#8b7c6b"), (block((14, 5.4, 14), (0, 1.0, 0), 0.88), WALL)]
    roof, wood, glow = [], [], []
    for x in (-1, 1):
        for z in (-1, 1):
            stone.append((solid([polygon(6, 2.5, 0, 0.5), polygon(6, 1.95, 8.2, 0.5), polygon(6, 2.35, 8.6, 0.5), polygon(6, 2.35, 9.4, 0.5)]).moved(6.6 * x, 0, 6.6 * z), WALL))
            roof.append((solid([polygon(6, 2.8, 9.3, 0.5), polygon(6, 2.75, 9.5, 0.5), np.tile([0, 13.2, 0], (6, 1))], 1.6).moved(6.6 * x, 0, 6.6 * z), ROOF))
            glow.append(block((0.5, 0.9, 0.12), (6.6 * x, 6.6, 6.6 * z + 1.8)))
    stone.append((block((9, 4.2, 8), (0, 6.4, 0), 0.95), "#c3ae92"))
    wood += [(block((9.1, 0.5, 8.1), (0, 8.6, 0), 0.98), WOOD), (block((0.5, 4.1, 0.4), (-4.3, 6.4, 3.95), 1.0), WOOD), (block((0.5, 4.1, 0.4), (4.3, 6.4, 3.95)), WOOD), (block((0.5, 4.1, 0.4), (0, 6.4, 3.95)), WOOD)]
    roof.append((hip_roof(9, 8, 10.6, 5.2), ROOF))
    for k in range(4):
        for t in (-1, 1):
            merlon = block((1.3, 1.1, 0.8), (2.4 * t, 6.3, 6.1)).turned((0, 1, 0), 90 * k)
            stone.append((merlon, WALL))
    wood.append((outline([(-2.0, 0.0), (2.0, 0.0), (2.0, 2.9), (1.1, 4.0), (-1.1, 4.0), (-2.0, 2.9)], 0.4).moved(0, 0.2, 7.0), IRON))
    stone.append((outline([(-2.7, 0.0), (2.7, 0.0), (2.7, 3.4), (1.6, 4.9), (-1.6, 4.9), (-2.7, 3.4)], 1.0).moved(0, 0.1, 6.6), "#8b7c6b"))
    flat = [(pipe((0, 15.5, 0), (0, 19.0, 0), 0.12, 5), IRON), (solid([[(0, 18.8, 0.06), (2.6, 18.2, 0.06), (0, 17.4, 0.06)], [(0, 18.8, -0.06), (2.6, 18.2, -0.06), (0, 17.4, -0.06)]]), RED)]
    flat += [(block((1.7, 3.4, 0.12), (4.2 * s, 2.2, 6.95), 1.0).turned((1, 0, 0), 0), RED) for s in (-1, 1)]
    glow += windows(4, 0.8, 7.3, 3.92, -3.2, 3.2, 1.1) + [m for k in (1, 2, 3) for m in [block((0.8, 1.1, 0.12), (x, 7.3, 4.0)).turned((0, 1, 0), 90 * k) for x in (-2.0, 2.0)]]
    return gather(stone=stone, plank=wood, tiles=roof, flat=flat, glow_warm=glow)


def red_longhouse():
    """Barracks, 8 x 13 m: plank walls on stone under a steep roof."""
    stone = [(block((8.4, 1.1, 13.0), (0, 0, 0), 0.97), "#8b7c6b")]
    wood = [(block((7.6, 2.6, 12.2), (0, 1.0, 0)), WOOD_PALE), (outline([(-3.8, 0.0), (3.8, 0.0), (0.0, 4.2)], 12.2).moved(0, 3.6, 0), "#8a6239")]
    wood += [(block((0.5, 2.8, 0.5), (x, 0.9, z)), WOOD) for x in (-3.8, 3.8) for z in (-6.0, -2.0, 2.0, 6.0)]
    side = [(0.0, 4.75), (-4.7, -0.75), (-4.7, -0.4), (0.0, 5.15)]
    roof = [(outline(side, 13.6).moved(0, 3.6, 0), ROOF), (outline([(-x, y) for x, y in side], 13.6).moved(0, 3.6, 0), ROOF)]
    wood += [(block((2.0, 2.6, 0.3), (0, 0.4, 6.1)), IRON), (block((0.5, 0.5, 14.2), (0, 8.45, 0)), WOOD)]
    glow = [block((0.8, 0.8, 0.14), (s * 2.4, 2.0, 6.12)) for s in (-1, 1)] + [block((0.7, 0.7, 0.14), (0, 4.9, 6.12))] + [block((0.14, 0.8, 0.9), (s * 3.82, 2.0, z)) for s in (-1, 1) for z in (-4, 0, 4)]
    return gather(stone=stone, plank=wood, tiles=roof, glow_warm=glow)


def red_foundry():
    """A forge hall with two chimneys and an open furnace mouth."""
    stone = [(block((13, 4.6, 10), (0, 0, 0), 0.93), WALL), (block((13.4, 0.7, 10.4), (0, 0, 0)), "#8b7c6b")]
    for x, h in ((-4.2, 12.5), (-0.8, 10.5)):
        stone.append((drum(8, 1.5, 1.0, h, (x, 0, -3.4)), "#8f5a45"))
        stone.append((drum(8, 1.25, 1.25, 0.7, (x, h - 0.6, -3.4)), IRON))
    roof = [(hip_roof(12.4, 9.4, 4.6, 2.9, 0.5, 0.45), "#7e3a2c")]
    flat = [(outline([(-2.3, 0.0), (2.3, 0.0), (2.3, 2.2), (1.2, 3.4), (-1.2, 3.4), (-2.3, 2.2)], 0.7).moved(2.6, 0.2, 4.8), IRON), (block((1.8, 0.9, 2.6), (-4.0, 0, 5.9)), WOOD), (block((1.5, 0.5, 2.2), (-4.0, 0.7, 5.9)), "#23262b")]
    fire = [burning(outline([(-1.6, 0.0), (1.6, 0.0), (1.6, 1.9), (0.8, 2.7), (-0.8, 2.7), (-1.6, 1.9)], 0.2).moved(2.6, 0.3, 5.12), -0.2, 3.6)]
    fire += [burning(drum(8, 0.9, 0.5, 0.5, (x, y, -3.4)), y - 0.3, y + 0.9) for x, y in ((-4.2, 12.0), (-0.8, 10.0))]
    return gather(stone=stone, tiles=roof, flat=flat, fire=fire, glow_warm=windows(2, 0.9, 2.2, 4.78, -3.6, -1.6, 0.9))


def red_tower():
    """A timber watch tower with a fire basket, 9 m."""
    wood = [(pipe((1.7 * x, 0, 1.7 * z), (1.15 * x, 5.8, 1.15 * z), 0.2, 5), WOOD) for x in (-1, 1) for z in (-1, 1)]
    for k in range(4):
        wood.append((pipe((1.65, 0.6, 1.65), (-1.3, 3.8, 1.3), 0.1, 4).turned((0, 1, 0), 90 * k), WOOD))
    wood += [(block((3.6, 0.35, 3.6), (0, 5.6, 0)), WOOD_PALE)] + [(m, WOOD_PALE) for m in all_round(block((3.4, 0.9, 0.14), (0, 5.95, 1.7)))]
    wood += [(pipe((1.5 * x, 5.9, 1.5 * z), (1.5 * x, 8.1, 1.5 * z), 0.12, 4), WOOD) for x in (-1, 1) for z in (-1, 1)]
    return gather(plank=wood, tiles=[(hip_roof(3.2, 3.2, 8.1, 2.2, 0.5, 0.02), ROOF)], flat=[(drum(8, 0.3, 0.55, 0.5, (0, 5.95, 0)), IRON)], fire=[flame(0.36, 0.9).moved(0, 6.4, 0)])


def red_palisade():
    """Four metres of sharpened logs along x."""
    wood = []
    for k in range(7):
        x, h = -1.75 + 0.583 * k, 2.6 + 0.25 * (k % 3 - 1)
        wood.append((solid([polygon(6, 0.31, 0), polygon(6, 0.29, h), np.tile([0, h + 0.6, 0], (6, 1))], 2.0, (False, False)).moved(x, 0, 0.05 * (k % 2)), (WOOD, WOOD_PALE, "#80583a")[k % 3]))
    wood.append((block((4.0, 0.25, 0.18), (0, 1.7, -0.36)), WOOD))
    return gather(plank=wood)


def mill():
    """A windmill's tower; its sails are a mesh of their own. Sails turn at (0, 8.4, 2.6)."""
    stone = [(drum(10, 3.3, 3.1, 1.0), "#8b7c6b"), (drum(10, 3.0, 2.0, 8.0, (0, 0.8, 0)), "#ebe0c8")]
    roof = [(solid([polygon(10, 2.5, 8.6), polygon(10, 2.4, 8.9), np.tile([0, 12.2, 0], (10, 1))], 1.6), "#3e6f94")]
    wood = [(block((1.5, 2.2, 0.3), (0, 0.6, 2.95)), WOOD), (block((0.9, 1.0, 0.25), (0, 4.6, 2.45)), WOOD), (pipe((0, 8.4, 1.0), (0, 8.4, 2.7), 0.24, 6), WOOD), (block((3.2, 0.3, 0.3), (0, 3.2, 2.55)), WOOD)]
    return gather(stone=stone, tiles=roof, plank=wood, glow_warm=[block((0.6, 0.7, 0.14), (0, 4.72, 2.56))])


def mill_sails():
    """Four sails in the plane z = 0 about the origin."""
    parts = [(drum(8, 0.45, 0.45, 0.5).turned((1, 0, 0), 90).moved(0, 0, -0.1), WOOD)]
    for k in range(4):
        spar = block((0.2, 5.8, 0.2), (0, 0, 0))
        cloth = solid([[(0.12, 1.2, 0.0), (1.5, 1.2, 0.16), (1.5, 5.7, 0.16), (0.12, 5.7, 0.0)], [(0.12, 1.2, 0.06), (1.5, 1.2, 0.22), (1.5, 5.7, 0.22), (0.12, 5.7, 0.06)]])
        bars = sg.merge(*[block((1.5, 0.1, 0.1), (0.78, y, 0.17)) for y in (1.2, 2.7, 4.2, 5.6)])
        parts += [(m.turned((0, 0, 1), 90 * k + 22), c) for m, c in ((spar, WOOD), (cloth, "#f3ead2"), (bars, WOOD_PALE))]
    return gather(flat=parts)


def cottage(roof="#b5552f", size=1.0):
    """A villager's house, 6 x 5 m, with a chimney."""
    stone = [(block((6.2, 0.7, 5.2), (0, 0, 0)), "#8b7c6b"), (block((5.8, 2.6, 4.8), (0, 0.6, 0)), "#efe4cc"), (block((0.9, 5.4, 0.9), (1.9, 0, -1.3)), "#8f5a45")]
    stone.append((profile([(-2.4, 0.0), (2.4, 0.0), (0.0, 2.5)], 5.8).moved(0, 3.2, 0), "#efe4cc"))
    side = [(0.0, 2.95), (-3.1, -0.3), (-3.1, 0.0), (0.0, 3.3)]
    tiles = [(profile(side, 6.6, 1.6).moved(0, 3.2, 0), roof), (profile([(-z, y) for z, y in side], 6.6, 1.6).moved(0, 3.2, 0), roof)]
    wood = [(block((1.1, 2.0, 0.2), (-1.2, 0.5, 2.4)), WOOD)] + [(block((0.3, 2.7, 0.3), (x, 0.5, z)), WOOD) for x in (-2.8, 2.8) for z in (-2.3, 2.3)] + [(block((5.7, 0.26, 0.2), (0, 3.0, 2.36)), WOOD)]
    glow = [block((0.9, 0.9, 0.14), (1.2, 1.5, 2.38)), block((0.14, 0.9, 0.9), (2.9, 1.5, 0.6))]
    return gather(stone=stone, tiles=tiles, plank=wood, glow_warm=glow)


def bridge(length=30.0, width=7.0):
    """A stone bridge along z; its deck is at y = 0 and it hangs below."""
    stone = [(block((width, 0.9, length), (0, -0.9, 0)), "#b3a592")]
    for z in (-length / 6, length / 6):
        stone.append((solid([rectangle(width + 1.0, 2.2, -6.5, 0, z), rectangle(width + 0.2, 1.7, -0.9, 0, z)]), "#9c8f7e"))
    for s in (-1, 1):
        stone.append((block((0.6, 0.9, length), (s * (width / 2 - 0.1), 0, 0), 1.0), "#a09484"))
        stone.append((block((0.8, 0.22, length + 0.2), (s * (width / 2 - 0.1), 0.9, 0)), "#c4b8a6"))
        for z in np.linspace(-length / 2 + 0.5, length / 2 - 0.5, 5):
            stone.append((block((1.1, 1.7, 1.1), (s * (width / 2 - 0.1), -0.2, z), 0.9), "#b3a592"))
    return {"stone": coloured(*stone)}
