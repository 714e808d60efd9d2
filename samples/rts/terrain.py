"""The ground of the rts sample: heights, the river, roads, the painted map and the water."""
import numpy as np

import scenegen as sg
from scenegen import Noise, smooth
from shapes import colour

HALF, CELLS = 256.0, 512            # the map's half width in metres and its samples a side
WATER = 0.0                         # height of the water's surface
# through the map from the far left to the near right, x and z in metres, and the river's half width there
RIVER = np.array([(-190, -250), (-128, -150), (-82, -96), (-52, -58), (-24, -28), (2, -3), (25, 20), (50, 52), (70, 90), (84, 140), (100, 260)], float)
LAKE = (-86.0, -98.0, 30.0)
BLUE, RED, VILLAGE, MINE = (-44.0, 24.0), (44.0, -40.0), (-66.0, -34.0), (58.0, 14.0)
BRIDGE = (1.0, -4.0)
CRATERS = [(-3.5, 15.0, 2.3), (-17.0, -5.0, 2.0), (17.5, -4.5, 2.4), (5.5, -29.0, 2.1), (28.0, -3.0, 1.9), (-8.0, 31.0, 2.0), (-24.0, -2.0, 1.7), (22.5, 4.0, 2.0), (2.0, 33.0, 1.7)]
ACROSS = np.array([0.70, -0.714])    # unit, over the bridge from blue to red
ROADS = {
    "main": [(-44, 24), (-30, 19), (-18, 12), (-9.5, 6.7), (11.5, -14.7), (17.5, -19.4), (24.3, -24.6), (34, -32), (43, -37)],
    "west": [(-44, 24), (-58, 8), (-66, -12), (-62, -30), (-84, -40), (-120, -36), (-170, -50), (-255, -40)],
    "south": [(-44, 24), (-36, 42), (-14, 50), (10, 56), (24, 74), (26, 110), (8, 170), (0, 255)],
    "east": [(17.5, -19.4), (35, -13), (54, 6), (66, 20), (100, 26), (150, 40), (255, 60)],
    "north": [(17.5, -19.4), (10.5, -36), (11, -56), (19, -78), (14, -104), (20, -170), (30, -255)],
}


def samples(points, steps=12):
    """A smooth line through points, densely."""
    return sg.spline(np.asarray(points, float), steps)


def grid():
    """Coordinates of the height samples."""
    c = (np.arange(CELLS) + 0.5) / CELLS * 2 * HALF - HALF
    return np.meshgrid(c, c)


def distance_to(line, x, z):
    """From every grid point to a line of short segments."""
    best = np.full(x.shape, np.inf)
    for (ax, az), (bx, bz) in zip(line[:-1], line[1:]):
        ex, ez = bx - ax, bz - az
        t = np.clip(((x - ax) * ex + (z - az) * ez) / max(ex * ex + ez * ez, 1e-9), 0.0, 1.0)
        best = np.minimum(best, (x - ax - t * ex) ** 2 + (z - az - t * ez) ** 2)
    return np.sqrt(best)


