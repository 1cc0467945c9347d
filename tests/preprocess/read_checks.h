// What the tests of the readers share.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>

#include "core/error.h"
#include "preprocess/read_atoms.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::test {

inline ReadResult read_text(const std::string& name, std::string_view content, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  return read_atoms(folder.file(name, content), options);
}

// The message of the InputError that reading this text ends in, without the folder; "" when it is read.
inline std::string input_error(const std::string& name, std::string_view content, const ReadOptions& options = {}) {
  const TemporaryFolder folder;
  try {
    read_atoms(folder.file(name, content), options);
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    EXPECT_TRUE(message.starts_with(prefix)) << message;
    return message.substr(prefix.size());
  }
  return "";
}

inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same_bits(const Vec3& a, const Vec3& b) {
  return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

inline void expect_same_atoms(const Atoms& a, const Atoms& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(same_bits(a.positions[i], b.positions[i])) << "atom " << i;
    ASSERT_EQ(a.species_name(i), b.species_name(i)) << "atom " << i;
  }
  EXPECT_EQ(a.box.periodic, b.box.periodic);
  EXPECT_TRUE(same_bits(a.box.origin, b.box.origin));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(same_bits(a.box.vectors[k], b.box.vectors[k])) << k;
}

}  // namespace atomesh::test
