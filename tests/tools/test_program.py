#!/usr/bin/env python3
"""The burnish program, driven as a user drives it: test_program.py BURNISH [unittest arguments]."""
import base64
import json
import math
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

BURNISH = ""
ROOT = pathlib.Path(__file__).resolve().parents[2]
SUBCOMMANDS = ["render", "view", "plan", "bake", "prefilter", "reference", "cost", "inspect", "doctor", "stability"]
SANITIZED = os.environ.get("BURNISH_SANITIZED") == "1"
RENDER_KEYS = ["schema_version", "backend", "renderer", "size", "frames", "timing_mode", "frame_ms", "frame_cpu_ms", "passes", "effects", "programs",
               "plan", "gbuffer_bytes_per_pixel", "texture_bytes", "nonfinite_pixels", "gl_errors", "warnings", "rungs"]
PREFILTER_KEYS = ["schema_version", "source", "size", "lobe", "format", "levels", "total_ms", "total_cpu_ms", "tables_ms", "warnings"]
BAKE_KEYS = ["schema_version", "folder", "finished", "bounces", "capture_ms", "filter_ms", "store_ms", "wall_ms", "warnings"]
PLAN_KEYS = ["schema_version", "effects", "passes", "programs", "targets"]


def scene_text(points=((-1, -1, 0), (1, -1, 0), (0, 1, 0)), indices=(0, 1, 2)):
    """A triangle, a sun, two cameras, in one file."""
    positions = b"".join(struct.pack("<3f", *p) for p in points)
    data = positions + struct.pack(f"<{len(indices)}H", *indices)
    lows, highs = [min(p[i] for p in points) for i in range(3)], [max(p[i] for p in points) for i in range(3)]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 5, "name": "sun"}]}},
        "nodes": [{"mesh": 0, "name": "tri"}, {"camera": 0, "translation": [0, 0, 4]}, {"camera": 1, "translation": [0, 0, 9]},
                  {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 3]}],
        "cameras": [{"name": "front", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}},
                    {"name": "far", "type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "materials": [{"name": "gold-ish", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.7, 0.3, 1], "metallicFactor": 0, "roughnessFactor": 0.4}}],
        "meshes": [{"name": "m", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)}, {"buffer": 0, "byteOffset": len(positions), "byteLength": len(data) - len(positions)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": lows, "max": highs},
                      {"bufferView": 1, "componentType": 5123, "count": len(indices), "type": "SCALAR"}]})


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="burnish-test-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scene = self.folder / "scene.gltf"
        self.scene.write_text(scene_text())
        self.out = self.folder / "out"
        self.out.mkdir()

    def run_it(self, *arguments, **more):
        # The leak sanitizer's own tracer crashes now and then on the driver's threads when the program ends: often with OSMesa's, where leaks are not looked for (the code is the same),
        # seldom with EGL's, where the program runs once more.
        sanitized = os.environ.get("BURNISH_SANITIZED")
        if sanitized and "osmesa" in arguments:
            more["env"] = {**more.get("env", os.environ), "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"}
        for _ in range(3):
            result = subprocess.run([BURNISH, *map(str, arguments)], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL, **more)
            if not sanitized or "LeakSanitizer has encountered a fatal error" not in result.stderr:
                break
        return result

    def good(self, *arguments):
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, 0, f"{arguments}: {result.stderr}{result.stdout}")
        return result

    def bad(self, code, *arguments, says=()):
        """One clear line on standard error, nothing on standard output, the right exit code."""
        result = self.run_it(*arguments)
        self.assertEqual(result.returncode, code, f"{arguments}: {result.stderr}{result.stdout}")
        lines = [line for line in result.stderr.splitlines() if not line.startswith("burnish: warning: ")]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertRegex(lines[0], r"^burnish: .+: .+")
        self.assertEqual(result.stdout, "")
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, lines[0])
        return lines[0]


class Help(Program):
    def test_every_subcommand_has_help(self):
        whole = self.good("--help").stdout
        for name in SUBCOMMANDS:
            self.assertIn(name, whole)
            self.assertIn("--help", self.good(name, "--help").stdout)

    def test_scene_options_are_in_help(self):
        for name in "render", "plan", "reference":
            text = self.good(name, "--help").stdout
            for option in "--camera --eye --target --up --fov --time --animation --size --env --probes --exposure --quality --set --tonemap --backend --threads --json".split():
                self.assertIn(option, text)

    def test_help_costs_little(self):
        if SANITIZED:
            return
        costs = []
        for _ in range(5):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            self.good("--help")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            costs.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
        self.assertLess(min(costs), 0.050)

    def test_version(self):
        self.assertRegex(self.good("--version").stdout, r"^burnish \d+\.\d+\.\d+\n$")

    def test_nothing_asked_is_a_usage_error(self):
        result = self.run_it()
        self.assertEqual(result.returncode, 2)
        self.assertIn("render", result.stderr)


class Usage(Program):
    def test_unknown_subcommand(self):
        self.bad(2, "rendr", says=("did you mean 'render'", "doctor"))
        self.bad(2, "frobnicate", says="doctor")

    def test_unknown_option(self):
        self.bad(2, "render", self.scene, "-o", self.out / "a.png", "--tonemapp", "agx", says="did you mean '--tonemap'")
        self.bad(2, "plan", self.scene, "second.gltf", says="second.gltf")

    def test_missing_arguments(self):
        self.bad(2, "render", says="SCENE")
        self.bad(2, "render", self.scene, says="--output")
        self.bad(2, "inspect", says="FILE")

    def test_bad_values(self):
        for option, values in {"--size": ["12", "0x5", "5x", "-4x4", "99999x1", "1x1x1"], "--eye": ["1,2", "a,b,c", "1,2,nan", "1,2,3,4", ""],
                               "--fov": ["0", "180", "nan", "wide"], "--exposure": ["bright", "inf", "1e9"], "--threads": ["0", "-1", "many", "1.5"],
                               "--tonemap": ["filmic"], "--backend": ["vulkan"]}.items():
            for value in values:
                self.bad(2, "plan", self.scene, f"{option}={value}", says=option)
        self.bad(2, "render", self.scene, "-o", self.out / "a.png", "--view", "x", says=("--view", "albedo", "nonfinite"))
        self.bad(2, "render", self.scene, "-o", self.out / "a.jpg", says=(".png", ".exr"))
        self.bad(2, "render", self.scene, "-o", self.out / "a.png", "--frames", "0", says="--frames")

    def test_alternatives_are_listed(self):
        self.bad(2, "plan", self.scene, "--tonemap", "filmic", says=("neutral", "agx", "aces", "none"))
        self.bad(2, "plan", self.scene, "--backend", "vulkan", says=("egl", "osmesa", "glfw"))

    def test_rungs_by_name(self):
        self.bad(2, "plan", self.scene, "--set", "fresnl=none", says=("--set", "fresnel", "did you mean"))
        self.bad(2, "plan", self.scene, "--set", "fresnel=schlik", says=("did you mean 'schlick'", "conductor"))
        for text in "fresnel", "fresnel=", "=schlick", "":
            self.bad(2, "plan", self.scene, f"--set={text}", says="--set")
        self.bad(2, "plan", self.scene, "--quality", "best", says=("seed", "default", "exact"))

    def test_eye_and_camera_are_one_or_the_other(self):
        self.bad(2, "plan", self.scene, "--eye", "0,0,3", says="--target")
        self.bad(2, "plan", self.scene, "--eye", "0,0,3", "--target", "0,0,0", "--camera", "front", says="--camera")

    def test_negative_numbers_are_values(self):
        self.good("plan", self.scene, "--eye", "-1.5,-2,-3", "--target", "-.5,0,0", "--exposure", "-3")