class Ground:
    """Heights and distances on a regular grid, sampled bilinearly."""

    def __init__(self):
        x, z = grid()
        n = Noise(301, CELLS)
        self.broad, self.fine = n.fbm(5, octaves=4), n.fbm(24, octaves=3)
        wobble = 5.0 * (n.fbm(14, octaves=3) - 0.5)
        self.river = distance_to(samples(RIVER, 6), x, z) + wobble
        lake = np.hypot(x - LAKE[0], (z - LAKE[1]) * 1.25) + 12.0 * (n.fbm(8, octaves=3) - 0.5)
        self.river = np.minimum(self.river, lake - LAKE[2] + 7.0)
        self.road = np.full(x.shape, np.inf)
        for points in ROADS.values():
            self.road = np.minimum(self.road, distance_to(samples(points, 5), x, z))
        self.road = self.road + 1.2 * (self.fine - 0.5)
        self.height = self._heights(x, z)
        gz, gx = np.gradient(self.height, 2 * HALF / CELLS)
        self.slope = np.hypot(gx, gz)
        self.gx, self.gz = gx, gz

    def _heights(self, x, z):
        land = 2.3 + 5.0 * (self.broad - 0.5) + 0.7 * (self.fine - 0.5)
        away = np.hypot(x, z)
        edge = smooth(88, 190, away + 50 * (self.broad - 0.5))
        land = land + edge * (7.0 + 42.0 * (self.broad - 0.28).clip(0, 1)) + 2.5 * edge * self.fine
        ridge = lambda cx, cz, r, top: top * np.exp(-((x - cx) ** 2 + (z - cz) ** 2) / (r * r))
        land = land + ridge(86, -84, 26, 12) + ridge(76, -4, 12, 4) + ridge(-16, -74, 20, 6)
        for (cx, cz), radius, top in ((BLUE, 30, 3.2), (RED, 29, 6.0), (VILLAGE, 14, 3.2), (MINE, 9, 2.6)):
            d = np.hypot(x - cx, z - cz) + 6 * (self.fine - 0.5)
            land = land + (top - land) * smooth(radius + 8, radius, d)
        # roads are cut level with what they pass, at the height of the bridge's deck near it
        near = np.hypot(x - BRIDGE[0], z - BRIDGE[1])
        land = land + (2.75 - land) * smooth(26, 15, near) * smooth(7.0, 3.0, self.road)
        for cx, cz, r in CRATERS:
            d = np.hypot(x - cx, z - cz) / r
            land = land - 0.75 * smooth(1.0, 0.1, d) + 0.28 * np.exp(-((d - 1.15) / 0.3) ** 2)
        valley = smooth(5.5, 15.0 + 40.0 * edge, self.river)
        return (land.clip(0.9, None)) * valley - 2.6 * (1 - smooth(4.0, 9.5, self.river))

    def at(self, field, x, z):
        """A grid field at a point or at arrays of points."""
        px = (np.asarray(x, float) + HALF) / (2 * HALF) * CELLS - 0.5
        pz = (np.asarray(z, float) + HALF) / (2 * HALF) * CELLS - 0.5
        px, pz = np.clip(px, 0, CELLS - 1.001), np.clip(pz, 0, CELLS - 1.001)
        ix, iz = px.astype(int), pz.astype(int)
        fx, fz = px - ix, pz - iz
        f = getattr(self, field)
        return (f[iz, ix] * (1 - fx) + f[iz, ix + 1] * fx) * (1 - fz) + (f[iz + 1, ix] * (1 - fx) + f[iz + 1, ix + 1] * fx) * fz

    def normal(self, x, z):
        """Unit normal of the ground at a point."""
        return sg.unit(np.array([-self.at("gx", x, z), 1.0, -self.at("gz", x, z)]))


def lines(limit=255.0):
    """Grid lines: two metres apart where the game is, coarser outside."""
    inner = np.arange(-120.0, 120.1, 2.0)
    outer = np.array([126, 134, 144, 156, 170, 186, 204, 222, 240, limit])
    return np.concatenate([-outer[::-1], inner, outer])


def ground_mesh(ground):
    """The heightfield with its texture coordinates over the whole map."""
    c = lines()
    x, z = np.meshgrid(c, c)
    z = z[::-1]                                              # rows run towards -z, so that the grid's winding looks up
    y = ground.at("height", x, z)
    n = sg.unit(sg.stack(-ground.at("gx", x, z), 1.0, -ground.at("gz", x, z)))
    t = sg.unit(sg.stack(n[..., 1], -n[..., 0], 0.0 * y))
    p = sg.stack(x, y, z).reshape(-1, 3)
    uv = sg.stack((x + HALF) / (2 * HALF), (z + HALF) / (2 * HALF)).reshape(-1, 2)
    k = len(c) - 1
    return sg.Mesh(p, n.reshape(-1, 3), np.concatenate([t.reshape(-1, 3), np.ones((len(p), 1))], 1), uv, sg._grid_indices(k, k))


