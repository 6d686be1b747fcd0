// SPDX-License-Identifier: Apache-2.0
#include "engine/size/lattice/lattice_map.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/size/lattice/harmonic_fit.h"

namespace weft {
namespace {

using Cell = LatticeMap::Cell;
using Kind = LatticeMap::Kind;

// A square that is to be looked at.
struct Pending {
  std::uint32_t node = 0;
  Point centre{};
  double half = 0;
};

// The result of looking at a square: its cell, and whether smaller ones would be better.
struct Look {
  Cell cell;
  bool split = false;
};

// Whether a quarter of a grid's samples have the same bits as those to the right and above.
template <class Fitter>
bool mostly_equal(const double* size) {
  constexpr std::size_t kGrid = Fitter::kGrid;
  std::size_t equal = 0;
  for (std::size_t j = 0; j + 1 < kGrid; ++j) {
    for (std::size_t i = 0; i + 1 < kGrid; ++i) {
      const double* const s = size + j * kGrid + i;
      equal += s[0] == s[1] && s[0] == s[kGrid] ? 1 : 0;
    }
  }
  return 4 * equal >= (kGrid - 1) * (kGrid - 1);
}

// Looks at squares, on any thread.
class Surveyor {
 public:
  Surveyor(const SizeFunction& size, const SizeMap& map, const LatticeShape& shape)
      : size_(size), map_(map), scale_(std::sqrt(shape.area_ratio)) {}

  Look look_at(const Pending& square) const {
    const Point centre = square.centre;
    const double half = square.half;
    Look look;
    Cell& cell = look.cell;
    cell.box = {centre.x - half, centre.y - half, centre.x + half, centre.y + half};
    const SizeMap::Place place = map_.locate(cell.box);
    if (place.node->leaf() && !place.node->meets_domain) {
      cell.kind = Kind::kOutside;
      return look;
    }
    if (const auto uniform = map_.uniform_size(place, cell.box)) {
      cell.kind = Kind::kConstant;
      cell.size = *uniform;
      return look;
    }
    Sampled<CoarseFitter> few;
    sample(few, coarse_, square);
    if (few.any()) {
      const double rows = rows_of(few, square);
      if (rows < LatticeMap::kCoarseRows) {
        fit(look, few, coarse_, square);
        return look;
      }
      if (hopeless(few, rows)) {
        look.split = true;
        return look;
      }
    }
    Sampled<FineFitter> many;
    sample(many, fine_, square);
    if (!many.any()) {
      look.split = !place.node->leaf();
    } else {
      fit(look, many, fine_, square);
    }
    return look;
  }

 private:
  // Roots, squares and quotients of such sizes are normal numbers.
  static constexpr double kMinSize = 1e-150;
  static constexpr double kMaxSize = 1e150;
  static constexpr double kMaxRatio = 20;  // of the samples: no polynomial of degree 5 follows
  static constexpr double kMaxRows = 1e9;
  static constexpr double kRootTwo = 1.4142135623730951;

  // A square's samples of the size: all of them, and the wanted edges where they are sizes.
  template <class Fitter>
  struct alignas(64) Sampled {
    static_assert(Fitter::kSamples % SizeFunction::kLanes == 0);
    double x[Fitter::kSamples];
    double y[Fitter::kSamples];
    double size[Fitter::kSamples];
    typename Fitter::Samples edges;
    double lo = kMaxSize;
    double hi = kMinSize;
    bool all = true;  // are sizes
    bool any() const { return lo <= hi; }
  };

  template <class Fitter>
  void sample(Sampled<Fitter>& at, const Fitter& fitter, const Pending& square) const {
    for (std::size_t s = 0; s < Fitter::kSamples; ++s) {
      const Point p = fitter.sample(s, square.centre, square.half);
      at.x[s] = p.x;
      at.y[s] = p.y;
    }
    size_.evaluate(Fitter::kSamples, at.x, at.y, at.size);
    for (std::size_t s = 0; s < Fitter::kSamples; ++s) {
      const double size = at.size[s];
      if (!(size > kMinSize && size < kMaxSize)) {
        at.all = false;
        continue;
      }
      at.lo = std::min(at.lo, size);
      at.hi = std::max(at.hi, size);
      at.edges[s] = std::sqrt(size / kEquilateral);
    }
  }

  // The rows of the largest triangles that the square has room for.
  template <class Fitter>
  static double rows_of(const Sampled<Fitter>& at, const Pending& square) {
    return 2 * square.half / std::sqrt(at.hi / kEquilateral);
  }

  // Whether a few samples show that no polynomial will be accepted: the fit of a lower degree is
  // off by kHopeless times as much as may be.
  bool hopeless(const Sampled<CoarseFitter>& few, double rows) const {
    constexpr double kHopeless = 2;
    const double most = rows < LatticeMap::kSmallRows ? LatticeMap::kAnyFit : LatticeMap::kGoodFit;
    return few.all && coarse_.fit(few.edges).deviation() > kHopeless * most;
  }

