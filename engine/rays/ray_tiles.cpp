// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "rays/ray_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"

namespace promin {
namespace {

constexpr uint32_t kTileRows = 4;
constexpr uint32_t kTileWidth = 8;
constexpr uint32_t kPacketSize = RayTiler::kPacketSize;

/// The number of pairs of neighbouring rays in a sample. Their median distance is called a step here.
constexpr size_t kSampleSteps = 255;
/// The search for the end of a row tests one ray in kStride. If this ray is less than kFarSteps from the previous
/// tested ray, the row does not end between them.
constexpr size_t kStride = 16;
constexpr float kFarSteps = 32.0F;
/// The smallest distance, in steps, between the last ray of a row and the first ray of the next row.
constexpr float kLeastJump = 8.0F;
/// Rays of neighbouring rows count as neighbours if they are at most this many steps apart.
constexpr float kMostNeighbourSteps = 16.0F;
/// The smallest shift between rows that is corrected. With a smaller shift, groups of four rays trace as fast as rays
/// outside groups.
constexpr float kLeastLag = 1.5F;
/// Number of bands that a thread processes at a time. Rays that form no group of four are put behind them.
constexpr size_t kChunkBands = 16;

/// A ray's origin and direction as one point, in units of the scene.
struct Place {
  vec3 origin{0.0F};
  vec3 direction{0.0F};
};

Place operator-(const Place& a, const Place& b) {
  return {a.origin - b.origin, a.direction - b.direction};
}

float dot(const Place& a, const Place& b) {
  return glm::dot(a.origin, b.origin) + glm::dot(a.direction, b.direction);
}

/// Returns the squared distance of two rays; NaN if either ray has no direction.
float square_distance(const Place& a, const Place& b) {
  const Place difference = a - b;
  return dot(difference, difference);
}

struct Row {
  uint32_t begin = 0;
  uint32_t end = 0;

  uint32_t length() const { return end - begin; }
};

using Band = std::span<Row>;

class Rows {
 public:
  Rows(std::span<const Ray> rays, const SceneCube& cube)
      : rays_(rays), unit_(1.0F / cube.radius), square_step_(measure_square_step()) {}

  Place place_of(size_t ray) const { return {rays_[ray].origin * unit_, scaled_direction(rays_[ray])}; }

  /// Prefetches a ray that is read soon, because waiting for memory would otherwise take most of the time.
  void expect(size_t ray) const { __builtin_prefetch(&rays_[std::min(ray, rays_.size() - 1)]); }

  bool are_neighbours(const Place& a, const Place& b) const {
    return square_distance(a, b) <= kMostNeighbourSteps * kMostNeighbourSteps * square_step_;
  }

  std::vector<Row> find() const {
    std::vector<Row> rows;
    for (size_t begin = 0; begin < rays_.size();) {
      const size_t end = find_end(begin, rows.empty() ? 0 : rows.back().length());
      rows.push_back({static_cast<uint32_t>(begin), static_cast<uint32_t>(end)});
      begin = end;
    }
    return rows;
  }

  /// Joins rows that are next to each other into bands of up to kTileRows.
  std::vector<Band> join(std::span<Row> rows) const {
    std::vector<Band> bands;
    size_t first = 0;
    for (size_t i = 1; i <= rows.size(); ++i) {
      if (i < rows.size() && i - first < kTileRows && are_joined(rows[i - 1], rows[i])) continue;
      bands.push_back(rows.subspan(first, i - first));
      first = i;
    }
    return bands;
  }

 private:
  float measure_square_step() const {
    std::array<float, kSampleSteps> steps{};
    for (size_t i = 0; i < kSampleSteps; ++i) {
      const size_t first = sampled_pair(i, rays_.size());
      const float step = square_distance(place_of(first), place_of(first + 1));
      steps[i] = step >= 0.0F ? step : 0.0F;
    }
    const auto median = steps.begin() + kSampleSteps / 2;
    std::nth_element(steps.begin(), median, steps.end());
    return *median;
  }

  /// Returns whether the row that begins at `start` ends with ray `last`: whether the next ray is nearer to the row's
  /// beginning than to ray `last`.
  bool is_end(const Place& start, size_t last) const {
    const Place next = place_of(last + 1);
    const float jump = square_distance(place_of(last), next);
    return jump > kLeastJump * kLeastJump * square_step_ && square_distance(next, start) < jump;
  }

