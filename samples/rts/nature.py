"""Trees, rocks, crystals, lamps and fires of the rts sample. Every function returns {material: mesh}."""
import numpy as np

import scenegen as sg
from shapes import DARK, STEEL, STONE, WOOD, WOOD_PALE, ball, block, colour, coloured, drum, grounded, pipe, polygon, retangent, solid, tint


def shaded_crown(mesh, low, high, y0, y1):
    """Leaf colours from below to above, and lighter where the surface looks up."""
    t = sg.smooth(y0, y1, mesh.p[:, 1]) * 0.7 + 0.3 * (0.5 + 0.5 * mesh.n[:, 1])
    mesh.c = sg.blend(colour(low), colour(high), t)
    return mesh


def pine(low="#1f5b3a", high="#5fae4f"):
    """A fir 8 m tall: a trunk and four skirts of branches."""
    parts = [tint(drum(6, 0.34, 0.22, 1.8), WOOD)]
    for k, (y, r, h) in enumerate(((1.1, 2.3, 2.7), (2.7, 1.9, 2.5), (4.2, 1.42, 2.3), (5.6, 0.92, 2.4))):
        skirt = sg.lathe([[(0.0, 0.35), (r, 0.0)], [(r, 0.0), (0.55 * r, 0.42 * h), (0.0, h)]], 9).turned((0, 1, 0), 23 * k).moved(0, y, 0)
        parts.append(shaded_crown(skirt, low, high, y - 0.4, y + 0.9 * h))
    return {"flat": grounded(sg.merge(*parts), 1.2, 0.35, 0.55)}


def leaf_tree(low="#2d6a2c", high="#9ccb3f", seed=1):
    """A broad tree 7 m tall: a bent trunk and a few round masses of leaves."""
    rng = np.random.Generator(np.random.PCG64(seed))
    trunk = sg.tube(sg.spline([(0, 0, 0), (0.12, 1.4, 0.05), (0.0, 2.6, 0.0), (0.1, 3.6, 0.1)], 2), 0.3, 6)
    parts = [tint(trunk, WOOD)]
    for (x, y, z), r in (((0, 4.9, 0), 2.05), ((1.35, 3.9, 0.6), 1.4), ((-1.25, 4.1, 0.7), 1.45), ((0.1, 3.8, -1.35), 1.4)):
        blob = sg.sphere(r, 9, 6).scaled(1, 0.86, 1).turned((0, 1, 0), 360 * rng.random()).moved(x, y, z)
        parts.append(shaded_crown(blob, low, high, 2.6, 6.4))
    return {"flat": grounded(sg.merge(*parts), 1.2, 0.35, 0.4)}


def bush():
    """Two rounds of leaves on the ground."""
    parts = [shaded_crown(sg.sphere(r, 8, 5).scaled(1, 0.75, 1).moved(x, 0.4, z), "#2c6b33", "#86bf45", 0.0, 1.2) for x, z, r in ((0, 0, 0.95), (0.8, 0.3, 0.7))]
    return {"flat": grounded(sg.merge(*parts), 0.5, 0.5)}


def tuft(dark="#3c7a2c", pale="#a8cf4c"):
    """Five blades of grass, each a thin pyramid."""
    parts = []
    for k in range(5):
        a = 2.4 * k
        lean = np.array([0.28 * np.sin(a), 0.75 + 0.1 * (k % 3), 0.28 * np.cos(a)])
        foot = polygon(3, 0.075, 0.0) + np.array([0.12 * np.sin(a), 0, 0.12 * np.cos(a)])
        blade = solid([foot, np.tile(foot.mean(0) + lean, (3, 1))], 1.0, (False, False))
        blade.c = sg.blend(colour(dark), colour(pale), sg.smooth(0.0, 0.7, blade.p[:, 1]))
        parts.append(blade)
    return {"flat": sg.merge(*parts)}


