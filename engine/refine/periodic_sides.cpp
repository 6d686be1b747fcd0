// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/periodic_sides.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/base/text.h"

namespace weft {
namespace {

std::string field_of(std::size_t pair) {
  return "quality.periodic[" + std::to_string(pair) + "]";
}
std::string text_of(Point p) {
  return "(" + text(p.x) + ", " + text(p.y) + ")";
}

Error bad_pair(std::size_t pair, const std::string& message, std::optional<Point> at = {}) {
  const std::string field = field_of(pair);
  return {ErrorCode::kBadOption, field, field + ": " + message, at};
}

// A side of the domain, its inside at the left of its edges.
struct DomainSide {
  std::vector<SegmentEdge> edges;
  Vector along{0, 0};  // the sum of the edges
  double length = 0;

  // The ends of its lines: where they begin, or where they end.
  std::vector<std::uint32_t> begins() const { return less(&SegmentEdge::a, &SegmentEdge::b); }
  std::vector<std::uint32_t> ends() const { return less(&SegmentEdge::b, &SegmentEdge::a); }

 private:
  using End = std::uint32_t SegmentEdge::*;
  std::vector<std::uint32_t> less(End these, End others) const {
    std::vector<std::uint32_t> result = all(these);
    const std::vector<std::uint32_t> taken = all(others);
    std::erase_if(
        result, [&](std::uint32_t v) { return std::binary_search(taken.begin(), taken.end(), v); });
    return result;
  }
  std::vector<std::uint32_t> all(End end) const {
    std::vector<std::uint32_t> result;
    for (const SegmentEdge& edge : edges) result.push_back(edge.*end);
    std::sort(result.begin(), result.end());
    return result;
  }
};

class PairReader {
 public:
  PairReader(const Domain& domain, std::size_t pair) : domain_(domain), pair_(pair) {}

  Result<DomainSide> side(std::int32_t marker) const {
    DomainSide side;
    const std::string named = "segments with marker " + std::to_string(marker);
    bool any = false;
    for (std::uint32_t index = 0; index < domain_.triangles.size(); ++index) {
      const Domain::Triangle& t = domain_.triangles[index];
      for (std::uint32_t i = 0; i < 3; ++i) {
        if (t.subsegment[i] == kNone || domain_.subsegments[t.subsegment[i]].marker != marker)
          continue;
        any = true;
        const std::uint32_t a = t.vertex[kNext[i]], b = t.vertex[kPrevious[i]];
        const Point p = domain_.vertices[a], q = domain_.vertices[b];
        if (!domain_.curvatures.empty() && domain_.curvatures[t.subsegment[i]] != 0)
          return tl::unexpected(bad_pair(pair_, named + " are arcs, and sides are straight", p));
        if (t.neighbor[i] != kNone) continue;
        side.edges.push_back({index, i, a, b});
        side.along = {side.along.x + (q.x - p.x), side.along.y + (q.y - p.y)};
        side.length += weft::length(q - p);
      }
    }
    if (side.edges.empty())
      return tl::unexpected(bad_pair(
          pair_, any ? named + " are not on the boundary of the domain"
                     : "no segment in the domain has the marker " + std::to_string(marker)));
    return side;
  }

  // What takes the beginnings of `from` to the ends of `to`.
  Result<Motion> motion(const PeriodicPair& pair, const DomainSide& from, const DomainSide& to,
                        double tolerance) const {
    const double size = length(from.along);
    const double other = length(to.along);
    const std::string named =
        "the sides with markers " + std::to_string(pair.from) + " and " + std::to_string(pair.to);
    if (std::fabs(from.length - to.length) > 4 * tolerance ||
        std::fabs(size - other) > 4 * tolerance)
      return tl::unexpected(bad_pair(pair_, named + " are " + text(from.length) + " and " +
                                                text(to.length) +
                                                " long; only sides that are alike repeat"));
    const auto begins = from.begins(), ends = to.ends();
    if (begins.empty() || begins.size() != ends.size() || size <= 4 * tolerance)
      return tl::unexpected(bad_pair(pair_, named + " are " + std::to_string(begins.size()) +
                                                " and " + std::to_string(ends.size()) +
                                                " lines; each line must have an image"));
    // Opposite directions: a translation.
    const bool translates =
        length({from.along.x + to.along.x, from.along.y + to.along.y}) <= 16 * tolerance;
    const double scale = -1 / (size * other);
    const double cosine = translates ? 1 : scale * dot(from.along, to.along);
    const double sine = translates ? 0 : scale * cross(from.along, to.along);
    // In the direction of the sides, beginnings and ends have one order.
    const auto foremost = [&](const std::vector<std::uint32_t>& vertices, Vector direction) {
      return domain_.vertices[*std::min_element(
          vertices.begin(), vertices.end(), [&](std::uint32_t u, std::uint32_t v) {
            const Vector between = domain_.vertices[u] - domain_.vertices[v];
            return dot(between, direction) < 0;
          })];
    };
    const Point p = foremost(begins, from.along);
    const Point q = foremost(ends, {-to.along.x, -to.along.y});
    return translates ? Motion::translation(p, q) : Motion::rotation(p, q, cosine, sine);
  }

