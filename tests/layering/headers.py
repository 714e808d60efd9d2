#!/usr/bin/env python3
"""Each public header compiles alone, without a warning: headers.py COMPILER INCLUDE_DIR."""
import pathlib
import subprocess
import sys

compiler, folder = sys.argv[1], pathlib.Path(sys.argv[2])
headers = sorted((folder / "burnish").glob("*.h"))
failed = 0
for header in headers:
    text = f"#include <burnish/{header.name}>\n#include <burnish/{header.name}>\n"
    command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Werror", f"-I{folder}", "-x", "c++", "-"]
    result = subprocess.run(command, input=text, capture_output=True, text=True)
    if result.returncode:
        failed += 1
        print(f"burnish/{header.name} does not compile alone:\n{result.stderr}")
print(f"headers: {len(headers)} tried, {failed} failed")
sys.exit(1 if failed or not headers else 0)
