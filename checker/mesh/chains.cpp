// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/chains.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "checker/domain/segment_steps.h"
#include "checker/domain/tolerance.h"
#include "checker/text.h"

namespace weft::check {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxCandidates = 16;  // each pair of which may be the ends of a chain

class ChainJudge {
 public:
  ChainJudge(const BentDomain& bent, const Arrangement& arrangement, const Mesh& mesh,
             const ListedEdges& listed, const InputPoints& input_points, Findings& findings)
      : bent_(bent),
        domain_(bent.domain),
        arrangement_(arrangement),
        mesh_(mesh),
        input_points_(input_points),
        findings_(findings),
        tolerance_(on_segment_tolerance(domain_)),
        steps_(steps_along_segments(domain_, mesh, listed,
                                    std::vector<double>(domain_.segments.size(), tolerance_))),
        vertex_at_(vertices_of_arrangement(arrangement, input_points, mesh, listed, tolerance_)),
        expected_marker_(mesh.edges.size()),
        state_(mesh.edges.size(), State::kOnNoSegment) {
    ends_.reserve(2 * steps_.size());
    for (const Step& step : steps_) {
      ends_.push_back({step.segment, step.from_position, step.from});
      ends_.push_back({step.segment, step.to_position, step.to});
    }
    std::sort(ends_.begin(), ends_.end());
    ends_.erase(std::unique(ends_.begin(), ends_.end()), ends_.end());
  }

  void judge_segment(std::uint32_t segment, const std::vector<Need>& needs) {
    const auto along = arrangement_.edges_of(segment);
    const Track track = track_of(domain_, segment);
    const auto need = [&](std::uint32_t e) {
      const Need most =
          std::max(needs[arrangement_.face(2 * e)], needs[arrangement_.face(2 * e + 1)]);
      return bent_.is_tear[segment] || is_short(segment, e, needs)
                 ? std::min(most, Need::kEitherWay)
                 : most;
    };
    for (std::size_t first = 0, end = 0; first < along.size(); first = end) {
      end = first + 1;
      const Need wanted = need(along[first]);
      if (wanted == Need::kNothing) continue;
      while (end < along.size() && need(along[end]) == wanted) ++end;
      is_optional_ = wanted == Need::kEitherWay;
      if (is_optional_) allow(segment, track, along.subspan(first, end - first));
      judge_run(segment, track, along.subspan(first, end - first));
    }
  }

  void judge_listed(const ListedEdges& listed) {
    // If several segments run within the tolerance of an edge, the marker of any of them is right.
    for (const Step& step : steps_) {
      const std::int32_t marker = mesh_.edges[step.edge].marker;
      if (state_[step.edge] == State::kOnSegment && marker != expected_marker_[step.edge] &&
          marker == marker_of(edge_at(step, track_of(domain_, step.segment))))
        expected_marker_[step.edge] = marker;
    }
    for (const auto& [edge, segment, marker] : bent_.beside) {
      if (state_[edge] == State::kOnNoSegment) state_[edge] = State::kUnclear;
      if (state_[edge] == State::kOnSegment && mesh_.edges[edge].marker == marker)
        expected_marker_[edge] = marker;
    }
    for (std::size_t i = 0; i < mesh_.edges.size(); ++i) {
      const Mesh::Edge& edge = mesh_.edges[i];
      const auto name = [&] {
        return say("listed edge ", i, " (", edge.a, ", ", edge.b, ") from ", mesh_.vertices[edge.a],
                   " to ", mesh_.vertices[edge.b]);
      };
      if (state_[i] == State::kOnNoSegment && listed.half_edge[i])
        findings_.add(Rule::kEdges,
                      [&] { return say(name(), " is not part of a segment in the domain"); });
      if (state_[i] == State::kOnSegment && edge.marker != expected_marker_[i])
        findings_.add(Rule::kMarkers, [&] {
          return say(name(), " has the marker ", edge.marker, ", its segment has ",
                     expected_marker_[i]);
        });
    }
  }

  SegmentsOfVertices take_segments() {
    for (auto& [vertex, segment] : segments_) segment = bent_.given[segment];
    for (const BentDomain::Beside& beside : bent_.beside) {
      segments_.emplace_back(mesh_.edges[beside.edge].a, beside.segment);
      segments_.emplace_back(mesh_.edges[beside.edge].b, beside.segment);
    }
    std::sort(segments_.begin(), segments_.end());
    segments_.erase(std::unique(segments_.begin(), segments_.end()), segments_.end());
    return std::move(segments_);
  }

