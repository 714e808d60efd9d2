#!/usr/bin/env python3
"""The frame bench: CPU milliseconds of a frame of the common workload, in units of a plain full-screen pass.

In rounds, for every light count: unit_pass, `burnish render` at full size, unit_pass, the same at 64x36 (the fixed part), unit_pass; each figure is
divided by the units around it. docs/benchmarks.md says how to read the table.

    run_bench.py [--build DIR] [--scene-dir DIR] [--lights 1,64,256,1024] [--json OUT] [--check]
"""
import argparse
import glob
import json
import os
import re
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.normpath(os.path.join(HERE, "..", ".."))
CAMERA = ["--eye=-10.8,2.3,0.7", "--target=4,2.5,-0.4", "--fov", "60", "--exposure", "0"]
BARS = {1: 6.5, 64: 7.5, 256: 9.5}  # units a frame at 1280x720
FIXED_BAR = 0.5                     # units a frame at 64x36
FIXED_SIZE = "64x36"
NOISY = 1.10                        # a unit that changes by more than this between before and after is not to be trusted


class BenchError(Exception):
    """What is missing or failed, and what to do."""


def run(command):
    """Standard output of a command."""
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    except OSError as error:
        raise BenchError("%s: %s; build it first (docs/benchmarks.md)" % (command[0], error.strerror)) from error
    if done.returncode != 0:
        raise BenchError("%s failed (%d):\n%s%s" % (" ".join(command), done.returncode, done.stdout, done.stderr))
    return done.stdout


def unit(program):
    """(milliseconds, renderer) of unit_pass."""
    out = run([program])
    found = re.match(r"unit pass ([0-9.]+) CPU ms .* on (.*)", out)
    if not found:
        raise BenchError("%s printed %r" % (program, out))
    return float(found.group(1)), found.group(2)


def render(args, scene, size, name):
    """Median and p95 CPU milliseconds a frame, lights in view, warnings."""
    picture = os.path.join(args.pictures, name + ".png")
    report = os.path.join(args.pictures, name + ".json")
    out = run([args.program, "render", scene, "--env", args.env, *CAMERA, "--size", size, "--frames", str(args.frames), "--json", report, "-o", picture])
    with open(report, encoding="utf-8") as file:
        data = json.load(file)
    if data["gl_errors"] or data["nonfinite_pixels"]:
        raise BenchError("%s: %d GL errors, %d pixels not finite" % (name, data["gl_errors"], data["nonfinite_pixels"]))
    lights = re.search(r"(\d+) of (\d+) lights in view", out)
    return {"median": data["frame_cpu_ms"]["median"], "p95": data["frame_cpu_ms"]["p95"],
            "lights_in_view": int(lights.group(1)) if lights else None, "effects": data["effects"], "warnings": data["warnings"]}


def scenes(args):
    """{light count: file} of the scene folder; makes the hall where it is not there yet."""
    if not args.scene_dir:
        args.scene_dir = os.path.join(args.build, "bench", "hall")
        if not glob.glob(os.path.join(args.scene_dir, "*_L1.gltf")):
            print("making the hall in %s ..." % args.scene_dir, file=sys.stderr)
            os.makedirs(args.scene_dir, exist_ok=True)
            python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable  # has numpy from the packages
            run([python, "-B", os.path.join(HERE, "make_hall.py"), "-o", args.scene_dir])
    found = {}
    for count in args.lights:
        files = sorted(glob.glob(os.path.join(args.scene_dir, "*_L%d.gltf" % count)))
        if len(files) != 1:
            raise BenchError("%s: %d files named *_L%d.gltf, one is needed" % (args.scene_dir, len(files), count))
        found[count] = files[0]
    args.env = args.env or os.path.join(args.scene_dir, "env.hdr")
    return found


def measure_round(args, scene, name, first):
    """Unit, frame, unit, fixed part, unit: each figure is divided by the mean of the units on either side of it."""
    one = (lambda: first[0]) if first else (lambda: unit(args.unit)[0])
    u0 = one()
    frame = render(args, scene, args.size, name)
    u1 = one()
    fixed = render(args, scene, FIXED_SIZE, name + "_fixed")
    u2 = one()
    return {"frame": frame, "fixed": fixed, "before": u0, "after": u1, "units": 2 * frame["median"] / (u0 + u1),
            "fixed_units": 2 * fixed["median"] / (u1 + u2), "noisy": max(u0, u1) > NOISY * min(u0, u1)}


