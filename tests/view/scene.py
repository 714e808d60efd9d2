"""A scene that shows what rungs differ in: a glossy ball over a dull floor, a sun and a lamp, two cameras, and the ball moves."""
import base64
import json
import math
import struct


def ball(radius=1.0, rows=24, columns=48):
    points, normals, indices = [], [], []
    for r in range(rows + 1):
        for c in range(columns + 1):
            v, u = math.pi * r / rows, 2 * math.pi * c / columns
            n = (math.sin(v) * math.cos(u), math.cos(v), math.sin(v) * math.sin(u))
            normals.append(n)
            points.append(tuple(radius * x for x in n))
            if r < rows and c < columns:
                a, b = r * (columns + 1) + c, (r + 1) * (columns + 1) + c
                indices += ([a, a + 1, b] if r > 0 else []) + ([b, a + 1, b + 1] if r + 1 < rows else [])
    return points, normals, indices


def floor(size=6.0, y=-1.0):
    return [(-size, y, -size), (-size, y, size), (size, y, size), (size, y, -size)], [(0, 1, 0)] * 4, [0, 1, 2, 0, 2, 3]


def text():
    data, views, accessors, meshes = b"", [], [], []

    def add(values, form, kind, component, **more):
        nonlocal data
        width = len(values[0]) if isinstance(values[0], tuple) else 1
        flat = [x for v in values for x in (v if isinstance(v, tuple) else (v,))]
        piece = struct.pack(f"<{len(flat)}{form}", *flat)
        piece += b"\0" * (-len(piece) % 4)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(piece)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(flat) // width, "type": kind, **more})
        data += piece
        return len(accessors) - 1

    for material, (points, normals, indices) in enumerate((ball(), floor())):
        low, high = [[f(p[i] for p in points) for i in range(3)] for f in (min, max)]
        meshes.append({"primitives": [{"attributes": {"POSITION": add(points, "f", "VEC3", 5126, min=low, max=high), "NORMAL": add(normals, "f", "VEC3", 5126)},
                                       "indices": add(indices, "H", "SCALAR", 5123), "material": material}]})
    times = add([0.0, 1.0, 2.0], "f", "SCALAR", 5126, min=[0.0], max=[2.0])
    moves = add([(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)], "f", "VEC3", 5126)
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3, 4, 5, 6]}], "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3, "name": "sun"}, {"type": "point", "intensity": 20, "range": 12, "name": "lamp"}]}},
        "nodes": [{"mesh": 0, "name": "ball"}, {"mesh": 1, "name": "floor"}, {"camera": 0, "translation": [0, 0.5, 5]}, {"camera": 1, "translation": [1, 2, 8]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}, "rotation": [-0.5, 0.2, 0, math.sqrt(1 - 0.29)]},
                  {"extensions": {"KHR_lights_punctual": {"light": 1}}, "translation": [2, 2, 2]},
                  {"name": "place", "extras": {"burnish": {"probe": {}}}, "translation": [0, 2, 0], "scale": [8, 4, 8]}],
        "cameras": [{"name": n, "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}} for n in ("near", "far")],
        "materials": [{"name": "glossy", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.2, 0.1, 1], "metallicFactor": 0, "roughnessFactor": 0.35}},
                      {"name": "dull", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0, "roughnessFactor": 0.9}}],
        "animations": [{"name": "hop", "samplers": [{"input": times, "output": moves}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "meshes": meshes, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]})