  // Decides on a square by its samples, some of which are sizes.
  template <class Fitter>
  void fit(Look& look, const Sampled<Fitter>& at, const Fitter& fitter,
           const Pending& square) const {
    Cell& cell = look.cell;
    const double rows = rows_of(at, square);
    const bool small = rows < LatticeMap::kSmallRows;
    look.split = rows >= LatticeMap::kFewRows;
    if (mostly_equal<Fitter>(at.size)) {
      cell.kind = Kind::kStepped;
      return;
    }
    // The indices of the lattice are exact far beyond kMaxRows, and no mesh has so many rows.
    if (!at.all || at.hi > kMaxRatio * at.lo || !(rows < kMaxRows)) return;
    if (!small && missed(size_.bounds(cell.box), at.lo, at.hi)) return;

    HarmonicFit fit = fitter.fit(at.edges);
    const double bend = fit.bend();
    const double most_bend = small ? ConformalMap::kMaxBend : LatticeMap::kFewBends;
    const double most = small ? LatticeMap::kAnyFit
                              : std::max(LatticeMap::kGoodFit, LatticeMap::kGoodFitRows / rows);
    if (!(bend < most_bend && fit.deviation() <= most)) return;
    look.split = false;
    fit.u[0].re -= fit.above;
    cell.kind = Kind::kFit;
    cell.exact = !small || fit.deviation() < LatticeMap::kExactFit;
    cell.map = ConformalMap(square.centre, square.half * kRootTwo, fit.u, scale_);
  }

  static bool missed(const Interval& bounds, double lo, double hi) {
    return bounds.may_be_nan || !(bounds.hi <= LatticeMap::kMissed * hi) ||
           !(bounds.lo * LatticeMap::kMissed >= lo);
  }

  const SizeFunction& size_;
  const SizeMap& map_;
  const double scale_;  // of the lattice's edges, by its area ratio
  const FineFitter fine_;
  const CoarseFitter coarse_;
};

}  // namespace

Result<LatticeMap> LatticeMap::build(const SizeFunction& size, const SizeMap& map,
                                     const Box& domain, const LatticeShape& shape,
                                     const ExecutionContext& context) {
  constexpr std::size_t kAtATime = 16;  // squares: about 100 us
  const Surveyor surveyor(size, map, shape);
  LatticeMap lattices;
  lattices.cells_.clear();
  lattices.centre_ = {0.5 * domain.min_x + 0.5 * domain.max_x,
                      0.5 * domain.min_y + 0.5 * domain.max_y};
  lattices.half_ = 0.5 * std::max(domain.width(), domain.height()) * (1 + 1e-9);
  std::vector<Pending> level{{0, lattices.centre_, lattices.half_}};
  std::vector<Look> looks;
  for (int depth = 0; !level.empty(); ++depth) {
    looks.resize(level.size());
    context.for_each((level.size() + kAtATime - 1) / kAtATime, [&](std::size_t group) {
      if (context.poll()) return;
      const std::size_t end = std::min((group + 1) * kAtATime, level.size());
      for (std::size_t i = group * kAtATime; i < end; ++i) looks[i] = surveyor.look_at(level[i]);
    });
    if (auto error = context.poll()) return tl::unexpected(*error);
    std::vector<Pending> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Pending& square = level[i];
      // Each square whose turn is still to come gives one cell at least.
      const std::size_t known = lattices.cells_.size() + (level.size() - i) + next.size();
      if (!looks[i].split || depth == kMaxDepth || known + 3 > kMaxCells) {
        lattices.nodes_[square.node].cell = static_cast<std::uint32_t>(lattices.cells_.size());
        lattices.cells_.push_back(looks[i].cell);
        continue;
      }
      const auto child = static_cast<std::uint32_t>(lattices.nodes_.size());
      lattices.nodes_[square.node].first_child = child;
      lattices.nodes_.resize(child + 4);
      const double half = 0.5 * square.half;
      for (unsigned c = 0; c < 4; ++c) {
        next.push_back(
            {child + c,
             {square.centre.x + (c & 1 ? half : -half), square.centre.y + (c & 2 ? half : -half)},
             half});
      }
    }
    level = std::move(next);
  }
  lattices.join_mixed();
  if (auto error = lattices.align(shape, context)) return tl::unexpected(*error);
  return lattices;
}

void LatticeMap::join_mixed() {
  // Children come after their parents.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.first_child == 0) continue;
    const auto mixed = [&](unsigned c) {
      const Node& child = nodes_[node.first_child + c];
      return child.first_child == 0 && cells_[child.cell].kind == Kind::kMixed;
    };
    if (!(mixed(0) && mixed(1) && mixed(2) && mixed(3))) continue;
    const Box last = cells_[nodes_[node.first_child + 3].cell].box;
    node.cell = nodes_[node.first_child].cell;
    node.first_child = 0;
    cells_[node.cell].box.merge(last);
  }
}

std::size_t LatticeMap::lattices_that_vary() const {
  return static_cast<std::size_t>(std::count_if(cells_.begin(), cells_.end(), [](const Cell& g) {
    return g.kind == Kind::kFit || g.kind == Kind::kMixed;
  }));
}

