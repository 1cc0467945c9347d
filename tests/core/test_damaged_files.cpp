// Whatever is done to a .crb, .crt or .crf, reading it ends in a value or an InputError: never in another exception, a
// crash, or memory that a small file has no right to.
#include <gtest/gtest.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>
#include <functional>
#include <random>

#include "core/crb_format.h"
#include "core/error.h"
#include "core/material_file.h"
#include "core/parameter_file.h"
#include "tests/core/random_material.h"
#include "tests/core/random_parameters.h"
#include "tests/support/temporary_folder.h"

namespace atomesh {
namespace {

using test::difference;
using test::random_material;
using test::read_bytes;
using test::TemporaryFolder;
using test::write_bytes;

const test::MaterialKind small{.atoms = 8, .tetrahedra = 6, .own_vertices = true};

// The message of the InputError that `read` throws, "" when it throws nothing. Anything else goes through.
std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// The section (or "header") a byte of a .crb belongs to.
std::string section_at(const std::vector<SectionInfo>& sections, std::uint64_t byte) {
  std::uint64_t end = sizeof(CrbHeader) + sections.size() * sizeof(CrbEntry);
  if (byte < end) return "header";
  for (const SectionInfo& section : sections) {
    end += section.stored_bytes;
    if (byte < end) return section.name;
  }
  return "";
}

// Makes the checksums of a tampered .crb right again, as far as its table can be followed.
void reseal(std::string& bytes) {
  CrbHeader header{};
  if (bytes.size() < sizeof(header)) return;
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.sections > 64 || bytes.size() < sizeof(header) + header.sections * sizeof(CrbEntry)) return;
  std::vector<CrbEntry> table(header.sections);
  const std::size_t size = table.size() * sizeof(CrbEntry);
  if (size > 0) std::memcpy(table.data(), bytes.data() + sizeof(header), size);
  for (CrbEntry& entry : table) {
    if (entry.offset > bytes.size() || entry.stored > bytes.size() - entry.offset) continue;
    entry.checksum = XXH3_64bits(bytes.data() + entry.offset, entry.stored);
  }
  std::string sealed(bytes.data(), offsetof(CrbHeader, checksum));
  if (size > 0) sealed.append(reinterpret_cast<const char*>(table.data()), size);
  header.checksum = XXH3_64bits(sealed.data(), sealed.size());
  std::memcpy(bytes.data(), &header, sizeof(header));
  if (size > 0) std::memcpy(bytes.data() + sizeof(header), table.data(), size);
}

CrbEntry& entry_of(std::string& bytes, std::string_view name) {
  for (std::size_t at = sizeof(CrbHeader);; at += sizeof(CrbEntry)) {
    auto* entry = reinterpret_cast<CrbEntry*>(bytes.data() + at);
    if (std::string_view(entry->name.data()) == name) return *entry;
  }
}

TEST(DamagedCrb, EveryFlippedBitIsRefusedAndItsSectionNamed) {
  const TemporaryFolder folder;
  const std::string whole = folder.file("whole.crb");
  for (const bool compress : {true, false}) {
    write_material(whole, random_material(3, small), {.compress = compress});
    std::string bytes = read_bytes(whole);
    const std::vector<SectionInfo> sections = list_sections(whole);
    ASSERT_LT(bytes.size(), 8000U);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const std::string section = section_at(sections, i);
      for (int bit = 0; bit < 8; ++bit) {
        bytes[i] = static_cast<char>(bytes[i] ^ (1 << bit));
        const std::string message = refusal([&] { parse_material(bytes, "damaged.crb"); });
        bytes[i] = static_cast<char>(bytes[i] ^ (1 << bit));
        ASSERT_NE(message, "") << "byte " << i << " bit " << bit << " of " << section;
        ASSERT_TRUE(message.starts_with("damaged.crb: ")) << message;
        if (i >= 8) {  // a damaged magic makes it another kind of file
          ASSERT_NE(message.find("section " + section + ": "), std::string::npos) << message;
        }
      }
    }
  }
}