 private:
  // The states, from the least to the most that is known: near a broken chain, an edge may belong
  // to it.
  enum class State : std::uint8_t { kOnNoSegment, kUnclear, kOnSegment };
  // Of a step.
  struct End {
    std::uint32_t segment;
    double position;
    std::uint32_t vertex;
    auto operator<=>(const End&) const = default;
  };

  // Whether merging, or rounding at a small angle, may have made one vertex of the ends of the
  // edge: then there is a sliver beside it.
  bool is_short(std::uint32_t segment, std::uint32_t e, const std::vector<Need>& needs) const {
    if (needs[arrangement_.face(2 * e)] != Need::kEitherWay &&
        needs[arrangement_.face(2 * e + 1)] != Need::kEitherWay)
      return false;
    const Arrangement::Edge& edge = arrangement_.edges()[e];
    const Vec2 p = arrangement_.vertices().at(edge.u), q = arrangement_.vertices().at(edge.v);
    return std::hypot(q.x - p.x, q.y - p.y) <=
           std::max(reach(segment, edge.u), reach(segment, edge.v));
  }

  // How far from w the chain of the segment may meet other chains that pass there.
  double reach(std::uint32_t segment, std::uint32_t w) const {
    return std::max(tolerance_ / std::max(smallest_sine(segment, w), 1e-15), bent_.slack[segment]);
  }

  // Edges of the segment, one after the other, that must be in the mesh. The chain passes through
  // the input points among their ends; its own ends may be crossings. If it crosses other chains in
  // between, it has a vertex in common with them, or the mesh would overlap.
  void judge_run(std::uint32_t segment, const Track& track, std::span<const std::uint32_t> run) {
    std::vector<std::uint32_t> previous;
    for (std::size_t k = 0; k <= run.size(); ++k) {
      const bool is_last = k == run.size();
      const std::uint32_t w =
          is_last ? arrangement_.edges()[run.back()].v : arrangement_.edges()[run[k]].u;
      const bool is_input = input_points_.has(arrangement_.vertices().at(w));
      if (!is_input && k > 0 && !is_last) continue;
      if (!vertex_at_[w] && is_input) continue;  // judge_points reports it
      std::vector<std::uint32_t> stops =
          vertex_at_[w] ? std::vector{*vertex_at_[w]} : meetings_near(segment, track, w);
      if (stops.empty() && !is_optional_) stops = ends_around(segment, track, w);
      if (stops.empty()) {
        miss(segment, w);
        if (!is_optional_) return;
        previous.clear();
        continue;
      }
      if (previous.empty())
        previous = std::move(stops);
      else
        previous = {judge_chain(segment, track, previous, stops)};
    }
  }

  // Segments that cross at a small angle run within the tolerance of each other around the
  // crossing, so their chains may meet anywhere there; so may those that merging has moved. Returns
  // the ends of steps of the segment near w, the nearest first. Those of the other segment may be
  // among them.
  std::vector<std::uint32_t> meetings_near(std::uint32_t segment, const Track& track,
                                           std::uint32_t w) const {
    const double at = track.position(arrangement_.vertices().at(w));
    const double most = reach(segment, w);
    // At angles of rounding's size the whole segment is near.
    std::vector<std::pair<double, std::uint32_t>> near;
    const auto middle = std::lower_bound(ends_.begin(), ends_.end(), End{segment, at, 0});
    auto before = middle, after = middle;
    const auto distance_before = [&] {
      return before != ends_.begin() && std::prev(before)->segment == segment
                 ? at - std::prev(before)->position
                 : kInfinite;
    };
    const auto distance_after = [&] {
      return after != ends_.end() && after->segment == segment ? after->position - at : kInfinite;
    };
    for (;;) {
      const double distance = std::min(distance_before(), distance_after());
      const bool is_enough = near.size() >= kMaxCandidates && distance > near.back().first;
      if (!(distance <= most) || is_enough) break;
      const End& end = distance_before() == distance ? *--before : *after++;
      near.emplace_back(distance, end.vertex);
    }
    std::sort(near.begin(), near.end());
    near.resize(std::min(near.size(), kMaxCandidates));
    std::vector<std::uint32_t> vertices;
    for (const auto& [distance, vertex] : near) vertices.push_back(vertex);
    return vertices;
  }

