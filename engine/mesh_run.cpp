// SPDX-License-Identifier: Apache-2.0
#include "engine/mesh_run.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "engine/base/work_time.h"
#include "engine/emit/slot_fragments.h"
#include "engine/leaf_run.h"
#include "engine/parallel/leaf_stage.h"
#include "engine/refine/area_bound.h"
#include "engine/refine/mapped_area.h"
#include "engine/refine/refiner.h"
#include "engine/refine/smoothing/equaliser.h"
#include "engine/refine/smoothing/smoother.h"
#include "engine/refine/smoothing/stages.h"

namespace weft {
namespace {

using Clock = ExecutionContext::Clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// One attempt at the mesh.
template <class AreaBound>
class MeshRun {
 public:
  // `truncated`: stop at the client's number of triangles, and keep the mesh as it is then.
  MeshRun(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink, ExecutionContext& context,
          Summary& summary, MeshStore& mesh, bool truncated)
      : plan_(plan),
        area_(area),
        context_(context),
        summary_(summary),
        mesh_(mesh),
        truncated_(truncated),
        refinement_{mesh,
                    plan.corners,
                    plan.domain.regions,
                    plan.edge_limits,
                    context,
                    plan.domain.bytes() + plan.other_bytes + plan.corners.bytes(),
                    truncated ? context.budget().triangle_limit : limit(plan, context)},
        root_(Slots::of_domain(plan.domain)),
        fragments_(plan, area, refinement_, truncated, sink, summary),
        leaves_(plan, area, refinement_, root_) {}

  // What comes before the leaves' tasks, or all refinement if there are no leaves. `start` is when
  // the work on the mesh began.
  std::optional<Error> prepare(Clock::time_point start) {
    context_.add_triangles(static_cast<std::int64_t>(plan_.domain.triangles.size()));
    context_.end_stage("mesh set-up");
    std::optional<Error> error;
    if (!truncated_ && plan_.wants_leaves())
      error = leaves_.prepare(!plan_.max_triangles && plan_.may_stream);
    if (!error && !leaves_.exists()) error = refine_alone();
    summary_.coarse_seconds = seconds_since(start);
    return error;
  }

  // What comes after `prepare`.
  std::optional<Error> run(Clock::time_point start) {
    std::uint64_t run_bytes = 0;
    if (leaves_.exists()) {
      LeafRun<AreaBound> run(plan_, refinement_, leaves_, root_, fragments_);
      if (auto error = run.run()) return error;
      run_bytes = run.bytes();
      summary_.refine_seconds += run.refine_seconds();
      summary_.streamed = leaves_.streams() && !run.cleaned_up();
      summary_.rounds = leaves_.leaves().rounds();
      for (const Quadtree::Leaf& leaf : leaves_.tree().leaves())
        summary_.leaves.push_back(leaf.box);
    } else if (auto error = send_alone()) {
      return error;
    }
    fragments_.close();
    context_.end_stage("closing");
    RefinerStats stats = leaves_.stats();
    stats += alone_;
    summary_.insertions += stats.insertions;
    summary_.exact_predicates += stats.exact_predicates;
    summary_.deferred = leaves_.deferred();
    summary_.engine_seconds = seconds_since(start) - fragments_.run().blocked_seconds();
    summary_.refine_seconds += refine_time_.seconds();
    summary_.emit_seconds = fragments_.build_seconds();
    summary_.peak_bytes = refinement_.other_bytes + mesh_.bytes() + root_.bytes() + stats.bytes +
                          fragments_.run().peak_bytes() + leaves_.bytes() + run_bytes;
    return std::nullopt;
  }

 private:
  static constexpr std::uint64_t kNoCap = std::numeric_limits<std::uint64_t>::max();

  // The limit on triangles of the first attempt: that of the client, if it has one, instead of the
  // server's.
  static std::uint64_t limit(const MeshPlan& plan, const ExecutionContext& context) {
    return std::min(plan.max_triangles.value_or(kNoCap), context.budget().triangle_limit);
  }

