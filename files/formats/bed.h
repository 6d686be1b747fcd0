// SPDX-License-Identifier: Apache-2.0
// The bed among the values at the vertices of a mesh: those named `depth`, in metres, positive
// down, or `elevation`, in metres, positive up. A format that has the bed under one of the two gets
// the other one with its sign turned.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "files/formats/mesh.h"

namespace weft::files {

class Bed {
 public:
  explicit Bed(const MeshView& mesh) {
    for (const VertexValues& values : mesh.vertex_values) {
      if (!is_bed(values.name)) continue;
      values_ = values.values;
      depth_sign_ = values.name == "depth" ? 1 : -1;
    }
  }
  bool is_known() const { return !values_.empty(); }
  // 0 if it is not known.
  double depth(std::size_t vertex) const { return at(vertex, depth_sign_); }
  double elevation(std::size_t vertex) const { return at(vertex, -depth_sign_); }

  // Whether values of that name are the bed.
  static bool is_bed(std::string_view name) { return name == "depth" || name == "elevation"; }

 private:
  // Without a negative zero.
  double at(std::size_t vertex, double sign) const {
    return values_.empty() || values_[vertex] == 0 ? 0 : sign * values_[vertex];
  }

  std::span<const double> values_;
  double depth_sign_ = 1;
};

}  // namespace weft::files
