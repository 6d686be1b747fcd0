// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>

#include "engine/base/failure.h"
#include "engine/base/text.h"
#include "engine/domain/arcs/arc.h"
#include "engine/domain/arcs/flat_arcs.h"
#include "engine/domain/domain.h"
#include "engine/domain/simplify/simplify.h"
#include "engine/domain/tolerance.h"
#include "engine/emit/bounds_error.h"
#include "engine/gradation_mesh.h"
#include "engine/layers/layer_filler.h"
#include "engine/layers/layer_plan.h"
#include "engine/mesh_run.h"
#include "engine/parallel/narrow_places.h"
#include "engine/refine/acute_corners.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/edge_limits.h"
#include "engine/refine/mapped_area.h"
#include "engine/refine/storage/mesh_store.h"
#include "engine/size/gradation/scaled_size.h"
#include "engine/size/gradation/within_size.h"
#include "engine/size/lattice/lattice_map.h"
#include "engine/size/size_map.h"
#include "engine/size/size_spec.h"
#include "engine/size/size_warnings.h"
#include "engine/size/vanishing_size.h"

namespace weft {
namespace {

// Wall time since the last call.
class StageClock {
 public:
  double lap() {
    const auto now = ExecutionContext::Clock::now();
    return std::chrono::duration<double>(now - std::exchange(start_, now)).count();
  }

 private:
  ExecutionContext::Clock::time_point start_ = ExecutionContext::Clock::now();
};

// From this extent on the sixth powers of edges, which the angle test multiplies, are normal
// numbers; kMaxMagnitude keeps them finite.
std::optional<Error> check_extent(const Box& box) {
  constexpr double kSmallestExtent = 1e-40;
  const double extent = std::max(box.width(), box.height());
  if (extent >= kSmallestExtent) return std::nullopt;
  return Error{ErrorCode::kBadCoordinate, "domain.points",
               "the domain is at most " + text(extent) + " wide and high, it must be at least " +
                   text(kSmallestExtent)};
}

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

// The stages of a run, in order.
class Pipeline {
 public:
  Pipeline(const MeshRequest& request, ChunkSink& sink, ExecutionContext& context)
      : request_(request), sink_(sink), context_(context) {}

  Result<Summary> run() {
    if (auto error = check_options(request_)) return tl::unexpected(*error);
    if (auto error = context_.need_bytes(bytes_to_make(request_.size, request_.pslg), "the size"))
      return tl::unexpected(*error);
    if (auto error = check_size(request_.size)) return tl::unexpected(*error);
    if (Trace* const trace = context_.trace()) trace->start();
    if (auto error = context_.compute([this] { return prepare(); })) return tl::unexpected(*error);
    if (request_.size.gradation_within && size_->limited_across_land() != nullptr) {
      if (auto error = limit_within()) return tl::unexpected(*error);
    }
    if (request_.simplify > 0) {
      if (auto error = context_.compute([this] { return simplify_domain(); }))
        return tl::unexpected(*error);
    }
    return refine();
  }

 private:
  static constexpr std::uint64_t kUncountable = 1'000'000'000'000'000'000;

  // From the domain and its size on. Reads neither `pslg` nor the value of the size.
  Result<Summary> refine() {
    const double bound = size().constant().value_or(std::numeric_limits<double>::infinity());
    quality_ = QualityBounds::from(request_.min_angle_deg, request_.min_edge, precision_of(box_));
    if (request_.placement == Placement::kLattice)
      quality_.lattice = LatticeShape::for_angle(request_.min_angle_deg);
    edge_limits_ = EdgeLimits(sizes_at(), request_.keep);
    if (auto error = check_edge_limits(request_, edge_limits_, 2 * std::sqrt(quality_.min_length2)))
      return tl::unexpected(*error);
    if (auto error = check_borders()) return tl::unexpected(*error);
    if (auto error = admit(bound)) return tl::unexpected(*error);
    if (!map_) return mesh(ConstantArea(bound), 0);
    LatticeMap lattices;
    if (quality_.lattice.exists()) {
      auto laid_out = context_.compute(
          [&] { return LatticeMap::build(size(), *map_, box_, quality_.lattice, context_); });
      if (!laid_out) return tl::unexpected(laid_out.error());
      lattices = std::move(*laid_out);
      lattices_ = lattices.lattices_that_vary();
    }
    context_.end_stage("lattices");
    return mesh(MappedArea(size(), *map_, lattices),
                map_->bytes() + lattices.bytes() + size_->bytes());
  }

