// SPDX-License-Identifier: Apache-2.0
// Says which lattice holds where: a quadtree of squares, the grains, over the domain.
//
// A grain is
//   kConstant  where the size is one value, by the size map's bounds: the hexagonal lattice of this
//              value through the origin, the same in all grains of the same value;
//   kFit       where a harmonic polynomial fits the logarithm of the size: its conformal lattice
//              (conformal_map.h);
//   kStepped   where most neighbouring samples are equal bit for bit, but not all: at the borders
//   of
//              constant pieces. The size is evaluated for each point placed there (mapped_area.h);
//   kMixed     where nothing fits: circumcentres;
//   kOutside   of the domain.
//
// A square is split until it is constant, or its fit is good. A fit is good if
//   - its deviation from log h is at most kGoodFit, or kGoodFitRows over the number of rows. The
//     lattice is laid out for the finest deviation at the samples, so that no bound is exceeded: 2
//     % costs at most 2 % of the triangles, and a fault at every second grain's border would cost
//     more;
//   - its coefficients sum to at most kFewBends, so that the lattice turns little within a grain;
//   - the size function's bounds in the square are within kMissed of the samples, so these missed
//     nothing.
// In a square of fewer than kSmallRows rows of the lattice, a deviation of kAnyFit is good, because
// smaller squares have more faults. A square without a fit is split down to kFewRows rows; one of
// fewer than kCoarseRows is judged by few samples and a polynomial of low degree, and so are larger
// ones whose fit is hopeless. Values that are not positive and finite have no fit; no lattice point
// depends on a square that has them.
//
//   triangles over the least number, kFewRows     8      4      2      no lattice
//   10 min(r1, r2) + 1, about two points          1.067  1.067  1.066  1.527
//   2 + 10 |r - 30|, a fine ring                  1.252  1.219  1.205  1.530
//   1 km + 0.15 times the distance to a coast     1.512  1.354  1.330  1.540
//   4 km + 0.15 times, its lines simplified       1.412  1.291  1.268  1.537
//   1.2 + sin(3x) sin(3y), 20 rows per period     1.540  1.427  1.394  1.540
// On the coast the engine takes 1.09 times as long with 4 as with 8, and 1.18 times with 2. In the
// short waves, where most squares are looked at in vain, 1.5 times with either.
//
// If log h is harmonic (a constant, a power of the distance from a point, an exponential of x),
// one lattice goes through many grains without a fault, because the grains are aligned: each is
// turned and shifted so that both lattices agree in the middle of the side that it shares with a
// neighbour. Neighbours follow breadth first from the constant grains, and then from the first
// grain of each part that was not reached.
//
// All threads of the run examine squares and their neighbours; the order of the grains
// does not depend on them. A square that is split holds some ten triangles at least, so their
// number is in proportion to the mesh, up to kMaxGrains: 48 on the pipe model, in 0.2 ms; 30,000 on
// a coast of 308,000 triangles that grow from the shore. Thread-safety: immutable once built.
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

class GrainMap {
 public:
  enum class Kind : std::uint8_t { kOutside, kMixed, kStepped, kConstant, kFit };

  struct Grain {
    Kind kind = Kind::kMixed;
    double size = 0;  // kConstant: the value
    Box box;
    ConformalMap map;  // kFit
  };

  static constexpr double kGoodFit = 0.02;
  static constexpr double kGoodFitRows = 0.1;
  static constexpr double kAnyFit = 0.2;
  static constexpr double kSmallRows = 16;
  static constexpr double kCoarseRows = 4;
  static constexpr double kFewRows = 2;
  static constexpr double kMissed = 1.3;
  static constexpr double kFewBends = 0.6;
  static constexpr int kMaxDepth = 24;
  static constexpr std::size_t kMaxGrains = std::size_t{1} << 15;

  // One grain that has no lattice.
  GrainMap() : nodes_(1), grains_(1) {}

  // REQUIRES: `map` is that of `size`; the shape exists. Errors: kCancelled, kDeadlineExceeded.
  static Result<GrainMap> build(const SizeFunction& size, const SizeMap& map, const Box& domain,
                                const LatticeShape& shape, const ExecutionContext& context);

  // The grain at p, or the nearest one.
  const Grain& locate(Point p) const { return grains_[index_at(p)]; }

  const std::vector<Grain>& grains() const { return grains_; }

  // Grains of kFit and kMixed: at their borders rows of triangles may be irregular.
  std::size_t lattices_that_vary() const;

  std::size_t bytes() const {
    return grains_.capacity() * sizeof(Grain) + nodes_.capacity() * sizeof(Node);
  }

 private:
  struct Node {
    std::uint32_t first_child = 0;  // of four; 0 for a leaf
    std::uint32_t grain = 0;
  };
  // A neighbour, and the middle of the common side.
  struct Contact {
    std::uint32_t grain;
    Point at;
  };

  std::uint32_t index_at(Point p) const;
  // Joins four squares without a lattice into one, which is found sooner. Some grains stay unused.
  void join_mixed();
  std::vector<Contact> contacts_of(std::uint32_t grain) const;
  std::optional<Error> align(const LatticeShape& shape, const ExecutionContext& context);
  // Turns and shifts the lattice of `to` so that it agrees with that of `from` at a point.
  static void continue_lattice(const Grain& from, Grain& to, Point at, double fill);

  Point centre_{};
  double half_ = 0;  // half the side of the whole square
  std::vector<Node> nodes_;
  std::vector<Grain> grains_;
};

}  // namespace weft
