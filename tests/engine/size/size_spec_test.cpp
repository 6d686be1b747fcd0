// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_spec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "weft/weft.h"

namespace weft {
namespace {

const Raster kRaster{{0, 0}, 1, 1, 2, 1, {1, 3}};

// A square of side 4 around a segment with the marker 7 from (1, 2) to (3, 2).
Pslg square() {
  Pslg pslg;
  pslg.points = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {1, 2}, {3, 2}};
  pslg.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5, 7}};
  return pslg;
}

Result<Size> made(const SizeSpec& spec) {
  const ExecutionContext context;
  const Pslg pslg = square();
  return make_size(spec, pslg, *triangulate(pslg, context), context);
}

SizeSpec with_field(std::string expression, decltype(FieldSpec::kind) kind) {
  SizeSpec spec = std::move(expression);
  spec.fields.push_back({"f", std::move(kind)});
  return spec;
}

TEST(SizeSpec, OfEachKindIsMadeIntoAFunction) {
  const auto at = [](const SizeSpec& spec) { return made(spec)->function()({0.5, 0}); };
  EXPECT_TRUE(std::isinf(at({})));
  EXPECT_EQ(at(0.25), 0.25);
  EXPECT_EQ(at("x + 1"), 1.5);
  EXPECT_EQ(at(kRaster), 2);
}

TEST(SizeSpec, TellsWhetherItIsTheSameEverywhere) {
  const auto constant = [](const SizeSpec& spec) { return made(spec)->function().constant(); };
  EXPECT_TRUE(std::isinf(constant({}).value()));
  EXPECT_EQ(constant(0.25), 0.25);
  EXPECT_EQ(constant("2^3"), 8);
  EXPECT_EQ(constant("x"), std::nullopt);
  EXPECT_EQ(constant(kRaster), std::nullopt);
}

TEST(SizeSpec, OfAConstantHasItsValueInEveryLaneAndBox) {
  const auto size = made(0.25);
  alignas(64) const double x[8] = {};
  alignas(64) double out[8] = {};
  size->function().evaluate(8, x, x, out);
  for (const double value : out) EXPECT_EQ(value, 0.25);
  const Interval bounds = size->function().bounds({0, 0, 1, 1});
  EXPECT_EQ(bounds.lo, 0.25);
  EXPECT_EQ(bounds.hi, 0.25);
  EXPECT_FALSE(bounds.may_be_nan);
}

TEST(SizeSpec, OfEdgesBoundsTheAreaByAnEquilateralTriangle) {
  const auto area = [](SizeSpec spec) {
    spec.measure = Measure::kEdge;
    return made(spec)->function()({0.5, 0});
  };
  EXPECT_DOUBLE_EQ(area(2.0), std::sqrt(3));
  EXPECT_DOUBLE_EQ(area("x + 1.5"), std::sqrt(3));
  EXPECT_DOUBLE_EQ(area(kRaster), std::sqrt(3));
  EXPECT_TRUE(std::isinf(area({})));
  EXPECT_LT(area("x - 2.5"), 0) << "so that it is found to be no size";
}

TEST(SizeSpec, MayNameTheDistanceToSegments) {
  const auto at = [](const DistanceSpec& distance, Point p) {
    return made(with_field("1 + f", distance))->function()(p);
  };
  EXPECT_EQ(at({}, {2, 1}), 2);
  EXPECT_EQ(at({.markers = {7}}, {2, 0.5}), 2.5);
  EXPECT_EQ(at({.markers = {7, 0}}, {2, 0.5}), 1.5);
  EXPECT_EQ(at({.points = {{0, 0}, {4, 0}}}, {2, 0}), 3);
  EXPECT_EQ(at({.points = {{0, 0}, {4, 0}}, .segments = {{0, 1}}}, {2, 0}), 1);
}

TEST(SizeSpec, MayNameARasterAndAMesh) {
  const FieldRaster raster{{0, 0}, 4, 4, 2, 2, {1, 5, 1, 5}};
  EXPECT_EQ(made(with_field("f", raster))->function()({3, 3}), 4);
  const FieldMesh mesh{{{0, 0}, {4, 0}, {0, 4}}, {{0, 1, 2}}, {0, 4, 8}};
  EXPECT_EQ(made(with_field("f + 1", mesh))->function()({1, 1}), 4);
}

TEST(SizeSpec, MayNameTheWidth) {
  EXPECT_NEAR(made(with_field("f", WidthSpec{}))->function()({2, 2}), 4, 0.2);
}

