// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/narrow_places.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/refine/storage/mesh_store.h"

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance(Point p, Point q) {
  return std::sqrt((p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y));
}
double doubled_area(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
Point between(Point a, Point b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
}
double distance_to_segment(Point p, Point a, Point b) {
  const double x = b.x - a.x;
  const double y = b.y - a.y;
  const double along = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
  return distance(p, between(a, b, std::clamp(along, 0.0, 1.0)));
}

// How large triangles are beside a narrow place. Edges are as long as the gap's width h at the
// place, and h + K y at the distance y from it; a triangle has c times the square of an edge. K and
// c are fitted to measurements, in triangles per square of h x h:
//
//   minimum angle                5     10    15    20    25    30    33    36
//   in the strip, from          0.14  0.29  0.40  0.58  0.77  0.88  1.0   1.0
//                 to            0.22  0.44  0.77  0.88  1.2   1.6   1.8   9.2
//   2.05 tan                    0.18  0.36  0.55  0.75  0.96  1.2   1.3   1.5
//   strip and both sides, from  0.33  0.70  1.1   1.7   2.3   3.5   4.3   5.2
//                         to    0.52  1.1   2.1   2.7   3.7   6.2   7.8   28
//   + 2.45 tan / (1 - tan/.97)  0.41  0.89  1.5   2.2   3.2   4.7   6.1   8.6
struct Grading {
  double k;
  double c;
  double per_square;  // in the strip and at both sides

  static Grading of(double sin2) {
    const double tangent = std::sqrt(sin2 / (1 - sin2));
    const double in_strip = 2.05 * tangent;
    const double at_side = 1.225 * tangent / (1 - tangent / 0.97);
    // The sum over the distance y, of the strip up to the middle: 1 / (c (1 + K/2)) = in_strip; to
    // infinity: 1 / (c K) = at_side.
    Grading grading{};
    const double ck = 1 / at_side;
    grading.c = 1 / in_strip - 0.5 * ck;
    grading.k = ck / grading.c;
    grading.per_square = in_strip + 2 * at_side;
    return grading;
  }

  // Triangles per unit of length on one side of a segment, beyond those of `area` that the size
  // makes anyway. The nearest thing on this side is at the distance w.
  double beside(double h, double w, double area) const {
    const double natural = std::sqrt(area / c);  // edge
    const double far = std::min(0.5 * w, (natural - h) / k);
    if (!(far > 0)) return 0;
    const double graded = (1 / h - 1 / (h + k * far)) / (c * k);
    return std::max(0.0, graded - far / (c * natural * natural));
  }
};

// A clean one.
struct Strip {
  double width;
  double lower_bound;  // of the triangles
};

double width_of_most(std::vector<Strip>& strips, double lower_bound) {
  constexpr double kMax = 0.9;
  std::sort(strips.begin(), strips.end(),
            [](const Strip& a, const Strip& b) { return a.width < b.width; });
  double width = 0;
  double sum = 0;
  for (const Strip& strip : strips) {
    if (sum >= kMax * lower_bound) break;
    sum += strip.lower_bound;
    width = strip.width;
  }
  return width;
}

}  // namespace

// One thread's look at some of the domain's triangles.
class NarrowPlaces::Search {
 public:
  Search(const Domain& domain, const CrossedArms& crossed_arms, const QualityBounds& quality,
         const std::function<double(Point)>& expected_area)
      : domain_(domain),
        crossed_arms_(crossed_arms),
        expected_area_(expected_area),
        area_over_bound_(area_over_bound(quality)),
        grading_(Grading::of(quality.sin2)),
        floor_(std::sqrt(quality.min_length2)) {}

  // Looks at the triangles from `first` to before `last`. Most are not thin, nor are their
  // neighbours.
  void look_at(std::uint32_t first, std::uint32_t last,
               const std::vector<std::uint8_t>& maybe_thin) {
    const auto nobody = static_cast<std::uint32_t>(domain_.triangles.size());
    for (std::uint32_t t = first; t < last; ++t) {
      const auto& across = domain_.triangles[t].neighbor;
      if ((maybe_thin[t] | maybe_thin[std::min(across[0], nobody)] |
           maybe_thin[std::min(across[1], nobody)] | maybe_thin[std::min(across[2], nobody)]) != 0)
        look_at(t);
    }
  }

