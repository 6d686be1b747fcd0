// SPDX-License-Identifier: Apache-2.0
// Named fields in size expressions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/size/expression/expression.h"

namespace weft {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// a x + b y + c to the left of x = edge, undefined from there on.
class HalfPlane final : public Field {
 public:
  HalfPlane(double a, double b, double c, double edge) : a_(a), b_(b), c_(c), edge_(edge) {}

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override {
    for (std::size_t i = 0; i < n; ++i) out[i] = x[i] < edge_ ? a_ * x[i] + b_ * y[i] + c_ : kNan;
  }
  Interval bounds(const Box& box) const noexcept override {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (box.min_x >= edge_) return {kInfinity, -kInfinity, true};
    const double x = std::min(box.max_x, edge_);
    Interval found{kInfinity, -kInfinity, box.max_x >= edge_};
    for (const Point p : {Point{box.min_x, box.min_y}, Point{x, box.min_y},
                          Point{box.min_x, box.max_y}, Point{x, box.max_y}}) {
      const double value = a_ * p.x + b_ * p.y + c_;
      found.lo = std::min(found.lo, value - 1e-9);
      found.hi = std::max(found.hi, value + 1e-9);
    }
    return found;
  }
  std::unique_ptr<const Field> slope() const override {
    return has_slope ? std::make_unique<HalfPlane>(0, 0, std::sqrt(a_ * a_ + b_ * b_), edge_)
                     : nullptr;
  }
  std::size_t operations() const noexcept override { return 100; }

  bool has_slope = true;

 private:
  double a_, b_, c_, edge_;
};

const HalfPlane kDepth(3, 4, 100, 5);
const HalfPlane kCoast(1, 0, 0, 1e9);
const std::vector<NamedField> kFields = {{"coast", &kCoast}, {"depth", &kDepth}};

double value(const std::string& source, Point p) {
  return Expression::parse(source, kFields).value()(p);
}

std::string message(const std::string& source) {
  return Expression::parse(source, kFields).error().message;
}

TEST(FieldsOfExpressions, AreTheirValues) {
  EXPECT_EQ(value("depth", {1, 2}), 111);
  EXPECT_EQ(value("2*depth + coast - x", {1, 2}), 222);
  EXPECT_EQ(value("coast*coast", {7, 2}), 49);
}

TEST(FieldsOfExpressions, HaveASlope) {
  EXPECT_EQ(value("slope(depth)", {1, 2}), 5);
  EXPECT_EQ(value("slope(depth) + depth + slope(coast)", {1, 2}), 117);
}

TEST(FieldsOfExpressions, MayBeUndefined) {
  EXPECT_TRUE(std::isnan(value("depth + 1", {6, 0})));
  EXPECT_EQ(value("defined(depth)", {6, 0}), 0);
  EXPECT_EQ(value("defined(depth)", {4, 0}), 1);
  EXPECT_EQ(value("defined(depth) ? depth : 7", {6, 0}), 7);
  EXPECT_EQ(value("coalesce(depth, 7)", {6, 0}), 7);
  EXPECT_EQ(value("coalesce(depth, 7)", {1, 2}), 111);
  EXPECT_EQ(value("coalesce(depth, depth, coast)", {6, 0}), 6);
  EXPECT_EQ(value("coalesce(1, depth)", {6, 0}), 1);
  EXPECT_EQ(value("defined(3) && !defined(0/0)", {0, 0}), 1);
}

TEST(FieldsOfExpressions, ArePartOfNoConstant) {
  EXPECT_FALSE(Expression::parse("depth", kFields)->constant());
  EXPECT_EQ(Expression::parse("depth > 3 ? 2 : 2", kFields)->constant(), 2);
}

TEST(FieldsOfExpressions, GiveTheSameBitsInEveryBatch) {
  const Expression size = *Expression::parse("coalesce(depth, 3*coast) + slope(depth)", kFields);
  alignas(64) double x[16], y[16], out[16];
  std::mt19937_64 random(1);
  for (int i = 0; i < 16; ++i) {
    x[i] = static_cast<double>(random() % 1000) / 100;
    y[i] = static_cast<double>(random() % 1000) / 100;
  }
  size.evaluate(16, x, y, out);
  for (int i = 0; i < 16; ++i) {
    const double alone = size({x[i], y[i]});
    EXPECT_TRUE(out[i] == alone || (std::isnan(out[i]) && std::isnan(alone)));
  }
}

TEST(FieldsOfExpressions, HaveBoundsThatHoldAndGuardsThatAreSeen) {
  const char* const sources[] = {"depth",
                                 "coalesce(depth, 5)",
                                 "defined(depth) ? depth : -2",
                                 "defined(depth)",
                                 "min(depth, coast)",
                                 "coalesce(2*depth, coast)",
                                 "!defined(depth) || coast > 3",
                                 "coalesce(slope(depth), 1) - depth/coast"};
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 * 12; };
  for (const char* const source : sources) {
    const Expression size = *Expression::parse(source, kFields);
    for (int round = 0; round < 300; ++round) {
      const Point a{uniform(), uniform()};
      const Point b{a.x + uniform() / 8, a.y + uniform() / 8};
      const Interval bounds = size.bounds({a.x, a.y, b.x, b.y});
      for (int i = 0; i < 20; ++i) {
        const Point p{a.x + uniform() / 12 * (b.x - a.x), a.y + uniform() / 12 * (b.y - a.y)};
        const double value = size(p);
        if (std::isnan(value))
          EXPECT_TRUE(bounds.may_be_nan) << source;
        else
          EXPECT_TRUE(bounds.lo <= value && value <= bounds.hi) << source;
      }
    }
  }
  const Box undefined{6, 0, 7, 1};
  const Interval guarded = Expression::parse("coalesce(depth, 5)", kFields)->bounds(undefined);
  EXPECT_EQ(guarded.lo, 5);
  EXPECT_EQ(guarded.hi, 5);
  EXPECT_FALSE(guarded.may_be_nan);
  EXPECT_EQ(Expression::parse("defined(depth) ? depth : 5", kFields)->bounds(undefined).hi, 5);
}