TEST(SizeSpec, LeavesRoomForCellsAcross) {
  SizeSpec spec;
  spec.cells_across = 8;
  const auto size = made(spec);
  EXPECT_NEAR(size->function()({2, 2}), std::sqrt(3) / 4 * 0.25, 0.03);
  EXPECT_FALSE(size->function().constant());
  spec.cells_across = -1;
  EXPECT_EQ(check_size(spec)->field, "size.cells_across");
  spec.cells_across = 0;
  for (const double wrong : {-1.0, 2e5, std::numeric_limits<double>::quiet_NaN()}) {
    spec.points_per_circle = wrong;
    EXPECT_EQ(check_size(spec)->field, "size.points_per_circle") << wrong;
  }
}

TEST(SizeSpec, WithALimitToItsGradationGrowsByNoMore) {
  SizeSpec spec = "x < 1 ? 0.1 : 10";
  spec.measure = Measure::kEdge;
  spec.gradation = 0.5;
  const auto size = made(spec);
  const auto edge = [&](double x) {
    return std::sqrt(size->function()({x, 2}) * 4 / std::sqrt(3));
  };
  EXPECT_NEAR(edge(0.5), 0.1, 1e-12);
  EXPECT_LE(edge(3), 1.1 + 1e-12);
  EXPECT_GE(edge(3), 1.1 * 0.95);
}

// The limit of min(a, b) is the least of both limits; that of a steep distance is known without a
// search, whatever stands beside it.
TEST(SizeSpec, OfALeastValueIsLimitedInItsParts) {
  const auto limited = [](const std::string& expression) {
    SizeSpec spec = with_field(expression, DistanceSpec{});
    spec.measure = Measure::kEdge;
    spec.gradation = 0.2;
    auto size = made(spec);
    EXPECT_TRUE(size) << size.error().message;
    return std::move(*size);
  };
  const auto edge = [](const Size& size, Point p) {
    return SizeFunction::edge_of_area(size.function()(p));
  };
  const Size by_border = limited("0.1 + 0.9*f");
  const Size by_place = limited("0.3 + 0.7*x");
  const Size both = limited(" min(0.1 + 0.9*f, max(0.3, 0.2) + 0.7*x)");
  const Size other_order = limited("min(0.3 + 0.7*x, min(0.1 + 0.9*f, 10))");
  const Size in_a_sum = limited("0 + min(0.1 + 0.9*f, 0.3 + 0.7*x)");
  for (double x = 0.05; x < 4; x += 0.17) {
    for (double y = 0.05; y < 4; y += 0.17) {
      const Point p{x, y};
      const double least = std::min(edge(by_border, p), edge(by_place, p));
      EXPECT_LE(edge(both, p), least * (1 + 1e-12)) << x << " " << y;
      EXPECT_GE(edge(both, p), least * 0.95);
      EXPECT_GE(edge(other_order, p), least * 0.95);
      const Interval bounds = both.function().bounds({x, y, x + 0.1, y + 0.1});
      EXPECT_LE(bounds.lo, both.function()(p));
      EXPECT_GE(bounds.hi, both.function()({x + 0.05, y + 0.1}));
    }
  }
  // At the border itself the sources would have lowered it.
  EXPECT_EQ(edge(both, {3.9, 0}), edge(by_border, {3.9, 0}));
  EXPECT_LT(both.bytes(), in_a_sum.bytes());
}

TEST(SizeSpec, OfALeastValueNamesTheFieldThatIsUndefined) {
  SizeSpec spec = with_field("min(1 + 0.9*f, g)", DistanceSpec{});
  spec.fields.push_back({"g", FieldRaster{{0, 0}, 1, 1, 3, 3, std::vector<float>(9, 2)}});
  spec.gradation = 0.2;
  const auto size = made(spec);
  ASSERT_TRUE(size) << size.error().message;
  EXPECT_TRUE(std::isnan(size->function()({3, 3})));
  EXPECT_EQ(size->function().asked_at({3, 3}).undefined, std::vector<std::string>{"g"});
  EXPECT_TRUE(size->function().bounds({1, 1, 3, 3}).may_be_nan);
  EXPECT_GT(size->function()({1, 1}), 0);
}

TEST(SizeSpec, AtAMarkerGrowsFromItsSegmentsByTheGradation) {
  SizeSpec spec = 1.0;
  spec.measure = Measure::kEdge;
  spec.at = {{7, 0.25}};
  EXPECT_EQ(made(spec)->function().constant(), std::sqrt(3) / 4);  // edges on segments alone
  spec.gradation = 0.5;
  for (const std::string expression : {"1", "1 + 0*x", "y > 9"}) {  // the last is no size
    spec.value = expression;
    const auto size = made(spec);
    ASSERT_TRUE(size);
    EXPECT_FALSE(size->function().constant());
    for (const double y : {2.0, 2.5, 3.0, 4.0}) {
      const double edge = std::min(1.0, 0.25 + 0.5 * (y - 2));
      const double area = std::sqrt(3) / 4 * edge * edge;
      const double got = size->function()({2, y});
      EXPECT_NEAR(got, expression == "y > 9" ? 0 : area, 1e-12) << y;
      const Interval bounds = size->function().bounds({1.5, y - 0.25, 2.5, y + 0.25});
      EXPECT_LE(bounds.lo, got);
      EXPECT_GE(bounds.hi, got);
    }
  }
  spec.value = std::monostate();
  EXPECT_NEAR(made(spec)->function()({2, 4}), std::sqrt(3) / 4 * 1.25 * 1.25, 1e-12);
}

