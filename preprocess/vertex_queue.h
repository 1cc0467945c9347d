// The free vertices of a mesh that is being simplified, in the order of their shortest edges.
#pragma once

#include <queue>
#include <span>
#include <vector>

#include "preprocess/star_mesh.h"

namespace atomesh {

// A vertex whose edges were all refused waits aside until an eighth of its star has changed, or nothing else is left to
// do: the last vertices have stars of thousands of tetrahedra, and to look at them after each change would cost more
// than all the rest.
class VertexQueue {
 public:
  struct Waiting {
    double squared_length;  // of the edge to look at next, or less
    Index vertex;
    bool operator<(const Waiting& other) const {  // the queue gives the greatest first
      return squared_length != other.squared_length ? squared_length > other.squared_length : vertex > other.vertex;
    }
  };

  // Those with free[v] = 1; `free` is followed from then on.
  VertexQueue(const StarMesh& mesh, const std::vector<std::uint8_t>& free, const Progress& progress);

  // False when nobody is left whom it makes sense to try.
  bool next(Waiting& waiting);
  // How much of the work is done, from 0 to 1, if most vertices can go.
  double fraction() const { return 1.0 - static_cast<double>(left_) / static_cast<double>(total_); }

  // True when somebody waits for a shorter edge.
  bool shorter_waits(double squared_length) const {
    return !queue_.empty() && queue_.top().squared_length < squared_length;
  }
  void put_back(Index v, double squared_length);

  // The edges of v up to this length were refused.
  void refuse(Index v, double squared_length) { refused_[v] = squared_length; }
  double refused(Index v) const { return refused_[v]; }
  void put_aside(Index v, std::size_t star_size);
  // The stars of these vertices, free ones or not, were changed: what was refused may now be allowed. The new edges, if
  // they may be shorter than the old, all lead to `apex`.
  void changed(std::span<const Index> vertices, Index apex = no_index);

 private:
  bool revive();

  const StarMesh& mesh_;
  const std::vector<std::uint8_t>& free_;
  std::priority_queue<Waiting> queue_;
  std::vector<double> refused_;  // squared length of the longest edge of each vertex refused since its star changed
  std::vector<Index> patience_;  // changes of the star until one that waits aside is tried again; 0: not aside
  std::vector<Index> aside_;     // those that wait aside, and some that no longer do
  std::vector<double> key_;      // of each vertex's entry in the queue; others of the same vertex are stale
  std::size_t total_ = 0, left_ = 0;
};

}  // namespace atomesh
