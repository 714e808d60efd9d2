#!/usr/bin/env python3
"""burnish view, driven as its users drive it: test_view.py BURNISH [unittest arguments], under an X server (xvfb-run -a)."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy

import png
import scene
import x11

BURNISH = ""
SIZE = (640, 360)       # of the window
SIDEBAR = 320           # half of it: the sidebar never takes more
PICTURE = (320, 360)
FIXED = ("--exposure", "1")
PATIENCE = 60           # seconds: a machine with other work takes ten times as long now and then
LABELS = 34             # rows at the top of a pane that its label may cover
ENVIRONMENT = {**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"}
if os.environ.get("BURNISH_SANITIZED") == "1":
    ENVIRONMENT["ASAN_OPTIONS"] = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"  # Xlib and the driver keep what they have


def without_progress(words):
    """Standard error less what a busy machine adds: "burnish: opening the window (1 s)"."""
    return "".join(line for line in words.splitlines(True) if not re.match(r"burnish: .* \(\d+ s\)$", line))


def linear(picture):
    """sRGB decoded, 0 to 1, and how wide a step of 8 bits is there."""
    decode = lambda v: numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)
    return decode(picture / 255), decode((picture + 1) / 255) - decode(picture / 255)


class View(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="burnish-view-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.scene = cls.folder / "scene.gltf"
        cls.scene.write_text(scene.text())
        cls.rendered = {}

    def run_it(self, *arguments, **more):
        return subprocess.run([BURNISH, *map(str, arguments)], capture_output=True, text=True, timeout=120, stdin=subprocess.DEVNULL, cwd=self.folder, **{"env": ENVIRONMENT, **more})

    def view(self, *arguments, frames=2, size=SIZE):
        """The window's picture and what was printed."""
        file = self.folder / "window.png"
        result = self.run_it("view", self.scene, "--size", "%dx%d" % size, "--frames", frames, "--screenshot", file, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(without_progress(result.stderr), "")
        picture = png.read(file)
        self.assertEqual(picture.shape, (size[1], size[0], 3))
        return picture, result.stdout

    def render(self, *arguments, size=PICTURE):
        key = (arguments, size)
        if key not in self.rendered:
            file = self.folder / "rendered.png"
            result = self.run_it("render", self.scene, "--size", "%dx%d" % size, "-o", file, *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.rendered[key] = png.read(file)
        return self.rendered[key]

    def assertSame(self, a, b):
        """Software rendering differs by 1/255 between contexts, by more in pixels at edges."""
        gap = numpy.abs(a - b).max(axis=2)
        self.assertLess((gap > 1).mean(), 0.002)
        self.assertLess((gap > 8).mean(), 0.0005)

    def assertDifferent(self, a, b, share=0.01):
        self.assertGreater((numpy.abs(a - b).max(axis=2) > 4).mean(), share)


class Pictures(View):
    def test_the_window_shows_the_renders_picture(self):
        expected = self.render()
        self.assertGreater(expected.std(), 20)
        for backend in "glfw", "egl":
            with self.subTest(backend):
                window, words = self.view("--backend", backend)
                self.assertSame(window[:, :PICTURE[0]], expected)
                self.assertIn("pictures 320x360", words)
        self.assertDifferent(expected, self.render("--camera", "far"))
        self.assertSame(self.view("--camera", "far")[0][:, :PICTURE[0]], self.render("--camera", "far"))

    def test_the_sidebar_can_go(self):
        self.assertSame(self.view("--panel", "none")[0], self.render(size=SIZE))

    def test_debug_views_and_time(self):
        self.assertSame(self.view("--view", "normal", "--time", "1")[0][:, :PICTURE[0]], self.render("--view", "normal", "--time", "1"))

    def test_every_panel_shows_something_of_its_own(self):
        seen = {}
        for name in "picture", "quality", "times", "plan", "compare", "keys":
            seen[name] = self.view("--panel", name, frames=3)[0][:, PICTURE[0]:]
            self.assertGreater((seen[name].max(axis=2) > 120).mean(), 0.01, name)  # text
            for other, picture in seen.items():
                if other != name:
                    self.assertDifferent(seen[name], picture)

    def test_text_grows_with_the_scale(self):
        """Bright pixels of the same panel: letters of twice the height."""
        small, large = [self.view("--panel", "keys", "--ui-scale", scale, size=(1000, 900))[0] for scale in ("0.75", "1.25")]
        self.assertGreater((large[:, 513:].max(axis=2) > 120).sum(), 1.5 * (small[:, 1000 - 292:].max(axis=2) > 120).sum())


class Comparison(View):
    RUNG = "specular=phong"

    def test_split_screen(self):
        window, words = self.view("--split", self.RUNG, *FIXED, frames=8)
        a, b = self.render(*FIXED), self.render(*FIXED, "--set", self.RUNG)
        self.assertDifferent(a, b)
        half, line, rows = PICTURE[0] // 2, 5, slice(LABELS, None)
        self.assertSame(window[rows, :half - line], a[rows, :half - line])
        self.assertSame(window[rows, half + line:PICTURE[0]], b[rows, half + line:])
        self.assertIn(f"B: {self.RUNG}", words)
        self.assertIn("passes that differ: lighting", words)
        self.assertRegex(words, r"frame: A [\d.]+ \[[\d.]+, [\d.]+\] ms, B [\d.]+ \[")
        self.assertRegex(words, r"of 5 pairs")  # 8 frames: the first develops, two more go unmeasured

    def heat(self, *arguments):
        """Panes of A, B and the map without their labels, and the words."""
        window, words = self.view("--heat", *FIXED, *arguments, frames=3)
        w, h = PICTURE[0] // 2, PICTURE[1] // 2
        return window[LABELS:h, :w], window[LABELS:h, w:2 * w], window[h + LABELS:2 * h, :w], words

    def test_a_quality_does_not_differ_from_itself(self):
        a, b, heat, words = self.heat()
        self.assertSame(a, b)
        self.assertGreater(a.std(), 20)
        self.assertEqual(heat.max(), 0)
        self.assertIn("the plans are the same", words)
        self.assertIn("rms of B - A: 0 %", words)

    def test_heat_is_where_they_differ(self):
        a, b, heat, words = self.heat("--split", self.RUNG)
        self.assertSame(a, self.render(*FIXED, size=(160, 180))[LABELS:])
        gap, warm = numpy.abs(a - b).max(axis=2), heat.max(axis=2) > 0
        self.assertTrue(warm[gap > 1].all())
        # The background is the same with any rung.
        depth = self.render("--view", "albedo", *FIXED, size=(160, 180))[LABELS:].max(axis=2)
        self.assertGreater((depth == 0).sum(), 100)
        self.assertFalse(warm[depth == 0].any())
        # More difference is lighter: the tenth with the largest one against the tenth with the least.
        light, order = heat.sum(axis=2)[warm], numpy.argsort(gap[warm], kind="stable")
        tenth = len(order) // 10
        self.assertGreater(light[order[-tenth:]].mean(), 1.5 * light[order[:tenth]].mean())
        self.assertRegex(words, r"rms of B - A: [1-9][\d.]* %")
        self.assertRegex(words, r"pixels over 0.01 of white: [\d.]+ %")

    def test_figures_follow_from_the_pictures(self):
        """Without a tone map, and dark enough that nothing is clipped, the 8-bit pictures hold linear radiance over white, each to a step."""
        dark = ("--exposure", "4", "--tonemap", "none")
        words = self.view("--heat", "--split", self.RUNG, *dark, frames=3)[1]
        (a, step_a), (b, step_b) = [linear(self.render(*dark, *more, size=(160, 180))) for more in ((), ("--set", self.RUNG))]
        self.assertLess(max(a.max(), b.max()), 1)
        root = lambda x: numpy.sqrt((x ** 2).mean())
        rms = float(re.search(r"rms of B - A: ([\d.]+) %", words).group(1)) / 100
        self.assertGreater(rms, 0.02)
        self.assertAlmostEqual(rms, root(b - a) / root(a), delta=(root(step_a) + root(step_b)) / root(a))
        energy = float(re.search(r"B's energy: ([-+\d.]+) %", words).group(1)) / 100
        self.assertAlmostEqual(energy, b.sum() / a.sum() - 1, delta=(step_a.sum() + step_b.sum()) / a.sum())
        over = float(re.search(r"white: ([\d.]+) %", words).group(1)) / 100
        self.assertGreaterEqual(over, ((numpy.abs(b - a) - step_a - step_b).max(axis=2) > 0.01).mean() - 1e-3)
        self.assertLessEqual(over, ((numpy.abs(b - a) + step_a + step_b).max(axis=2) > 0.01).mean() + 1e-3)

    def test_presets_and_words_that_are_none(self):
        self.assertIn("B: seed, diffuse=lambert", self.view("--split", "seed", "--split", "diffuse=lambert")[1])
        quality = self.folder / "phong.json"
        quality.write_text('{"schema_version": 1, "base": "default", "terms": {"specular": "phong"}}')
        self.assertIn("rms of B - A: 0 %", self.view("--split", quality, "--set", self.RUNG)[1])
        self.assertNotIn("rms of B - A: 0 %", self.view("--split", quality)[1])
        result = self.run_it("view", self.scene, "--split", "specular=pong")
        self.assertEqual(result.returncode, 2)
        self.assertIn("phong", result.stderr)


class Live(View):
    def setUp(self):
        self.x = x11.Display()
        self.addCleanup(self.x.close)

    def start(self, *arguments):
        program = subprocess.Popen([BURNISH, "view", str(self.scene), "--size", "%dx%d" % SIZE, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=self.folder, env=ENVIRONMENT)
        self.addCleanup(lambda: (program.kill(), program.wait(), program.stdout.close(), program.stderr.close()))
        window = self.x.find("burnish - ")
        self.x.focus(window)
        time.sleep(0.3)
        return program, window

    def eye(self, program, window):
        self.x.key(window, "p")
        line = program.stdout.readline()
        numbers = re.match(r"--eye ([-\d.e]+),([-\d.e]+),([-\d.e]+) --target ([-\d.e]+),([-\d.e]+),([-\d.e]+)", line)
        self.assertTrue(numbers, line)
        values = numpy.array([float(n) for n in numbers.groups()])
        return values[:3], values[3:] - values[:3]

    def saved(self, window):
        before = set(self.folder.glob("burnish-*.png"))
        self.x.key(window, "F12")
        for _ in range(10 * PATIENCE):
            new = set(self.folder.glob("burnish-*.png")) - before
            if new:
                return png.read(new.pop())
            time.sleep(0.1)
        self.fail("F12 saved nothing")

    def soon(self, holds):
        """Tries until this holds: a machine with other work may take seconds for what was asked before."""
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                return holds()
            except AssertionError:
                if time.monotonic() > deadline:
                    raise

    def assertShows(self, window, expected):
        self.soon(lambda: self.assertSame(self.saved(window), expected))

    def ended(self, program, code):
        self.assertEqual(program.wait(timeout=PATIENCE), code)
        self.assertEqual(without_progress(program.stderr.read()), "")

    def test_keys_mouse_and_closing(self):
        program, window = self.start(*FIXED)
        eye, forward = self.eye(program, window)
        numpy.testing.assert_allclose(eye, [0, 0.5, 5], atol=1e-4)
        self.x.press(window, "w")
        self.soon(lambda: self.assertGreater((self.eye(program, window)[0] - eye) @ forward, 0.05))
        self.x.release(window, "w")
        moved, direction = self.eye(program, window)
        way = moved - eye
        numpy.testing.assert_allclose(way / numpy.linalg.norm(way), forward, atol=1e-3)
        numpy.testing.assert_allclose(direction, forward, atol=1e-3)
        self.x.key(window, "2")
        numpy.testing.assert_allclose(self.eye(program, window)[0], [1, 2, 8], atol=1e-4)
        self.x.drag(window, (100, 150), (160, 150), button=3)
        self.soon(lambda: self.assertGreater(self.eye(program, window)[1][0], 0.05))  # the mouse went right
        self.assertAlmostEqual(self.eye(program, window)[1][1], 0, delta=1e-3)
        self.x.key(window, "1")
        self.x.key(window, "Tab")
        self.assertShows(window, self.render(*FIXED, size=SIZE))
        self.x.delete(window)
        self.ended(program, 0)

    def test_pictures_of_the_same_second_are_all_kept(self):
        program, window = self.start("--panel", "none", *FIXED)
        for _ in range(8):  # each waits for a file that was not there
            self.saved(window)
        self.x.delete(window)
        self.ended(program, 0)

    def test_the_line_between_a_and_b_moves(self):
        program, window = self.start("--split", Comparison.RUNG, *FIXED)
        self.x.drag(window, (160, 100), (80, 100))
        a, b = self.render(*FIXED), self.render(*FIXED, "--set", Comparison.RUNG)

        def moved():
            picture = self.saved(window)
            self.assertSame(picture[:, :78], a[:, :78])
            self.assertSame(picture[:, 82:], b[:, 82:])
        self.soon(moved)
        program.send_signal(signal.SIGINT)
        self.ended(program, -signal.SIGINT)

    def test_the_quality_is_saved_and_loaded(self):
        file = self.folder / "quality.json"
        file.unlink(missing_ok=True)
        self.addCleanup(file.unlink, missing_ok=True)
        rungs = ("--set", "fresnel=none", "--set", "diffuse=lambert")
        program, window = self.start("--panel", "none", *rungs, *FIXED)
        self.x.control(window, "s", pause=0)
        deadline = time.monotonic() + PATIENCE
        while not file.exists():
            self.assertLess(time.monotonic(), deadline, "Ctrl S saved nothing")
            time.sleep(0.1)
        self.assertShows(window, self.render(*rungs, *FIXED, size=SIZE))
        self.assertSame(self.render("--quality", "./quality.json", *FIXED, size=SIZE), self.render(*rungs, *FIXED, size=SIZE))
        # Another one is taken up, one that is none is not.
        other = json.loads(file.read_text())
        other["terms"]["fresnel"], other["terms"]["diffuse"] = "schlick", "coupled-fit"
        file.write_text(json.dumps(other))
        self.x.control(window, "o")
        self.assertShows(window, self.render(*FIXED, size=SIZE))
        file.write_text("{}")
        self.x.control(window, "o")
        time.sleep(0.5)
        self.assertSame(self.saved(window), self.render(*FIXED, size=SIZE))
        self.x.delete(window)
        self.ended(program, 0)

    def test_light_from_probes_goes_and_comes_back(self):
        result = self.run_it("bake", self.scene, "-o", "probes", "--size", "16", "--bounces", "1", "--backend", "egl")
        self.assertEqual(result.returncode, 0, result.stderr)
        program, window = self.start("--panel", "none", "--probes", "probes", *FIXED)
        lit, unlit = self.render("--probes", "probes", *FIXED, size=SIZE), self.render(*FIXED, size=SIZE)
        self.assertDifferent(lit, unlit)
        self.assertSame(self.saved(window), lit)
        for picture in unlit, lit:
            self.x.key(window, "l")
            self.assertShows(window, picture)
        self.x.delete(window)
        self.ended(program, 0)

    def test_it_rests_when_nothing_changes(self):
        program, window = self.start()

        def cpu():
            fields = pathlib.Path(f"/proc/{program.pid}/stat").read_text().rsplit(")", 1)[1].split()
            return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        deadline = time.monotonic() + PATIENCE
        while True:  # until the picture is drawn and timed
            before = cpu()
            time.sleep(1)
            if cpu() - before < 0.02:
                break
            self.assertLess(time.monotonic(), deadline, "it never rests")
        self.x.key(window, "v")  # and wakes up again
        self.soon(lambda: self.assertGreater(cpu() - before, 0.02))
        self.x.delete(window)
        self.ended(program, 0)

    def test_playing_moves_the_ball(self):
        program, window = self.start("--panel", "none", *FIXED)
        still = self.saved(window)
        self.x.key(window, "space", 0.05)
        time.sleep(0.7)
        self.x.key(window, "space", 0.05)
        time.sleep(0.5)
        self.soon(lambda: self.assertDifferent(self.saved(window), still))
        self.x.delete(window)
        self.ended(program, 0)


class Refusals(View):
    def bad(self, code, *arguments, says, **more):
        result = self.run_it("view", *arguments, **more)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(without_progress(result.stderr).splitlines()), 1, result.stderr)
        self.assertIn(says, result.stderr)

    def test_no_display(self):
        blind = {name: value for name, value in ENVIRONMENT.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
        self.bad(1, self.scene, says="xvfb-run", env=blind)
        self.bad(1, self.scene, says="DISPLAY", env={**blind, "DISPLAY": ":987"})

    def test_usage(self):
        self.bad(2, self.scene, "--backend", "osmesa", says="osmesa has no window")
        self.bad(2, self.scene, "--panel", "plans", says="did you mean 'plan'")
        self.bad(2, self.scene, "--frames", "2", "--screenshot", "a.jpg", says=".png")
        self.bad(2, self.scene, "--screenshot", "a.png", says="--frames")
        self.bad(1, self.scene, "--frames", "2", "--screenshot", "nowhere/a.png", says="nowhere")


if __name__ == "__main__":
    connection = x11.Display()  # the server starts anew when its last client goes, and refuses others meanwhile
    BURNISH = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
