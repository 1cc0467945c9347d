// Lines, fields and numbers of text; files that appear whole or not at all.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "core/error.h"
#include "core/file_extension.h"
#include "core/text_file.h"
#include "tests/support/temporary_folder.h"

namespace atomesh::test {
namespace {

std::vector<std::string> lines_of(std::string_view text) {
  LineReader reader(text);
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.next(line)) {
    lines.emplace_back(line);
    EXPECT_EQ(reader.line_number(), lines.size());
  }
  EXPECT_EQ(reader.offset(), text.size());
  return lines;
}

TEST(LowerExtension, IsTheLastOneInLowerCase) {
  EXPECT_EQ(lower_extension("Salt.CRB"), ".crb");
  EXPECT_EQ(lower_extension("/home/A.B/salt.tar.Gz"), ".gz");
  EXPECT_EQ(lower_extension("/home/A.B/salt"), "");
  EXPECT_EQ(lower_extension(".crb"), "");                    // a hidden file's whole name
  EXPECT_EQ(lower_extension("\u00e4.\u00c4B"), ".\u00c4b");  // others stay
}

TEST(LineReader, EveryEndingOfALine) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines_of(""), Lines{});
  EXPECT_EQ(lines_of("\n"), Lines{""});
  EXPECT_EQ(lines_of("a\nb"), (Lines{"a", "b"}));
  EXPECT_EQ(lines_of("a\r\n\r\nb\r\n"), (Lines{"a", "", "b"}));
  EXPECT_EQ(lines_of("a\r\rb\n\nc\n"), (Lines{"a\r\rb", "", "c"}));
}

TEST(Fields, AreSeparatedByAnyBlanks) {
  EXPECT_EQ(split_fields(" a\t bc  \r"), (std::vector<std::string_view>{"a", "bc"}));
  EXPECT_TRUE(split_fields(" \t ").empty());
  std::string_view line = "x  y";
  EXPECT_EQ(next_field(line), "x");
  EXPECT_EQ(next_field(line), "y");
  EXPECT_EQ(next_field(line), "");
  EXPECT_EQ(next_field(line), "");
}

TEST(ParseReal, TakesFiniteNumbersAndNothingElse) {
  double value = 0.0;
  const std::pair<const char*, double> good[] = {{"1", 1.0},
                                                 {"-0", -0.0},
                                                 {"+2.5", 2.5},
                                                 {".5", 0.5},
                                                 {"5.", 5.0},
                                                 {"1e3", 1000.0},
                                                 {"-1.25E-2", -0.0125},
                                                 {"0.1", 0.1},
                                                 {"1e-400", 0.0},
                                                 {"4.9e-324", 4.9e-324},
                                                 {"1.7976931348623157e308", 1.7976931348623157e308}};
  for (const auto& [text, expected] : good) {
    ASSERT_TRUE(parse_real(text, value)) << text;
    EXPECT_EQ(value, expected) << text;
    EXPECT_EQ(std::signbit(value), std::signbit(expected)) << text;
  }
  value = 7.0;
  for (const char* bad :
       {"",     "+",   "-",    ".",        "e5",    "1e",     "1x",   "1 ",  " 1",  "1,5", "nan", "NaN",
        "-nan", "inf", "-inf", "infinity", "1e999", "-1e999", "0x10", "1d3", "+-1", "++1", "--1", "1.2.3"}) {
    EXPECT_FALSE(parse_real(bad, value)) << bad;
  }
  EXPECT_EQ(value, 7.0);
}

TEST(ParseInteger, TakesWholeNumbersThatFit) {
  std::int64_t value = 0;
  EXPECT_TRUE(parse_integer("-9223372036854775808", value));
  EXPECT_EQ(value, std::numeric_limits<std::int64_t>::min());
  EXPECT_TRUE(parse_integer("+17", value));
  EXPECT_EQ(value, 17);
  for (const char* bad : {"", "+", "+-1", "1.0", "1e3", "9223372036854775808", "12a", "0x1"}) {
    EXPECT_FALSE(parse_integer(bad, value)) << bad;
  }
}

TEST(MappedFile, GivesTheBytes) {
  const TemporaryFolder folder;
  const MappedFile file(folder.file("a", std::string_view("x\0y", 3)));
  EXPECT_EQ(file.bytes(), std::string_view("x\0y", 3));
  EXPECT_EQ(MappedFile(folder.file("empty", "")).bytes().size(), 0u);
}

TEST(MappedFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_THROW(MappedFile(folder.file("missing")), InputError);
  EXPECT_THROW(MappedFile(folder.path().string()), InputError);
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_THROW(MappedFile(folder.file("pipe")), InputError);  // and does not wait for a writer
}

TEST(AtomicFile, AppearsOnCommit) {
  const TemporaryFolder folder;
  AtomicFile file(folder.file("a"));
  file.write("new");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a")));
  file.commit();
  EXPECT_EQ(read_bytes(folder.file("a")), "new");
}

TEST(AtomicFile, WithoutCommitTheOldFileStays) {
  const TemporaryFolder folder;
  folder.file("a", "old");
  {
    AtomicFile file(folder.file("a"));
    file.write("half");
  }
  EXPECT_EQ(read_bytes(folder.file("a")), "old");
  const std::filesystem::directory_iterator entries(folder.path());
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
}

// However the process ends: it has no name to be left behind under.
TEST(AtomicFile, HasNoNameBeforeTheCommitWhereTheFileSystemCan) {
  const TemporaryFolder folder;
  const auto entries = [&] {
    const std::filesystem::directory_iterator list(folder.path());
    return std::distance(begin(list), end(list));
  };
  const int probe = ::open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (probe < 0) GTEST_SKIP() << "this file system has no files without a name";
  ::close(probe);
  AtomicFile file(folder.file("a"));
  file.write("whole");
  std::fflush(file.stream());
  EXPECT_EQ(entries(), 0);
  file.commit();
  EXPECT_EQ(entries(), 1);
  EXPECT_EQ(read_bytes(folder.file("a")), "whole");
  struct stat now {};
  ASSERT_EQ(::stat(folder.file("a").c_str(), &now), 0);
  const mode_t mask = ::umask(0);
  ::umask(mask);
  EXPECT_EQ(now.st_mode & 0777U, 0666U & ~mask);  // as any other new file
}

TEST(AtomicFile, CanBeWrittenByName) {
  const TemporaryFolder folder;
  AtomicFile file(folder.file("a"));
  write_bytes(file.place(), "by this process");
  EXPECT_EQ(read_bytes(file.place()), "by this process");
  ASSERT_EQ(std::system(("echo and another >> " + file.place()).c_str()), 0);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a")));
  file.commit();
  EXPECT_EQ(read_bytes(folder.file("a")), "by this processand another\n");
  EXPECT_EQ(folder.count(), 1U);
}

TEST(AtomicFile, FollowsLinksAndWritesThroughDevices) {
  const TemporaryFolder folder;
  folder.file("target", "old");
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  AtomicFile file(folder.file("link"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_bytes(folder.file("target")), "new");
  AtomicFile device("/dev/null");
  device.write("gone");
  device.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, SaysWhyItCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_THROW(AtomicFile(folder.path().string()), Error);
  EXPECT_THROW(AtomicFile(folder.file("no/such/folder")), Error);
}

}  // namespace
}  // namespace atomesh::test
