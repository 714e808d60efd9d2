#!/usr/bin/env python3
"""The bake bench: what baking a scene's probes costs, its split over capture, filter and storage, and what the baked light costs a frame.

    bake_bench.py [--build DIR] [--scene fps] [--size 128] [--ambient-size 16] [--until 0.01] [--auto] [--frames 9] [--rounds 3] [--camera NAME] [--picture 1280x720] [--keep DIR]

One bake into an empty folder; then frames with and without its probes, alternating (medians over the rounds of CPU ms of all passes). Prints Markdown. docs/benchmarks.md has figures.
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))


def run(command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit("%s\n%s" % (" ".join(command), done.stderr))
    return done


def bake(args, folder):
    report = folder + ".json"
    command = [args.program, "bake", args.scene, "-o", folder, "--size", str(args.size), "--ambient-size", str(args.ambient_size), "--until", str(args.until), "--json", report]
    run(command + (["--auto"] if args.auto else []))
    with open(report, encoding="utf-8") as file:
        return json.load(file)


def frame(args, probes, report):
    """CPU ms of each pass of a frame, and the renderer's name."""
    command = [args.program, "render", args.scene, "--size", args.picture, "--frames", str(args.frames), "--profile", "--json", report, "-o", report[:-5] + ".png"]
    if args.camera:
        command += ["--camera", args.camera]
    if probes:
        command += ["--probes", probes]
    run(command)
    with open(report, encoding="utf-8") as file:
        data = json.load(file)
    if data["gl_errors"] or data["nonfinite_pixels"]:
        sys.exit("%d GL errors, %d pixels not finite" % (data["gl_errors"], data["nonfinite_pixels"]))
    return {p["name"]: p["cpu_ms"]["median"] for p in data["passes"]}, data["renderer"]


def spread(values):
    return "%.1f (%.1f to %.1f)" % (statistics.median(values), min(values), max(values))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(TOP, "build", "release"))
    parser.add_argument("--scene", default="fps")
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--ambient-size", type=int, default=16)
    parser.add_argument("--until", type=float, default=0.01)
    parser.add_argument("--auto", action="store_true")
    parser.add_argument("--frames", type=int, default=9)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--camera", default="")
    parser.add_argument("--picture", default="1280x720")
    parser.add_argument("--keep", help="where the probes go; else they are thrown away")
    args = parser.parse_args()
    args.program = os.path.join(args.build, "bin", "burnish")
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.path.join(temporary, "probes")
        baked = bake(args, folder)
        without, lit, renderer = [], [], ""
        for turn in range(args.rounds):
            for probes, into in ((None, without), (folder, lit)):
                passes, renderer = frame(args, probes, os.path.join(temporary, "frame.json"))
                into.append(passes)
            print("round %d of %d: done" % (turn + 1, args.rounds), file=sys.stderr)
        if args.keep:
            shutil.copytree(folder, args.keep, dirs_exist_ok=True)
    print("%s, %s, faces of %d (lattice %d), rest under %g\n" % (args.scene, renderer, args.size, args.ambient_size, args.until))
    print("| bounce | captured | change | q | estimated rest |\n|---|---|---|---|---|")
    for b in baked["bounces"]:
        rest = "not known" if b["rest"] is None else "%.2g" % b["rest"]
        print("| %d | %d | %.3f | %s | %s |" % (b["bounce"], b["captured"], b["change"], "%.3f" % b["ratio"] if b["ratio"] else "", rest))
    total = baked["capture_ms"] + baked["filter_ms"] + baked["store_ms"]
    print("\n| | CPU s | share |\n|---|---|---|")
    for name in ("capture", "filter", "store"):
        print("| %s | %.2f | %.0f %% |" % (name, baked[name + "_ms"] / 1e3, 100 * baked[name + "_ms"] / total))
    print("| all, wall | %.2f | |" % (baked["wall_ms"] / 1e3))
    print("\n| pass, CPU ms at %s | without probes | with |\n|---|---|---|" % args.picture)
    for name in ("tiles", "lighting"):
        print("| %s | %s | %s |" % (name, spread([p[name] for p in without]), spread([p[name] for p in lit])))
    print("| frame | %s | %s |" % (spread([sum(p.values()) for p in without]), spread([sum(p.values()) for p in lit])))


if __name__ == "__main__":
    main()
