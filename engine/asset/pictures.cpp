#include "asset/pictures.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <system_error>
#include <thread>

#include "asset/uri.h"
#include "core/file.h"

namespace burnish::asset {
namespace {

constexpr TextureRef Material::*kSlots[] = {
    &Material::baseColorTexture,     &Material::metallicRoughnessTexture, &Material::normalTexture,
    &Material::occlusionTexture,     &Material::emissiveTexture,          &Material::specularTexture,
    &Material::specularColorTexture, &Material::diffuseTexture,           &Material::specularGlossinessTexture};

std::string imagePath(std::size_t i, const char* member = "") { return fmt::format("/images/{}{}", i, member); }

std::vector<bool> usedPictures(const Document& doc) {
  std::vector<bool> used(doc.pictures.size());
  for (const Material& m : doc.materials)
    for (const auto slot : kSlots)
      if (const TextureRef& ref = m.*slot)
        if (const int picture = doc.textures[std::size_t(ref.texture)].picture; picture >= 0)
          used[std::size_t(picture)] = true;
  return used;
}

// A name inside the folder that nothing stands behind. Everything else that cannot be resolved is a refusal: told apart
// by asking again without the guard, and by looking whether something is there that is no file.
bool isMissing(const Source& source, const std::string& uri, const Error& refusal) {
  if (uriKind(uri) != UriKind::Relative) return false;
  const std::string name = percentDecoded(uri);
  std::error_code ignored;
  const auto status = std::filesystem::status(source.folder / name, ignored);
  if (name.find('\0') != name.npos || status.type() != std::filesystem::file_type::not_found) return false;
  const auto unguarded = core::resolveInside(source.folder, uri, true);
  return !unguarded && unguarded.error().what == refusal.what;
}

// The canonical path of a picture's file; empty when there is none (a warning where the picture is used).
std::filesystem::path resolve(Check& check, const Source& source, const std::string& uri, std::size_t index,
                              bool used) {
  if (uriKind(uri) == UriKind::Invalid)
    check.fail(imagePath(index, "/uri"), fmt::format("'{}' is no URI", uri.substr(0, 80)));
  if (!used && uri.starts_with("http"))
    check.warn(imagePath(index, "/uri"), "nothing is fetched from a network; the picture is not used");
  if (!check.ok() || (!used && uri.starts_with("http"))) return {};
  auto path = core::resolveInside(source.folder, uri, source.allowOutside);
  if (path) return std::move(*path);
  const Error& e = path.error();
  if (!isMissing(source, uri, e))
    check.fail(imagePath(index, "/uri"), e.place + ": " + e.what, e.remedy);
  else if (used)
    check.warn(imagePath(index), fmt::format("picture {} was not found: materials go on without it", e.place));
  return {};
}

struct Job {
  std::size_t index = 0;
  std::span<const std::byte> bytes;  // of a buffer view or of `data`
  std::vector<std::byte> data;
  const std::string* uri = nullptr;  // read when its turn comes, so that few files are in memory at a time
};

// What is to be decoded; faults of paths and data URIs come to light here.
class Collector {
 public:
  Collector(Check& check, Document& doc, const Source& source) : check_(check), doc_(doc), source_(source) {}

  void add(std::size_t index, bool used) {
    const PictureSource& p = doc_.pictures[index];
    if (p.view >= 0) {
      const auto bytes = bytesOf(doc_, p.view);
      if (used && bytes.empty())
        check_.warn(imagePath(index), "the picture's buffer has no data: materials go on without it");
      else if (used)
        jobs.push_back({index, bytes, {}, nullptr});
    } else if (uriKind(*p.uri) == UriKind::Data) {
      auto data = decodeDataUri(*p.uri);
      if (!data) return check_.fail(imagePath(index, "/uri"), data.error().what);
      if (!used) return;
      jobs.push_back({index, {}, std::move(data->bytes), nullptr});
      jobs.back().bytes = jobs.back().data;
    } else {
      const auto file = resolve(check_, source_, *p.uri, index, used);
      if (!used || !check_.ok() || file.empty()) return;
      const auto [first, fresh] = files_.try_emplace(file.native(), index);
      if (fresh)
        jobs.push_back({index, {}, {}, p.uri});
      else
        same_[int(index)] = int(first->second);
    }
  }
  void shareSameFiles() {
    for (Texture& t : doc_.textures)
      if (const auto same = same_.find(t.picture); same != same_.end()) t.picture = same->second;
  }
  std::vector<Job> jobs;

