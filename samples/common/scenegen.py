"""Helpers shared by the scripts that write Burnish's sample and benchmark scenes.

What is here: tileable noise and texture maps, PNG and Radiance HDR files,
mesh pieces with tangents and metric UVs, glTF 2.0 assembly, and a self-check.
Python 3 and numpy only. The same script writes the same bytes on every run.

Conventions
  * metres, Y up, right handed; front faces are counter-clockwise.
  * a mesh is a Mesh: positions, normals, tangents (w = +1 or -1), UVs, indices and
    optional vertex colours. Texture v grows downwards, so the bitangent
    cross(N, T) * w points to smaller v, as glTF asks for.
  * textures: colour is authored linear and stored as sRGB; heights are in metres,
    so normal maps have true slopes; ORM packs occlusion, roughness, metallic.
  * environments: latitude-longitude RGBE in cd/m2, row 0 is +Y, column angle
    phi = 2 pi (x + 0.5) / width, direction (-sin phi, ., cos phi): the centre looks along -Z, +X is to its right.
"""
import argparse
import dataclasses
import json
import math
import os
import struct
import sys
import time
import zlib
from typing import Optional

import numpy as np

TAU = 2.0 * math.pi
FLOAT, U8, U16, U32 = 5126, 5121, 5123, 5125
COMPONENT_TYPES = {FLOAT: np.float32, U8: np.uint8, U16: np.uint16, U32: np.uint32}
COMPONENT_COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


# ---------------------------------------------------------------- files

def write_atomic(path, data):
    """Write bytes under a temporary name in the same folder, then rename."""
    os.makedirs(os.path.dirname(os.path.abspath(path)), exist_ok=True)
    part = "%s.part%d" % (path, os.getpid())
    try:
        with open(part, "wb") as f:
            f.write(data)
        os.replace(part, path)
    except BaseException:
        if os.path.exists(part):
            os.unlink(part)
        raise


def _png_filtered(a):
    """Rows filtered by Paeth's predictor, the best single choice for these maps."""
    a = a.astype(np.int16)
    left = np.zeros_like(a); left[:, 1:] = a[:, :-1]
    up = np.zeros_like(a); up[1:] = a[:-1]
    corner = np.zeros_like(a); corner[1:, 1:] = a[:-1, :-1]
    p = left + up - corner
    pa, pb, pc = np.abs(p - left), np.abs(p - up), np.abs(p - corner)
    guess = np.where((pa <= pb) & (pa <= pc), left, np.where(pb <= pc, up, corner))
    return ((a - guess) & 255).astype(np.uint8)


def png_bytes(a):
    """An 8-bit PNG from an array (h, w, 1|3|4) of uint8."""
    h, w, c = a.shape
    rows = _png_filtered(a).reshape(h, w * c)
    raw = np.concatenate([np.full((h, 1), 4, np.uint8), rows], 1).tobytes()

    def chunk(tag, data):
        body = tag + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    head = struct.pack(">IIBBBBB", w, h, 8, {1: 0, 3: 2, 4: 6}[c], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head)
            + chunk(b"IDAT", zlib.compress(raw, 6)) + chunk(b"IEND", b""))


def rgbe_encode(rgb):
    """Shared-exponent pixels (h, w, 4), rounded to nearest."""
    peak = np.maximum(rgb.max(-1), 1e-32)
    exponent = np.frexp(peak * (1.0 + 1.0 / 512.0))[1]
    mantissa = np.floor(np.ldexp(rgb, (8 - exponent)[..., None]) + 0.5)
    out = np.concatenate([np.clip(mantissa, 0, 255), (exponent + 128)[..., None]], -1)
    return out.astype(np.uint8)


def _rle_row(row):
    """One channel of one scanline in Radiance's run-length coding."""
    out, i, n = bytearray(), 0, len(row)
    literal = bytearray()

    def flush():
        for k in range(0, len(literal), 128):
            piece = literal[k:k + 128]
            out.append(len(piece)); out.extend(piece)
        literal.clear()

    while i < n:
        run = 1
        while run < 127 and i + run < n and row[i + run] == row[i]:
            run += 1
        if run >= 4:
            flush()
            out += bytes((128 + run, row[i]))
        else:
            literal.extend(row[i:i + run])
        i += run
    flush()
    return out