TEST(SizeSpec, GrowsByTheGradationFromARegionWithABoundOfItsOwn) {
  Pslg pslg = square();  // with a region of edges of length 0.1 below y = 1
  pslg.points.insert(pslg.points.end(), {{0, 1}, {4, 1}});
  pslg.segments.push_back({6, 7});
  pslg.regions.push_back({{2, 0.5}, 1, area_of_edge(0.1)});
  const ExecutionContext context;
  const Domain domain = *triangulate(pslg, context);
  for (const SizeSpec::Value& value :
       {SizeSpec::Value(), SizeSpec::Value(1.0), SizeSpec::Value("1 + 0.01*y")}) {
    SizeSpec spec = value;
    spec.measure = Measure::kEdge;
    const auto free = make_size(spec, pslg, domain, context);
    EXPECT_GT(free->function()({2, 1.5}), 0.3);
    spec.gradation = 0.2;
    const auto size = make_size(spec, pslg, domain, context);
    for (const double y : {1.0, 1.5, 3.0})
      EXPECT_NEAR(SizeFunction::edge_of_area(size->function()({2, y})), 0.1 + 0.2 * (y - 1), 1e-9);
  }
  SizeSpec small = 0.09;
  small.measure = Measure::kEdge;
  small.gradation = 0.2;
  EXPECT_TRUE(make_size(small, pslg, domain, context)->function().constant());
}

TEST(SizeSpec, AtAMarkerNamesWhatIsWrong) {
  const auto fault = [](std::vector<SizeAt> at) {
    SizeSpec spec = 1.0;
    spec.at = std::move(at);
    return made(spec).error();
  };
  for (const double value : {0.0, -1.0, std::nan(""), 1 / 0.0}) {
    const Error error = fault({{7, 1}, {0, value}});
    EXPECT_EQ(error.code, ErrorCode::kBadOption);
    EXPECT_EQ(error.field, "size.at[1].max_edge");
  }
  EXPECT_EQ(fault({{7, 1}, {7, 2}}).field, "size.at[1].marker");
  const Error unknown = fault({{7, 1}, {8, 2}});
  EXPECT_EQ(unknown.code, ErrorCode::kBadOption);
  EXPECT_EQ(unknown.field, "size.at[1].marker");
  EXPECT_NE(unknown.message.find("is 8, which is the marker of no segment"), std::string::npos);
  EXPECT_EQ(fault(std::vector<SizeAt>(33, {7, 1})).field, "size.at");
}

TEST(SizeSpec, ThatIsNoSizeNamesItsField) {
  for (const double value : {0.0, -1.0, std::nan(""), 1 / 0.0}) {
    const auto error = check_size(value);
    ASSERT_TRUE(error) << value;
    EXPECT_EQ(error->code, ErrorCode::kBadSizeValue);
    EXPECT_EQ(error->field, "size.constant");
  }
  EXPECT_EQ(check_size("0")->field, "size.expression");
  EXPECT_EQ(check_size("x +")->code, ErrorCode::kExpressionSyntax);
  Raster bad = kRaster;
  bad.values[1] = 0;
  const SizeSpec spec = bad;
  EXPECT_EQ(made(spec).error().field, "size.raster.values[1]");
  SizeSpec steep = 1.0;
  for (const double gradation : {-1.0, std::nan(""), 1 / 0.0}) {
    steep.gradation = gradation;
    EXPECT_EQ(check_size(steep)->field, "size.gradation");
  }
}

