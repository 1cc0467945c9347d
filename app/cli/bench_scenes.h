// The data sets that pictures are timed and judged on, by name, each with a colour map, an extinction and views that
// show it.
#pragma once

#include <string>
#include <vector>

#include "core/material.h"
#include "core/parameters.h"
#include "core/progress.h"

namespace atomesh::cli {

struct BenchView {
  std::string name;       // "iso"
  std::string direction;  // for set_view()
  Projection projection = Projection::perspective;
};

struct BenchScene {
  std::string name;
  Material material;
  // For every mode: colour map, alpha_length, base colour. The middle of the sample is a few optical depths thick, so
  // that both what lies in front and what lies behind count.
  Parameters parameters;
  std::vector<BenchView> views;
  // What mode volume shows, for people: "peaks", a colour map with peaks. Where that would leave the picture nearly
  // empty: defects that are few stand in a crystal that is no longer transparent ("peaks in haze": the peaks, and
  // opacity 0.05 where the scalar is 0 and wherever they had less); a sample whose scalar is the same everywhere gets
  // the lattices' smooth one as a field ("peaks of waves").
  std::string volume_map = "peaks";
  std::string volume_field;  // of the material, that mode volume shows; "": that of all modes

  Parameters seen(const BenchView& view, Mode mode) const;
};

struct BenchSceneInfo {
  std::string name;
  std::string description;
  std::string file;  // of the folder of public data sets; "" for what is grown here
};

// lattice-36, lattice-58, lattice-100: jittered cubic lattices of n³ points (0.32, 1.35 and 6.9 million cells), meshed
// by Delaunay, with a smooth scalar; lattice-36-random, … with a random one. The ten samples by their names
// (samples.h), preprocessed. The public data sets: comb, blunt-fin, post, usm3d-box, quake, chaste-cube, raptor.
const std::vector<BenchSceneInfo>& bench_scene_table();

// Where the public data sets lie: `folder`, or ../shared/data/volume where it is empty.
std::string volume_data_folder(const std::string& folder);

// A name of the table, or lattice-N and lattice-N-random for any N from 2 to 200. `atoms` of a sample, 0 for the seed's
// count. Throws UsageError for an unknown name (naming the nearest), UnavailableError where the file is not there.
BenchScene make_bench_scene(const std::string& name, const std::string& data_folder = "", std::size_t atoms = 0,
                            Progress& progress = no_progress());

// Below this mean coverage of what the sample covers when it is opaque, a picture of mode volume from the first view is
// nearly empty, and says nothing about who drew it.
inline constexpr double nearly_empty = 0.04;

// What BenchScene::volume_map says, for a table's caption; a clause.
std::string volume_map_caption();

}  // namespace atomesh::cli