def measure(args):
    """One row for each light count. A neighbour's load comes in bursts that outlast a frame, so the rounds are short, and the median ratio counts."""
    renderer = unit(args.unit)[1]
    first = unit(args.unit) if args.unit_once else None
    per_count = {count: [] for count in scenes(args)}
    for turn in range(args.rounds):
        for count, scene in scenes(args).items():
            per_count[count].append(measure_round(args, scene, os.path.splitext(os.path.basename(scene))[0], first))
        print("round %d of %d: done" % (turn + 1, args.rounds), file=sys.stderr)
    rows = []
    for count, rounds in per_count.items():
        quiet = [r for r in rounds if not r["noisy"]] or rounds
        middle = sorted(quiet, key=lambda r: r["units"])[(len(quiet) - 1) // 2]
        units = sorted(r["units"] for r in quiet)
        fixed_units = statistics.median_low(r["fixed_units"] for r in quiet)
        rows.append({"lights": count, "lights_in_view": middle["frame"]["lights_in_view"], "cpu_ms": middle["frame"]["median"],
                     "cpu_ms_p95": middle["frame"]["p95"], "unit_before_ms": middle["before"], "unit_after_ms": middle["after"],
                     "units": middle["units"], "units_range": [units[0], units[-1]], "rounds": len(rounds), "quiet_rounds": len(rounds) - sum(r["noisy"] for r in rounds),
                     "fixed_cpu_ms": middle["fixed"]["median"], "fixed_units": fixed_units, "bar_units": BARS.get(count),
                     "noisy": all(r["noisy"] for r in rounds), "renderer": renderer, "effects": middle["frame"]["effects"],
                     "warnings": middle["frame"]["warnings"]})
    return rows


def table(rows):
    """The rows as a Markdown table."""
    lines = ["| lights | in view | CPU ms per frame: median (p95) | unit before / after, ms | units: median (range) | quiet rounds | bar | fixed part: ms | units |", "|" + "---|" * 9]
    for r in rows:
        lines.append("| %d | %s | %.1f (%.1f) | %.2f / %.2f%s | %.2f (%.2f..%.2f) | %d of %d | %s | %.1f | %.2f |" % (
            r["lights"], r["lights_in_view"], r["cpu_ms"], r["cpu_ms_p95"], r["unit_before_ms"], r["unit_after_ms"], " noisy" if r["noisy"] else "", r["units"], *r["units_range"],
            r["quiet_rounds"], r["rounds"], r["bar_units"] or "-", r["fixed_cpu_ms"], r["fixed_units"]))
    return "\n".join(lines)


def over(rows):
    """What is over its bar."""
    return (["%d lights: %.2f units, the bar is %.1f" % (r["lights"], r["units"], r["bar_units"]) for r in rows if r["bar_units"] and r["units"] > r["bar_units"]] +
            ["%d lights: fixed part %.2f units, the bar is %.1f" % (r["lights"], r["fixed_units"], FIXED_BAR) for r in rows
             if r["bar_units"] and r["fixed_units"] > FIXED_BAR])


def machine():
    """Processor, cores, load."""
    model = "unknown"
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
            model = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), model)
    return {"processor": model, "cores": os.cpu_count(), "load_average": round(os.getloadavg()[0], 2)}


def count_list(text):
    """'1,64' as numbers."""
    counts = [int(part) for part in text.split(",")]
    if not counts or min(counts) < 0:
        raise argparse.ArgumentTypeError("light counts are numbers with commas between")
    return counts


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(TOP, "build", "release"), help="build folder with bin/burnish and bin/unit_pass (build/release)")
    parser.add_argument("--scene-dir", help="folder of NAME_L<count>.gltf and env.hdr; default: the hall, made when missing")
    parser.add_argument("--env", help="lat-long picture; default: env.hdr of the scene folder")
    parser.add_argument("--lights", type=count_list, default=[1, 64, 256, 1024], help="light counts, default 1,64,256,1024")
    parser.add_argument("--size", default="1280x720", help="the bars hold for 1280x720, the size of the unit")
    parser.add_argument("--frames", type=int, default=8, help="measured frames a round")
    parser.add_argument("--rounds", type=int, default=7, help="rounds; the median ratio of those whose units agree counts")
    parser.add_argument("--unit-once", action="store_true", help="measure the unit once only (quick trials)")
    parser.add_argument("--pictures", help="where pictures and reports go; default: BUILD/bench/pictures")
    parser.add_argument("--json", help="write all figures there")
    parser.add_argument("--check", action="store_true", help="exit with 1 when a figure is over its bar")
    args = parser.parse_args()
    if args.check and args.size != "1280x720":
        parser.error("--check needs --size 1280x720: the bars hold for it")
    args.program = os.path.join(args.build, "bin", "burnish")
    args.unit = os.path.join(args.build, "bin", "unit_pass")
    args.pictures = args.pictures or os.path.join(args.build, "bench", "pictures")
    return args


def main():
    """0: done; 1: over a bar (--check) or something failed."""
    args = arguments()
    about = machine()
    try:
        os.makedirs(args.pictures, exist_ok=True)
        rows = measure(args)
    except BenchError as error:
        print("run_bench: %s" % error, file=sys.stderr)
        return 1
    print("%s, %d cores, load %.1f; %s; %s, %d rounds of %d frames\n" % (about["processor"], about["cores"], about["load_average"], rows[0]["renderer"], args.size, args.rounds, args.frames))
    print(table(rows))
    for warning in sorted({text for r in rows for text in r["warnings"]}):
        print("warning: " + warning)
    too_much = over(rows) if args.size == "1280x720" else []
    for text in too_much:
        print("over: " + text)
    if args.json:
        with open(args.json, "w", encoding="utf-8") as file:
            json.dump({"schema_version": 1, "machine": about, "size": args.size, "frames": args.frames, "rows": rows, "over": too_much}, file, indent=1)
    return 1 if args.check and too_much else 0


if __name__ == "__main__":
    sys.exit(main())
