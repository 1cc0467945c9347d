#include "core/content_hash.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <new>

#include "core/text_file.h"

namespace atomesh {

std::string content_hash(std::string_view bytes, Progress& progress) {
  constexpr std::size_t piece = std::size_t{16} << 20U;
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), &XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_128bits_reset(state.get());
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    progress.check();
    const std::string_view part = bytes.substr(at, piece);
    XXH3_128bits_update(state.get(), part.data(), part.size());
  }
  const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "xxh3-128:%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text.data();
}

std::string content_hash_of_file(const std::string& path, Progress& progress) {
  const MappedFile file(path);
  return content_hash(file.bytes(), progress);
}

}  // namespace atomesh
