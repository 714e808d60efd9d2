// readGltf: container, JSON, validation, data, pictures, nodes, in this order. docs/decisions/gltf_reader.md says why tinygltf
// stands nowhere in it, and lists the bounds.
#include <fmt/format.h>

#include <cmath>
#include <new>

#include "asset/elements.h"
#include "asset/glb.h"
#include "asset/pictures.h"
#include "core/file.h"

namespace burnish::asset {
namespace {

bool finite(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!(std::abs(m[c][r]) <= double(std::numeric_limits<float>::max()))) return false;
  return true;
}

// The roots of what is shown: of the file's scene, or all there are where the file has no scenes.
std::vector<int> rootsOf(const Document& doc) {
  if (doc.scene >= 0) return doc.scenes[std::size_t(doc.scene)].nodes;
  std::vector<int> roots;
  for (std::size_t i = 0; i < doc.nodes.size(); ++i)
    if (doc.nodes[i].parent < 0) roots.push_back(int(i));
  return roots;
}

// Depth first, parents before children, with a stack of our own: trees may be as deep as they have nodes.
// `shown` gets the place of each of the document's nodes in the result, -1 for those that are not in it.
std::vector<Node> buildNodes(Check& check, const Document& doc, std::vector<int>& shown) {
  struct Todo {
    int source, parent;
  };
  std::vector<Node> out;
  std::vector<glm::dmat4> world;
  std::vector<Todo> stack;
  const auto push = [&](const std::vector<int>& list, int parent) {
    for (auto i = list.rbegin(); i != list.rend(); ++i) stack.push_back({*i, parent});
  };
  push(rootsOf(doc), -1);
  while (check.ok() && !stack.empty()) {
    const Todo todo = stack.back();
    stack.pop_back();
    const NodeSource& n = doc.nodes[std::size_t(todo.source)];
    world.push_back(todo.parent < 0 ? n.local : world[std::size_t(todo.parent)] * n.local);
    if (!finite(world.back()))
      check.fail(fmt::format("/nodes/{}", todo.source), "the node's transform in the scene is not finite");
    push(n.children, int(out.size()));
    shown[std::size_t(todo.source)] = int(out.size());
    out.push_back({n.name, todo.parent, n.local, n.mesh, n.camera, n.light, n.skin,
                   std::vector<float>(n.weights.begin(), n.weights.end()), n.translation, n.scale, n.rotation,
                   n.probe, n.probeGrid});
  }
  return out;
}

void checkEnvironment(Check& check, const Document& doc, const Source& source) {
  if (doc.scene < 0) return;
  const std::string& uri = doc.scenes[std::size_t(doc.scene)].environment;
  if (uri.empty()) return;
  if (auto path = core::resolveInside(source.folder, uri, source.allowOutside); !path)
    check.fail(fmt::format("/scenes/{}/extras/burnish/environment", doc.scene),
               path.error().place + ": " + path.error().what, path.error().remedy);
}

Result<Asset> finish(Check& check, Document& doc, Source& source, std::uint64_t sourceBytes, ImageDecoder& decoder) {
  Asset asset;
  validateDocument(check, doc);
  if (check.ok()) loadBuffers(check, doc, source);
  for (const Buffer& b : doc.buffers) sourceBytes += b.owned.size();
  if (check.ok()) validateData(check, doc, sourceBytes);
  if (check.ok()) asset.meshes = buildMeshes(check, doc, sourceBytes);
  std::vector<int> shown(doc.nodes.size(), -1);
  if (check.ok()) asset.nodes = buildNodes(check, doc, shown);
  if (check.ok()) buildMotion(check, doc, shown, sourceBytes, asset);
  if (check.ok()) checkEnvironment(check, doc, source);
  if (check.ok()) asset.pictures = loadPictures(check, doc, source, decoder);
  if (!check.ok()) return fail(check.error());
  dropMissingTextures(check, doc.materials, doc.textures, asset.pictures);
  asset.samplers = std::move(doc.samplers);
  asset.textures = std::move(doc.textures);
  asset.materials = std::move(doc.materials);
  asset.cameras = std::move(doc.cameras);
  asset.lights = std::move(doc.lights);
  if (doc.scene >= 0) {
    asset.environment = doc.scenes[std::size_t(doc.scene)].environment;
    asset.fog = doc.scenes[std::size_t(doc.scene)].fog;
    asset.sky = doc.scenes[std::size_t(doc.scene)].sky;
  }
  return asset;
}

Result<Asset> read(const std::filesystem::path& file, const ReadOptions& options, Report& report) {
  const std::string place = file.filename().string();
  if (!options.decoder)
    return fail(place, "ReadOptions::decoder is not set", "pass makeDecoderPool() or a decoder of your own");
  auto bytes = core::readFile(file, options.maxFileBytes);
  if (!bytes) return fail(std::move(bytes.error()));
  Source source{file.parent_path(), options.allowOutside, options.maxFileBytes - bytes->size(), {}};
  std::span<const std::byte> text = *bytes;
  if (isGlb(*bytes)) {
    auto glb = parseGlb(*bytes, place, report);
    if (!glb) return fail(std::move(glb.error()));
    text = glb->json;
    source.glbChunk = glb->binary ? *glb->binary : std::span<const std::byte>{};
  }
  auto json = parseJson(text, place, {.depth = options.maxJsonDepth});
  if (!json) return fail(std::move(json.error()));
  Check check(place, report);
  Document doc = parseDocument(*json, check);
  if (!check.ok()) return fail(check.error());
  auto asset = finish(check, doc, source, bytes->size(), *options.decoder);
  if (asset) asset->name = place;
  return asset;
}

}  // namespace

Result<Asset> readGltf(const std::filesystem::path& file, const ReadOptions& options, Report& report) {
  try {
    return read(file, options, report);
  } catch (const std::bad_alloc&) {
    return fail(file.filename().string(), "there is not enough memory to read it", "use a smaller file");
  } catch (const std::length_error&) {
    return fail(file.filename().string(), "there is not enough memory to read it", "use a smaller file");
  }
}

}  // namespace burnish::asset
