#!/usr/bin/env python3
"""The scaling bench: CPU milliseconds of a frame over the number of lights, of instances and of pixels, in units of a plain full-screen pass.

    scaling.py [--build DIR] [--lights 1,16,64,256,1024,4096] [--instances 1,100,1000,10000] [--sizes 640x360,1280x720,1920x1080,3840x2160]
               [--frames 5] [--rounds 3] [--size 1280x720] [--markdown OUT] [--only lights,clustered,instances,distinct,sizes]

Scenes are make_field.py's. Each figure is the median over the rounds of a frame over the unit before it; rounds of different rows alternate. docs/benchmarks.md has the figures.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys

from run_bench import HERE, TOP, BenchError, run, unit

SWEEPS = {"lights": "point lights spread over 400 instances", "clustered": "point lights crowded on the middle ninth of them", "instances": "instances of 8 meshes, 64 lights",
          "distinct": "instances with a mesh each, 64 lights", "sizes": "pixels, 400 instances, 256 lights"}


def scene(args, instances, lights, kind):
    """A file of make_field.py's, made on first use."""
    folder = os.path.join(args.build, "bench", "scaling", kind)
    path = os.path.join(folder, "field_I%d_L%d.gltf" % (instances, lights))
    if not os.path.exists(path):
        python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable  # has numpy from the packages
        flags = {"distinct": ["--distinct"], "clustered": ["--clustered"]}.get(kind, [])
        run([python, "-B", os.path.join(HERE, "make_field.py"), "-o", folder, "--instances", str(instances), "--lights", str(lights)] + flags)
    return path


def rows_of(args, sweep):
    """[(label, scene file, size)] of a sweep."""
    if sweep in ("lights", "clustered"):
        return [(str(n), scene(args, 400, n, "clustered" if sweep == "clustered" else "spread"), args.size) for n in args.lights]
    if sweep in ("instances", "distinct"):
        return [(str(n), scene(args, n, 64, "distinct" if sweep == "distinct" else "spread"), args.size) for n in args.instances]
    return [(size, scene(args, 400, 256, "spread"), size) for size in args.sizes]


def frame(args, path, size):
    """One measured run: the report of `burnish render`, and what it printed."""
    report = os.path.join(args.build, "bench", "scaling", "frame.json")
    out = run([args.program, "render", path, "--camera", "bench", "--exposure", "0", "--size", size, "--frames", str(args.frames), "--profile", "--json", report, "-o", report[:-5] + ".png"])
    with open(report, encoding="utf-8") as file:
        data = json.load(file)
    if data["gl_errors"] or data["nonfinite_pixels"]:
        raise BenchError("%s: %d GL errors, %d pixels not finite" % (path, data["gl_errors"], data["nonfinite_pixels"]))
    data["head"] = out.split("\n", 1)[0]
    return data


def measure(args):
    """{sweep: [row]}; a row has label, draws and lights as printed, the passes and the units of each round."""
    found = {sweep: [{"label": label, "path": path, "size": size, "ms": [], "units": [], "passes": {}} for label, path, size in rows_of(args, sweep)] for sweep in args.only}
    for turn in range(args.rounds):
        for rows in found.values():
            for row in rows:
                one = unit(args.unit)[0]
                data = frame(args, row["path"], row["size"])
                ms = sum(p["cpu_ms"]["median"] for p in data["passes"])
                row["head"] = data["head"]
                row["warnings"] = data["warnings"]
                row["ms"].append(ms)
                row["units"].append(ms / one)
                for p in data["passes"]:
                    row["passes"].setdefault(p["name"], []).append(p["cpu_ms"]["median"])
        print("round %d of %d: done" % (turn + 1, args.rounds), file=sys.stderr)
    return found


def tables(found):
    """The sweeps as Markdown."""
    lines = []
    for sweep, rows in found.items():
        names = [n for n in ("gbuffer", "tiles", "lighting") if any(n in r["passes"] for r in rows)]
        lines += ["", "| %s | draws, lights in view | CPU ms of all passes | units (range) | %s, CPU ms |" % (SWEEPS[sweep], ", ".join(names)), "|" + "---|" * 5]
        for r in rows:
            parts = [p.strip() for p in r["head"].split(";")[-1].split(",")]
            passes = ", ".join("%.1f" % statistics.median(r["passes"][n]) if n in r["passes"] else "-" for n in names)
            lines.append("| %s | %s, %s | %.1f | %.2f (%.2f..%.2f) | %s |" % (r["label"], parts[0], parts[2].replace(" lights in view", ""), statistics.median(r["ms"]), statistics.median(r["units"]), min(r["units"]),
                                                                            max(r["units"]), passes))
        for text in sorted({w for r in rows for w in r["warnings"]}):
            lines.append("\nwarning: " + text)
    return "\n".join(lines[1:])


def main():
    def ints(text):
        return [int(n) for n in text.split(",")]

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(TOP, "build", "release"))
    parser.add_argument("--lights", type=ints, default=[1, 16, 64, 256, 1024, 4096])
    parser.add_argument("--instances", type=ints, default=[1, 100, 1000, 10000])
    parser.add_argument("--sizes", type=lambda s: s.split(","), default=["640x360", "1280x720", "1920x1080", "3840x2160"])
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", type=lambda s: s.split(","), default=list(SWEEPS))
    parser.add_argument("--markdown")
    args = parser.parse_args()
    args.program = os.path.join(args.build, "bin", "burnish")
    args.unit = os.path.join(args.build, "bin", "unit_pass")
    for sweep in args.only:
        if sweep not in SWEEPS:
            sys.exit("scaling.py: no sweep '%s'; choose from: %s" % (sweep, ", ".join(SWEEPS)))
    try:
        text = tables(measure(args))
    except (BenchError, subprocess.SubprocessError) as error:
        sys.exit("scaling.py: %s" % error)
    print(text)
    if args.markdown:
        with open(args.markdown, "w", encoding="utf-8") as file:
            file.write(text + "\n")


if __name__ == "__main__":
    main()