class Failures(Program):
    def test_missing_files(self):
        self.bad(1, "plan", self.folder / "none.gltf", says="none.gltf")
        self.bad(1, "inspect", self.folder / "none.gltf", says="none.gltf")
        self.bad(1, "plan", self.scene, "--env", self.folder / "none.hdr", says="none.hdr")

    def test_unknown_sample_lists_samples(self):
        self.bad(1, "plan", "fpz", says=("fpz", "sample"))

    def test_unknown_camera_lists_cameras(self):
        self.bad(1, "plan", self.scene, "--camera", "fron", says=("did you mean 'front'", "far"))
        self.bad(1, "plan", self.scene, "--camera", "2", says="front")

    def test_damaged_scene(self):
        self.scene.write_text(scene_text().replace('"count": 3', '"count": 3000'))
        self.bad(1, "plan", self.scene, says=("scene.gltf", "/accessors/"))
        self.scene.write_bytes(b"\x00\xff" * 50)
        self.bad(1, "inspect", self.scene, says="scene.gltf")

    def test_no_regular_file(self):
        os.mkfifo(self.folder / "pipe.gltf")
        self.bad(1, "plan", self.folder / "pipe.gltf", says="pipe.gltf")
        self.bad(1, "inspect", self.folder / "pipe.gltf", says="pipe.gltf")
        self.bad(1, "inspect", self.folder, says=self.folder.name)
        self.bad(1, "plan", "/dev/zero", says="/dev/zero")

    def test_outputs_that_cannot_be_written(self):
        old = self.out / "old.png"
        old.write_text("precious")
        for output in self.folder / "no/such/a.png", self.out / "dir.png", pathlib.Path("/dev/full.d/a.png"):
            (self.out / "dir.png").mkdir(exist_ok=True)
            self.bad(1, "render", self.scene, "-o", output, says=output.name)
        for output in self.folder / "no/a.json", self.out, "/dev/full":
            self.bad(1, "plan", self.scene, "--json", output)
            self.bad(1, "render", self.scene, "-o", old, "--json", output)
        self.assertEqual(old.read_text(), "precious")
        self.assertEqual(sorted(p.name for p in self.out.iterdir()), ["dir.png", "old.png"])

    def test_full_standard_output(self):
        for arguments in (["--help"], ["inspect", "--substance", "gold"], ["plan", self.scene, "--json", "-"]):
            with open("/dev/full", "w") as full:
                result = subprocess.run([BURNISH, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
            self.assertEqual(result.returncode, 1)
            self.assertIn("standard output", result.stderr)

    def test_control_characters_do_not_reach_the_terminal(self):
        self.scene.write_text(scene_text().replace('"gold-ish"', json.dumps("a\x1b[31mb")))
        self.assertNotIn("\x1b", self.good("inspect", self.scene).stdout)


def moving_scene_text(animations=({"name": "slide", "shift": 1.5},)):
    """The triangle moves to the right within a second, by each animation's shift."""
    scene = json.loads(scene_text())
    data = b"".join(struct.pack("<8f", 0, 1, 0, 0, 0, a["shift"], 0, 0) for a in animations)
    scene["buffers"].append({"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()})
    scene["animations"] = []
    for i, animation in enumerate(animations):
        for offset, length, kind, count in (32 * i, 8, "SCALAR", 2), (32 * i + 8, 24, "VEC3", 2):
            scene["bufferViews"].append({"buffer": 1, "byteOffset": offset, "byteLength": length})
            scene["accessors"].append({"bufferView": len(scene["bufferViews"]) - 1, "componentType": 5126, "count": count, "type": kind})
        scene["accessors"][-2].update(min=[0], max=[1])
        scene["animations"].append({"name": animation["name"],
                                    "samplers": [{"input": len(scene["accessors"]) - 2, "output": len(scene["accessors"]) - 1}],
                                    "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]})
    return json.dumps(scene)


class Time(Program):
    def picture(self, *more):
        result = self.good("render", self.scene, "--size", "64x48", "--view", "normal", "-o", self.out / "a.png", *more)
        return (self.out / "a.png").read_bytes(), result.stderr

    def test_time_moves_and_loops(self):
        self.scene.write_text(moving_scene_text())
        rest, moved = self.picture()[0], self.picture("--time", "0.5")[0]
        self.assertEqual(rest, self.picture("--time", "0")[0])
        self.assertNotEqual(rest, moved)
        self.assertEqual(moved, self.picture("--time", "7.5")[0])
        self.assertEqual(moved, self.picture("--time", "-0.5")[0])
        self.assertIn("--time", self.good("plan", "--help").stdout)

    def test_choice_of_animations(self):
        self.scene.write_text(moving_scene_text([{"name": "slide", "shift": 1.5}, {"name": "jump", "shift": -1.5}]))
        first, said = self.picture("--time", "0.5")
        self.assertIn("not played", said)
        self.assertIn("jump", said)
        self.assertEqual(first, self.picture("--time", "0.5", "--animation", "slide")[0])
        jump, said = self.picture("--time", "0.5", "--animation", "1")
        self.assertNotEqual(first, jump)
        self.assertNotIn("not played", said)
        render = ["render", self.scene, "-o", self.out / "b.png"]
        self.bad(1, *render, "--time", "1", "--animation", "slde", says=("slde", "did you mean 'slide'"))
        self.bad(2, *render, "--animation", "slide", says="--time")
        self.bad(2, *render, "--time", "soon", says="not a time")
        self.scene.write_text(scene_text())
        self.assertIn("no animations", self.picture("--time", "1")[1])


class Inspect(Program):
    def test_animations(self):
        self.scene.write_text(moving_scene_text())
        text = self.good("inspect", self.scene).stdout
        for expected in "skins: 0", "meshes with morph targets: 0", "animations: 1", "slide: 1.000 s, 1 channels (1 translations,":
            self.assertIn(expected, text)

    def test_scene(self):
        text = self.good("inspect", self.scene).stdout
        for expected in "meshes: 1 with 1 triangles", "lights: 1", "cameras: 2", "front", "gold-ish", "dielectric", "bounds: -1.000,-1.000,0.000 to 1.000,1.000,0.000", "warnings: ":
            self.assertIn(expected, text)

    def test_named_conductor_and_anisotropy(self):
        scene = json.loads(scene_text())
        scene["extensionsUsed"].append("KHR_materials_anisotropy")
        scene["materials"][0]["extensions"] = {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 0.7853982}}
        scene["materials"][0]["extras"] = {"burnish": {"substance": "copper"}}
        self.scene.write_text(json.dumps(scene))
        text = self.good("inspect", self.scene).stdout
        for expected in "metal 100 %", "anisotropy 0.50 at 45.0°", "eta 0.224,1.041,1.295 k 3.335,2.628,2.360":
            self.assertIn(expected, text)
        scene["materials"][0]["extras"]["burnish"]["substance"] = "coper"
        self.scene.write_text(json.dumps(scene))
        text = self.good("inspect", self.scene).stdout
        self.assertIn("/materials/0/extras/burnish/substance: unknown substance 'coper' is left out (did you mean 'copper'?)", text)
        self.assertNotIn("eta", text)

    def test_substance(self):
        gold = self.good("inspect", "--substance", "Gold").stdout
        self.assertRegex(gold, r"F0: [\d.]+,[\d.]+,[\d.]+")
        self.assertRegex(gold, r"eta: 0\.358,0\.496,1\.468 .*\nk: [\d.]+,2\.255,1\.772 ")
        self.assertIn("code: 1.0000", gold)
        water = self.good("inspect", "--substance", "water").stdout
        self.assertIn("IOR: 1.33", water)
        self.assertNotIn("eta:", water)
        self.assertNotIn("\x1b", gold)
        self.bad(1, "inspect", "--substance", "golt", says=("did you mean 'gold'", "water"))

    def test_hdr_picture(self):
        file = self.folder / "sky.hdr"
        file.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([128, 64, 32, 129]) * 8)
        text = self.good("inspect", file).stdout
        self.assertIn("size: 4x2, 3 channels, float", text)
        self.assertIn("lat-long", text)
        self.assertRegex(text, r"R: 1(\.00\d*)? to 1")
        self.assertIn("not finite: 0 NaN, 0 infinite", text)

    def test_damaged_picture(self):
        file = self.folder / "bad.png"
        file.write_bytes(b"\x89PNG\r\n\x1a\n" + b"\x00" * 40)
        self.bad(1, "inspect", file, says="bad.png")


class Plan(Program):
    def test_json(self):
        self.good("plan", self.scene, "--json", self.out / "plan.json")
        plan = json.loads((self.out / "plan.json").read_text(), parse_constant=self.fail)
        self.assertEqual(list(plan), PLAN_KEYS)
        self.assertEqual(plan["schema_version"], 1)
        for effect in plan["effects"]:
            self.assertEqual(list(effect), ["name", "on", "called_by", "reason", "objects", "passes", "programs", "targets", "bytes"])
            self.assertEqual(bool(effect["passes"] or effect["targets"]) and not effect["on"], False)
            self.assertIn(effect["called_by"], ("scene", "setting"))
            self.assertTrue(effect["reason"], effect)
        self.assertTrue(any(effect["on"] for effect in plan["effects"]))
        self.assertTrue(any(not effect["on"] for effect in plan["effects"]))
        for one in plan["passes"]:
            self.assertEqual(list(one), ["name", "reads", "writes", "effects", "programs"])
            self.assertTrue(one["effects"], one)
        for target in plan["targets"]:
            self.assertEqual(list(target), ["name", "format", "layers", "bytes"])
        self.assertTrue(plan["passes"] and plan["programs"] and plan["targets"])
        self.assertEqual(sorted(p.name for p in self.out.iterdir()), ["plan.json"])

    def test_json_on_standard_output_is_alone(self):
        plan = json.loads(self.good("plan", self.scene, "--json", "-").stdout)
        self.assertEqual(list(plan), PLAN_KEYS)

    def test_text(self):
        text = self.good("plan", self.scene).stdout
        for word in "effects", "passes", "targets", "gbuffer", "camera front", "1280x720":
            self.assertIn(word, text)

    def test_link_stays_a_link(self):
        (self.out / "link.json").symlink_to(self.out / "real.json")
        self.good("plan", self.scene, "--json", self.out / "link.json")
        self.assertTrue((self.out / "link.json").is_symlink())
        self.assertIn("effects", json.loads((self.out / "real.json").read_text()))


def hdr_text(width, height, light):
    """A Radiance picture, not run-length coded; light(azimuth from -Z toward +X, polar angle) gives a colour."""
    data = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width))
    for y in range(height):
        for x in range(width):
            rgb = light(((x + 0.5) / width - 0.5) * 2 * math.pi, (y + 0.5) / height * math.pi)
            top = max(max(rgb), 1e-30)
            exponent = math.frexp(top)[1]
            scale = 256 / 2.0 ** exponent
            data += bytes([*(min(255, int(c * scale)) for c in rgb), exponent + 128])
    return bytes(data)


def read_ktx2(data):
    """{levels: [six faces of rows of texels], keys}, from the specification alone."""
    assert data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n"
    fmt, type_size, width, height, depth, layers, faces, level_count, scheme, dfd_at, dfd_len, kvd_at, kvd_len, sgd_at, sgd_len = struct.unpack_from("<13I2Q", data, 12)
    assert (width, depth, layers, faces, scheme, sgd_at, sgd_len) == (height, 0, 0, 6, 0, 0, 0)
    letter, texel = {97: ("e", 8), 109: ("f", 16)}[fmt]
    assert type_size == texel // 4
    # The descriptor: right after the level index, its own length first, and what it must say of RGBA floats.
    assert dfd_at == 80 + 24 * level_count and dfd_at % 4 == 0 and kvd_at == dfd_at + dfd_len
    words = struct.unpack_from(f"<{dfd_len // 4}I", data, dfd_at)
    assert words[0] == dfd_len == 4 + 24 + 16 * 4 and words[1] == 0 and words[2] == 2 | (24 + 64) << 16
    assert words[3] == 0x00010101 and words[4] == 0 and words[5] == texel and words[6] == 0  # RGBSDA, BT.709, linear, straight
    for c in range(4):
        bits = texel * 2
        assert words[7 + 4 * c:11 + 4 * c] == (bits * c | (bits - 1) << 16 | (0xc0 | (c if c < 3 else 15)) << 24, 0, 0xbf800000, 0x3f800000)
    keys, at = {}, kvd_at
    while at < kvd_at + kvd_len:
        length, = struct.unpack_from("<I", data, at)
        key, value = data[at + 4:at + 4 + length].split(b"\0", 1)
        assert value.endswith(b"\0")
        keys[key.decode()] = value[:-1].decode()
        at += 4 + (length + 3) // 4 * 4
    assert at == kvd_at + kvd_len and list(keys) == sorted(keys)
    levels, end = [], len(data)
    for k in range(level_count):
        offset, length, whole = struct.unpack_from("<3Q", data, 80 + 24 * k)
        size = max(width >> k, 1)
        assert length == whole == 6 * size * size * texel and offset % texel == 0 and offset + length == end
        end = offset  # the smallest level comes first
        values = struct.unpack_from(f"<{6 * size * size * 4}{letter}", data, offset)
        levels.append([[values[((f * size + y) * size) * 4:((f * size + y + 1) * size) * 4] for y in range(size)] for f in range(6)])
    assert end - (kvd_at + kvd_len) < texel
    return {"levels": levels, "keys": keys, "size": width, "half": letter == "e"}


class Prefilter(Program):
    """At faces of 16, so that all of it takes seconds."""
    def setUp(self):
        super().setUp()
        self.sky = self.folder / "sky.hdr"
        self.sky.write_bytes(hdr_text(32, 16, lambda azimuth, polar: (1.0, 0.5, 0.25)))

    def prefilter(self, out, *more, source=None):
        return self.good("prefilter", source or self.sky, "-o", self.out / out, "--size", "16", *more)

    def test_constant_in_constant_out_and_what_ktx2_says(self):
        for more, lobe in (["--half"], "blinn-phong"), (["--float", "--lobe", "ggx"], "ggx"):
            self.prefilter("a.ktx2", *more)
            cube = read_ktx2((self.out / "a.ktx2").read_bytes())
            self.assertEqual((cube["size"], cube["half"]), (16, more[0] == "--half"))
            self.assertEqual(cube["keys"]["BurnishLobe"], lobe)
            self.assertEqual(cube["keys"]["BurnishVersion"], "1")
            self.assertRegex(cube["keys"]["KTXwriter"], r"^Burnish \d+\.\d+\.\d+$")
            roughness = [float(r) for r in cube["keys"]["BurnishRoughness"].split(" ")]
            self.assertEqual(len(roughness), len(cube["levels"]))
            self.assertEqual(roughness, sorted(roughness))
            self.assertEqual(roughness[0], 0)
            for level in cube["levels"]:
                for face in level:
                    for row in face:
                        for i, value in enumerate(row):
                            self.assertAlmostEqual(value, (1, 0.5, 0.25, 1)[i % 4], delta=1e-3)

    def test_faces_look_where_they_should(self):
        # Red toward +X (to the right of the picture's centre), green up, blue toward +Z (at the picture's edges).
        self.sky.write_bytes(hdr_text(64, 32, lambda a, p: (1 + math.sin(p) * math.sin(a), 1 + math.cos(p), 1 - math.sin(p) * math.cos(a))))
        self.prefilter("a.ktx2", "--float")
        for level in read_ktx2((self.out / "a.ktx2").read_bytes())["levels"]:
            middle = [face[len(face) // 2][4 * (len(face) // 2):][:3] for face in level]
            for axis in range(3):
                self.assertGreater(middle[2 * axis][axis], 1.4)
                self.assertLess(middle[2 * axis + 1][axis], 0.6)
        # +X: columns run toward -Z, rows downward.
        face = read_ktx2((self.out / "a.ktx2").read_bytes())["levels"][0][0]
        self.assertGreater(face[8][2], face[8][4 * 15 + 2])
        self.assertGreater(face[0][4 * 8 + 1], face[15][4 * 8 + 1])

    def test_every_output_is_an_input_with_the_same_texels(self):
        self.sky.write_bytes(hdr_text(64, 32, lambda a, p: (4 + a, 1 + p, 3)))
        for name in "a.dds", "a.exr", "folder", "a.ktx2":
            self.prefilter(name, "--levels", "2")
            result = self.prefilter("again.ktx2", "--levels", "2", source=self.out / name)
            self.assertIn("is filtered already", result.stderr)
            first = read_ktx2((self.out / "again.ktx2").read_bytes())["levels"][0]
            if name == "a.dds":
                expected = first
            self.assertEqual(first, expected)
        self.assertEqual(sorted(p.name for p in (self.out / "folder").iterdir())[:2], ["level0_nx.exr", "level0_ny.exr"])
        self.prefilter("again.ktx2", "--levels", "2", source=self.out / "folder" / "level0_%s.exr")
        self.assertEqual(read_ktx2((self.out / "again.ktx2").read_bytes())["levels"][0], expected)
        faces = [self.out / "folder" / f"level0_{face}.exr" for face in ("px", "nx", "py", "ny", "pz", "nz")]
        self.good("prefilter", *faces, "-o", self.out / "again.ktx2", "--size", "16", "--levels", "2")
        self.assertEqual(read_ktx2((self.out / "again.ktx2").read_bytes())["levels"][0], expected)

    def test_same_bytes_for_any_number_of_threads(self):
        data = set()
        for threads in 1, 2, 8:
            self.prefilter("a.dds", "--threads", threads)
            data.add((self.out / "a.dds").read_bytes())
        self.assertEqual(len(data), 1)

    def test_json(self):
        self.prefilter("a.ktx2", "--levels", "2", "--json", self.out / "a.json")
        report = json.loads((self.out / "a.json").read_text(), parse_constant=self.fail)
        self.assertEqual(list(report), PREFILTER_KEYS)
        self.assertEqual((report["schema_version"], report["size"], report["lobe"], report["format"], report["warnings"]), (1, 16, "blinn-phong", "half", []))
        self.assertEqual([level["size"] for level in report["levels"]], [16, 8])
        for level in report["levels"]:
            self.assertEqual(len({"samples", "bands"} & set(level)), 1)
            self.assertEqual([key for key in level if key not in ("samples", "bands")], ["size", "roughness", "power", "ms"])
        self.assertEqual((report["levels"][0]["roughness"], report["levels"][0]["power"]), (0, None))
        second = report["levels"][1]
        self.assertAlmostEqual(second["power"], 2 / second["roughness"] ** 4 - 2, places=5)
        self.assertGreater(report["total_ms"], 0)
        result = self.prefilter("a.ktx2", "--json", "-")
        self.assertEqual(list(json.loads(result.stdout)), PREFILTER_KEYS)

    def test_check(self):
        result = self.prefilter("a.ktx2", "--check", "--json", self.out / "a.json")
        self.assertIn("holds", result.stdout)
        self.assertNotIn("FAILS", result.stdout)
        check = json.loads((self.out / "a.json").read_text())["check"]
        self.assertTrue(check["within"])
        self.assertEqual((check["rms_bound"], check["worst_bound"]), (1e-4, 1e-3))
        for level in check["levels"][1:]:
            self.assertEqual(list(level), ["size", "samples", "rms", "worst", "within"])
            self.assertGreater(level["samples"], 0)
            self.assertLessEqual(level["rms"], 1e-4)
        self.assertIsNone(check["levels"][0]["rms"])  # a lat-long picture has no texels of level 0
        self.prefilter("b.ktx2", "--check", "--float", source=self.out / "a.ktx2")

    def test_sh(self):
        self.prefilter("a.ktx2", "--sh", self.out / "sh.json")
        sh = json.loads((self.out / "sh.json").read_text())
        self.assertEqual(sh["schema_version"], 1)
        self.assertEqual(len(sh["coefficients"]), 9)
        # A constant sky: radiance L everywhere gives irradiance pi L, in the first band alone.
        for c, light in enumerate((1, 0.5, 0.25)):
            self.assertAlmostEqual(sh["coefficients"][0][c], light, delta=1e-4)
            for i in range(1, 9):
                self.assertAlmostEqual(sh["coefficients"][i][c], 0, delta=5e-3)  # texels are points: 16 rows are this far from a sphere

    def test_dering(self):
        self.sky.write_bytes(hdr_text(64, 32, lambda a, p: (1000.0 if p < 0.1 else 0.0,) * 3))

        def least(*more):
            self.prefilter("a.ktx2", "--sh", self.out / "sh.json", *more)
            sh = json.loads((self.out / "sh.json").read_text())
            self.assertEqual(sh["dering"], bool(more))
            c = [row[0] for row in sh["coefficients"]]
            values = []
            for i in range(64):
                y = 1 - 2 * (i + 0.5) / 64
                for k in range(32):
                    x, z = ((1 - y * y) ** 0.5 * f(k * math.pi / 16) for f in (math.cos, math.sin))
                    values.append(sum(a * b for a, b in zip(c, (1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y))))
            return min(values), max(values)
        low, high = least()
        self.assertLess(low, -0.03 * high)  # of 1 + 2 c + 5/4 P2(c): -0.158 at c = -8/15, 4.25 at 1
        low, high = least("--dering")
        self.assertGreater(low, -1e-3 * high)
        self.bad(2, "prefilter", self.sky, "-o", self.out / "a.dds", "--dering", says="--sh")

    def test_usage(self):
        self.bad(2, "prefilter", says="IN")
        self.bad(2, "prefilter", self.sky, says="--output")
        self.bad(2, "prefilter", self.sky, self.sky, "-o", self.out / "a.dds", says="six faces")
        self.bad(2, "prefilter", self.sky, "-o", self.out / "a.png", says=(".ktx2", ".dds", ".exr"))
        self.bad(2, "prefilter", self.sky, "-o", self.out / "a.dds", "--lobe", "phong", says=("blinn-phong", "ggx"))
        self.bad(2, "prefilter", self.sky, "-o", self.out / "a.dds", "--half", "--float", says="--float")
        for option, values in {"--size": ["0", "15", "100", "8192", "big", "-16"], "--levels": ["-1", "0", "40", "x"], "--error": ["0", "1", "nan", "x"], "--threads": ["0", "x"]}.items():
            for value in values:
                self.bad(2, "prefilter", self.sky, "-o", self.out / "a.dds", f"{option}={value}", says=option)
        self.assertEqual(list(self.out.iterdir()), [])

    def test_bad_inputs(self):
        def fails(source, says):
            self.bad(1, "prefilter", source, "-o", self.out / "a.ktx2", "--size", "16", says=says)
            self.assertEqual(list(self.out.iterdir()), [])
        fails(self.folder / "none.hdr", "none.hdr")
        fails(self.folder / "face_%s.exr", "face_%s.exr")
        fails(self.out, "no six faces")
        fails("/dev/zero", "/dev/zero")
        whole = self.sky.read_bytes()
        broken = self.folder / "broken.hdr"
        broken.write_bytes(whole[:-100])
        fails(broken, "broken.hdr")
        broken.write_bytes(b"hello, world")
        fails(broken, ("broken.hdr", "KTX2"))
        broken.write_bytes(hdr_text(7, 5, lambda a, p: (1, 1, 1)))
        fails(broken, ("broken.hdr", "7 x 5", "2:1"))
        self.prefilter("good.ktx2")
        data = (self.out / "good.ktx2").read_bytes()
        (self.out / "good.ktx2").unlink()
        cut = self.folder / "cut.ktx2"
        cut.write_bytes(data[:-1])
        fails(cut, ("cut.ktx2: byte", "damaged KTX2"))
        cut.write_bytes(data[:20] + struct.pack("<II", 1 << 28, 1 << 28) + data[28:])
        fails(cut, "cut.ktx2")

    def test_bad_texels_are_named(self):
        self.prefilter("a.ktx2", "--float", "--levels", "1")
        data = bytearray((self.out / "a.ktx2").read_bytes())
        offset, = struct.unpack_from("<Q", data, 80)
        struct.pack_into("<2f", data, offset + 16 * (16 * 16 + 2), float("nan"), -1)
        (self.folder / "bad.ktx2").write_bytes(data)
        result = self.prefilter("b.ktx2", "--levels", "2", source=self.folder / "bad.ktx2")
        self.assertRegex(result.stderr, r"warning: .*bad\.ktx2: 2 values were mended: 1 not a number and 1 negative .* level 0, face -X, column 2, row 0")
        text = self.good("inspect", self.folder / "bad.ktx2").stdout
        self.assertIn("level 0: 1 NaN, 0 infinite, 1 negative values, the first on face -X, column 2, row 0", text)

    def test_more_than_half_floats_hold(self):
        self.sky.write_bytes(hdr_text(32, 16, lambda a, p: (1e5, 1, 1)))
        self.assertRegex(self.prefilter("a.dds").stderr, r"values above 65504 \(largest 1\d\d\d\d\d|values above 65504 \(largest 1e\+05|values above 65504 \(largest 9\d\d\d\d")
        self.assertEqual(self.prefilter("a.dds", "--float").stderr, "")

    def test_outputs_that_cannot_be_written(self):
        old = self.out / "old.ktx2"
        self.prefilter("old.ktx2")
        before = old.read_bytes()
        for output in self.folder / "no/such/a.dds", self.sky / "a.dds", pathlib.Path("/proc/none.ktx2"), self.folder / "no/folder", pathlib.Path("/proc/none"):
            self.bad(1, "prefilter", self.sky, "-o", output, "--size", "16", says=str(output))
        self.bad(1, "prefilter", self.sky, "-o", self.folder, "--size", "16", says="none of the files to be replaced")
        self.bad(1, "prefilter", self.sky, "-o", old, "--size", "16", "--json", self.folder / "no/a.json", says="a.json")

        def small():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (64, 64))
        for output in old, self.out / "new.dds", self.out / "new.exr", self.out / "new":
            result = self.run_it("prefilter", old, "-o", output, "--size", "16", "--lobe", "ggx", preexec_fn=small)  # no picture: its decoder needs shared memory
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("file size limit", result.stderr)
        self.assertEqual(old.read_bytes(), before)
        self.assertEqual([p.name for p in self.out.iterdir()], ["old.ktx2"])

    def test_kill_leaves_the_old_or_the_new(self):
        """kill -9 at any moment; tests/cubemap does it thousands of times under the writer alone."""
        rounds = 60 if os.environ.get("BURNISH_LONG") == "1" else 6
        for name in "a.ktx2", "faces":
            def content():
                path = self.out / name
                return path.read_bytes() if path.is_file() else b"".join(p.name.encode() + p.read_bytes() for p in sorted(path.iterdir()))
            self.prefilter(name, "--lobe", "ggx", "--levels", "2")
            allowed = [content()]
            begin = time.monotonic()
            self.prefilter(name, "--levels", "2")
            span = time.monotonic() - begin
            allowed.append(content())
            for i in range(rounds):
                child = subprocess.Popen([BURNISH, "prefilter", self.sky, "-o", self.out / name, "--size", "16", "--levels", "2", "--lobe", ("ggx", "blinn-phong")[i % 2]],
                                         stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(span * (0.3 + 0.7 * i / rounds))
                child.kill()
                child.wait(timeout=60)
                self.assertIn(content(), allowed)

    def test_inspect(self):
        self.prefilter("a.dds", "--lobe", "ggx")
        self.prefilter("faces", "--lobe", "ggx")
        self.prefilter("a.exr", "--lobe", "ggx", "--float")
        for name, says in ("a.dds", "format: DDS cube, R16G16B16A16_FLOAT, written by Burnish"), ("faces", "format: folder with six files a level"), ("a.exr", "format: OpenEXR, levels stacked"):
            text = self.good("inspect", self.out / name).stdout
            for expected in says, "size: 16x16, 6 faces, 2 levels", "lobe: ggx", "roughness", "wrong: ":
                self.assertIn(expected, text)
            self.assertRegex(text, r"\n +0 +16 +0\.0000 +- +0\.25 +1 +0\.58\d+\n")
        self.assertIn("lobe: none", self.good("inspect", self.out / "faces" / "level0_%s.exr").stdout)

    def test_progress_and_interrupt(self):
        child = subprocess.Popen([BURNISH, "prefilter", self.sky, "-o", self.out / "a.dds", "--size", "4096"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        child.communicate(timeout=60)
        self.assertIn(child.returncode, (-signal.SIGINT, 0))
        if child.returncode != 0:
            self.assertEqual(list(self.out.iterdir()), [])


def rooms_text(intensity=(40, 40), table=(0, 0)):
    """Two closed rooms 20 m apart, with a table and a lamp that casts shadows in each, four reflection probes and a lattice through both."""
    points, normals, indices = [], [], []
    for inside in True, False:
        for face in range(6):
            n = [0, 0, 0]
            n[face // 2] = -1 if face % 2 else 1
            u = [0, 0, 0]
            u[(face // 2 + 1) % 3] = 1
            v = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]]
            first = len(points) % 24
            for s, t in (-1, -1), (1, -1), (1, 1), (-1, 1):
                points.append([n[i] + s * u[i] + t * v[i] for i in range(3)])
                normals.append([-x if inside else x for x in n])
            corners = [first, first + 1, first + 2, first, first + 2, first + 3]
            indices.append(corners[::-1] if inside else corners)
    data = struct.pack("<144f", *[x for p in points for x in p]) + struct.pack("<144f", *[x for n in normals for x in n]) + struct.pack("<72H", *[i for face in indices for i in face])
    vectors = [{"bufferView": i, "componentType": 5126, "count": 24, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]} for i in range(4)]
    counts = [{"bufferView": 4 + i, "componentType": 5123, "count": 36, "type": "SCALAR"} for i in range(2)]
    nodes = []
    for i, x in enumerate((0, 20)):
        nodes += [{"mesh": 2 * i, "name": f"room {i}", "translation": [x, 0, 0], "scale": [2, 1.5, 2]}, {"mesh": 2 * i + 1, "name": f"table {i}", "translation": [x + 0.5, -1.2, 0.3 + table[i]], "scale": [0.4, 0.3, 0.3]},
                  {"name": f"lamp {i}", "translation": [x - 0.5, 1, 0.2], "extensions": {"KHR_lights_punctual": {"light": i}}}]
        nodes += [{"name": f"probe_{i}{side}", "translation": [x + (1 if side == "b" else -1), 0, 0], "scale": [1, 1.5, 2]} for side in "ab"]
    nodes.append({"name": "lattice", "translation": [10.375, 0, 0], "scale": [11.375, 0.001, 1], "extras": {"burnish": {"probe_grid": {"counts": [14, 1, 2]}}}})
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": k, "range": 8, "extras": {"burnish": {"shadow": True}}} for k in intensity]}},
        "nodes": nodes,
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": c, "metallicFactor": 0, "roughnessFactor": r}} for c, r in (([0.8, 0.5, 0.3, 1], 0.7), ([0.5, 0.5, 0.5, 1], 0.4), ([0.2, 0.3, 0.8, 1], 0.7))],
        "meshes": [{"primitives": [{"attributes": {"POSITION": k, "NORMAL": 2 + k}, "indices": 4 + k, "material": (2 * room if k == 0 else 1)}]} for room in range(2) for k in range(2)],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
        "bufferViews": [{"buffer": 0, "byteOffset": 288 * i, "byteLength": 288} for i in range(4)] + [{"buffer": 0, "byteOffset": 1152 + 72 * i, "byteLength": 72} for i in range(2)],
        "accessors": vectors + counts})


class Bake(Program):
    """Two rooms, four probes of 16², a lattice of some free points."""
    OPTIONS = ["--size", "16", "--bounces", "3"]

    def setUp(self):
        super().setUp()
        self.rooms = self.folder / "rooms.gltf"
        self.rooms.write_text(rooms_text())
        # The leak sanitizer's tracer may crash at a program's end (run_it); a bake that runs once more finds what the first one left, so that leaks are not looked for here.
        if os.environ.get("BURNISH_SANITIZED"):
            environment = unittest.mock.patch.dict(os.environ, ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0")
            environment.start()
            self.addCleanup(environment.stop)

    def bake(self, name, *more, backend="egl"):
        return self.good("bake", self.rooms, "-o", self.out / name, *self.OPTIONS, "--backend", backend, *more)

    def report(self, name, *more):
        return json.loads(self.bake(name, *more, "--json", "-").stdout)

    def content(self, name):
        """Names and bytes of all that a folder holds."""
        root = self.out / name
        return {str(p.relative_to(root)): p.read_bytes() for p in sorted(root.rglob("*")) if p.is_file()}

    def assertSame(self, a, b):
        self.assertEqual(sorted(a), sorted(b))
        self.assertEqual([name for name in a if a[name] != b[name]], [])

    def test_bake_and_render(self):
        result = self.bake("a", "--json", self.out / "a.json")
        lines = result.stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines[:3]], ["bounce 1", "bounce 2", "bounce 3"])
        self.assertIn("estimated rest", lines[2])
        self.assertIn("4 reflection probes, a lattice of 14 x 1 x 2 points, 3 bounces", lines[-1])
        report = json.loads((self.out / "a.json").read_text())
        self.assertEqual(list(report), BAKE_KEYS)
        self.assertTrue(report["finished"])
        for bounce in report["bounces"]:
            self.assertEqual(list(bounce), ["bounce", "change", "light", "ratio", "rest", "captured", "reused"])
        self.assertEqual(report["bounces"][0]["captured"], 14)
        for key in "capture_ms", "filter_ms", "store_ms", "wall_ms":
            self.assertGreater(report[key], 0)
        text = self.good("inspect", self.out / "a").stdout
        for expected in "reflection probes: 4", "probe_0a: box of 2.00 x 3.00 x 4.00 m", "14 x 1 x 2 points", "10 of 28 free", "work folder: 3 bounces joined", "wrong: nothing":
            self.assertIn(expected, text)
        manifest = json.loads((self.out / "a" / "probes.json").read_text())
        self.assertEqual(manifest["format"], "burnish-probes")
        self.assertEqual(len(manifest["bake"]["bounces"]), 3)
        self.assertEqual(manifest["bake"]["options"]["size"], 16)
        for subcommand in (["render", "-o", self.out / "with.png", "--size", "64x36"], ["plan"]):
            self.good(subcommand[0], self.rooms, *subcommand[1:], "--probes", self.out / "a")
        self.assertTrue((self.out / "with.png").exists())

    def test_rooms_are_found(self):
        scene = json.loads(rooms_text())
        keep = [i for i, node in enumerate(scene["nodes"]) if not node["name"].startswith(("probe", "lattice"))]
        scene["scenes"][0]["nodes"] = keep
        self.rooms.write_text(json.dumps(scene))
        self.bad(1, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, says="--auto")
        self.bake("a", "--auto")
        text = self.good("inspect", self.out / "a").stdout
        self.assertIn("reflection probes: 2", text)
        self.assertIn("lattice: ", text)

    def test_files_of_a_folder_are_ktx2(self):
        self.bake("a")
        manifest = json.loads((self.out / "a" / "probes.json").read_text())
        for probe in manifest["reflections"]:
            data = (self.out / "a" / probe["file"]["name"]).read_bytes()
            self.assertEqual(len(data), probe["file"]["bytes"])
            cube = read_ktx2(data)
            self.assertEqual((cube["size"], len(cube["levels"]), cube["half"]), (16, probe["levels"], True))
            self.assertEqual(float(cube["keys"].get("BurnishScale", 1)), probe["scale"])
            most = max(v for level in cube["levels"] for face in level for row in face for i, v in enumerate(row) if i % 4 < 3)
            self.assertTrue(16384 <= most < 32768, most)
        grid = manifest["grid"]
        for key, form, width, height in ("irradiance", 106, 9 * 14, 2), ("distances", 103, 16 * 14, 16 * 2):
            data = (self.out / "a" / grid[key]["name"]).read_bytes()
            self.assertEqual(data[:12], b"\xabKTX 20\xbb\r\n\x1a\n")
            self.assertEqual(struct.unpack("<9I", data[12:48]), (form, 4, width, height, 0, 0, 1, 1, 0))
            offset, length = struct.unpack("<2Q", data[80:96])
            self.assertEqual((offset + length, length), (len(data), width * height * 4 * (3 if form == 106 else 2)))

    def test_kill_and_resume_give_the_same_bytes(self):
        rounds, partial = 50 if os.environ.get("BURNISH_LONG") == "1" else 10, 0
        for backend in "egl", "osmesa":
            begin = time.monotonic()
            self.bake("whole", backend=backend)
            span = time.monotonic() - begin
            whole = self.content("whole")
            for i in range(rounds):
                # Some moments lie before the first capture, some after the last.
                moment = random.Random(20261129 + i).uniform(0.15, 1.0) * span
                child = subprocess.Popen([BURNISH, "bake", self.rooms, "-o", self.out / "killed", *self.OPTIONS, "--backend", backend], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                time.sleep(moment)
                child.kill()
                child.wait(timeout=60)
                report = json.loads(self.bake("killed", "--resume", "--json", "-", backend=backend).stdout)
                partial += 0 < report["bounces"][0]["reused"] and 0 < sum(b["captured"] for b in report["bounces"])
                self.assertSame(self.content("killed"), whole)
                shutil.rmtree(self.out / "killed")
            shutil.rmtree(self.out / "whole")
        self.assertGreater(partial, 0, "no kill came while it was baking")

    def test_one_killed_again_and_again_gets_there(self):
        self.bake("whole")
        child, kills = None, 0
        while child is None or child.returncode != 0:
            child = subprocess.Popen([BURNISH, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            try:
                child.wait(timeout=0.6 + 0.1 * kills)
            except subprocess.TimeoutExpired:
                child.send_signal((signal.SIGKILL, signal.SIGINT, signal.SIGTERM)[kills % 3])
                kills += 1
                child.wait(timeout=60)
            child.stderr.close()
            self.assertIn(child.returncode, (0, -signal.SIGKILL, -signal.SIGINT, -signal.SIGTERM))
        self.assertSame(self.content("a"), self.content("whole"))

    def test_shards_are_one_process(self):
        for backend in "egl", "osmesa":
            self.bake("whole", backend=backend)
            for bounce in 1, 2, 3:
                self.bad(1, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--backend", backend, "--shard", "1/4", "--bounce", bounce + 1, says="bounce")
                together = [subprocess.Popen([BURNISH, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--backend", backend, "--shard", f"{i}/4", "--bounce", str(bounce)],
                                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for i in (4, 2, 1, 3)]
                for child in together:
                    out, errors = child.communicate(timeout=300)
                    self.assertEqual(child.returncode, 0, errors)
                    self.assertRegex(out, rf"bounce {bounce}, shard \d/4: \d+ captured")
                joined = self.good("bake", "--merge", self.out / "a").stdout
                self.assertIn(f"bounce {bounce}: change", joined)
                self.assertIn("finished" if bounce == 3 else f"bounce {bounce + 1} can be baked", joined)
            self.assertSame(self.content("a"), self.content("whole"))
            shutil.rmtree(self.out / "a")
            shutil.rmtree(self.out / "whole")

    def test_a_change_bakes_what_it_touches(self):
        self.bake("a")
        self.assertEqual(sum(b["captured"] for b in self.report("a", "--resume")["bounces"]), 0)
        for text, points in (rooms_text(intensity=(55, 40)), 6), (rooms_text(intensity=(55, 40), table=(0, -0.5)), 8):
            self.rooms.write_text(text)
            report = self.report("a", "--resume")
            self.assertEqual([report["bounces"][k]["captured"] for k in (0, 1)], [points] * 2)
            self.assertEqual([report["bounces"][k]["reused"] for k in (0, 1)], [14 - points] * 2)
            self.bake("fresh")
            self.assertSame(self.content("a"), self.content("fresh"))
            shutil.rmtree(self.out / "fresh")

    def test_two_bakes_into_one_folder(self):
        self.bake("whole")
        several = [subprocess.Popen([BURNISH, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--resume"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) for _ in range(4)]
        errors = [(child.communicate(timeout=300)[1], child.returncode) for child in several]
        self.assertIn(0, [code for _, code in errors])
        for text, code in errors:
            self.assertIn(code, (0, 1))
            if code == 1:
                self.assertIn("another bake is writing here", text)
        self.assertIn(1, [code for _, code in errors])
        self.assertSame(self.content("a"), self.content("whole"))

    def test_outputs_that_cannot_be_written(self):
        self.bake("a")
        old = self.content("a")
        self.bad(1, "bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, says=("holds probes already", "--resume"))
        self.rooms.write_text(rooms_text(intensity=(55, 55)))

        def set_only(content):
            return {name: data for name, data in content.items() if not name.startswith("work/")}

        def small(limit):
            return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        for limit in 1000, 10000:
            result = self.run_it("bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--resume", preexec_fn=small(limit))
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("file size limit", result.stderr)
            self.assertEqual(set_only(self.content("a")), set_only(old))
        self.good("render", self.rooms, "--probes", self.out / "a", "-o", self.out / "a.png", "--size", "16x16")
        self.bake("a", "--resume")
        self.bake("fresh")
        self.assertSame(self.content("a"), self.content("fresh"))

        def nobody():
            if os.geteuid() == 0:
                os.setgid(65534)
                os.setuid(65534)
        for path in [self.folder, self.out]:
            path.chmod(0o755)
        before = self.content("a")
        for target in "a", "new":
            result = self.run_it("bake", self.rooms, "-o", self.out / target, *self.OPTIONS, "--resume", preexec_fn=nobody) if os.geteuid() == 0 else None
            if result is None:
                (self.out / "a").chmod(0o555)
                result = self.run_it("bake", self.rooms, "-o", self.out / target, *self.OPTIONS, "--resume")
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("ermission", result.stderr)
        self.assertEqual(self.content("a"), before)
        (self.out / "a").chmod(0o755)
        self.bad(1, "bake", self.rooms, "-o", self.folder / "no" / "such", says=("such", "create"))
        self.bad(1, "bake", self.rooms, "-o", self.rooms, says="no folder")
        self.bad(1, "bake", self.rooms, "-o", self.folder, says="other things")

    def test_damage_is_noticed(self):
        self.bake("a")
        old = self.content("a")
        manifest = self.out / "a" / "probes.json"
        for data in old["probes.json"][:-100], b"", old["probes.json"].replace(b"0.25", b"0.26", 1):
            manifest.write_bytes(data)
            self.bad(1, "render", self.rooms, "--probes", self.out / "a", "-o", self.out / "a.png", says="probes.json")
            self.assertIn("probes.json", self.good("inspect", self.out / "a").stdout.split("wrong:")[1])
        manifest.write_bytes(old["probes.json"])
        for name in old:
            if name.endswith(".ktx2") and not name.startswith("work/"):
                (self.out / "a" / name).write_bytes(old[name][:-1] + bytes([old[name][-1] ^ 1]))
                self.bad(1, "plan", self.rooms, "--probes", self.out / "a", says=(name, "is damaged"))
                self.assertIn(f"{name}: is damaged", self.good("inspect", self.out / "a").stdout)
                (self.out / "a" / name).write_bytes(old[name])
        for name in old:
            if name.startswith("work/light/"):
                (self.out / "a" / name).write_bytes(old[name][:40] + bytes([old[name][40] ^ 1]) + old[name][41:])
        result = self.bake("a", "--resume")
        self.assertIn("is damaged: what it held is baked again", result.stderr)
        self.assertSame(self.content("a"), old)

    def test_inspect_says_what_is_missing(self):
        def wrong():
            return self.good("inspect", self.out / "a").stdout.split("wrong:")[1]
        self.good("bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--shard", "2/3", "--bounce", "1")
        self.assertIn("not finished: 0 bounces are baked, more are missing, of the next one shard 2/3", wrong())
        self.bad(1, "bake", "--merge", self.out / "a", says=("1/3, 3/3", "bounce 1"))
        self.bad(1, "render", self.rooms, "--probes", self.out / "a", "-o", self.out / "a.png", says="probes.json")
        self.bake("a", "--resume")
        self.assertEqual(wrong().strip(), "nothing")
        self.rooms.write_text(rooms_text(intensity=(55, 40)))
        self.good("bake", self.rooms, "-o", self.out / "a", *self.OPTIONS, "--shard", "1/3", "--bounce", "1", "--resume")
        self.assertIn("the set is outdated", wrong())

    def test_usage(self):
        for options, says in ((["--shard", "1/4"], "--bounce"), (["--bounce", "1"], "--shard"), (["--shard", "5/4", "--bounce", "1"], "1 <= I <= N"), (["--shard", "4", "--bounce", "1"], "I/N"),
                              (["--bounces", "0"], "--bounces"), (["--until", "0"], "--until"), (["--until", "0.1", "--bounces", "2"], "--until"), (["--size", "100"], "power of two"), (["--size", "64x64"], "power of two"),
                              (["--ambient-size", "4096"], "power of two"), (["--lobe", "phong"], "blinn-phong"), (["--albedo-limit", "1.5"], "--albedo-limit"), (["--camera", "x"], "--camera")):
            self.bad(2, "bake", self.rooms, "-o", self.out / "a", *options, says=says)
        self.bad(2, "bake", says="SCENE")
        self.bad(2, "bake", self.rooms, says="--output")
        self.bad(2, "bake", "--merge", self.out, self.rooms, says="--merge")
        self.bad(2, "bake", "--merge", self.out, "--resume", says="--merge")
        self.bad(1, "bake", self.scene, "-o", self.out / "a", says=("scene.gltf", "no places for probes", "--auto"))
        self.bad(1, "bake", "--merge", self.out / "none", says="holds no bake")
        self.bad(1, "render", self.scene, "-o", self.out / "a.png", "--probes", self.out / "none", says="no such folder")
        self.bad(1, "render", self.scene, "-o", self.out / "a.png", "--probes", self.out, says="probes.json")
        self.assertEqual(list(self.out.iterdir()), [])


class Doctor(Program):
    def test_doctor(self):
        # Capabilities of all backends; the hard cases once, on the one named (Stability runs them all).
        text = self.good("doctor", "--no-cases").stdout
        for word in "egl", "osmesa", "glfw", "renderer", "largest texture", "anisotropic filtering", "trial frame", "threads", "hard cases":
            self.assertIn(word, text)
        self.assertLess(len(text.splitlines()), 70)
        self.assertNotIn("glfw", self.good("doctor", "--no-cases", "--backend", "egl").stdout)

    def test_json(self):
        file = self.out / "doctor.json"
        self.good("doctor", "--no-cases", "--json", file)
        report = json.loads(file.read_text())
        self.assertEqual(list(report), ["schema_version", "program", "system", "processor", "threads", "backends"])
        names = [b["backend"] for b in report["backends"]]
        self.assertEqual(names, ["egl", "osmesa", "glfw"])
        for backend in report["backends"]:
            if not backend["usable"]:
                self.assertTrue(backend["error"])
                continue
            self.assertGreater(backend["trial"]["programs"], 3)
            self.assertGreater(backend["trial"]["frame_ms"], 0)
            self.assertEqual(backend["trial"]["nonfinite_pixels"], 0)
            self.assertEqual(backend["failed"], 0)
        self.assertEqual(json.loads(self.good("doctor", "--no-cases", "--backend", "egl", "--json", "-").stdout)["backends"][0]["backend"], "egl")

    def test_a_backend_that_is_named_must_open(self):
        environment = {**os.environ, "DISPLAY": ":987", "WAYLAND_DISPLAY": ""}
        result = self.run_it("doctor", "--backend", "glfw", "--quick", env=environment)
        self.assertEqual(result.returncode, 1)
        self.assertIn("not available", result.stdout)


class Render(Program):
    def render(self, *more, name="a.png"):
        self.good("render", self.scene, "--size", "64x48", "-o", self.out / name, *more)
        return (self.out / name).read_bytes()

    def test_png_on_both_backends(self):
        for backend in "egl", "osmesa":
            data = self.render("--backend", backend)
            self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
            self.assertEqual(struct.unpack(">II", data[16:24]), (64, 48))
            self.assertEqual(sorted(p.name for p in self.out.iterdir()), ["a.png"])

    def test_exr(self):
        self.assertEqual(self.render(name="a.exr")[:4], b"\x76\x2f\x31\x01")

    def test_two_runs_give_the_same_bytes(self):
        self.assertEqual(self.render(), self.render("--frames", "3"))

    def test_json(self):
        for mode, more in ("async", []), ("profile", ["--profile"]):
            self.render("--frames", "4", "--json", self.out / "a.json", *more)
            report = json.loads((self.out / "a.json").read_text(), parse_constant=self.fail)
            self.assertEqual(list(report), RENDER_KEYS)
            self.assertEqual((report["schema_version"], report["backend"], report["size"], report["frames"]), (1, "egl", [64, 48], 4))
            self.assertEqual(report["timing_mode"], mode)
            self.assertEqual(report["gbuffer_bytes_per_pixel"], 8)
            self.assertEqual((report["gl_errors"], report["nonfinite_pixels"]), (0, 0))
            for key in "frame_ms", "frame_cpu_ms":
                self.assertEqual(list(report[key]), ["median", "p95"])
                self.assertGreater(report[key]["p95"], 0)
            self.assertTrue(report["passes"] and report["effects"] and report["programs"])
            rows = report["plan"]["effects"]
            self.assertEqual([e["name"] for e in rows if e["on"]], report["effects"])
            geometry = next(e for e in rows if e["name"] == "geometry")
            self.assertEqual(geometry["passes"], ["gbuffer"])
            self.assertEqual(geometry["gpu_ms"], next(p for p in report["passes"] if p["name"] == "gbuffer")["gpu_ms"]["median"])
            self.assertGreater(report["texture_bytes"], 64 * 48 * 8)
            for one in report["passes"]:
                self.assertEqual(list(one), ["name", "gpu_ms", "cpu_ms"])
                self.assertIsNotNone(one["gpu_ms"]["median"], one)
                self.assertEqual(one["cpu_ms"]["median"] is not None, mode == "profile")

    def test_json_on_standard_output_is_alone(self):
        result = self.good("render", self.scene, "--size", "16x16", "-o", self.out / "a.png", "--json", "-")
        self.assertEqual(list(json.loads(result.stdout)), RENDER_KEYS)

    def test_debug_views_differ(self):
        pictures = {view: self.render("--view", view) for view in ("final", "albedo", "normal", "roughness", "substance", "depth", "position")}
        self.assertEqual(len(set(pictures.values())), len(pictures))

    def test_options_change_the_picture(self):
        plain = self.render("--exposure", "2")
        for more in (["--exposure", "4"], ["--exposure", "2", "--camera", "far"], ["--exposure", "2", "--camera", "1"], ["--exposure", "2", "--fov", "30"],
                     ["--exposure", "2", "--eye", "1,1,4", "--target", "0,0,0"], ["--exposure", "2", "--tonemap", "aces"]):
            self.assertNotEqual(plain, self.render(*more), more)
        self.assertEqual(plain, self.render("--exposure", "2", "--camera", "0"))
        self.assertEqual(plain, self.render("--exposure", "2", "--threads", "1"))

    def test_closed_standard_output(self):
        reader, writer = os.pipe()
        os.close(reader)
        result = subprocess.run([BURNISH, "render", self.scene, "--size", "16x16", "-o", self.out / "a.png"], stdout=writer, stderr=subprocess.PIPE, text=True, timeout=60)
        os.close(writer)
        self.assertEqual(result.returncode, 1)
        self.assertTrue((self.out / "a.png").exists())

    def test_interrupt_leaves_nothing_half_written(self):
        rounds = 60 if os.environ.get("BURNISH_LONG") == "1" else 8
        for i in range(rounds):
            child = subprocess.Popen([BURNISH, "render", self.scene, "--size", "512x512", "-o", self.out / "a.png", "--json", self.out / "a.json", "--frames", "1"],
                                     stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            time.sleep(0.9 * i / rounds)
            child.send_signal(signal.SIGINT)
            child.communicate(timeout=60)
            self.assertIn(child.returncode, (-signal.SIGINT, 0))
            left = sorted(p.name for p in self.out.iterdir())
            self.assertLessEqual(set(left), {"a.png", "a.json"}, "a temporary file stayed behind")
            if "a.png" in left:
                self.assertEqual((self.out / "a.png").read_bytes()[-8:-4], b"IEND")
            if "a.json" in left:
                self.assertEqual(list(json.loads((self.out / "a.json").read_text())), RENDER_KEYS)
            for name in left:
                (self.out / name).unlink()

    def test_interrupt_ends_a_long_run_at_once(self):
        child = subprocess.Popen([BURNISH, "render", self.scene, "-o", self.out / "a.png", "--frames", "100000"], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(3)
        begin = time.monotonic()
        child.send_signal(signal.SIGINT)
        _, errors = child.communicate(timeout=60)
        self.assertEqual(child.returncode, -signal.SIGINT, errors)
        self.assertLess(time.monotonic() - begin, 2)
        self.assertEqual(list(self.out.iterdir()), [])
        self.assertRegex(errors, re.compile(r"^burnish: rendering \d+/100000 \(\d+ s\)$", re.M))


class Rungs(Program):
    def listing(self):
        """{term: [(rung, in force by default, forward only)]} of --list-rungs, which needs no scene."""
        terms, term = {}, None
        for line in self.good("render", "--list-rungs").stdout.splitlines()[:-1]:
            if not line.startswith(" "):
                term = line.split(":")[0]
                terms[term] = []
            else:
                mark, name = line[2], line[4:].split()[0]
                terms[term].append((name, mark == "*", "[forward only]" in line))
        return terms

    def test_every_rung_of_the_ladders_is_listed(self):
        terms = self.listing()
        names = {term: [rung[0] for rung in rungs] for term, rungs in terms.items()}
        self.assertEqual(names["fresnel"], "none schlick spherical-gaussian dielectric conductor".split())
        self.assertEqual(names["normalization"], "none linear-fit linear-fit-8 plus-2 plus-8 exact".split())
        self.assertEqual(names["lobe"], "pow exp2 stable".split())
        self.assertEqual(names["distribution"], "blinn-phong beckmann ggx".split())
        self.assertEqual(names["geometry"], "void kelemen schlick-smith smith v-cavity".split())
        for model in "phong blinn-phong modified-phong max-phong normalized-blinn-phong cook-torrance ward ward-anisotropic ward-bounded ggx-smith".split():
            self.assertIn(model, names["specular"])
        for diffuse in "lambert lambert-fresnel coupled oren-nayar-qualitative oren-nayar oren-nayar-energy".split():
            self.assertIn(diffuse, names["diffuse"])
        self.assertEqual(names["compensation"], ["none", "multiple-scattering"])
        forward = {f"{term}={name}" for term, rungs in terms.items() for name, _, only in rungs if only}
        self.assertEqual(forward, {"fresnel=conductor"})
        for term, rungs in terms.items():
            self.assertEqual(sum(default for _, default, _ in rungs), 1, term)

    def test_set_and_presets_change_the_picture(self):
        def picture(*arguments):
            file = self.out / "a.png"
            self.good("render", self.scene, "--size", "48x48", "--exposure", "1", *arguments, "-o", file)
            return file.read_bytes()
        usual = picture()
        self.assertEqual(picture("--quality", "default"), usual)
        self.assertNotEqual(picture("--quality", "seed"), usual)
        # The last of two wins, over the preset, wherever it stands.
        self.assertEqual(picture("--set", "fresnel=none", "--set", "fresnel=schlick"), usual)
        self.assertNotEqual(picture("--set", "fresnel=none"), usual)
        self.assertEqual(picture("--set", "diffuse=lambert", "--quality", "default"), picture("--set", "diffuse=lambert"))

    def test_forward_only_and_idle_rungs_say_so(self):
        result = self.good("render", self.scene, "--size", "16x16", "-o", self.out / "a.png", "--set", "specular=ward-anisotropic", "--set", "geometry=smith", "--set", "fresnel=conductor")
        self.assertRegex(result.stderr, r"fresnel=conductor needs what the G-buffer does not hold")
        self.assertRegex(result.stderr, r"geometry=smith has no effect with specular=ward-anisotropic")
        plan = json.loads(self.good("plan", self.scene, "--set", "fresnel=conductor", "--json", "-").stdout)
        effect = next(e for e in plan["effects"] if e["name"] == "forward_reference")
        self.assertTrue(effect["on"])
        self.assertIn("fresnel=conductor", effect["reason"])
        self.assertNotIn("gbuffer_a", [t["name"] for t in plan["targets"]])

    def test_json_names_the_rungs(self):
        report = json.loads(self.good("render", self.scene, "--size", "16x16", "-o", self.out / "a.png", "--set", "geometry=smith", "--json", "-").stdout)
        self.assertEqual(report["rungs"]["geometry"], "smith")
        self.assertEqual(report["rungs"]["fresnel"], "schlick")
        self.assertEqual(set(report["rungs"]), set(self.listing()))


class Cost(Program):
    """What accuracy costs; tests/cost has the figures."""
    def cost(self, *arguments):
        return self.good("cost", self.scene, "-o", self.out, "--size", "48x32", "--rounds", "3", "--minutes", "3", "--no-choices", *arguments)

    def test_a_term_is_measured_against_ground_truth(self):
        result = self.cost("--term", "fresnel", "--term", "shadow", "--reference-spp", "4", "--json", self.folder / "copy.json")
        report = json.loads((self.out / "cost.json").read_text())
        self.assertEqual(report, json.loads((self.folder / "copy.json").read_text()))
        self.assertEqual(report["schema_version"], 1)
        self.assertLessEqual({"terms", "front", "machine", "base", "exact", "contributors", "command"}, set(report))
        self.assertEqual((report["against"], report["clock"], report["size"]), ("ground truth", "CPU time", [48, 32]))
        self.assertEqual([t["term"] for t in report["terms"]], ["fresnel"])
        self.assertIn("shadow", [i["term"] for i in report["idle"]])
        rungs = {r["rung"]: r for r in report["terms"][0]["rungs"]}
        self.assertEqual(list(rungs), ["none", "schlick", "spherical-gaussian", "dielectric"])
        for name, rung in rungs.items():
            self.assertLessEqual({"rms", "psnr", "p999", "energy", "perceptual"}, set(rung["error"]))
            self.assertGreater(rung["cpu_ms"], 0)
            self.assertLessEqual(rung["spread"]["low"], rung["cpu_ms"])
            self.assertGreaterEqual(rung["spread"]["high"], rung["cpu_ms"])
            self.assertGreater(rung["error_truth"]["rms"], 0)
            self.assertEqual(rung["error"]["rms"] == 0, name == "dielectric")
            self.assertEqual(rung["in_force"], name == "schlick")
            self.assertIn(name, result.stdout)
        self.assertIn("preset exact", result.stdout)
        self.assertTrue((self.out / "index.html").is_file())
        self.assertTrue((self.out / "reference.exr").is_file())
        # The reference is taken up again: no second one is traced.
        before = (self.out / "reference.exr").read_bytes()
        for more in ["--reference", self.out / "reference.exr"], []:
            self.cost("--term", "lobe", *more)
            self.assertEqual((self.out / "reference.exr").read_bytes(), before)
            again = json.loads((self.out / "cost.json").read_text())
            self.assertEqual((again["base"]["error"], again["reference"]["samples"]), (report["base"]["error"], 4))
        # Of another size it does not fit: another one is traced.
        self.good("cost", self.scene, "-o", self.out, "--size", "32x32", "--rounds", "3", "--no-choices", "--term", "lobe", "--reference-spp", "2")
        again = json.loads((self.out / "cost.json").read_text())
        self.assertEqual((again["size"], again["reference"]["samples"]), ([32, 32], 2))

    def test_errors(self):
        self.bad(2, "cost", self.scene, says="--output")
        self.bad(2, "cost", self.scene, "-o", self.out, "--term", "frensel", says=("frensel", "fresnel"))
        self.bad(2, "cost", self.scene, "-o", self.out, "--rounds", "1", says="--rounds")
        self.bad(2, "cost", self.scene, "-o", self.out, "--no-reference", "--reference-spp", "3", says="--reference-spp")
        self.bad(1, "cost", self.scene, "-o", self.out, "--reference", self.folder / "none.exr", says="none.exr")
        self.bad(1, "cost", self.folder / "none.gltf", "-o", self.out, says="none.gltf")
        self.bad(1, "cost", self.scene, "-o", self.scene / "in", says="in")


class Reference(Program):
    """burnish reference: files, JSON, interruption. What the light is like is test_pathtrace's."""
    def reference(self, *arguments, output="a.exr"):
        return json.loads(self.good("reference", self.scene, "-o", self.out / output, "--size", "40x30", *arguments, "--json", "-").stdout)

    def test_writes_picture_layers_and_json(self):
        report = self.reference("--spp", "20", "--seed", "7", "--bounces", "2", "--pixel", "centre", "--camera", "far", "--png", self.out / "a.png")
        self.assertEqual(list(report), ["schema_version", "file", "scene", "camera", "size", "samples", "error", "seed", "bounces", "pixel", "seconds", "interrupted", "warnings"])
        self.assertEqual([report[k] for k in ("samples", "seed", "bounces", "pixel", "camera", "size", "interrupted")], [20, 7, 2, "centre", "camera far", [40, 30], False])
        self.assertEqual(sorted(f.name for f in self.out.iterdir()), ["a.exr", "a.png"])
        # Viewers see the picture: its layers are no channels of it.
        self.assertIn("size: 40x30, 3 channels, float", self.good("inspect", self.out / "a.exr").stdout)
        header = (self.out / "a.exr").read_bytes()[:4096]
        for name in b"direct.R", b"albedo.G", b"normal.Z", b"variance.B", b"samples", b"noise", b"software", b"seed", b"camera":
            self.assertIn(name, header)

    def test_seeds_and_threads(self):
        names = ["one.exr", "two.exr", "other.exr"]
        for name, more in zip(names, (["--threads", "1"], ["--threads", "2"], ["--threads", "1", "--seed", "2"])):
            self.reference("--spp", "8", *more, output=name)
        one, two, other = ((self.out / name).read_bytes() for name in names)
        self.assertEqual(one, two)
        self.assertNotEqual(one, other)

    def test_until_error(self):
        report = self.reference("--until-error", "0.05")
        self.assertLess(report["error"], 0.05)
        self.assertGreaterEqual(report["samples"], 16)

    def test_interrupted_and_resumed(self):
        whole = self.reference("--spp", "8000", "--threads", "1", output="whole.exr")
        file = self.out / "a.exr"
        command = [BURNISH, "reference", str(self.scene), "-o", str(file), "--size", "40x30", "--threads", "1", "--spp", "8000"]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
        said = ""
        while "tracing" not in said and process.poll() is None:
            said = process.stderr.readline()
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("--resume", errors)
        self.assertTrue(file.is_file() and pathlib.Path(str(file) + ".state").is_file())
        report = self.reference("--spp", "8000", "--threads", "1", "--resume")
        self.assertEqual(report["samples"], 8000)
        self.assertLess(report["seconds"], 2 * whole["seconds"] + 1)
        self.assertEqual(file.read_bytes(), (self.out / "whole.exr").read_bytes())
        # The state stays with --resume, is of these options alone, and goes without.
        self.bad(1, "reference", self.scene, "-o", file, "--size", "40x30", "--spp", "8000", "--seed", "9", "--resume", says=("a.exr.state", "another picture"))
        self.reference("--spp", "8")
        self.assertFalse(pathlib.Path(str(file) + ".state").exists())

    def test_errors(self):
        self.bad(2, "reference", self.scene, says="--output")
        self.bad(2, "reference", self.scene, "-o", self.out / "a.png", says=".exr")
        self.bad(2, "reference", self.scene, "-o", self.out / "a.exr", "--spp", "0", says="--spp")
        self.bad(2, "reference", self.scene, "-o", self.out / "a.exr", "--until-error", "2", says="--until-error")
        self.bad(2, "reference", self.scene, "-o", self.out / "a.exr", "--pixel", "center", says=("--pixel", "did you mean 'centre'"))
        self.bad(1, "reference", self.scene, "-o", self.folder / "none" / "a.exr", says="none")
        self.bad(1, "reference", self.folder / "none.gltf", "-o", self.out / "a.exr", says="none.gltf")
        self.assertEqual(list(self.out.iterdir()), [])


class Budget(Program):
    """Quality files, and what burnish cost --budget writes."""
    def quality(self, **parts):
        file = self.folder / "q.json"
        file.write_text(json.dumps({"schema_version": 1, **parts}))
        return file

    def rungs(self, *arguments):
        return json.loads(self.good("render", self.scene, "--size", "16x16", "-o", self.out / "a.png", *arguments, "--json", "-").stdout)["rungs"]

    def test_a_quality_file_is_rendered_with(self):
        file = self.quality(base="seed", terms={"fresnel": "none"})
        rungs = self.rungs("--quality", file)
        self.assertEqual((rungs["fresnel"], rungs["geometry"], rungs["diffuse"]), ("none", "void", "lambert"))
        self.assertEqual(self.rungs("--quality", file, "--set", "fresnel=dielectric")["fresnel"], "dielectric")
        plan = json.loads(self.good("plan", self.scene, "--quality", self.quality(terms={"bloom": "scatter"}), "--json", "-").stdout)
        self.assertTrue(next(e for e in plan["effects"] if e["name"] == "bloom")["on"])

    def test_the_tone_map_of_the_file_gives_way_to_the_option(self):
        def picture(*arguments):
            file = self.out / "a.png"
            self.good("render", self.scene, "--size", "48x48", "--exposure", "1", *arguments, "-o", file)
            return file.read_bytes()
        file = self.quality(tone_map="aces")
        self.assertEqual(picture("--quality", file), picture("--tonemap", "aces"))
        self.assertEqual(picture("--quality", file, "--tonemap", "agx"), picture("--tonemap", "agx"))
        self.assertNotEqual(picture("--quality", file), picture())

    def test_presets_and_files_are_told_apart(self):
        (self.folder / "seed").write_text(json.dumps({"schema_version": 1, "terms": {"fresnel": "none"}}))
        def fresnel(name):
            result = subprocess.run([os.path.abspath(BURNISH), "render", str(self.scene), "--size", "16x16", "-o", str(self.out / "a.png"), "--quality", name, "--json", "-"],
                                    cwd=self.folder, capture_output=True, text=True, timeout=300)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)["rungs"]["fresnel"]
        self.assertEqual(fresnel("seed"), "schlick")
        self.assertEqual(fresnel("./seed"), "none")
        self.bad(2, "plan", self.scene, "--quality", "sead", says=("--quality", "did you mean 'seed'", "exact", "./sead"))

    def test_faulty_quality_files_are_one_error(self):
        self.bad(1, "plan", self.scene, "--quality", self.folder / "none.json", says="none.json")
        self.bad(1, "plan", self.scene, "--quality", self.folder, says=str(self.folder))
        file = self.quality(terms={"fresnel": "schlik"})
        for command in ["plan"], ["render", "-o", self.out / "a.png"]:
            self.bad(1, command[0], self.scene, *command[1:], "--quality", file, says=("q.json: /terms/fresnel", "did you mean 'schlick'"))
        self.assertEqual(list(self.out.iterdir()), [])
        file.write_text("{")
        self.bad(1, "plan", self.scene, "--quality", file, says=("q.json", "not JSON"))
        os.remove(file)
        os.mkfifo(file)
        self.bad(1, "plan", self.scene, "--quality", file, says="q.json")

    def test_cost_writes_the_quality_of_each_budget(self):
        out = self.folder / "cost"
        result = self.good("cost", self.scene, "-o", out, "--size", "48x48", "--no-reference", "--no-choices", "--rounds", "3", "--term", "fresnel", "--term", "diffuse",
                           "--budget", "100%", "--budget", "0.0001", "--target-error", "50%", "--budget-minutes", "0.2")
        report = json.loads((out / "cost.json").read_text())
        self.assertEqual([b["met"] for b in report["budgets"]], [True, False, True])
        self.assertAlmostEqual(report["budgets"][0]["ms"], report["base"]["ms"], delta=1e-3 * report["base"]["ms"])
        self.assertLessEqual(report["budgets"][0]["best"]["error"]["rms"], report["base"]["error"]["rms"])
        self.assertLessEqual(report["budgets"][2]["best"]["error"]["rms"], 0.5)
        self.assertIn("NOT MET", result.stdout)
        self.assertIn("--budget 100% --budget 0.0001 --target-error 50% --budget-minutes 0.2", report["command"])
        for name, budget in zip(["100_percent", "0.0001_ms", "error_0.5"], report["budgets"]):
            file = out / f"quality_{name}.json"
            self.assertIn(file.name, result.stdout)
            self.assertEqual(self.rungs("--quality", file), budget["best"]["rungs"])

    def test_budgets_are_numbers(self):
        for text in "", "fast", "0", "-3", "50%%", "%", "nan", "inf":
            self.bad(2, "cost", self.scene, "-o", self.out, f"--budget={text}", says="--budget")
            self.bad(2, "cost", self.scene, "-o", self.out, f"--target-error={text}", says="--target-error")


class Storage(Program):
    def test_scale_and_formats_reach_plan_and_picture(self):
        def targets(*arguments):
            plan = json.loads(self.good("plan", self.scene, "--size", "64x48", *arguments, "--json", "-").stdout)
            return {t["name"]: t for t in plan["targets"]}
        usual = targets()
        self.assertEqual(targets("--scale", "0.5")["depth"]["bytes"] * 4, usual["depth"]["bytes"])
        self.assertEqual(targets("--set", "normal-storage=oct-16")["gbuffer_b"]["format"], "RGBA16")
        self.assertEqual(targets("--set", "light-buffer=r11g11b10")["light"]["format"], "R11F_G11F_B10F")
        self.good("render", self.scene, "--size", "64x48", "--scale", "0.5", "-o", self.out / "half.png")
        for wrong in ("0.1", "2", "half"):
            self.bad(2, "render", self.scene, "--scale", wrong, "-o", self.out / "a.png", says=("0.25 to 1",))


class Stability(Program):
    def test_hard_cases_hold(self):
        if SANITIZED:  # tests/hard_cases runs the same table
            return
        file = self.out / "stability.json"
        result = self.good("stability", "--quick", "-o", file)
        table = json.loads(file.read_text())
        self.assertEqual(list(table), ["schema_version", "cases", "guards"])
        for row in table["cases"]:
            self.assertEqual(list(row)[:6], ["id", "case", "backend", "value", "bound", "pass"])
            self.assertTrue(row["pass"], row)
        self.assertEqual({row["backend"] for row in table["cases"]}, {"double", "float", "egl", "osmesa"})
        for row in table["guards"]:
            self.assertTrue({"name", "value", "reason", "worst_energy_loss"} <= set(row))
        self.assertIn(f"{len(table['cases'])} of {len(table['cases'])} hold", result.stdout)

    def test_chosen_cases(self):
        result = self.good("stability", "--backend", "egl", "--case", "H15", "--case", "H4", "--quick", "-o", self.out / "some.json")
        table = json.loads((self.out / "some.json").read_text())
        self.assertEqual({row["id"] for row in table["cases"]}, {"H4", "H15"})
        self.assertEqual(table["guards"], [])
        self.assertNotIn("guard ledger", result.stdout)
        self.bad(2, "stability", "--case", "H99", says=["H99", "H29"])
        self.bad(2, "stability", "--shaders", self.folder / "none")

    def test_a_planted_fault_fails_its_case(self):
        shaders = self.folder / "shaders" / "shading"
        shaders.mkdir(parents=True)
        text = (ROOT / "shaders/shading/environment.h").read_text()
        fault = text.replace("R(-16.0) * unitClamp(alpha)", "R(-16.0) * sqrt(unitClamp(alpha))")
        self.assertNotEqual(text, fault)
        (shaders / "environment.h").write_text(fault)
        result = self.run_it("stability", "--no-cpu", "--backend", "egl", "--case", "H15", "--shaders", self.folder / "shaders", "-o", self.out / "fault.json")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stdout, r"fails: 1 case: H15 \(egl\)")
        failed = [row for row in json.loads((self.out / "fault.json").read_text())["cases"] if not row["pass"]]
        self.assertIn("specular occlusion", failed[0]["case"])

    def test_a_backend_that_cannot_be_opened_fails(self):
        environment = {**os.environ, "DISPLAY": ":987", "WAYLAND_DISPLAY": ""}
        result = self.run_it("stability", "--backend", "glfw", "--no-cpu", "--no-ledger", "-o", self.out / "none.json", env=environment)
        self.assertEqual(result.returncode, 1)
        self.assertIn("FAILS", result.stdout)
        row = json.loads((self.out / "none.json").read_text())["cases"][0]
        self.assertEqual((row["id"], row["value"], row["pass"]), ("H28", None, False))

    def test_bad_output(self):
        self.bad(1, "stability", "-o", self.folder / "no" / "such.json", says="such.json")


class Sample(Program):
    def test_fps_sample(self):
        self.good("render", "fps", "--camera", "hero", "--size", "160x90", "-o", self.out / "fps.png")
        self.assertIn("hero", self.good("inspect", "fps").stdout)

    def test_chart_sample(self):
        self.good("render", "chart", "--size", "160x90", "-o", self.out / "chart.png")
        listing = self.good("inspect", "chart").stdout
        self.assertIn("gem_0.05: dielectric, F0 0.250", listing)
        self.assertIn("warnings: 0", listing)


if __name__ == "__main__":
    BURNISH = sys.argv.pop(1)
    unittest.main(argv=sys.argv, verbosity=2)
