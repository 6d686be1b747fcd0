// SPDX-License-Identifier: Apache-2.0
// Size expressions: any bytes are parsed; the first nine choose a box and points in it. Asserts of
// what parses:
//   batch         a value is the same bits in a batch, at any place of it, and alone
//   bounds        it lies in the interval bounds of the box; where lo == hi, all are the same
//   folding       with numbers in the place of x and y, so that all is folded, it has the same bits
//                 (powers aside: a whole constant exponent becomes products)
//   acceptance    the checker's parser takes what the engine's takes, and nothing else
//   value         both give the same, unless the expression amplifies rounding
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "checker/size/size_expression.h"
#include "engine/size/expression/expression.h"
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

// The source with numbers for the names x and y.
std::string substituted(std::string_view source, double x, double y) {
  std::string out;
  for (std::size_t i = 0; i < source.size();) {
    const auto is_word = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
    };
    std::size_t end = i + 1;
    if (is_word(source[i]))
      while (end < source.size() && is_word(source[end])) ++end;
    const std::string_view word = source.substr(i, end - i);
    if (word == "x" || word == "y")
      out += "(" + print(word == "x" ? x : y) + ")";
    else
      out += word;
    i = end;
  }
  return out;
}

// Whether rounding stays small: short, no powers of ten, nothing that amplifies.
bool is_tame(std::string_view source) {
  if (source.size() > 40 || source.find_first_of("^<>=!?%&|") != std::string_view::npos)
    return false;
  for (const std::string_view name : {"pow", "tan", "sin", "cos", "exp", "floor", "ceil"})
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

  const auto parsed = Expression::parse(source);
  const auto judged = check::SizeExpression::parse(source);
  const bool too_complex = !parsed && parsed.error().code == ErrorCode::kExpressionTooComplex;
  if (!too_complex && source.size() <= check::SizeExpression::kMaxLength)
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
    if (parsed->constant()) must(same(value, *parsed->constant()), "constant", shown);
  }

  const Point p{points.x[chosen], points.y[chosen]};
  const double value = points.value[chosen];
  if (source.find('^') == std::string_view::npos && source.find("pow") == std::string_view::npos) {
    const auto folded = Expression::parse(substituted(source, p.x, p.y));
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
