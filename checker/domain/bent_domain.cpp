// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/bent_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "checker/domain/bent_chain.h"
#include "checker/domain/gaps.h"
#include "checker/domain/mesh_points.h"
#include "checker/domain/segment_steps.h"
#include "checker/domain/tolerance.h"
#include "checker/geometry/box_tree.h"

namespace weft::check {
namespace {

// The touches of one segment. REQUIRES: they are sorted by segment.
template <class T>
std::span<const T> of_segment(const std::vector<T>& sorted, std::uint32_t segment) {
  const auto begin = std::partition_point(
      sorted.begin(), sorted.end(), [&](const T& element) { return element.segment < segment; });
  const auto end = std::partition_point(
      begin, sorted.end(), [&](const T& element) { return element.segment == segment; });
  return {begin, end};
}

class Bender {
 public:
  Bender(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
         const ListedEdges& listed, const std::vector<Jumps>& jumps)
      : domain_(domain),
        near_(near),
        mesh_(mesh),
        jumps_(jumps),
        images_(images_of_points(domain, near, mesh)),
        steps_(steps_along_segments(domain, mesh, listed, near.bend)),
        is_stop_(mesh.vertices.size(), 0),
        touches_(near.touches),
        first_piece_(domain.segments.size() + 1, 0) {
    result_.domain.holes = domain.holes;
    result_.domain.regions = domain.regions;
    result_.domain.areas = domain.areas;
    result_.domain.fill = domain.fill;
    result_.domain.points = domain.points;
    result_.domain.snap = domain.snap;
    result_.link_slack = sliver_slack();
    result_.rounding = near.rounding;
    for (std::size_t i = 0; i < images_.size(); ++i)
      if (images_[i]) result_.domain.points[i] = mesh.vertices[*images_[i]];
    std::stable_sort(touches_.begin(), touches_.end(),
                     [](const auto& t, const auto& u) { return t.segment < u.segment; });
    find_stops(listed);
    find_steps_of_others();
  }

  BentDomain bend() {
    for (std::uint32_t s = 0; s < domain_.segments.size(); ++s)
      bend_segment(s, of_segment(steps_, s));
    note_beside();
    link_points();
    link_touches();
    for (const std::array<Vec2, 2>& link : links_across_gaps(result_.domain))
      result_.links.push_back(link);
    result_.given = result_.origin;
    return std::move(result_);
  }

 private:
  // Marks where a chain may have a corner: at input points, and where listed edges meet or end.
  void find_stops(const ListedEdges& listed) {
    std::vector<std::uint32_t> degree(mesh_.vertices.size(), 0);
    for (std::size_t i = 0; i < mesh_.edges.size(); ++i) {
      if (!listed.half_edge[i]) continue;
      ++degree[mesh_.edges[i].a];
      ++degree[mesh_.edges[i].b];
    }
    for (std::size_t v = 0; v < degree.size(); ++v) is_stop_[v] = degree[v] != 2;
    for (const std::optional<std::uint32_t> v : images_)
      if (v) is_stop_[*v] = 1;
  }

  void find_steps_of_others() {
    const auto distance = [&](const Step& step) {
      const Track track = track_of(domain_, step.segment);
      return std::max(track.distance(mesh_.vertices[step.from]),
                      track.distance(mesh_.vertices[step.to]));
    };
    std::vector<double> least(mesh_.edges.size(), std::numeric_limits<double>::infinity());
    for (const Step& step : steps_) least[step.edge] = std::min(least[step.edge], distance(step));
    for (Step& step : steps_)
      step.is_of_another = least[step.edge] <= near_.rounding &&
                           distance(step) > least[step.edge] + near_.rounding / 8;
  }

  void bend_segment(std::uint32_t s, std::span<const Step> steps) {
    first_piece_[s + 1] = first_piece_[s];
    auto [from, to] = domain_.segments[s];
    if (lexicographically_less(domain_.points[to], domain_.points[from])) std::swap(from, to);
    const bool is_bent = near_.is_bent(s);
    const Track track = track_of(domain_, s);
    const std::vector<ChainStop> chain =
        bent_chain(mesh_, track, steps, near_.bend[s], {images_[from], result_.domain.points[from]},
                   {images_[to], result_.domain.points[to]}, jumps_[s]);
    std::uint32_t last = from;
    for (std::size_t k = 1; k < chain.size(); ++k) {
      const ChainStop& stop = chain[k];
      const bool is_end = k + 1 == chain.size();
      if (!is_end && !is_stop_[*stop.vertex] && !stop.jumped && !chain[k + 1].jumped) continue;
      const std::uint32_t next = is_end ? to : junction(*stop.vertex);
      if (stop.jumped && is_bent) {
        add_gap(s, track, last, next);
      } else {
        add_piece(s, last, next, false, false);
      }
      last = next;
    }
  }

  // Input points that seem to be missing from the mesh are replaced by the points that they must be
  // merged with, which may be in the mesh because of other segments.
  void add_gap(std::uint32_t s, const Track& track, std::uint32_t from, std::uint32_t to) {
    const Vec2 p = result_.domain.points[from], q = result_.domain.points[to];
    std::vector<std::pair<double, std::uint32_t>> between;
    for (const Contacts::Touch& touch : of_segment(touches_, s)) {
      const double position = track.position(result_.domain.points[touch.point]);
      if (position > track.position(p) && position < track.position(q))
        between.emplace_back(position, touch.point);
    }
    std::sort(between.begin(), between.end());
    // Two chains that the search could not join are apart by no more than this.
    const bool is_tear = std::hypot(q.x - p.x, q.y - p.y) <= 2 * near_.bend[s];
    for (const auto& [position, point] : between) {
      add_piece(s, from, point, true, is_tear);
      from = point;
    }
    add_piece(s, from, to, true, is_tear);
  }

