// SPDX-License-Identifier: Apache-2.0
// How good the triangles of a mesh are: its figures, the distributions of angles, aspects and areas
// over their bounds, and the worst triangles.
//
// The aspect of a triangle is its circumradius over twice its inradius: 1 if it is equilateral,
// infinite if it is degenerate (Pebay and Baker, Analysis of triangle quality measures, 2003).
//
//   const MeshQuality quality = measure_quality(mesh.view(), {});
//   std::fputs(quality_text(quality, true).c_str(), stdout);  // quality_report.h
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "client/base/files.h"
#include "client/report/mesh_figures.h"
#include "files/formats/area_bound.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"

namespace weft::client {

// counts[i] values are from bounds[i] to below bounds[i + 1]; those outside are in the first and
// the last count.
struct Histogram {
  explicit Histogram(std::vector<double> of);
  void add(double value);
  void add(const Histogram& other);

  std::vector<double> bounds;         // ascending; the last may be infinite
  std::vector<std::uint64_t> counts;  // one fewer
};

struct MeasuredTriangle {
  std::size_t triangle = 0;
  Point at;  // the middle of its corners
  double min_angle_deg = 180;
  double aspect = 1;
  std::optional<double> area_over_bound;
};

struct MeshQuality {
  static constexpr std::size_t kWorst = 5;

  MeshFigures figures;
  Histogram min_angles;  // the smallest of each triangle, in degrees
  Histogram angles;      // all
  Histogram aspects;
  std::optional<Histogram> areas_over_bound;
  // At most kWorst each, the worst first; of equal ones the first.
  std::vector<MeasuredTriangle> worst_by_angle;
  std::vector<MeasuredTriangle> worst_by_area;  // over its bound
};

// Uses all processors; the result does not depend on how many there are. `make_bound`, if it is not
// empty, is called once by each thread. REQUIRES: vertex numbers in range, order 1.
MeshQuality measure_quality(const MeshView& mesh, const MakeAreaBound& make_bound);

}  // namespace weft::client
