"""Capitals and digits drawn as strokes, for the chart's labels. numpy only.

A glyph is strokes separated by `;`, each a line through points `x,y` and arcs `acx,cy,rx,ry,from,to` (degrees).
The baseline is y = 0, capitals are 1 high; the width is that of the strokes' centre lines.
"""
import functools

import numpy as np

GLYPHS = {
    "0": "a.29,.71,.29,.29,0,180 a.29,.29,.29,.29,180,360 .58,.71", "1": ".06,.78 .30,1 .30,0",
    "2": "a.28,.72,.28,.28,165,-36 0,0 .57,0", "3": "a.28,.75,.26,.25,155,-90 a.28,.25,.29,.25,90,-155",
    "4": ".46,0 .46,1 0,.27 .61,.27", "5": ".52,1 .09,1 .05,.53 a.28,.32,.29,.32,132,-152",
    "6": "a.29,.31,.29,.31,0,360;0,.31 .02,.46 .09,.64 .35,1", "7": "0,1 .56,1 .19,0",
    "8": "a.29,.76,.25,.24,0,360;a.29,.26,.29,.26,0,360", "9": "a.29,.69,.29,.31,0,360;.58,.69 .56,.54 .49,.36 .23,0",
    ".": ".04,0 .04,.02", "-": "0,.48 .36,.48", "%": "a.15,.80,.15,.20,0,360;a.65,.20,.15,.20,0,360;.14,0 .66,1",
    "A": "0,0 .35,1 .70,0;.12,.32 .58,.32", "B": "0,0 0,1 .28,1 a.28,.76,.24,.24,90,-90 0,.52;.28,.52 a.28,.26,.29,.26,90,-90 0,0",
    "C": "a.33,.67,.33,.33,28,180 a.33,.33,.33,.33,180,332", "D": "0,0 0,1 .24,1 a.24,.64,.37,.36,90,0 a.24,.36,.37,.36,0,-90 0,0",
    "E": ".50,1 0,1 0,0 .50,0;0,.52 .43,.52", "F": ".50,1 0,1 0,0;0,.50 .42,.50",
    "G": "a.33,.67,.33,.33,28,180 a.33,.33,.33,.33,180,360 .66,.46 .38,.46", "H": "0,0 0,1;.60,0 .60,1;0,.52 .60,.52",
    "I": "0,0 0,1", "K": "0,0 0,1;.56,1 0,.40;.18,.55 .59,0", "L": "0,1 0,0 .46,0", "M": "0,0 0,1 .36,.35 .72,1 .72,0",
    "N": "0,0 0,1 .60,0 .60,1", "O": "a.34,.66,.34,.34,0,180 a.34,.34,.34,.34,180,360 .68,.66",
    "P": "0,0 0,1 .29,1 a.29,.73,.28,.27,90,-90 0,.46", "R": "0,0 0,1 .29,1 a.29,.73,.28,.27,90,-90 0,.46;.27,.46 .57,0",
    "S": "a.28,.75,.26,.25,32,270 a.28,.25,.28,.25,90,-150", "T": "0,1 .60,1;.30,1 .30,0",
    "U": "0,1 0,.32 a.31,.32,.31,.32,180,360 .62,1", "V": "0,1 .33,0 .66,1", "W": "0,1 .24,0 .46,.82 .68,0 .92,1",
    "Y": "0,1 .31,.46 .62,1;.31,.46 .31,0", "Z": "0,1 .56,1 0,0 .56,0",
}
SPACE, TRACKING = 0.34, 0.27      # in cap heights


@functools.lru_cache(maxsize=None)
def glyph(char):
    """The glyph's segments (n, 2, 2) and its width."""
    out = []
    for stroke in GLYPHS[char].split(";"):
        points = []
        for token in stroke.split():
            v = [float(x) for x in token.lstrip("a").split(",")]
            if token[0] == "a":
                t = np.radians(np.linspace(v[4], v[5], 4 + int(abs(v[5] - v[4]) / 9)))
                points += list(np.stack([v[0] + v[2] * np.cos(t), v[1] + v[3] * np.sin(t)], 1))
            else:
                points.append(np.array(v))
        out += list(zip(points[:-1], points[1:]))
    segments = np.array(out)
    return segments, float(segments[..., 0].max())


def width(text):
    """Length of a line of text in cap heights."""
    return sum(SPACE if c == " " else glyph(c)[1] for c in text) + TRACKING * (len(text) - 1)


class Page:
    """Ink (0..1) on a picture of `size` pixels that shows the rectangle (x0, y0, x1, y1), y upwards."""

    def __init__(self, rect, size):
        self.x0, self.y1 = rect[0], rect[3]
        self.scale = size[0] / (rect[2] - rect[0])
        self.ink = np.zeros((size[1], size[0]), np.float32)

    def strokes(self, segments, thickness, tone):
        """Draws segments (n, 2, 2) with round ends, smooth over one pixel."""
        s = (np.asarray(segments, float) - (self.x0, self.y1)) * (self.scale, -self.scale)
        half = thickness * self.scale / 2
        lo = np.maximum(np.floor(s.min((0, 1)) - half - 1).astype(int), 0)
        hi = np.ceil(s.max((0, 1)) + half + 2).astype(int)
        window = self.ink[lo[1]:hi[1], lo[0]:hi[0]]
        y, x = np.mgrid[lo[1]:lo[1] + window.shape[0], lo[0]:lo[0] + window.shape[1]] + 0.5
        nearest = np.full(window.shape, 1e9)
        for (ax, ay), (bx, by) in s:
            dx, dy = bx - ax, by - ay
            t = np.clip(((x - ax) * dx + (y - ay) * dy) / max(dx * dx + dy * dy, 1e-9), 0, 1)
            nearest = np.minimum(nearest, (x - ax - t * dx) ** 2 + (y - ay - t * dy) ** 2)
        np.maximum(window, tone * np.clip(half + 0.5 - np.sqrt(nearest), 0, 1), out=window)

    def text(self, text, x, y, cap, align=0.5, tone=1.0):
        """A line of text on the baseline y; align 0 starts at x, 0.5 centres, 1 ends there."""
        x -= align * width(text) * cap
        for char in text:
            if char == " ":
                x += (SPACE + TRACKING) * cap
                continue
            segments, wide = glyph(char)
            self.strokes(segments * cap + (x, y), 0.135 * cap, tone)
            x += (wide + TRACKING) * cap

    def rule(self, x0, x1, y, thickness, tone):
        """A thin line across."""
        self.strokes([[(x0, y), (x1, y)]], thickness, tone)
