// One atoms file to one material file, and what is said about it to people and machines.
#pragma once

#include <string>
#include <vector>

#include "app/cli/json.h"
#include "app/cli/simplify_pictures.h"
#include "core/material.h"
#include "core/progress.h"
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
  PreprocessJob job;  // the output is the last one written; "" before
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
PreprocessedFile preprocess_file(const PreprocessJob& job, const PreprocessSettings& settings, Progress& progress);
// The two halves of it: all but the writing; and a further stage, which may follow once for each file that is wanted.
PreprocessedFile preprocess_input(const std::string& input, const PreprocessSettings& settings, Progress& progress);
void write_output(PreprocessedFile& file, const std::string& output, bool compress, Progress& progress);

// What a stage of preprocess() made, in a few words: "25,725 atoms, dat; 0 skipped, 0 duplicates". Of material and
// report only what that stage and those before made is looked at (but for the surface, of which `measure` says whether
// it is closed).
std::string stage_outcome(const std::string& stage, const Material& material, const PipelineReport& report);

// A row a stage: its time, the most memory held, what it made.
std::string stage_table(const PreprocessedFile& file);

// What simplifying changed and how near it came to what can go, in a few lines; "" when nothing was simplified.
std::string certificate_text(const PreprocessedFile& file);

// What `preprocess --json` says of one file.
Json preprocess_json(const PreprocessedFile& file);

}  // namespace atomesh::cli
