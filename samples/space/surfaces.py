"""Tileable materials of the space sample: hull panels, windows, solar cells, foil and rock."""
import numpy as np

import scenegen as sg
from scenegen import Noise, Surface, blend, cavity, smooth

TITANIUM = np.array((0.618, 0.580, 0.543))


def split_panels(rng, size, smallest, rect=None, depth=0):
    """Rectangles in pixels from splitting a square again and again, along the longer side mostly."""
    x0, y0, x1, y1 = rect or (0, 0, size, size)
    w, h = x1 - x0, y1 - y0
    wide = w * (0.7 + 0.6 * rng.random()) > h
    span = w if wide else h
    if span < 2 * smallest or (depth > 3 and rng.random() < 0.22):
        return [(x0, y0, x1, y1)]
    cut = int(span * (0.3 + 0.4 * rng.random())) // 8 * 8
    cut = max(smallest, min(span - smallest, cut))
    a, b = ((x0, y0, x0 + cut, y1), (x0 + cut, y0, x1, y1)) if wide else ((x0, y0, x1, y0 + cut), (x0, y0 + cut, x1, y1))
    return split_panels(rng, size, smallest, a, depth + 1) + split_panels(rng, size, smallest, b, depth + 1)


def hull_surface(seed=401, bare=0.07, metres=32.0, size=1024):
    """Painted plates on titanium: each plate has its own shade, gloss and height; some are bare, paint is chipped at seams."""
    z = Noise(seed, size)
    shade, gloss, lift, metal, edge = (np.zeros((size, size)) for _ in range(5))
    for x0, y0, x1, y1 in split_panels(z.rng, size, 48):
        a, b, c, d = z.rng.random(4)
        here = (slice(y0, y1), slice(x0, x1))
        shade[here], gloss[here], lift[here], metal[here] = a, b, c, float(d < bare)
        px, py = np.arange(x1 - x0) + 0.5, np.arange(y1 - y0) + 0.5
        edge[here] = np.minimum(np.minimum(px, x1 - x0 - px)[None], np.minimum(py, y1 - y0 - py)[:, None])
    seam = smooth(1.2, 3.2, edge)
    grit, cloud = z.fbm(48, octaves=3), z.fbm(5, octaves=4)
    streak = z.fbm(48, 3, 3)
    worn = smooth(0.77, 0.81, z.fbm(16, octaves=4) + 0.14 * smooth(8, 2, edge))
    rivet = np.zeros((size, size))
    pitch = 16
    rx, ry = np.abs((np.arange(size) % pitch) - 7.5), np.abs((np.arange(size) % pitch) - 7.5)
    row = (edge > 5.0) & (edge < 8.5)
    rivet[row] = smooth(2.4, 1.0, np.hypot(np.minimum(rx, 9)[None] + 0 * ry[:, None], 0 * rx[None] + np.minimum(ry, 9)[:, None]))[row]
    bare_mask = (np.maximum(metal, worn) * seam > 0.5).astype(float)     # nothing is partly metal: mips blend what must be
    paint = blend((0.44, 0.46, 0.48), (0.64, 0.65, 0.65), smooth(0.1, 0.9, shade)) * (0.82 + 0.2 * cloud + 0.12 * (streak - 0.5))[..., None]
    steel = TITANIUM * (0.80 + 0.25 * grit)[..., None]
    colour = blend(paint, steel, bare_mask)
    colour = blend((0.05, 0.05, 0.055), colour, 0.25 + 0.75 * seam)
    height = 0.05 * lift * seam + 0.04 * seam + 0.02 * rivet - 0.004 * worn + 0.003 * grit
    rough = (0.40 + 0.28 * gloss + 0.12 * (cloud - 0.5)) * (1 - bare_mask) + bare_mask * (0.40 + 0.22 * gloss + 0.10 * streak)
    rough = rough * seam + 0.85 * (1 - seam)
    return Surface(metres, height, colour, rough, bare_mask, np.clip(cavity(height, 0.12, 5), 0.3, 1))


def metal_surface():
    """Bare machined metal: brushed, scorched in bands."""
    z = Noise(402, 512)
    brush, cloud, band = z.fbm(4, 128, 2), z.fbm(4, octaves=4), z.fbm(1, 12, 2)
    colour = blend(TITANIUM * 0.55, TITANIUM * 1.05, smooth(0.3, 0.7, cloud)) * (0.85 + 0.3 * brush)[..., None]
    ring = smooth(0.02, 0.06, np.abs(z.y * 8 % 1 - 0.5) * 2)
    height = 0.02 * ring + 0.002 * brush + 0.008 * band
    return Surface(4.0, height, colour * (0.5 + 0.5 * ring)[..., None], 0.26 + 0.22 * brush + 0.15 * cloud, 1 + 0 * brush, 0.5 + 0.5 * ring)


def foil_surface():
    """Crinkled insulation foil; its colour is the substance's."""
    z = Noise(403, 512)
    wx, wy = z.warped(6, 0.1)
    fold = z.ridged(6, 4, wx, wy)
    height = 0.05 * fold + 0.02 * z.fbm(12, octaves=3)
    return Surface(3.0, height, None, 0.20 + 0.12 * z.fbm(8, octaves=3), 1 + 0 * fold, cavity(height, 0.08))


