// SPDX-License-Identifier: Apache-2.0
// Fragments of whole slots, and the builder that every fragment of a run is built with; sends them
// to the sink.
//
//   SlotFragments<ConstantArea> fragments(plan, area, refinement, truncated, sink, summary);
//   fragments.send_vertices(root);
//   fragments.run().run(..., [&](std::uint32_t task) {
//     fragments.run().finish(index, fragments.build([&](auto& builder) { ... }));
//   });
//   SlotFragments<ConstantArea>::Sections sections;
//   sections.add_triangles(root);
//   fragments.send(sections);
//   fragments.close();
//
// Errors: those of the run (fragment_run.h), in run().error(). Thread-safety: tasks may call
// `build`, and the functions of `run()` that say so; the rest may be called only between runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/trace.h"
#include "engine/base/work_time.h"
#include "engine/emit/delivery.h"
#include "engine/emit/fragment.h"
#include "engine/emit/fragment_run.h"
#include "engine/parallel/mesh_plan.h"
#include "engine/parallel/task_graph.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/storage/slots.h"
#include "weft/mesh.h"

namespace weft {

template <class AreaBound>
class SlotFragments {
 public:
  // Pieces of owners' slots.
  class Sections {
   public:
    void add_vertices(const Slots& slots) {
      slots.for_vertices([&](std::uint32_t first, std::uint32_t last) {
        all_.push_back({first, last, true});
      });
    }
    void add_triangles(const Slots& slots) {
      slots.for_triangles([&](std::uint32_t first, std::uint32_t last) {
        all_.push_back({first, last, false});
      });
    }

   private:
    friend class SlotFragments;
    struct Section {
      std::uint32_t first;
      std::uint32_t last;
      bool vertices;  // not triangles
    };
    std::vector<Section> all_;
  };

  // `truncated`: whether refinement ended before all triangles were good.
  SlotFragments(const MeshPlan& plan, const AreaBound& area, const RefinementContext& refinement,
                bool truncated, ChunkSink& sink, Summary& summary)
      : plan_(plan),
        area_(area),
        refinement_(refinement),
        truncated_(truncated),
        delivery_(sink, refinement.context, summary),
        run_(delivery_, refinement.context) {}

  FragmentRun& run() { return run_; }
  const FragmentRun& run() const { return run_; }

  // The sum over all tasks.
  double build_seconds() const { return time_.seconds(); }

  // Builds a fragment of what `fill` puts into a FragmentBuilder; nullopt if the context stops the
  // run.
  template <class F>
  std::optional<Fragment> build(F&& fill) {
    return time_.measure([&] {
      FragmentBuilder<AreaBound> builder(refinement_.mesh, plan_.domain, refinement_.corners,
                                         area_.again(), plan_.quality.lattice.exists(), truncated_,
                                         refinement_.context);
      fill(builder);
      return builder.finish();
    });
  }

  // Sends an owner's vertices at once, before any fragment of a run.
  void send_vertices(const Slots& slots) {
    auto fragment = refinement_.context.compute([&] {
      return build([&](FragmentBuilder<AreaBound>& builder) {
        slots.for_vertices(
            [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
      });
    });
    const auto error = fragment ? delivery_.send(std::move(*fragment)) : refinement_.context.poll();
    if (error) run_.stop(*error);
  }

  // Builds the fragments of the given sections in parallel, and sends them. REQUIRES: these are
  // final.
  void send(const Sections& sections) {
    constexpr std::size_t kPerFragment = 48;  // about 10,000 vertices or triangles
    const auto& all = sections.all_;
    const auto fragments =
        static_cast<std::uint32_t>((all.size() + kPerFragment - 1) / kPerFragment);
    run_.run(
        kClosingGraph, TaskGraph(fragments), 0, fragments,
        [](std::uint32_t fragment) { return fragment; },
        [&](std::uint32_t fragment) {
          run_.finish(fragment, build([&](FragmentBuilder<AreaBound>& builder) {
                        const std::size_t end = std::min((fragment + 1) * kPerFragment, all.size());
                        std::size_t vertices = 0;
                        std::size_t triangles = 0;
                        for (std::size_t s = fragment * kPerFragment; s < end; ++s)
                          (all[s].vertices ? vertices : triangles) += all[s].last - all[s].first;
                        builder.expect(vertices, triangles);
                        for (std::size_t s = fragment * kPerFragment; s < end; ++s) {
                          if (all[s].vertices) {
                            builder.add_vertices(all[s].first, all[s].last);
                          } else {
                            builder.add_triangles(all[s].first, all[s].last);
                          }
                        }
                      }));
        });
  }

  // Call after the last fragment.
  void close() { delivery_.finish(); }

 private:
  static constexpr Trace::GraphName kClosingGraph{"closing fragments", {"closing fragment"}};

  const MeshPlan& plan_;
  const AreaBound& area_;
  const RefinementContext& refinement_;
  const bool truncated_;
  Delivery delivery_;
  FragmentRun run_;
  WorkTime time_;
};

}  // namespace weft
