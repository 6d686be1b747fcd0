// SPDX-License-Identifier: Apache-2.0
#include "engine/parallel/quadtree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace weft {
namespace {

constexpr double kTarget = 100;
// What a leaf may be smaller than the square, at most.
constexpr double kDeepest = 0x1p-31;

struct Tree {
  Box domain;
  std::vector<Quadtree::Sample> samples;
  Quadtree quadtree;
};

// The leaves with which a leaf's `box` shares a point; `apart(x, y)`: whether a box that ends at x
// shares none with one that begins at y.
template <class Apart>
std::vector<std::uint32_t> others(const Tree& tree, std::uint32_t leaf, Box Quadtree::Leaf::*box,
                                  Apart apart) {
  const auto& leaves = tree.quadtree.leaves();
  const Box& p = leaves[leaf].*box;
  std::vector<std::uint32_t> found;
  for (std::uint32_t other = 0; other < leaves.size(); ++other) {
    const Box& q = leaves[other].*box;
    if (other != leaf && !apart(p.max_x, q.min_x) && !apart(q.max_x, p.min_x) &&
        !apart(p.max_y, q.min_y) && !apart(q.max_y, p.min_y))
      found.push_back(other);
  }
  return found;
}

// Samples that crowd towards one point of the domain, so that leaves differ much in size.
Tree graded(const Box& domain, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const Point focus{domain.min_x + unit() * domain.width(),
                    domain.min_y + unit() * domain.height()};
  Tree tree{domain, {}, {}};
  for (int i = 0; i < 3000; ++i) {
    const double crowding = std::pow(unit(), 2);
    const double x = domain.min_x + unit() * domain.width();
    const double y = domain.min_y + unit() * domain.height();
    tree.samples.push_back(
        {{focus.x + crowding * (x - focus.x), focus.y + crowding * (y - focus.y)}, 1 + 9 * unit()});
  }
  tree.quadtree = Quadtree::build(domain, tree.samples, kTarget);
  return tree;
}

struct Place {
  const char* name;
  Box box;
};
void PrintTo(const Place& place, std::ostream* out) {
  *out << place.name;
}

class Quadtrees : public testing::TestWithParam<Place> {
 protected:
  static constexpr std::uint64_t kSeeds = 4;

  template <class F>
  void for_trees(F&& f) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(seed);
      f(graded(GetParam().box, seed));
    }
  }
};

bool contains(const Box& b, Point p) {
  return p.x >= b.min_x && p.x < b.max_x && p.y >= b.min_y && p.y < b.max_y;
}

double before(double x) {
  return std::nextafter(x, -std::numeric_limits<double>::infinity());
}

TEST_P(Quadtrees, HaveTheDomainInTheirSquare) {
  for_trees([](const Tree& tree) {
    const Box square = tree.quadtree.box();
    EXPECT_LE(square.min_x, tree.domain.min_x);
    EXPECT_LE(square.min_y, tree.domain.min_y);
    EXPECT_GT(square.max_x, tree.domain.max_x);
    EXPECT_GT(square.max_y, tree.domain.max_y);
  });
}

// The largest total weight of leaves that a line across x, or across y, cuts.
double most_cut(const std::vector<Quadtree::Leaf>& leaves, bool along_x) {
  double most = 0;
  for (const Quadtree::Leaf& at : leaves) {
    const double line = along_x ? at.box.min_x : at.box.min_y;
    double cut = 0;
    for (const Quadtree::Leaf& l : leaves) {
      const double first = along_x ? l.box.min_x : l.box.min_y;
      const double last = along_x ? l.box.max_x : l.box.max_y;
      if (first <= line && line < last) cut += l.weight;
    }
    most = std::max(most, cut);
  }
  return most;
}

TEST_P(Quadtrees, HaveTheirLeavesInTheOrderOfASweepThatCutsTheLightestSections) {
  for_trees([](const Tree& tree) {
    const auto& leaves = tree.quadtree.leaves();
    ASSERT_GT(leaves.size(), 20u);
    const auto middle = [](const Quadtree::Leaf& l, bool along_x) {
      return along_x ? std::pair(l.box.min_x + l.box.max_x, l.box.min_y)
                     : std::pair(l.box.min_y + l.box.max_y, l.box.min_x);
    };
    const auto sorted = [&](bool along_x) {
      return std::is_sorted(leaves.begin(), leaves.end(), [&](const auto& a, const auto& b) {
        return middle(a, along_x) < middle(b, along_x);
      });
    };
    const bool along_x = sorted(true);
    ASSERT_TRUE(along_x || sorted(false));
    EXPECT_LE(most_cut(leaves, along_x), most_cut(leaves, !along_x) * (1 + 1e-9));
  });
}

