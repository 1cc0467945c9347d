// Pictures of any size in bounded memory (seed 4.2.3): drawn in passes, each a band of whole rows.
#pragma once

#include <functional>

#include "render/renderer.h"

namespace atomesh {

// Takes a finished band, from the top of the picture down, and may write into it. The channels given to
// render_in_passes() hold this band's values.
using BandSink = std::function<void(Image& band, int first_row)>;

// What render() does, `rows` rows at a time: the same pixels to the last bit, the statistics of all passes added up
// (the scene is projected anew in each). Progress goes over all passes. Throws what render() and `sink` throw.
void render_in_passes(const Renderer& renderer, const Scene& scene, const Camera& camera, const Parameters& parameters,
                      int rows, RenderStats& stats, const Channels& channels, const BandSink& sink,
                      Progress& progress = no_progress());

// The largest of Channels::thickness over the whole picture (mode xray; 0 in the others), drawn `rows` rows at a time:
// what the scale of a legend goes by, which must not depend on how the picture is drawn.
double largest_thickness(const Renderer& renderer, const Scene& scene, const Camera& camera,
                         const Parameters& parameters, int rows, Progress& progress = no_progress());

// Bytes that a pass takes for each row of the picture; what the renderer keeps of the scene comes on top.
std::uint64_t pass_bytes_per_row(const Camera& camera, const Parameters& parameters, const Channels& channels);

// The most rows whose pass takes no more than `bytes`, one at least and at most all; where it is more than a few, a
// number that goes well with the renderers' tiles.
int rows_within(std::uint64_t bytes, const Camera& camera, const Parameters& parameters, const Channels& channels);

// What a pass may take by default: a quarter of what the process can still take (memory_room()), and at most 1 GB. More
// would save nothing but some setting up.
std::uint64_t default_pass_bytes();

}  // namespace atomesh
