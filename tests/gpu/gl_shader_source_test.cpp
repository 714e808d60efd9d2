// The include resolver; needs no GL.
#include <catch2/catch.hpp>
#include <fstream>

#include "gl/shader_source.h"
#include "temporary_folder.h"

using burnish::gl::EmbeddedShader;
using burnish::gl::nameFiles;
using burnish::gl::ShaderLibrary;
using Catch::Matchers::Contains;

namespace {

constexpr EmbeddedShader kFiles[] = {
    {"pass/main.frag",
     "#pragma once\n#include \"common.glsl\"\n#include \"shading/lobe.h\"\n#include \"shading/lobe.h\"\nvoid main() "
     "{}\n"},
    {"pass/common.glsl", "float common;\n"},
    {"shading/lobe.h",
     "#pragma once\n#ifdef __cplusplus\n#include <cmath>\n#include \"only/cpp.h\"\n#else\n#include "
     "\"bridge.h\"\n#endif\nfloat lobe;\n"},
    {"shading/bridge.h", "float bridge;"},  // no newline at its end
    {"cycle/a.h", "#include \"b.h\"\n"},
    {"cycle/b.h", "\n#include \"a.h\"\n"},
    {"bad/missing.frag", "float x;\n  #  include \"nowhere.h\"\n"},
    {"bad/outside.frag", "#include \"../../etc/passwd\"\n"},
    {"bad/malformed.frag", "#include common\n"},
    {"bad/version.frag", "#version 330\nvoid main() {}\n"},
    {"comment.frag", "/* text\n#include \"nowhere.h\"\n*/\n// #include \"nowhere.h\"\nvoid main() {}\n"},
    {"versioned.frag", "#version 450 core\nvoid main() {}\n"},
};
const ShaderLibrary kLibrary({}, kFiles);

}  // namespace

TEST_CASE("includes come in once, with integer #line indices") {
  const std::vector<std::string> defines = {"LIGHTS 4", "FAST"};
  const auto text = kLibrary.resolve("pass/main.frag", defines);
  REQUIRE(text);
  CHECK(text->files ==
        std::vector<std::string>{"pass/main.frag", "pass/common.glsl", "shading/lobe.h", "shading/bridge.h"});
  CHECK(text->text ==
        "#version 450 core\n#define LIGHTS 4\n#define FAST\n"
        "#line 1 0\n\n"
        "#line 1 1\nfloat common;\n#line 3 0\n"
        "#line 1 2\n\n#ifdef __cplusplus\n\n\n#else\n#line 1 3\nfloat bridge;\n#line 7 2\n#endif\nfloat lobe;\n#line 4 "
        "0\n"
        "\nvoid main() {}\n");
}

TEST_CASE("what stands in comments is no directive") {
  const auto text = kLibrary.resolve("comment.frag");
  REQUIRE(text);
  CHECK_THAT(text->text, Contains("/* text\n#include \"nowhere.h\"\n*/"));
}

TEST_CASE("a file's own #version 450 gives way, another is an error") {
  const auto text = kLibrary.resolve("versioned.frag");
  REQUIRE(text);
  CHECK(text->text == "#version 450 core\n#line 1 0\n\nvoid main() {}\n");
  CHECK_THAT(kLibrary.resolve("bad/version.frag").error().message(), Contains("bad/version.frag:1") && Contains("330"));
}

TEST_CASE("faults of includes are clear errors") {
  CHECK_THAT(kLibrary.resolve("cycle/a.h").error().message(),
             Contains("cycle/b.h:2") && Contains("cycle/a.h -> cycle/b.h -> cycle/a.h"));
  CHECK_THAT(kLibrary.resolve("bad/missing.frag").error().message(),
             Contains("bad/missing.frag:2") && Contains("nowhere.h"));
  CHECK_THAT(kLibrary.resolve("bad/outside.frag").error().message(),
             Contains("bad/outside.frag:1") && Contains("leaves"));
  CHECK_THAT(kLibrary.resolve("bad/malformed.frag").error().message(),
             Contains("bad/malformed.frag:1") && Contains("malformed"));
  CHECK_THAT(kLibrary.resolve("absent.frag").error().message(), Contains("absent.frag") && Contains("no such shader"));
  CHECK_FALSE(kLibrary.resolve("../x.frag"));
  CHECK_FALSE(kLibrary.resolve("/etc/passwd"));
  CHECK_FALSE(kLibrary.resolve(""));
  const std::vector<std::string> bad = {"A 1\n#define B"};
  CHECK_FALSE(kLibrary.resolve("pass/main.frag", bad));
}

TEST_CASE("the override folder wins, file by file") {
  const burnish::test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path / "pass");
  std::ofstream(folder.path / "pass/common.glsl") << "float edited;\n";
  const ShaderLibrary library(folder.path, kFiles);
  const auto text = library.resolve("pass/main.frag");
  REQUIRE(text);
  CHECK_THAT(text->text, Contains("float edited;") && Contains("float lobe;") && !Contains("float common;"));
  CHECK_THAT(library.file("nowhere.h").error().message(), Contains(folder.path.string()));
}

TEST_CASE("compiler logs name files") {
  const std::vector<std::string> files = {"a.frag", "b/c.h"};
  CHECK(nameFiles("0:12(5): error: no\n1:3(1): warning: x", files) ==
        "a.frag:12(5): error: no\nb/c.h:3(1): warning: x");                                          // Mesa
  CHECK(nameFiles("1(12) : error C1008: undefined", files) == "b/c.h:12 : error C1008: undefined");  // NVIDIA
  CHECK(nameFiles("ERROR: 0:7: 'x' : undeclared", files) ==
        "ERROR: a.frag:7: 'x' : undeclared");                                                 // AMD, Intel, glslang
  CHECK(nameFiles("9:1(1): error: value 3 of 10", files) == "9:1(1): error: value 3 of 10");  // no such file: as it is
}