  /// Returns the ray before the largest jump between rays `a` and `b`, if one jump is much larger than all others.
  size_t find_jump(size_t a, size_t b) const {
    const Place place_a = place_of(a);
    const Place place_b = place_of(b);
    while (b - a > 1) {
      const size_t middle = (a + b) / 2;
      const Place place = place_of(middle);
      (square_distance(place, place_a) < square_distance(place, place_b) ? a : b) = middle;
    }
    return a;
  }

  /// Returns whether these rays may be one row and not two: whether the middle ray is about halfway.
  bool is_one_row(const Place& start, size_t begin, size_t last) const {
    const float half_square = square_distance(start, place_of((begin + last) / 2));
    const float square = square_distance(start, place_of(last));
    return 16.0F * half_square > square && 16.0F * half_square < 9.0F * square;
  }

  /// Finds the end of the row that begins at `begin`. `expected` is the length of the previous row, or 0; most rows
  /// have nearly the same length.
  size_t find_end(size_t begin, size_t expected) const {
    const size_t count = rays_.size();
    const Place start = place_of(begin);
    if (expected >= kStride && begin + expected + kStride < count) {
      // Prefetches the rays around the expected end of the next row, one cache line at a time.
      for (size_t i = 0; i <= 2 * kStride; i += 2) expect(begin + 2 * expected - kStride + i);
      const size_t last = find_jump(begin + expected - kStride, begin + expected + kStride);
      if (is_end(start, last) && is_one_row(start, begin, last)) return last + 1;
    }
    Place place = start;
    for (size_t i = begin; i + 1 < count;) {
      const size_t next = std::min(i + kStride, count - 1);
      expect(i + 8 * kStride);
      const Place place_of_next = place_of(next);
      if (square_distance(place, place_of_next) > kFarSteps * kFarSteps * square_step_) {
        const size_t last = find_jump(i, next);
        if (is_end(start, last)) return last + 1;
      }
      i = next;
      place = place_of_next;
    }
    return count;
  }

  bool are_joined(const Row& a, const Row& b) const {
    const Place start = place_of(a.begin);
    const float square_length = square_distance(start, place_of(a.end - 1));
    return square_distance(start, place_of(b.begin)) * 16.0F <= square_length;
  }

  std::span<const Ray> rays_;
  float unit_;
  float square_step_;
};

/// Writes a chunk's rays in their new order: first the groups of four, then the rays that form no groups.
class Sink {
 public:
  explicit Sink(uint32_t* next) : next_(next) {}

  /// Writes rays of one row.
  void put(uint32_t first, uint32_t count) {
    const uint32_t whole = count / kPacketSize * kPacketSize;
    for (uint32_t i = 0; i < whole; ++i) *next_++ = first + i;
    for (uint32_t i = whole; i < count; ++i) rest_.push_back(first + i);
  }

  /// Writes rays of two rows that are next to each other.
  void put_pair(uint32_t a, uint32_t count_a, uint32_t b, uint32_t count_b) {
    const uint32_t both = std::min(count_a, count_b) / 2 * 2;
    for (uint32_t i = 0; i < both; i += 2) {
      for (const uint32_t ray : {a + i, a + i + 1, b + i, b + i + 1}) *next_++ = ray;
    }
    put(a + both, count_a - both);
    put(b + both, count_b - both);
  }

  void put_rest() { std::copy(rest_.begin(), rest_.end(), next_); }

 private:
  uint32_t* next_;
  std::vector<uint32_t> rest_;
};

/// Iterates along the rows of a band.
class BandWalk {
 public:
  BandWalk(const Rows& rows, Band band) : rows_(rows) {
    const Row& longest =
        *std::max_element(band.begin(), band.end(), [](const Row& a, const Row& b) { return a.length() < b.length(); });
    if (longest.length() == 0) return;
    zero_ = rows.place_of(longest.begin);
    along_ = rows.place_of(longest.end - 1) - zero_;
    mean_step_ = dot(along_, along_) / static_cast<float>(longest.length());
    is_regular_ = std::all_of(band.begin(), band.end(), [&](const Row& row) {
      return row.length() == longest.length() && are_in_a_column(row.begin, longest.begin) &&
             are_in_a_column(row.end - 1, longest.end - 1);
    });
    for (size_t i = 0; i < band.size(); ++i) {
      Head& head = heads_[i];
      head.next = band[i].begin;
      head.end = band[i].end;
      head.step = mean_step_;
      if (head.next < head.end) look(head);
      if (is_regular_) head.column = 0.0F;
    }
  }