  // Measures the gradation within the domain on a mesh of its own, with a share of the sizes that
  // are limited across land.
  std::optional<Error> limit_within() {
    const SizeFunction& across = size();
    const double share = GradationMesh::share_of_edges(request_.size.gradation);
    MeshRequest request;
    request.min_edge = share * request_.min_edge;
    request.leaf_triangles = request_.leaf_triangles;
    request.sweeps = 0;
    request.allow_unrefined = true;
    Budget budget = context_.budget();
    budget.max_triangles = std::min(budget.max_triangles, budget.triangle_limit);
    ExecutionContext context(context_, budget);
    GradationMesh mesh(request_);
    Pipeline run(request, mesh, context);
    run.size_.emplace(std::make_unique<ScaledSize>(across, share * share));
    run.domain_ = std::move(domain_);
    run.summary_.box = summary_.box;
    run.box_ = box_;
    run.flat_ = std::move(flat_);
    if (auto error = context.compute([&] { return run.map_size(); })) return error;
    if (auto made = run.refine(); !made) return made.error();
    domain_ = std::move(run.domain_);
    flat_ = std::move(run.flat_);
    return context_.compute([&]() -> std::optional<Error> {
      const SizeFunction& unlimited = *size_->limited_across_land();
      auto within = std::move(mesh).limit(unlimited, domain_.bytes() + size_->bytes(), context_);
      if (!within) return within.error();
      size_->add(std::make_unique<WithinSize>(across, unlimited, std::move(*within)));
      return map_size();
    });
  }

  // The domain's triangulation, and the map of a size that varies.
  std::optional<Error> prepare() {
    context_.enter(Stage::kTriangulate);
    // Up to twice the least angle, no triangle at the rim of an arc is cut off by it and good.
    const double max_turn_deg = std::clamp(2 * request_.min_angle_deg, 40.0, kMaxTurnDeg);
    const double asked_deg = 360 / request_.size.points_per_circle;
    auto domain = triangulate(request_.pslg, context_, std::min(max_turn_deg, asked_deg));
    if (!domain) return domain.error();
    domain_ = std::move(*domain);
    if (auto error = find_sides(std::min(max_turn_deg, asked_deg))) return error;
    if (request_.simplify > 0 && !domain_.curvatures.empty())
      return Error{ErrorCode::kBadOption, "simplify",
                   "simplify is " + text(request_.simplify) +
                       ", but the domain has arcs, and only straight segments are simplified"};
    summary_.merging = domain_.merging;
    summary_.overlap = domain_.overlap;
    summary_.outside = domain_.outside;
    for (Point p : domain_.vertices) summary_.box.add(p);
    if (auto error = check_extent(summary_.box)) return error;
    box_ = box_with_arcs(domain_, summary_.box);
    if (auto error = lay_out_layers()) return error;
    summary_.triangulate_seconds = clock_.lap();
    context_.end_stage("triangulation");

    context_.enter(Stage::kSize);
    const SizeSpec& spec = request_.size;
    if (!spec.fields.empty() || spec.gradation > 0 || spec.cells_across > 0)
      if (auto error = flatten()) return error;
    auto made = make_size(request_.size, flat_ ? flat_->pslg : request_.pslg, ground(), context_);
    if (!made) return made.error();
    size_.emplace(std::move(*made));
    if (request_.simplify > 0) return std::nullopt;  // the map is that of the simplified domain
    return map_size();
  }

