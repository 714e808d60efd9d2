// Pictures of qualities, on one thread or two.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "cost/bench_impl.h"

namespace burnish::cost {

const Image* Bench::Impl::kept(const Quality& key) const {
  const auto found = std::find_if(pictures.begin(), pictures.end(), [&](const auto& k) { return k->key == key; });
  return found == pictures.end() ? nullptr : &(*found)->picture;
}

Result<Image> Bench::Impl::shoot(const Quality& key) {
  auto picture = linearPicture(*renderer, *linear, scene, view, key);
  if (picture) targets = renderer->lastPlan().targets;
  return picture;
}

Result<const Image*> Bench::picture(const Quality& quality) {
  const auto one = pictures({&quality, 1});
  return one ? Result<const Image*>(one->front()) : fail(one.error());
}

void Bench::assist(ContextMaker open) {
  if (open) impl_->assistant = std::make_unique<Assistant>(*this, std::move(open));
}

Result<std::vector<const Image*>> Bench::pictures(std::span<const Quality> qualities, const std::function<bool()>& goOn) {
  Impl& b = *impl_;
  std::vector<Quality> keys;
  for (const Quality& q : qualities)
    if (const Quality key = pictureKey(q, b.exposureEv); !b.kept(key) && std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  std::vector<std::unique_ptr<Image>> made(keys.size());
  std::atomic<std::size_t> next = 0;  // the one that is begun next, by whoever is free
  const auto work = [&](const std::function<Result<Image>(const Quality&)>& shoot) -> Result<void> {
    for (std::size_t i; (!goOn || goOn()) && (i = next++) < keys.size();) {
      auto picture = shoot(keys[i]);
      if (!picture) return fail(picture.error());
      made[i] = std::make_unique<Image>(std::move(*picture));
      hold(*made[i]);
    }
    return {};
  };
  const bool two = b.assistant && keys.size() > 1;
  if (two) b.assistant->begin([&](Studio& studio) { return work([&](const Quality& key) { return studio.picture(b.scene, key); }); });
  const Result<void> own = work([&](const Quality& key) { return b.shoot(key); });
  const Result<void> other = two ? b.assistant->wait() : Result<void>();
  if (!own) return fail(own.error());
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (made[i]) b.pictures.push_back(std::make_unique<Impl::Kept>(Impl::Kept{keys[i], std::move(*made[i])}));
  if (!other) {
    b.report.warn("second context", fmt::format("{}: all pictures are made on the first", other.error().message()));
    b.assistant.reset();
    return pictures(qualities, goOn);
  }
  std::vector<const Image*> out;
  for (const Quality& q : qualities) out.push_back(b.kept(pictureKey(q, b.exposureEv)));
  return out;
}

void Bench::forget(std::span<const Quality> but) {
  Impl& b = *impl_;
  std::vector<Quality> keys{pictureKey(b.base, b.exposureEv)};
  for (const Quality& q : but) keys.push_back(pictureKey(q, b.exposureEv));
  std::erase_if(b.pictures, [&](const auto& kept) { return std::find(keys.begin(), keys.end(), kept->key) == keys.end(); });
}

}  // namespace burnish::cost
