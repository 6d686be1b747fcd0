// SPDX-License-Identifier: Apache-2.0
#include "engine/refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "engine/domain/tolerance.h"
#include "engine/emit/bounds_error.h"
#include "engine/emit/digest.h"
#include "engine/mesh_run.h"
#include "engine/parallel/narrow_places.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/mapped_area.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/lattice/lattice_map.h"
#include "engine/size/sampled_size.h"
#include "engine/size/size_warnings.h"
#include "engine/size/vanishing_size.h"

namespace weft {
namespace {

// Where double precision ends: edges below this are not made.
double precision_of(const Box& box) {
  return kEdgeFraction * std::max({std::fabs(box.min_x), std::fabs(box.min_y), std::fabs(box.max_x),
                                   std::fabs(box.max_y)});
}

// The least number of triangles for areas of at most `bound` and of the bounds of regions.
double triangles_asked(const Domain& domain, double bound) {
  double sum = 0;
  for (const Domain::Triangle& t : domain.triangles) {
    const Point a = domain.vertices[t.vertex[0]];
    const Point b = domain.vertices[t.vertex[1]];
    const Point c = domain.vertices[t.vertex[2]];
    const double area = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    sum += area / std::min(bound, domain.regions[t.region].max_area);
  }
  return sum;
}

// A number of triangles, as an error spells it.
std::string count_text(double count) {
  return text(std::min(std::ceil(count), 1e300));  // which need not be counted any more
}

class Refinement {
 public:
  Refinement(const Refinable& ready, ChunkSink& sink, ExecutionContext& context, StageClock& clock,
             Summary& summary)
      : ready_(ready), sink_(sink), context_(context), clock_(clock), summary_(summary) {}

  std::optional<Error> run() {
    const double bound = ready_.size.constant().value_or(std::numeric_limits<double>::infinity());
    quality_ = QualityBounds::from(ready_.request.min_angle_deg, ready_.request.min_edge,
                                   precision_of(ready_.box));
    if (ready_.request.placement == Placement::kLattice)
      quality_.lattice = LatticeShape::for_angle(ready_.request.min_angle_deg);
    edge_limits_ = EdgeLimits(sizes_at(), ready_.request.keep);
    if (auto error =
            check_edge_limits(ready_.request, edge_limits_, 2 * std::sqrt(quality_.min_length2)))
      return error;
    if (auto error = check_borders()) return error;
    if (auto error = admit(bound)) return error;
    if (!ready_.request.sample_points.empty()) return sample();
    if (!ready_.map) return mesh(ConstantArea(bound), 0);
    LatticeMap lattices;
    if (quality_.lattice.exists()) {
      auto laid_out = context_.compute([&] {
        return LatticeMap::build(ready_.size, *ready_.map, ready_.box, quality_.lattice, context_);
      });
      if (!laid_out) return laid_out.error();
      lattices = std::move(*laid_out);
      lattices_ = lattices.lattices_that_vary();
    }
    context_.end_stage("lattices");
    return mesh(MappedArea(ready_.size, *ready_.map, lattices),
                ready_.map->bytes() + lattices.bytes() + ready_.size_bytes);
  }

 private:
  static constexpr std::uint64_t kUncountable = 1'000'000'000'000'000'000;

  // The lengths of edges at markers, for the line on which layers end.
  std::vector<SizeAt> sizes_at() const {
    std::vector<SizeAt> sizes = ready_.request.size.at;
    if (ready_.layers)
      for (SizeAt& at : sizes)
        at.max_edge *= ready_.layers->plan.least_stretch(at.marker, ready_.layers->domain);
    return sizes;
  }

  // Refuses sizes for which refinement would not end, unless the client has said where it may.
  std::optional<Error> check_borders() {
    if (!ready_.map || ready_.request.min_edge > 0 || has_triangle_cap(context_.budget()))
      return std::nullopt;
    const auto found = find_vanishing(ready_.size, ready_.ground, quality_.min_length2, context_);
    if (!found) return found.error();
    if (!*found) return std::nullopt;
    const Point at = **found;
    return Error{ErrorCode::kBadSizeValue, "size",
                 "the size falls to 0 on the segment through (" + text(at.x) + ", " + text(at.y) +
                     "), as fast as the square of the distance to it or faster, which would need "
                     "infinitely many triangles; give it a least value above 0, by max",
                 at};
  }