  // False for most triangles that are not thin over an edge on a segment, and never for one that
  // is. Without a division, and without a branch: which edges are on a segment is hard to foresee.
  static bool maybe_thin(const Domain& domain, std::uint32_t t) {
    constexpr double kMaybe = 7;  // below kThin, for rounding
    const Domain::Triangle& triangle = domain.triangles[t];
    const Point a = domain.vertices[triangle.vertex[0]];
    const Point b = domain.vertices[triangle.vertex[1]];
    const Point c = domain.vertices[triangle.vertex[2]];
    // At each corner, the dot product of the two edges that meet there.
    const double at_a = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
    const double at_b = (c.x - b.x) * (a.x - b.x) + (c.y - b.y) * (a.y - b.y);
    const double at_c = (a.x - c.x) * (b.x - c.x) + (a.y - c.y) * (b.y - c.y);
    const double area = kMaybe * doubled_area(a, b, c);
    const bool over_a = area < std::max(at_b, at_c), on_a = triangle.subsegment[0] != kNone;
    const bool over_b = area < std::max(at_c, at_a), on_b = triangle.subsegment[1] != kNone;
    const bool over_c = area < std::max(at_a, at_b), on_c = triangle.subsegment[2] != kNone;
    return (over_a & on_a) | (over_b & on_b) | (over_c & on_c);
  }

  NarrowPlaces found;
  std::vector<Strip> strips;

 private:
  void look_at(std::uint32_t t) {
    const Domain::Triangle& triangle = domain_.triangles[t];
    for (unsigned i = 0; i < 3; ++i) {
      if (triangle.subsegment[i] == kNone) continue;
      const std::uint32_t across = triangle.neighbor[i];
      if (across != kNone && across < t) continue;  // seen from there
      const Side here{t, i};
      Side there{across, 0};
      if (across != kNone) {
        while (domain_.triangles[across].neighbor[there.edge] != t ||
               domain_.triangles[across].subsegment[there.edge] != triangle.subsegment[i])
          ++there.edge;
      }
      if (thin(here) || (across != kNone && thin(there)))
        measure(here, there, triangle.subsegment[i]);
    }
  }

  struct Side {
    std::uint32_t triangle;  // kNone outside
    unsigned edge;
  };
  // What is nearest on one side.
  struct Nearest {
    double distance = kInfinity;
    std::uint32_t subsegment = kNone;  // kNone for a vertex
  };

  // A triangle at whose base an angle is below 7 degrees.
  static constexpr double kThin = 8;
  static constexpr int kMaxVisits = 96;    // triangles, for one look from one point
  static constexpr int kMaxPieces = 2048;  // of a segment

  Point corner(const Side& side, unsigned i) const {
    return domain_.vertices[domain_.triangles[side.triangle].vertex[(side.edge + i) % 3]];
  }

  // Where the apex over an edge stands, as a fraction of its length.
  double foot(const Side& side) const {
    const Point apex = corner(side, 0);
    const Point a = corner(side, 1);
    const Point b = corner(side, 2);
    const double x = b.x - a.x;
    const double y = b.y - a.y;
    return ((apex.x - a.x) * x + (apex.y - a.y) * y) / (x * x + y * y);
  }
  bool thin(const Side& side) const {
    const Point a = corner(side, 1);
    const Point b = corner(side, 2);
    const double x = b.x - a.x;
    const double y = b.y - a.y;
    const double at = foot(side);
    const double height = doubled_area(a, b, corner(side, 0)) / (x * x + y * y);  // of the length
    return kThin * height < std::max(at, 1 - at);
  }

