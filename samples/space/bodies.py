"""What is not built: asteroids, the planet with its limb of air, the moon, and the sky of stars."""
import math

import numpy as np

import scenegen as sg
from scenegen import blend, smooth, stack


class Lattice:
    """Value noise in space on a lattice that repeats every 32 cells."""

    def __init__(self, seed):
        self.flat = np.random.Generator(np.random.PCG64(seed)).random(32 ** 3).astype(np.float32)

    def at(self, p):
        """Noise in [0, 1] at points (..., 3)."""
        p = np.asarray(p, np.float32)
        i = np.floor(p).astype(np.int32)
        f = p - i
        f = f * f * (3 - 2 * f)
        a, b = i & 31, (i + 1) & 31
        x, y, z = ((a[..., k] * s, b[..., k] * s) for k, s in ((0, 1024), (1, 32), (2, 1)))
        pick = lambda j, k: self.flat[x[j] + y[k] + z[0]] * (1 - f[..., 2]) + self.flat[x[j] + y[k] + z[1]] * f[..., 2]
        rows = [pick(j, 0) * (1 - f[..., 1]) + pick(j, 1) * f[..., 1] for j in (0, 1)]
        return rows[0] * (1 - f[..., 0]) + rows[1] * f[..., 0]

    def fbm(self, p, octaves, gain=0.5):
        """Octaves of noise, in [0, 1]."""
        total, amp, norm = 0.0, 1.0, 0.0
        for k in range(octaves):
            total = total + amp * self.at(p * 2.0 ** k + 7.3 * k)
            norm += amp
            amp *= gain
        return total / norm


def enlarge_map(a, w, h):
    """A latitude-longitude map enlarged bilinearly; it wraps sideways."""
    sh, sw = a.shape
    x = (np.arange(w) + 0.5) * sw / w - 0.5
    y = np.clip((np.arange(h) + 0.5) * sh / h - 0.5, 0, sh - 1.001)
    ix, iy = np.floor(x).astype(int), y.astype(int)
    fx, fy = (x - ix).astype(np.float32), (y - iy).astype(np.float32)
    a = a.astype(np.float32)
    rows = a[:, ix % sw] * (1 - fx) + a[:, (ix + 1) % sw] * fx
    return rows[iy] * (1 - fy)[:, None] + rows[iy + 1] * fy[:, None]


COVERED = math.radians(84.0)        # how far from the near pole the planet's maps reach


def cap_direction(x, y):
    """Lambert's equal-area projection undone: unit vectors about +z for x and y in [-1, 1], held at the rim."""
    edge = math.sqrt(2.0 - 2.0 * math.cos(COVERED))
    r = np.hypot(x, y)
    k = edge * np.minimum(r, 1.0) / np.maximum(r, 1e-9)
    px, py = x * k, y * k
    q = px * px + py * py
    return stack(px * np.sqrt(1 - q / 4), py * np.sqrt(1 - q / 4), 1 - q / 2)


