// SPDX-License-Identifier: Apache-2.0
// The arrays of a chunk, as files/ takes the pieces of a mesh.
#pragma once

#include <google/protobuf/repeated_field.h>

#include <cstddef>
#include <span>

#include "files/formats/mesh.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {

template <class T>
std::span<const T> span_of(const google::protobuf::RepeatedField<T>& field) {
  return {field.data(), static_cast<std::size_t>(field.size())};
}

// Valid as long as the chunk.
inline files::MeshView view_of(const v1::Chunk& chunk) {
  return {.coordinates = span_of(chunk.coordinates()),
          .triangles = span_of(chunk.triangles()),
          .regions = span_of(chunk.regions()),
          .edges = span_of(chunk.edges()),
          .edge_markers = span_of(chunk.edge_markers()),
          .input_points = span_of(chunk.input_points()),
          .input_point_markers = {},
          .edge_bulges = span_of(chunk.edge_bulges())};
}

}  // namespace weft::wire
