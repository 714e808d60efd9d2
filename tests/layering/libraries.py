#!/usr/bin/env python3
"""What programs load at start: every shared object must stand in the table of docs/dependencies.md, and OpenImageIO must not be among them.

`libraries.py DEPENDENCIES.md FILE...` asks ldd; `libraries.py --self-test DEPENDENCIES.md` checks that a breach would be found.
"""
import pathlib
import re
import subprocess
import sys


def allowed(document):
    section = pathlib.Path(document).read_text().split("## Shared objects", 1)[1]
    rows = re.findall(r"^\| ([^|]+) \| [^|]+ \| [^|]+ \|$", section, re.M)
    names = {name.strip() for row in rows for name in row.split(",")} - {"soname"}
    if len(names) < 5:
        raise SystemExit(f"{document}: no table of shared objects under '## Shared objects'")
    return names


def faults(listing, names):
    """listing: what ldd prints."""
    found = []
    for line in listing.splitlines():
        words = line.split()
        if not words or words[0].startswith(("linux-vdso", "linux-gate")) or words[0] == "statically":
            continue
        soname = pathlib.PurePosixPath(words[0]).name
        base = re.sub(r"\.so[.\d]*$", "", soname)
        if "not found" in line:
            found.append(f"{soname} is not found")
        elif base.startswith("libOpenImageIO"):
            found.append(f"{soname}: only burnish-decode may link OpenImageIO")
        elif base not in names:
            found.append(f"{soname} is not in the table of docs/dependencies.md: add it with its licence, or lose it")
    return found


def self_test(names):
    good = "\tlinux-vdso.so.1 (0x1)\n\tlibstdc++.so.6 => /lib/libstdc++.so.6 (0x2)\n\t/lib64/ld-linux-x86-64.so.2 (0x3)\n"
    cases = [("", 0), ("\tlibOpenImageIO.so.2.4 => /lib/x (0x4)\n", 1), ("\tlibavcodec.so.59 => /lib/y (0x5)\n", 1), ("\tlibfmt.so.9 => not found\n", 1)]
    return [f"expected {n} faults of {more!r}" for more, n in cases if len(faults(good + more, names)) != n]


def main():
    arguments = [a for a in sys.argv[1:] if a != "--self-test"]
    names = allowed(arguments[0])
    if "--self-test" in sys.argv:
        found = self_test(names)
    else:
        found = []
        for file in arguments[1:]:
            listing = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
            found += [f"{file}: {fault}" for fault in faults(listing, names)]
    for line in found:
        print(line)
    print(f"libraries: {len(found)} fault{'' if len(found) == 1 else 's'}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
