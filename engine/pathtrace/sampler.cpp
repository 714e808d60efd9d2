#include "pathtrace/sampler.h"

namespace burnish::pathtrace {
namespace {

// Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators" (splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

std::uint32_t reversed(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

// A nested uniform scramble of bits that are reversed: each bit is flipped by a hash of those below it (Laine and Karras 2011; the constants are Vegdahl's, as Burley 2020, section 3, has the method).
std::uint32_t scrambledReversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}
std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) { return reversed(scrambledReversed(reversed(x), seed)); }

// Sobol's second dimension of an index below Sampler::kGroup: rows of Pascal's triangle modulo 2.
std::uint32_t sobol1(std::uint32_t index) {
  constexpr std::uint32_t kColumns[] = {0x80000000u, 0xc0000000u, 0xa0000000u};
  std::uint32_t x = 0;
  for (std::uint32_t bit = 0; bit < 3; ++bit)
    if (index >> bit & 1u) x ^= kColumns[bit];
  return x;
}

float unit(std::uint32_t x) { return float(x >> 8) * (1.0f / 16777216.0f); }

}  // namespace

Sampler::Sampler(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
    : index_(sample % kGroup), state_(mixed(mixed(seed) ^ mixed((std::uint64_t(pixel) << 32) | (sample / kGroup)))) {}

glm::vec2 Sampler::next2() {
  const std::uint64_t a = state_ = mixed(state_), b = mixed(a ^ 0xd1b54a32d192ed03ull);
  // The order of the samples is shuffled too, so that calls do not go together: three bits of a scramble are a permutation of eight.
  const std::uint32_t i = scrambled(index_ << 29, std::uint32_t(a)) >> 29;
  return {unit(reversed(scrambledReversed(i, std::uint32_t(a >> 32)))), unit(scrambled(sobol1(i), std::uint32_t(b)))};
}

float Sampler::next() { return next2().x; }

}  // namespace burnish::pathtrace
