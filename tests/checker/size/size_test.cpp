// SPDX-License-Identifier: Apache-2.0
// Sizes of all kinds, and the fields that they name, as `check` judges them.
#include "checker/size/size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

using Rules = std::set<Rule>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kEdge = 1.0745699318235418;  // of an equilateral triangle of area 0.5

const DistanceField kToOrigin{{}, {{0, 0}}, {}};

SizeSpec spec(std::string source, std::vector<NamedField> fields) {
  SizeSpec size = std::move(source);
  size.fields = std::move(fields);
  return size;
}

double value(const SizeSpec& size, Vec2 p, const Domain& domain = {}) {
  const auto made = size_function(size, domain);
  EXPECT_TRUE(made) << made.error();
  return made ? (*made)(p) : kNan;
}

std::string error_of(const SizeSpec& size) {
  const auto made = size_function(size, {});
  return made ? "" : made.error();
}

Report report_of(const SizeSpec& size) {
  Problem problem = block(4);  // triangles of area 0.5 on [0, 6] x [0, 4]
  problem.requirements = {};
  problem.requirements.size = size;
  return problem.check();
}

TEST(CheckersSizeSpec, OfNothingIsNoBound) {
  EXPECT_FALSE(*size_function({}, {}));
}

TEST(CheckersSizeSpec, OfAConstantBoundsAreas) {
  EXPECT_TRUE(report_of(0.5).ok());
  EXPECT_EQ(violated(report_of(0.499)), Rules{Rule::kArea});
  EXPECT_EQ(violated(report_of(0.0)), Rules{Rule::kSize});
  EXPECT_EQ(violated(report_of(kNan)), Rules{Rule::kSize});
}

TEST(CheckersSizeSpec, OfEdgesBoundsTheAreaOfAnEquilateralTriangle) {
  SizeSpec size = std::to_string(kEdge * 1.0001);
  size.measure = Measure::kEdge;
  EXPECT_TRUE(report_of(size).ok());
  size.value = kEdge * 0.9999;
  EXPECT_EQ(violated(report_of(size)), Rules{Rule::kArea});
  size.value = Raster{{0, 0}, 1, 1, 1, 1, {2}};
  EXPECT_NEAR(value(size, {0, 0}), std::sqrt(3), 1e-15);
  size.value = -kEdge;  // its square would do
  EXPECT_EQ(violated(report_of(size)), Rules{Rule::kSize});
}

TEST(Fields, AreNamedInExpressions) {
  const RasterField raster{{0, 0}, 8, 8, 2, 2, {0, 16, 8, 24}};              // 2 x + y
  const MeshField mesh{{{0, 0}, {8, 0}, {0, 8}}, {{0, 1, 2}}, {0, 24, 32}};  // 3 x + 4 y
  const SizeSpec size =
      spec("coast + 100*depth + 1e4*h", {{"coast", kToOrigin}, {"depth", raster}, {"h", mesh}});
  EXPECT_NEAR(value(size, {3, 4}), 5 + 100 * 10 + 1e4 * 25, 1e-9);
}

TEST(Fields, HaveSlopes) {
  const RasterField raster{{0, 0}, 8, 8, 2, 2, {0, 24, 32, 56}};             // 3 x + 4 y
  const MeshField mesh{{{0, 0}, {8, 0}, {0, 8}}, {{0, 1, 2}}, {0, 40, 96}};  // 5 x + 12 y
  const std::vector<NamedField> fields = {{"coast", kToOrigin}, {"depth", raster}, {"h", mesh}};
  EXPECT_EQ(value(spec("slope(coast)", fields), {3, 4}), 1);
  EXPECT_NEAR(value(spec("slope(depth)", fields), {3, 4}), 5, 1e-14);
  EXPECT_NEAR(value(spec("-x + 2* - slope ( h\n ) ^2", fields), {3, 4}), -3 - 2 * 169, 1e-12);
  EXPECT_NEAR(value(spec("min(slope(h), h) + coast", fields), {3, 4}), 13 + 5, 1e-14);
}

TEST(Fields, AreInTheSlopeByNameAlone) {
  const std::vector<NamedField> fields = {{"coast", kToOrigin}};
  for (const char* const source : {"slope(2*coast)", "slope(x)", "slope", "slope(coast, 1)",
                                   "slope()", "slope(", "slope coast", "$coast", "slope((coast))"})
    EXPECT_NE(error_of(spec(source, fields)), "") << source;
  EXPECT_EQ(error_of(spec("1 + slope(x)", fields)),
            "the size expression does not parse: slope takes the name of a field, at column 5");
}

TEST(Fields, ThatAreUndefinedAreGuarded) {
  const RasterField raster{{0, 0}, 1, 1, 2, 2, {3, 3, 3, 3}};  // undefined beyond 1
  const auto at = [&](const char* source, Vec2 p) {
    return value(spec(source, {{"coast", kToOrigin}, {"depth", raster}}), p);
  };
  EXPECT_EQ(at("defined(depth)", {0.5, 0.5}), 1);
  EXPECT_EQ(at("defined(depth)", {2, 0}), 0);
  EXPECT_EQ(at("!defined(slope(depth))", {2, 0}), 1);
  EXPECT_EQ(at("defined(depth) ? depth : 7", {2, 0}), 7);
  EXPECT_EQ(at("coalesce(depth, 7)", {0.5, 0.5}), 3);
  EXPECT_EQ(at("coalesce(depth, 7)", {2, 0}), 7);
  EXPECT_EQ(at("coalesce(depth, depth, coast)", {2, 0}), 2);
  for (const char* const source :
       {"depth", "depth + 1", "min(depth, 1)", "min(1, depth)", "max(1, 2, depth)", "max(depth, 1)",
        "clamp(depth, 1, 2)", "clamp(1, depth, 2)", "coalesce(depth, depth)"}) {
    EXPECT_TRUE(std::isnan(at(source, {2, 0}))) << source;
    EXPECT_FALSE(std::isnan(at(source, {0.5, 0.5}))) << source;
  }
  EXPECT_NE(error_of(spec("coalesce(coast)", {{"coast", kToOrigin}})), "");
}