def facets(seed, squash=(1.0, 0.75, 1.0), rough=0.28):
    """A flat-shaded boulder of radius about 1: a dented ball with its own facets."""
    rng = np.random.Generator(np.random.PCG64(seed))
    m = sg.sphere(1.0, 8, 6)
    bumps = sg.unit(rng.normal(size=(7, 3)))
    lift = 1.0 + sum(rough * (rng.random() - 0.45) * np.exp(-3.0 * (1 - m.p @ b)) for b in bumps)
    p = np.round(m.p * lift[:, None] * np.array(squash), 6)
    parts = []
    for tri in p[m.i]:
        n = np.cross(tri[1] - tri[0], tri[2] - tri[0])
        if np.linalg.norm(n) > 1e-6:
            n = sg.unit(n)
            along = np.cross([0.0, 1.0, 0.0], n)
            along = along if np.linalg.norm(along) > 0.05 else np.array([1.0, 0.0, 0.0])
            parts.append(sg._fan(tri, np.tile(n, (3, 1)), sg.unit(along), 2.0))
    return sg.merge(*parts)


def rock(seed, pale="#a39b93"):
    """A boulder about 1.5 m across, sunk a little."""
    m = tint(facets(seed, (1.05, 0.8, 0.95)), pale).moved(0, 0.45, 0)
    m.c = m.c * (0.78 + 0.3 * np.clip(m.n[:, 1:2], -0.3, 1))
    return {"flat": grounded(m, 0.5, 0.5)}


def crystal(seed, tone):
    """A cluster of glowing spikes on a rock: the resource that the factions fight over."""
    rng = np.random.Generator(np.random.PCG64(seed))
    foot = tint(facets(seed + 90, (1.3, 0.4, 1.2)), "#4a4458")
    spikes = []
    for k in range(5):
        a, lean, h, r = 2.5 * k + rng.random(), 0.5 * (k > 0) * (0.5 + rng.random()), 2.4 - 0.3 * k + 0.4 * rng.random(), 0.42 - 0.045 * k
        spike = solid([polygon(5, 0.7 * r, -0.2), polygon(5, r, 0.62 * h), np.tile([0.0, h, 0.0], (5, 1))], 2.0, (False, False))
        axis = (np.cos(a), 0.0, -np.sin(a))
        spikes.append(spike.turned(axis, 48 * lean).moved(0.45 * np.sin(a) * (k > 0), 0.15, 0.45 * np.cos(a) * (k > 0)))
    return {"flat": grounded(foot, 0.3, 0.4), "crystal_" + tone: sg.merge(*spikes)}


def lamp_post(style):
    """A street lamp 3.4 m tall: a steel arm, or a wooden post with a lantern."""
    if style == "blue":
        post = coloured((drum(6, 0.28, 0.2, 0.3), DARK), (pipe((0, 0.2, 0), (0, 3.3, 0), 0.09, 6), STEEL), (block((0.2, 0.12, 1.1), (0, 3.25, 0.42)), STEEL))
        return {"flat": grounded(post), "glow_cool": block((0.3, 0.12, 0.55), (0, 3.12, 0.68))}
    post = coloured((block((0.26, 3.3, 0.26), (0, 0, 0), 0.8), WOOD), (block((0.16, 0.16, 0.95), (0, 2.95, 0.35)), WOOD_PALE),
                    (drum(4, 0.36, 0.05, 0.25, (0, 2.82, 0.68)), DARK))
    return {"flat": grounded(post), "glow_warm": block((0.34, 0.42, 0.34), (0, 2.4, 0.68), 0.85)}


def brazier():
    """An iron bowl on three legs with a flame."""
    bowl = [(drum(8, 0.35, 0.62, 0.4, (0, 0.95, 0)), DARK)]
    for k in range(3):
        a = 2.0944 * k
        bowl.append((pipe((0.55 * np.sin(a), 0, 0.55 * np.cos(a)), (0.28 * np.sin(a), 1.05, 0.28 * np.cos(a)), 0.07, 5), DARK))
    return {"flat": grounded(coloured(*bowl)), "fire": flame(0.42, 1.1).moved(0, 1.25, 0)}


def flame(radius, height):
    """A faceted tongue of fire standing on y = 0."""
    main = solid([polygon(6, 0.5 * radius, 0), polygon(6, radius, 0.3 * height), np.tile([0.06, height, 0.0], (6, 1))], 1.0, (False, False))
    side = solid([polygon(5, 0.3 * radius, 0), polygon(5, 0.5 * radius, 0.2 * height), np.tile([0.1, 0.62 * height, 0.05], (5, 1))], 1.0, (False, False))
    return burning(sg.merge(main, side.moved(0.55 * radius, 0, 0.3 * radius), side.turned((0, 1, 0), 140).moved(-0.45 * radius, 0, -0.3 * radius)), 0.0, height)