  // Estimates the number of triangles, for the size `bound` everywhere or that of the map, and
  // refuses a mesh over the limit.
  std::optional<Error> admit(double bound) {
    const Budget& budget = context_.budget();
    const auto over_limit = [](const char* field, std::string message) {
      return Error{ErrorCode::kLimitExceeded, field, std::move(message)};
    };
    const double by_bounds = triangles_asked(ready_.domain, bound);
    const double pieces = edge_limits_.pieces(ready_.domain);
    const double by_pieces = EdgeLimits::triangles_lower_bound(pieces, ready_.domain);
    const double lower_bound =
        std::max({ready_.map ? ready_.map->triangles_lower_bound() : 0, by_bounds, by_pieces});
    const double expected = std::max(ready_.map ? ready_.map->expected_triangles() : 0, by_bounds);
    if (ready_.domain.triangles.size() > budget.triangle_limit) {
      return over_limit("domain", "the domain itself has " +
                                      std::to_string(ready_.domain.triangles.size()) +
                                      " triangles, more than the limit of " +
                                      std::to_string(budget.triangle_limit));
    }
    const char* const asked_by = lower_bound > by_pieces ? "size" : "size.at";
    if (!has_triangle_cap(context_.budget()) &&
        lower_bound > static_cast<double>(budget.triangle_limit)) {
      return over_limit(asked_by, "the size asks for at least " + count_text(lower_bound) +
                                      " triangles, more than the limit of " +
                                      std::to_string(budget.triangle_limit));
    }
    if (!has_triangle_cap(context_.budget()) && !may_stream() &&
        lower_bound > static_cast<double>(MeshStore::kMaxTriangles)) {
      return over_limit(asked_by, "the size asks for at least " + count_text(lower_bound) +
                                      " triangles; a mesh with a minimum angle above " +
                                      text(kMaxStreamingAngleDeg) +
                                      " degrees, with segments that are kept or with periodic "
                                      "sides, has at most " +
                                      std::to_string(MeshStore::kMaxTriangles) +
                                      ", because all of it is in memory at the same time");
    }
    if (auto error = check_bytes_of_pieces(pieces)) return error;
    by_size_ = std::max(triangles_per_bound(quality_.lattice) * expected,
                        static_cast<double>(ready_.domain.triangles.size()));
    auto corners =
        context_.compute([&] { return AcuteCorners::build(ready_.domain, quality_, context_); });
    if (!corners) return corners.error();
    corners_.emplace(std::move(*corners));
    corners_->share_shells(ready_.sides.twins());
    // Between segments that are kept, no angle asks for triangles.
    if (!edge_limits_.keep_any()) {
      auto narrow = context_.compute([&] {
        return NarrowPlaces::find(
            ready_.domain, corners_->crossed_arms(), quality_,
            [&](Point p) { return ready_.map ? ready_.map->expected_size(p) : bound; }, context_);
      });
      if (!narrow) return narrow.error();
      narrow_ = std::move(*narrow);
    }
    if (!has_triangle_cap(context_.budget()) &&
        narrow_.lower_bound() > static_cast<double>(budget.triangle_limit))
      return too_narrow();
    lower_bound_ = std::max(lower_bound, narrow_.lower_bound());
    const double elsewhere =
        NarrowPlaces::elsewhere(quality_) * static_cast<double>(ready_.domain.triangles.size());
    expected_ = std::max({by_size_, elsewhere, EdgeLimits::kTrianglesPerPiece * pieces}) +
                narrow_.expected();
    const double most = static_cast<double>(
        has_triangle_cap(context_.budget()) ? budget.max_triangles : kUncountable);
    context_.report_expected(static_cast<std::uint64_t>(std::min(expected_, most)));
    context_.end_stage("size map");
    return std::nullopt;
  }

