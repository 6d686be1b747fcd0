// SPDX-License-Identifier: Apache-2.0
// Size expressions: any bytes are parsed; the first nine choose a box and points in it. They may
// name two fields: f, a raster that has no value at a node, and g, values on a mesh, one of which
// is none. Asserts of what parses:
//   batch         a value is the same bits in a batch, at any place of it, and alone
//   bounds        it lies in the interval bounds of the box; where lo == hi, all are the same
//   undefined     the fields that it says are undefined at a point are NaN there
//   folding       with numbers in the place of x and y, so that all is folded, it has the same bits
//                 (powers aside: a whole constant exponent becomes products)
//   acceptance    the checker's parser takes what the engine's takes, and nothing else
//   value         both give the same, unless the expression amplifies rounding or jumps
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "checker/size/mesh_field.h"
#include "checker/size/raster_field.h"
#include "checker/size/size_expression.h"
#include "engine/base/context.h"
#include "engine/size/expression/expression.h"
#include "engine/size/fields/mesh_field.h"
#include "engine/size/fields/raster_field.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

constexpr std::size_t kPoints = 13;
constexpr std::size_t kPadded = 16;

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

std::string print(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

double coordinate(ByteSource& bytes) {
  constexpr std::array<double, 8> kScales{1, 1, 1, 0.125, 100, 1e6, 1e-6, 1e160};
  const int steps = bytes.byte() - 128;
  return steps * kScales[bytes.below(kScales.size())] / 16;
}

// The points of one evaluation, in arrays as evaluate() wants them.
struct Points {
  alignas(64) std::array<double, kPadded> x{};
  alignas(64) std::array<double, kPadded> y{};
  alignas(64) std::array<double, kPadded> value{};
};

// The fields of all expressions, within 8 of the origin, and the checker's of the same values.
class Fields {
 public:
  Fields() : engine_{{"f", &raster_}, {"g", &mesh_}} {
    checker_ = {{"f", [this](check::Vec2 p) { return checker_raster_.value(p); },
                 [this](check::Vec2 p) { return checker_raster_.slope(p); }},
                {"g", [this](check::Vec2 p) { return checker_mesh_.value(p); },
                 [this](check::Vec2 p) { return checker_mesh_.slope(p); }}};
  }
  Fields(const Fields&) = delete;
  Fields& operator=(const Fields&) = delete;

  const std::vector<NamedField>& engine() const { return engine_; }
  const std::vector<check::Field>& checker() const { return checker_; }

  // Whether `name`, as "f" or "slope(f)", is a field without a value at p.
  bool is_undefined(const std::string& name, Point p) const {
    for (const NamedField& field : engine_)
      if (name == field.name) return std::isnan((*field.field)(p));
    for (const NamedField& field : engine_)
      if (name == "slope(" + field.name + ")") return std::isnan((*field.field->slope())(p));
    return false;
  }

 private:
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const FieldRaster raster_values_{
      .origin = {-6, -4},
      .dx = 2,
      .dy = 1.5,
      .columns = 5,
      .rows = 4,
      .values = {1, 2, -3, 4, 5, 0, 7, 8, 9, 1e-3F, 1e6F, 12, -13, 14, 15, 16, 17, 18, kNone, 20}};
  const FieldMesh mesh_values_{
      .vertices = {{-7, -7}, {7, -6}, {1, 1}, {-5, 6}, {8, 8}, {3, -1}},
      .triangles = {{0, 1, 2}, {0, 2, 3}, {2, 4, 3}, {1, 5, 2}, {1, 4, 5}, {5, 4, 2}, {0, 0, 1}},
      .values = {1, -2, 3, 0.25, std::numeric_limits<double>::quiet_NaN(), 50}};
  const check::RasterField checker_raster_{{raster_values_.origin.x, raster_values_.origin.y},
                                           raster_values_.dx,
                                           raster_values_.dy,
                                           raster_values_.columns,
                                           raster_values_.rows,
                                           raster_values_.values};
  const check::MeshField checker_mesh_values_ = [this] {
    check::MeshField mesh;
    for (const Point p : mesh_values_.vertices) mesh.vertices.push_back({p.x, p.y});
    mesh.triangles = mesh_values_.triangles;
    mesh.values = mesh_values_.values;
    return mesh;
  }();
  const ExecutionContext context_;
  const RasterField raster_ = RasterField::make(raster_values_, "f", context_).value();
  const MeshField mesh_ = MeshField::make(mesh_values_, "g", context_).value();
  const check::MeshValues checker_mesh_ = check::MeshValues::make(checker_mesh_values_).value();
  std::vector<NamedField> engine_;
  std::vector<check::Field> checker_;
};

const Fields& fields() {
  static const Fields fields;
  return fields;
}

// Corners, borders and insides of the box.
Points points_in(const Box& box) {
  Points points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double s = static_cast<double>(i * 5 % kPoints) / (kPoints - 1);
    const double t = static_cast<double>(i * 7 % 4) / 3;
    points.x[i] = std::clamp(std::lerp(box.min_x, box.max_x, s), box.min_x, box.max_x);
    points.y[i] = std::clamp(std::lerp(box.min_y, box.max_y, t), box.min_y, box.max_y);
  }
  return points;
}

