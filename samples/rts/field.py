"""The map while it is being filled: `Field` puts instances down, keeps them apart and remembers the occlusion that they leave
on the ground; lamps and their lights; positions along roads."""
import math

import numpy as np

import scenegen as sg
from terrain import ACROSS, samples

BRIDGE_TURN = math.degrees(math.atan2(ACROSS[0], ACROSS[1]))
DECK = 2.78
# colour, candela, metres
WARM, COOL, FIRE, HEAD = ((1.0, 0.60, 0.26), 9500.0, 10.0), ((0.42, 0.74, 1.0), 5600.0, 10.0), ((1.0, 0.42, 0.12), 5600.0, 9.5), ((1.0, 0.88, 0.62), 2600.0, 8.0)
GLOWS = {"violet": ((0.72, 0.26, 1.0), 3600.0, 7.5), "teal": ((0.16, 1.0, 0.75), 2800.0, 7.5)}


def bearing(dx, dz):
    """Degrees about +y that turn +z to a direction."""
    return math.degrees(math.atan2(dx, dz))


class Field:
    """The map while it is being filled."""

    def __init__(self, g, ground, kinds):
        self.g, self.ground, self.kinds = g, ground, kinds
        self.rng = np.random.Generator(np.random.PCG64(77))
        self.taken, self.spots, self.counts = [], [], {}
        self.light_count = 0

    def height(self, x, z):
        return float(self.ground.at("height", x, z))

    def free(self, x, z, radius):
        """Whether a disc meets nothing that stands already."""
        return all((x - a) ** 2 + (z - b) ** 2 > (radius + r) ** 2 for a, b, r in self.taken)

    def name(self, stem):
        k = self.counts.get(stem, 0)
        self.counts[stem] = k + 1
        return "%s_%03d" % (stem, k)

    def put(self, kind, x, z, turn=0.0, radius=1.0, scale=None, y=None, tilt=0.0, shade=0.5, stem=None, **rest):
        """Stand an instance on the ground; tilt 1 lays it along the slope. Returns its node."""
        ground = self.height(x, z) if y is None else y
        rotation = sg.quaternion((0, 1, 0), turn)
        if tilt:
            n = self.ground.normal(x, z)
            axis = np.cross([0.0, 1.0, 0.0], n)
            if np.linalg.norm(axis) > 1e-5:
                rotation = sg.quaternion_product(sg.quaternion(axis, tilt * math.degrees(math.acos(min(1.0, n[1])))), rotation)
        self.taken.append((x, z, radius))
        if shade:
            self.spots.append((x, z, radius, shade))
        return self.g.node(self.name(stem or kind), (x, ground, z), rotation, scale, mesh=self.kinds[kind], **rest)

    def building(self, kind, x, z, turn, half, sink=0.0, shade=0.6):
        """A building with its rectangle of occlusion; half is (x, z) half sizes before turning."""
        self.taken.append((x, z, max(half) + 0.6))
        self.spots.append((x, z, half[0], half[1], turn, shade))
        corners = [self.height(x + math.cos(math.radians(turn)) * a + math.sin(math.radians(turn)) * b, z - math.sin(math.radians(turn)) * a + math.cos(math.radians(turn)) * b)
                   for a in (-half[0], half[0]) for b in (-half[1], half[1])]
        y = min(corners + [self.height(x, z)]) - sink
        self.g.node(self.name(kind), (x, y, z), turn, mesh=self.kinds[kind])
        return y

    def light(self, stem, at, what):
        """A point light; `what` is (colour, candela, metres)."""
        self.light_count += 1
        self.g.light(self.name(stem), "point", at, None, what[0], what[1], what[2])

    def local(self, x, z, turn, dx, dz):
        """A point given in a turned thing's own coordinates."""
        a = math.radians(turn)
        return x + dx * math.cos(a) + dz * math.sin(a), z - dx * math.sin(a) + dz * math.cos(a)


def along(points, start, gap, count, side=0.0):
    """Positions and bearings along a road, `gap` metres apart, `side` metres to the right."""
    line = samples(points, 16)
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    out = []
    for k in range(count):
        s = start + gap * k
        if s > arc[-1] - 0.5:
            break
        x, z = np.interp(s, arc, line[:, 0]), np.interp(s, arc, line[:, 1])
        dx, dz = np.interp(s + 0.5, arc, line[:, 0]) - np.interp(s - 0.5, arc, line[:, 0]), np.interp(s + 0.5, arc, line[:, 1]) - np.interp(s - 0.5, arc, line[:, 1])
        norm = math.hypot(dx, dz)
        out.append((x - side * dz / norm, z + side * dx / norm, bearing(dx, dz)))
    return out


def lantern(f, x, z, turn, what=((1.0, 0.60, 0.26), 1500.0, 6.0)):
    """A lantern on the ground and its light."""
    f.put("lantern", x, z, turn, 0.3, shade=0.3)
    f.light("lantern_light", (x, f.height(x, z) + 1.3, z), what)


def lamp(f, style, x, z, turn):
    """A lamp post and its light."""
    if not f.free(x, z, 0.4) or f.ground.at("river", x, z) < 12.5:
        return
    f.put("lamp_" + style, x, z, turn, 0.35, shade=0.4)
    lx, lz = f.local(x, z, turn, 0.0, 0.68)
    f.light("lamp_light", (lx, f.height(x, z) + 2.75, lz), COOL if style == "blue" else WARM)


def stores(f, at, count):
    """Crates and barrels in a heap."""
    for k in range(count * 3):
        a, r = 2.39996 * k, 0.55 * math.sqrt(k + 0.5) * 1.25
        x, z = at[0] + r * math.sin(a), at[1] + r * math.cos(a)
        if k >= count:
            break
        if f.free(x, z, 0.5):
            f.put("crate" if k % 3 else "barrel_%d" % (k % 2), x, z, 47 * k, 0.55, shade=0.4)
