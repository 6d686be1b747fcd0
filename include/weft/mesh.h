// SPDX-License-Identifier: Apache-2.0
// A finished mesh: all of it, or in chunks, and the report on it.
//
// Chunks are numbered from 0 and come in order; together they are the whole mesh. Vertices and
// triangles are numbered from 0 across the mesh, in the order in which chunks carry them. A chunk
// refers only to its own vertices and to those of earlier chunks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "weft/geometry.h"

namespace weft {

using Digest = std::array<std::uint8_t, 32>;  // SHA-256

struct Chunk {
  // An edge of the mesh that lies on an input segment. It is carried once, even if its two
  // triangles are in different chunks.
  struct Edge {
    std::uint32_t a = 0;  // mesh vertex
    std::uint32_t b = 0;
    std::uint32_t segment = 0;  // index of the input segment
    std::int32_t marker = 0;
  };

  std::uint32_t index = 0;
  std::uint32_t first_vertex = 0;
  std::uint32_t first_triangle = 0;
  std::vector<double> coordinates;       // x0, y0, x1, y1, ... of the vertices from first_vertex
  std::vector<std::uint32_t> triangles;  // three mesh vertices each, counter-clockwise
  std::vector<std::int32_t> regions;     // region id per triangle; empty if every id is 0
  std::vector<Edge> edges;
  // Per edge, the bulge (Arc::bulge) of the arc from its a to its b that it is a chord of; empty if
  // all are straight.
  std::vector<double> bulges;
  // (mesh vertex, index of the input point) for the vertices of this chunk that are input points.
  std::vector<std::array<std::uint32_t, 2>> input_points;
  Box box;          // of this chunk's triangles
  Digest digest{};  // SHA-256 of the chunk's canonical bytes, see chunk_digest
};

// Maximum bytes of the arrays of a chunk.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 20;

// SHA-256 over, little-endian and without padding: coordinates, triangles, regions (written out
// even when all are 0), edges (a, b, segment, marker), input_points, bulges.
Digest chunk_digest(const Chunk& chunk);

// Receives the chunks in order, on the thread that called `stream`. `accept` may block: only
// its own run waits. Returning false stops the run with kCancelled.
class ChunkSink {
 public:
  virtual ~ChunkSink() = default;
  virtual bool accept(Chunk&& chunk) = 0;
};

// What was merged of the input because it is nearer than the tolerance, before refinement.
struct Merging {
  double tolerance = 0;  // the larger of Pslg::snap and the floor of double precision
  // Input points that moved onto the vertex of another point; coincident points are not counted.
  std::uint64_t points = 0;
  // Input segments that are led through a vertex that is farther off them than rounding explains
  // (4 units in the last place of the largest coordinate).
  std::uint64_t segments = 0;
  // The largest distance of such a point to its vertex, or of such a vertex to its segment. If
  // several segments have become one edge, the distance is that to the lowest of them.
  double farthest = 0;
  Point farthest_at{};  // the vertex
  // Faces that merging closed: each connected run of edges of segments that are apart in the input
  // and now lie on each other, and each loop of segments that has become one vertex.
  std::uint64_t vanished_faces = 0;
  Point vanished_at{};  // the vertex of the first loop, or an end of the first run
};

// Where areas of a PSLG cover what others cover, holes not counted.
struct Overlap {
  std::uint64_t areas = 0;  // that share a face with another
  double area = 0;          // of these faces, in squared units
  bool united = false;      // or else, by even-odd filling, not meshed where an even number overlap
};

// Segments that border no area and of which no part bounds the mesh or lies in it; of several that
// coincide, one counts. Where lines should enclose a face and do not close, they are outside.
struct OutsideSegments {
  std::uint64_t segments = 0;
  std::uint32_t first = 0;  // index into Pslg::segments
  Point at;                 // on it
};

// What MeshRequest::simplify did to the domain.
struct Simplification {
  std::uint64_t points = 0;    // vertices of the domain that are gone
  std::uint64_t islands = 0;   // land, or holes, that are meshed now
  std::uint64_t waters = 0;    // parts that are no longer meshed
  std::uint64_t channels = 0;  // that were cut
  std::uint64_t cut_off = 0;   // waters behind these, which are no longer meshed
  std::uint64_t straits = 0;   // channels that stay: the widest way to a large water
  double area = 0;             // of the new domain less that of the old one
  double farthest = 0;         // of a new line from the old ones, at most
  std::vector<Point> cuts;     // a point in each of `channels`, of the first 1,024
};

// A warning about a size that is probably not what is wanted.
struct SizeWarning {
  enum class Kind : std::uint8_t {
    kBoundsNothing,         // larger than the domain everywhere
    kCoarseRaster,          // of sizes: its nodes lie farther apart than the least edge it asks for
    kFieldNotNamed,         // by the expression
    kGradationWithinAlone,  // without a gradation
  };
  Kind kind;
  std::string field;  // its name, if one is meant
  std::string message;
};

// Triangles that miss a bound, by the first reason that holds.
struct Unrefined {
  std::uint64_t small_input_angle = 0;  // its smallest angle is forced by two segments that meet
  std::uint64_t edge_floor = 0;         // splitting it would make edges below MeshRequest::min_edge
  std::uint64_t kept = 0;               // splitting it would split a segment that is kept
  std::uint64_t budget = 0;             // max_triangles was reached
  std::uint64_t precision = 0;          // its split would make edges too short for double precision
  std::uint64_t streaming = 0;          // its surroundings had been sent when it was to be split
  // Triangles of the last two that are larger than their bound; the others miss only the angle.
  std::uint64_t too_large = 0;

