// SPDX-License-Identifier: Apache-2.0
// The engine's report on a finished mesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/domain/arrangement/merging.h"
#include "engine/domain/overlap.h"
#include "engine/output/chunk.h"
#include "engine/output/size_warnings.h"

namespace weft {

// Triangles that miss a bound, by reason. Each triangle counts once, under the first reason that
// holds.
struct Unrefined {
  std::uint64_t small_input_angle = 0;  // its smallest angle is forced by two segments that meet
  std::uint64_t edge_floor = 0;         // splitting it would make edges below MeshRequest::min_edge
  std::uint64_t budget = 0;             // max_triangles was reached
  std::uint64_t precision = 0;          // its split would make edges too short for double precision
  std::uint64_t streaming = 0;          // its surroundings had been sent when it was to be split
  // Triangles of the last two that are larger than their bound; the others miss only the angle.
  std::uint64_t too_large = 0;

  Unrefined& operator+=(const Unrefined& other) {
    small_input_angle += other.small_input_angle;
    edge_floor += other.edge_floor;
    budget += other.budget;
    precision += other.precision;
    streaming += other.streaming;
    too_large += other.too_large;
    return *this;
  }
  std::uint64_t total() const {
    return small_input_angle + edge_floor + budget + precision + streaming;
  }
  // Triangles that neither the input nor the request exempts.
  std::uint64_t without_exemption() const { return precision + streaming; }
};

// Two segments so near to each other that the bound on angles makes many triangles between them.
struct NarrowPlace {
  std::uint32_t segment = 0;  // indices into Pslg::segments
  std::uint32_t other = 0;
  Point at;              // on the first, where they make the most triangles
  double width = 0;      // between them there
  double triangles = 0;  // between them and around, at least
};

struct Summary {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t edges = 0;  // on input segments
  std::uint32_t chunks = 0;
  // Whether the mesh was sent while it was refined, so that only a strip of it was in memory at a
  // time; if not, all of it was.
  bool streamed = false;
  double area = 0;  // sum over the triangles, squared units
  Box box;

  double min_angle_deg = 0;
  double max_angle_deg = 0;
  // 1 % of the triangles have a smallest angle below this; to 0.1 degrees.
  double min_angle_p1_deg = 0;
  // Mean over the triangles of 4 sqrt(3) area / (sum of the squared edges): 1 for equilateral ones.
  double mean_quality = 0;
  // Triangles over the least number that their bounds allow, the integral of 1 / bound, taken at
  // the centroids of the mesh. Regions without a bound count for neither; 0 if there is no bound.
  double ideal_ratio = 0;
  // Share of the area where Steiner points came from a lattice, 0 to 1: on grains of
  // grain_map.h, or under one bound everywhere. The rest has circumcentres, or lies at steps.
  double lattice_share = 0;
  std::array<std::uint64_t, 18> angle_histogram{};  // all angles, 10 degrees per bin
  // Aspect ratio = longest edge / (2 sqrt(3) inradius), 1 for equilateral; bins end at
  // 1.1, 1.25, 1.5, 2, 3, 5, 10, 100, infinity.
  std::array<std::uint64_t, 9> aspect_histogram{};
  // Area over its bound, ten bins of 0.1; the last also counts triangles above the bound. All 0 if
  // there is no bound.
  std::array<std::uint64_t, 10> size_histogram{};
  double least_bound = 0;  // on a triangle's area, of those that have one; 0 if none has
  std::vector<SizeWarning> size_warnings;
  Unrefined unrefined;
  // The centroid of the first triangle, in the order of the chunks, that misses a bound without
  // exemption; meaningless if there is none.
  Point unrefined_at;
  Merging merging;  // of the input, before refinement
  Overlap overlap;  // of the input's areas
  // The costliest one, if it has at least a fifth of a mesh of a thousand triangles or more.
  std::optional<NarrowPlace> narrow;

  // Seconds of wall time, one stage after the other.
  double triangulate_seconds = 0;
  double size_seconds = 0;    // the boxes of the size field
  double coarse_seconds = 0;  // the coarse mesh and the quadtree; all of a mesh of one leaf
  double engine_seconds = 0;  // the whole run, without time blocked in the sink
  // Seconds of work, summed over the threads; the two overlap.
  double refine_seconds = 0;
  double emit_seconds = 0;  // numbering, quality, digests

  std::uint64_t peak_bytes = 0;  // engine memory of this run, not counting the request
  std::uint64_t insertions = 0;
  std::uint64_t deferred = 0;          // insertions that waited for another round
  std::uint64_t exact_predicates = 0;  // filter failures

  std::vector<Box> leaves;   // of the quadtree, in the order in which they are sent, if any
  std::uint32_t rounds = 0;  // of the leaves' tasks that found work

  Digest digest{};  // SHA-256 over the digests of the chunks, in order
};

}  // namespace weft
