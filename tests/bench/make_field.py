#!/usr/bin/env python3
"""Writes the scaling scenes `field`: many instances of a few meshes, or of as many meshes as instances, and many small lights.

    make_field.py -o DIR [--instances N,N,...] [--lights L,L,...] [--distinct] [--clustered]

Output: DIR/field_I<instances>_L<lights>.gltf for each pair (with --distinct: every instance has a mesh of its own), sharing nothing.
With --clustered the lights crowd on the middle ninth of the field, else they are spread over it.
A square lattice of low-poly things, one a metre, on a plain; one directional light, L point lights of range 2 m just above it. Camera `bench` sees all of it from above.
"""
import math
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "samples", "common"))
import scenegen as sg  # noqa: E402

KINDS = 8


def thing(kind):
    """Eight shapes of some 60 to 130 triangles."""
    if kind % 2:
        return sg.lathe([sg.spline([(0.30, 0.0), (0.24 - 0.02 * kind, 0.25), (0.10 + 0.02 * kind, 0.6), (0.02, 0.8)], 1)], 8 + kind, 1.0)
    return sg.merge(sg.box((0.5, 0.25, 0.4), (0, 0.125, 0), 0.02), sg.box((0.2 + 0.02 * kind, 0.3, 0.2), (0, 0.4, 0), 0.02))


def field(folder, instances, lights, distinct, clustered):
    """One scene file."""
    g = sg.Gltf("Burnish tests/bench/make_field.py")
    rng = np.random.Generator(np.random.PCG64(77))
    side = math.ceil(math.sqrt(instances))
    g.camera("bench", (0, 0.55 * side, 0.75 * side), (0, 0, 0.05 * side), 50.0, 0.1, 4.0 * side)
    colours = [tuple(0.15 + 0.7 * rng.random(3)) for _ in range(KINDS)]
    mats = [g.material("paint_%d" % k, None, colours[k], 0.35 + 0.08 * k, 0.0) for k in range(KINDS)]
    ground = g.material("ground", None, (0.25, 0.27, 0.22), 0.9, 0.0)
    g.node("ground", mesh=g.mesh("ground", (sg.plane((-side, 0, side), (2 * side, 0, 0), (0, 0, -2 * side), 4.0), ground)))
    kinds = [g.mesh("thing_%d" % k, (thing(k), mats[k])) for k in range(KINDS)]
    for i in range(instances):
        at = (i % side - side / 2 + 0.5, 0, i // side - side / 2 + 0.5)
        mesh = g.mesh("thing_%d" % i, (thing(i % KINDS), mats[i % KINDS])) if distinct else kinds[i % KINDS]
        g.node("thing", at, float(rng.integers(360)), mesh=mesh)
    g.light("sun", "directional", (0, 12, 0), (-0.4, -1.0, -0.3), (1.0, 0.95, 0.88), 2.0)
    reach = side / 6 if clustered else side / 2
    at = rng.uniform((-reach, 0.5, -reach), (reach, 1.2, reach), (lights, 3)).round(3)
    for k in range(lights):
        g.light("point_%d" % k, "point", at[k], None, tuple((0.3 + 0.7 * rng.random(3)).round(3)), 4.0, 2.0)
    name = "field_I%d_L%d" % (instances, lights)
    g.save(folder, name, name + ".bin", {"ev100": -math.log2(1.2)})
    return os.path.join(folder, name + ".gltf")


def numbers(option, default):
    """The list after `option` on the command line."""
    return [int(n) for n in sys.argv[sys.argv.index(option) + 1].split(",")] if option in sys.argv else default


def main():
    if "-o" not in sys.argv:
        sys.exit(__doc__)
    folder = sys.argv[sys.argv.index("-o") + 1]
    os.makedirs(folder, exist_ok=True)
    for instances in numbers("--instances", [1000, 10000]):
        for lights in numbers("--lights", [64]):
            print(field(folder, instances, lights, "--distinct" in sys.argv, "--clustered" in sys.argv))


if __name__ == "__main__":
    main()