 private:
  const Domain& domain_;
  const std::size_t pair_;
};

}  // namespace

// Both sides are walked from one vertex that has an image to the next: what lies between, of
// either, is missing in the other.
class PeriodicSides::Matching {
 public:
  // The sides' vertices are indices into `vertices`.
  Matching(const Point* vertices, const Pair& pair, std::uint32_t index, double tolerance,
           std::array<Side, 2> sides)
      : vertices_(vertices),
        motions_{pair.motion, pair.motion.inverse()},
        pair_(index),
        tolerance_(tolerance),
        sides_(std::move(sides)) {
    for (Side& side : sides_)
      std::sort(side.begin(), side.end(),
                [](const Edge& e, const Edge& f) { return e.first < f.first; });
    find_images();
  }

  // Calls f(edge, end, image of the edge, image of the end) for edges with images at one end.
  template <class F>
  void for_twins(F&& f) const {
    const auto by_last = [](Side side) {
      std::sort(side.begin(), side.end(),
                [](const Edge& e, const Edge& g) { return e.last < g.last; });
      return side;
    };
    const auto match = [&](const Side& here, const Side& there, std::uint32_t Edge::*end) {
      for (const Edge& edge : here) {
        const std::uint32_t image = image_of(edge.*end);
        if (image == kNone) continue;
        const auto twin =
            std::lower_bound(there.begin(), there.end(), image,
                             [end](const Edge& e, std::uint32_t v) { return e.*end < v; });
        if (twin != there.end() && (*twin).*end == image)
          f(edge.edge, edge.*end, twin->edge, image);
      }
    };
    match(sides_[0], sides_[1], &Edge::first);
    match(sides_[0], by_last(sides_[1]), &Edge::last);
  }

  // Adds the splits that are missing; unless `all` are wanted, at most one of each edge.
  std::optional<Error> run(bool all, Missing& missing) const {
    std::size_t walked = 0, walked_there = 0;
    for (const Edge& start : sides_[0]) {
      const std::uint32_t image = image_of(start.first);
      if (image == kNone) continue;
      const auto here = line_from(0, start.first);
      const auto there = line_from(1, image);
      walked += here.size();
      walked_there += there.size();
      const std::uint32_t end = image_of(here.back()->last);
      if (end == kNone) return no_image(0, here.back()->last);
      if (there.empty()) return no_image(0, start.first);
      if (there.back()->last != end) return no_image(1, there.back()->last);
      add_splits(1, there, here, all, missing);
      add_splits(0, here, there, all, missing);
    }
    if (walked == sides_[0].size() && walked_there == sides_[1].size()) return std::nullopt;
    return lonely();
  }

 private:
  using Line = std::vector<const Edge*>;
  struct Vertex {
    double place;  // along a line that no side is likely to be square to
    std::uint32_t vertex;
  };

  Point at(std::uint32_t vertex) const { return vertices_[vertex]; }
  static double place_of(Point p) { return 0.8414709848078965 * p.x + 0.5403023058681398 * p.y; }