// The source in words, and single characters that belong to none.
std::vector<std::string_view> words_of(std::string_view source) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  std::vector<std::string_view> words;
  for (std::size_t i = 0; i < source.size();) {
    std::size_t end = i + 1;
    if (is_word(source[i]))
      while (end < source.size() && is_word(source[end])) ++end;
    words.push_back(source.substr(i, end - i));
    i = end;
  }
  return words;
}

bool names_a_field(const std::vector<std::string_view>& words) {
  return std::any_of(words.begin(), words.end(),
                     [](std::string_view word) { return word == "f" || word == "g"; });
}

// The source with numbers for the names x and y.
std::string substituted(const std::vector<std::string_view>& words, double x, double y) {
  std::string out;
  for (const std::string_view word : words) {
    if (word == "x" || word == "y")
      out += "(" + print(word == "x" ? x : y) + ")";
    else
      out += word;
  }
  return out;
}

// Whether rounding stays small: short, no powers of ten, nothing that amplifies.
bool is_tame(std::string_view source) {
  if (source.size() > 40 || source.find_first_of("^<>=!?%&|") != std::string_view::npos)
    return false;
  for (const std::string_view name :
       {"pow", "tan", "sin", "cos", "exp", "floor", "ceil", "slope", "defined", "coalesce"})
    if (source.find(name) != std::string_view::npos) return false;
  std::size_t digits = 0;
  for (const char c : source) {
    digits = std::isdigit(static_cast<unsigned char>(c)) != 0 ? digits + 1 : 0;
    if (digits > 2) return false;
  }
  for (std::size_t i = 1; i < source.size(); ++i)
    if ((source[i] == 'e' || source[i] == 'E') &&
        (std::isdigit(static_cast<unsigned char>(source[i - 1])) != 0 || source[i - 1] == '.'))
      return false;
  return true;
}

void judge(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  Box box{coordinate(bytes), coordinate(bytes), 0, 0};
  box.max_x = box.min_x + std::fabs(coordinate(bytes));
  box.max_y = box.min_y + std::fabs(coordinate(bytes));
  const std::size_t chosen = bytes.below(kPoints);
  const std::string_view source = bytes.rest();
  const auto must = [&](bool holds, std::string_view law, const auto& evidence) {
    if (!holds) broken(law, evidence() + "\nin '" + std::string(source) + "'", data, size);
  };

  const auto parsed = Expression::parse(source, fields().engine());
  const auto judged = check::SizeExpression::parse(source, fields().checker());
  const bool too_complex = !parsed && parsed.error().code == ErrorCode::kExpressionTooComplex;
  if (!too_complex)
    must(parsed.has_value() == judged.has_value(), "acceptance", [&] {
      return parsed ? "the checker: " + judged.error() : "the engine: " + parsed.error().message;
    });
  if (!parsed) return;

  Points points = points_in(box);
  parsed->evaluate(kPoints, points.x.data(), points.y.data(), points.value.data());
  const Interval bounds = parsed->bounds(box);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double value = points.value[i];
    const auto shown = [&] {
      return print(value) + " at (" + print(points.x[i]) + ", " + print(points.y[i]) + ")";
    };
    must(same(value, (*parsed)({points.x[i], points.y[i]})), "batch", shown);
    const bool inside =
        std::isnan(value) ? bounds.may_be_nan : bounds.lo <= value && value <= bounds.hi;
    must(inside, "bounds", [&] {
      return shown() + " is not in [" + print(bounds.lo) + ", " + print(bounds.hi) + "]";
    });
    for (const std::string& name : parsed->asked_at({points.x[i], points.y[i]}).undefined)
      must(fields().is_undefined(name, {points.x[i], points.y[i]}), "undefined",
           [&] { return name + ", " + shown(); });
    if (parsed->constant()) must(same(value, *parsed->constant()), "constant", shown);
  }

  const Point p{points.x[chosen], points.y[chosen]};
  const double value = points.value[chosen];
  const std::vector<std::string_view> words = words_of(source);
  if (source.find('^') == std::string_view::npos && source.find("pow") == std::string_view::npos &&
      !names_a_field(words)) {
    const auto folded = Expression::parse(substituted(words, p.x, p.y));
    if (folded)
      must(folded->constant() && same((*folded)(p), value), "folding",
           [&] { return print((*folded)(p)) + " for " + print(value); });
    else
      must(folded.error().code == ErrorCode::kExpressionTooComplex, "folding",
           [&] { return folded.error().message; });
  }
  if (judged && is_tame(source) && std::fabs(p.x) <= 100 && std::fabs(p.y) <= 100 &&
      std::isfinite(value)) {
    const double other = (*judged)({p.x, p.y});
    const double nearby = (*parsed)({p.x * (1 + 1e-9), p.y * (1 - 1e-9)});
    const double slack = 1e-6 * std::max(1.0, std::fabs(value)) + 100 * std::fabs(nearby - value);
    must(!std::isfinite(nearby) || std::fabs(other - value) <= slack, "value",
         [&] { return "the checker gives " + print(other) + " for " + print(value); });
  }
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}