def window_surface():
    """Dark cladding with rows of lit windows two metres apart; returns the surface and its emission."""
    size = 512
    z = Noise(404, size)
    cols, rows = 16, 8
    ix, iy = np.floor(z.x * cols).astype(int), np.floor(z.y * rows).astype(int)
    fx, fy = np.abs(z.x * cols % 1 - 0.5), np.abs(z.y * rows % 1 - 0.5)
    pane = smooth(0.34, 0.28, fx) * smooth(0.20, 0.15, fy)
    lit = (z.rng.random((rows, cols)) < 0.62) * (0.35 + 0.65 * z.rng.random((rows, cols)))
    warm = z.rng.random((rows, cols))
    glow = blend((1.0, 0.72, 0.38), (0.72, 0.86, 1.0), smooth(0.62, 0.72, warm))[iy, ix] * (lit[iy, ix] * pane)[..., None]
    colour = blend((0.16, 0.17, 0.19), (0.02, 0.025, 0.03), pane)
    height = -0.05 * pane
    return Surface(16.0, height, colour, 0.5 - 0.35 * pane, 0 * pane, 1 - 0.3 * pane), sg.to_srgb(glow)


def solar_surface():
    """Blue cells between silver conductors, 4 x 4 m of them."""
    size = 512
    z = Noise(405, size)
    fx, fy = np.abs(z.x * 8 % 1 - 0.5), np.abs(z.y * 8 % 1 - 0.5)
    cell = smooth(0.5, 0.465, np.maximum(fx, fy))
    per = z.rng.random((8, 8))[np.floor(z.y * 8).astype(int), np.floor(z.x * 8).astype(int)]
    wire = smooth(0.10, 0.04, np.abs(z.x * 40 % 1 - 0.5)) * 0.35
    colour = blend((0.62, 0.62, 0.60), blend((0.010, 0.022, 0.085), (0.020, 0.045, 0.150), per), (cell > 0.5) * 1.0)
    colour = blend(colour, (0.55, 0.56, 0.58), wire * (cell > 0.5))
    return Surface(4.0, 0.01 * cell + 0.006 * per * cell, colour, 0.5 - 0.32 * cell + 0.08 * per, (cell < 0.5).astype(float), 1 + 0 * cell)


def rock_surface():
    """Carbonaceous rock: dust in the hollows, fine craters, a few bright veins."""
    size = 512
    z = Noise(406, size)
    broad, fine = z.fbm(4, octaves=5), z.fbm(24, octaves=4)
    pits = np.zeros((size, size))
    for cx, cy, r in z.rng.random((70, 3)):
        radius = 0.012 + 0.05 * r ** 3
        d = np.hypot((z.x - cx + 0.5) % 1 - 0.5, (z.y - cy + 0.5) % 1 - 0.5) / radius
        pits += np.where(d < 1.6, radius * (smooth(1.0, 0.2, d) * -1.0 + 0.35 * np.exp(-((d - 1.05) / 0.2) ** 2)), 0.0)
    height = 0.5 * broad + 0.22 * fine + 5.0 * pits
    ridge = smooth(0.97, 1.0, z.ridged(4, 2))
    colour = blend((0.085, 0.076, 0.068), (0.20, 0.175, 0.15), smooth(0.3, 0.7, broad)) * (0.6 + 0.8 * fine)[..., None]
    colour = blend(colour, (0.36, 0.33, 0.29), 0.5 * ridge)
    return Surface(8.0, height, colour, 0.93 - 0.1 * fine, 0 * broad, cavity(height, 0.5, 8))


def engine_glow():
    """A nozzle's emission from its middle (v = 0) to its rim."""
    r = np.linspace(0.0, 1.0, 64)
    tone = blend((0.62, 0.85, 1.0), (0.05, 0.26, 1.0), smooth(0.25, 0.75, r)) * (0.06 + 0.94 * np.exp(-(r / 0.42) ** 2))[:, None]
    return sg.to_srgb(np.repeat(tone[:, None], 8, 1))


def make_materials(g):
    """Every material of the scene by name."""
    hull = g.surface("hull", hull_surface())
    metal = g.surface("metal", metal_surface())
    foil = g.surface("foil", foil_surface())
    solar = g.surface("solar", solar_surface())
    rock = g.surface("rock", rock_surface())
    windows, glow = window_surface()
    lit = dict(g.surface("windows", windows), emit=g.texture("windows_emission", glow))
    mats = {"hull": g.material("hull", hull), "hull_grey": g.material("hull_grey", hull, (0.30, 0.32, 0.35), rough=0.95), "hull_dark": g.material("hull_dark", hull, (0.10, 0.11, 0.125), rough=0.9),
            "hull_orange": g.material("hull_orange", hull, (1.0, 0.30, 0.06)), "hull_teal": g.material("hull_teal", hull, (0.10, 0.42, 0.50)), "hull_sand": g.material("hull_sand", hull, (0.85, 0.68, 0.42)),
            "metal": g.material("metal", metal), "foil": g.material("foil", foil, (1.0, 0.729, 0.364), substance="gold"), "solar": g.material("solar", solar),
            "rock": g.material("rock", rock), "rock_red": g.material("rock_red", rock, (1.0, 0.78, 0.60)),
            "windows": g.material("windows", lit, emit=(1, 1, 1), nits=9000.0), "canopy": g.material("canopy", base=(0.012, 0.018, 0.025), rough=0.06, substance="glass")}
    mats["engine"] = g.material("engine", {"emit": g.texture("engine_emission", engine_glow(), True)}, (0.02, 0.02, 0.02), 0.6, 0.0, (1, 1, 1), 40000.0)
    for name, colour, nits in (("nav_red", (1.0, 0.06, 0.03), 26000.0), ("nav_green", (0.08, 1.0, 0.25), 26000.0),
                               ("flood", (1.0, 0.90, 0.72), 30000.0)):
        mats[name] = g.material(name, base=(0.02, 0.02, 0.02), rough=0.6, emit=colour, nits=nits)
    return mats