def hdr_bytes(rgb, packed=True):
    """A Radiance .hdr file of linear RGB, new-style run-length coded. packed=False spends no time on looking for runs, of
    which stars and other noise have none; the width must then be a multiple of 128."""
    h, w, _ = rgb.shape
    pixels = rgbe_encode(rgb)
    out = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (h, w))
    if not packed:
        rows = pixels.transpose(0, 2, 1).reshape(h, 4 * w // 128, 128)
        rows = np.concatenate([np.full((h, 4 * w // 128, 1), 128, np.uint8), rows], 2).reshape(h, -1)
        start = np.tile(np.array([2, 2, w >> 8, w & 255], np.uint8), (h, 1))
        return bytes(out) + np.concatenate([start, rows], 1).tobytes()
    for y in range(h):
        out += bytes((2, 2, w >> 8, w & 255))
        for c in range(4):
            out += _rle_row(pixels[y, :, c].tobytes())
    return bytes(out)


def sphere_directions(w, h):
    """The direction of every pixel of a latitude-longitude map."""
    theta = (np.arange(h) + 0.5)[:, None] / h * math.pi
    phi = (np.arange(w) + 0.5)[None] / w * TAU
    return stack(-np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi))


# ---------------------------------------------------------------- noise and maps

def stack(*parts):
    """Broadcast the parts and stack them along a new last axis."""
    return np.stack(np.broadcast_arrays(*[np.asarray(p, float) for p in parts]), -1)


def smooth(lo, hi, x):
    """Hermite step from 0 at lo to 1 at hi."""
    t = np.clip((x - lo) / (hi - lo), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def blend(a, b, t):
    """Colour a where t = 0, colour b where t = 1."""
    return np.asarray(a) * (1.0 - t[..., None]) + np.asarray(b) * t[..., None]


def unit(v):
    """v over its length; a zero vector stays zero."""
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-20)


class Noise:
    """Seeded noise over a square that repeats without seams."""

    def __init__(self, seed, size=512):
        self.rng = np.random.Generator(np.random.PCG64(seed))
        self.size = size
        self.y, self.x = np.mgrid[0:size, 0:size] / size

    def value(self, nx, ny=None, x=None, y=None):
        """Value noise on a lattice of nx by ny cells, in [0, 1]."""
        ny = ny or nx
        grid = self.rng.random((ny, nx))
        px = (self.x if x is None else x) * nx
        py = (self.y if y is None else y) * ny
        ix, iy = np.floor(px).astype(int), np.floor(py).astype(int)
        fx, fy = px - ix, py - iy
        fx, fy = fx * fx * (3 - 2 * fx), fy * fy * (3 - 2 * fy)
        x0, x1, y0, y1 = ix % nx, (ix + 1) % nx, iy % ny, (iy + 1) % ny
        top = grid[y0, x0] * (1 - fx) + grid[y0, x1] * fx
        low = grid[y1, x0] * (1 - fx) + grid[y1, x1] * fx
        return top * (1 - fy) + low * fy

    def fbm(self, nx, ny=None, octaves=5, gain=0.5, x=None, y=None):
        """Octaves of value noise, mean about 0.5, in [0, 1]."""
        ny = ny or nx
        total, amp, norm = 0.0, 1.0, 0.0
        for k in range(octaves):
            total = total + amp * self.value(nx << k, ny << k, x, y)
            norm += amp
            amp *= gain
        return total / norm

    def ridged(self, nx, octaves=4, x=None, y=None):
        """Thin bright lines, as of veins and cracks, in [0, 1]."""
        total, amp, norm = 0.0, 1.0, 0.0
        for k in range(octaves):
            total = total + amp * (1.0 - np.abs(2.0 * self.value(nx << k, None, x, y) - 1.0))
            norm += amp
            amp *= 0.5
        return total / norm

    def warped(self, n, amount):
        """Coordinates bent by noise: pass them as x and y."""
        return (self.x + amount * (self.fbm(n, None, 3) - 0.5),
                self.y + amount * (self.fbm(n, None, 3) - 0.5))

    def scratches(self, count, length=0.15, width=1.2, along=None):
        """Straight scratches, 1 on the line and 0 away from it."""
        out = np.zeros((self.size, self.size))
        for cx, cy, a, l, w in self.rng.random((count, 5)):
            angle = a * math.pi if along is None else along + (a - 0.5) * 0.5
            dx = (self.x - cx + 0.5) % 1.0 - 0.5
            dy = (self.y - cy + 0.5) % 1.0 - 0.5
            s = dx * math.cos(angle) + dy * math.sin(angle)
            d = -dx * math.sin(angle) + dy * math.cos(angle)
            reach = length * (0.3 + 0.7 * l)
            line = smooth(width * (0.5 + w) / self.size, 0.0, np.abs(d))
            out = np.maximum(out, line * smooth(reach, 0.6 * reach, np.abs(s)))
        return out


def blur(a, radius):
    """Two box blurs that wrap around."""
    for _ in range(2):
        for axis in (0, 1):
            a = sum(np.roll(a, k, axis) for k in range(-radius, radius + 1)) / (2 * radius + 1)
    return a


def cavity(height, depth, radius=6):
    """Occlusion from a height map: 1 on level ground, darker in hollows of that depth."""
    return np.clip(1.0 - np.maximum(blur(height, radius) - height, 0.0) / depth, 0.0, 1.0)


def normal_map(height, metres):
    """Tangent-space normals (h, w, 3) in [-1, 1] of heights over a square that wide."""
    scale = height.shape[0] / metres / 2.0
    dx = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * scale
    dy = (np.roll(height, -1, 0) - np.roll(height, 1, 0)) * scale
    return unit(stack(-dx, dy, 1.0))


def to_u8(a):
    """[0, 1] to 8 bits."""
    return np.floor(np.clip(a, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)


def to_srgb(linear):
    """Linear colour to 8-bit sRGB."""
    c = np.clip(linear, 0.0, 1.0)
    return to_u8(np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055))


@dataclasses.dataclass
class Surface:
    """One tileable material: linear albedo or F0, height in metres, and the ORM channels."""
    metres: float
    height: np.ndarray
    colour: Optional[np.ndarray]
    rough: np.ndarray
    metal: np.ndarray
    ao: np.ndarray

    def maps(self):
        """The 8-bit images by kind."""
        out = {"normal": to_u8(normal_map(self.height, self.metres) * 0.5 + 0.5),
               "orm": to_u8(stack(self.ao, self.rough, self.metal))}
        if self.colour is not None:
            out["base"] = to_srgb(self.colour)
        return out


# ---------------------------------------------------------------- meshes

@dataclasses.dataclass
class Mesh:
    """Triangles with everything glTF wants of a vertex."""
    p: np.ndarray
    n: np.ndarray
    t: np.ndarray
    uv: np.ndarray
    i: np.ndarray
    c: Optional[np.ndarray] = None

    def moved(self, x=0.0, y=0.0, z=0.0):
        """A copy shifted by (x, y, z)."""
        return dataclasses.replace(self, p=self.p + np.array([x, y, z], float))

    def turned(self, axis, degrees):
        """A copy rotated about an axis through the origin."""
        m = rotation_matrix(axis, degrees)
        t = np.concatenate([self.t[:, :3] @ m.T, self.t[:, 3:]], 1)
        return dataclasses.replace(self, p=self.p @ m.T, n=self.n @ m.T, t=t)

    def scaled(self, x, y=None, z=None):
        """A copy scaled by positive factors; normals and tangents follow."""
        s = np.array([x, y or x, z or x], float)
        n = unit(self.n / s)
        t = self.t[:, :3] * s
        t = unit(t - n * np.sum(t * n, -1, keepdims=True))
        return dataclasses.replace(self, p=self.p * s, n=n,
                                   t=np.concatenate([t, self.t[:, 3:]], 1))


def rotation_matrix(axis, degrees):
    """Rodrigues' formula."""
    x, y, z = unit(np.asarray(axis, float))
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = math.radians(degrees)
    return np.eye(3) + math.sin(a) * k + (1 - math.cos(a)) * (k @ k)


def merge(*meshes):
    """One mesh from several; vertex colours fill with white where one has none."""
    starts = np.cumsum([0] + [len(m.p) for m in meshes])
    join = lambda name: np.concatenate([getattr(m, name) for m in meshes])
    colour = None
    if any(m.c is not None for m in meshes):
        colour = np.concatenate([np.ones((len(m.p), 3)) if m.c is None else m.c for m in meshes])
    index = np.concatenate([m.i + s for m, s in zip(meshes, starts)])
    return Mesh(join("p"), join("n"), join("t"), join("uv"), index, colour)


def _grid_indices(nu, nv):
    a = (np.arange(nv)[:, None] * (nu + 1) + np.arange(nu)[None]).ravel()
    b, c, d = a + 1, a + nu + 1, a + nu + 2
    return np.stack([a, b, d, a, d, c], 1).reshape(-1, 3)


def _without_slivers(p, tri):
    area = np.linalg.norm(np.cross(p[tri[:, 1]] - p[tri[:, 0]], p[tri[:, 2]] - p[tri[:, 0]]), axis=1)
    return tri[area > 1e-10]


def patch(fn, nu, nv, repeat_u=1.0, repeat_v=1.0):
    """A parametric surface fn(u, v) -> (..., 3); du x dv is the outside."""
    u, v = np.meshgrid(np.linspace(0, 1, nu + 1), np.linspace(0, 1, nv + 1))
    e = 1e-4
    inner = np.clip(v, 2e-3, 1 - 2e-3)      # derivatives just off the poles
    du = fn(u + e, inner) - fn(u - e, inner)
    dv = fn(u, inner + e) - fn(u, inner - e)
    n = unit(np.cross(du, dv))
    t = unit(unit(du) - n * np.sum(unit(du) * n, -1, keepdims=True))
    p = fn(u, v).reshape(-1, 3)
    uv = stack(u * repeat_u, (1.0 - v) * repeat_v).reshape(-1, 2)
    t4 = np.concatenate([t.reshape(-1, 3), np.ones((len(p), 1))], 1)
    return Mesh(p, n.reshape(-1, 3), t4, uv, _without_slivers(p, _grid_indices(nu, nv)))


def plane(origin, right, up, metres, us=None, vs=None, keep=None):
    """A flat sheet: right x up is its front, one texture repeat per `metres`.

    us and vs are the grid lines in metres from the origin; keep(u, v) of cell centres
    leaves cells out. Texture coordinates are metric from the sheet's own origin."""
    right, up = np.asarray(right, float), np.asarray(up, float)
    lu, lv = np.linalg.norm(right), np.linalg.norm(up)
    us = np.array([0.0, lu]) if us is None else np.asarray(us, float)
    vs = np.array([0.0, lv]) if vs is None else np.asarray(vs, float)
    u, v = np.meshgrid(us, vs)
    p = (np.asarray(origin, float) + (u / lu)[..., None] * right + (v / lv)[..., None] * up).reshape(-1, 3)
    tri = _grid_indices(len(us) - 1, len(vs) - 1)
    if keep is not None:
        cu, cv = np.meshgrid((us[1:] + us[:-1]) / 2, (vs[1:] + vs[:-1]) / 2)
        tri = tri.reshape(-1, 2, 3)[keep(cu, cv).ravel()].reshape(-1, 3)
    used, tri = np.unique(tri, return_inverse=True)
    tri = tri.reshape(-1, 3)
    n = np.tile(unit(np.cross(right, up)), (len(used), 1))
    t = np.tile(np.append(right / lu, 1.0), (len(used), 1))
    uv = stack(u / metres, -v / metres).reshape(-1, 2)
    return Mesh(p[used], n, t, uv[used], tri)


def _flat(points, normals, tangent, uv):
    """A fan over a few points with their own normals; tangents are made orthogonal to them."""
    p, n = np.asarray(points, float), np.asarray(normals, float)
    t = np.tile(np.asarray(tangent, float), (len(p), 1))
    t = unit(t - n * np.sum(t * n, -1, keepdims=True))
    tri = np.array([[0, k, k + 1] for k in range(1, len(p) - 1)])
    t4 = np.concatenate([t, np.ones((len(p), 1))], 1)
    return Mesh(p, n, t4, np.asarray(uv, float), tri)


def _fan(points, normals, tangent, metres):
    """_flat with the points ordered to face outwards and planar, metric UVs."""
    p, n = np.asarray(points, float), np.asarray(normals, float)
    mean = unit(n.mean(0))
    if np.dot(np.cross(p[1] - p[0], p[2] - p[0]), mean) < 0:
        p, n = p[::-1], n[::-1]
    t = unit(np.asarray(tangent, float) - mean * np.dot(tangent, mean))
    b = np.cross(mean, t)
    return _flat(p, n, t, stack(p @ t, -(p @ b)) / metres)


def box(size, centre=(0, 0, 0), bevel=0.0, metres=1.0, grain=None):
    """A box with chamfers shaded round; `grain` (0, 1 or 2) is the axis texture u follows.

    Without grain every face has u along its longer side."""
    half = np.asarray(size, float) / 2
    bevel = min(bevel, 0.45 * 2 * half.min())
    eye, parts = np.eye(3), []
    core = half - bevel

    def corner(signs, axis):
        p = core * signs
        p[axis] = half[axis] * signs[axis]
        return p

    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        along = grain if grain in (a, b) else (a if half[a] >= half[b] else b)
        if grain is None and axis != 1 and abs(half[a] - half[b]) < 1e-9:
            along = a if a != 1 else b
        for s in (-1, 1):
            pts = []
            for sa, sb in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                signs = np.zeros(3); signs[axis], signs[a], signs[b] = s, sa, sb
                pts.append(corner(signs, axis))
            parts.append(_fan(pts, np.tile(eye[axis] * s, (4, 1)), eye[along], metres))
    if bevel > 0:
        parts += _box_edges(corner, eye, metres) + _box_corners(corner, eye, metres)
    return merge(*parts).moved(*centre)


def _box_edges(corner, eye, metres):
    out = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for sa in (-1, 1):
            for sb in (-1, 1):
                pts, nrm = [], []
                for face, s, order in ((a, sa, (-1, 1)), (b, sb, (1, -1))):
                    for e in order:
                        signs = np.zeros(3); signs[axis], signs[a], signs[b] = e, sa, sb
                        pts.append(corner(signs, face)); nrm.append(eye[face] * s)
                out.append(_fan(pts, nrm, eye[axis], metres))
    return out


def _box_corners(corner, eye, metres):
    out = []
    for k in range(8):
        signs = np.array([1.0 if k >> j & 1 else -1.0 for j in range(3)])
        pts = [corner(signs.copy(), j) for j in range(3)]
        out.append(_fan(pts, [eye[j] * signs[j] for j in range(3)], eye[k % 3] + 0.31 * eye[(k + 1) % 3], metres))
    return out


def spline(points, steps=6):
    """Catmull-Rom through the points (n, k), `steps` pieces a span."""
    p = np.asarray(points, float)
    q = np.concatenate([[2 * p[0] - p[1]], p, [2 * p[-1] - p[-2]]])
    t = (np.arange(steps) / steps)[:, None]
    out = []
    for a, b, c, d in zip(q[:-3], q[1:-2], q[2:-1], q[3:]):
        out.append(0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t ** 2
                          + (3 * b - a - 3 * c + d) * t ** 3))
    return np.concatenate(out + [p[-1:]])


def lathe(pieces, segments=32, metres=1.0):
    """A surface of revolution about Y. Each piece is (radius, y) points, smooth within, listed so
    that the outside is on the right of its direction of travel (upwards on an outer wall)."""
    widest = max(float(np.max(np.asarray(q)[:, 0])) for q in pieces)
    around = max(1, round(TAU * widest / metres))
    angle = np.linspace(0, TAU, segments + 1)
    s, c = np.sin(angle), np.cos(angle)
    out, offset = [], 0.0
    for piece in pieces:
        q = np.asarray(piece, float)
        step = np.linalg.norm(np.diff(q, axis=0), axis=1)
        arc = offset + np.concatenate([[0], np.cumsum(step)])
        offset = arc[-1]
        d = np.zeros_like(q); e = unit(np.diff(q, axis=0))
        d[:-1] += e; d[1:] += e
        d = unit(d)
        nr, ny = d[:, 1][:, None], -d[:, 0][:, None]
        p = stack(q[:, :1] * s, q[:, 1:] + 0 * s, q[:, :1] * c).reshape(-1, 3)
        n = stack(nr * s, ny + 0 * s, nr * c).reshape(-1, 3)
        t = stack(c + 0 * nr, 0.0 * s + 0 * nr, -s + 0 * nr, 1.0).reshape(-1, 4)
        uv = stack(angle / TAU * around + 0 * nr, -arc[:, None] / metres + 0 * s).reshape(-1, 2)
        tri = _without_slivers(p, _grid_indices(segments, len(q) - 1))
        out.append(Mesh(p, n, t, uv, tri))
    return merge(*out)


def sphere(radius, segments=24, rings=12, metres=1.0):
    """A ball about the origin."""
    a = np.linspace(-math.pi / 2, math.pi / 2, rings + 1)
    profile = radius * stack(np.cos(a), np.sin(a))
    profile[[0, -1], 0] = 0
    m = lathe([profile], segments, metres)
    return dataclasses.replace(m, n=unit(m.p))


def tube(path, radius, segments=12, metres=1.0, closed=False):
    """A round tube along points; frames are carried without twist. Ends stay open."""
    p = np.asarray(path, float)
    if closed:
        d = unit(np.roll(p, -1, 0) - np.roll(p, 1, 0))
    else:
        d = unit(np.gradient(p, axis=0))
    frame, side = [], np.cross(d[0], [0.0, 1.0, 0.0] if abs(d[0][1]) < 0.9 else [1.0, 0.0, 0.0])
    for k in range(len(p)):
        side = unit(side - d[k] * np.dot(side, d[k]))
        frame.append(side)
    side = np.array(frame)
    if closed:
        p, d, side = (np.concatenate([a, a[:1]]) for a in (p, d, side))
    up = np.cross(d, side)
    angle = np.linspace(0, TAU, segments + 1)[None, :, None]
    n = side[:, None] * np.cos(angle) - up[:, None] * np.sin(angle)
    around = -side[:, None] * np.sin(angle) - up[:, None] * np.cos(angle)
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
    if closed:
        arc *= max(1, round(arc[-1] / metres)) * metres / arc[-1]
    turns = max(1, round(TAU * radius / metres))
    along = np.broadcast_to(d[:, None], n.shape)
    uv = stack(arc[:, None] / metres, -np.linspace(0, turns, segments + 1)[None])
    v = (p[:, None] + radius * n).reshape(-1, 3)
    # u runs along the path and -v around it: n x along must be `around`
    flip = np.sign(np.sum(np.cross(n, along) * around, -1)).reshape(-1, 1)
    t = np.concatenate([along.reshape(-1, 3), flip], 1)
    tri = _grid_indices(segments, len(p) - 1)
    face = np.cross(v[tri[:, 1]] - v[tri[:, 0]], v[tri[:, 2]] - v[tri[:, 0]])
    if np.sum(face * n.reshape(-1, 3)[tri[:, 0]]) < 0:
        tri = tri[:, ::-1]
    return Mesh(v, n.reshape(-1, 3), t, uv.reshape(-1, 2), _without_slivers(v, tri))


def ring(radius, section, segments=48, metres=1.0):
    """A closed tube in the plane Y = 0."""
    a = np.linspace(0, TAU, segments, endpoint=False)
    return tube(radius * stack(np.sin(a), 0 * a, np.cos(a)), section, 10, metres, True)


# ---------------------------------------------------------------- glTF

def quaternion(axis, degrees):
    """A rotation as glTF stores it."""
    a = math.radians(degrees) / 2
    x, y, z = unit(np.asarray(axis, float)) * math.sin(a)
    return [x, y, z, math.cos(a)]


def quaternion_product(a, b):
    """The rotation b followed by a."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def aim(direction):
    """The rotation that turns -Z to a direction and keeps +Y as near up as it can."""
    f = unit(np.asarray(direction, float))
    hint = np.array([0.0, 1.0, 0.0]) if abs(f[1]) < 0.999 else np.array([1.0, 0.0, 0.0])
    r = unit(np.cross(f, hint))
    m = np.stack([r, np.cross(r, f), -f], 1)
    w = math.sqrt(max(0.0, 1 + m[0, 0] + m[1, 1] + m[2, 2])) / 2
    if w > 1e-3:
        q = [(m[2, 1] - m[1, 2]) / (4 * w), (m[0, 2] - m[2, 0]) / (4 * w), (m[1, 0] - m[0, 1]) / (4 * w), w]
    else:                                   # a half turn: any large axis will do
        x, y, z = (math.sqrt(max(0.0, 1 + 2 * m[k, k] - np.trace(m))) / 2 for k in range(3))
        q = [x, math.copysign(y, m[0, 1]), math.copysign(z, m[0, 2]), 0.0]
    return list(unit(np.array(q)))


def _tidy(x):
    """Floats shortened so that the text does not hang on the last bit."""
    if isinstance(x, (float, np.floating)):
        v = round(float(x), 6) + 0.0
        return int(v) if v == int(v) and abs(v) < 1e9 else v
    if isinstance(x, dict):
        return {k: _tidy(v) for k, v in x.items()}
    if isinstance(x, (list, tuple, np.ndarray)):
        return [_tidy(v) for v in x]
    return int(x) if isinstance(x, np.integer) else x


class Gltf:
    """Collects a scene; save() writes NAME.gltf, NAME.bin and the textures."""

    def __init__(self, generator):
        self.generator = generator
        self.blob = bytearray()
        self.views, self.accessors, self.meshes, self.materials = [], [], [], []
        self.images, self.textures, self.nodes, self.cameras, self.lights = [], [], [], [], []
        self.files, self.used, self.triangles, self._attributes = {}, set(), {}, {}
        self.animations = {}

    # -- textures and materials
    def texture(self, name, image, clamp=False):
        """Add an image as textures/NAME.png; returns the texture's index. clamp: it ends at its edges, else it repeats."""
        uri = "textures/%s.png" % name
        self.files[uri] = png_bytes(image)
        self.images.append({"name": name, "uri": uri, "mimeType": "image/png"})
        self.textures.append({"name": name, "source": len(self.images) - 1, "sampler": int(clamp)})
        return len(self.textures) - 1

    def surface(self, name, surf):
        """Add a Surface's maps; returns texture indices by kind."""
        return {kind: self.texture("%s_%s" % (name, kind), image) for kind, image in surf.maps().items()}

    def material(self, name, maps=None, base=(1, 1, 1), rough=1.0, metal=None, emit=None, nits=0.0, two_sided=False, substance=None):
        """Add a material; with maps, factors multiply them. substance: a name of the engine's library."""
        maps = maps or {}
        pbr = {"baseColorFactor": list(base) + [1.0], "roughnessFactor": rough,
               "metallicFactor": (1.0 if maps else 0.0) if metal is None else metal}
        out = {"name": name, "pbrMetallicRoughness": pbr}
        if "base" in maps:
            pbr["baseColorTexture"] = {"index": maps["base"]}
        if "orm" in maps:
            pbr["metallicRoughnessTexture"] = {"index": maps["orm"]}
            out["occlusionTexture"] = {"index": maps["orm"]}
        if "normal" in maps:
            out["normalTexture"] = {"index": maps["normal"]}
        if emit is not None:
            out["emissiveFactor"] = list(emit)
            out["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": nits}}
            self.used.add("KHR_materials_emissive_strength")
        if "emit" in maps:
            out["emissiveTexture"] = {"index": maps["emit"]}
        if two_sided:
            out["doubleSided"] = True
        if substance:
            out["extras"] = {"burnish": {"substance": substance}}
        self.materials.append(out)
        return len(self.materials) - 1

    # -- geometry
    def _accessor(self, a, component, kind, target, bounds=False):
        self.blob += bytes(-len(self.blob) % 4)
        a = np.ascontiguousarray(a, COMPONENT_TYPES[component])
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": a.nbytes})
        if target is not None:
            self.views[-1]["target"] = target
        self.blob += a.tobytes()
        out = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(a), "type": kind}
        if component == U8:
            out["normalized"] = True
        if bounds:
            out["min"], out["max"] = [float(x) for x in a.min(0)], [float(x) for x in a.max(0)]
        self.accessors.append(out)
        return len(self.accessors) - 1

    def _primitive(self, m):
        """Accessors of a Mesh; the same object used twice is stored once."""
        if id(m) in self._attributes:
            return self._attributes[id(m)][1]
        # rounded, so that a library's last bit does not change the file
        names = [("POSITION", m.p, "VEC3"), ("NORMAL", m.n, "VEC3"), ("TANGENT", m.t, "VEC4"), ("TEXCOORD_0", m.uv, "VEC2")]
        attributes = {k: self._accessor(np.round(a, 6), FLOAT, kind, 34962, k == "POSITION") for k, a, kind in names}
        if m.c is not None:
            rgba = to_u8(np.concatenate([m.c, np.ones((len(m.c), 1))], 1))
            attributes["COLOR_0"] = self._accessor(rgba, U8, "VEC4", 34962)
        index = m.i.reshape(-1)
        component = U16 if len(m.p) < 65535 else U32
        out = {"attributes": attributes, "indices": self._accessor(index, component, "SCALAR", 34963)}
        self._attributes[id(m)] = (m, out)
        return out

    def mesh(self, name, *parts):
        """Add a mesh of (Mesh, material) primitives; returns its index."""
        primitives = []
        for m, material in parts:
            primitives.append(dict(self._primitive(m), material=material))
        self.meshes.append({"name": name, "primitives": primitives})
        self.triangles[len(self.meshes) - 1] = sum(len(m.i) for m, _ in parts)
        return len(self.meshes) - 1

    # -- nodes
    def node(self, name, at=(0, 0, 0), turn=None, scale=None, parent=None, **rest):
        """Add a node to the scene, or under a parent; turn is degrees about Y or a quaternion."""
        out = {"name": name, "translation": list(at)}
        if turn is not None:
            out["rotation"] = quaternion((0, 1, 0), turn) if np.isscalar(turn) else list(turn)
        if scale is not None:
            out["scale"] = [scale] * 3 if np.isscalar(scale) else list(scale)
        out.update(rest)
        self.nodes.append(out)
        if parent is not None:
            self.nodes[parent].setdefault("children", []).append(len(self.nodes) - 1)
        return len(self.nodes) - 1

    def camera(self, name, eye, target, fov, near=0.05, far=200.0, parent=None):
        """Add a perspective camera with a vertical field of view in degrees; far None: infinite."""
        self.cameras.append({"name": name, "type": "perspective",
                             "perspective": {"yfov": math.radians(fov), "znear": near}})
        if far is not None:
            self.cameras[-1]["perspective"]["zfar"] = far
        self.node(name, eye, aim(np.subtract(target, eye)), parent=parent, camera=len(self.cameras) - 1)

    def light(self, name, kind, at=(0, 0, 0), toward=None, colour=(1, 1, 1), intensity=1.0, reach=None, cone=None, shadow=False, parent=None,
              stand_in=False):
        """Add a punctual light; cone is (inner, outer) half angles in degrees; shadow: it asks to cast shadows; stand_in: it stands for light that probes bring."""
        out = {"name": name, "type": kind, "color": list(colour), "intensity": intensity}
        if reach:
            out["range"] = reach
        if cone:
            out["spot"] = {"innerConeAngle": math.radians(cone[0]), "outerConeAngle": math.radians(cone[1])}
        ours = {"shadow": True} if shadow else {}
        if stand_in:
            ours["standIn"] = True
        if ours:
            out["extras"] = {"burnish": ours}
        self.lights.append(out)
        self.used.add("KHR_lights_punctual")
        turn = None if toward is None else aim(toward)
        self.node(name, at, turn, parent=parent, extensions={"KHR_lights_punctual": {"light": len(self.lights) - 1}})

    def animate(self, name, node, path, times, values):
        """Add a linear channel to the animation of that name; path is translation, rotation or scale."""
        keys = np.asarray(times, float).reshape(-1, 1)
        out = self.animations.setdefault(name, {"name": name, "channels": [], "samplers": []})
        out["samplers"].append({"input": self._accessor(keys, FLOAT, "SCALAR", None, True), "interpolation": "LINEAR",
                                "output": self._accessor(np.round(values, 6), FLOAT, "VEC4" if path == "rotation" else "VEC3", None)})
        out["channels"].append({"sampler": len(out["samplers"]) - 1, "target": {"node": node, "path": path}})

    def spin(self, name, node, axis, seconds, turns=1, start=(0, 0, 0, 1)):
        """A steady rotation about a local axis that comes round after `seconds`, from the rest rotation on."""
        steps = np.arange(4 * abs(turns) + 1)
        values = [quaternion_product(start, quaternion(axis, 90.0 * k * np.sign(turns))) for k in steps]
        self.animate(name, node, "rotation", steps * seconds / steps[-1], values)

    # -- output
    def document(self, bin_uri, extras):
        """The glTF document as a dictionary."""
        out = {"asset": {"version": "2.0", "generator": self.generator}}
        if self.used:
            out["extensionsUsed"] = sorted(self.used)
        if self.lights:
            out["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        children = {c for n in self.nodes for c in n.get("children", ())}
        scene = {"name": "scene", "nodes": [k for k in range(len(self.nodes)) if k not in children]}
        if extras:
            scene["extras"] = {"burnish": extras}
        out.update(scene=0, scenes=[scene], nodes=self.nodes)
        if self.cameras:
            out["cameras"] = self.cameras
        out.update(meshes=self.meshes, materials=self.materials)
        if self.textures:
            wraps = (10497, 33071)[:1 + max(t["sampler"] for t in self.textures)]
            out["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": w, "wrapT": w} for w in wraps]
            out.update(textures=self.textures, images=self.images)
        if self.animations:
            out["animations"] = list(self.animations.values())
        out.update(bufferViews=self.views, buffers=[{"uri": bin_uri, "byteLength": len(self.blob)}])
        out = _tidy(out)
        out["accessors"] = self.accessors       # bounds must be the exact floats
        return out

    def save(self, folder, name, bin_name=None, extras=None, shared=True):
        """Write the scene; shared=False leaves out the bin and textures (written before)."""
        bin_name = bin_name or name + ".bin"
        if shared:
            write_atomic(os.path.join(folder, bin_name), bytes(self.blob))
            for uri, data in self.files.items():
                write_atomic(os.path.join(folder, uri), data)
        text = json.dumps(self.document(bin_name, extras), separators=(",", ":")) + "\n"
        write_atomic(os.path.join(folder, name + ".gltf"), text.encode())

    def summary(self):
        """Counts over the nodes that draw."""
        drawn = [n["mesh"] for n in self.nodes if "mesh" in n]
        return {"triangles": sum(self.triangles[m] for m in drawn),
                "draws": sum(len(self.meshes[m]["primitives"]) for m in drawn),
                "nodes": len(self.nodes), "meshes": len(self.meshes), "materials": len(self.materials),
                "textures": len(self.textures), "lights": len(self.lights), "animated": sum(len(a["channels"]) for a in self.animations.values()), "cameras": len(self.cameras),
                "bin_bytes": len(self.blob), "texture_bytes": sum(map(len, self.files.values()))}


# ---------------------------------------------------------------- self-check

def _load_accessor(doc, data, index):
    a = doc["accessors"][index]
    view = doc["bufferViews"][a["bufferView"]]
    kind, count = COMPONENT_TYPES[a["componentType"]], COMPONENT_COUNTS[a["type"]]
    size = a["count"] * count * np.dtype(kind).itemsize
    if size > view["byteLength"] or view["byteOffset"] + view["byteLength"] > len(data):
        raise ValueError("accessor %d reaches past its buffer view" % index)
    if view["byteOffset"] % np.dtype(kind).itemsize:
        raise ValueError("accessor %d is not aligned" % index)
    return np.frombuffer(data, kind, a["count"] * count, view["byteOffset"]).reshape(a["count"], count)


def _check_vertices(p, n, t, bounds):
    if not all(np.isfinite(a).all() for a in (p, n, t)):
        yield "a value is not finite"
    if not (np.array_equal(p.min(0), np.float32(bounds[0])) and np.array_equal(p.max(0), np.float32(bounds[1]))):
        yield "min/max do not match the positions"
    if np.abs(np.linalg.norm(n, axis=1) - 1).max() > 1e-4:
        yield "a normal is not a unit vector"
    if np.abs(np.linalg.norm(t[:, :3], axis=1) - 1).max() > 1e-4:
        yield "a tangent is not a unit vector"
    if not np.isin(t[:, 3], (-1.0, 1.0)).all():
        yield "a tangent's handedness is neither 1 nor -1"
    if np.abs(np.sum(t[:, :3] * n, 1)).max() > 2e-3:
        yield "a tangent is not orthogonal to its normal"


def _check_faces(p, n, t, uv, tri):
    p, n, t, uv = (a.astype(float) for a in (p, n, t, uv))
    e1, e2 = p[tri[:, 1]] - p[tri[:, 0]], p[tri[:, 2]] - p[tri[:, 0]]
    face = np.cross(e1, e2)
    area = np.linalg.norm(face, axis=1)
    if area.min() < 1e-12:
        yield "%d triangles have no area" % np.sum(area < 1e-12)
    mean = n[tri].sum(1)
    against = np.sum(face * mean, 1) < 0
    if against.any():
        yield "%d of %d triangles face away from their normals" % (against.sum(), len(tri))
    d1, d2 = uv[tri[:, 1]] - uv[tri[:, 0]], uv[tri[:, 2]] - uv[tri[:, 0]]
    det = d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]
    good = np.abs(det) > 1e-12
    if good.mean() < 0.98:
        yield "%.1f %% of the triangles have no UV area" % (100 - 100 * good.mean())
    inv = np.sign(det)[:, None]
    pu, pv = (e1 * d2[:, 1:] - e2 * d1[:, 1:]) * inv, (e2 * d1[:, :1] - e1 * d2[:, :1]) * inv
    bit = np.cross(n, t[:, :3]) * t[:, 3:]
    wrong = good & ((np.sum(t[tri, :3].sum(1) * pu, 1) < 0) | (np.sum(bit[tri].sum(1) * pv, 1) > 0))
    if wrong.mean() > 0.002:
        yield "%d of %d triangles have tangents against their UVs" % (wrong.sum(), len(tri))