  // The ends of the steps of the segment that pass w, of which at most a few are found. A run that
  // begins or ends where a link, or what the mesh need not have, meets the segment has no vertex
  // there.
  std::vector<std::uint32_t> ends_around(std::uint32_t segment, const Track& track,
                                         std::uint32_t w) const {
    const double at = track.position(arrangement_.vertices().at(w));
    auto step = std::partition_point(steps_.begin(), steps_.end(), [&](const Step& s) {
      return s.segment < segment || (s.segment == segment && s.from_position <= at);
    });
    std::vector<std::uint32_t> vertices;
    for (std::size_t k = 0; k < kMaxCandidates && step != steps_.begin(); ++k) {
      --step;
      if (step->segment != segment) break;
      if (step->to_position >= at) vertices.insert(vertices.end(), {step->from, step->to});
    }
    return vertices;
  }

  // Of the angles at which others pass the segment at w.
  double smallest_sine(std::uint32_t segment, std::uint32_t w) const {
    const auto [a, b] = domain_.segments[segment];
    const Vec2 p = domain_.points[a], q = domain_.points[b];
    const Vec2 u{q.x - p.x, q.y - p.y};
    double smallest = 1;
    for (const std::uint32_t h : arrangement_.half_edges_at(w)) {
      const auto covers = arrangement_.covers(h / 2);
      if (std::find(covers.begin(), covers.end(), segment) != covers.end()) continue;
      const Arrangement::Edge& edge = arrangement_.edges()[h / 2];
      const Vec2 v{edge.to.x - edge.from.x, edge.to.y - edge.from.y};
      smallest = std::min(smallest, std::fabs(u.x * v.y - u.y * v.x) /
                                        (std::hypot(u.x, u.y) * std::hypot(v.x, v.y)));
    }
    return smallest;
  }

  // If edges need not be in the mesh, any of them may be.
  void allow(std::uint32_t segment, const Track& track, std::span<const std::uint32_t> run) {
    const auto position = [&](std::uint32_t w) {
      return track.position(arrangement_.vertices().at(w));
    };
    const double start = position(arrangement_.edges()[run.front()].u);
    const double goal = position(arrangement_.edges()[run.back()].v);
    for (const Step& step : steps_between(segment, start, goal)) {
      state_[step.edge] = std::max(state_[step.edge], State::kUnclear);
      lay(step);
    }
  }

  void miss(std::uint32_t segment, std::uint32_t w) {
    if (is_optional_) return;
    findings_.add(Rule::kChains, [&] {
      return say("segment ", bent_.given[segment], ": no vertex where it meets others, near ",
                 arrangement_.vertices().at(w));
    });
  }

  // A chain leads from one of the vertices to one of the others. Returns where it ends.
  std::uint32_t judge_chain(std::uint32_t segment, const Track& track,
                            std::span<const std::uint32_t> starts,
                            std::span<const std::uint32_t> goals) {
    const std::uint32_t from = starts.front(), to = goals.front();
    if (from == to) return to;
    const auto position = [&](std::uint32_t v) { return track.position(mesh_.vertices[v]); };
    double first = position(from), last = position(to);
    for (const std::uint32_t start : starts) first = std::min(first, position(start));
    for (const std::uint32_t goal : goals) last = std::max(last, position(goal));
    if (const auto joined = first_joined(steps_between(segment, first, last), starts, goals)) {
      follow(segment, track, (*joined)[0], (*joined)[1]);
      return (*joined)[1];
    }
    if (is_optional_) return to;
    const Followed broken = follow(segment, track, from, to);
    for (const Step& step : broken.steps)
      state_[step.edge] = std::max(state_[step.edge], State::kUnclear);
    findings_.add(Rule::kChains, [&] {
      return say("segment ", bent_.given[segment], ": between vertices ", from, " at ",
                 mesh_.vertices[from], " and ", to, " at ", mesh_.vertices[to],
                 ", the chain of listed edges breaks off at vertex ", broken.farthest, " at ",
                 mesh_.vertices[broken.farthest]);
    });
    return to;
  }

  struct Followed {
    std::uint32_t farthest;       // reached vertex
    std::span<const Step> steps;  // of the segment, between the vertices
  };

  // Uses the steps of a chain from one vertex to the other, if there is one.
  Followed follow(std::uint32_t segment, const Track& track, std::uint32_t from, std::uint32_t to) {
    const double start = track.position(mesh_.vertices[from]);
    const double goal = track.position(mesh_.vertices[to]);
    const std::span<const Step> steps = steps_between(segment, start, goal);
    const Walk found = walk(steps, from, start, to);
    for (const std::size_t k : found.path) use(steps[k], track);
    return {found.farthest, steps};
  }