TEST(DamagedCrb, EveryTruncationIsRefusedAndTheFirstSectionMissingNamed) {
  const TemporaryFolder folder;
  const std::string whole = folder.file("whole.crb");
  write_material(whole, random_material(3, small));
  const std::string bytes = read_bytes(whole);
  const std::vector<SectionInfo> sections = list_sections(whole);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string message = refusal([&] { parse_material(bytes.substr(0, length), "cut.crb"); });
    ASSERT_NE(message, "") << length;
    if (length > 0) {
      ASSERT_NE(message.find("section " + section_at(sections, length) + ": "), std::string::npos) << message;
    }
  }
  EXPECT_NE(refusal([&] { parse_material(bytes + '\0', "long.crb"); }), "");
  // And once on a real file.
  write_bytes(folder.file("cut.crb"), std::string_view(bytes).substr(0, bytes.size() / 2));
  EXPECT_TRUE(
      refusal([&] { read_material(folder.file("cut.crb")); }).starts_with(folder.file("cut.crb") + ": section "));
}

TEST(DamagedCrb, WhatIsNotReadDoesNotMatter) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crb");
  write_material(path, random_material(3, small));
  std::string bytes = read_bytes(path);
  const CrbEntry entry = entry_of(bytes, "tetrahedra");
  bytes[entry.offset + entry.stored / 2] ^= 0x10;
  write_bytes(path, bytes);
  EXPECT_NE(refusal([&] { read_material(path); }).find("section tetrahedra: "), std::string::npos);
  EXPECT_NO_THROW(read_material(path, {.tetrahedra = false}));
}

TEST(DamagedCrb, OtherVersionsAreNamed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crb");
  write_material(path, random_material(3, small));
  std::string bytes = read_bytes(path);
  bytes[8] = 7;
  reseal(bytes);
  write_bytes(path, bytes);
  EXPECT_NE(refusal([&] { read_material(path); }).find("version 7, this program reads versions 1 to 3"),
            std::string::npos);
  write_material(folder.file("a.crt"), random_material(3, small));
  std::string text = read_bytes(folder.file("a.crt"));
  text.replace(text.find(" 3\n"), 2, " 12");
  write_bytes(folder.file("a.crt"), text);
  EXPECT_NE(
      refusal([&] { read_material(folder.file("a.crt")); }).find("version 12, this program reads versions 1 to 3"),
      std::string::npos);
}

// Version 2 ends its counts before the number of fields, version 1 before that of substitutions.
TEST(DamagedCrb, OlderVersionsAreReadAndKnowNothingOfWhatCameLater) {
  const TemporaryFolder folder;
  for (const unsigned version : {1U, 2U}) {
    test::MaterialKind kind = small;
    kind.fields = false;
    kind.substitutions = version > 1;
    const Material material = random_material(3, kind);
    const std::string path = folder.file("a.crb");
    write_material(path, material, {.compress = false});
    std::string bytes = read_bytes(path);
    CrbHeader header{};
    std::memcpy(&header, bytes.data(), sizeof(header));
    header.version = version;
    const CrbEntry counts = entry_of(bytes, "counts");
    const std::size_t size = version == 1 ? crb_counts_size_1 : crb_counts_size_2;
    bytes.erase(counts.offset + size, counts.raw - size);
    header.file_size = bytes.size();
    std::memcpy(bytes.data(), &header, sizeof(header));
    for (std::size_t s = 0; s < header.sections; ++s) {
      auto& entry = reinterpret_cast<CrbEntry*>(bytes.data() + sizeof(CrbHeader))[s];
      if (entry.offset > counts.offset) {
        entry.offset -= counts.raw - size;
      } else {
        entry.raw = entry.stored = size;
      }
    }
    reseal(bytes);
    write_bytes(path, bytes);
    EXPECT_EQ(difference(read_material(path), material), "") << version;

    const auto as_version = [&](const Material& m) {
      write_material(folder.file("a.crt"), m);
      std::string text = read_bytes(folder.file("a.crt"));
      text.replace(text.find(" 3\n"), 2, " " + std::to_string(version));
      write_bytes(folder.file("a.crt"), text);
      return folder.file("a.crt");
    };
    EXPECT_EQ(difference(read_material(as_version(material)), material), "");
    kind.fields = version == 2;
    kind.substitutions = version == 1;
    EXPECT_NE(refusal([&] {
                read_material(as_version(random_material(3, kind)));
              }).find(version == 1 ? "substitutions" : "fields"),
              std::string::npos);
  }
}