TEST_P(Quadtrees, TellWhereTheirLeavesAreAmongTheSquaresOfTheirDepth) {
  for_trees([](const Tree& tree) {
    const Box square = tree.quadtree.box();
    for (const Quadtree::Leaf& leaf : tree.quadtree.leaves()) {
      ASSERT_EQ(std::lround(std::log2(square.width() / leaf.side())), leaf.depth);
      const auto x = std::lround((leaf.box.min_x - square.min_x) / leaf.side());
      const auto y = std::lround((leaf.box.min_y - square.min_y) / leaf.side());
      const auto along = static_cast<long>(leaf.along);
      const auto across = static_cast<long>(leaf.across);
      ASSERT_EQ(std::minmax(along, across), std::minmax(x, y));
    }
  });
}

// Every point has one leaf: tried where it is hardest, at corners, on borders, and the last
// doubles before them.
TEST_P(Quadtrees, GiveEachPointTheOneLeafWhoseHalfOpenBoxHoldsIt) {
  for_trees([](const Tree& tree) {
    const auto& leaves = tree.quadtree.leaves();
    std::vector<Point> points;
    for (const Quadtree::Leaf& leaf : leaves) {
      const Box& b = leaf.box;
      const double xs[] = {b.min_x, 0.5 * (b.min_x + b.max_x), before(b.max_x), b.max_x};
      const double ys[] = {b.min_y, 0.5 * (b.min_y + b.max_y), before(b.max_y), b.max_y};
      for (const double x : xs) {
        for (const double y : ys) points.push_back({x, y});
      }
    }
    for (const Point p : points) {
      if (!contains(tree.quadtree.box(), p)) continue;
      const auto holds = [&](const Quadtree::Leaf& leaf) { return contains(leaf.box, p); };
      ASSERT_EQ(std::count_if(leaves.begin(), leaves.end(), holds), 1) << p.x << ", " << p.y;
      ASSERT_TRUE(holds(leaves[tree.quadtree.leaf_at(p)])) << p.x << ", " << p.y;
    }
  });
}

TEST_P(Quadtrees, GiveAPointOutsideALeafNearBy) {
  for_trees([](const Tree& tree) {
    const Box square = tree.quadtree.box();
    const double far = square.max_x + 10 * square.width();
    const Quadtree::Leaf& leaf = tree.quadtree.leaves()[tree.quadtree.leaf_at({far, far})];
    EXPECT_EQ(leaf.box.max_x, square.max_x);
    EXPECT_EQ(leaf.box.max_y, square.max_y);
  });
}

TEST_P(Quadtrees, AreBalanced) {
  for_trees([](const Tree& tree) {
    const double slack = 1e-3;  // of a side, for rounding far from the origin
    const auto& leaves = tree.quadtree.leaves();
    for (const auto& a : leaves) {
      for (const auto& b : leaves) {
        if (a.side() <= 2 * (1 + slack) * b.side()) continue;
        const double gap = slack * b.side();
        const bool touch = a.box.min_x <= b.box.max_x + gap && b.box.min_x <= a.box.max_x + gap &&
                           a.box.min_y <= b.box.max_y + gap && b.box.min_y <= a.box.max_y + gap;
        ASSERT_FALSE(touch) << "sides " << a.side() << " and " << b.side();
      }
    }
  });
}

TEST_P(Quadtrees, HaveLeavesThatWeighTheTargetAtMost) {
  for_trees([](const Tree& tree) {
    for (const auto& leaf : tree.quadtree.leaves()) EXPECT_LE(leaf.weight, kTarget);
  });
}

TEST_P(Quadtrees, LoseNoWeight) {
  for_trees([](const Tree& tree) {
    std::vector<double> expected(tree.quadtree.leaves().size());
    for (const auto& s : tree.samples) expected[tree.quadtree.leaf_at(s.at)] += s.weight;
    double most = 0;
    for (std::size_t l = 0; l < expected.size(); ++l) {
      // A sample on a border may round to either side of it.
      EXPECT_NEAR(tree.quadtree.leaves()[l].weight, expected[l], 20);
      most += tree.quadtree.leaves()[l].weight - expected[l];
    }
    EXPECT_NEAR(most, 0, 1e-6);
  });
}

TEST_P(Quadtrees, KnowWhichLeavesTouch) {
  for_trees([](const Tree& tree) {
    for (std::uint32_t a = 0; a < tree.quadtree.leaves().size(); ++a)
      ASSERT_EQ(tree.quadtree.touching(a), others(tree, a, &Quadtree::Leaf::box, std::less<>()))
          << "leaf " << a;
  });
}

// The part that two intervals share.
double shared(double min_a, double max_a, double min_b, double max_b) {
  return std::min(max_a, max_b) - std::max(min_a, min_b);
}