  std::uint64_t total() const {
    return small_input_angle + edge_floor + kept + budget + precision + streaming;
  }
  // Triangles that neither the input nor the request exempts.
  std::uint64_t without_exemption() const { return precision + streaming; }
};

// Two segments so near to each other that the bound on angles makes many triangles between them,
// the most of all such places.
struct NarrowPlace {
  std::uint32_t segment = 0;  // indices into Pslg::segments
  std::uint32_t other = 0;
  Point at;              // on the first, where they make the most triangles
  double width = 0;      // between them there
  double triangles = 0;  // between them and around, at least
  double in_all = 0;     // triangles in all such places, at least
  double widest = 0;     // nine tenths of these lie where segments are no further apart
};

// The layers along walls, and what was cut of them.
struct LayerSummary {
  std::uint64_t triangles = 0;
  double least_thickness = 0;  // but for layers that end in a point
  Point at;                    // at the wall there
  std::uint64_t cut = 0;       // places at walls where they are thinner than was asked for
};

struct Summary {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint64_t edges = 0;  // on input segments
  std::uint32_t chunks = 0;
  bool streamed = false;  // while it was refined: only a strip was in memory at a time
  double area = 0;        // sum over the triangles, squared units
  Box box;

  double min_angle_deg = 0;
  double max_angle_deg = 0;
  double min_angle_p1_deg = 0;  // the first percentile of smallest angles, to 0.1 degrees
  // Mean over the triangles of 4 sqrt(3) area / (sum of the squared edges): 1 for equilateral ones.
  double mean_quality = 0;
  // Triangles over the least number that their bounds allow, the integral of 1 / bound. Regions
  // without a bound count for neither; 0 if there is no bound.
  double ideal_ratio = 0;
  // Share of the area where Steiner points came from a lattice, 0 to 1. The rest has
  // circumcentres, or lies at steps of the size.
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
  Point kept_at;                             // of the largest triangle in Unrefined::kept
  Merging merging;                           // of the input, before refinement
  Overlap overlap;                           // of the input's areas
  OutsideSegments outside;                   // before simplification
  std::optional<Simplification> simplified;  // unless MeshRequest::simplify is 0
  // If MeshRequest::layers has some. What is above on triangles, from min_angle_deg to kept_at, is
  // of those outside of layers.
  std::optional<LayerSummary> layers;
  // The costliest one, if it has at least a fifth of a mesh of a thousand triangles or more.
  std::optional<NarrowPlace> narrow;

  // Only with MeshRequest::sample_points. At each, the bound on the area of a triangle with its
  // centroid there: the least of the size and the region's. Infinity for none, NaN outside of the
  // domain, 0 at a place where the size alone is no size.
  std::vector<double> sampled_bounds;
  double expected_triangles = 0;  // of a mesh, about

  // Seconds of wall time.
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

// All of a mesh at once.
struct Mesh {
  std::vector<Point> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise
  std::vector<std::int32_t> regions;  // region id per triangle; empty if every id is 0
  std::vector<Chunk::Edge> edges;     // on input segments
  std::vector<double> bulges;         // per edge, as Chunk has them; empty if all are straight
  // (mesh vertex, index of the input point) for the vertices that are input points.
  std::vector<std::array<std::uint32_t, 2>> input_points;
  Summary summary;
};

}  // namespace weft