TEST(DamagedCrb, AForgedSizeAllocatesNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crb");
  write_material(path, random_material(3, small));
  const std::string sound = read_bytes(path);
  const std::uint64_t huge[] = {std::uint64_t{1} << 30U, std::uint64_t{1} << 40U, ~std::uint64_t{0}, ~std::uint64_t{7}};
  for (const std::uint64_t size : huge) {
    for (const SectionInfo& section : list_sections(path)) {
      std::string bytes = sound;
      entry_of(bytes, section.name).raw = size;
      reseal(bytes);
      EXPECT_NE(refusal([&] { parse_material(bytes, "b.crb"); }).find("section " + section.name + ": "),
                std::string::npos);
    }
  }
  // The counts themselves, stored raw so that they can be patched.
  write_material(path, random_material(3, small), {.compress = false});
  for (std::size_t field = 0; field < sizeof(CrbCounts) / 8; ++field) {
    for (const std::uint64_t value :
         {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{0xFFFFFFFE}, huge[0], huge[2]}) {
      std::string bytes = read_bytes(path);
      std::uint64_t before = 0;
      std::memcpy(&before, bytes.data() + entry_of(bytes, "counts").offset + 8 * field, 8);
      if (value == before) continue;
      std::memcpy(bytes.data() + entry_of(bytes, "counts").offset + 8 * field, &value, 8);
      reseal(bytes);
      const std::string message = refusal([&] { parse_material(bytes, "b.crb"); });
      EXPECT_NE(message, "") << "count " << field << " = " << value;
    }
  }
}

TEST(DamagedCrb, AnyTamperingWithRightChecksumsIsAMaterialOrRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crb");
  std::mt19937 random(11);
  std::size_t refused = 0;
  std::size_t accepted = 0;
  for (const bool compress : {true, false}) {
    write_material(path, random_material(4, small), {.compress = compress});
    const std::string sound = read_bytes(path);
    for (int round = 0; round < 4000; ++round) {
      std::string bytes = sound;
      const auto changes = 1 + random() % 3;
      for (unsigned change = 0; change < changes; ++change) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 4) {
          case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
            break;
          case 1:
            bytes[at] = static_cast<char>(random());
            break;
          case 2:
            bytes[at] = static_cast<char>(0xFF);
            break;
          default:
            bytes[at] = 0;
        }
      }
      reseal(bytes);
      const std::string message = refusal([&] { parse_material(bytes, "b.crb"); });
      ++(message.empty() ? accepted : refused);
    }
  }
  EXPECT_GT(refused, 2000U);
  EXPECT_GT(accepted, 500U);  // else the checks behind the checksums were never reached
}

TEST(DamagedCrt, EveryTruncationIsRefusedWithItsLine) {
  const TemporaryFolder folder;
  write_material(folder.file("a.crt"), random_material(3, small));
  const std::string text = read_bytes(folder.file("a.crt"));
  for (std::size_t length = 1; length < text.size() - 1; ++length) {
    const std::string message = refusal([&] { parse_material(text.substr(0, length), "b.crt"); });
    ASSERT_TRUE(message.starts_with("b.crt:")) << length << ": " << message;
  }
  // Only the last newline may be missing.
  EXPECT_EQ(difference(parse_material(text.substr(0, text.size() - 1), "b.crt"), random_material(3, small)), "");
}