class Cap:
    """Noise over a map of the planet's near side, each octave made no finer than it needs to be."""

    def __init__(self, size):
        self.size = size

    def directions(self, size):
        c = (np.arange(size) + 0.5) / size * 2 - 1
        return cap_direction(c[None] + 0 * c[:, None], -c[:, None] + 0 * c[None]).astype(np.float32)

    def enlarge(self, a, size):
        if a.shape[0] == size:
            return a
        c = np.clip((np.arange(size) + 0.5) * a.shape[0] / size - 0.5, 0, a.shape[0] - 1.001)
        i = c.astype(int)
        f = (c - i).astype(np.float32)
        rows = a[:, i] * (1 - f) + a[:, i + 1] * f
        return rows[i] * (1 - f)[:, None] + rows[i + 1] * f[:, None]

    def fbm(self, seed, frequency, octaves, gain=0.5, warp=None):
        total, amp, norm = 0.0, 1.0, 0.0
        for k in range(octaves):
            f = frequency * 2.0 ** k
            size = self.size
            while size > 192 and size / 2 > 7.5 * f:
                size //= 2
            p = self.directions(size)
            if warp is not None:
                p = p + np.stack([self.enlarge(m, size) if m.shape[0] <= size else m[::m.shape[0] // size, ::m.shape[0] // size] for m in warp], -1)
            total = total + amp * self.enlarge(Lattice(seed + k).at(p * f + 11.7), self.size)
            norm += amp
            amp *= gain
        return total / norm


# ---------------------------------------------------------------- asteroids

def asteroid(seed, segments=24, rings=14, craters=6, lumps=1.0):
    """A body of radius about 1, the rounder the less `lumps` is."""
    rng = np.random.Generator(np.random.PCG64(seed))
    m = sg.sphere(1.0, segments, rings, 1.0)
    d = m.p
    noise = Lattice(seed)
    lift = 1.0 + lumps * (0.75 * (noise.fbm(d * 1.1 + 5, 2) - 0.5) + 0.28 * (noise.fbm(d * 3.1 + 9, 3) - 0.5))
    for _ in range(craters):
        c, r = sg.unit(rng.normal(size=3)), (0.18 + 0.3 * rng.random()) * (0.4 + 0.6 * lumps)
        t = np.arccos(np.clip(d @ c, -1, 1)) / r
        lift = lift - (0.10 + 0.32 * lumps) * r * smooth(1.0, 0.25, t) + 0.10 * r * np.exp(-((t - 1.05) / 0.22) ** 2)
    stretch = 1.0 + lumps * np.array((0.0, -0.22 + 0.2 * rng.random(), -0.15 + 0.2 * rng.random()))
    p = np.round(d * lift[:, None] * stretch, 6)
    return smoothed(sg.Mesh(p, m.n, m.t, m.uv, m.i), segments)


def smoothed(m, segments):
    """Normals from the faces, alike on both sides of the seam and at the poles."""
    key = np.unique(np.round(m.p, 5), axis=0, return_inverse=True)[1].ravel()
    face = np.cross(m.p[m.i[:, 1]] - m.p[m.i[:, 0]], m.p[m.i[:, 2]] - m.p[m.i[:, 0]])
    total = np.zeros((key.max() + 1, 3))
    for k in range(3):
        np.add.at(total, key[m.i[:, k]], face)
    m.n = sg.unit(total)[key]
    along = m.t[:, :3] - m.n * np.sum(m.t[:, :3] * m.n, -1, keepdims=True)
    m.t = np.concatenate([sg.unit(along), m.t[:, 3:]], 1)
    return m


# ---------------------------------------------------------------- planet

def near_side(segments=256, rings=64):
    """The part of a unit sphere that its maps cover: +z is their middle, in an equal-area projection."""
    t, a = np.meshgrid(np.linspace(0, COVERED, rings + 1), np.arange(segments + 1) / segments * math.tau, indexing="ij")
    p = stack(np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)).reshape(-1, 3)
    reach = (np.sin(t / 2) / math.sin(COVERED / 2)).ravel()
    x, y = reach * np.cos(a.ravel()), reach * np.sin(a.ravel())
    e = 1e-4 * np.where(x > 0, -1, 1)                            # inwards: the projection ends at the rim
    along = (cap_direction(x + e, y) - cap_direction(x, y)) / e[:, None]
    along = sg.unit(along - p * np.sum(along * p, -1, keepdims=True))
    tri = sg._without_slivers(p, sg._grid_indices(segments, rings))
    out = np.cross(p[tri[:, 1]] - p[tri[:, 0]], p[tri[:, 2]] - p[tri[:, 0]])
    tri = np.where((np.sum(out * p[tri[:, 0]], 1) < 0)[:, None], tri[:, ::-1], tri)
    return sg.Mesh(p, p.copy(), np.concatenate([along, np.ones((len(p), 1))], 1), np.stack([0.5 + 0.5 * x, 0.5 - 0.5 * y], 1), tri)


def far_side(segments=256, rings=40):
    """The rest of the sphere, which no camera of the scene sees."""
    a = np.linspace(-math.pi / 2, math.pi / 2 - COVERED, rings + 1)
    profile = stack(np.cos(a), np.sin(a))
    profile[0, 0] = 0
    m = sg.lathe([profile], segments)
    m.n = sg.unit(m.p)
    return m.turned((1, 0, 0), 90)


def planet_maps(pole, size=1536):
    """Base colour, normal, ORM and city lights of an ocean world's near side; `pole` is its north in the map's frame."""
    cap = Cap(size)
    d = cap.directions(size)
    warp = [0.30 * (cap.fbm(600 + 10 * k, 2.2, 3) - 0.5) for k in range(3)]
    rise = cap.fbm(640, 2.0, 8, 0.53, warp)
    wet, fine = cap.fbm(660, 4.0, 4), cap.fbm(670, 30.0, 3, 0.7)
    lat = d @ np.asarray(pole, np.float32)
    land = smooth(0.522, 0.527, rise)
    ocean = blend((0.005, 0.018, 0.055), (0.016, 0.090, 0.125), smooth(0.46, 0.525, rise))
    arid = smooth(0.58, 0.42, wet + 0.45 * np.abs(np.abs(lat) - 0.35))
    ground = blend((0.045, 0.085, 0.025), (0.36, 0.235, 0.115), arid)
    ground = blend(ground, (0.17, 0.13, 0.10), smooth(0.58, 0.66, rise))
    ground = blend(ground, (0.78, 0.80, 0.84), smooth(0.66, 0.70, rise + 0.12 * np.abs(lat)))
    ground = ground * (0.62 + 0.76 * fine)[..., None]
    colour = blend(ocean, ground, land)
    ice = smooth(0.84, 0.90, np.abs(lat) + 0.35 * (rise - 0.5) + 0.08 * (fine - 0.5))
    colour = blend(colour, (0.82, 0.87, 0.92), ice)
    cover, depth = clouds(cap, d, lat)
    colour = blend(colour, blend((0.50, 0.55, 0.62), (0.92, 0.93, 0.94), depth), cover)
    facing = np.clip((d[..., 2] - 0.46) / 0.54, 0.0, 1.0)       # 0 at the limb as the sector sees it
    air = 0.05 + 0.62 * (1 - facing) ** 4
    colour = blend(colour, (0.20, 0.44, 0.90), np.clip(air, 0, 0.7))
    rough = (0.38 * (1 - land) + 0.9 * land) * (1 - cover) + 0.95 * cover
    height = 0.020 * np.maximum(rise - 0.524, 0.0) * (1 - cover) + 0.0025 * cover * (0.4 + 0.6 * depth)
    town = smooth(0.54, 0.68, cap.fbm(780, 22.0, 3, 0.7)) * smooth(0.45, 0.60, cap.fbm(790, 5.0, 3)) * land * (1 - ice) * (1 - smooth(0.60, 0.66, rise))
    spots = smooth(0.56, 0.80, cap.fbm(800, 150.0, 2, 0.8)) ** 1.5
    lights = (town * (0.06 + 0.94 * spots) * (1 - 0.85 * cover))[..., None] * np.array((1.0, 0.62, 0.26))
    return {"base": sg.to_srgb(colour), "normal": sg.to_u8(sg.normal_map(height, 2.0) * 0.5 + 0.5), "orm": sg.to_u8(stack(1.0, rough, 0.0)), "emit": sg.to_srgb(lights)}


def clouds(cap, d, lat):
    """Share of the ground that clouds hide, and how thick they are: streets bent by winds, fronts, a few storms that spiral."""
    p = d.astype(np.float64)
    rng = np.random.Generator(np.random.PCG64(745))
    for x, y, sign in ((-0.52, 0.30, 1), (0.10, 0.42, 1), (-0.20, -0.36, -1), (0.42, -0.10, -1), (-0.05, 0.05, 1)):
        c = sg.unit(np.array([x, y, math.sqrt(max(0.05, 1 - x * x - y * y))]))
        r = 0.10 + 0.07 * rng.random()
        t = np.linalg.norm(p - c, axis=-1)
        near = t < 3 * r
        a = sign * 3.8 * np.exp(-(t[near] / r) ** 1.2)
        q = p[near]
        p[near] = q * np.cos(a)[:, None] + np.cross(c, q) * np.sin(a)[:, None] + c * ((q @ c) * (1 - np.cos(a)))[:, None]
    swirl = [(0.20 * (cap.fbm(700 + 10 * k, 3.4, 4) - 0.5) + (p - d)[..., k]).astype(np.float32) for k in range(3)]
    sheet = cap.fbm(740, 3.2, 7, 0.58, swirl)
    belts = 0.035 * np.cos(11.0 * np.arcsin(np.clip(lat, -1, 1)))
    fine = cap.fbm(760, 14.0, 4, 0.62, swirl)
    grain = cap.fbm(770, 44.0, 3, 0.7)
    thick = smooth(0.535, 0.66, sheet + belts + 0.16 * (fine - 0.5) + 0.10 * (grain - 0.5))
    thin = 0.45 * smooth(0.52, 0.70, fine) * smooth(0.44, 0.56, sheet)
    depth = smooth(0.50, 0.72, sheet + 0.30 * (fine - 0.5) + 0.22 * (grain - 0.5))
    return np.clip(thick + thin * (1 - thick), 0, 1), depth


def limb(distance, to_sun_local, segments=256, rings=10):
    """The glow of the air around a unit planet whose centre is `distance` away along -z: an annulus that faces the eye, its
    emission in a texture that knows where the sun is. Returns (mesh, emission picture)."""
    sink, radius = 1.0 / distance, math.sqrt(1.0 - 1.0 / distance ** 2)
    outer = 1.035

    def fn(u, v):
        a = u * math.tau
        r = radius * (0.995 + (outer - 0.995) * (1 - v))
        return stack(r * np.cos(a), r * np.sin(a), sink + 0 * a)
    m = sg.patch(fn, segments, rings)
    m.uv = np.stack([np.tile(np.linspace(0, 1, segments + 1), rings + 1), np.repeat(np.linspace(0.99, 0.01, rings + 1), segments + 1)], 1)
    m.n = np.tile([0.0, 0.0, 1.0], (len(m.p), 1))
    w, h = 512, 64
    a = (np.arange(w) + 0.5)[None] / w * math.tau
    depth = np.arange(h)[:, None] / (h - 1.0)                   # 0 inner, 1 outer
    lit = smooth(-0.55, 0.75, np.cos(a) * to_sun_local[0] + np.sin(a) * to_sun_local[1] + 0.25 * to_sun_local[2])
    fall = np.exp(-depth / 0.16) * smooth(1.0, 0.75, depth)
    tone = blend((0.16, 0.42, 1.0), (0.62, 0.82, 1.0), np.exp(-depth / 0.07) + 0 * a)
    dusk = np.exp(-((lit - 0.18) / 0.12) ** 2)
    tone = blend(tone, (1.0, 0.52, 0.24), 0.45 * dusk * np.exp(-depth / 0.2))
    return m, sg.to_srgb(tone * (fall * lit)[..., None])


# ---------------------------------------------------------------- stars

def star_map(w=3072, h=1536, band_normal=(0.55, -0.90, -0.24), rich=(-0.40, 0.10, -0.90), sun=None):
    """Stars, the milky way and a nebula in cd/m2; `rich` is where the band and the nebula are brightest."""
    small = w // 4
    theta = (np.arange(small // 2) + 0.5)[:, None] / (small // 2) * math.pi
    phi = (np.arange(small) + 0.5)[None] / small * math.tau
    d = stack(-np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi))
    axis, rich = sg.unit(np.array(band_normal)), sg.unit(np.array(rich))
    off = d @ axis
    toward = 0.5 + 0.5 * (d @ rich)
    noise = Lattice(810)
    cloud = noise.fbm(d * 4.0 + 3, 5, 0.55)
    dust = noise.fbm(d * 6.5 + 17, 5, 0.6)
    band = np.exp(-(off / (0.13 + 0.10 * toward)) ** 2) * (0.25 + 0.75 * toward ** 2)
    lane = smooth(0.46, 0.60, dust + 0.12 * np.exp(-(off / 0.07) ** 2))
    milky = (band * (0.35 + 0.9 * cloud) * (1 - 0.78 * lane * np.exp(-(off / 0.12) ** 2)))[..., None] * blend((0.60, 0.70, 1.0), (1.0, 0.80, 0.62), toward ** 3) * 330.0
    veil = noise.fbm(d * 2.3 + 29, 6, 0.58)
    patch = np.clip(d @ sg.unit(rich + 0.35 * axis), 0, 1) ** 7
    red = smooth(0.44, 0.72, veil) * patch
    teal = smooth(0.46, 0.74, noise.fbm(d * 3.1 + 41, 6, 0.58)) * np.clip(d @ sg.unit(rich - 0.30 * axis + np.array([0.25, 0.1, 0.0])), 0, 1) ** 9
    gas = red[..., None] * np.array((560.0, 110.0, 190.0)) + teal[..., None] * np.array((40.0, 230.0, 330.0)) + (red * teal)[..., None] * np.array((350.0, 380.0, 500.0))
    low = milky + gas * (1 - 0.5 * lane)[..., None] + np.array((7.0, 9.0, 15.0))
    out = np.stack([enlarge_map(low[..., k], w, h) for k in range(3)], -1)
    rng = np.random.Generator(np.random.PCG64(820))
    count = 15000
    v = sg.unit(rng.normal(size=(count, 3)))
    pull = rng.random(count) < 0.45                              # nearly half of them gather in the band
    v[pull] = sg.unit(v[pull] - axis * (v[pull] @ axis)[:, None] * (0.80 + 0.15 * rng.random((pull.sum(), 1))))
    power = 420.0 * (1.0 - rng.random(count)) ** -0.70
    warmth = rng.random(count)
    tint = blend((0.65, 0.78, 1.0), (1.0, 0.97, 0.92), smooth(0.0, 0.5, warmth))
    tint = blend(tint, (1.0, 0.66, 0.40), smooth(0.80, 1.0, warmth))
    x = (np.arctan2(-v[:, 0], v[:, 2]) / math.tau % 1.0) * w
    y = np.arccos(np.clip(v[:, 1], -1, 1)) / math.pi * h
    # one texel each: spread over more they would look like blobs
    np.add.at(out, (np.minimum(y.astype(int), h - 1), x.astype(int) % w), np.minimum(power, 26000.0)[:, None] * tint)
    if sun is not None:
        theta = (np.arange(h) + 0.5)[:, None] / h * math.pi
        phi = (np.arange(w) + 0.5)[None] / w * math.tau
        c = -np.sin(theta) * np.sin(phi) * sun[0] + np.cos(theta) * sun[1] + np.sin(theta) * np.cos(phi) * sun[2]
        a = np.arccos(np.clip(c, -1, 1))
        out += (60000.0 * smooth(0.0075, 0.0055, a) + 2600.0 * np.exp(-a / 0.012) + 260.0 * np.exp(-a / 0.06))[..., None] * np.array((1.0, 0.95, 0.88))
    return np.minimum(out, 62000.0)
