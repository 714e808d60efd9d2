#!/usr/bin/env python3
"""The order of rungs by error does not depend on the reference's noise: check_orders.py BURNISH [--scene fps] [--camera hero] [--size 96x54] [--probes DIR] [--spp 64] [--term TERM]...
Traces three references of different seeds and measures the rungs against each. Two rungs whose errors differ by more than both spreads together must be in the same order against all three.
Also: the errors against the exact rung are the same numbers each time, and a time that was measured before lies within the spread that was said then, for at least 4 of 5 rungs."""
import argparse
import itertools
import json
import pathlib
import subprocess
import sys
import tempfile

parser = argparse.ArgumentParser()
parser.add_argument("burnish")
parser.add_argument("--scene", default="fps")
parser.add_argument("--camera", default="hero")
parser.add_argument("--size", default="96x54")
parser.add_argument("--probes")
parser.add_argument("--spp", default="64")
parser.add_argument("--rounds", default="5")
parser.add_argument("--term", action="append")
arguments = parser.parse_args()
names = arguments.term or ["fresnel", "diffuse", "environment-specular", "ambient"]


def run(*command):
    result = subprocess.run([arguments.burnish, *map(str, command)], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if result.returncode:
        sys.exit(f"{' '.join(map(str, command))}: {result.stderr}")


def measured(seed, folder):
    file = folder / f"{seed}.exr"
    view = ["--camera", arguments.camera, "--size", arguments.size] + (["--probes", arguments.probes] if arguments.probes else [])
    run("reference", arguments.scene, *view, "--seed", seed, "--spp", arguments.spp, "--pixel", "centre", "--quality", "exact", "-o", file)
    run("cost", arguments.scene, *view, "--reference", file, "--no-choices", "--rounds", arguments.rounds, "--minutes", 0, *sum((["--term", n] for n in names), []), "-o", folder / str(seed))
    report = json.loads((folder / str(seed) / "cost.json").read_text())
    print(f"seed {seed}: noise {100 * report['reference']['noise']:.2f} %, base {100 * report['base']['error']['rms']:.3f} % +- {100 * report['base']['error']['rms_spread']:.3f} %", flush=True)
    return report


def rungs(report):
    return {(t["term"], r["rung"]): r for t in report["terms"] for r in t["rungs"]}


def sign(report, a, b):
    """1 or -1 where the errors of a and b differ by more than their spreads, else 0."""
    x, y = rungs(report)[a]["error_truth"], rungs(report)[b]["error_truth"]
    difference = x["rms"] - y["rms"]
    return 0 if abs(difference) <= x["rms_spread"] + y["rms_spread"] else 1 if difference > 0 else -1


with tempfile.TemporaryDirectory(prefix="burnish-orders-") as folder:
    reports = [measured(seed, pathlib.Path(folder)) for seed in (1, 2, 3)]
faults, pairs, told = [], 0, 0
for term in reports[0]["terms"]:
    keys = [(term["term"], r["rung"]) for r in term["rungs"]]
    for a, b in itertools.combinations(keys, 2):
        signs = {sign(report, a, b) for report in reports} - {0}
        pairs += 1
        told += bool(signs)
        if len(signs) > 1:
            faults.append(f"{a} and {b} change places with the seed")
within = count = 0
for key, first in rungs(reports[0]).items():
    for report in reports[1:]:
        other = rungs(report)[key]
        if other["error"]["rms"] != first["error"]["rms"]:
            faults.append(f"{key}: {other['error']['rms']} and {first['error']['rms']} against the exact rung")
        count += 1
        within += first["frame_ms"]["low"] <= other["frame_ms"]["median"] <= first["frame_ms"]["high"]
if told == 0:
    faults.append("no two errors differ by more than their spread: --spp is too low to say anything")
if within < 0.8 * count:
    faults.append(f"only {within} of {count} repeated times lie within the spread")
print(f"{told} of {pairs} pairs of rungs differ by more than their spread, {within} of {count} repeated times lie within theirs")
sys.exit("\n".join(faults) or 0)