  // Refuses sizes at markers whose edges alone take more than the run may have.
  std::optional<Error> check_bytes_of_pieces(double pieces) const {
    if (has_triangle_cap(context_.budget())) return std::nullopt;
    const double bytes = EdgeLimits::bytes_lower_bound(pieces, ready_.domain);
    const std::uint64_t most = context_.budget().max_bytes;
    if (bytes <= static_cast<double>(most)) return std::nullopt;
    return Error{ErrorCode::kBudgetExceeded, "size.at",
                 "the lengths at markers ask for at least " + count_text(pieces) +
                     " edges, which take " + count_text(bytes) + " bytes; the limit is " +
                     std::to_string(most)};
  }

  // Instead of a mesh.
  std::optional<Error> sample() {
    // What layers take of the domain is a part of it.
    const Domain& domain = ready_.layers ? ready_.layers->domain : ready_.ground;
    const std::vector<Point>& points = ready_.request.sample_points;
    summary_.peak_bytes = ready_.size_bytes + (ready_.map ? ready_.map->bytes() : 0) +
                          ready_.domain.bytes() + bytes_to_sample(domain, points.size());
    if (auto error = context_.need_bytes(summary_.peak_bytes, "the sampled size")) return error;
    auto sampled =
        context_.compute([&] { return sample_size(ready_.size, domain, points, context_); });
    if (!sampled) return sampled.error();
    if (sampled->bad) return bad_size_error({*sampled->bad, &ready_.size});
    // Where a size varies, rows of lattices end.
    constexpr double kIfItVaries = 1.12;
    const double by_bounds = triangles_per_bound(quality_.lattice) * sampled->per_bound;
    summary_.expected_triangles =
        std::min(std::max(expected_, by_bounds) * (ready_.map ? kIfItVaries : 1),
                 static_cast<double>(kUncountable));
    summary_.sampled_bounds = std::move(sampled->bounds);
    summary_.size_seconds = clock_.lap();
    summary_.engine_seconds = summary_.triangulate_seconds + summary_.size_seconds;
    summary_.size_warnings = size_warnings(ready_.request.size, summary_.box, least_sampled());
    summary_.digest = Sha256().finish();  // of no chunks
    context_.enter(Stage::kDone);
    return std::nullopt;
  }

  // Above 0; 0 if there is none.
  double least_sampled() const {
    double least = std::numeric_limits<double>::infinity();
    for (const double bound : summary_.sampled_bounds)
      if (bound > 0 && bound < least) least = bound;
    return std::isinf(least) ? 0 : least;
  }

  template <class AreaBound>
  std::optional<Error> mesh(const AreaBound& area, std::uint64_t size_bytes) {
    summary_.size_seconds = clock_.lap();
    context_.enter(Stage::kRefine);
    MeshPlan plan{
        .domain = ready_.domain,
        .box = ready_.box,
        .quality = quality_,
        .corners = *corners_,
        .narrow = narrow_,
        .expected_triangles = expected_,
        .expected_by_size = by_size_,
        .may_stream = may_stream(),
        .leaf_triangles = ready_.request.leaf_triangles.value_or(leaf_triangles_for(by_size_)),
        .triangles_lower_bound = lower_bound_,
        .sweeps = sweeps(),
        .other_bytes = size_bytes + narrow_.bytes() + bytes_of_layers(),
        .edge_limits = edge_limits_,
        .sides = ready_.sides};
    if (has_triangle_cap(context_.budget())) plan.max_triangles = context_.budget().max_triangles;
    ChunkSink& sink = ready_.layers ? ready_.layers->filler : sink_;
    if (auto error = run_mesh(plan, area, sink, context_, summary_)) return error;
    if (ready_.layers)
      if (auto error = ready_.layers->filler.finish(context_, summary_)) return error;
    summary_.engine_seconds += summary_.triangulate_seconds + summary_.size_seconds;
    summary_.size_warnings = size_warnings(ready_.request.size, summary_.box, summary_.least_bound);
    summary_.narrow = costly_place();
    if (!ready_.request.allow_unrefined) {
      if (auto error = bounds_error(summary_, ready_.request.min_angle_deg)) return error;
    }
    context_.enter(Stage::kDone);
    return std::nullopt;
  }

  std::uint32_t sweeps() const {
    constexpr std::uint32_t kDefault = 2;
    constexpr double kNearlyAll = 4;  // triangles that the size makes, over those of the domain
    const bool worth_it =
        quality_.lattice.exists() &&
        by_size_ > kNearlyAll * static_cast<double>(ready_.domain.triangles.size());
    return ready_.request.sweeps.value_or(worth_it && sweeps_cost_little() ? kDefault : 0);
  }