  // The points of the bent domain.
  void add_piece(std::uint32_t s, std::uint32_t from, std::uint32_t to, bool is_gap, bool is_tear) {
    if (result_.domain.points[from] == result_.domain.points[to]) return;
    result_.is_gap.push_back(is_gap);
    result_.is_tear.push_back(is_tear);
    result_.domain.segments.push_back({from, to});
    result_.domain.markers.push_back(marker(s));
    if (!domain_.segment_areas.empty())
      result_.domain.segment_areas.push_back(domain_.segment_areas[s]);
    result_.origin.push_back(s);
    result_.slack.push_back(near_.is_bent(s) ? sliver_slack() : 0);
    ++first_piece_[s + 1];
  }

  // The number of a mesh vertex as a point of the bent domain.
  std::uint32_t junction(std::uint32_t vertex) {
    if (junctions_.empty()) junctions_.assign(mesh_.vertices.size(), kNone);
    if (junctions_[vertex] == kNone) {
      junctions_[vertex] = static_cast<std::uint32_t>(result_.domain.points.size());
      result_.domain.points.push_back(mesh_.vertices[vertex]);
    }
    return junctions_[vertex];
  }

  double sliver_slack() const { return kSliver * near_.merging_distance; }

  std::int32_t marker(std::uint32_t s) const {
    return domain_.markers.empty() ? 0 : domain_.markers[s];
  }

  void note_beside() {
    std::vector<char> is_beside(mesh_.edges.size(), 0);
    for (const Step& step : steps_)
      if (near_.is_bent(step.segment)) is_beside[step.edge] = 1;
    for (const Step& step : steps_)
      if (is_beside[step.edge])
        result_.beside.push_back({step.edge, step.segment, marker(step.segment)});
  }

  void link_points() {
    for (const auto [i, j] : near_.points) {
      const Vec2 p = result_.domain.points[i], q = result_.domain.points[j];
      if (!(p == q)) result_.links.push_back({p, q});
    }
  }

  void link_touches() {
    for (std::size_t first = 0, end = 0; first < touches_.size(); first = end) {
      const std::uint32_t s = touches_[first].segment;
      while (end < touches_.size() && touches_[end].segment == s) ++end;
      const std::uint32_t first_piece = first_piece_[s];
      std::vector<Box> boxes;
      for (std::uint32_t k = first_piece; k < first_piece_[s + 1]; ++k) {
        const auto [p, q] = ends_of_piece(k);
        boxes.push_back(box_of(p, q));
      }
      const BoxTree tree(std::move(boxes));
      for (std::size_t t = first; t < end; ++t) link_touch(touches_[t], tree);
    }
  }

  // `tree`: of the pieces of the segment.
  void link_touch(const Contacts::Touch& touch, const BoxTree& tree) {
    const Vec2 p = result_.domain.points[touch.point];
    const double most = 2 * near_.bend[touch.segment];
    std::pair<double, std::uint32_t> nearest{most, kNone};
    tree.visit(box_of(p, p).grown(most), [&](std::uint32_t k) {
      const std::uint32_t piece = first_piece_[touch.segment] + k;
      const auto [a, b] = ends_of_piece(piece);
      nearest = std::min(nearest, {Track(a, b).distance(p), piece});
    });
    if (nearest.second == kNone) return;
    const auto [a, b] = ends_of_piece(nearest.second);
    if (const auto q = across(p, a, b, nearest.first)) result_.links.push_back({p, *q});
  }

  std::array<Vec2, 2> ends_of_piece(std::uint32_t piece) const {
    const auto [a, b] = result_.domain.segments[piece];
    return {result_.domain.points[a], result_.domain.points[b]};
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;

  const Domain& domain_;
  const NearFeatures& near_;
  const Mesh& mesh_;
  const std::vector<Jumps>& jumps_;                   // per segment
  std::vector<std::optional<std::uint32_t>> images_;  // per point: its mesh vertex
  std::vector<Step> steps_;
  std::vector<char> is_stop_;               // per mesh vertex
  std::vector<Contacts::Touch> touches_;    // by segment
  std::vector<std::uint32_t> junctions_;    // per mesh vertex: its number, or kNone
  std::vector<std::uint32_t> first_piece_;  // per segment
  BentDomain result_;
};

}  // namespace

double BentDomain::slack_of(std::span<const std::uint32_t> covers) const {
  double most = covers.empty() ? link_slack : 0;
  for (const std::uint32_t piece : covers) most = std::max(most, slack[piece]);
  return std::max(most, rounding);
}

BentDomain unbent(const Domain& domain) {
  BentDomain result;
  result.domain = domain;
  result.is_gap.resize(domain.segments.size());
  result.is_tear.resize(domain.segments.size());
  result.slack.resize(domain.segments.size());
  result.rounding = on_segment_tolerance(domain);
  result.links = links_across_gaps(domain);
  result.origin.resize(domain.segments.size());
  std::iota(result.origin.begin(), result.origin.end(), 0u);
  result.given = result.origin;
  return result;
}

BentDomain bend(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                const ListedEdges& listed, const std::vector<Jumps>& jumps) {
  return near.any ? Bender(domain, near, mesh, listed, jumps).bend() : unbent(domain);
}

}  // namespace weft::check