  // The vertices of a side, each once, by number.
  static std::vector<std::uint32_t> vertices_of(const Side& side) {
    std::vector<std::uint32_t> result;
    for (const Edge& edge : side) {
      result.push_back(edge.first);
      result.push_back(edge.last);
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  void find_images() {
    std::vector<Vertex> there;
    for (const std::uint32_t v : vertices_of(sides_[1])) there.push_back({place_of(at(v)), v});
    std::sort(there.begin(), there.end(), [](const Vertex& u, const Vertex& v) {
      return std::pair(u.place, u.vertex) < std::pair(v.place, v.vertex);
    });
    for (const std::uint32_t v : vertices_of(sides_[0])) {
      const Point image = motions_[0](at(v));
      double nearest = tolerance_;
      std::uint32_t found = kNone;
      for (auto candidate =
               std::lower_bound(there.begin(), there.end(), place_of(image) - 2 * tolerance_,
                                [](const Vertex&u, double p) { return u.place < p; });
           candidate != there.end() && candidate->place <= place_of(image) + 2 * tolerance_;
           ++candidate) {
        const double away = length(at(candidate->vertex) - image);
        if (away <= nearest) {
          nearest = away;
          found = candidate->vertex;
        }
      }
      if (found == kNone) continue;
      images_.push_back({v, found});
      have_images_[1].push_back(found);
      have_images_[0].push_back(v);
    }
    for (auto& vertices : have_images_) std::sort(vertices.begin(), vertices.end());
  }

  std::uint32_t image_of(std::uint32_t vertex) const {
    const auto found =
        std::lower_bound(images_.begin(), images_.end(), vertex,
                         [](const auto& image, std::uint32_t v) { return image.first < v; });
    return found != images_.end() && found->first == vertex ? found->second : kNone;
  }
  bool has_image(std::size_t side, std::uint32_t vertex) const {
    return std::binary_search(have_images_[side].begin(), have_images_[side].end(), vertex);
  }

  // The edges from a vertex on, up to the first other vertex that has an image.
  Line line_from(std::size_t side, std::uint32_t vertex) const {
    Line line;
    do {
      const auto next =
          std::lower_bound(sides_[side].begin(), sides_[side].end(), vertex,
                           [](const Edge& e, std::uint32_t v) { return e.first < v; });
      if (next == sides_[side].end() || next->first != vertex) break;
      line.push_back(&*next);
      vertex = next->last;
    } while (!has_image(side, vertex) && line.size() <= sides_[side].size());
    return line;
  }

  // The splits of `line` by the images of the vertices within `other`, or of the middle one alone.
  // Both lines are straight and have the same ends.
  void add_splits(std::size_t side, const Line& line, const Line& other, bool all,
                  Missing& missing) const {
    missing.edges += line.size();
    missing.lacking += other.size() - 1;
    const Point start = at(line.front()->first);
    const std::size_t middle = (other.size() - 1) / 2;
    for (std::size_t i = 0; i + 1 < other.size(); ++i) {
      if (!all && i != middle) continue;
      Point image = motions_[1 - side](at(other[i]->last));
      const auto found = std::find_if(line.begin(), line.end(), [&](const Edge* edge) {
        return length(at(edge->last) - start) > length(image - start);
      });
      if (found == line.end()) continue;
      const SegmentEdge& edge = (*found)->edge;
      // On a side that is parallel to an axis, all vertices are.
      if (at(edge.a).x == at(edge.b).x) image.x = at(edge.a).x;
      if (at(edge.a).y == at(edge.b).y) image.y = at(edge.a).y;
      missing.splits.push_back({edge, image, pair_});
    }
  }

  Error no_image(std::size_t side, std::uint32_t vertex) const {
    const Point p = at(vertex);
    return bad_pair(
        pair_, "the side at " + text_of(p) + " has no image at " + text_of(motions_[side](p)), p);
  }
  // REQUIRES: some edge begins at, or follows, no vertex with an image.
  Error lonely() const {
    for (std::size_t side = 0; side < 2; ++side) {
      for (const Edge& edge : sides_[side]) {
        for (const std::uint32_t end : {edge.first, edge.last})
          if (!has_image(side, end)) return no_image(side, end);
      }
    }
    return no_image(0, sides_[0].front().first);
  }

  const Point* const vertices_;
  const std::array<Motion, 2> motions_;  // to the side `to`, and back
  const std::uint32_t pair_;
  const double tolerance_;
  std::array<Side, 2> sides_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> images_;  // by the vertex of side `from`
  std::array<std::vector<std::uint32_t>, 2> have_images_;        // sorted
};

Result<PeriodicSides> PeriodicSides::of(const std::vector<PeriodicPair>& pairs,
                                        const Domain& domain, double tolerance) {
  PeriodicSides sides;
  sides.tolerance_ = 4 * tolerance;
  std::vector<std::int32_t> seen;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const std::int32_t marker : {pairs[i].from, pairs[i].to}) {
      if (std::find(seen.begin(), seen.end(), marker) != seen.end())
        return tl::unexpected(
            bad_pair(i, "the marker " + std::to_string(marker) + " names two sides"));
      seen.push_back(marker);
    }
    const PairReader reader(domain, i);
    const auto from = reader.side(pairs[i].from);
    if (!from) return tl::unexpected(from.error());
    const auto to = reader.side(pairs[i].to);
    if (!to) return tl::unexpected(to.error());
    const auto motion = reader.motion(pairs[i], *from, *to, tolerance);
    if (!motion) return tl::unexpected(motion.error());
    sides.pairs_.push_back({{pairs[i].from, pairs[i].to}, *motion});
    Side here, there;
    for (const SegmentEdge& edge : from->edges) here.push_back({edge.a, edge.b, edge});
    for (const SegmentEdge& edge : to->edges) there.push_back({edge.b, edge.a, edge});
    const Matching matching(domain.vertices.data(), sides.pairs_.back(),
                            static_cast<std::uint32_t>(i), sides.tolerance_,
                            {std::move(here), std::move(there)});
    matching.for_twins([&](const SegmentEdge& edge, std::uint32_t end, const SegmentEdge& other,
                           std::uint32_t image) {
      sides.twins_.push_back({{domain.triangles[edge.triangle].subsegment[edge.edge],
                               domain.triangles[other.triangle].subsegment[other.edge]},
                              {end, image}});
    });
    Missing missing;
    if (auto error = matching.run(true, missing)) return tl::unexpected(*error);
    for (const Split& split : missing.splits) {
      const Domain::Triangle& t = domain.triangles[split.edge.triangle];
      sides.images_.push_back(
          {domain.subsegments[t.subsegment[split.edge.edge]].segment, split.at});
    }
  }
  return sides;
}

Result<PeriodicSides::Missing> PeriodicSides::missing(const MeshStore& mesh,
                                                      const AcuteCorners& corners,
                                                      std::span<const Slots* const> slots,
                                                      const ExecutionContext& context) const {
  std::vector<std::array<Side, 2>> sides(pairs_.size());
  const auto add = [&](const SegmentEdge& edge) {
    const std::int32_t marker = corners.marker(mesh, edge.a, edge.b);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (marker == pairs_[i].markers[0]) sides[i][0].push_back({edge.a, edge.b, edge});
      if (marker == pairs_[i].markers[1]) sides[i][1].push_back({edge.b, edge.a, edge});
    }
  };
  for (const Slots* const some : slots) {
    some->for_triangles([&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t t = first; t < last; ++t) {
        const Triangle& triangle = mesh.triangles[t];
        if (triangle.dead()) continue;
        for (std::uint32_t i = 0; i < 3; ++i) {
          if (triangle.on_segment(i) && triangle.neighbor[i] == kNone)
            add({t, i, triangle.vertex[kNext[i]], triangle.vertex[kPrevious[i]]});
        }
      }
    });
    if (auto error = context.poll()) return tl::unexpected(*error);
  }
  Missing missing;
  for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
    const Matching matching(mesh.vertices.data(), pairs_[i], i, tolerance_, std::move(sides[i]));
    if (auto error = matching.run(false, missing)) return tl::unexpected(*error);
    if (auto error = context.poll()) return tl::unexpected(*error);
  }
  std::sort(missing.splits.begin(), missing.splits.end(), [](const Split& s, const Split& t) {
    return std::tuple(s.pair, s.at.x, s.at.y) < std::tuple(t.pair, t.at.x, t.at.y);
  });
  return missing;
}