def check_file(path):
    """Every fault found in a .gltf written by Gltf, as lines of text."""
    folder = os.path.dirname(os.path.abspath(path))
    with open(path) as f:
        doc = json.load(f)
    with open(os.path.join(folder, doc["buffers"][0]["uri"]), "rb") as f:
        data = f.read()
    faults, seen = [], set()
    if len(data) != doc["buffers"][0]["byteLength"]:
        faults.append("buffer: length differs from byteLength")
    for image in doc.get("images", []):
        if not os.path.exists(os.path.join(folder, image["uri"])):
            faults.append("image %s is missing" % image["uri"])
    for m in doc["meshes"]:
        for k, prim in enumerate(m["primitives"]):
            key = prim["indices"]
            if key in seen:
                continue
            seen.add(key)
            faults += ["%s[%d]: %s" % (m["name"], k, s) for s in _check_primitive(doc, data, prim)]
    for node in doc["nodes"]:
        if "rotation" in node and abs(np.linalg.norm(node["rotation"]) - 1) > 1e-4:
            faults.append("node %s: rotation is not a unit quaternion" % node["name"])
    return faults


def _check_primitive(doc, data, prim):
    att = prim["attributes"]
    p, n, t, uv = (_load_accessor(doc, data, att[k]) for k in ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"))
    index = _load_accessor(doc, data, prim["indices"]).astype(np.int64).ravel()
    if not len(p) == len(n) == len(t) == len(uv):
        return ["attribute counts differ"]
    if len(index) % 3 or index.max() >= len(p):
        return ["indices out of range or not triangles"]
    if prim["material"] >= len(doc["materials"]):
        return ["no such material"]
    acc = doc["accessors"][att["POSITION"]]
    return list(_check_vertices(p, n, t, (acc["min"], acc["max"]))) + list(_check_faces(p, n, t, uv, index.reshape(-1, 3)))


# ---------------------------------------------------------------- command line

def run(description, build, default_folder):
    """The command line the scripts share: build(folder) -> (.gltf paths, summary)."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", metavar="DIR", default=default_folder, help="output folder (default: %(default)s)")
    parser.add_argument("--check", action="store_true", help="read the files back and verify them")
    args = parser.parse_args()
    start = time.monotonic()
    paths, summary = build(args.output)
    print(" ".join("%s=%s" % kv for kv in summary.items()))
    print("wrote %s in %.1f s" % (args.output, time.monotonic() - start))
    faults = []
    if args.check:
        for path in paths:
            found = check_file(path)
            faults += found
            print("check %s: %s" % (os.path.basename(path), "ok" if not found else "%d faults" % len(found)))
            for line in found:
                print("  " + line)
    return 1 if faults else 0