  // Smoothing takes time for each triangle in the rows where two lattices meet. If `n` lattices are
  // in a mesh of N triangles, these rows hold about 3 sqrt(n / N) of the triangles:
  //
  //                   pipe   slope  hollow  long waves
  //   sqrt(n / N)     0.010  0.009  0.018   0.033
  //   time, 2 sweeps  1.1    1.3    1.3     1.5    times that without
  //
  // In a small mesh the angles matter more than the time.
  bool sweeps_cost_little() const {
    constexpr double kSmall = 1e5;  // triangles
    constexpr double kFewFaults = 0.012;
    return by_size_ < kSmall || static_cast<double>(lattices_) < kFewFaults * kFewFaults * by_size_;
  }

  // A segment of the request, also for those on which layers end.
  std::uint32_t segment_of(std::uint32_t segment) const {
    return ready_.layers
               ? ready_.layers->plan.segment_of(segment, ready_.request.pslg, ready_.layers->domain)
               : segment;
  }

  // The domain as it was, and what the filler keeps of a mesh: coordinates, in a vector that grows.
  std::uint64_t bytes_of_layers() const {
    constexpr double kBytesPerTriangle = 2 * sizeof(Point) / 2.0;
    return ready_.layers
               ? ready_.layers->domain.bytes() +
                     static_cast<std::uint64_t>(kBytesPerTriangle * std::min(expected_, 1e12))
               : 0;
  }

  Error too_narrow() const {
    const NarrowPlaces::Costliest& worst = *narrow_.costliest();
    return {ErrorCode::kLimitExceeded, "quality.min_angle_deg",
            "the minimum angle asks for at least " + count_text(narrow_.lower_bound()) +
                " triangles where the domain is narrow, more than the limit of " +
                std::to_string(context_.budget().triangle_limit) +
                "; the most of them between segments " + std::to_string(segment_of(worst.segment)) +
                " and " + std::to_string(segment_of(worst.other)) + ", " + text(worst.width) +
                " apart at (" + text(worst.at.x) + ", " + text(worst.at.y) + ")",
            worst.at};
  }

  std::optional<NarrowPlace> costly_place() const {
    constexpr std::uint64_t kMany = 1000;
    constexpr double kLargePart = 0.2;
    const auto& worst = narrow_.costliest();
    const auto triangles = static_cast<double>(summary_.triangles);
    const double least = worst ? 2 * worst->lower_bound : 0;  // the other segment has as many
    const double in_all = std::max(least, narrow_.lower_bound());
    if (summary_.triangles < kMany || in_all < kLargePart * triangles || !worst)
      return std::nullopt;
    return NarrowPlace{.segment = segment_of(worst->segment),
                       .other = segment_of(worst->other),
                       .at = worst->at,
                       .width = worst->width,
                       .triangles = std::min(least, triangles),
                       .in_all = std::min(in_all, triangles),
                       .widest = narrow_.widest()};
  }

  // A triangle at a segment that is kept may be larger than leaves are, and sides match in the end.
  bool may_stream() const {
    return ready_.request.min_angle_deg <= kMaxStreamingAngleDeg && !edge_limits_.keep_any() &&
           ready_.sides.empty();
  }

  const Refinable& ready_;
  ChunkSink& sink_;
  ExecutionContext& context_;
  StageClock& clock_;
  Summary& summary_;
  QualityBounds quality_;
  EdgeLimits edge_limits_;
  std::optional<AcuteCorners> corners_;
  NarrowPlaces narrow_;
  double lower_bound_ = 0;    // of the triangles
  double expected_ = 0;       // triangles
  double by_size_ = 0;        // of these, what the size alone makes
  std::size_t lattices_ = 0;  // that the size bends, or where none fits
};

}  // namespace

std::optional<Error> refine(const Refinable& ready, ChunkSink& sink, ExecutionContext& context,
                            StageClock& clock, Summary& summary) {
  return Refinement(ready, sink, context, clock, summary).run();
}

}  // namespace weft