  // Finds the sides that repeat each other, and has each have the vertices of both.
  std::optional<Error> find_sides(double max_turn_deg) {
    if (request_.periodic.empty()) return std::nullopt;
    if (has_triangle_cap())
      return Error{ErrorCode::kBadOption, "quality.periodic",
                   "quality.periodic needs a mesh that is refined to the end, but "
                   "budget.max_triangles may end it before"};
    const double tolerance = merge_tolerance(request_.pslg);
    auto sides = PeriodicSides::of(request_.periodic, domain_, tolerance);
    if (!sides) return sides.error();
    sides_ = std::move(*sides);
    if (!sides_.lacks_images()) return std::nullopt;
    std::vector<std::uint32_t> origin;
    auto domain = triangulate(sides_.with_images(request_.pslg, origin), context_, max_turn_deg);
    if (!domain) return domain.error();
    domain_ = std::move(*domain);
    const std::size_t points = request_.pslg.points.size();
    const std::size_t segments = request_.pslg.segments.size();
    for (std::uint32_t& point : domain_.input_point)
      if (point != kNone && point >= points) point = kNone;
    for (Subsegment& s : domain_.subsegments)
      if (s.segment >= segments) s.segment = origin[s.segment - segments];
    sides = PeriodicSides::of(request_.periodic, domain_, tolerance);
    if (!sides) return sides.error();
    sides_ = std::move(*sides);
    return std::nullopt;
  }

  // Makes holes of the domain where layers will be.
  std::optional<Error> lay_out_layers() {
    if (request_.layers.empty()) return std::nullopt;
    if (!domain_.curvatures.empty())
      return Error{ErrorCode::kBadOption, "quality.layers",
                   "quality.layers need a domain of straight segments, but it has arcs"};
    auto plan = LayerPlan::of(request_.layers, domain_, merge_tolerance(request_.pslg), context_);
    if (!plan) return plan.error();
    auto domain = triangulate(plan->with_holes(request_.pslg, request_.layers), context_);
    if (!domain) return domain.error();
    if (auto error = plan->check(request_.pslg, domain_, *domain)) return error;
    layers_.emplace(std::move(domain_), std::move(*plan), request_, sink_);
    domain_ = std::move(*domain);
    return std::nullopt;
  }

  // The lengths of edges at markers, for the line on which layers end.
  std::vector<SizeAt> sizes_at() const {
    std::vector<SizeAt> sizes = request_.size.at;
    if (layers_)
      for (SizeAt& at : sizes)
        at.max_edge *= layers_->plan.least_stretch(at.marker, layers_->domain);
    return sizes;
  }

  // What the size sees of a domain with arcs.
  std::optional<Error> flatten() {
    if (flat_ || domain_.curvatures.empty()) return std::nullopt;
    flat_.emplace(Flat{flatten_arcs(request_.pslg), {}});
    auto domain = triangulate(flat_->pslg, context_);
    if (domain) {
      flat_->domain = std::move(*domain);
      return std::nullopt;
    }
    // A seed may be that near to an arc that it is not on its side: then chords have to do.
    const ErrorCode code = domain.error().code;
    if (code != ErrorCode::kSeedOutsideDomain && code != ErrorCode::kSeedOnSegment &&
        code != ErrorCode::kEmptyDomain)
      return domain.error();
    flat_->domain = domain_;
    return std::nullopt;
  }
  const Domain& ground() const { return flat_ ? flat_->domain : domain_; }

  // Makes the domain no finer than a share of its size. The size stays that of the domain as it
  // was.
  std::optional<Error> simplify_domain() {
    if (size().constant() == std::numeric_limits<double>::infinity() && !has_bounds())
      return Error{ErrorCode::kBadOption, "simplify",
                   "simplify is " + text(request_.simplify) +
                       ", a share of the size, and the request has no size"};
    Finest finest{.share = request_.simplify,
                  .edge =
                      [this](Point p) {
                        const double area = size()(p);
                        return SizeFunction::bounds_area(area)
                                   ? SizeFunction::edge_of_area(area)
                                   : std::numeric_limits<double>::infinity();
                      },
                  .region_edge = {}};
    for (const Region& region : domain_.regions)
      finest.region_edge.push_back(SizeFunction::edge_of_area(region.max_area));
    for (const SizeAt& at : request_.size.at)
      finest.marker_edge.emplace_back(at.marker, at.max_edge);
    auto made = simplify(domain_, finest, context_);
    if (!made) return made.error();
    domain_ = std::move(made->domain);
    summary_.simplified = made->changes;
    summary_.box = {};
    for (const Point p : domain_.vertices) summary_.box.add(p);
    box_ = summary_.box;
    context_.end_stage("simplification");
    return map_size();
  }

  // Whether regions or markers have a bound of their own.
  bool has_bounds() const {
    return !request_.size.at.empty() ||
           std::any_of(domain_.regions.begin(), domain_.regions.end(), [](const Region& region) {
             return region.max_area < std::numeric_limits<double>::infinity();
           });
  }