def enlarge(a, factor):
    """Bilinear enlargement, cell centres kept."""
    n = a.shape[0]
    c = np.clip((np.arange(n * factor) + 0.5) / factor - 0.5, 0, n - 1.001)
    i = c.astype(int)
    f = (c - i).astype(np.float32)
    a = a.astype(np.float32)
    rows = a[:, i] * (1 - f) + a[:, i + 1] * f
    return rows[i] * (1 - f)[:, None] + rows[i + 1] * f[:, None]


def painted(ground, contact, factor=4):
    """Base colour of the ground; contact is 1 in the open, less under things."""
    up = lambda a: enlarge(a, factor)
    n = Noise(302, CELLS)
    tile = lambda a: np.tile(a, (factor, factor)).astype(np.float32)
    grain, blots = tile(n.fbm(32, octaves=4)), tile(n.fbm(12, octaves=3))
    strokes = tile(n.fbm(20, 90, 2))
    height, slope, river, road = up(ground.height), up(ground.slope), up(ground.river), up(ground.road)
    broad = up(ground.broad)
    edge = lambda lo, hi, v: smooth(lo, hi, v).astype(np.float32)
    mix = lambda a, b, t: a + (np.asarray(b, np.float32) - a) * t[..., None]
    out = np.empty(height.shape + (3,), np.float32)
    out[:] = colour("#5f9a35")
    out = mix(out, colour("#86b83f"), edge(0.50, 0.56, blots + 0.5 * (broad - 0.5)))
    out = mix(out, colour("#3f7f38"), edge(0.55, 0.60, 1 - blots + 0.3 * (grain - 0.5)) * 0.8)
    out = mix(out, colour("#a9cc4e"), edge(0.66, 0.68, strokes) * edge(0.45, 0.6, broad) * 0.5)
    dirt = edge(3.6, 3.0, road + 1.4 * (grain - 0.5))
    rim = edge(4.6, 3.6, road + 1.4 * (grain - 0.5))
    out = mix(out, colour("#4c7f2f"), rim * 0.7)
    out = mix(out, colour("#b98a55"), dirt)
    ruts = edge(0.35, 0.15, np.abs(np.abs(road - 0.2) - 1.15))
    out = mix(out, colour("#94683d"), ruts * dirt * 0.75)
    for (cx, cz), radius, text in ((BLUE, 21.0, "#9aa2a5"), (RED, 21.0, "#a3795a"), (MINE, 7.0, "#7a6a63"), (VILLAGE, 9.0, "#b98a55")):
        x, z = grid()
        d = up(np.hypot(x - cx, z - cz)) + 5.0 * (grain - 0.5) + 3.0 * (blots - 0.5)
        out = mix(out, colour("#4c7f2f"), edge(radius + 1.2, radius, d) * 0.8)
        out = mix(out, colour(text), edge(radius, radius - 0.6, d))
        out = mix(out, colour(text) * 0.8, edge(0.52, 0.56, blots) * edge(radius, radius - 0.6, d) * 0.6)
    sand = edge(12.0, 10.6, river + 2.0 * (blots - 0.5)) * edge(3.0, 2.0, height)
    out = mix(out, colour("#e2c88a"), sand)
    out = mix(out, colour("#b79a63"), edge(0.35, 0.05, height) * sand)
    out = mix(out, colour("#3f7d74"), edge(0.0, -0.9, height))
    cliff = edge(0.66, 0.78, slope + 0.25 * (grain - 0.5))
    out = mix(out, colour("#a39a92"), cliff)
    out = mix(out, colour("#857c78"), cliff * edge(0.5, 0.55, strokes))
    x, z = grid()
    for cx, cz, r in CRATERS:
        d = up(np.hypot(x - cx, z - cz)) / r + 0.9 * (grain - 0.5)
        out = mix(out, colour("#6f5a3c"), edge(1.75, 1.35, d) * 0.8)
        out = mix(out, colour("#3a2f25"), edge(1.15, 0.6, d) * 0.9)
    return out * (0.9 + 0.2 * grain)[..., None] * (0.55 + 0.45 * up(contact))[..., None]


