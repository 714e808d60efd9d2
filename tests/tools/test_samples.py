#!/usr/bin/env python3
"""The sample scenes: what their files hold and what the program says of them: test_samples.py BURNISH SAMPLES SOURCES [unittest arguments].

SAMPLES is the folder of generated scenes, SOURCES that of the scripts. `Regenerated` makes each scene anew and compares bytes (tens of seconds)."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np

BURNISH, SAMPLES, SOURCES = "", pathlib.Path(), pathlib.Path()


class Scene:
    """One generated scene, with what the tests ask of it."""

    def __init__(self, name):
        self.file = SAMPLES / name / f"{name}.gltf"
        self.doc = json.loads(self.file.read_text())
        self.nodes, self.meshes = self.doc["nodes"], self.doc["meshes"]
        self.lights = self.doc["extensions"]["KHR_lights_punctual"]["lights"]
        self.extras = self.doc["scenes"][0]["extras"]["burnish"]
        self.parents = {c: k for k, n in enumerate(self.nodes) for c in n.get("children", ())}

    def placed(self, kind):
        return [n for n in self.nodes if kind in n]

    def triangles(self, mesh):
        return sum(self.doc["accessors"][p["indices"]]["count"] // 3 for p in self.meshes[mesh]["primitives"])

    def root_of(self, index):
        while index in self.parents:
            index = self.parents[index]
        return self.nodes[index]

    def cameras(self):
        return {c["name"] for c in self.doc["cameras"]}

    def shadowed(self):
        return sorted(l["name"] for l in self.lights if l.get("extras", {}).get("burnish", {}).get("shadow"))

    def animated(self):
        return {self.nodes[c["target"]["node"]]["name"] for a in self.doc["animations"] for c in a["channels"]}


def png(data):
    """The pixels (h, w, channels) of an 8-bit PNG."""
    at, packed = 8, b""
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body, at = data[at + 8:at + 8 + length], at + 12 + length
        if kind == b"IHDR":
            w, h, n = int.from_bytes(body[:4], "big"), int.from_bytes(body[4:8], "big"), {2: 3, 6: 4}[body[9]]
        packed += body if kind == b"IDAT" else b""
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(h, 1 + w * n)
    out = np.zeros((h + 1, (w + 1) * n), np.int32)              # a row above and a pixel to the left stay zero
    for y in range(h):
        kind, line, above = rows[y, 0], out[y + 1], out[y]
        for x in range(n, (w + 1) * n):
            a, b, c = line[x - n], above[x], above[x - n]
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[x] = (int(rows[y, 1 + x - n]) + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
    return out[1:, n:].reshape(h, w, n)


class Samples(unittest.TestCase):
    def render(self, scene, camera, *more):
        """The report and the pixels."""
        with tempfile.TemporaryDirectory(prefix="burnish-samples-") as folder:
            report, picture = pathlib.Path(folder) / "report.json", pathlib.Path(folder) / "a.png"
            result = subprocess.run([BURNISH, "render", scene.file, "--camera", camera, "--size", "160x90", "--exposure", str(scene.extras["ev100"]),
                                     "-o", picture, "--json", report, *more], capture_output=True, text=True, timeout=120)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(report.read_text()), png(picture.read_bytes())

    def clean(self, scene):
        """Every number of the picture is finite, nothing is warned of; playing the animations changes a little of it."""
        report, still = self.render(scene, "hero")
        later, moved = self.render(scene, "hero", "--time", "5")
        for seen in (report, later):
            self.assertEqual(seen["nonfinite_pixels"], 0)
            self.assertEqual(seen["gl_errors"], 0)
            self.assertEqual(seen["warnings"], [])
        changed = np.mean(np.abs(still - moved).max(-1) > 8)
        self.assertTrue(0.001 < changed < 0.3, changed)
        return still

    def well_made(self, scene):
        """The script's own check of tangents, winding, bounds; names on everything that a host may look up."""
        sys.path.insert(0, str(SOURCES / "common"))
        import scenegen
        self.assertEqual(scenegen.check_file(scene.file), [])
        for table in (scene.nodes, scene.meshes, scene.doc["materials"], scene.lights, scene.doc["cameras"], scene.doc["animations"]):
            self.assertTrue(all(row["name"] for row in table))
        names = [n["name"] for n in scene.nodes]
        self.assertEqual(len(names), len(set(names)))
        self.assertTrue((scene.file.parent / scene.extras["environment"]).exists())

    def test_rts(self):
        scene = Scene("rts")
        self.well_made(scene)
        drawn = scene.placed("mesh")
        self.assertGreaterEqual(len(drawn), 1000)
        self.assertLessEqual(len(scene.meshes), 100)
        stems = [n["name"].rsplit("_", 1)[0] for n in drawn]
        for stem, least in (("soldier", 120), ("heavy", 50), ("tank", 10), ("truck", 2), ("artillery", 3), ("boat", 4), ("pine", 150), ("leaf", 80), ("rock", 90)):
            self.assertGreaterEqual(sum(s.startswith(stem) for s in stems), least, stem)
        units = [n for n in drawn if n["name"].startswith(("soldier", "heavy", "tank", "truck", "artillery"))]
        for node in units:
            self.assertTrue(100 <= scene.triangles(node["mesh"]) <= 600, node["name"])
        self.assertLess(sum(scene.triangles(n["mesh"]) for n in drawn), 300000)
        points = [l for l in scene.lights if l["type"] == "point"]
        self.assertGreaterEqual(len(points), 300)
        self.assertTrue(all(3 <= l["range"] <= 12 for l in points))
        self.assertEqual([l["name"] for l in scene.lights if l["type"] == "directional"], ["sun"])
        self.assertEqual(scene.shadowed(), ["sun"])
        self.assertEqual(set(scene.extras["fog"]), {"density", "falloff", "height", "albedo"})
        self.assertEqual(scene.cameras(), {"hero", "close", "map"})
        self.assertEqual(scene.animated(), {"mill_sails", "radar_dish", "patrol_truck"})
        self.clean(scene)

    def test_space(self):
        scene = Scene("space")
        self.well_made(scene)
        drawn = scene.placed("mesh")
        self.assertGreaterEqual(len(drawn), 400)
        self.assertLessEqual(len(scene.meshes), 40)
        self.assertGreaterEqual(sum(n["name"].startswith("asteroid") for n in drawn), 250)
        # Far from the origin, and only by the transforms: what floats hold stays small.
        for index in range(len(scene.nodes)):
            self.assertEqual(scene.root_of(index)["name"], "sector")
        self.assertGreater(math.hypot(*scene.root_of(0)["translation"]), 1e6)
        for mesh in scene.meshes:
            for primitive in mesh["primitives"]:
                bounds = scene.doc["accessors"][primitive["attributes"]["POSITION"]]
                self.assertLess(max(map(abs, bounds["min"] + bounds["max"])), 1000, mesh["name"])
        planet = next(n for n in drawn if n["name"] == "planet")
        self.assertTrue(1e5 <= planet["scale"][0] <= 1e6)
        self.assertGreater(math.hypot(*planet["translation"]), 1e6)
        self.assertTrue(all("zfar" not in c["perspective"] for c in scene.doc["cameras"]))
        self.assertEqual(scene.shadowed(), ["sun"])
        self.assertNotIn("fog", scene.extras)
        self.assertEqual(scene.cameras(), {"hero", "close", "far"})
        self.assertTrue({"station_wheel", "cruiser", "fighter_0"} <= scene.animated())
        self.clean(scene)
        # The same picture at the origin: 1.2e6 m away nothing trembles. Without shadows: the texels of cascades lie on a grid of the world, which moves under the scene.
        _, there = self.render(scene, "hero", "--set", "shadow=none")
        with tempfile.TemporaryDirectory(prefix="burnish-samples-") as folder:
            shutil.copytree(scene.file.parent, pathlib.Path(folder) / "space")
            scene.file = pathlib.Path(folder) / "space/space.gltf"
            scene.root_of(0)["translation"] = [0, 0, 0]
            scene.file.write_text(json.dumps(scene.doc))
            _, here = self.render(scene, "hero", "--set", "shadow=none")
        off = np.abs(here - there).max(-1)
        self.assertLess(np.mean(off > 1), 0.002)

    def test_fps_lights(self):
        self.assertEqual(Scene("fps").shadowed(), ["lamp_1", "lamp_2", "lamp_3", "sun_shaft"])


class Regenerated(unittest.TestCase):
    def test_scripts_write_the_same_bytes_again(self):
        for name in ("fps", "rts", "space", "chart"):
            with tempfile.TemporaryDirectory(prefix="burnish-samples-") as folder:
                subprocess.run([sys.executable, "-B", SOURCES / name / "make_scene.py", "-o", folder, "--check"], check=True, capture_output=True, timeout=300)
                made = sorted(p.relative_to(folder) for p in pathlib.Path(folder).rglob("*") if p.is_file())
                self.assertEqual(made, sorted(p.relative_to(SAMPLES / name) for p in (SAMPLES / name).rglob("*") if p.is_file()))
                for path in made:
                    self.assertEqual((pathlib.Path(folder) / path).read_bytes(), (SAMPLES / name / path).read_bytes(), f"{name}/{path}")


if __name__ == "__main__":
    BURNISH, SAMPLES, SOURCES = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1)), pathlib.Path(sys.argv.pop(1))
    unittest.main(argv=sys.argv, verbosity=2)
