// One atoms file to one material file, and what is said about it to people and machines.
#pragma once

#include <string>
#include <vector>

#include "app/cli/json.h"
#include "app/cli/session.h"
#include "app/cli/simplify_pictures.h"
#include "core/material.h"
#include "preprocess/pipeline.h"

namespace atomesh::cli {

struct PreprocessJob {
  std::string input;
  std::string output;  // .crb or .crt
};

struct PreprocessSettings {
  PipelineOptions options;
  bool compress = true;
};

struct PreprocessedFile {
  PreprocessJob job;
  Material material;
  PipelineReport report;
  std::vector<StageTime> stages;            // with the certificate's pictures and the writing
  std::vector<std::uint64_t> stage_memory;  // of each: the most memory held while it ran, bytes
  double total_ms = 0.0;
  std::uint64_t output_bytes = 0;
  // When it was simplified: how many pictures were drawn of either mesh (stage "certify"), and how they differ.
  std::size_t pictures = 0;
  SimplifyPictures::Difference picture_difference;
};

// Provenance::options of what is written, but for the hash of the input. `format` as in provenance_options().
std::vector<std::pair<std::string, std::string>> recorded_options(const PreprocessSettings& settings,
                                                                  const std::string& format);

// Reads, makes and writes. Throws what these throw, and UsageError for an input that is preprocessed already.
PreprocessedFile preprocess_file(const PreprocessJob& job, const PreprocessSettings& settings, Session& session);

// A row a stage: its time, the most memory held, what it made.
std::string stage_table(const PreprocessedFile& file);

// What simplifying changed and how near it came to what can go, in a few lines; "" when nothing was simplified.
std::string certificate_text(const PreprocessedFile& file);

// What `preprocess --json` says of one file.
Json preprocess_json(const PreprocessedFile& file);

}  // namespace atomesh::cli
