#!/usr/bin/env python3
"""Installs a build into a temporary prefix, builds consumer/ against it, runs it, and runs the installed program.

package.py CMAKE BINARY_DIR COMPILER
"""
import os
import pathlib
import subprocess
import sys
import tempfile


def run(*command, **more):
    print("+", *command, flush=True)
    # Nothing of the build tree may help: the installed files must do.
    environment = {k: v for k, v in os.environ.items() if k not in ("LD_LIBRARY_PATH", "CMAKE_PREFIX_PATH", "Burnish_DIR", "DESTDIR")}
    return subprocess.run([str(c) for c in command], check=True, env=environment, **more)


def check(condition, text):
    if not condition:
        raise SystemExit(f"package: {text}")


def main():
    cmake, build, compiler = sys.argv[1:4]
    source = pathlib.Path(__file__).resolve().parent / "consumer"
    example = (source / "consumer.cpp").read_text().split("// [readme]\n")[1].split("// [/readme]")[0]
    check(example in (source.parents[2] / "README.md").read_text(), "README's example differs from consumer.cpp")
    with tempfile.TemporaryDirectory() as folder:
        prefix, consumer = pathlib.Path(folder, "prefix"), pathlib.Path(folder, "build")
        run(cmake, "--install", build, "--prefix", prefix, stdout=subprocess.DEVNULL)
        for public in (prefix / "include/burnish").glob("*.h"):
            check(build not in public.read_text(), f"{public.name} names the build folder")
        for config in prefix.glob("lib/**/cmake/Burnish/*.cmake"):
            check(build not in config.read_text(), f"{config.name} names the build folder")
        run(cmake, "-S", source, "-B", consumer, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={compiler}",
            "-DCMAKE_BUILD_TYPE=Release", stdout=subprocess.DEVNULL)
        run(cmake, "--build", consumer)
        picture = pathlib.Path(folder, "picture.png")
        run(consumer / "consumer", picture)
        check(picture.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n", "the consumer wrote no PNG")

        # The consumer's own folder found the library by its build-time path; the program finds it beside itself, wherever the prefix was moved to.
        moved = prefix.rename(pathlib.Path(folder, "moved"))
        program = moved / "bin/burnish"
        check(program.exists(), "bin/burnish is not installed")
        check((moved / "bin/burnish-decode").exists(), "bin/burnish-decode is not installed")
        version = run(program, "--version", capture_output=True, text=True).stdout
        check(version.startswith("burnish "), f"--version says {version!r}")
        if (moved / "share/burnish/samples/fps").exists():
            listing = run(program, "inspect", "fps", capture_output=True, text=True).stdout
            check("meshes: " in listing, "the installed program does not find its samples")
    print("package: installed, found, built and ran")


if __name__ == "__main__":
    main()
