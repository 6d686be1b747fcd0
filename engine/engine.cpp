// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <utility>

#include "engine/base/failure.h"
#include "engine/base/text.h"
#include "engine/domain/arcs/arc.h"
#include "engine/domain/arcs/flat_arcs.h"
#include "engine/domain/domain.h"
#include "engine/domain/simplify/simplify.h"
#include "engine/domain/tolerance.h"
#include "engine/gradation_mesh.h"
#include "engine/layers/layer_plan.h"
#include "engine/refinement.h"
#include "engine/size/gradation/within_size.h"
#include "engine/size/size_map.h"
#include "engine/size/size_spec.h"

namespace weft {
namespace {

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
      if (auto error = limit_to_within()) return tl::unexpected(*error);
    }
    if (request_.simplify > 0) {
      if (auto error = context_.compute([this] { return simplify_domain(); }))
        return tl::unexpected(*error);
    }
    const Refinable ready{request_,
                          domain_,
                          ground(),
                          box_,
                          size(),
                          map_ ? &*map_ : nullptr,
                          size_->bytes() + (flat_ ? flat_->bytes() : 0),
                          sides_,
                          layers_ ? &*layers_ : nullptr};
    if (auto error = refine(ready, sink_, context_, clock_, summary_))
      return tl::unexpected(std::move(*error));
    return summary_;
  }

 private:
  std::optional<Error> limit_to_within() {
    auto within = limit_within(request_, domain_, ground(), box_, size(),
                               *size_->limited_across_land(), context_);
    if (!within) return within.error();
    size_->add(
        std::make_unique<WithinSize>(size(), *size_->limited_across_land(), std::move(*within)));
    return context_.compute([this] { return map_size(); });
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
    if (has_triangle_cap(context_.budget()))
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

  static std::uint64_t bytes_of(const Pslg& pslg) {
    return pslg.points.size() * sizeof(Point) + pslg.segments.size() * sizeof(Segment);
  }

  // What the size sees of a domain with arcs.
  std::optional<Error> flatten() {
    if (flat_ || domain_.curvatures.empty()) return std::nullopt;
    const std::uint64_t bytes =
        bytes_of(request_.pslg) + count_chords(request_.pslg) * (sizeof(Point) + sizeof(Segment));
    if (auto error = context_.need_bytes(domain_.bytes() + bytes, "chords of arcs")) return error;
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

  const SizeFunction& size() const { return size_->function(); }

  // A domain whose arcs are polylines.
  struct Flat {
    Pslg pslg;
    Domain domain;

    std::uint64_t bytes() const { return bytes_of(pslg) + domain.bytes(); }
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
  PeriodicSides sides_;
  std::optional<LaidOut> layers_;
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