TEST(Fields, ThatAreUndefinedAtOneCentroidAreFound) {
  // Nodes at all half units; one of them, beside the centroid (0.5, 1/3) alone, has no value.
  RasterField raster{{0, 0}, 0.25, 0.25, 25, 17, std::vector<float>(25 * 17, 0.5F)};
  EXPECT_TRUE(report_of(spec("depth", {{"depth", raster}})).ok());
  raster.values[1 * 25 + 2] = std::numeric_limits<float>::quiet_NaN();
  const Report report = report_of(spec("depth", {{"depth", raster}}));
  EXPECT_EQ(violated(report), Rules{Rule::kSize});
  EXPECT_EQ(report.total(Rule::kSize), 1u);
  EXPECT_NE(to_text(report).find("the size is nan at (0.5, 0.333"), std::string::npos);
  EXPECT_TRUE(report_of(spec("coalesce(depth, 0.5)", {{"depth", raster}})).ok());
  EXPECT_EQ(violated(report_of(spec("coalesce(depth, 0.4)", {{"depth", raster}}))),
            Rules{Rule::kArea});
  for (float& node : raster.values) node = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(report_of(spec("depth", {{"depth", raster}})).total(Rule::kSize), 32u);
}

// The centroid (0.5, 1/3) is not a double; the field ends there.
TEST(Fields, ThatEndAtACentroidAreDefinedThere) {
  const RasterField raster{{0, 1.0 / 3}, 6, 4, 2, 2, {0.5F, 0.5F, 0.5F, 0.5F}};
  const Report report = report_of(spec("depth", {{"depth", raster}}));
  EXPECT_EQ(report.total(Rule::kSize), 0u) << to_text(report);
}

TEST(Fields, MeasureTheDomain) {
  Problem problem = block(4);
  problem.requirements = {};
  problem.requirements.size = spec("coast < 1 ? 0.4 : 1", {{"coast", DistanceField{{1}, {}, {}}}});
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kArea});
  problem.requirements.size.fields[0].kind = DistanceField{{9}, {}, {}};
  EXPECT_EQ(violated(problem.check()), Rules{Rule::kSize});
}

TEST(Fields, OfWidthAreNotJudged) {
  EXPECT_EQ(error_of(spec("1 + w", {{"w", WidthField{}}})),
            "the checker cannot judge sizes that use the field w");
  EXPECT_EQ(error_of(spec("slope(w)", {{"w", WidthField{}}})),
            "the checker cannot judge sizes that use the field w");
  EXPECT_EQ(error_of(spec("1", {{"w", WidthField{}}})), "");
}

TEST(Fields, HaveNamesThatMeanNothingElse) {
  const auto named = [](const std::string& name) {
    return error_of(spec("1", {{"a", kToOrigin}, {name, kToOrigin}}));
  };
  EXPECT_EQ(named("b"), "");
  EXPECT_EQ(named("_Long2"), "");
  EXPECT_EQ(named(std::string(64, 'b')), "");
  EXPECT_EQ(named(""), "the name of field 1 is '', which is no name");
  EXPECT_EQ(named("2b"), "the name of field 1 is '2b', which is no name");
  EXPECT_EQ(named("a b"), "the name of field 1 is 'a b', which is no name");
  EXPECT_EQ(named("$a"), "the name of field 1 is '$a', which is no name");
  EXPECT_EQ(named("a"), "two fields have the name 'a'");
  EXPECT_EQ(named(std::string(10000, 'b')), "the name of field 1 has 10000 bytes, the limit is 64");
  for (const char* const taken : {"x", "y", "pi", "e", "min", "slope", "defined", "coalesce"})
    EXPECT_EQ(named(taken),
              "the name of field 1 is '" + std::string(taken) + "', which means something else");
}

TEST(Fields, OfNonsenseAreViolations) {
  const auto rules = [](const NamedField& field) {
    return violated(report_of(spec("1", {field})));
  };
  EXPECT_EQ(rules({"f", DistanceField{{}, {{1, 1}}, {{0, 1}}}}), Rules{Rule::kSize});
  EXPECT_EQ(rules({"f", RasterField{}}), Rules{Rule::kSize});
  EXPECT_EQ(rules({"f", MeshField{}}), Rules{Rule::kSize});
  EXPECT_EQ(rules({"f", MeshField{{{0, 0}}, {{0, 1, 2}}, {1}}}), Rules{Rule::kSize});
  EXPECT_EQ(rules({"", kToOrigin}), Rules{Rule::kSize});
  EXPECT_EQ(error_of(spec("1", {{"f", MeshField{}}})), "field 0: no triangle has an area");
}

}  // namespace
}  // namespace weft::check::testing