  std::optional<Error> map_size() {
    if (size().constant()) return std::nullopt;
    if (auto error = flatten()) return error;
    auto map = SizeMap::build(size(), ground(), context_);
    if (!map) return map.error();
    map_.emplace(std::move(*map));
    return std::nullopt;
  }

  // Refuses sizes for which refinement would not end, unless the client has said where it may.
  std::optional<Error> check_borders() {
    if (!map_ || request_.min_edge > 0 || has_triangle_cap()) return std::nullopt;
    const auto found = find_vanishing(size(), ground(), quality_.min_length2, context_);
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
    const double by_bounds = triangles_asked(domain_, bound);
    const double pieces = edge_limits_.pieces(domain_);
    const double by_pieces = EdgeLimits::triangles_lower_bound(pieces, domain_);
    const double lower_bound =
        std::max({map_ ? map_->triangles_lower_bound() : 0, by_bounds, by_pieces});
    const double expected = std::max(map_ ? map_->expected_triangles() : 0, by_bounds);
    if (domain_.triangles.size() > budget.triangle_limit) {
      return over_limit("domain", "the domain itself has " +
                                      std::to_string(domain_.triangles.size()) +
                                      " triangles, more than the limit of " +
                                      std::to_string(budget.triangle_limit));
    }
    const char* const asked_by = lower_bound > by_pieces ? "size" : "size.at";
    if (!has_triangle_cap() && lower_bound > static_cast<double>(budget.triangle_limit)) {
      return over_limit(asked_by, "the size asks for at least " + count_text(lower_bound) +
                                      " triangles, more than the limit of " +
                                      std::to_string(budget.triangle_limit));
    }
    if (!has_triangle_cap() && !may_stream() &&
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
                        static_cast<double>(domain_.triangles.size()));
    auto corners =
        context_.compute([&] { return AcuteCorners::build(domain_, quality_, context_); });
    if (!corners) return corners.error();
    corners_.emplace(std::move(*corners));
    corners_->share_shells(sides_.twins());
    // Between segments that are kept, no angle asks for triangles.
    if (!edge_limits_.keep_any()) {
      auto narrow = context_.compute([&] {
        return NarrowPlaces::find(
            domain_, corners_->crossed_arms(), quality_,
            [&](Point p) { return map_ ? map_->expected_size(p) : bound; }, context_);
      });
      if (!narrow) return narrow.error();
      narrow_ = std::move(*narrow);
    }
    if (!has_triangle_cap() && narrow_.lower_bound() > static_cast<double>(budget.triangle_limit))
      return too_narrow();
    lower_bound_ = std::max(lower_bound, narrow_.lower_bound());
    const double elsewhere =
        NarrowPlaces::elsewhere(quality_) * static_cast<double>(domain_.triangles.size());
    expected_ = std::max({by_size_, elsewhere, EdgeLimits::kTrianglesPerPiece * pieces}) +
                narrow_.expected();
    const double most =
        static_cast<double>(has_triangle_cap() ? budget.max_triangles : kUncountable);
    context_.report_expected(static_cast<std::uint64_t>(std::min(expected_, most)));
    context_.end_stage("size map");
    return std::nullopt;
  }

  // Refuses sizes at markers whose edges alone take more than the run may have.
  std::optional<Error> check_bytes_of_pieces(double pieces) const {
    if (has_triangle_cap()) return std::nullopt;
    const double bytes = EdgeLimits::bytes_lower_bound(pieces, domain_);
    const std::uint64_t most = context_.budget().max_bytes;
    if (bytes <= static_cast<double>(most)) return std::nullopt;
    return Error{ErrorCode::kBudgetExceeded, "size.at",
                 "the lengths at markers ask for at least " + count_text(pieces) +
                     " edges, which take " + count_text(bytes) + " bytes; the limit is " +
                     std::to_string(most)};
  }

