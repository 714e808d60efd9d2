"""The station: a spindle that keeps still and a wheel that turns about it. Axis +y, metres; {material: mesh}."""
import numpy as np

import scenegen as sg
from hulls import PANEL, collect
from solids import block, pipe, solid

RADIUS = 250.0


def wheel():
    """The ring, its spokes and their collars."""
    out = []
    inner, outer, half = RADIUS - 20, RADIUS + 20, 22.0
    wall = lambda *points, seg=120: sg.lathe([[a, b] for a, b in zip(points[:-1], points[1:])], seg, PANEL)
    c = 8.0
    rim = [(outer, -half + c), (outer, half - c), (outer - c, half), (inner + c, half), (inner, half - c), (inner, -half + c), (inner + c, -half), (outer - c, -half), (outer, -half + c)]
    out.append(("hull", wall(*rim)))
    for y in (-9.0, -3.0, 3.0, 9.0):
        out.append(("windows", sg.lathe([[(outer + 0.4, y - 1.0), (outer + 0.4, y + 1.0)]], 120, 16.0)))
    for y in (-6.0, 6.0):
        out.append(("windows", sg.lathe([[(inner - 0.4, y + 2.0), (inner - 0.4, y - 2.0)]], 120, 16.0)))
    for r in (RADIUS - 6.0, RADIUS + 6.0):
        for s in (-1, 1):
            ends = [(r + 1.0, s * (half + 0.4)), (r - 1.0, s * (half + 0.4))]
            out.append(("windows", sg.lathe([ends if s > 0 else ends[::-1]], 120, 16.0)))
    for y in (-half + c, half - c):
        lip = [(outer, y - 1.2), (outer + 1.6, y - 0.8), (outer + 1.6, y + 0.8), (outer, y + 1.2)]
        out.append(("hull_orange", wall(*lip)))
    rng = np.random.Generator(np.random.PCG64(503))
    for k in range(24):
        a = 15.0 * k
        place = lambda m: m.turned((0, 1, 0), a)
        size = 6 + 7 * rng.random(3)
        out.append((("hull_grey", "hull", "hull_dark")[k % 3], place(block((size[0], 3.0 + size[1] * 0.3, size[2] * 2.0), (RADIUS + 4 * (k % 2 - 0.5), half - 0.5, 0), 0.9, PANEL))))
        out.append(("hull_grey", place(block((size[2], 3.0 + size[0] * 0.25, size[1] * 2.2), (0, 0, 0), 0.9, PANEL).turned((0, 0, 1), 180).moved(RADIUS + 5 * (k % 2 - 0.5), -half + 0.5, 0))))
        if k % 2 == 0:
            out.append(("hull_grey", place(block((5.0, 30.0, 9.0), (outer - 1.5, -15, 0), 1.0, PANEL))))
    for k in range(6):
        place = lambda m: m.turned((0, 1, 0), 60 * k)
        spoke = solid([[(30, y, z) for y, z in ((-7, -7), (7, -7), (7, 7), (-7, 7))], [(inner + 3, y, z) for y, z in ((-5, -5), (5, -5), (5, 5), (-5, 5))]], PANEL)
        out.append(("hull", place(spoke)))
        for y in (-7.6, 7.6):
            out.append(("metal", place(pipe((34, y, 0), (inner + 2, y * 0.8, 0), 0.9, 6))))
        out.append(("windows", place(strip_on_spoke(inner))))
        out.append(("windows", place(strip_on_spoke(inner, -1))))
        for r in (80.0, 150.0):
            out.append(("hull_orange", place(block((4.0, 16.0 - r * 0.02, 16.0 - r * 0.02), (r, -8.0 + r * 0.01, 0), 1.0, PANEL))))
        out.append(("hull_grey", place(block((14.0, 26.0, 24.0), (inner - 3.0, -13.0, 0), 1.0, PANEL))))
        for s in (-1, 1):
            out.append(("nav_red", place(block((1.6, 1.6, 1.6), (RADIUS, s * (half + 4.2) - 0.8, 34.0)))))
            out.append(("hull_dark", place(block((3.0, 4.0, 3.0), (RADIUS, s * (half + 1.6) - 2.0, 34.0)))))
    out.append(("hull_grey", sg.lathe([[(34, -12), (34, 12)], [(34, 12), (26, 12)], [(26, -12), (34, -12)]], 24, PANEL)))
    return collect(out)