  std::optional<Error> refine_alone() {
    context_.count_triangles_as(LeafRun<AreaBound>::kRefining);
    return refine_time_.measure([&] {
      Refiner<OwnsAll, AreaBound> refiner(refinement_, plan_.quality, area_,
                                          truncated_ ? *plan_.max_triangles : kNoCap);
      refiner.begin(root_, OwnsAll{}, plan_.box);
      const bool in_stages =
          plan_.sweeps > 0 && !truncated_ && area_.has_slack_in(plan_.box, plan_.quality.lattice);
      if (in_stages) refiner.set_stage(kFirstStage);
      auto error = refiner.queue_all();
      if (!error) error = in_stages ? refine_in_stages(refiner) : refiner.run();
      const std::array<const Slots*, 1> all{&root_};
      if (!error) error = plan_.sides.match(refiner, mesh_, plan_.corners, all, context_);
      alone_ = refiner.stats();
      if (!error && plan_.sweeps > 0 && !truncated_) error = smooth_alone();
      return error;
    });
  }

  // The first vertex that may move.
  std::uint32_t first_free() const {
    return static_cast<std::uint32_t>(plan_.domain.vertices.size());
  }

  std::optional<Error> refine_in_stages(Refiner<OwnsAll, AreaBound>& refiner) {
    Equaliser<OwnsAll, AreaBound> equaliser(refinement_, plan_.quality, area_.again());
    equaliser.begin(OwnsAll{}, plan_.box, first_free(), 0);
    return weft::refine_in_stages(refiner, equaliser, root_);
  }

  std::optional<Error> smooth_alone() {
    Smoother<OwnsAll, AreaBound> smoother(refinement_, plan_.quality, area_.again());
    smoother.begin(OwnsAll{}, plan_.box, first_free(), 0);
    return smoother.run(root_, plan_.sweeps);
  }

  std::optional<Error> send_alone() {
    root_.number_vertices(mesh_, 0);
    typename SlotFragments<AreaBound>::Sections sections;
    sections.add_vertices(root_);
    sections.add_triangles(root_);
    fragments_.send(sections);
    context_.add_fraction(1);
    return fragments_.run().error();
  }

  const MeshPlan& plan_;
  const AreaBound& area_;
  ExecutionContext& context_;
  Summary& summary_;
  MeshStore& mesh_;
  const bool truncated_;
  const RefinementContext refinement_;
  Slots root_;
  SlotFragments<AreaBound> fragments_;
  LeafStage<AreaBound> leaves_;
  RefinerStats alone_;
  WorkTime refine_time_;
};

}  // namespace

template <class AreaBound>
std::optional<Error> run_mesh(const MeshPlan& plan, const AreaBound& area, ChunkSink& sink,
                              ExecutionContext& context, Summary& summary) {
  const auto attempt = [&](bool truncated) -> std::optional<Error> {
    const auto start = Clock::now();
    std::optional<MeshStore> mesh;
    std::optional<MeshRun<AreaBound>> run;
    const auto prepare = [&]() -> std::optional<Error> {
      const std::uint64_t at_first = plan.domain.bytes() + plan.other_bytes +
                                     plan.domain.triangles.size() * sizeof(Triangle) +
                                     plan.domain.vertices.size() * sizeof(Point);
      if (auto error = context.need_bytes(at_first, "the mesh")) return error;
      auto mesh_made = MeshStore::from(plan.domain, context.budget().triangle_limit,
                                       plan.expected_triangles, context);
      if (!mesh_made) return mesh_made.error();
      mesh.emplace(std::move(*mesh_made));
      run.emplace(plan, area, sink, context, summary, *mesh, truncated);
      return run->prepare(start);
    };
    if (auto error = context.compute(prepare)) return error;
    return run->run(start);
  };
  const double cap = static_cast<double>(plan.max_triangles.value_or(0));
  if (plan.max_triangles && plan.triangles_lower_bound > cap) return attempt(true);
  const Summary before = summary;
  auto error = attempt(false);
  const bool reached = error && error->code == ErrorCode::kLimitExceeded && plan.max_triangles &&
                       *plan.max_triangles <= context.budget().triangle_limit;
  if (!reached) return error;
  summary = before;
  context.add_triangles(-static_cast<std::int64_t>(context.triangles()));
  return attempt(true);
}

template std::optional<Error> run_mesh(const MeshPlan&, const ConstantArea&, ChunkSink&,
                                       ExecutionContext&, Summary&);
template std::optional<Error> run_mesh(const MeshPlan&, const MappedArea&, ChunkSink&,
                                       ExecutionContext&, Summary&);

}  // namespace weft
