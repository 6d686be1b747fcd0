// SPDX-License-Identifier: Apache-2.0
// Says which lattice holds where: a quadtree of squares over the domain, the lattice cells. Sizes
// are bounds on areas, h is the edge of an equilateral triangle of such an area.
//
//   kind        where                                     its points are those of
//   kConstant   the size is one value, by the size map's  the hexagonal lattice of this value,
//               bounds                                    through the origin in all such cells
//   kFit        a harmonic polynomial fits log h          its conformal lattice (conformal_map.h)
//   kStepped    most neighbouring samples are equal bit   the lattice of the value at each point
//               for bit, but not all: borders of          (refine/mapped_area.h)
//               constant pieces
//   kMixed      nothing fits                              none: circumcentres
//   kOutside    outside of the domain                     none
//
// A square is split until it is constant, or its fit is good. A fit is good if
//   - its deviation from log h is at most kGoodFit, or kGoodFitRows over the number of rows. The
//     lattice is laid out for the finest deviation at the samples, so that no bound is exceeded;
//   - its coefficients sum to at most kFewBends, so that the lattice turns little within a cell;
//   - the size function's bounds in the square are within kMissed of the samples, so these missed
//     nothing.
// In a square of fewer than kSmallRows rows of the lattice, a deviation of kAnyFit is good, because
// smaller squares have more faults. A square without a fit is split down to kFewRows rows; one of
// fewer than kCoarseRows is tested by few samples and a polynomial of low degree, and so are larger
// ones whose fit is hopeless. Values that are not positive and finite have no fit; no lattice point
// depends on a square that has them.
//
// If log h is harmonic (a constant, a power of the distance from a point, an exponential of x), one
// lattice goes through many cells without a fault, because the cells are aligned: each is turned
// and shifted so that both lattices agree in the middle of the side that it shares with a
// neighbour. Neighbours follow breadth first from the constant cells, and then from the first cell
// of each component that was not reached.
//
// All threads of the run examine squares and their neighbours; the order of the cells does not
// depend on them. A square that is split holds some ten triangles at least, so the number of cells
// is in proportion to the mesh, up to kMaxCells. bench/README.md says what kFewRows costs.
//
// Errors: those of `build`. Thread-safety: immutable once built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/context.h"
#include "engine/base/geometry.h"
#include "engine/size/lattice/conformal_map.h"
#include "engine/size/lattice/lattice.h"
#include "engine/size/size_function.h"
#include "engine/size/size_map.h"
#include "weft/error.h"

namespace weft {

class LatticeMap {
 public:
  enum class Kind : std::uint8_t { kOutside, kMixed, kStepped, kConstant, kFit };

  struct Cell {
    Kind kind = Kind::kMixed;
    double size = 0;  // kConstant: the value
    Box box;
    ConformalMap map;    // kFit
    bool exact = false;  // kFit: hardly any row of triangles has faults

    // Whether its triangles are as large as they may be.
    bool faultless() const { return kind == Kind::kFit ? exact : kind != Kind::kMixed; }
  };

  static constexpr double kGoodFit = 0.02;
  static constexpr double kGoodFitRows = 0.1;
  static constexpr double kAnyFit = 0.2;
  static constexpr double kSmallRows = 16;
  static constexpr double kCoarseRows = 4;
  static constexpr double kFewRows = 2;
  static constexpr double kExactFit = 0.005;
  static constexpr double kMissed = 1.3;
  static constexpr double kFewBends = 0.6;
  static constexpr int kMaxDepth = 24;
  static constexpr std::size_t kMaxCells = std::size_t{1} << 15;

  // One cell that has no lattice.
  LatticeMap() : nodes_(1), cells_(1) {}

  // REQUIRES: `map` is that of `size`; the shape exists. Errors: kCancelled, kDeadlineExceeded.
  static Result<LatticeMap> build(const SizeFunction& size, const SizeMap& map, const Box& domain,
                                  const LatticeShape& shape, const ExecutionContext& context);

  // The cell at p, or the nearest one.
  const Cell& locate(Point p) const { return cells_[index_at(p)]; }

  // Whether all cells that meet the box are faultless.
  bool is_faultless_in(const Box& box) const;

  const std::vector<Cell>& cells() const { return cells_; }

  // Cells of kFit and kMixed: at their borders rows of triangles may be irregular.
  std::size_t lattices_that_vary() const;

  std::size_t bytes() const {
    return cells_.capacity() * sizeof(Cell) + nodes_.capacity() * sizeof(Node);
  }

 private:
  struct Node {
    std::uint32_t first_child = 0;  // of four; 0 for a leaf
    std::uint32_t cell = 0;
  };
  // A neighbour, and the middle of the common side.
  struct Contact {
    std::uint32_t cell;
    Point at;
  };

  std::uint32_t index_at(Point p) const;
  // Joins four squares without a lattice into one, which is found sooner. Some cells stay unused.
  void join_mixed();
  std::vector<Contact> contacts_of(std::uint32_t cell) const;
  std::optional<Error> align(const LatticeShape& shape, const ExecutionContext& context);
  // Turns and shifts the lattice of `to` so that it agrees with that of `from` at a point.
  static void continue_lattice(const Cell& from, Cell& to, Point at, double area_ratio);

  Point centre_{};
  double half_ = 0;  // half the side of the whole square
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

}  // namespace weft