TEST_P(Quadtrees, GrowLeavesByHalfOfTheLeastSideBesideThem) {
  for_trees([](const Tree& tree) {
    const auto& leaves = tree.quadtree.leaves();
    for (std::uint32_t a = 0; a < leaves.size(); ++a) {
      const Box& box = leaves[a].box;
      double left = leaves[a].side(), right = left, below = left, above = left;
      for (const std::uint32_t b : tree.quadtree.touching(a)) {
        const Box& other = leaves[b].box;
        const double side = leaves[b].side();
        const bool beside = shared(box.min_y, box.max_y, other.min_y, other.max_y) > 0;
        const bool along = shared(box.min_x, box.max_x, other.min_x, other.max_x) > 0;
        if (beside && other.max_x == box.min_x) left = std::min(left, side);
        if (beside && other.min_x == box.max_x) right = std::min(right, side);
        if (along && other.max_y == box.min_y) below = std::min(below, side);
        if (along && other.min_y == box.max_y) above = std::min(above, side);
      }
      const Box& halo = leaves[a].halo;
      const double slack = 1e-3 * leaves[a].side();
      EXPECT_NEAR(halo.min_x, box.min_x - 0.5 * left, slack);
      EXPECT_NEAR(halo.max_x, box.max_x + 0.5 * right, slack);
      EXPECT_NEAR(halo.min_y, box.min_y - 0.5 * below, slack);
      EXPECT_NEAR(halo.max_y, box.max_y + 0.5 * above, slack);
    }
  });
}

TEST_P(Quadtrees, FindEveryLeafWhoseHaloOverlaps) {
  for_trees([](const Tree& tree) {
    const auto overlapping = tree.quadtree.overlapping();
    ASSERT_EQ(overlapping.size(), tree.quadtree.leaves().size());
    for (std::uint32_t a = 0; a < overlapping.size(); ++a)
      ASSERT_EQ(overlapping[a], others(tree, a, &Quadtree::Leaf::halo, std::less_equal<>()))
          << "leaf " << a;
  });
}

constexpr Place kPlaces[] = {{"ASquare", {0, 0, 1, 1}},
                             {"ALongBox", {-3, 5, 14, 8.5}},
                             {"FarFromTheOrigin", {1e9, -1e9, 1e9 + 1e3, -1e9 + 700}},
                             {"Tiny", {-2e-40, 1e-40, 1e-40, 2e-40}},
                             {"Huge", {-1e49, -1e49, 1e49, 1e48}}};

INSTANTIATE_TEST_SUITE_P(Over, Quadtrees, testing::ValuesIn(kPlaces),
                         [](const auto& info) { return info.param.name; });

TEST(Quadtree, OfLittleIsOneLeaf) {
  const Quadtree tree = Quadtree::build({0, 0, 1, 1}, {{{0.5, 0.5}, kTarget}}, kTarget);
  ASSERT_EQ(tree.leaves().size(), 1u);
  EXPECT_EQ(tree.leaves()[0].weight, kTarget);
  EXPECT_TRUE(tree.overlapping()[0].empty());
}

TEST(Quadtree, DoesNotSplitForOneSampleAlone) {
  const Quadtree tree = Quadtree::build({0, 0, 1, 1}, {{{0.3, 0.7}, 1e9}}, kTarget);
  ASSERT_EQ(tree.leaves().size(), 1u);
  EXPECT_EQ(tree.leaves()[0].weight, 1e9);
}

TEST(Quadtree, AsksBeforeThereAreManyLeaves) {
  Tree tree = graded({0, 0, 1, 1}, 1);
  std::uint64_t asked = 0;
  const auto build = [&](std::uint64_t most) {
    return Quadtree::build(tree.domain, tree.samples, kTarget / 1000,
                           [&](std::uint64_t leaves) -> std::optional<Error> {
                             asked = leaves;
                             if (leaves <= most) return std::nullopt;
                             return Error{ErrorCode::kBudgetExceeded, "", "too many leaves"};
                           });
  };
  const auto whole = build(1'000'000);
  ASSERT_TRUE(whole);
  ASSERT_GT(whole->leaves().size(), 7'000u);
  EXPECT_EQ(asked, whole->leaves().size());
  const auto stopped = build(3'000);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "too many leaves");
  EXPECT_LT(asked, 6'200u) << "it asked when they were there";
}

TEST(Quadtree, EndsWhereSamplesInOnePlaceOutweighTheTarget) {
  const Quadtree tree =
      Quadtree::build({0, 0, 1, 1}, {{{0.3, 0.7}, 1e9}, {{0.3, 0.7}, 1e9}}, kTarget);
  const Quadtree::Leaf& leaf = tree.leaves()[tree.leaf_at({0.3, 0.7})];
  EXPECT_NEAR(leaf.side(), kDeepest, 0.01 * kDeepest);
  EXPECT_EQ(leaf.weight, 2e9);
}

TEST(Quadtree, DoesNotDependOnTheOrderOfSamplesApart) {
  Tree tree = graded({0, 0, 1, 1}, 1);
  std::vector<Quadtree::Sample> reversed(tree.samples.rbegin(), tree.samples.rend());
  const Quadtree other = Quadtree::build(tree.domain, reversed, kTarget);
  ASSERT_EQ(other.leaves().size(), tree.quadtree.leaves().size());
  for (std::size_t l = 0; l < other.leaves().size(); ++l)
    EXPECT_EQ(other.leaves()[l].box.min_x, tree.quadtree.leaves()[l].box.min_x);
}

}  // namespace
}  // namespace weft
