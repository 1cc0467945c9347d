// An Ogg Theora file, decoded: what players would show.
#pragma once

#include <ogg/ogg.h>
#include <theora/theoradec.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "core/image.h"

namespace atomesh::test {

struct Movie {
  int width = 0;
  int height = 0;
  double frames_per_second = 0.0;
  std::vector<Image> frames;
};

// BT.601 with foot- and headroom, as Theora has it.
inline Vec4f rgb_of(int y, int cb, int cr) {
  const double l = 1.164 * (y - 16);
  const auto channel = [](double v) { return static_cast<float>(std::clamp(v / 255.0, 0.0, 1.0)); };
  return {channel(l + 1.596 * (cr - 128)), channel(l - 0.392 * (cb - 128) - 0.813 * (cr - 128)),
          channel(l + 2.017 * (cb - 128)), 1.0F};
}

inline Image image_of(const th_info& info, const th_ycbcr_buffer& planes) {
  Image image(static_cast<int>(info.pic_width), static_cast<int>(info.pic_height));
  const auto sample = [&](int plane, int column, int row) {
    const th_img_plane& p = planes[plane];
    const int x = (column + static_cast<int>(info.pic_x)) * p.width / planes[0].width;
    const int y = (row + static_cast<int>(info.pic_y)) * p.height / planes[0].height;
    return static_cast<int>(p.data[y * p.stride + x]);
  };
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      image.at(column, row) = rgb_of(sample(0, column, row), sample(1, column, row), sample(2, column, row));
    }
  }
  return image;
}

// Everything of `bytes`; no frames where it is no Theora.
inline Movie decode_theora(const std::string& bytes) {
  Movie movie;
  ogg_sync_state sync;
  ogg_sync_init(&sync);
  char* buffer = ogg_sync_buffer(&sync, static_cast<long>(bytes.size()));
  std::memcpy(buffer, bytes.data(), bytes.size());
  ogg_sync_wrote(&sync, static_cast<long>(bytes.size()));
  th_info info;
  th_comment comment;
  th_setup_info* setup = nullptr;
  th_dec_ctx* decoder = nullptr;
  th_info_init(&info);
  th_comment_init(&comment);
  ogg_stream_state stream;
  bool begun = false;
  ogg_page page;
  while (ogg_sync_pageout(&sync, &page) == 1) {
    if (!begun) begun = ogg_stream_init(&stream, ogg_page_serialno(&page)) == 0;
    ogg_stream_pagein(&stream, &page);
    ogg_packet packet;
    while (ogg_stream_packetout(&stream, &packet) == 1) {
      if (decoder == nullptr) {
        if (th_decode_headerin(&info, &comment, &setup, &packet) > 0) continue;
        decoder = th_decode_alloc(&info, setup);
        if (decoder == nullptr) break;
        movie.width = static_cast<int>(info.pic_width);
        movie.height = static_cast<int>(info.pic_height);
        movie.frames_per_second = static_cast<double>(info.fps_numerator) / info.fps_denominator;
      }
      if (th_decode_packetin(decoder, &packet, nullptr) < 0) continue;
      th_ycbcr_buffer planes;
      th_decode_ycbcr_out(decoder, planes);
      movie.frames.push_back(image_of(info, planes));
    }
  }
  if (decoder != nullptr) th_decode_free(decoder);
  if (setup != nullptr) th_setup_free(setup);
  if (begun) ogg_stream_clear(&stream);
  th_comment_clear(&comment);
  th_info_clear(&info);
  ogg_sync_clear(&sync);
  return movie;
}

}  // namespace atomesh::test
