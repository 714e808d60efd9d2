"""Ships of the space sample. Every function returns {material: mesh}; bows point to +z, metres."""
import math

import numpy as np

import scenegen as sg
from solids import block, drum, pipe, rectangle, solid

PANEL = 32.0                        # metres that the hull's maps cover


def section(z, w, h, c, y=0.0):
    """A chamfered rectangle of half sizes w and h at z."""
    return np.array([(w, y - h + c, z), (w, y + h - c, z), (w - c, y + h, z), (-w + c, y + h, z), (-w, y + h - c, z), (-w, y - h + c, z), (-w + c, y - h, z), (w - c, y - h, z)], float)


def loft(sections, ends=(True, True)):
    """A hull through sections, flat shaded; every span is convex, the whole need not be."""
    rings = [section(*s) for s in sections]
    last = len(rings) - 2
    return sg.merge(*[solid([a, b], PANEL, (ends[0] and k == 0, ends[1] and k == last)) for k, (a, b) in enumerate(zip(rings[:-1], rings[1:]))])


def band(sections, z0, z1, grow=0.25):
    """A strip around a loft between two stations, a little proud of it."""
    table = np.array([list(s) + [0.0] * (5 - len(s)) for s in sections], float)
    order = np.argsort(table[:, 0])
    at = lambda z: [np.interp(z, table[order, 0], table[order, k]) for k in range(1, 5)]
    rings = []
    for z in (z0, z1):
        w, h, c, y = at(z)
        rings.append(section(z, w + grow, h + grow, c + 0.4 * grow, y))
    return solid(rings, PANEL, (True, True))


def quad_of(sections, span, face):
    """The four corners of one face of one span: 0 right, 2 top, 4 left, 6 bottom, odd ones the chamfers."""
    a, b = section(*sections[span]), section(*sections[span + 1])
    return a[face], a[(face + 1) % 8], b[(face + 1) % 8], b[face]


def frame_on(sections, span, face, s, t):
    """A point on a hull face with (along, across, normal); s runs from span to span, t across."""
    p0, p1, q1, q0 = quad_of(sections, span, face)
    lo, hi = p0 + (q0 - p0) * s, p1 + (q1 - p1) * s
    along, across = sg.unit((q0 + q1) - (p0 + p1)), sg.unit((p1 + q1) - (p0 + q0))
    n = sg.unit(np.cross(along, across))
    middle = (p0 + p1 + q0 + q1) / 4
    centre = np.array([0.0, np.mean([s_[4] if len(s_) > 4 else 0.0 for s_ in sections[span:span + 2]]), middle[2]])
    return lo + (hi - lo) * t, along, across, n if np.dot(n, middle - centre) > 0 else -n


