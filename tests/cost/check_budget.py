#!/usr/bin/env python3
"""What burnish cost --budget promises, held against fresh processes.

check_budget.py BURNISH SCENE [-o DIR] [--size WxH] [--shares 50,75,100] [--processes 5] [--frames 15] [-- more options of burnish cost]

Has the qualities of some shares of the default's time found (taken as they are where DIR holds them already), then renders each in fresh processes in turn with the default, and compares: the median of the
processes' ratios must be within the share plus the spread that the report states for it, also where the tool says that nothing fits with all of its spread. Exit 1 where one is not.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys


def run(command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def frame(options, quality):
    """CPU milliseconds of the frame's passes in a process of its own."""
    report = json.loads(run([options.burnish, "render", options.scene, "--size", options.size, "--quality", quality, "--profile", "--frames", options.frames, "--json", "-", "-o", options.output / "frame.png"]))
    return sum(p["cpu_ms"]["median"] for p in report["passes"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("scene")
    parser.add_argument("-o", dest="output", type=pathlib.Path, default=pathlib.Path("budget-check"))
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--shares", default="50,75,100")
    parser.add_argument("--processes", type=int, default=5)
    parser.add_argument("--frames", type=int, default=15)
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options = parser.parse_args(sys.argv[1:cut])
    options.more = sys.argv[cut + 1:]
    shares = [int(s) for s in options.shares.split(",")]
    files = [options.output / f"quality_{s}_percent.json" for s in shares]
    if not all(f.exists() for f in files):
        budgets = [word for s in shares for word in ("--budget", f"{s}%")]
        print(run([options.burnish, "cost", options.scene, "-o", options.output, "--size", options.size, *budgets, *options.more]))
    report = json.loads((options.output / "cost.json").read_text())
    base = report["base"]["ms"]
    ratios = {s: [] for s in shares}
    times = {s: [] for s in shares}
    for turn in range(options.processes):
        before = frame(options, "default")
        for share, file in zip(shares, files):
            own = frame(options, file)
            after = frame(options, "default")
            ratios[share].append(own / ((before + after) / 2))
            times[share].append(own)
            before = after
    failed = 0
    print(f"{'share':>6} {'ratio in fresh processes':>26} {'stated':>24} {'ms':>8}  settings")
    for i, share in enumerate(shares):
        found = next(b for b in report["budgets"] if abs(b["ms"] / base - share / 100) < 0.005)
        stated = found["best"]["spread"]
        # The stated spread is of milliseconds, the base's own in it; ratios to the base have the rest (widths add up in squares).
        whole, bases = (x["high"] / x["median"] - 1 for x in (stated, report["base"]["spread"]))
        spread = max(whole**2 - bases**2, 0) ** 0.5 * stated["median"] / base
        median = statistics.median(ratios[share])
        good = median <= share / 100 + spread
        failed += not good
        note = ("" if good else "NOT MET ") + ("" if found["met"] else "(said to be the nearest, not to fit) ")
        print(f"{share:>5}% {median:>10.4f} ({min(ratios[share]):.4f} to {max(ratios[share]):.4f}) {stated['median'] / base:>9.4f} ± {spread:.4f} {statistics.median(times[share]):>12.2f}  {note}{', '.join(found['best']['settings'])}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