  // What is nearest to the point q of an edge, seen through the triangles of one side.
  Nearest nearest(const Side& side, Point q) {
    Nearest best;
    if (side.triangle == kNone) return best;
    const Domain::Triangle& base = domain_.triangles[side.triangle];
    const std::uint32_t a = base.vertex[kNext[side.edge]];
    const std::uint32_t b = base.vertex[kPrevious[side.edge]];
    stack_.assign(1, side);
    for (int visits = 0; !stack_.empty() && visits < kMaxVisits; ++visits) {
      const Side in = stack_.back();
      stack_.pop_back();
      const Domain::Triangle& t = domain_.triangles[in.triangle];
      const std::uint32_t apex = t.vertex[in.edge];
      if (apex != a && apex != b) {
        const double d = distance(q, domain_.vertices[apex]);
        if (d < best.distance) best = {d, kNone};
      }
      for (const unsigned edge : {kNext[in.edge], kPrevious[in.edge]}) {
        const std::uint32_t u = t.vertex[kNext[edge]];
        const std::uint32_t v = t.vertex[kPrevious[edge]];
        const Point from = domain_.vertices[u];
        const Point to = domain_.vertices[v];
        if (doubled_area(from, to, q) <= 0) continue;  // not outwards
        const double d = distance_to_segment(q, from, to);
        if (d >= best.distance) continue;
        if (t.subsegment[edge] == kNone) {
          Side next{t.neighbor[edge], 0};
          while (domain_.triangles[next.triangle].neighbor[next.edge] != in.triangle) ++next.edge;
          stack_.push_back(next);
        } else if (u != a && u != b && v != a && v != b &&
                   !crossed_arms_.share_corner(base.subsegment[side.edge], t.subsegment[edge])) {
          best = {d, t.subsegment[edge]};
        }
      }
    }
    return best;
  }

  void measure(const Side& here, const Side& there, std::uint32_t subsegment) {
    const Point a = corner(here, 1);
    const Point b = corner(here, 2);
    const double length = distance(a, b);
    Costliest costliest{domain_.subsegments[subsegment].segment, kNone, a, kInfinity, 0};
    double most = 0;
    std::vector<std::pair<double, double>>& open = open_;
    open.assign(1, {0, 1});
    // A vertex close by is nearest at its foot.
    const auto split_at = [&](double at) {
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (!(open[i].first < at && at < open[i].second)) continue;
        open.push_back({at, open[i].second});
        open[i].second = at;
        return;
      }
    };
    split_at(foot(here));
    if (there.triangle != kNone) split_at(1 - foot(there));
    for (int looks = 0; !open.empty() && looks < kMaxPieces; ++looks) {
      const auto [from, to] = open.back();
      open.pop_back();
      constexpr unsigned kPoints = 3;
      std::array<double, kPoints> h{};
      std::array<Nearest, kPoints> sees{};
      double expected = 0;
      double quality_alone = 0;
      for (unsigned i = 0; i < kPoints; ++i) {
        const Point q = between(a, b, from + (to - from) * ((2 * i + 1) * (1.0 / (2 * kPoints))));
        const Nearest one = nearest(here, q);
        const Nearest two = nearest(there, q);
        sees[i] = one.distance <= two.distance ? one : two;
        h[i] = std::max(sees[i].distance, floor_);
        const double area = expected_area_(q);
        for (const auto& [side, near] : {std::pair{here, one}, std::pair{there, two}}) {
          if (side.triangle == kNone) continue;
          const double bound =
              std::min(area, domain_.regions[domain_.triangles[side.triangle].region].max_area);
          const double w = std::max(near.distance, h[i]);
          expected += grading_.beside(h[i], w, area_over_bound_ * bound) / kPoints;
          quality_alone += grading_.beside(h[i], w, kInfinity) / kPoints;
        }
      }
      const double piece = (to - from) * length;
      const auto [low, high] = std::minmax_element(h.begin(), h.end());
      if (piece > 2 * *low && *high > kAlike * *low) {
        open.push_back({0.5 * (from + to), to});
        open.push_back({from, 0.5 * (from + to)});
        continue;
      }
      if (piece < *low) continue;
      found.pieces_.push_back({between(a, b, from), between(a, b, to), expected * piece});
      found.expected_ += expected * piece;
      // A clean strip has segments all along, and no edge that the floor on edges exempts.
      const bool clean = piece > 4 * *high && *low > 4 * floor_ && *high < kInfinity &&
                         std::all_of(sees.begin(), sees.end(),
                                     [](const Nearest& n) { return n.subsegment != kNone; });
      if (!clean) continue;
      const double lower_bound = kCertain * quality_alone * piece;
      found.lower_bound_ += lower_bound;
      strips.push_back({*high, lower_bound});
      costliest.lower_bound += lower_bound;
      if (lower_bound <= most) continue;
      most = lower_bound;
      costliest.other = domain_.subsegments[sees[1].subsegment].segment;
      costliest.at = between(a, b, 0.5 * (from + to));
      costliest.width = sees[1].distance;
    }
    if (costliest.lower_bound > (found.costliest_ ? found.costliest_->lower_bound : 0))
      found.costliest_ = costliest;
  }

  static constexpr double kAlike = 1.5;
  static constexpr double kCertain = 0.35;

  const Domain& domain_;
  const CrossedArms& crossed_arms_;
  const std::function<double(Point)>& expected_area_;
  const double area_over_bound_;
  const Grading grading_;
  const double floor_;
  std::vector<Side> stack_;
  std::vector<std::pair<double, double>> open_;
};