TEST(FieldsOfExpressions, LeaveUndefinedWhatIsComputedOfThemWhereTheyAre) {
  const auto bounds = [](const char* source) {
    return Expression::parse(source, kFields)->bounds({6, 0, 7, 1});
  };
  for (const char* const source :
       {"depth + 1", "1 - depth", "2*depth", "depth/coast", "-depth", "abs(depth)", "depth^2",
        "sqrt(depth)", "exp(depth)", "sin(depth)", "floor(depth)", "min(depth, 3)", "max(3, depth)",
        "atan2(1, depth)", "1 + 0.3*max(2, depth)", "coast < 9 ? depth : depth + 1"}) {
    EXPECT_GT(bounds(source).lo, bounds(source).hi) << source;
    EXPECT_TRUE(bounds(source).may_be_nan) << source;
  }
  for (const char* const source : {"pow(depth, coast - 6)", "hypot(depth, 1/(coast - 6))"}) {
    EXPECT_EQ(bounds(source).hi, std::numeric_limits<double>::infinity()) << source;
    EXPECT_TRUE(bounds(source).may_be_nan) << source;
  }
  for (const char* const source : {"depth < 3", "depth <= 3", "depth > 3", "depth == depth"})
    EXPECT_EQ(bounds(source).hi, 0) << source;
  EXPECT_EQ(bounds("depth != 3").lo, 1);
  EXPECT_EQ(bounds("depth < 3 ? 1 : 2").lo, 2);
}

TEST(FieldsOfExpressions, AreExplainedIfMisspelt) {
  EXPECT_THAT(message("detph"), HasSubstr("unknown name 'detph'; did you mean 'depth'?"));
  EXPECT_THAT(message("bathymetry"), HasSubstr("the variables are x, y, coast and depth"));
  EXPECT_THAT(message("slope(2*depth)"), HasSubstr("line 1, column 7"));
  EXPECT_THAT(message("slope(x)"), HasSubstr("slope takes the name of a field"));
  EXPECT_THAT(message("slope"), HasSubstr("needs arguments"));
  EXPECT_THAT(message("depth(1)"), HasSubstr("'depth' is not a function"));
}

TEST(FieldsOfExpressions, WithoutASlopeSaySo) {
  HalfPlane steep(1, 1, 1, 9);
  steep.has_slope = false;
  const std::vector<NamedField> fields = {{"w", &steep}};
  const auto made = Expression::parse("1 + slope(w)", fields);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, "the field w has no slope");
}

TEST(FieldsOfExpressions, AreJudgedByNameAlone) {
  const std::vector<std::string> names = {"coast", "depth"};
  EXPECT_THAT(Expression::check("3 + slope(depth)", names)->used, ElementsAre(false, true));
  EXPECT_EQ(Expression::check("3 + 4", names)->constant, 7);
  EXPECT_FALSE(Expression::check("depth", names)->constant);
  EXPECT_FALSE(Expression::check("3 + width", names));
}

TEST(NamesOfFields, AreWordsThatMeanNothingElse) {
  using Names = std::vector<std::string>;
  const auto message = [](const Names& names) {
    const auto error = Expression::check_names(names);
    return error ? error->field + ": " + error->message : "";
  };
  EXPECT_EQ(message({"coast", "_h2", "X"}), "");
  EXPECT_THAT(message({"coast", ""}), HasSubstr("size.fields[1].name: size.fields[1].name is ''"));
  for (const char* const bad : {"2a", "a-b", "a b", "\xc3\xa9"})
    EXPECT_THAT(message({bad}), HasSubstr("letters, digits and _")) << bad;
  EXPECT_THAT(message({std::string(65, 'a')}), HasSubstr("64 bytes"));
  EXPECT_EQ(message({std::string(64, 'a')}), "");
  for (const char* const taken : {"x", "pi", "min", "slope"})
    EXPECT_THAT(message({taken}), HasSubstr("means something else")) << taken;
  EXPECT_THAT(message({"a", "b", "a"}), HasSubstr("size.fields[0] has the same name"));
}

}  // namespace
}  // namespace weft
