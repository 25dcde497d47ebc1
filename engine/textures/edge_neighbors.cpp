// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/edge_neighbors.h"

#include <algorithm>
#include <tuple>

#include "core/parallel.h"

namespace promin {
namespace {

/// The number of vertices that a thread processes at a time.
constexpr size_t kVertexChunkSize = 16384;

/// The edges, grouped by the lower of their two vertices.
class EdgeBuckets {
 public:
  EdgeBuckets(std::span<const uint32_t> vertices, uint32_t vertex_count)
      : vertices_(vertices), ends_(size_t{vertex_count} + 1, 0), edges_(vertices.size()) {
    for_each_edge([&](uint32_t edge) { ++ends_[lower(edge) + 1]; });
    for (size_t i = 1; i < ends_.size(); ++i) ends_[i] += ends_[i - 1];
    // While a bucket is filled, its begin moves to its end. The next bucket originally began there.
    for_each_edge([&](uint32_t edge) { edges_[ends_[lower(edge)]++] = edge; });
  }

  std::span<uint32_t> bucket(size_t vertex) {
    const uint32_t begin = vertex == 0 ? 0 : ends_[vertex - 1];
    return std::span(edges_).subspan(begin, ends_[vertex] - begin);
  }
  uint32_t upper(uint32_t edge) const { return std::max(vertices_[edge], vertices_[next_corner(edge)]); }
  bool runs_down(uint32_t edge) const { return vertices_[edge] > vertices_[next_corner(edge)]; }

 private:
  uint32_t lower(uint32_t edge) const { return std::min(vertices_[edge], vertices_[next_corner(edge)]); }
  template <typename Task>
  void for_each_edge(const Task& task) const {
    for (uint32_t edge = 0; edge < vertices_.size(); ++edge) {
      if (vertices_[edge] != kNoCorner) task(edge);
    }
  }

  std::span<const uint32_t> vertices_;
  std::vector<uint32_t> ends_;
  std::vector<uint32_t> edges_;
};

/// Pairs the edges of a bucket.
void join(EdgeBuckets& buckets, std::span<uint32_t> bucket, std::vector<uint32_t>& neighbors) {
  const auto order_of = [&](uint32_t edge) { return std::tuple(buckets.upper(edge), buckets.runs_down(edge), edge); };
  std::ranges::sort(bucket, {}, order_of);
  for (size_t begin = 0; begin < bucket.size();) {
    const uint32_t upper = buckets.upper(bucket[begin]);
    size_t down = begin;
    while (down < bucket.size() && buckets.upper(bucket[down]) == upper && !buckets.runs_down(bucket[down])) ++down;
    size_t end = down;
    while (end < bucket.size() && buckets.upper(bucket[end]) == upper) ++end;
    for (size_t i = 0; i < std::min(down - begin, end - down); ++i) {
      neighbors[bucket[begin + i]] = bucket[down + i];
      neighbors[bucket[down + i]] = bucket[begin + i];
    }
    begin = end;
  }
}

}  // namespace

std::vector<uint32_t> find_edge_neighbors(std::span<const uint32_t> vertices, uint32_t vertex_count) {
  EdgeBuckets buckets(vertices, vertex_count);
  std::vector<uint32_t> neighbors(vertices.size(), kNoCorner);
  for_each_chunk(vertex_count, kVertexChunkSize, 0, [&](size_t begin, size_t end) {
    for (size_t vertex = begin; vertex < end; ++vertex) join(buckets, buckets.bucket(vertex), neighbors);
  });
  return neighbors;
}

}  // namespace promin
