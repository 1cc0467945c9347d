// The samples' own random numbers: the same on every platform and standard library, at any number of threads.
#pragma once

#include <cstdint>

namespace atomesh {

// SplitMix64 (Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195): a counter pushed through a mixing function, so the
// n-th number of a seed is also available on its own.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(mix(seed)) {}

  std::uint64_t next() { return mix(state_ += golden); }
  // [0,1), 53 bits.
  double uniform() { return to_unit(next()); }
  // [0,count); count > 0. The bias of the modulo is below 2^-32 for every count an Index can hold.
  std::uint64_t below(std::uint64_t count) { return next() % count; }

  // The number that belongs to item `index` of stream `seed`, [0,1): for loops that share their work.
  static double uniform_of(std::uint64_t seed, std::uint64_t index) {
    return to_unit(mix(mix(seed) + golden * (index + 1)));
  }

 private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
  static double to_unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace atomesh
