// What the process holds, what it may still take, and how it says that something will not fit.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <memory>

#include "core/content_hash.h"
#include "core/error.h"
#include "core/memory.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

constexpr std::uint64_t megabyte = 1'000'000;

// Memory that is really there.
std::unique_ptr<char[]> touched(std::size_t bytes) {
  std::unique_ptr<char[]> block(new char[bytes]);
  std::memset(block.get(), 1, bytes);
  return block;
}

TEST(Memory, PeaksRiseWithWhatIsTakenAndCanBeForgotten) {
  constexpr std::size_t bytes = 64 * megabyte;
  const std::uint64_t before = current_memory();
  ASSERT_GT(before, 0U);
  reset_peak_memory();
  {
    const auto block = touched(bytes);
    EXPECT_GE(current_memory(), before + bytes / 2);
    EXPECT_GE(recent_peak_memory(), before + bytes / 2);
  }
  release_free_memory();
  reset_peak_memory();
  const std::uint64_t whole = peak_memory();
  EXPECT_GE(whole, before + bytes / 2) << "the peak since the start is kept";
#if !defined(__SANITIZE_ADDRESS__)  // whose allocator keeps what is freed
  EXPECT_LT(recent_peak_memory(), whole) << "the recent one is forgotten";
#endif
}

TEST(Memory, ThereIsRoomForALittleAndNotForEverything) {
  ASSERT_TRUE(memory_room().has_value());
  EXPECT_NO_THROW(require_memory("a test", megabyte, "do nothing"));
  try {
    require_memory("a test", std::uint64_t{1} << 60, "try less");
    FAIL() << "an exabyte fits?";
  } catch (const UnavailableError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("a test needs about 1152921504.6 GB"), std::string::npos) << text;
    EXPECT_NE(text.find("try less"), std::string::npos) << text;
    EXPECT_NE(text.find("can be had ("), std::string::npos) << text;
  }
}

TEST(Memory, ALimitBelowWhatIsHeldIsRefused) {
  EXPECT_THROW(limit_memory(1000), UsageError);
}

TEST(Memory, ControlGroupsOfBothVersions) {
  const test::TemporaryFolder folder;
  namespace fs = std::filesystem;
  const std::string root = folder.path().string();
  fs::create_directories(root + "/memory/job/step");
  fs::create_directories(root + "/user/shell");
  const auto write = [&](const std::string& name, const std::string& text) { test::write_bytes(root + name, text); };

  EXPECT_FALSE(control_group_room("4:memory:/job/step\n0::/\n", root)) << "no files, no limit";
  write("/memory/job/step/memory.limit_in_bytes", "9223372036854771712\n");
  write("/memory/job/step/memory.usage_in_bytes", "1000\n");
  write("/memory/job/memory.limit_in_bytes", "500000000\n");
  write("/memory/job/memory.usage_in_bytes", "300000000\n");
  write("/memory/job/memory.stat", "cache 7\ntotal_inactive_file 100000000\n");
  const auto v1 = control_group_room("5:devices:/x\n4:cpu,memory:/job/step\n0::/\n", root);
  ASSERT_TRUE(v1.has_value());
  EXPECT_EQ(v1->bytes, 300000000U) << "the outer group's limit counts, file pages that can go do not";

  write("/user/memory.max", "max\n");
  write("/user/memory.current", "5\n");
  EXPECT_FALSE(control_group_room("0::/user/shell", root));
  write("/user/shell/memory.max", "1000\n");
  write("/user/shell/memory.current", "5000\n");
  const auto v2 = control_group_room("0::/user/shell", root);
  ASSERT_TRUE(v2.has_value());
  EXPECT_EQ(v2->bytes, 0U) << "over the limit there is nothing left";
  EXPECT_FALSE(control_group_room("nonsense\n:\n", root));
}

TEST(Memory, TextsAreForPeople) {
  EXPECT_EQ(memory_text(1'500'000), "1.5 MB");
  EXPECT_EQ(memory_text(340 * megabyte), "340 MB");
  EXPECT_EQ(memory_text(1020 * megabyte), "1.02 GB");
  EXPECT_EQ(memory_text(24105 * megabyte), "24.1 GB");
}

TEST(ContentHash, TellsContentsApart) {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a", std::string(40'000'000, 'x'));
  EXPECT_EQ(content_hash_of_file(a), content_hash_of_file(folder.file("b", std::string(40'000'000, 'x'))));
  std::string other(40'000'000, 'x');
  other[39'999'999] = 'y';
  EXPECT_NE(content_hash_of_file(a), content_hash_of_file(folder.file("c", other)));
  // XXH3-128 of nothing, as the reference implementation's test vectors have it.
  EXPECT_EQ(content_hash(""), "xxh3-128:99aa06d3014798d86001c324468d497f");
  EXPECT_THROW(content_hash_of_file(folder.file("none")), InputError);
}

}  // namespace
}  // namespace atomesh
