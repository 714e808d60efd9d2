// Whether the suite would notice: stray calls planted into a frame, between its passes and inside one.
#include <catch2/catch.hpp>

#include "zero_cost/account.h"

using namespace burnish;
using namespace burnish::test;

namespace {

GLuint some(const Recorder& r, ObjectKind kind, std::string_view label = {}) {
  for (const auto& [key, object] : r.ledger().alive())
    if (object.kind == kind && object.label.find(label) != std::string::npos) return object.id;
  FAIL("there is no " << kindName(kind) << " '" << label << "'");
  return 0;
}

constexpr float kBlack[4] = {};

/// Where a call is planted.
enum class At : std::uint8_t { Between, Inside, End };  ///< after the second pass; in the pass "tonemap"; after the last pass

struct Plant {
  std::string_view name;
  At at;
  bool account;           ///< the account notices by itself; else only the comparison of two frames does
  void (*call)(Recorder&);
};

#define SHIM(type, function) r.shim<type>(Function::function)

constexpr Plant kPlants[] = {
    {"clear of what is bound", At::Between, true, [](Recorder& r) { SHIM(PFNGLCLEARPROC, Clear)(GL_COLOR_BUFFER_BIT); }},
    {"clear of a target between passes", At::Between, true, [](Recorder& r) { SHIM(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)(some(r, ObjectKind::Framebuffer, "light"), GL_COLOR, 0, kBlack); }},
    {"clear of another pass's target", At::Inside, true, [](Recorder& r) { SHIM(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)(some(r, ObjectKind::Framebuffer, "light"), GL_COLOR, 0, kBlack); }},
    {"clear of what a pass draws all of", At::Inside, true, [](Recorder& r) { SHIM(PFNGLCLEARPROC, Clear)(GL_COLOR_BUFFER_BIT); }},
    {"draw between passes", At::Between, true, [](Recorder& r) { SHIM(PFNGLDRAWARRAYSPROC, DrawArrays)(GL_TRIANGLES, 0, 3); }},
    {"draw once more in a pass", At::Inside, false, [](Recorder& r) { SHIM(PFNGLDRAWARRAYSPROC, DrawArrays)(GL_TRIANGLES, 0, 0); }},
    {"texture bound", At::Inside, true, [](Recorder& r) { SHIM(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)(12, some(r, ObjectKind::Texture)); }},
    {"textures bound at once", At::Inside, true,
     [](Recorder& r) {
       const GLuint ids[2] = {some(r, ObjectKind::Texture), some(r, ObjectKind::Texture)};
       SHIM(PFNGLBINDTEXTURESPROC, BindTextures)(12, 2, ids);
     }},
    {"framebuffer bound", At::Between, true, [](Recorder& r) { SHIM(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)(GL_FRAMEBUFFER, some(r, ObjectKind::Framebuffer)); }},
    {"program bound", At::Between, true, [](Recorder& r) { SHIM(PFNGLUSEPROGRAMPROC, UseProgram)(some(r, ObjectKind::Program)); }},
    {"vertex array bound", At::Between, true, [](Recorder& r) { SHIM(PFNGLBINDVERTEXARRAYPROC, BindVertexArray)(some(r, ObjectKind::VertexArray)); }},
    {"uniform buffer bound after the last draw", At::End, true, [](Recorder& r) { SHIM(PFNGLBINDBUFFERBASEPROC, BindBufferBase)(GL_UNIFORM_BUFFER, 5, some(r, ObjectKind::Buffer)); }},
    {"uniform of a program that is not drawn with", At::Between, true, [](Recorder& r) { SHIM(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)(some(r, ObjectKind::Program, "gbuffer"), 0, 1); }},
    {"buffer written again", At::Inside, true, [](Recorder& r) { SHIM(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)(some(r, ObjectKind::Buffer, "frame data"), 0, 16, kBlack); }},
    {"buffer made", At::Between, true,
     [](Recorder& r) {
       GLuint id = 0;
       SHIM(PFNGLCREATEBUFFERSPROC, CreateBuffers)(1, &id);
       SHIM(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage)(id, 64, nullptr, 0);
     }},
    {"texture made", At::Inside, true,
     [](Recorder& r) {
       GLuint id = 0;
       SHIM(PFNGLCREATETEXTURESPROC, CreateTextures)(GL_TEXTURE_2D, 1, &id);
       SHIM(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D)(id, 1, GL_RGBA8, 16, 16);
     }},
    {"framebuffer made and freed", At::Between, true,
     [](Recorder& r) {
       GLuint id = 0;
       SHIM(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers)(1, &id);
       SHIM(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)(1, &id);
     }},
    {"buffer's store made larger", At::Inside, true, [](Recorder& r) { SHIM(PFNGLNAMEDBUFFERDATAPROC, NamedBufferData)(some(r, ObjectKind::Buffer, "draw data"), 1 << 20, nullptr, GL_STREAM_DRAW); }},
    {"query", At::Inside, true,
     [](Recorder& r) {
       GLuint id = 0;
       SHIM(PFNGLGENQUERIESPROC, GenQueries)(1, &id);
       SHIM(PFNGLQUERYCOUNTERPROC, QueryCounter)(id, GL_TIMESTAMP);
       SHIM(PFNGLDELETEQUERIESPROC, DeleteQueries)(1, &id);
     }},
    {"fence", At::Between, true, [](Recorder& r) { SHIM(PFNGLDELETESYNCPROC, DeleteSync)(SHIM(PFNGLFENCESYNCPROC, FenceSync)(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)); }},
    {"finish", At::Inside, true, [](Recorder& r) { SHIM(PFNGLFINISHPROC, Finish)(); }},
    {"flush", At::Between, true, [](Recorder& r) { SHIM(PFNGLFLUSHPROC, Flush)(); }},
    {"question", At::Inside, true,
     [](Recorder& r) {
       GLint value = 0;
       SHIM(PFNGLGETINTEGERVPROC, GetIntegerv)(GL_MAX_TEXTURE_SIZE, &value);
     }},
    {"read back", At::Inside, true,
     [](Recorder& r) {
       float texel[4] = {};
       SHIM(PFNGLGETTEXTURESUBIMAGEPROC, GetTextureSubImage)(some(r, ObjectKind::Texture, "exposure"), 0, 0, 0, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, sizeof texel, texel);
     }},
    {"barrier", At::Between, true, [](Recorder& r) { SHIM(PFNGLMEMORYBARRIERPROC, MemoryBarrier)(GL_ALL_BARRIER_BITS); }},
    {"mip levels", At::Inside, true, [](Recorder& r) { SHIM(PFNGLGENERATETEXTUREMIPMAPPROC, GenerateTextureMipmap)(some(r, ObjectKind::Texture, "light")); }},
    {"blit", At::Between, true,
     [](Recorder& r) {
       const GLuint light = some(r, ObjectKind::Framebuffer, "light");
       SHIM(PFNGLBLITNAMEDFRAMEBUFFERPROC, BlitNamedFramebuffer)(light, light, 0, 0, 1, 1, 2, 2, 3, 3, GL_COLOR_BUFFER_BIT, GL_NEAREST);
     }},
    {"state", At::Inside, false, [](Recorder& r) { SHIM(PFNGLENABLEPROC, Enable)(GL_DITHER); }},
};

#undef SHIM

/// A frame with a light buffer and a metered exposure, on which every plant finds what it names.
constexpr std::size_t kPasses = 6;
Subject garden() {
  Subject s = stand();
  s.quality.exposureEv.reset();
  return s;
}

Observation planted(const Plant& plant, bool& done) {
  return observe(garden(), {.plant = [&plant, &done, passes = std::size_t(0)](Recorder& r, Function f) mutable {
                   const std::string& group = r.ledger().groupNames()[r.ledger().group()];
                   const bool ends = f == Function::PopDebugGroup && group.empty();
                   passes += ends;
                   const bool here = plant.at == At::Inside ? group == "tonemap" && f != Function::PushDebugGroup : ends && passes == (plant.at == At::Between ? 2 : kPasses);
                   if (done || !here) return;
                   done = true;
                   plant.call(r);
                 }});
}

}  // namespace

TEST_CASE("zero cost: stray calls are noticed", "[zero_cost][mutation]") {
  const Observation clean = observe(garden());
  CHECK(clean.strays == std::vector<std::string>{});
  CHECK(clean.plan.passes.size() == kPasses);
  CHECK(std::size(kPlants) >= 17);
  for (const Plant& plant : kPlants) {
    INFO(plant.name);
    bool done = false;
    const Observation dirty = planted(plant, done);
    CHECK(done);
    CHECK(difference(clean, dirty).has_value());
    if (plant.account) CHECK(!dirty.strays.empty());
  }
}

TEST_CASE("zero cost: two observations of the same frame are the same", "[zero_cost][mutation]") {
  const Observation a = observe(garden()), b = observe(garden());
  CHECK(difference(a, b).value_or("") == "");
}
