#!/usr/bin/env python3
"""Pages of made-up cost reports: their files, read by parsers that are not ours, and the page in a browser without a network.

check_page.py WRITE_PAGE [TEST...]: WRITE_PAGE is the program that writes the pages.
"""
import csv
import html.parser
import json
import math
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import browser

PROGRAM = None
NAMES = ("full", "hostile", "empty")
SVG = "{http://www.w3.org/2000/svg}"
MOST_BYTES = 15_000_000
VOID = {"meta", "br", "input", "img", "link", "base", "hr", "col", "area", "embed", "source", "track", "wbr"}


def setUpModule():
    global FOLDER, KEEP
    KEEP = tempfile.TemporaryDirectory(prefix="burnish-page-")
    FOLDER = pathlib.Path(KEEP.name)
    done = subprocess.run([PROGRAM, FOLDER], capture_output=True, text=True, timeout=120, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{PROGRAM}: {done.stderr}")


def tearDownModule():
    KEEP.cleanup()


def plots(name, ending):
    return sorted((FOLDER / name / "plots").glob("*." + ending))


def document(name):
    def refuse(word):
        raise ValueError(f"{word} is no JSON number")
    return json.loads((FOLDER / name / "cost.json").read_bytes().decode("utf-8", "strict"), parse_constant=refuse)


class Page(html.parser.HTMLParser):
    """What a page holds: attributes that name other things, ids, tags that do not close."""
    def __init__(self, text):
        super().__init__()
        self.attributes, self.ids, self.open, self.faults, self.tags = [], [], [], [], []
        self.feed(text)
        self.faults += [f"<{tag}> is never closed" for tag in self.open]

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self.attributes += [(tag, key, value) for key, value in attrs]
        self.ids += [value for key, value in attrs if key == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> closes another one")


class Files(unittest.TestCase):
    def test_drawings_are_well_formed_and_inside(self):
        count = 0
        for name in NAMES:
            for file in plots(name, "svg"):
                root = ElementTree.parse(file).getroot()
                self.assertEqual(root.tag, SVG + "svg", file)
                _, _, width, height = map(float, root.get("viewBox").split())
                self.assertTrue(root.find(SVG + "title").text and root.find(SVG + "desc").text, file)
                self.assertEqual(list(root.iter(SVG + "script")), [], file)
                for element in root.iter():
                    for key, most in (("x", width), ("cx", width), ("x1", width), ("x2", width), ("y", height), ("cy", height), ("y1", height), ("y2", height)):
                        if element.get(key):
                            at = float(element.get(key))
                            self.assertTrue(-1 <= at <= most + 1, f"{file.name}: {key}={at} of {most} in {element.tag}")
                    self.assertFalse([k for k in element.keys() if k.startswith("on") or k.endswith("href")], file)
                count += 1
        self.assertGreater(count, 15)

    def test_every_plot_is_there_as_png_of_twice_the_size(self):
        for name in NAMES:
            self.assertEqual([p.stem for p in plots(name, "svg")], [p.stem for p in plots(name, "png")])
            for file in plots(name, "png"):
                width, height = struct.unpack(">II", file.read_bytes()[16:24])
                root = ElementTree.parse(file.with_suffix(".svg")).getroot()
                self.assertEqual((width, height), (2 * float(root.get("width")), 2 * float(root.get("height"))), file)
        for name in ("full", "empty"):
            rows = browser.png_rows((FOLDER / name / "plots" / "front.png").read_bytes(), 160)
            self.assertGreater(len({bytes(p) for row in rows for p in zip(*[iter(row)] * 3)}), 8, f"{name}: the plot is blank")

    def test_json_has_what_the_schema_names(self):
        for name in NAMES:
            d = document(name)
            self.assertEqual(d["schema_version"], 1)
            self.assertGreaterEqual(set(d), {"terms", "front", "machine", "base", "exact", "contributors", "budgets", "seconds", "command", "warnings", "idle", "size", "scene", "clock", "against"})
            for term in d["terms"]:
                for rung in term["rungs"]:
                    self.assertGreaterEqual(set(rung), {"rung", "cpu_ms", "spread", "error", "error_truth", "error_exact_rest", "dominated", "in_force", "note"})
                    if rung["error"]:
                        self.assertGreaterEqual(set(rung["error"]), {"rms", "psnr", "p999", "energy", "perceptual"})
            for point in d["front"]:
                self.assertGreaterEqual(set(point), {"settings", "ms", "error"})
        self.assertEqual([t["term"] for t in document("full")["terms"]][:2], ["geometry", "fresnel"])
        self.assertIsNone(document("full")["terms"][0]["rungs"][-1]["error"]["psnr"], "equal pictures: infinite, hence null")
        self.assertIn("seed", [p["preset"] for p in document("full")["front"]])

    def test_csv_is_read_back_and_holds_what_json_holds(self):
        for name in NAMES:
            text = (FOLDER / name / "cost.csv").read_bytes().decode("utf-8", "strict")
            self.assertEqual(text.count("\n"), text.count("\r\n"), "RFC 4180: lines end with CR LF")
            rows = list(csv.DictReader(text.splitlines(keepends=True), strict=True))
            rungs = [(t, r) for t in document(name)["terms"] for r in t["rungs"]]
            self.assertEqual(len(rows), len(rungs))
            for row, (term, rung) in zip(rows, rungs):
                self.assertNotIn(None, row, "a row has more cells than the header")
                for key, expected in (("term", term["term"]), ("rung", rung["rung"]), ("note", rung["note"])):
                    self.assertEqual(row[key].removeprefix("'"), expected.removeprefix("'"))
                    self.assertNotRegex(row[key], r"^\s*[=+\-@|%]", "a spreadsheet would take it for a formula")
                for key, value in (("pass_median_ms", rung["cpu_ms"]), ("exact_rms", (rung["error"] or {}).get("rms"))):
                    self.assertEqual(float(row[key]) if row[key] else None, value)

    def test_pages_are_whole_and_fetch_nothing(self):
        for name in NAMES:
            text = (FOLDER / name / "index.html").read_text("utf-8", "strict")
            self.assertLess(len(text.encode()), MOST_BYTES)
            page = Page(text)
            self.assertEqual(page.faults, [], name)
            self.assertEqual(len(page.ids), len(set(page.ids)), name)
            self.assertEqual([t for t, _ in page.tags if t in ("link", "img", "iframe", "object", "embed", "base", "form", "audio", "video")], [], name)
            self.assertEqual([t for t, _ in page.tags].count("script"), 1)
            for tag, key, value in page.attributes:
                self.assertFalse(key.startswith("on"), f"{name}: {key}={value!r}")
                if key in ("src", "href", "xlink:href", "action", "data", "srcset"):
                    self.assertRegex(value, r"^(#[\w-]+$|data:image/png;base64,[A-Za-z0-9+/]+=*$)", f"{name}: <{tag} {key}>")
                    if value.startswith("#"):
                        self.assertIn(value[1:], page.ids, f"{name}: {value} leads nowhere")
                if key in ("aria-labelledby", "aria-describedby"):
                    for part in value.split():
                        self.assertIn(part, page.ids)
            self.assertNotRegex(text.split("</style>")[0], r"url\(|@import", name)
            for tag, attributes in page.tags:
                if attributes.get("role") in ("img", "region"):
                    self.assertTrue(attributes.get("aria-label") or attributes.get("aria-labelledby"), f"{name}: <{tag}> has no name")
            # The script's own strings aside, nothing hostile is markup.
            self.assertNotIn("<script>throw", text)

    def test_pictures_of_the_page_are_pictures(self):
        text = (FOLDER / "full" / "index.html").read_text()
        found = re.findall(r'<image id="p\d+" width="(\d+)" height="(\d+)" href="data:image/png;base64,([^"]+)"', text)
        self.assertGreater(len(found), 40)
        import base64
        for width, height, data in found:
            self.assertEqual(struct.unpack(">II", base64.b64decode(data, validate=True)[16:24]), (int(width), int(height)))


class InTheBrowser(unittest.TestCase):
    def test_the_judge_sees_planted_faults(self):
        with tempfile.TemporaryDirectory() as folder:
            bad = pathlib.Path(folder) / "bad.html"
            bad.write_text("<!DOCTYPE html><body><svg class=plot viewBox='0 0 100 20' width=100 height=20><text x=60 y=15>far too long for it</text></svg><div style='width:2000px'>wide</div>"
                           "<script>console.error('planted');fetch('http://planted.invalid/x').catch(function(){})</script>")
            seen = browser.look([("bad", bad, 500, {})])
            self.assertTrue(any("planted" in line for line in seen.console), seen.console)
            self.assertTrue(any("planted.invalid" in line for line in seen.requests), seen.requests)
            self.assertTrue(seen.results["bad"]["outside"])
            self.assertGreater(seen.results["bad"]["sideways"], 1000)

    def judge(self, name, result):
        self.assertLessEqual(result["sideways"], 1, f"{name}: the page scrolls sideways")
        self.assertEqual(result["outside"], [], f"{name}: text leaves its plot")
        self.assertEqual(result["collisions"], [], f"{name}: texts of a plot lie on each other")
        self.assertEqual(result["spilled"], [], f"{name}: text leaves its box")
        self.assertEqual(result["flat"], [], f"{name}: plots or pictures without a size")
        self.assertGreaterEqual(result["contrast"], 4.5, f"{name}: text is too faint")

    def test_layout_in_both_themes_wide_and_narrow(self):
        frames = []
        for name in NAMES:
            page = FOLDER / name / "index.html"
            frames += [(f"{name} {theme} {width}", page, width, {"theme": theme}) for theme, width in (("light", 1280), ("dark", 360))]
        frames.append(("full dark 768", FOLDER / "full" / "index.html", 768, {"theme": "dark"}))
        seen = browser.look(frames)
        self.assertEqual(seen.console, [])
        self.assertEqual(seen.requests, [])
        self.assertEqual(set(seen.results), {f[0] for f in frames})
        for name, result in seen.results.items():
            self.judge(name, result)
            self.assertNotIn("owned", result["title"] if "hostile" not in name else result["title"].split(":")[0][:5], name)
        full = seen.results["full light 1280"]
        self.assertGreaterEqual(full["plots"], 9)
        self.assertGreater(full["pictures"], 60)
        self.assertEqual(full["opened"], full["details"])
        self.assertEqual(full["theme"], ["light", "dark"], "the button turns the theme")
        self.assertTrue(full["tip"].startswith("on the front") or "ms" in full["tip"], full["tip"])
        self.assertTrue(full["flipped"], "a click shows the other picture")
        self.assertTrue(full["wiped"], "the slider uncovers the other picture")

    def test_screenshots_are_light_and_dark_as_the_system_asks(self):
        page = FOLDER / "full" / "index.html"
        brightness = {}
        for dark in (False, True):
            rows = browser.png_rows(browser.screenshot(page, 900, 1000, dark), 700)
            pixels = [sum(row[i:i + 3]) / 765 for row in rows[::7] for i in range(0, len(row) - 2, 3 * 11)]
            brightness[dark] = sum(pixels) / len(pixels)
            self.assertGreater(math.sqrt(sum((p - brightness[dark]) ** 2 for p in pixels) / len(pixels)), 0.05, "the picture is empty")
        self.assertGreater(brightness[False], 0.75)
        self.assertLess(brightness[True], 0.25)

    def test_whole_without_script(self):
        seen = browser.look([("plain", FOLDER / "full" / "index.html", 1280, {"scriptless": True})])
        result = seen.results["plain"]
        self.judge("without script", result)
        self.assertEqual(result["buttons"], 0, "buttons that need the script stay hidden")
        self.assertGreaterEqual(result["plots"], 9)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit(__doc__)
    PROGRAM = sys.argv.pop(1)
    unittest.main(verbosity=2)