def greebles(rng, sections, spots, count, size=(1.2, 5.0), height=(0.3, 1.4)):
    """Boxes sitting on hull faces: spots lists (span, face) to choose from."""
    parts = []
    for _ in range(count):
        span, face = spots[int(rng.random() * len(spots))]
        s, t, a, b, h = rng.random(5)
        p, along, across, n = frame_on(sections, span, face, 0.06 + 0.88 * s, 0.14 + 0.72 * t)
        la, lb = size[0] + (size[1] - size[0]) * a * a, size[0] + (size[1] - size[0]) * 0.6 * b * b
        up = height[0] + (height[1] - height[0]) * h * h
        foot = [p + along * x * la / 2 + across * y * lb / 2 - n * 0.8 for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        top = [p + along * x * la * 0.42 + across * y * lb * 0.40 + n * up for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        parts.append(solid([foot, top], PANEL, (False, True)))
    return sg.merge(*parts)


def strip(sections, span, face, s0, s1, t, height=2.0, lift=0.14):
    """A band of windows on a hull face; one row every two metres, as the texture has it."""
    rows = []
    for s in (s0, s1):
        p, _, across, n = frame_on(sections, span, face, s, t)
        rows.append((p - across * height / 2 + n * lift, p + across * height / 2 + n * lift, n))
    (a0, a1, n), (b0, b1, _) = rows
    m = sg._fan([a0, b0, b1, a1], np.tile(n, (4, 1)), sg.unit(b0 - a0), 16.0)
    # whole rows: v of the lower edge to a multiple of an eighth
    m.uv = m.uv - np.array([0.0, m.uv[:, 1].min() % 0.125])
    return m


def bell(radius, length, z, x=0.0, y=0.0, segments=20):
    """An engine nozzle that opens towards -z: (metal, glow)."""
    outer = [(0.55 * radius, 0.0), (0.80 * radius, 0.30 * length), (0.97 * radius, 0.75 * length), (radius, length)]
    inner = [(0.93 * radius, length), (0.89 * radius, 0.82 * length)]
    throat = [(0.89 * radius, 0.82 * length), (0.80 * radius, 0.62 * length), (0.70 * radius, 0.52 * length)]
    nozzle = sg.lathe([sg.spline(outer, 3), [outer[-1], inner[0]], inner], segments, 4.0)
    hoop = sg.lathe([[(1.03 * radius, 0.80 * length), (1.06 * radius, 0.84 * length), (1.06 * radius, 0.92 * length), (1.03 * radius, 0.96 * length)]], segments, 4.0)
    glow = sg.lathe([throat, [(0.70 * radius, 0.52 * length), (0.35 * radius, 0.49 * length), (0.0, 0.48 * length)]], segments, 4.0)
    rim = np.hypot(glow.p[:, 0], glow.p[:, 2]) / (0.89 * radius)
    glow.uv = np.stack([glow.uv[:, 0] * 0.05, rim], 1)
    place = lambda m: m.turned((1, 0, 0), -90).moved(x, y, z)
    return place(sg.merge(nozzle, hoop)), place(glow)


def collect(pairs):
    """{material: merged mesh} from (material, mesh) pairs."""
    out = {}
    for name, mesh in pairs:
        out.setdefault(name, []).append(mesh)
    return {name: sg.merge(*meshes) for name, meshes in out.items()}


CRUISER = [(-92, 20, 11, 5), (-84, 25, 14.5, 6), (-30, 25.5, 15, 6), (-22, 15, 9.5, 4), (-8, 14, 9, 4), (-2, 19, 12, 5), (28, 20, 12.5, 6), (66, 15, 9, 4.5, -0.5), (98, 8, 4.6, 2.4, -1.5), (114, 2.4, 1.5, 0.7, -2.2)]
CRUISER_ENGINES = [(-11.8, 5.3, 4.9), (11.8, 5.3, 4.9), (-11.8, -5.3, 4.9), (11.8, -5.3, 4.9), (0.0, 0.0, 5.6)]


def cruiser():
    """The large ship, 220 m: an engine block, a waist with tanks, a long forebody with turrets."""
    rng = np.random.Generator(np.random.PCG64(501))
    out = [("hull", loft(CRUISER))]
    out.append(("hull_orange", band(CRUISER, 44.0, 48.5)))
    out.append(("hull_orange", band(CRUISER, 51.0, 52.4)))
    out.append(("hull_dark", band(CRUISER, -80.0, -74.0, 0.5)))
    for z in (-62.0, -46.0):
        out.append(("hull_grey", band(CRUISER, z, z + 3.0, 0.7)))
    spots = [(1, 2), (1, 0), (1, 4), (1, 6), (5, 2), (5, 0), (5, 4), (6, 2), (6, 0), (6, 4), (5, 6), (6, 6)]
    out.append(("hull_grey", greebles(rng, CRUISER, spots, 150)))
    out.append(("hull", greebles(rng, CRUISER, spots, 70, (3.0, 11.0), (0.4, 1.6))))
    out.append(("metal", greebles(rng, CRUISER, [(3, f) for f in range(8)] + [(4, 2), (4, 0), (4, 4)], 60, (0.8, 3.0), (0.4, 1.8))))
    for face in (0, 4):
        for span, s0, s1, t in ((1, 0.30, 0.62, 0.30), (1, 0.30, 0.88, 0.62), (5, 0.10, 0.85, 0.42), (6, 0.08, 0.36, 0.5), (5, 0.22, 0.60, 0.74), (6, 0.60, 0.90, 0.5)):
            out.append(("windows", strip(CRUISER, span, face, s0, s1, t)))
    # bridge tower: stepped blocks, windows on every side of the top one
    tower = [(30, 20, 26, 0.86, 14.0, -44), (20, 9, 17, 0.85, 19.0, -48), (13, 7, 10, 0.88, 27.5, -46)]
    for w, h, d, taper, y, z in tower:
        out.append(("hull", block((w, h if y > 14 else 6, d), (0, y, z), taper, PANEL)))
    out.append(("windows", block((12.6, 2.0, 9.6), (0, 30.2, -46), 0.985, 16.0)))
    out.append(("hull_orange", block((14.5, 1.2, 11.0), (0, 34.3, -46), 0.97, PANEL)))
    for x, h in ((-4, 12), (4, 9), (0, 15)):
        out.append(("metal", pipe((x, 35, -49), (x, 35 + h, -50), 0.36, 5)))
    out.append(("hull_grey", drum(12, 2.6, 1.4, 2.0, (-7.5, 28, -52), 0.5, PANEL)))
    # tanks at the waist
    for k in range(6):
        a = math.radians(60 * k + 30)
        x, y = 15.5 * math.cos(a), 10.5 * math.sin(a)
        tank = sg.lathe([sg.spline([(0.0, -7.0), (2.6, -6.0), (3.3, -3.8)], 3), [(3.3, -3.8), (3.3, 3.8)], sg.spline([(3.3, 3.8), (2.6, 6.0), (0.0, 7.0)], 3)], 16, 3.0)
        out.append(("foil", tank.turned((1, 0, 0), 90).moved(x, y, -13)))
    # side pods on pylons
    for s in (-1, 1):
        pod = [(-70, 4, 3.6, 1.8), (-62, 5.2, 4.6, 2.2), (-30, 5.2, 4.6, 2.2), (-8, 2.2, 1.8, 0.9)]
        out.append(("hull_grey", loft(pod).moved(s * 38, -4, 0)))
        out.append(("hull_orange", band(pod, -36, -32).moved(s * 38, -4, 0)))
        pylon = solid([[(s * 24, -2, -66), (s * 24, 2, -66), (s * 24, 2, -36), (s * 24, -2, -36)], [(s * 34, -5, -60), (s * 34, -3, -60), (s * 34, -3, -42), (s * 34, -5, -42)]], PANEL)
        out.append(("hull", pylon))
        metal, glow = bell(3.4, 6, -69, s * 38, -4, 16)
        out += [("metal", metal), ("engine", glow), ("nav_red" if s > 0 else "nav_green", block((0.9, 0.9, 0.9), (s * 43.4, -4.4, -32)))]
        # radiators
        for k in range(3):
            fin = solid([[(s * 12, 13.5, -82 + 7 * k), (s * 12, 13.5, -77 + 7 * k), (s * 13, 13.5, -77 + 7 * k), (s * 13, 13.5, -82 + 7 * k)], [(s * 19, 30, -84 + 7 * k), (s * 19, 30, -80 + 7 * k), (s * 19.4, 30, -80 + 7 * k), (s * 19.4, 30, -84 + 7 * k)]], PANEL)
            out.append(("hull_dark", fin))
    for x, y, r in CRUISER_ENGINES:
        metal, glow = bell(r, 10, -89, x, y)
        out += [("metal", metal), ("engine", glow)]
    for z, y in ((16.0, 12.4), (40.0, 11.4), (62.0, 9.2)):
        out += turret(0.0, y, z)
    for s in (-1, 1):
        for z in (4.0, 24.0):
            out += turret(s * 13.0, -12.0, z, -1.0, 0.7)
    out.append(("hull_dark", solid([[(-1, -9, 70), (1, -9, 70), (1, -9, 92), (-1, -9, 92)], [(-0.5, -19, 66), (0.5, -19, 66), (0.5, -17, 78), (-0.5, -17, 78)]], PANEL)))
    out.append(("metal", pipe((0, -2.2, 112), (0, -2.2, 130), 0.35, 6)))
    return collect(out)


def turret(x, y, z, up=1.0, size=1.0):
    """A twin gun that looks forward."""
    base = drum(12, 3.4, 3.0, 1.4, (0, -0.4, 0), 0.5, PANEL)
    house = solid([rectangle(5.0, 6.4, 0.9), rectangle(4.4, 5.2, 2.6), rectangle(3.0, 3.0, 3.2, 0, -0.4)], PANEL)
    guns = sg.merge(*[pipe((g, 1.9, 2.0), (g, 2.3, 10.0), 0.42, 8) for g in (-1.1, 1.1)], *[pipe((g, 2.27, 9.2), (g, 2.32, 10.6), 0.58, 8) for g in (-1.1, 1.1)])
    place = lambda m: (m if up > 0 else m.turned((0, 0, 1), 180)).scaled(size).moved(x, y, z)
    return [("hull_grey", place(sg.merge(base, house))), ("metal", place(guns))]


def fighter():
    """A single-seat craft, 14 m, with swept wings and two engines."""
    body = [(-5.6, 1.0, 0.8, 0.3), (-4.0, 1.35, 1.05, 0.45), (0.5, 1.15, 0.95, 0.4), (4.0, 0.72, 0.62, 0.28, -0.1), (7.6, 0.16, 0.14, 0.06, -0.25)]
    out = [("hull", loft(body)), ("hull_orange", band(body, -0.2, 0.5, 0.04)), ("hull_orange", band(body, 4.6, 5.0, 0.04))]
    out.append(("canopy", solid([section(-0.6, 0.55, 0.30, 0.2, 0.95), section(0.8, 0.62, 0.52, 0.3, 0.90), section(2.2, 0.5, 0.34, 0.2, 0.72), section(3.2, 0.2, 0.1, 0.06, 0.52)], PANEL)))
    for s in (-1, 1):
        wing = solid([[(s * 1.0, -0.28, -4.6), (s * 1.0, 0.10, -4.6), (s * 1.0, 0.10, 1.4), (s * 1.0, -0.28, 1.4)], [(s * 6.2, -0.85, -5.6), (s * 6.2, -0.70, -5.6), (s * 6.2, -0.70, -3.0), (s * 6.2, -0.85, -3.0)]], PANEL)
        stripe = solid([[(s * 4.3, -0.66, -5.2), (s * 4.3, -0.40, -5.2), (s * 4.3, -0.40, -1.6), (s * 4.3, -0.66, -1.6)], [(s * 5.0, -0.74, -5.35), (s * 5.0, -0.50, -5.35), (s * 5.0, -0.50, -2.1), (s * 5.0, -0.74, -2.1)]], PANEL)
        fin = solid([[(s * 1.1, 0.5, -5.4), (s * 1.3, 0.5, -5.4), (s * 1.3, 0.5, -2.8), (s * 1.1, 0.5, -2.8)], [(s * 2.0, 2.6, -6.4), (s * 2.1, 2.6, -6.4), (s * 2.1, 2.6, -5.2), (s * 2.0, 2.6, -5.2)]], PANEL)
        nacelle = [(-5.4, 0.62, 0.58, 0.28), (-1.2, 0.66, 0.62, 0.3), (1.2, 0.5, 0.46, 0.22)]
        out += [("hull", wing), ("hull_orange", stripe), ("hull_grey", fin), ("hull_grey", loft(nacelle).moved(s * 1.75, 0, 0))]
        metal, glow = bell(0.62, 1.3, -5.3, s * 1.75, 0, 14)
        out += [("metal", metal), ("engine", glow), ("metal", pipe((s * 6.2, -0.78, -3.2), (s * 6.2, -0.78, 1.6), 0.12, 6)),
                ("nav_red" if s > 0 else "nav_green", block((0.16, 0.16, 0.3), (s * 6.3, -0.86, -4.6)))]
    return collect(out)


def freighter():
    """A truss with a cab and engines; containers are instances of their own, placed by `racks`."""
    out = []
    corners = [(-3, -3), (3, -3), (3, 3), (-3, 3)]
    for x, y in corners:
        out.append(("metal", pipe((x, y, -48), (x, y, 44), 0.4, 6)))
    for k in range(12):
        z = -46 + 8 * k
        for (x0, y0), (x1, y1) in zip(corners, corners[1:] + corners[:1]):
            out.append(("metal", pipe((x0, y0, z), (x1, y1, z), 0.25, 5)))
            out.append(("metal", pipe((x0, y0, z), (x1, y1, min(z + 8, 44)), 0.2, 5)))
    cab = [(42, 6, 5, 2), (47, 8, 7, 2.5), (60, 7.5, 6.5, 2.5), (68, 4, 3, 1.5, -0.5)]
    out += [("hull_sand", loft(cab)), ("windows", strip(cab, 1, 0, 0.1, 0.9, 0.6)), ("windows", strip(cab, 1, 4, 0.1, 0.9, 0.6)), ("windows", strip(cab, 2, 2, 0.1, 0.7, 0.5, 2.0)), ("hull_dark", band(cab, 48, 50))]
    rng = np.random.Generator(np.random.PCG64(502))
    out.append(("hull_grey", greebles(rng, cab, [(1, 0), (1, 2), (1, 4), (1, 6)], 26, (0.8, 3.2), (0.2, 0.9))))
    tail = [(-66, 7, 6, 2.5), (-60, 9, 8, 3), (-46, 8, 7, 3)]
    out += [("hull_grey", loft(tail)), ("hull_sand", band(tail, -58, -54, 0.3)), ("metal", greebles(rng, tail, [(1, 0), (1, 2), (1, 4)], 18, (1.0, 3.0), (0.3, 1.0)))]
    for x in (-4, 4):
        metal, glow = bell(3.4, 6, -65, x, 0, 16)
        out += [("metal", metal), ("engine", glow)]
    for s in (-1, 1):
        out.append(("foil", sg.sphere(3.2, 16, 10, 3.0).moved(s * 8.5, 0, -40)))
    return collect(out)


def racks():
    """Where a freighter carries its containers: (x, y, z) of 32 of them."""
    return [(x, y, -33 + 18.6 * k) for k in range(4) for x in (-7.2, 7.2) for y in (-7.2, 0.0, 7.2)] + [(0, y, -33 + 18.6 * k) for k in range(4) for y in (-7.2, 7.2)]


def container():
    """A ribbed box, 6 x 6 x 17.5 m."""
    parts = [block((6.0, 6.0, 17.4), (0, -3.0, 0), 1.0, PANEL)]
    for z in np.linspace(-8.3, 8.3, 5):
        parts.append(block((6.3, 6.3, 0.5), (0, -3.15, z), 1.0, PANEL))
    return sg.merge(*parts)


def shuttle():
    """A stubby transfer craft, 22 m."""
    body = [(-10, 3.0, 2.6, 1.2), (-7, 4.0, 3.4, 1.6), (4, 4.0, 3.4, 1.6), (9, 2.6, 2.0, 1.0, -0.5), (11, 1.2, 0.9, 0.5, -0.8)]
    out = [("hull", loft(body)), ("hull_teal", band(body, -5, -2.5, 0.15)), ("canopy", strip(body, 2, 2, 0.15, 0.8, 0.5, 3.4)), ("windows", strip(body, 1, 0, 0.2, 0.9, 0.62)), ("windows", strip(body, 1, 4, 0.2, 0.9, 0.62))]
    for s in (-1, 1):
        metal, glow = bell(1.5, 3, -9.4, s * 2.0, 0, 14)
        out += [("metal", metal), ("engine", glow), ("hull_grey", solid([[(s * 3.6, -1.5, -8), (s * 3.6, -0.8, -8), (s * 3.6, -0.8, 0), (s * 3.6, -1.5, 0)], [(s * 9, -2.2, -9), (s * 9, -1.9, -9), (s * 9, -1.9, -5), (s * 9, -2.2, -5)]], PANEL))]
    return collect(out)
