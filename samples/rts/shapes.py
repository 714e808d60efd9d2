"""Palette and baked occlusion of the rts sample's things, on top of samples/common/solids.py."""
import dataclasses

import numpy as np

from solids import ball, block, cap, colour, coloured, drum, outline, pipe, polygon, profile, rectangle, retangent, solid, tint, wheel  # noqa: F401

DARK, STEEL, BONE = "#2e333b", "#7d8894", "#d9d4c6"
WOOD, WOOD_PALE, STONE = "#6b4a2f", "#a5794a", "#8d8a86"
# faction: main colour, a lighter trim, hull, dark parts
FACTIONS = {
    "blue": {"main": "#2767d6", "trim": "#6fb1ff", "hull": "#b9c6d3", "dark": "#36414f", "cloth": "#3f5d86"},
    "red": {"main": "#cf2f25", "trim": "#ffb347", "hull": "#8a6d55", "dark": "#3d302b", "cloth": "#7e3a2c"},
}


def grounded(mesh, reach=0.6, depth=0.5, under=0.25):
    """Baked occlusion in the vertex colours: darker near the ground and on faces that look down."""
    c = np.ones((len(mesh.p), 3)) if mesh.c is None else mesh.c
    near = 1.0 - depth * np.exp(-np.maximum(mesh.p[:, 1:2], 0.0) / reach)
    down = 1.0 - under * np.clip(-mesh.n[:, 1:2], 0.0, 1.0)
    return dataclasses.replace(mesh, c=c * near * down)
