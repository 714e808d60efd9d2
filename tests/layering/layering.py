#!/usr/bin/env python3
"""The house rule, enforced: includes point down only, and every library has its own users.

Layers come from burnish_module(NAME LAYER n) in engine/CMakeLists.txt. `layering.py ROOT` checks a tree and lists every breach as file:line;
`layering.py --self-test` plants one breach of each kind in a small tree and makes sure that each is found.
"""
import pathlib
import re
import sys
import tempfile

PUBLIC_LAYERS = {"result": 1, "image": 1, "context": 1, "material": 2, "scene": 3, "quality": 2, "plan": 3, "renderer": 6, "measure": 4, "probe": 6}
PASSES = {"gbuffer", "lighting", "shadow", "transparency", "post"}
NO_GL = {"core", "image", "asset", "material", "prefilter", "reference", "scene", "plan", "pathtrace"}
GL_USERS = {"gl", "gpu_scene", "gbuffer", "lighting", "shadow", "transparency", "post", "renderer", "stability", "probe", "context"}
MAX_PUBLIC_HEADERS = 10

MODULE = re.compile(r"burnish_module\(\s*(\w+)\s+LAYER\s+(\d+)")
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.M)
SOURCES = {".h", ".hpp", ".c", ".cpp", ".inl", ".glsl", ".vert", ".frag", ".comp"}
GL_HEADER = re.compile(r"^(glad/|GL/|EGL/|GLES|KHR/|epoxy/|GLFW/)")


def is_viewer(path):
    return path.parts[:2] == ("tools", "burnish") and path.name.startswith("view")


LIBRARY_USERS = [  # (include pattern, who may, in words)
    (re.compile(r"^OpenImageIO/"), lambda p: p.parts[:2] == ("tools", "burnish-decode"), "only tools/burnish-decode uses OpenImageIO"),
    (re.compile(r"^(tiny_gltf|tinygltf)"), lambda p: p.parts[:2] == ("tests", "unit"), "only tests/unit uses tinygltf"),
    (re.compile(r"^glad/"), lambda p: (p.parts[0] == "engine" and p.parts[1] in GL_USERS) or is_viewer(p), "glad belongs to gl, the modules above it and burnish view"),
    (re.compile(r"^(EGL/|GL/osmesa|GLFW/)"), lambda p: p.parts[:2] == ("engine", "context") or p.parts[0] == "samples" or is_viewer(p),
     "only engine/context (and sample hosts) open contexts; burnish view handles its window's events"),
    (re.compile(r"^(imgui|backends/imgui)"), lambda p: is_viewer(p), "only burnish view uses Dear ImGui"),
    (re.compile(r"^embree"), lambda p: p.parts[:2] == ("engine", "reference"), "only engine/reference uses Embree"),
    (re.compile(r"^CLI/"), lambda p: p.parts[0] == "tools", "only tools parse a command line"),
]


def layers(root):
    found = {name: int(n) for name, n in MODULE.findall((root / "engine/CMakeLists.txt").read_text())}
    if not found:
        raise SystemExit("layering: engine/CMakeLists.txt names no burnish_module(NAME LAYER n)")
    return found


def includes(path):
    text = path.read_text(errors="replace")
    for match in INCLUDE.finditer(text):
        yield text.count("\n", 0, match.start()) + 1, match.group(1)


def engine_target(root, source, name, modules):
    """(module or None, public header or None) that an include in the engine reaches."""
    if name.startswith("burnish/"):
        return None, pathlib.PurePosixPath(name).stem
    top = name.split("/")[0]
    if "/" in name and top in modules:
        return top, None
    resolved = (source.parent / name).resolve()
    try:
        parts = resolved.relative_to(root.resolve() / "engine").parts
    except ValueError:
        return None, None
    return (parts[0], None) if resolved.exists() and parts[0] in modules else (None, None)


def check_engine(root, path, line, name, modules):
    parts = path.parts
    module, header = engine_target(root, root / path, name, modules)
    if parts[1] == "include":
        own = PUBLIC_LAYERS[path.stem]
        if module or (header is None and "/" in name and name.split("/")[0] in modules):
            return f"a public header includes the module {module}"
        if header and PUBLIC_LAYERS.get(header, 99) > own:
            return f"<burnish/{header}.h> (layer {PUBLIC_LAYERS.get(header)}) lies above {path.stem}.h (layer {own})"
        return None
    own = modules.get(parts[1])
    if own is None:
        return f"engine/{parts[1]} is no module of engine/CMakeLists.txt"
    if module and module != parts[1]:
        if modules[module] > own:
            return f"{parts[1]} (layer {own}) includes {module} (layer {modules[module]}), which lies above it"
        if module in PASSES and parts[1] in PASSES:
            return f"the passes {parts[1]} and {module} include each other; they may meet only in frame resources"
    # result.h stands below everything; the other headers are for their layer and up.
    if header and header != "result" and PUBLIC_LAYERS.get(header, 99) > max(own, 1):
        return f"{parts[1]} (layer {own}) includes <burnish/{header}.h> (layer {PUBLIC_LAYERS.get(header)}), which lies above it"
    if parts[1] in NO_GL and (GL_HEADER.match(name) or name.startswith("gl/")):
        return f"{parts[1]} must know nothing of OpenGL, but includes {name}"
    return None