TEST(SizeSpec, NamesTheFieldThatIsWrong) {
  const auto error = [](const DistanceSpec& distance) {
    return made(with_field("f", distance)).error();
  };
  EXPECT_EQ(error({.markers = {8}}).field, "size.fields[0].distance.markers");
  EXPECT_EQ(error({.markers = {7}, .points = {{0, 0}}}).field, "size.fields[0].distance.markers");
  EXPECT_EQ(error({.points = {{0, 0}, {0, std::nan("")}}}).field,
            "size.fields[0].distance.points[1].y");
  EXPECT_EQ(error({.points = {{1e51, 0}}}).field, "size.fields[0].distance.points[0].x");
  EXPECT_EQ(error({.points = {{0, 0}}, .segments = {{0, 1}}}).field,
            "size.fields[0].distance.segments[0].b");
  EXPECT_EQ(error({.segments = {{3, 1}}}).field, "size.fields[0].distance.segments[0].a");
  SizeSpec many = "x + 1";
  for (std::size_t i = 0; i <= kMaxSizeFields; ++i)
    many.fields.push_back({"f" + std::to_string(i), DistanceSpec{}});
  EXPECT_EQ(check_size(many)->field, "size.fields");
  EXPECT_EQ(check_size(with_field("g", WidthSpec{}))->field, "size.expression");
  SizeSpec widths = with_field("f + g", WidthSpec{});
  widths.fields.push_back({"g", WidthSpec{}});
  EXPECT_EQ(check_size(widths)->field, "size.fields[1]");
}

TEST(SizeSpec, OfManyFieldsAsksForTheMemoryOfAll) {
  struct Source final : MemorySource {
    Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
      most = std::max(most, needed);
      return needed;
    }
    std::uint64_t most = 0;
  } source;
  SizeSpec spec = "x + 1";
  const FieldRaster raster{{0, 0}, 0.01, 0.01, 500, 500, std::vector<float>(250'000, 1)};
  for (int i = 0; i < 4; ++i) spec.fields.push_back({"r" + std::to_string(i), raster});
  spec.fields.push_back({"d", DistanceSpec{.points = std::vector<Point>(20'000, {1, 1})}});
  spec.fields.push_back({"w", WidthSpec{}});
  const Pslg pslg = square();
  ExecutionContext context;
  const Domain domain = *triangulate(pslg, context);
  context.set_memory(source, 0);
  const auto size = make_size(spec, pslg, domain, context);
  ASSERT_TRUE(size);
  EXPECT_GE(source.most, size->bytes());
  EXPECT_GE(bytes_to_make(spec, pslg) + (1u << 20), size->bytes());

  const ExecutionContext poor(Budget{.max_bytes = 3'000'000});
  EXPECT_EQ(make_size(spec, pslg, domain, poor).error().code, ErrorCode::kBudgetExceeded);
}

TEST(SizeSpec, OfEveryKindKeepsToTheBudget) {
  struct Source final : MemorySource {
    Result<std::uint64_t> grant(std::uint64_t needed, const Poll&) override {
      most = std::max(most, needed);
      return needed;
    }
    std::uint64_t most = 0;
  };
  const Pslg pslg = square();
  ExecutionContext alone;
  const Domain domain = *triangulate(pslg, alone);
  const FieldRaster raster{{0, 0}, 0.01, 0.01, 500, 500, std::vector<float>(250'000, 1)};
  FieldMesh mesh;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    mesh.vertices.push_back({0.01 * i, 0});
    mesh.vertices.push_back({0.01 * i, 1});
    mesh.values.insert(mesh.values.end(), {1, 2});
    if (i > 0) mesh.triangles.push_back({2 * i - 2, 2 * i, 2 * i - 1});
  }
  SizeSpec graded = "0.1 + abs(x - 1) + abs(y - 1)";
  graded.gradation = 0.05;
  SizeSpec wide = 1.0;
  wide.cells_across = 3;
  SizeSpec at_marker = "1 + x/8";
  at_marker.at.push_back({.marker = 7, .max_edge = 0.1});
  at_marker.gradation = 0.3;
  for (const SizeSpec& spec :
       {with_field("f", raster), with_field("f", mesh), with_field("f", WidthSpec{}),
        with_field("f", DistanceSpec{.points = std::vector<Point>(20'000, {1, 1})}), wide, graded,
        at_marker}) {
    Source source;
    ExecutionContext rich;
    rich.set_memory(source, 0);
    ASSERT_TRUE(make_size(spec, pslg, domain, rich));
    const ExecutionContext poor(Budget{.max_bytes = source.most / 2});
    const auto refused = make_size(spec, pslg, domain, poor);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kBudgetExceeded);
    EXPECT_EQ(refused.error().field, "budget.max_bytes");
  }
}

// Memory is asked for before it is taken, so the promise must cover it.
TEST(SizeSpec, TakesNoMoreMemoryThanItSays) {
  for (const std::uint32_t side : {1u, 4u, 5u, 33u, 1000u}) {
    const SizeSpec spec = Raster{{0, 0}, 1, 1, side, side, std::vector<double>(side * side, 1)};
    const auto size = made(spec);
    const std::uint64_t held = sizeof(double) * side * side;
    EXPECT_LE(size->bytes() - held, bytes_to_make(spec, {})) << side;
  }
  EXPECT_EQ(bytes_to_make("x", {}), 0u);
}

}  // namespace
}  // namespace weft