TEST(DamagedCrt, MistakesAreNamedWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a.crt");
  write_material(path, random_material(3, small));
  const std::string sound = read_bytes(path);
  // Replaces the first `from` behind `section` and says what the reader says.
  const auto message = [&](const std::string& section, const std::string& from, const std::string& to) {
    std::string text = sound;
    const std::size_t start = text.find("\n" + section + " ");
    EXPECT_NE(start, std::string::npos) << section;
    text.replace(text.find(from, start), from.size(), to);
    const std::string what = refusal([&] { parse_material(text, "b.crt"); });
    EXPECT_TRUE(what.starts_with("b.crt:")) << section << ": " << what;
    return what;
  };
  EXPECT_NE(message("atoms", "atoms 8", "atoms 9").find("expected a coordinate"), std::string::npos);
  EXPECT_NE(message("atoms", "atoms 8", "atoms 7").find("expected \"vertices\""), std::string::npos);
  EXPECT_NE(message("atoms", "atoms 8", "atoms 4000000000").find("lines cannot follow"), std::string::npos);
  EXPECT_NE(message("atoms", "atoms 8", "atoms -1").find("lines cannot follow"), std::string::npos);
  EXPECT_NE(message("tetrahedra", "tetrahedra 6", "tetrahedra 99999999").find("lines cannot follow"),
            std::string::npos);
  EXPECT_NE(message("tetrahedra", "tetrahedra 6", "tetrahedra 6 x").find("unexpected \"x\""), std::string::npos);
  EXPECT_NE(message("atoms", "\n-0 ", "\nnan ").find("expected a coordinate, got \"nan\""), std::string::npos);
  EXPECT_NE(message("atoms", "\n-0 ", "\n-0x ").find("expected a coordinate"), std::string::npos);
  EXPECT_NE(message("atoms", " 5e-324 ", " 5e-324 Xx ").find("\"Xx\" is not in the list of species"),
            std::string::npos);
  EXPECT_NE(message("vertices", " own", " mine").find("expected"), std::string::npos);
  EXPECT_NE(message("species", "\"Na\"", "Na").find("quotes"), std::string::npos);
  EXPECT_NE(message("species", "\"Na\"", "\"Na").find("quote"), std::string::npos);
  EXPECT_NE(message("species", "\"Na\"", "\"\\q\"").find("backslash"), std::string::npos);
  EXPECT_NE(message("species", "\"Na\"", "\"Cl\"").find("Cl stands twice"), std::string::npos);
  EXPECT_NE(message("fields", "fields 3", "fields 9999").find("cannot follow"), std::string::npos);
  EXPECT_NE(message("fields", "fields 3", "fields 60").find("too short for its fields"), std::string::npos);
  EXPECT_NE(message("fields", "fields 3", "fields 2").find("expected a value"), std::string::npos);
  EXPECT_NE(message("fields", "\"constant\"", "\"Density\"").find("Density stands twice"), std::string::npos);
  EXPECT_NE(message("extras", "\nend", "\nend\nmore").find("expected nothing after"), std::string::npos);
}

// Deterministic rough handling of a text file.
std::string mauled(std::string text, std::mt19937& random) {
  const auto changes = 1 + random() % 4;
  for (unsigned change = 0; change < changes && !text.empty(); ++change) {
    const std::size_t at = random() % text.size();
    switch (random() % 7) {
      case 0:
        text[at] = static_cast<char>(random());
        break;
      case 1:
        text.erase(at, 1 + random() % 20);
        break;
      case 2:
        text.insert(at, 1, "0123456789 -+.eE\n\"\\#[]{},=x"[random() % 28]);
        break;
      case 3:
        text[at] = static_cast<char>('0' + random() % 10);
        break;
      case 4: {  // a line twice
        const std::size_t begin = text.rfind('\n', at) + 1;
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        text.insert(begin, text.substr(begin, end - begin));
        break;
      }
      case 5: {  // a line less
        const std::size_t begin = text.rfind('\n', at) + 1;
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        text.erase(begin, end - begin);
        break;
      }
      default:
        text.insert(at, "99999999999999999999");
    }
  }
  return text;
}

TEST(DamagedCrt, RoughHandlingEndsInAMaterialOrIsRefused) {
  const TemporaryFolder folder;
  std::mt19937 random(12);
  std::size_t refused = 0;
  for (const auto& kind : {small, test::MaterialKind{.atoms = 6, .tetrahedra = 4}}) {
    write_material(folder.file("a.crt"), random_material(3, kind));
    const std::string text = read_bytes(folder.file("a.crt"));
    for (int round = 0; round < 4000; ++round) {
      const std::string damaged = mauled(text, random);
      if (!refusal([&] { parse_material(damaged, "b.crt"); }).empty()) ++refused;
    }
  }
  EXPECT_GT(refused, 2000U);
  EXPECT_LT(refused, 8000U);
}

TEST(DamagedCrf, RoughHandlingEndsInParametersOrIsRefused) {
  const TemporaryFolder folder;
  std::mt19937 random(13);
  write_crf(folder.file("a.crf"), test::random_parameters(2, {"Na", "O.w"}));
  const std::string text = read_bytes(folder.file("a.crf"));
  std::size_t refused = 0;
  for (int round = 0; round < 1500; ++round) {
    const std::string path = folder.file("b.crf");
    const std::string damaged = mauled(text, random);
    Parameters read;
    if (!refusal([&] { read = parse_crf(damaged, path); }).empty()) {
      ++refused;
      continue;
    }
    // What was read can be written into that very file, and says the same there.
    if (round % 10 == 0) {
      write_bytes(path, damaged);
      write_crf(path, read);
      ASSERT_EQ(read_crf(path), read);
    }
  }
  EXPECT_GT(refused, 500U);
  EXPECT_LT(refused, 1500U);
}

}  // namespace
}  // namespace atomesh