  std::span<const Step> steps_between(std::uint32_t segment, double start, double goal) const {
    const auto begin = std::lower_bound(
        steps_.begin(), steps_.end(), start - tolerance_, [&](const Step& step, double position) {
          return step.segment < segment ||
                 (step.segment == segment && step.from_position < position);
        });
    auto end = begin;
    while (end != steps_.end() && end->segment == segment &&
           end->from_position <= goal + tolerance_)
      ++end;
    return {begin, end};
  }

  // The marker of the lowest-numbered segment here that has one.
  std::int32_t marker_of(std::uint32_t e) const {
    if (domain_.markers.empty()) return 0;
    for (const std::uint32_t segment : arrangement_.covers(e))
      if (domain_.markers[segment] != 0) return domain_.markers[segment];
    return 0;
  }

  // The edge of the arrangement that a step lies on: the last that starts before its middle.
  std::uint32_t edge_at(const Step& step, const Track& track) const {
    const double middle = (step.from_position + step.to_position) / 2;
    const auto along = arrangement_.edges_of(step.segment);
    const auto after = std::partition_point(along.begin(), along.end(), [&](std::uint32_t e) {
      return track.position(arrangement_.vertices().at(arrangement_.edges()[e].u)) <= middle;
    });
    return after == along.begin() ? along.front() : *(after - 1);
  }

  void use(const Step& step, const Track& track) {
    if (state_[step.edge] != State::kOnSegment)
      expected_marker_[step.edge] = marker_of(edge_at(step, track));
    state_[step.edge] = State::kOnSegment;
    lay(step);
  }

  // The ends of the step are on its segment.
  void lay(const Step& step) {
    segments_.emplace_back(step.from, step.segment);
    segments_.emplace_back(step.to, step.segment);
  }

  const BentDomain& bent_;
  const Domain& domain_;
  const Arrangement& arrangement_;
  const Mesh& mesh_;
  const InputPoints& input_points_;
  Findings& findings_;
  double tolerance_;
  bool is_optional_ = false;  // whether the run at hand may be missing
  std::vector<Step> steps_;
  std::vector<End> ends_;  // of the steps; sorted, distinct
  std::vector<std::optional<std::uint32_t>> vertex_at_;
  std::vector<std::int32_t> expected_marker_;  // per listed edge on a segment
  std::vector<State> state_;                   // per listed edge
  SegmentsOfVertices segments_;
};

}  // namespace

void judge_points(const BentDomain& bent, std::size_t count, const Arrangement& arrangement,
                  const std::vector<Need>& needs, const InputPoints& input_points,
                  Findings& findings) {
  const Domain& domain = bent.domain;
  std::vector<char> is_end(domain.points.size(), 0);
  for (const auto [a, b] : domain.segments) is_end[a] = is_end[b] = 1;
  const auto beside_needed = [&](std::uint32_t half_edge) {
    return needs[arrangement.face(half_edge)] == Need::kAll ||
           needs[arrangement.face(half_edge ^ 1u)] == Need::kAll;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec2 p = domain.points[i];
    if (input_points.vertex_at(p)) continue;
    bool in_domain = false;
    if (is_end[i]) {
      const auto around = arrangement.half_edges_at(arrangement.vertices().of_point(i));
      in_domain = std::any_of(around.begin(), around.end(), beside_needed);
    } else {
      const Arrangement::Place place = arrangement.locate(p);
      in_domain = place.edge ? beside_needed(2 * *place.edge) : needs[place.face] == Need::kAll;
    }
    if (in_domain)
      findings.add(Rule::kPoints, [&] {
        return say("input point ", i, " at ", p, " is in the domain, but no vertex is there");
      });
  }
}

SegmentsOfVertices judge_chains(const BentDomain& bent, const Arrangement& arrangement,
                                const std::vector<Need>& needs, const Mesh& mesh,
                                const ListedEdges& listed, const InputPoints& input_points,
                                Findings& findings) {
  ChainJudge judge(bent, arrangement, mesh, listed, input_points, findings);
  for (std::uint32_t segment = 0; segment < bent.domain.segments.size(); ++segment)
    judge.judge_segment(segment, needs);
  judge.judge_listed(listed);
  return judge.take_segments();
}

}  // namespace weft::check
