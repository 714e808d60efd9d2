"""Flat-shaded convex pieces and vertex colours, shared by the scripts that build things out of simple solids.

Forward is +z, up is +y, things stand on y = 0. Colours are given as sRGB hex and kept linear in the vertices."""
import dataclasses
import math

import numpy as np

import scenegen as sg


def colour(text):
    """'#rrggbb' in sRGB to linear."""
    c = np.array([int(text[k:k + 2], 16) for k in (1, 3, 5)]) / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def tint(mesh, text):
    """The mesh in one colour."""
    return dataclasses.replace(mesh, c=np.tile(colour(text), (len(mesh.p), 1)))


def solid(rings, metres=2.0, caps=(True, True)):
    """A convex body, flat shaded, through rings of as many points each."""
    rings = [np.asarray(r, float) for r in rings]
    middle = np.concatenate(rings).mean(0)
    parts = []

    def face(points):
        kept = [p for k, p in enumerate(points) if np.linalg.norm(p - points[k - 1]) > 1e-6]
        if len(kept) < 3:
            return
        kept = np.array(kept)
        n = sum(np.cross(kept[k] - kept[0], kept[k + 1] - kept[0]) for k in range(1, len(kept) - 1))
        if np.linalg.norm(n) < 1e-9:
            return
        n = sg.unit(n)
        if np.dot(n, kept.mean(0) - middle) < 0:
            n = -n
        # u runs level, so that bricks and boards lie level too
        level = np.cross([0.0, 1.0, 0.0], n)
        along = level if np.linalg.norm(level) > 0.05 else kept[1] - kept[0]
        parts.append(sg._fan(kept, np.tile(n, (len(kept), 1)), sg.unit(along), metres))

    for a, b in zip(rings[:-1], rings[1:]):
        for k in range(len(a)):
            j = (k + 1) % len(a)
            face([a[k], a[j], b[j], b[k]])
    for wanted, ring in zip(caps, (rings[0], rings[-1])):
        if wanted:
            face(list(ring))
    return sg.merge(*parts)


def rectangle(width, depth, y, x=0.0, z=0.0):
    """A level ring of four points."""
    w, d = width / 2, depth / 2
    return [(x - w, y, z - d), (x + w, y, z - d), (x + w, y, z + d), (x - w, y, z + d)]


def retangent(mesh):
    """Tangents that follow new texture coordinates, of a mesh whose faces share no vertices."""
    a, b, c = (mesh.i[:, k] for k in range(3))
    e1, e2 = mesh.p[b] - mesh.p[a], mesh.p[c] - mesh.p[a]
    (u1, v1), (u2, v2) = (mesh.uv[b] - mesh.uv[a]).T, (mesh.uv[c] - mesh.uv[a]).T
    side = np.sign(u1 * v2 - u2 * v1)
    for corner in (a, b, c):
        n = mesh.n[corner]
        t = (e1 * v2[:, None] - e2 * v1[:, None]) * side[:, None]
        t = sg.unit(t - n * np.sum(t * n, -1, keepdims=True))
        # v grows downwards: a counter-clockwise face whose u and v turn clockwise is not mirrored
        mesh.t[corner] = np.concatenate([t, -side[:, None]], 1)
    return mesh


def block(size, at=(0, 0, 0), taper=1.0, metres=2.0):
    """A box that stands on its foot point `at`; taper scales its top."""
    w, h, d = size
    m = solid([rectangle(w, d, 0), rectangle(w * taper, d * taper, h)], metres)
    return m.moved(*at)


def polygon(sides, radius, y, phase=0.0):
    """A level regular ring."""
    a = math.tau * (np.arange(sides) + phase) / sides
    return sg.stack(radius * np.sin(a), y + 0 * a, radius * np.cos(a))


def drum(sides, lower, upper, height, at=(0, 0, 0), phase=0.5, metres=2.0):
    """A faceted cylinder or cone standing on `at`."""
    return solid([polygon(sides, lower, 0, phase), polygon(sides, upper, height, phase)], metres).moved(*at)


def profile(points, width, metres=2.0):
    """A convex (z, y) outline drawn out along x."""
    side = lambda x: [(x, y, z) for z, y in points]
    return solid([side(-width / 2), side(width / 2)], metres)


def outline(points, length, metres=2.0):
    """A convex (x, y) outline drawn out along z."""
    end = lambda z: [(x, y, z) for x, y in points]
    return solid([end(-length / 2), end(length / 2)], metres)


def pipe(a, b, radius, segments=6):
    """A straight round bar from a to b, with a cap at b."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    return sg.merge(sg.tube([a, b], radius, segments), cap(b, b - a, radius, segments))


def cap(at, towards, radius, segments):
    """A flat disc that faces along `towards`."""
    disc = sg.lathe([[(radius, 0.0), (0.0, 0.0)]], segments)
    t = sg.unit(np.asarray(towards, float))
    axis = np.cross([0.0, 1.0, 0.0], t)
    if np.linalg.norm(axis) < 1e-6:
        return (disc if t[1] > 0 else disc.turned((1, 0, 0), 180)).moved(*at)
    return disc.turned(axis, math.degrees(math.acos(np.clip(t[1], -1, 1)))).moved(*at)


def wheel(radius, width, x, y, z, segments=9):
    """A wheel on its axle along x, its outer side towards larger |x|."""
    m = sg.lathe([[(radius, 0.0), (radius, width)], [(radius, width), (0.0, 0.8 * width)]], segments)
    return m.turned((0, 0, 1), -90 if x > 0 else 90).moved(x, y, z)


def ball(radius, at=(0, 0, 0), segments=9, rings=6):
    """A smooth low-polygon ball."""
    return sg.sphere(radius, segments, rings).moved(*at)


def coloured(*pairs):
    """One mesh from (mesh, colour) pairs."""
    return sg.merge(*[tint(m, c) for m, c in pairs])