Result<NarrowPlaces> NarrowPlaces::find(const Domain& domain, const CrossedArms& crossed_arms,
                                        const QualityBounds& quality,
                                        const std::function<double(Point)>& expected_area,
                                        const ExecutionContext& context) {
  constexpr std::size_t kAtATime = 1024;  // triangles
  NarrowPlaces all;
  if (!(quality.sin2 > 0)) return all;
  const std::size_t n = domain.triangles.size();
  std::vector<NarrowPlaces> found((n + kAtATime - 1) / kAtATime);
  std::vector<std::vector<Strip>> strips(found.size());
  const auto range = [&](std::size_t i) {
    return std::pair{static_cast<std::uint32_t>(i * kAtATime),
                     static_cast<std::uint32_t>(std::min(n, (i + 1) * kAtATime))};
  };
  std::vector<std::uint8_t> maybe_thin(n + 1);  // the last one stands for no neighbour
  context.for_each(found.size(), [&](std::size_t i) {
    const auto [first, last] = range(i);
    for (std::uint32_t t = first; t < last; ++t) maybe_thin[t] = Search::maybe_thin(domain, t);
  });
  std::atomic<bool> stopped = false;
  context.for_each(found.size(), [&](std::size_t i) {
    if (stopped) return;
    if (context.poll()) {
      stopped = true;
      return;
    }
    Search search(domain, crossed_arms, quality, expected_area);
    const auto [first, last] = range(i);
    search.look_at(first, last, maybe_thin);
    found[i] = std::move(search.found);
    strips[i] = std::move(search.strips);
  });
  if (stopped) {
    if (auto error = context.poll()) return tl::unexpected(*error);
  }
  for (const NarrowPlaces& some : found) {
    all.pieces_.insert(all.pieces_.end(), some.pieces_.begin(), some.pieces_.end());
    all.expected_ += some.expected_;
    all.lower_bound_ += some.lower_bound_;
    if (some.costliest_ &&
        some.costliest_->lower_bound > (all.costliest_ ? all.costliest_->lower_bound : 0))
      all.costliest_ = some.costliest_;
  }
  std::vector<Strip> every;
  for (const auto& some : strips) every.insert(every.end(), some.begin(), some.end());
  all.widest_ = width_of_most(every, all.lower_bound_);
  return all;
}

double NarrowPlaces::elsewhere(const QualityBounds& quality) {
  if (!(quality.sin2 > 0)) return 1;
  return std::max(1.0, 0.6 * Grading::of(quality.sin2).per_square);
}

void NarrowPlaces::add_samples(double triangles_per_sample,
                               std::vector<Quadtree::Sample>& samples) const {
  constexpr double kMaxSamples = 1 << 17;
  const double most = std::max(triangles_per_sample, expected_ / kMaxSamples);
  for (const Piece& piece : pieces_) {
    const auto parts = static_cast<std::uint32_t>(std::ceil(piece.triangles / most));
    for (std::uint32_t i = 0; i < parts; ++i)
      samples.push_back(
          {between(piece.from, piece.to, (i + 0.5) / parts), piece.triangles / parts});
  }
}

}  // namespace weft
