// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/simplify.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <new>
#include <numeric>
#include <string>

#include "engine/domain/simplify/decimation.h"
#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/simplify/narrow.h"
#include "engine/domain/simplify/near_lines.h"
#include "engine/domain/simplify/pinches.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/tolerance.h"

namespace weft {
namespace {

constexpr int kRounds = 5;
constexpr std::size_t kMaxCuts = 1024;  // whose places are told
// Of the finest length, for the first time that nodes are taken out: what is left is for the
// narrow places that are closed afterwards.
constexpr double kFirstShare = 0.5;

double area_of(const Domain& domain) {
  double doubled = 0;
  for (const Domain::Triangle& t : domain.triangles) {
    const Point a = domain.vertices[t.vertex[0]];
    const Point b = domain.vertices[t.vertex[1]];
    const Point c = domain.vertices[t.vertex[2]];
    doubled += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  return doubled / 2;
}

// 0 if there is no length, or none above 0.
double finest_at(const Finest& finest, Point p, double bound) {
  const double asked = std::min(bound, finest.edge(p));
  return std::isfinite(asked) && asked > 0 ? finest.share * asked : 0;
}

// Sets the finest lengths of the points that lines name.
void set_finest(const Finest& finest, LineGraph& graph, StopPoller& poller) {
  std::vector<double> edge(graph.points.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> is_named(graph.points.size(), false);
  for (const GraphLine& line : graph.lines) {
    double bound = std::numeric_limits<double>::infinity();
    for (const std::uint32_t region : {line.left, line.right})
      if (region != kNone) bound = std::min(bound, finest.region_edge[region]);
    for (const auto& [marker, length] : finest.marker_edge)
      if (marker == line.marker) bound = std::min(bound, length);
    for (const std::uint32_t v : {line.a, line.b}) {
      edge[v] = std::min(edge[v], bound);
      is_named[v] = true;
    }
  }
  for (std::size_t v = 0; v < edge.size(); ++v) {
    if (!is_named[v]) continue;
    poller.step();
    graph.finest[v] = finest_at(finest, graph.points[v], edge[v]);
  }
}

// How far the graph's lines are from the original ones at most.
double farthest_of(const LineGraph& graph, const NearLines& original, double tolerance,
                   StopPoller& poller) {
  std::vector<std::uint32_t> by_error(graph.lines.size());
  std::iota(by_error.begin(), by_error.end(), 0);
  std::stable_sort(by_error.begin(), by_error.end(), [&](std::uint32_t l, std::uint32_t m) {
    return graph.lines[l].error > graph.lines[m].error;
  });
  double farthest = 0;
  for (const std::uint32_t l : by_error) {
    poller.step();
    const GraphLine& line = graph.lines[l];
    if (line.error <= farthest || line.error < tolerance) break;
    farthest = std::max(farthest,
                        original.farthest(graph.points[line.a], graph.points[line.b], line.error));
  }
  return farthest;
}

std::uint64_t kept_points(const Domain& domain) {
  return static_cast<std::uint64_t>(
      std::count_if(domain.input_point.begin(), domain.input_point.end(),
                    [](std::uint32_t point) { return point != kNone; }));
}

void require_some_left(const LineGraph& graph) {
  if (std::any_of(graph.lines.begin(), graph.lines.end(),
                  [](const GraphLine& line) { return line.bounds_domain(); }))
    return;
  throw Stopped{{ErrorCode::kEmptyDomain, "simplify",
                 "all of the domain is smaller than what simplify keeps, so nothing is left of it; "
                 "ask for less"}};
}

Simplified run(const Domain& domain, const Finest& finest, StopPoller& poller) {
  LineGraph graph = line_graph_of(domain, poller);
  set_finest(finest, graph, poller);
  const double tolerance = kMergeFraction * largest_coordinate(graph.points);
  const NearLines original(graph, poller);
  Simplification changes;
  const auto count = [&](const Dropped& dropped) {
    changes.islands += dropped.islands;
    changes.waters += dropped.waters;
  };
  count(decimate(graph, original, kFirstShare, tolerance, poller));
  require_some_left(graph);
  for (int round = 0; round < kRounds; ++round) {
    LineGraph narrowed = graph;
    const Narrowed result = close_narrow_places(
        narrowed, original,
        [&](Point p) {
          const double asked = finest.edge(p);
          return asked > 0 ? finest.share * asked : 0;
        },
        poller);
    if (result.changed > 0) {
      graph = std::move(narrowed);
      changes.channels += result.cuts.size();
      for (const Point cut : result.cuts)
        if (changes.cuts.size() < kMaxCuts) changes.cuts.push_back(cut);
      changes.cut_off += result.cut_off;
      count(result.dropped);
    }
    changes.straits = result.straits;
    require_some_left(graph);
    count(decimate(graph, original, 1, tolerance, poller));
    require_some_left(graph);
    if (result.changed == 0) break;
  }
  open_pinches(graph, original, poller);
  changes.farthest = farthest_of(graph, original, tolerance, poller);
  Simplified made{domain_of_lines(graph, domain, poller), changes};
  made.changes.area = area_of(made.domain) - area_of(domain);
  made.changes.points = kept_points(domain) - kept_points(made.domain);
  return made;
}

}  // namespace

Result<Simplified> simplify(const Domain& domain, const Finest& finest,
                            const ExecutionContext& context) {
  try {
    StopPoller poller(context);
    return run(domain, finest, poller);
  } catch (Stopped& stopped) {
    return tl::unexpected(std::move(stopped.error));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, "",
                "the machine has no memory left to simplify the domain");
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInternal, "", std::string("simplifying the domain: ") + e.what());
  }
}

}  // namespace weft