  void put_all(Sink& sink) {
    while (choose_tile()) {
      put_pair(heads_[0], heads_[1], sink);
      put_pair(heads_[2], heads_[3], sink);
      for (Head& head : heads_) advance(head);
    }
  }

 private:
  /// The next ray of a row, and its place.
  struct Head {
    uint32_t next = 0;
    uint32_t end = 0;
    /// The number of rays that the current tile takes.
    uint32_t taken = 0;
    Place place{};
    /// The ray's coordinate along the rows, and the distance between neighbouring rays of this row.
    float column = 0.0F;
    float step = 0.0F;
  };

  bool are_in_a_column(size_t a, size_t b) const {
    return std::fabs(dot(rows_.place_of(a) - rows_.place_of(b), along_)) < kLeastLag * mean_step_;
  }

  void look(Head& head) const {
    rows_.expect(head.next + 2 * kTileWidth);
    head.place = rows_.place_of(head.next);
    head.column = dot(head.place - zero_, along_);
  }

  void advance(Head& head) const {
    if (head.taken == 0) return;
    head.next += head.taken;
    if (is_regular_ || head.next == head.end) return;
    const float column = head.column;
    look(head);
    const float step = (head.column - column) / static_cast<float>(head.taken);
    head.step = step > 0.5F * mean_step_ && step < 2.0F * mean_step_ ? step : mean_step_;
  }

  /// Decides how many rays the tile takes from each row: none from rows that are ahead of the others. Returns false if
  /// no row has rays left. The row that is furthest behind always gives rays, even if columns are NaN, because `column
  /// > farthest` is then false.
  bool choose_tile() {
    const Head* last = nullptr;
    for (const Head& head : heads_) {
      if (head.next < head.end && (last == nullptr || head.column < last->column)) last = &head;
    }
    if (last == nullptr) return false;
    const float farthest = last->column + last->step * kTileWidth / 2;
    for (Head& head : heads_) head.taken = head.column > farthest ? 0 : std::min(kTileWidth, head.end - head.next);
    return true;
  }

  /// Writes rays of two neighbouring rows. The row that is behind first catches up with the other row.
  void put_pair(Head& a, Head& b, Sink& sink) const {
    if (a.taken == 0 || b.taken == 0 || !rows_.are_neighbours(a.place, b.place)) {
      sink.put(a.next, a.taken);
      sink.put(b.next, b.taken);
      return;
    }
    Head& behind = a.column < b.column ? a : b;
    Head& ahead = a.column < b.column ? b : a;
    const float lag = (ahead.column - behind.column) / behind.step;
    uint32_t lead = 0;
    if (lag >= kLeastLag && lag < kTileWidth) {
      lead = std::min(static_cast<uint32_t>(std::lround(lag)), behind.taken);
      ahead.taken = std::min(ahead.taken, (kTileWidth - lead) / 2 * 2);
      behind.taken = std::min(behind.taken, lead + ahead.taken);
      sink.put(behind.next, lead);
    }
    sink.put_pair(behind.next + lead, behind.taken - lead, ahead.next, ahead.taken);
  }

  const Rows& rows_;
  std::array<Head, kTileRows> heads_;
  Place zero_{};
  Place along_{};
  float mean_step_ = 0.0F;
  /// True if the rows have the same length and begin and end side by side. Such rows are assumed to be side by side
  /// everywhere, so none of their other rays is read.
  bool is_regular_ = false;
};

}  // namespace

std::span<const uint32_t> RayTiler::tile(std::span<const Ray> rays, const SceneCube& cube) {
  if (rays.size() < 2) return {};
  const Rows all(rays, cube);
  std::vector<Row> rows = all.find();
  const std::vector<Band> bands = all.join(rows);
  if (bands.size() == rows.size()) return {};
  order_.resize(rays.size());
  for_each_chunk(bands.size(), kChunkBands, 0, [&](size_t begin, size_t end) {
    // Groups of four begin at multiples of four. The rows are stored one after the other.
    const std::span<Row> chunk_rows(bands[begin].data(), bands[end - 1].data() + bands[end - 1].size());
    uint32_t first = chunk_rows.front().begin;
    for (Row& row : chunk_rows) {
      for (; first % kPacketSize != 0 && row.begin < row.end; ++row.begin, ++first) order_[first] = first;
    }
    Sink sink(order_.data() + first);
    for (size_t i = begin; i < end; ++i) BandWalk(all, bands[i]).put_all(sink);
    sink.put_rest();
  });
  return order_;
}

}  // namespace promin