std::uint32_t LatticeMap::index_at(Point p) const {
  Point centre = centre_;
  double half = half_;
  const Node* node = nodes_.data();
  while (node->first_child != 0) {
    half *= 0.5;
    const bool right = p.x >= centre.x;
    const bool up = p.y >= centre.y;
    node = &nodes_[node->first_child + (right ? 1 : 0) + (up ? 2 : 0)];
    centre.x += right ? half : -half;
    centre.y += up ? half : -half;
  }
  return node->cell;
}

bool LatticeMap::is_faultless_in(const Box& box) const {
  struct Square {
    std::uint32_t node;
    Point centre;
    double half;
  };
  std::vector<Square> left{{0, centre_, half_}};
  while (!left.empty()) {
    const Square square = left.back();
    left.pop_back();
    const Node& node = nodes_[square.node];
    if (node.first_child == 0) {
      if (!cells_[node.cell].faultless()) return false;
      continue;
    }
    const double half = 0.5 * square.half;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const bool right = (i & 1) != 0, up = (i & 2) != 0;
      if ((right ? box.max_x >= square.centre.x : box.min_x < square.centre.x) &&
          (up ? box.max_y >= square.centre.y : box.min_y < square.centre.y))
        left.push_back(
            {node.first_child + i,
             {square.centre.x + (right ? half : -half), square.centre.y + (up ? half : -half)},
             half});
    }
  }
  return true;
}

std::vector<LatticeMap::Contact> LatticeMap::contacts_of(std::uint32_t cell) const {
  std::vector<Contact> contacts;
  const Box& box = cells_[cell].box;
  const double beyond = 1e-6 * box.width();
  for (const bool across_x : {true, false}) {
    const double first = across_x ? box.min_y : box.min_x;
    const double last = across_x ? box.max_y : box.max_x;
    for (const double out : {across_x ? box.max_x + beyond : box.max_y + beyond,
                             across_x ? box.min_x - beyond : box.min_y - beyond}) {
      const auto place = [&](double along) {
        return across_x ? Point{out, along} : Point{along, out};
      };
      for (double along = first + beyond; along < last;) {
        const std::uint32_t other = index_at(place(along));
        const Box& next = cells_[other].box;
        const double from = across_x ? next.min_y : next.min_x;
        const double to = across_x ? next.max_y : next.max_x;
        if (other != cell && cells_[other].kind == Kind::kFit)
          contacts.push_back({other, place(0.5 * (std::max(first, from) + std::min(last, to)))});
        if (!(to >= along)) break;          // the side ends outside, or only rounding is left
        if (!(to + beyond > along)) break;  // far from the origin, `beyond` may round to nothing
        along = to + beyond;
      }
    }
  }
  return contacts;
}

std::optional<Error> LatticeMap::align(const LatticeShape& shape, const ExecutionContext& context) {
  constexpr std::size_t kAtATime = 64;  // cells: about 20 us
  const auto has_lattice = [](const Cell& g) {
    return g.kind == Kind::kConstant || g.kind == Kind::kFit;
  };
  std::vector<std::vector<Contact>> contacts(cells_.size());
  context.for_each((cells_.size() + kAtATime - 1) / kAtATime, [&](std::size_t group) {
    const std::size_t end = std::min((group + 1) * kAtATime, cells_.size());
    for (std::size_t g = group * kAtATime; g < end; ++g) {
      if (has_lattice(cells_[g])) contacts[g] = contacts_of(static_cast<std::uint32_t>(g));
    }
  });
  if (auto error = context.poll()) return error;

  std::vector<char> aligned(cells_.size());
  std::vector<std::uint32_t> queue;
  for (std::uint32_t g = 0; g < cells_.size(); ++g) {
    if (cells_[g].kind == Kind::kConstant) queue.push_back(g);
  }
  std::size_t head = 0;
  for (std::uint32_t first = 0; first <= cells_.size(); ++first) {
    while (head < queue.size()) {
      const std::uint32_t from = queue[head++];
      for (const Contact& contact : contacts[from]) {
        if (aligned[contact.cell]) continue;
        continue_lattice(cells_[from], cells_[contact.cell], contact.at, shape.area_ratio);
        aligned[contact.cell] = true;
        queue.push_back(contact.cell);
      }
    }
    if (first == cells_.size()) break;
    if (cells_[first].kind == Kind::kFit && !aligned[first]) {
      aligned[first] = true;
      queue.push_back(first);
    }
  }
  return std::nullopt;
}

void LatticeMap::continue_lattice(const Cell& from, Cell& to, Point at, double area_ratio) {
  ConformalMap::Value there;
  if (from.kind == Kind::kConstant) {
    const double per_unit = 1 / std::sqrt(area_ratio * from.size / kEquilateral);
    there = {{at.x * per_unit, at.y * per_unit}, {per_unit, 0}};
  } else {
    there = from.map.at(at);
  }
  const ConformalMap::Value own = to.map.at(at);
  Complex turn = there.slope * inverse(own.slope);
  turn = (1 / modulus(turn)) * turn;
  to.map.move(turn, there.w - turn * own.w);
}

}  // namespace weft