 private:
  Check& check_;
  Document& doc_;
  const Source& source_;
  std::map<std::string, std::size_t> files_;  // canonical path to the first image that names it
  std::map<int, int> same_;
};

// Decodes the jobs on one thread or two; answers stand at the jobs' places, so that reports do not depend on who was
// faster.
class Decoding {
 public:
  Decoding(const Document& doc, Source& source, ImageDecoder& decoder, const std::vector<Job>& jobs)
      : doc_(doc), source_(source), decoder_(decoder), jobs_(jobs), answers_(jobs.size()) {}

  std::vector<Result<Image>> run() {
    std::jthread second;  // joins before the answers are handed over, whatever happens
    if (decoder_.concurrency() > 1 && jobs_.size() > 1) {
      try {
        second = std::jthread([this] { work(); });
      } catch (const std::system_error&) {  // no second thread to be had: one does it all
      }
    }
    work();
    if (second.joinable()) second.join();
    return std::move(answers_);
  }

 private:
  void work() {
    for (std::size_t i = next_++; i < jobs_.size(); i = next_++) {
      try {
        answers_[i] = decode(jobs_[i]);
      } catch (const std::exception&) {
        answers_[i] = fail("", "there is not enough memory");
      }
    }
  }

  Result<Image> decode(const Job& job) {
    if (!job.uri) return decode(job.bytes, job.index);
    std::unique_lock lock(budget_);
    auto bytes = core::readFileInside(source_.folder, *job.uri, source_.allowOutside, source_.bytesLeft);
    if (bytes) source_.bytesLeft -= bytes->size();
    lock.unlock();
    return bytes ? decode(*bytes, job.index) : fail(bytes.error());
  }

  Result<Image> decode(std::span<const std::byte> bytes, std::size_t index) {
    DecodeLimits limits;
    {
      const std::lock_guard lock(budget_);
      limits.maxBytes = std::min(limits.maxBytes, decodedLeft_);
    }
    auto image = decoder_.decode(bytes, doc_.pictures[index].name, limits);
    const std::lock_guard lock(budget_);
    if (image) decodedLeft_ -= std::min<std::uint64_t>(decodedLeft_, image->byteSize());
    return image;
  }

  const Document& doc_;
  Source& source_;
  ImageDecoder& decoder_;
  const std::vector<Job>& jobs_;
  std::vector<Result<Image>> answers_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex budget_;
  std::uint64_t decodedLeft_ = std::uint64_t(8) << 30;  // pixels of all pictures together, bytes
};

}  // namespace

std::vector<Picture> loadPictures(Check& check, Document& doc, Source& source, ImageDecoder& decoder) {
  std::vector<Picture> out(doc.pictures.size());
  const std::vector<bool> used = usedPictures(doc);
  Collector collector(check, doc, source);
  for (std::size_t i = 0; check.ok() && i < out.size(); ++i) {
    out[i].name = doc.pictures[i].name;
    collector.add(i, used[i]);
  }
  if (!check.ok()) return out;
  collector.shareSameFiles();
  auto images = Decoding(doc, source, decoder, collector.jobs).run();
  for (std::size_t i = 0; i < images.size(); ++i) {
    Picture& picture = out[collector.jobs[i].index];
    if (images[i])
      picture.pixels = std::move(*images[i]);
    else
      check.warn(imagePath(collector.jobs[i].index),
                 fmt::format("picture {} cannot be used: {}: materials go on without it", picture.name,
                             images[i].error().what));
  }
  return out;
}

void dropMissingTextures(Check& check, std::vector<Material>& materials, const std::vector<Texture>& textures,
                         const std::vector<Picture>& pictures) {
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const auto slot : kSlots) {
      TextureRef& ref = materials[i].*slot;
      if (!ref) continue;
      const int picture = textures[std::size_t(ref.texture)].picture;
      if (picture >= 0 && !pictures[std::size_t(picture)].pixels.empty()) continue;
      if (picture < 0)
        check.warn(fmt::format("/textures/{}", ref.texture),
                   "the texture has no picture that can be read: materials go on without it");
      ref.texture = -1;
    }
}

}  // namespace burnish::asset
