#!/usr/bin/env python3
"""Guards of the shading text are declared in shaders/shading/constants.h and nowhere else.

In shaders/shading and shaders/lighting no other file may hold a small number of its own (1e-...), and a clamp, max or min must name a declared guard or say `model` in its line: that it
is part of the model, not of the arithmetic. No shader at all may hold a number that no float holds: some compilers refuse it even where a macro drops it. `guards.py ROOT` checks a tree; `guards.py --self-test` plants a breach of each kind.
"""
import pathlib
import re
import sys
import tempfile

SMALL = re.compile(r"\b\d+(\.\d*)?e-\d+", re.I)
NUMBER = re.compile(r"(?<![\w.])(\d+\.?\d*|\.\d+)(e[+-]?\d+)\b|(?<![\w.])(\d+\.\d*|\.\d+)", re.I)
CLAMP = re.compile(r"\b(clamp|max|min)\s*\(")
FOLDERS = ("shaders/shading", "shaders/lighting", "shaders/forward")
# Loops over counts, culling and tone curves of entry points are no shading: what a file outside the text may clamp without a word.
ENTRY_POINTS = {"tile_depth.frag", "sky.frag", "tile.vert"}


def breaches(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).glob("*")):
            if path.name == "constants.h" or path.name in ENTRY_POINTS:
                continue
            for number, line in enumerate(path.read_text().splitlines(), 1):
                code = line.split("//")[0]
                place = f"{path.relative_to(root)}:{number}"
                if SMALL.search(code):
                    yield f"{place}: a small number of its own: declare it as a guard in constants.h, with its reason"
                if CLAMP.search(code) and "BURNISH_" not in code and "model" not in line:
                    yield f"{place}: a clamp that is no declared guard: use one of constants.h, or say `model:` and why it is part of the model"
    for path in sorted(p for p in (root / "shaders").rglob("*") if p.is_file()):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            for found in NUMBER.finditer(line.split("//")[0]):
                size = float(found[0])
                if size > 3.4028234e38 or 0 < size < 1.1754944e-38:
                    yield f"{path.relative_to(root)}:{number}: {found[0]}: a number that no float holds"
    text = (root / "shaders/shading/constants.h").read_text().splitlines()
    numbers = []
    for i, line in enumerate(text):
        found = re.search(r"GUARDED\((\d+),", line)
        if found:
            numbers.append(int(found[1]))
            if not text[i - 1].startswith("// "):
                yield f"shaders/shading/constants.h:{i + 1}: a guard without a reason above it"
    if numbers != list(range(1, len(numbers) + 1)):
        yield f"shaders/shading/constants.h: guards are numbered {numbers}: count from 1 without a gap"


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in FOLDERS:
            (root / name).mkdir(parents=True)
        (root / "shaders/shading/constants.h").write_text("// why\n#define A GUARDED(1, R(1e-7), R(0.0))\n\n#define B GUARDED(3, R(1e-7), R(0.0))\n")
        (root / "shaders/shading/a.h").write_text("real x = max(y, R(0.0));\nreal z = y + R(1e-6);\nreal w = max(a, b);  // model: the larger\nreal v = max(a, BURNISH_GUARD_A);  // 1e-9\n")
        (root / "shaders/forward/b.frag").write_text("float x = y * 3.4e38;\nfloat z = 1e300;\nfloat w = 0.0;  // 1e300\n")
        found = list(breaches(root))
        assert len(found) == 5 and "a.h:1" in found[0] and "a.h:2" in found[1] and "b.frag:2: 1e300" in found[2] and "constants.h:4" in found[3] and "[1, 3]" in found[4], found


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    found = list(breaches(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "guards: all declared")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