Pslg PeriodicSides::with_images(const Pslg& pslg, std::vector<std::uint32_t>& origin) const {
  Pslg result = pslg;
  std::vector<Image> images = images_;
  const auto away = [&](const Image& image) {
    return length(image.at - pslg.points[pslg.segments[image.segment].a]);
  };
  // The last one of a segment first: what is before it is cut next.
  std::sort(images.begin(), images.end(), [&](const Image& u, const Image& v) {
    return std::tuple(u.segment, -away(u), u.at.x, u.at.y) <
           std::tuple(v.segment, -away(v), v.at.x, v.at.y);
  });
  for (const Image& image : images) {
    const auto point = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(image.at);
    Segment& before = result.segments[image.segment];
    Segment after = before;
    before.b = after.a = point;
    result.segments.push_back(after);
    origin.push_back(image.segment);
  }
  return result;
}

std::vector<std::int32_t> PeriodicSides::markers() const {
  std::vector<std::int32_t> result;
  for (const Pair& pair : pairs_)
    result.insert(result.end(), pair.markers.begin(), pair.markers.end());
  return result;
}

Error PeriodicSides::refused(const Split& split) {
  return bad_pair(split.pair,
                  "a vertex at " + text_of(split.at) +
                      ", the image of one on the other side, would be too near to others",
                  split.at);
}

}  // namespace weft
