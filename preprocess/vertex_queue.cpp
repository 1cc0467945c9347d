#include "preprocess/vertex_queue.h"

#include <algorithm>

namespace atomesh {

namespace {

constexpr double no_entry = -1.0;

}  // namespace

VertexQueue::VertexQueue(const StarMesh& mesh, const std::vector<std::uint8_t>& free, const Progress& progress)
    : mesh_(mesh),
      free_(free),
      refused_(free.size(), 0.0),
      patience_(free.size(), 0),
      key_(mesh.shortest_edges(progress)) {
  std::vector<Waiting> waiting;
  for (Index v = 0; v < free.size(); ++v) {
    if (free[v] != 0) waiting.push_back({key_[v], v});
  }
  total_ = left_ = waiting.size();
  queue_ = std::priority_queue<Waiting>({}, std::move(waiting));
}

bool VertexQueue::next(Waiting& waiting) {
  while (!queue_.empty() || revive()) {
    waiting = queue_.top();
    queue_.pop();
    const Index v = waiting.vertex;
    if (free_[v] == 0 || key_[v] != waiting.squared_length) continue;
    key_[v] = no_entry;
    --left_;
    return true;
  }
  return false;
}

void VertexQueue::put_back(Index v, double squared_length) {
  key_[v] = squared_length;
  queue_.push({squared_length, v});
  ++left_;
}

void VertexQueue::put_aside(Index v, std::size_t star_size) {
  patience_[v] = static_cast<Index>(1 + star_size / 8);
  aside_.push_back(v);
}

void VertexQueue::changed(std::span<const Index> vertices, Index apex) {
  for (const Index v : vertices) {
    if (free_[v] == 0) continue;
    if (patience_[v] > 0) {
      refused_[v] = 0.0;
      if (--patience_[v] == 0) put_back(v, 0.0);
      continue;
    }
    double key = refused_[v] > 0.0 ? 0.0 : key_[v];
    refused_[v] = 0.0;
    if (apex != no_index && apex != v) {
      const Vec3 edge = mesh_.position(apex) - mesh_.position(v);
      key = std::min(key, glm::dot(edge, edge));
    }
    if (key == key_[v]) continue;
    --left_;
    put_back(v, key);
  }
}

// Puts back into the queue who waits aside and had its star changed. False when there is nobody.
bool VertexQueue::revive() {
  std::vector<Index> aside = std::move(aside_);
  aside_.clear();
  for (const Index v : aside) {
    if (free_[v] == 0 || patience_[v] == 0) continue;
    if (refused_[v] > 0.0) {
      aside_.push_back(v);
    } else {
      patience_[v] = 0;
      put_back(v, 0.0);
    }
  }
  return !queue_.empty();
}

}  // namespace atomesh