def burning(mesh, low, high):
    """Texture coordinates for the fire's emission, which runs from yellow at `low` to red at `high`."""
    x, y, z = mesh.p.T
    mesh.uv = np.stack([0.5 + 0.10 * x + 0.07 * z, 0.98 - 0.96 * (y - low) / (high - low) + 0.010 * x - 0.013 * z], 1)
    return retangent(mesh)


def fire_glow():
    """The emission that `burning` looks into, its top row the tip of a flame."""
    v = np.linspace(0.0, 1.0, 64)
    tone = sg.blend(sg.blend((0.55, 0.02, 0.0), (1.0, 0.16, 0.006), sg.smooth(0.0, 0.5, v)), (1.0, 0.62, 0.12), sg.smooth(0.55, 1.0, v))
    return sg.to_srgb(np.repeat(tone[:, None], 8, 1))


def campfire():
    """Logs in a ring of stones, burning."""
    parts = []
    for k in range(7):
        a = 0.8976 * k
        parts.append((block((0.4, 0.28, 0.34), (0.85 * np.sin(a), 0, 0.85 * np.cos(a)), 0.75), STONE))
    for k in range(4):
        a = 1.5708 * k + 0.4
        parts.append((pipe((0.7 * np.sin(a), 0.1, 0.7 * np.cos(a)), (0, 0.55, 0), 0.1, 5), WOOD))
    return {"flat": grounded(coloured(*parts), 0.25, 0.5), "fire": flame(0.4, 1.25).moved(0, 0.2, 0)}


def crate():
    """A braced crate, 1.1 m."""
    h = 1.1
    parts = [(block((h - 0.12, h - 0.12, h - 0.12), (0, 0.06, 0)), WOOD_PALE)]
    for x in (-1, 1):
        for z in (-1, 1):
            parts.append((block((0.18, h, 0.18), (x * (h / 2 - 0.09), 0, z * (h / 2 - 0.09))), WOOD))
    for y in (0.0, h - 0.16):
        for s in (-1, 1):
            parts.append((block((h - 0.2, 0.16, 0.16), (0, y, s * (h / 2 - 0.08))), WOOD))
            parts.append((block((0.16, 0.16, h - 0.2), (s * (h / 2 - 0.08), y, 0)), WOOD))
    return {"flat": grounded(coloured(*parts), 0.3, 0.4)}


def barrel(text="#3f6f8f"):
    """A drum, 1 m tall."""
    body = sg.lathe([[(0.36, 0.0), (0.42, 0.35), (0.42, 0.65), (0.36, 1.0)], [(0.36, 1.0), (0.0, 1.0)]], 9)
    hoops = sg.merge(*[sg.lathe([[(0.425, y - 0.05), (0.44, y), (0.425, y + 0.05)]], 9) for y in (0.28, 0.72)])
    return {"flat": grounded(coloured((body, text), (hoops, STEEL)), 0.3, 0.4)}


def tent(text):
    """A ridge tent with a dark doorway, 4 m long."""
    from shapes import outline
    body = outline([(-1.7, 0.0), (1.7, 0.0), (0.0, 2.3)], 3.8)
    door = outline([(-0.6, 0.0), (0.6, 0.0), (0.0, 1.6)], 0.05).moved(0, 0, 1.9)
    ridge = pipe((0, 2.3, -2.1), (0, 2.3, 2.15), 0.07, 5)
    pegs = [block((0.12, 0.3, 0.12), (s * 1.75, 0, z)) for s in (-1, 1) for z in (-1.6, 1.6)]
    return {"flat": grounded(coloured((body, text), (door, DARK), (ridge, WOOD), (sg.merge(*pegs), WOOD)), 0.4, 0.45)}


def ball_buoy():
    """A channel buoy with a lamp; it floats at y = 0."""
    body = coloured((sg.lathe([[(0.45, -0.4), (0.7, 0.1), (0.5, 0.45), (0.18, 1.4)]], 8), "#e8642c"), (drum(8, 0.22, 0.2, 0.15, (0, 1.38, 0)), "#f4efe2"))
    return {"flat": body, "glow_warm": ball(0.2, (0, 1.68, 0), 6, 4)}
