// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include "formats/gltf/checks.h"

namespace promin {
namespace {

/// A source of `count` elements with `components` numbers each. Elements are `stride` bytes apart.
struct Source {
  const std::byte* data;
  size_t stride;
  size_t count;
  size_t components;
  int component_type;
  bool normalized;
};

template <class To, class From>
To convert(From value, bool normalized) {
  if constexpr (std::is_floating_point_v<To> && std::is_integral_v<From>) {
    const To scaled = static_cast<To>(value) / static_cast<To>(std::numeric_limits<From>::max());
    if (normalized) return std::max(scaled, To{-1});
  }
  return static_cast<To>(value);
}

template <class From, class To>
void copy_as(const Source& source, To* out) {
  for (size_t i = 0; i < source.count; ++i) {
    const std::byte* element = source.data + i * source.stride;
    for (size_t c = 0; c < source.components; ++c) {
      From value;
      std::memcpy(&value, element + c * sizeof(From), sizeof(From));
      *out++ = convert<To>(value, source.normalized);
    }
  }
}

template <class To>
void copy(const Source& source, To* out) {
  switch (source.component_type) {
    case kGltfByte:
      return copy_as<int8_t>(source, out);
    case kGltfUnsignedByte:
      return copy_as<uint8_t>(source, out);
    case kGltfShort:
      return copy_as<int16_t>(source, out);
    case kGltfUnsignedShort:
      return copy_as<uint16_t>(source, out);
    case kGltfUnsignedInt:
      return copy_as<uint32_t>(source, out);
    default:
      return copy_as<float>(source, out);
  }
}

template <class To>
std::vector<To> read_accessor(const GltfDocument& document, int index, LoadReport& report) {
  const GltfAccessor& accessor = document.accessors[static_cast<size_t>(index)];
  const size_t components = accessor.component_count;
  const size_t packed_stride = components * component_bytes(accessor.component_type);
  std::vector<To> values(accessor.count * components, To{});
  if (accessor.view >= 0) {
    const size_t stride = document.views[static_cast<size_t>(accessor.view)].byte_stride;
    copy(Source{bytes_of_view(document, accessor.view).data() + accessor.byte_offset,
                stride == 0 ? packed_stride : stride, accessor.count, components, accessor.component_type,
                accessor.is_normalized},
         values.data());
  }
  if (!accessor.sparse) return values;

  const GltfSparse& sparse = *accessor.sparse;
  std::vector<uint32_t> places(sparse.count);
  copy(Source{bytes_of_view(document, sparse.index_view).data() + sparse.index_offset,
              component_bytes(sparse.index_type), sparse.count, 1, sparse.index_type, false},
       places.data());
  const std::byte* replacements = bytes_of_view(document, sparse.value_view).data() + sparse.value_offset;
  for (size_t i = 0; i < sparse.count; ++i) {
    if (places[i] >= accessor.count) {
      report.refuse("gltf.accessor.index",
                    "sparse index " + std::to_string(places[i]) + " is out of range, because the accessor has only " +
                        std::to_string(accessor.count) + " elements",
                    "accessors[" + std::to_string(index) + "].sparse.indices, element " + std::to_string(i),
                    "export the file again");
      break;
    }
    copy(Source{replacements + i * packed_stride, packed_stride, 1, components, accessor.component_type,
                accessor.is_normalized},
         values.data() + places[i] * components);
  }
  return values;
}

}  // namespace

std::vector<float> read_floats(const GltfDocument& document, int accessor, LoadReport& report) {
  return read_accessor<float>(document, accessor, report);
}

std::vector<double> read_doubles(const GltfDocument& document, int accessor, LoadReport& report) {
  return read_accessor<double>(document, accessor, report);
}

std::vector<uint32_t> read_indices(const GltfDocument& document, int accessor, LoadReport& report) {
  return read_accessor<uint32_t>(document, accessor, report);
}

}  // namespace promin
