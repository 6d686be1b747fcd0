// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/arc_gaps.h"

#include <algorithm>
#include <array>
#include <utility>

#include "checker/domain/flattened.h"
#include "checker/geometry/box_tree.h"
#include "checker/geometry/hull.h"

namespace weft::check {
namespace {

constexpr double kMaxTurn = 5;       // degrees
constexpr std::size_t kRounds = 12;  // each of which halves a turn

// Adds a piece, cut into equal ones.
void add_pieces(const ArcPiece& piece, std::uint32_t count, std::vector<Vec2>& points,
                std::vector<ArcPiece>& pieces) {
  ArcPiece next = piece;
  for (std::uint32_t k = 1; k <= count; ++k) {
    next.to = piece.to;
    next.to_angle = piece.to_angle;
    if (k < count) {
      next.to_angle = piece.from_angle + (piece.to_angle - piece.from_angle) * k / count;
      next.to = static_cast<std::uint32_t>(points.size());
      points.push_back(piece.curve->at(next.to_angle));
    }
    pieces.push_back(next);
    next.from = next.to;
    next.from_angle = next.to_angle;
  }
}

std::vector<Vec2> single_points(const Domain& domain) {
  std::vector<Vec2> points = domain.points;
  points.insert(points.end(), domain.holes.begin(), domain.holes.end());
  for (const RegionSeed& seed : domain.regions) points.push_back(seed.at);
  return points;
}

using Ends = std::array<Vec2, 2>;

// What a gap must not reach: the chord, and, if it is the mesh's, the sides of its hull.
void add_lines(const ArcPiece& piece, const std::vector<Vec2>& points, std::vector<Ends>& lines) {
  constexpr double kMaxWithHull = 1.1;  // radians; longer edges are wrong
  const Vec2 p = points[piece.from], q = points[piece.to];
  const double turn = piece.to_angle - piece.from_angle;
  lines.push_back({p, q});
  if (piece.is_gap || turn > kMaxWithHull) return;
  const Vec2 corner = piece.curve->side(p, q, CircularArc::height(p, q, turn));
  lines.insert(lines.end(), {{p, corner}, {corner, q}});
}

// Segments and points that may come between a chord and its arc.
class Obstacles {
 public:
  explicit Obstacles(std::vector<Ends> lines) : lines_(std::move(lines)), tree_(boxes(lines_)) {}

  bool meet_any(const Hull& hull) const {
    bool any = false;
    tree_.visit(box_of(hull), [&](std::uint32_t i) {
      const auto& [a, b] = lines_[i];
      any = any || (a == b ? holds(hull, a) : meet(hull, a, b));
    });
    return any;
  }

 private:
  static std::vector<Box> boxes(const std::vector<Ends>& lines) {
    std::vector<Box> boxes;
    boxes.reserve(lines.size());
    for (const auto& [a, b] : lines) boxes.push_back(box_of(a, b));
    return boxes;
  }

  std::vector<Ends> lines_;
  BoxTree tree_;
};

}  // namespace

void cut_gaps(const Domain& domain, double least, std::vector<Vec2>& points,
              std::vector<ArcPiece>& pieces) {
  if (std::none_of(pieces.begin(), pieces.end(), [](const ArcPiece& p) { return p.is_gap; }))
    return;
  std::vector<Ends> fixed;
  for (const Vec2 p : single_points(domain)) fixed.push_back({p, p});
  const std::vector<double> bulges = bulges_of(domain);
  for (std::size_t s = 0; s < bulges.size(); ++s)
    if (bulges[s] == 0)
      fixed.push_back({points[domain.segments[s][0]], points[domain.segments[s][1]]});

  std::vector<ArcPiece> before;
  std::swap(before, pieces);
  for (const ArcPiece& piece : before)
    add_pieces(piece, piece.is_gap ? pieces_of(piece.to_angle - piece.from_angle, kMaxTurn) : 1,
               points, pieces);
  for (std::size_t round = 0; round < kRounds; ++round) {
    std::vector<Ends> lines = fixed;
    for (const ArcPiece& piece : pieces) add_lines(piece, points, lines);
    const Obstacles obstacles(std::move(lines));
    before.clear();
    std::swap(before, pieces);
    for (const ArcPiece& piece : before) {
      const Vec2 p = points[piece.from], q = points[piece.to];
      const double height = CircularArc::height(p, q, piece.to_angle - piece.from_angle);
      const bool cut = piece.is_gap && height > least &&
                       obstacles.meet_any({p, q, piece.curve->side(p, q, height)});
      add_pieces(piece, cut ? 2 : 1, points, pieces);
    }
    if (pieces.size() == before.size()) break;
  }
}

}  // namespace weft::check
