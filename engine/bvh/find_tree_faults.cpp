// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/find_tree_faults.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <vector>

#include "bvh/read_node.h"
#include "core/parallel.h"
#include "core/rounding.h"
#include "core/shared_progress.h"

namespace promin {
namespace {

using layout::Node;
using layout::Primitive;

constexpr uint32_t kCheckedChunkSize = 4096;

/// The two sides of a box along an axis: below its lower plane, or above its upper plane.
enum class BoxSide { kBelow, kAbove };

bool is_beyond(double coordinate, double plane, BoxSide side) {
  return side == BoxSide::kBelow ? coordinate < plane : coordinate > plane;
}

// This code is separate from bvh/clip_triangle on purpose: the code that cuts primitives for builders must not check
// itself.

/// The two parts of a polygon that is cut at a plane; either may be missing.
template <typename Piece>
struct PieceCut {
  std::optional<Piece> beyond;
  std::optional<Piece> within;
};

/// The corners of a convex, planar polygon, in order.
using CutPolygon = std::vector<dvec3>;

PieceCut<CutPolygon> cut_at(const CutPolygon& polygon, int axis, double plane, BoxSide side) {
  CutPolygon beyond;
  CutPolygon within;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec3& a = polygon[i];
    const dvec3& b = polygon[(i + 1) % polygon.size()];
    const bool is_a_beyond = is_beyond(a[axis], plane, side);
    (is_a_beyond ? beyond : within).push_back(a);
    if (is_a_beyond == is_beyond(b[axis], plane, side)) continue;
    dvec3 crossing = glm::mix(a, b, (plane - a[axis]) / (b[axis] - a[axis]));
    crossing[axis] = plane;
    beyond.push_back(crossing);
    within.push_back(crossing);
  }
  PieceCut<CutPolygon> cut;
  if (!beyond.empty()) cut.beyond = std::move(beyond);
  if (!within.empty()) cut.within = std::move(within);
  return cut;
}

PieceCut<ExactBounds> cut_at(const ExactBounds& box, int axis, double plane, BoxSide side) {
  PieceCut<ExactBounds> cut;
  const bool is_below = side == BoxSide::kBelow;
  const double outer = is_below ? box.lo[axis] : box.hi[axis];
  const double inner = is_below ? box.hi[axis] : box.lo[axis];
  if (!is_beyond(outer, plane, side)) return {{}, box};
  if (is_beyond(inner, plane, side)) return {box, {}};
  cut.beyond = cut.within = box;
  (is_below ? cut.beyond->hi : cut.beyond->lo)[axis] = plane;
  (is_below ? cut.within->lo : cut.within->hi)[axis] = plane;
  return cut;
}

/// Collects the parts of `piece` outside of `box`.
template <typename Piece>
void subtract(const Piece& piece, const ExactBounds& box, std::vector<Piece>& left) {
  const size_t first = left.size();
  Piece rest = piece;
  for (int axis = 0; axis < 3; ++axis) {
    for (const BoxSide side : {BoxSide::kBelow, BoxSide::kAbove}) {
      PieceCut<Piece> cut = cut_at(rest, axis, side == BoxSide::kBelow ? box.lo[axis] : box.hi[axis], side);
      if (!cut.within) {
        // The box contains no part of the piece, so the piece stays whole.
        left.resize(first);
        left.push_back(piece);
        return;
      }
      if (cut.beyond) left.push_back(std::move(*cut.beyond));
      rest = std::move(*cut.within);
    }
  }
}

/// Returns whether the boxes together cover a piece, if each box is enlarged by `tolerance` on all sides.
template <typename Piece>
bool is_covered(const Piece& piece, std::span<const ExactBounds> boxes, double tolerance) {
  std::vector<Piece> pieces = {piece};
  std::vector<Piece> left;
  for (const ExactBounds& box : boxes) {
    left.clear();
    for (const Piece& each : pieces) subtract(each, {box.lo - tolerance, box.hi + tolerance}, left);
    std::swap(pieces, left);
  }
  return pieces.empty();
}

CutPolygon polygon_of(const Primitive& p) {
  const std::array corners = triangle_corners(p);
  return {corners.begin(), corners.end()};
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr ExactBounds kNothing{dvec3(kInfinity), dvec3(-kInfinity)};

/// Returns the intersection of two boxes.
ExactBounds intersect(const ExactBounds& a, const ExactBounds& b) {
  const ExactBounds both{glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)};
  // The comparison is written so that a box with a NaN contains nothing.
  const bool is_box = glm::all(glm::lessThanEqual(b.lo, b.hi)) && glm::all(glm::lessThanEqual(both.lo, both.hi));
  return is_box ? both : kNothing;
}

bool contains(const ExactBounds& outer, const ExactBounds& inner) {
  return glm::all(glm::lessThanEqual(outer.lo, inner.lo)) && glm::all(glm::greaterThanEqual(outer.hi, inner.hi));
}

class Inspection {
 public:
  Inspection(const TreeView& tree, std::span<const Primitive> primitives, const PrimitiveNumbers& numbers)
      : tree_(tree),
        primitives_(primitives),
        numbers_(numbers),
        node_boxes_(tree_.nodes.size()),
        leaf_of_slot_(tree_.references.size()),
        slots_(tree_.references.size()),
        first_slot_(tree_.primitive_count + size_t{1}) {}