def contact_map(spots):
    """Ambient occlusion on the grid from (x, z, radius, depth) spots; rectangles come as (x, z, hx, hz, degrees, depth)."""
    out = np.ones((CELLS, CELLS))
    step = 2 * HALF / CELLS
    c = (np.arange(CELLS) + 0.5) * step - HALF
    for spot in spots:
        x, z = spot[:2]
        reach = (spot[2] * 1.9 + 0.8) if len(spot) == 4 else np.hypot(*spot[2:4]) + 3.5
        i0, i1 = np.searchsorted(c, (x - reach, x + reach))
        j0, j1 = np.searchsorted(c, (z - reach, z + reach))
        px, pz = np.meshgrid(c[i0:i1] - x, c[j0:j1] - z)
        if len(spot) == 4:
            d = np.hypot(px, pz)
            shade = 1 - spot[3] * smooth(spot[2] * 1.9 + 0.6, 0.35 * spot[2], d)
        else:
            a = np.radians(spot[4])
            u, v = px * np.cos(a) - pz * np.sin(a), px * np.sin(a) + pz * np.cos(a)
            d = np.hypot(np.maximum(np.abs(u) - spot[2], 0), np.maximum(np.abs(v) - spot[3], 0))
            shade = 1 - spot[5] * np.exp(-d / 1.1)
        out[j0:j1, i0:i1] *= shade
    return np.maximum(out, 0.25)


def water_mesh():
    """One level sheet where the river and the lake are; texture coordinates run over the whole map."""
    step = 8.0
    us = np.arange(0, 2 * HALF - 1.0, step)
    ground = water_mesh.ground

    def keep(u, v):
        cx, cz = u - HALF + 1.0, HALF - 1.0 - v
        return ground.at("river", cx, cz) < 13.0 + step
    m = sg.plane((-HALF + 1.0, WATER, HALF - 1.0), (us[-1], 0, 0), (0, 0, -us[-1]), 1.0, us, us, keep)
    m.uv = np.stack([(m.p[:, 0] + HALF) / (2 * HALF), (m.p[:, 2] + HALF) / (2 * HALF)], 1)
    return m


def water_colour(ground, factor=4):
    """Deep to shallow, with a foam line along the banks."""
    height = enlarge(ground.height, factor)
    n = Noise(303, CELLS)
    ripple = enlarge(n.fbm(24, octaves=3), factor)
    d = height + 0.5 * (ripple - 0.5)
    shore = (height / enlarge(np.maximum(ground.slope, 0.2), factor) + 1.6 * (ripple - 0.5)).astype(np.float32)   # metres from the bank, roughly
    mix = lambda a, b, t: a + (np.asarray(b, np.float32) - a) * t[..., None].astype(np.float32)
    out = np.zeros(height.shape + (3,), np.float32) + colour("#0e4f78").astype(np.float32)
    out = mix(out, colour("#1878a0"), smooth(-2.5, -1.6, d))
    out = mix(out, colour("#3fb4bd"), smooth(-1.7, -0.5, d))
    foam = np.maximum(smooth(-1.1, -0.75, shore), 0.5 * smooth(0.30, 0.12, np.abs(shore + 2.1)))
    return mix(out, colour("#eaf6f2"), foam)


def ripples(size=256, metres=10.0):
    """A tileable normal map of small waves."""
    n = Noise(304, size)
    wx, wy = n.warped(4, 0.12)
    h = 0.055 * n.fbm(6, octaves=3, x=wx, y=wy) + 0.012 * n.fbm(24, octaves=2)
    return sg.to_u8(sg.normal_map(h, metres) * 0.5 + 0.5)


def turf(size=256, metres=4.0):
    """A tileable normal map of short grass and clods."""
    n = Noise(305, size)
    h = 0.05 * n.fbm(10, octaves=4) + 0.012 * n.fbm(40, octaves=2)
    return sg.to_u8(sg.normal_map(h, metres) * 0.5 + 0.5)