  template <class AreaBound>
  Result<Summary> mesh(const AreaBound& area, std::uint64_t size_bytes) {
    summary_.size_seconds = clock_.lap();
    context_.enter(Stage::kRefine);
    MeshPlan plan{.domain = domain_,
                  .box = box_,
                  .quality = quality_,
                  .corners = *corners_,
                  .narrow = narrow_,
                  .expected_triangles = expected_,
                  .expected_by_size = by_size_,
                  .may_stream = may_stream(),
                  .leaf_triangles = request_.leaf_triangles.value_or(leaf_triangles_for(by_size_)),
                  .triangles_lower_bound = lower_bound_,
                  .sweeps = sweeps(),
                  .other_bytes = size_bytes + narrow_.bytes() + bytes_of_layers(),
                  .edge_limits = edge_limits_,
                  .sides = sides_};
    if (has_triangle_cap()) plan.max_triangles = context_.budget().max_triangles;
    ChunkSink& sink = layers_ ? layers_->filler : sink_;
    if (auto error = run_mesh(plan, area, sink, context_, summary_)) return tl::unexpected(*error);
    if (layers_)
      if (auto error = layers_->filler.finish(context_, summary_)) return tl::unexpected(*error);
    summary_.engine_seconds += summary_.triangulate_seconds + summary_.size_seconds;
    summary_.size_warnings = size_warnings(request_.size, summary_.box, summary_.least_bound);
    summary_.narrow = costly_place();
    if (!request_.allow_unrefined) {
      if (auto error = bounds_error(summary_, request_.min_angle_deg))
        return tl::unexpected(*error);
    }
    context_.enter(Stage::kDone);
    return summary_;
  }

  std::uint32_t sweeps() const {
    constexpr std::uint32_t kDefault = 2;
    constexpr double kNearlyAll = 4;  // triangles that the size makes, over those of the domain
    const bool worth_it = quality_.lattice.exists() &&
                          by_size_ > kNearlyAll * static_cast<double>(domain_.triangles.size());
    return request_.sweeps.value_or(worth_it && sweeps_cost_little() ? kDefault : 0);
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
    return layers_ ? layers_->plan.segment_of(segment, request_.pslg, layers_->domain) : segment;
  }

  // The domain as it was, and what the filler keeps of a mesh: coordinates, in a vector that grows.
  std::uint64_t bytes_of_layers() const {
    constexpr double kBytesPerTriangle = 2 * sizeof(Point) / 2.0;
    return layers_ ? layers_->domain.bytes() +
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
    return request_.min_angle_deg <= kMaxStreamingAngleDeg && !edge_limits_.keep_any() &&
           sides_.empty();
  }

  // Whether the client set a limit of its own: reaching that is no error.
  bool has_triangle_cap() const {
    const std::uint64_t cap = context_.budget().max_triangles;
    return cap <= context_.budget().triangle_limit && cap != Budget{}.max_triangles;
  }

  const SizeFunction& size() const { return size_->function(); }

  // A domain whose arcs are polylines.
  struct Flat {
    Pslg pslg;
    Domain domain;
  };

  // Layers, and the domain as it was before they made holes in it.
  struct LaidOut {
    LaidOut(Domain&& before, LayerPlan&& made, const MeshRequest& request, ChunkSink& sink)
        : domain(std::move(before)),
          plan(std::move(made)),
          filler(request.layers, request.pslg, domain, plan, sink) {}

    Domain domain;
    LayerPlan plan;
    LayerFiller filler;
  };

  const MeshRequest& request_;
  ChunkSink& sink_;
  ExecutionContext& context_;
  StageClock clock_;
  std::optional<Size> size_;
  Domain domain_;
  Box box_;                   // of all vertices that the mesh may have
  std::optional<Flat> flat_;  // of a domain with arcs
  std::optional<SizeMap> map_;
  QualityBounds quality_;
  EdgeLimits edge_limits_;
  PeriodicSides sides_;
  std::optional<LaidOut> layers_;
  std::optional<AcuteCorners> corners_;  // of domain_
  NarrowPlaces narrow_;
  double lower_bound_ = 0;    // of the triangles
  double expected_ = 0;       // triangles
  double by_size_ = 0;        // of these, what the size alone makes
  std::size_t lattices_ = 0;  // that the size bends, or where none fits
  Summary summary_;
};

}  // namespace

Result<Summary> generate_mesh(const MeshRequest& request, ChunkSink& sink,
                              ExecutionContext& context) {
  try {
    return Pipeline(request, sink, context).run();
  } catch (const Failure& failure) {
    return tl::unexpected(failure.error());
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, "", "memory ran out");
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInternal, "", e.what());
  }
}

}  // namespace weft
