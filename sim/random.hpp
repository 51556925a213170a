// The project's one source of chance: numbers that depend on (seed, stream, index) and nothing else, so that any part
// of a scene can be generated alone, in any order and on any number of threads. Integer arithmetic up to the last step.
#pragma once
#include <cstdint>
#include <string_view>

namespace understory {

/// Finaliser of SplitMix64 (Steele, Lea, Flood 2014; constants of Stafford's variant 13): a bijection that flips every
/// output bit with probability one half for every flipped input bit.
constexpr std::uint64_t mix_bits(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
  return value ^ (value >> 31);
}

/// A stream's number from its name (FNV-1a, 64 bits), and from a name and an ordinal.
constexpr std::uint64_t stream_of(std::string_view name, std::uint64_t ordinal = 0) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return mix_bits(hash + ordinal * 0x9e3779b97f4a7c15u);
}

/// A short sequence of draws: `index` is the thing it is for (a plant, a blade, a leaf).
class Random {
 public:
  constexpr Random(std::uint64_t seed, std::uint64_t stream, std::uint64_t index = 0)
      : state_(mix_bits(mix_bits(mix_bits(seed + golden_) ^ stream) + index * golden_)) {}

  /// 64 random bits (SplitMix64).
  constexpr std::uint64_t bits() { return mix_bits(state_ += golden_); }
  /// In [0, 1), a multiple of 2^-53.
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// In [low, high).
  constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In 0 .. count - 1; `count` > 0. Bias below count / 2^53.
  constexpr std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }
  /// Mean 0, deviation 1, never beyond +-6: the sum of twelve uniforms (Irwin-Hall). No library function is involved,
  /// so that every machine draws the same bits; no tail makes a blade of absurd length.
  constexpr double normal() {
    std::uint64_t sum = 0;
    for (int draw = 0; draw < 3; ++draw) {
      const std::uint64_t four = bits();
      sum += (four & 0xffff) + ((four >> 16) & 0xffff) + ((four >> 32) & 0xffff) + (four >> 48);
    }
    return (static_cast<double>(sum) + 6) / 65536 - 6;  // + 6: the middle of each 16-bit step
  }
  constexpr double normal(double mean, double deviation) { return mean + deviation * normal(); }

 private:
  static constexpr std::uint64_t golden_ = 0x9e3779b97f4a7c15u;  // 2^64 / golden ratio, odd
  std::uint64_t state_;
};

}  // namespace understory