  TreeFaults run(const TreeFaultOptions& options) {
    for (uint32_t i = 0; i < tree_.nodes.size(); ++i) visit(i);
    group_slots();
    const size_t chunk_count = (size_t{tree_.primitive_count} + kCheckedChunkSize - 1) / kCheckedChunkSize;
    std::vector<TreeFaults> of_chunks(chunk_count);
    SharedProgress progress(options.progress, static_cast<double>(chunk_count));
    for_each_index(chunk_count, options.thread_count, [&](size_t chunk) {
      const auto begin = static_cast<uint32_t>(chunk * kCheckedChunkSize);
      const uint32_t end = begin + std::min(kCheckedChunkSize, tree_.primitive_count - begin);
      for (uint32_t i = begin; i < end; ++i) inspect(i, of_chunks[chunk]);
      progress.add(1.0);
    });
    for (const TreeFaults& faults : of_chunks) {
      if (faults_.count == 0) faults_.first = faults.first;
      faults_.count += faults.count;
    }
    return std::move(faults_);
  }

 private:
  /// A node comes after its parent, so the parent's box is known here.
  void visit(uint32_t index) {
    const Node& node = tree_.nodes[index];
    for (uint32_t i = 0; i < layout::NODE_WIDTH; ++i) {
      const NodeChild child = child_of(node, i);
      if (child.kind == ChildKind::kAbsent) continue;
      const ExactBounds box = intersect(node_boxes_[index], child_box(node, i));
      if (child.kind == ChildKind::kNode) {
        node_boxes_[child.first] = box;
        continue;
      }
      const auto slots = primitives_.subspan(child.first, child.count);
      const auto has_lower_kind = [](const Primitive& a, const Primitive& b) { return a.c.z < b.c.z; };
      if (!std::is_sorted(slots.begin(), slots.end(), has_lower_kind)) {
        add_fault(faults_, "a leaf of node " + std::to_string(index) + " is not sorted by kind");
      }
      std::fill_n(leaf_of_slot_.begin() + child.first, child.count, static_cast<uint32_t>(leaf_boxes_.size()));
      leaf_boxes_.push_back(box);
    }
  }

  /// Sorts `slots_` by primitive: the slots [first_slot_[i], first_slot_[i + 1]) refer to primitive i.
  void group_slots() {
    for (const uint32_t primitive : tree_.references) ++first_slot_[primitive];
    std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());
    for (uint32_t slot = 0; slot < slots_.size(); ++slot) slots_[--first_slot_[tree_.references[slot]]] = slot;
  }

  void inspect(uint32_t index, TreeFaults& faults) const {
    const auto slots = std::span(slots_).subspan(first_slot_[index], first_slot_[index + 1] - first_slot_[index]);
    const Primitive& primitive = primitives_[slots.front()];
    const Bounds bounds = primitive_bounds(primitive);
    const ExactBounds whole{bounds.lo, bounds.hi};
    if (slots.size() == 1) {
      if (contains(box_of(slots.front()), whole)) return;
      add_fault(faults, name_of(primitive) + " extends outside the box of its leaf or of a node above it");
      return;
    }
    std::vector<ExactBounds> boxes;
    for (const uint32_t slot : slots) boxes.push_back(box_of(slot));
    const float size = std::max(max_abs_component(bounds.lo), max_abs_component(bounds.hi));
    const double tolerance = static_cast<double>(kUnitRoundoff) * static_cast<double>(size);
    const bool is_whole = primitive.c.z == layout::KIND_TRIANGLE ? is_covered(polygon_of(primitive), boxes, tolerance)
                                                                 : is_covered(whole, boxes, tolerance);
    if (is_whole) return;
    add_fault(faults, name_of(primitive) + " is in " + std::to_string(slots.size()) +
                          " leaves, and their boxes do not cover it");
  }

  const ExactBounds& box_of(uint32_t slot) const { return leaf_boxes_[leaf_of_slot_[slot]]; }

  std::string name_of(const Primitive& primitive) const {
    const PrimitiveId id = primitive_of_order(numbers_, primitive.c.y);
    return "primitive " + std::to_string(id.primitive) + " of object " + std::to_string(id.object);
  }

  static void add_fault(TreeFaults& faults, const std::string& sentence) {
    if (faults.count++ == 0) faults.first = sentence;
  }

  const TreeView& tree_;
  std::span<const Primitive> primitives_;
  const PrimitiveNumbers& numbers_;
  /// The box of each node and of each leaf, intersected with the boxes of all nodes above it.
  std::vector<ExactBounds> node_boxes_;
  std::vector<ExactBounds> leaf_boxes_;
  std::vector<uint32_t> leaf_of_slot_;
  std::vector<uint32_t> slots_;
  std::vector<uint32_t> first_slot_;
  TreeFaults faults_;
};

}  // namespace

TreeFaults find_tree_faults(const TreeView& tree, std::span<const Primitive> primitives,
                            const PrimitiveNumbers& numbers, const TreeFaultOptions& options) {
  return Inspection(tree, primitives, numbers).run(options);
}

}  // namespace promin
