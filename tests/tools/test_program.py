#!/usr/bin/env python3
"""The burnish program, driven as a user drives it: test_program.py BURNISH [unittest arguments]."""
import base64
import json
import os
import pathlib
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

BURNISH = ""
SUBCOMMANDS = ["render", "plan", "inspect", "doctor", "stability"]
SANITIZED = os.environ.get("BURNISH_SANITIZED") == "1"
RENDER_KEYS = ["schema_version", "backend", "renderer", "size", "frames", "timing_mode", "frame_ms", "frame_cpu_ms", "passes", "effects", "programs",
               "plan", "gbuffer_bytes_per_pixel", "texture_bytes", "nonfinite_pixels", "gl_errors", "warnings", "rungs"]
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
        return subprocess.run([BURNISH, *map(str, arguments)], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL, **more)

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
        for name in "render", "plan":
            text = self.good(name, "--help").stdout
            for option in "--camera --eye --target --up --fov --time --animation --size --env --exposure --quality --set --tonemap --backend --threads --json".split():
                self.assertIn(option, text)

    def test_what_does_not_work_yet_is_not_in_help(self):
        texts = "".join(self.good(*words, "--help").stdout for words in [[]] + [[name] for name in SUBCOMMANDS])
        for later in "--probes bake prefilter reference".split():
            self.assertNotRegex(texts, rf"(?<![\w-]){later}(?![\w-])")

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


class Doctor(Program):
    def test_doctor(self):
        text = self.good("doctor").stdout
        for word in "egl", "osmesa", "glfw", "renderer", "largest texture":
            self.assertIn(word, text)
        self.assertNotIn("glfw", self.good("doctor", "--backend", "egl").stdout)


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


class Stability(Program):
    def test_hard_cases_hold(self):
        if SANITIZED:  # tests/hard_cases runs the same table
            return
        file = self.out / "stability.json"
        result = self.good("stability", "-o", file)
        table = json.loads(file.read_text())
        self.assertEqual(list(table), ["schema_version", "cases", "guards"])
        for row in table["cases"]:
            self.assertEqual(list(row)[:6], ["id", "case", "backend", "value", "bound", "pass"])
            self.assertTrue(row["pass"], row)
        self.assertEqual({row["backend"] for row in table["cases"]}, {"double", "float", "egl", "osmesa"})
        for row in table["guards"]:
            self.assertTrue({"name", "value", "reason", "worst_energy_loss"} <= set(row))
        self.assertIn(f"{len(table['cases'])} of {len(table['cases'])} hold", result.stdout)

    def test_a_backend_that_cannot_be_opened_fails(self):
        environment = {**os.environ, "DISPLAY": ":987", "WAYLAND_DISPLAY": ""}
        result = self.run_it("stability", "--backend", "glfw", "--no-ledger", env=environment)
        self.assertEqual(result.returncode, 1)
        self.assertIn("FAILS", result.stdout)

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