def strip_on_spoke(inner, side=1):
    """Windows along a spoke's broad face."""
    z0, z1 = 7.15 * side, 5.15 * side
    pts = [(34, -1, z0), (inner, -1, z1), (inner, 1, z1), (34, 1, z0)]
    m = sg._fan(pts, np.tile([0.0, 0.0, float(side)], (4, 1)), (1, 0, 0), 16.0)
    m.uv = m.uv - np.array([0.0, m.uv[:, 1].min() % 0.125])
    return m


def spindle():
    """Hub, docks, masts and the trusses that carry the solar wings."""
    out = []
    core = [[(0.0, -120), (14, -120)], [(14, -120), (22, -108), (22, -70)], [(22, -70), (26, -60), (26, 60)], [(26, 60), (22, 70), (22, 110)], [(22, 110), (16, 124)], [(16, 124), (0.0, 124)]]
    out.append(("hull", sg.lathe([[a, b] for piece in core for a, b in zip(piece[:-1], piece[1:])], 24, PANEL)))
    for y in (-92.0, -84.0, 78.0, 84.0, 90.0, 96.0):
        out.append(("windows", sg.lathe([[(22.3, y - 1.0), (22.3, y + 1.0)]], 24, 16.0)))
    for y in (-64.0, 66.0):
        out.append(("hull_orange", sg.lathe([[(26.0, y - 2), (27.5, y - 1.5), (27.5, y + 1.5), (26.0, y + 2)]], 24, PANEL)))
    out.append(("foil", sg.lathe([[(22.4, -104), (22.4, -98)]], 24, 3.0)))
    # docks below: a collar with lit bays
    for k in range(8):
        place = lambda m: m.turned((0, 1, 0), 45 * k)
        out.append(("hull_grey", place(block((16, 12, 12), (27, -114, 0), 0.92, PANEL))))
        out.append(("flood", place(block((0.5, 5.0, 7.0), (35.0, -110.6, 0)))))
        out.append(("metal", place(pipe((33, -116, 0), (46, -132, 0), 0.8, 6))))
    out.append(("metal", pipe((0, 124, 0), (0, 230, 0), 1.6, 8)))
    for y in (150.0, 185.0, 215.0):
        out.append(("metal", sg.ring(5.0, 0.5, 24, 4.0).moved(0, y, 0)))
        for a in (0.0, 90.0):
            out.append(("metal", pipe((-5, y, 0), (5, y, 0), 0.3, 5).turned((0, 1, 0), a)))
    out.append(("nav_red", sg.sphere(1.6, 10, 6).moved(0, 231, 0)))
    dish = sg.lathe([sg.spline([(0.0, 0.0), (8.0, 1.0), (15.0, 4.0)], 3), [(15.0, 4.0), (14.6, 4.6)], sg.spline([(14.6, 4.6), (8.0, 1.8), (0.0, 0.9)], 3)], 24, PANEL)
    out.append(("hull", dish.turned((0, 0, 1), -70).moved(20, 118, 0)))
    for s in (-1, 1):
        # beams, not lattices: at a kilometre thin bars would only flicker
        out.append(("hull_grey", solid([[(s * 20, -96 + dy, dz) for dy, dz in ((-4, -4), (4, -4), (4, 4), (-4, 4))], [(s * 332, -96 + dy, dz) for dy, dz in ((-2.4, -2.4), (2.4, -2.4), (2.4, 2.4), (-2.4, 2.4))]], PANEL)))
        for x in (150.0, 200.0, 250.0, 300.0):
            out.append(("hull_orange", block((7, 9.0, 9.0), (s * x, -100.5, 0), 1.0, PANEL)))
        out.append(("nav_red" if s > 0 else "nav_green", block((3, 3, 3), (s * 334, -97.5, 0))))
    return collect(out)


def solar_wing():
    """One blanket of cells, 40 x 150 m, facing +z, hung on a boom along +y from the origin."""
    front = sg.plane((-20, 8, 0.3), (40, 0, 0), (0, 150, 0), 4.0)
    back = sg.plane((20, 8, -0.3), (-40, 0, 0), (0, 150, 0), PANEL)
    out = [("solar", front), ("hull_grey", back), ("metal", pipe((0, 0, 0), (0, 160, 0), 0.9, 6))]
    for y in np.linspace(8, 158, 6):
        out.append(("metal", block((41, 1.0, 1.0), (0, y - 0.5, 0))))
    for x in (-20, 20):
        out.append(("metal", block((0.8, 150, 0.9), (x, 8, 0))))
    return collect(out)


def wing_places():
    """(x, y, z, degrees about y, upside down) of the wings on the trusses."""
    out = []
    for s in (-1, 1):
        for x in (150.0, 200.0, 250.0, 300.0):
            for up in (False, True):
                out.append((s * x, -96.0, 0.0, up))
    return out
