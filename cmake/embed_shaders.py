#!/usr/bin/env python3
"""Writes every shader below a folder into one C++ file as raw string literals (name relative to the folder, '/' as separator)."""
import pathlib
import sys

KINDS = {".h", ".glsl", ".vert", ".frag", ".comp"}
PIECE = 12000  # characters; compilers limit the length of one literal


def literal(text: str) -> str:
    pieces = [text[i:i + PIECE] for i in range(0, len(text), PIECE)] or [""]
    return "\n".join(f'R"~~~({p})~~~"' for p in pieces)


def main() -> None:
    root, out = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    files = sorted(p for p in root.rglob("*") if p.suffix in KINDS)
    rows = ",\n".join(f'{{"{p.relative_to(root).as_posix()}", {literal(p.read_text())}}}' for p in files)
    text = ('#include "gl/embedded_shaders.h"\n\nnamespace burnish::gl {\n'
            f"static constexpr EmbeddedShader kShaders[] = {{\n{rows}\n}};\n"
            "std::span<const EmbeddedShader> embeddedShaders() { return kShaders; }\n}  // namespace burnish::gl\n")
    out.parent.mkdir(parents=True, exist_ok=True)
    if not out.exists() or out.read_text() != text:
        out.write_text(text)


if __name__ == "__main__":
    main()
