// SPDX-License-Identifier: Apache-2.0
// Makes parts of the mesh from slots, and sends them to the sink.
//
//   SlotParts<ConstantArea> parts(plan, area, refinement, cut_off, sink, summary);
//   parts.send_vertices(root);
//   parts.run().run(..., [&](std::uint32_t task) {
//     parts.run().finish(index, parts.build([&](auto& builder) { ... }));
//   });
//   SlotParts<ConstantArea>::Sections sections;
//   sections.add_triangles(root);
//   parts.send(sections);
//   parts.close();
//
// Thread-safety: tasks may call `build`, and the functions of `run()` that say so; the rest may be
// called only between runs.
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
#include "engine/emit/emit.h"
#include "engine/emit/part_run.h"
#include "engine/parallel/mesh_plan.h"
#include "engine/parallel/task_graph.h"
#include "engine/refine/refinement_context.h"
#include "engine/refine/storage/slots.h"
#include "weft/mesh.h"

namespace weft {

template <class AreaBound>
class SlotParts {
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
    friend class SlotParts;
    struct Section {
      std::uint32_t first;
      std::uint32_t last;
      bool vertices;  // not triangles
    };
    std::vector<Section> all_;
  };

  // `cut_off`: whether refinement ended before all triangles were good.
  SlotParts(const MeshPlan& plan, const AreaBound& area, const RefinementContext& refinement,
            bool cut_off, ChunkSink& sink, Summary& summary)
      : plan_(plan),
        area_(area),
        refinement_(refinement),
        cut_off_(cut_off),
        delivery_(sink, refinement.context, summary),
        run_(delivery_, refinement.context) {}

  PartRun& run() { return run_; }
  const PartRun& run() const { return run_; }

  // The sum over all tasks.
  double build_seconds() const { return time_.seconds(); }

  // Builds a part of what `fill` puts into a PartBuilder; nullopt if the context stops the run.
  template <class F>
  std::optional<Part> build(F&& fill) {
    return time_.measure([&] {
      PartBuilder<AreaBound> builder(refinement_.mesh, plan_.domain, refinement_.corners,
                                     area_.again(), plan_.quality.lattice.exists(), cut_off_,
                                     refinement_.context);
      fill(builder);
      return builder.finish();
    });
  }

  // Sends an owner's vertices at once, before any part of a run.
  void send_vertices(const Slots& slots) {
    auto part = refinement_.context.compute([&] {
      return build([&](PartBuilder<AreaBound>& builder) {
        slots.for_vertices(
            [&](std::uint32_t first, std::uint32_t last) { builder.add_vertices(first, last); });
      });
    });
    const auto error = part ? delivery_.send(std::move(*part)) : refinement_.context.poll();
    if (error) run_.stop(*error);
  }

  // Builds the parts of the given sections in parallel, and sends them. REQUIRES: these are final.
  void send(const Sections& sections) {
    constexpr std::size_t kPerPart = 48;  // about 10,000 vertices or triangles
    const auto& all = sections.all_;
    const auto parts = static_cast<std::uint32_t>((all.size() + kPerPart - 1) / kPerPart);
    run_.run(
        kClosingGraph, TaskGraph(parts), 0, parts, [](std::uint32_t part) { return part; },
        [&](std::uint32_t part) {
          run_.finish(part, build([&](PartBuilder<AreaBound>& builder) {
                        const std::size_t end = std::min((part + 1) * kPerPart, all.size());
                        std::size_t vertices = 0;
                        std::size_t triangles = 0;
                        for (std::size_t s = part * kPerPart; s < end; ++s)
                          (all[s].vertices ? vertices : triangles) += all[s].last - all[s].first;
                        builder.expect(vertices, triangles);
                        for (std::size_t s = part * kPerPart; s < end; ++s) {
                          if (all[s].vertices) {
                            builder.add_vertices(all[s].first, all[s].last);
                          } else {
                            builder.add_triangles(all[s].first, all[s].last);
                          }
                        }
                      }));
        });
  }

  // Call after the last part.
  void close() { delivery_.finish(); }

 private:
  static constexpr Trace::GraphName kClosingGraph{"closing parts", {"closing part"}};

  const MeshPlan& plan_;
  const AreaBound& area_;
  const RefinementContext& refinement_;
  const bool cut_off_;
  Delivery delivery_;
  PartRun run_;
  WorkTime time_;
};

}  // namespace weft