def check_outside(root, path, line, name, modules):
    """tools/ and samples/: their own files, system headers and <burnish/...> only."""
    local = (root / path).parent / name
    tool = pathlib.Path(*path.parts[:2])
    if name.startswith("burnish/"):
        own = (root / "engine/include" / name).exists() or (root / tool / "include" / name).exists()
        return None if own else f"{name} is no public header"
    if tool.name == "burnish-decode" and name.startswith("image/"):
        return None  # the other end of engine/image's decoder pool: both speak one protocol
    if local.exists():
        inside = local.resolve().is_relative_to((root / tool).resolve())
        return None if inside else f"{name} lies outside {tool}"
    if name.split("/")[0] in modules and (root / "engine" / name).exists():
        return f"includes the engine's own {name}; only <burnish/...> is open to it"
    return None


def check_shaders(root, path, line, name, modules):
    if path.suffix == ".md":
        return None
    parts = path.parts
    for base in (root / path).parent, root / "shaders":
        target = base / name
        if target.exists() and target.resolve().is_relative_to((root / "shaders").resolve()):
            folder = target.resolve().relative_to((root / "shaders").resolve()).parts[0]
            if parts[1] == "shading" and folder != "shading":
                return f"shaders/shading stands alone, but includes {folder}/"
            if parts[1] == "interface" and folder not in ("interface", "shading"):
                return f"shaders/interface lies below {folder}/"
            if parts[1] in PASSES and folder in PASSES and folder != parts[1]:
                return f"the passes {parts[1]} and {folder} include each other"
            return None
    if name.split("/")[0] in modules or name.startswith("burnish/"):
        return f"shader text includes engine code: {name}"
    return None


CHECKS = {"engine": check_engine, "tools": check_outside, "samples": check_outside, "shaders": check_shaders}


def breaches(root):
    modules = layers(root)
    found = []
    for top, check in CHECKS.items():
        for path in sorted(p for p in (root / top).rglob("*") if p.suffix in SOURCES and p.is_file()):
            relative = path.relative_to(root)
            for line, name in includes(path):
                fault = check(root, relative, line, name, modules)
                faults = [fault] if fault else []
                faults += [rule for pattern, may, rule in LIBRARY_USERS if pattern.match(name) and not may(relative)]
                found += [f"{relative}:{line}: {f}" for f in faults]
    headers = sorted((root / "engine/include/burnish").glob("*.h"))
    if len(headers) > MAX_PUBLIC_HEADERS:
        found.append(f"engine/include/burnish: {len(headers)} public headers, at most {MAX_PUBLIC_HEADERS} allowed")
    found += [f"engine/include/burnish/{h.name}: has no layer; name one in tests/layering/layering.py" for h in headers if h.stem not in PUBLIC_LAYERS]
    return found


PLANTED = [  # (file, text, part of the message)
    ("engine/core/a.cpp", '#include "image/x.h"\n', "which lies above it"),
    ("engine/core/r.cpp", '#include "../gl/objects.h"\n', "which lies above it"),
    ("engine/scene/b.cpp", "#include <burnish/renderer.h>\n", "which lies above it"),
    ("engine/gbuffer/c.cpp", '#  include "lighting/x.h"\n', "meet only in frame resources"),
    ("engine/plan/d.cpp", "#include <glad/gl.h>\n", "nothing of OpenGL"),
    ("engine/asset/e.cpp", '#include "gl/objects.h"\n', "nothing of OpenGL"),
    ("engine/scene/f.cpp", "#include <tiny_gltf.h>\n", "only tests/unit uses tinygltf"),
    ("engine/image/g.cpp", "#include <OpenImageIO/imageio.h>\n", "only tools/burnish-decode"),
    ("engine/renderer/h.cpp", "#include <EGL/egl.h>\n", "open contexts"),
    ("engine/include/burnish/scene.h", "#include <burnish/renderer.h>\n", "lies above scene.h"),
    ("engine/include/burnish/extra.h", "\n", "has no layer"),
    ("engine/stray/i.cpp", "#include <vector>\n", "is no module"),
    ("tools/burnish/j.cpp", '#include "core/file.h"\n', "only <burnish/...>"),
    ("tools/burnish/k.cpp", '#include "../../engine/core/file.h"\n', "lies outside"),
    ("tools/burnish/o.cpp", '#include "image/x.h"\n', "only <burnish/...>"),
    ("samples/embed/l.cpp", "#include <burnish/secret.h>\n", "no public header"),
    ("shaders/shading/m.h", '#include "lighting/tile.glsl"\n', "stands alone"),
    ("shaders/post/n.frag", '#include "../lighting/tile.glsl"\n', "include each other"),
]


def self_test(root):
    cmake = (root / "engine/CMakeLists.txt").read_text()
    failures = []
    for file, text, expected in [("", "", None)] + PLANTED:
        with tempfile.TemporaryDirectory() as folder:
            tree = pathlib.Path(folder)
            for existing in ("engine/core/file.h", "engine/gl/objects.h", "engine/image/x.h", "engine/lighting/x.h", "shaders/lighting/tile.glsl",
                             "engine/include/burnish/result.h"):
                (tree / existing).parent.mkdir(parents=True, exist_ok=True)
                (tree / existing).write_text("\n")
            (tree / "engine/CMakeLists.txt").write_text(cmake)
            if file:
                (tree / file).parent.mkdir(parents=True, exist_ok=True)
                (tree / file).write_text(text)
            found = breaches(tree)
            if expected is None and found:
                failures.append(f"a clean tree has breaches: {found}")
            if expected is not None and not any(f.startswith(file) and expected in f for f in found):
                failures.append(f"planted in {file}: expected '{expected}', found {found}")
    return failures


def main():
    root = pathlib.Path(sys.argv[-1]).resolve()
    found = self_test(root) if "--self-test" in sys.argv else breaches(root)
    for line in found:
        print(line)
    print(f"layering: {len(found)} fault{'' if len(found) == 1 else 's'}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
