#!/usr/bin/env python3
"""Prints docs/accuracy.md from reports of burnish cost: accuracy.py DIR[+AGAIN] [...] > docs/accuracy.md, each folder as `burnish cost SCENE -o DIR` wrote it. What the report AGAIN (`--term TERM`) has, terms and the preset
`exact`, takes the place of what DIR has of it: where a rung changed after DIR was measured."""
import json
import math
import pathlib
import sys


def percent(share, digits=3):
    if share is None:
        return "-"
    text = f"{100 * share:.{digits}g}"
    return ("0" if share == 0 else text) + " %"


def signed(share):
    return "-" if share is None else f"{100 * share:+.2g} %"


def milliseconds(median, spread):
    return f"{median:.2f} ({spread['low']:.2f} to {spread['high']:.2f})" if spread and median is not None else "-"


def decibels(value):
    return "-" if value is None or not math.isfinite(value) else f"{value:.1f}"


def row(*cells):
    print("| " + " | ".join(str(c).replace("|", "\\|") for c in cells) + " |")


def table(*heads):
    row(*heads)
    row(*["---"] * len(heads))


def kind(contributor):
    """A term, or one of the lines that stand for more."""
    return contributor["name"].split(":")[0] if ": " in contributor["name"] and not contributor["name"].startswith("what ") else contributor["name"].split(" ")[0]


def load(word):
    first, *later = (json.loads((pathlib.Path(folder) / "cost.json").read_text()) for folder in word.split("+"))
    first["again"] = []
    for r in later:
        terms = {t["term"]: t for t in r["terms"]}
        first["terms"] = [terms.get(t["term"], t) for t in first["terms"]]
        first["exact"] = r["exact"]
        lines = {kind(c): c for c in r["contributors"]}
        first["contributors"] = sorted((lines.get(kind(c), c) for c in first["contributors"]), key=lambda c: -c["rms"])
        first["again"].append((r["command"], sorted(terms)))
    return first


def whole(reports):
    print("## The default quality against ground truth\n")
    print("rms, energy and the rest as [cost.md](cost.md) has them; frame: milliseconds of the clock that the report names.\n")
    table("scene", "quality", "frame", "rms", "energy", "PSNR, dB", "perceptual")
    for r in reports:
        for name, point in (("default", r["base"]), ("exact", r["exact"])):
            e = point["error"]
            row(r["scene"], name, milliseconds(point["ms"], point["spread"]), f"{percent(e['rms'])} ± {percent(e['rms_spread'], 1)}", signed(e["energy"]), decibels(e["psnr"]), f"{e['perceptual']:.2f}")
    print("\n### What to improve next\n")
    print("By how much rms falls when one gap alone is closed, measured; points of a percent. Falls do not add up.\n")
    for r in reports:
        print(f"{r['scene']}:\n")
        for c in r["contributors"][:6]:
            print(f"- {100 * c['rms']:+.3g}: {c['name']}")
        print()


def ladders(r):
    print(f"## {r['scene']}, rung by rung\n")
    print("`*` marks the rung that the default quality has, `=` the exact one. Times are of the passes that the term changes. Errors: rms against the exact rung with the rest as in the default quality, and as in the preset\n`exact`; rms against ground truth; energy against the exact rung.\n")
    for term in r["terms"]:
        print(f"### {term['term']}\n")
        if term.get("setting"):
            print(f"Measured beside {term['setting']}.\n")
        table("", "ms", "exact rung", "beside `exact`", "ground truth", "energy", "")
        for rung in term["rungs"]:
            mark = (" *" if rung["in_force"] else "") + (" =" if rung["rung"] == term["exact_rung"] else "")
            ms = rung.get("cpu_ms", rung.get("gpu_ms"))
            beside, truth = rung.get("error_exact_rest"), rung.get("error_truth")
            row(rung["rung"] + mark, milliseconds(ms, rung.get("spread")), percent(rung["error"]["rms"]), percent(beside["rms"]) if beside else "-", percent(truth["rms"]) if truth else "-",
                signed(rung["error"]["energy"]), "dominated" if rung["dominated"] else "")
        print()
    late = [i["term"] for i in r["idle"] if "time was" in i["reason"]]
    if late:
        print(f"For these the time was too short: {', '.join(late)}.\n")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    reports = [load(word) for word in sys.argv[1:]]
    print("# How accurate the default quality is, and what the rest would cost\n")
    print("<!-- Written by tests/bench/accuracy.py: do not edit. -->")
    machine = reports[0]["machine"]
    print(f"Printed by `tests/bench/accuracy.py` from what these commands wrote, on {machine['cpu']}, {machine['renderer']}; times are {reports[0]['clock']}:\n")
    for r in reports:
        for command in (r["command"], *(command for command, terms in r["again"])):
            print(f"    {command}")
    print()
    for r in reports:
        for _, terms in r["again"]:
            print(f"{r['scene']}: the second command came after a change of {', '.join(terms)}: that and the preset `exact` are from it. Errors beside `exact` of the other terms are from before.\n")
    for r in reports:
        print(f"{r['scene']}: {r['seconds']:.0f} s of measuring, beside a reference of {r['reference']['samples']} samples a pixel (noise {percent(r['reference']['noise'])}).")
    print()
    whole(reports)
    for r in reports:
        ladders(r)


if __name__ == "__main__":
    main()
