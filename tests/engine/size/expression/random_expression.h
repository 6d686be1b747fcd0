// SPDX-License-Identifier: Apache-2.0
// Seeded random expressions, as text and as a value computed without the engine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "engine/size/expression/expression.h"
#include "engine/size/expression/lanes.h"

namespace weft::testing {

// std::mt19937_64 is the same everywhere; the standard distributions are not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::size_t below(std::size_t n) { return engine_() % n; }
  bool chance(std::size_t one_in) { return below(one_in) == 0; }
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double between(double lo, double hi) { return std::clamp(lo + unit() * (hi - lo), lo, hi); }
  // Mostly of everyday size, now and then 0 or far out.
  double coordinate() {
    if (chance(12)) return chance(2) ? 0.0 : -0.0;
    if (chance(12)) return std::ldexp(unit() - 0.5, static_cast<int>(below(400)) - 200);
    if (chance(4)) return std::floor(between(-4, 5));
    return between(-8, 8);
  }

 private:
  std::mt19937_64 engine_;
};

// How tightly an expression's top operator binds, as in the grammar.
enum class Binding { kConditional, kOr, kAnd, kComparison, kSum, kProduct, kUnary, kPower, kAtom };

using Function = std::function<double(double x, double y)>;

// An expression as text, and what it means by the definitions in expression.h.
struct Sample {
  std::string text;
  Function value;
  Binding binding = Binding::kAtom;
};

// Random expressions over the whole grammar, parenthesised no more than they need.
class ExpressionMaker {
 public:
  explicit ExpressionMaker(Random& random) : random_(random) {}

  Sample make(int depth) {
    if (depth <= 0) return leaf();
    switch (random_.below(14)) {
      case 0:
        return leaf();
      case 1:
      case 2:
        return infix(" + ", Binding::kSum, std::plus<>(), depth);
      case 3:
        return infix(" - ", Binding::kSum, std::minus<>(), depth);
      case 4:
      case 5:
        return infix("*", Binding::kProduct, std::multiplies<>(), depth);
      case 6:
        return infix(" / ", Binding::kProduct, std::divides<>(), depth);
      case 7:
        return comparison(depth);
      case 8:
        return logical(depth);
      case 9:
        return sign(depth);
      case 10:
        return power(depth);
      case 11:
        return conditional(depth);
      default:
        return call(depth);
    }
  }

 private:
  static std::string wrap(const Sample& sample, Binding least) {
    return sample.binding < least ? "(" + sample.text + ")" : sample.text;
  }
  static Binding tighter(Binding binding) {
    return static_cast<Binding>(static_cast<int>(binding) + 1);
  }

  template <class Op>
  Sample infix(const std::string& symbol, Binding binding, Op op, int depth) {
    const Sample a = make(depth - 1);
    const Sample b = make(depth - 1);
    const Binding left = binding == Binding::kComparison ? tighter(binding) : binding;
    return {wrap(a, left) + symbol + wrap(b, tighter(binding)),
            [=](double x, double y) -> double { return op(a.value(x, y), b.value(x, y)); },
            binding};
  }

  Sample leaf() {
    const auto number = [](std::string text, double v) {
      return Sample{std::move(text), [v](double, double) { return v; }};
    };
    switch (random_.below(12)) {
      case 0:
        return number("pi", std::numbers::pi);
      case 1:
        return number("e", std::numbers::e);
      case 2:
        return number("0", 0);
      case 3:
        return number(".5", .5);
      case 4:
        return number("1e3", 1000);
      case 5:
        return number("7e-2", 0.07);
      case 6:
        return number("2.5", 2.5);
      default:
        if (random_.chance(2)) return {"x", [](double x, double) { return x; }};
        return {"y", [](double, double y) { return y; }};
    }
  }

  Sample comparison(int depth) {
    constexpr Binding kBinding = Binding::kComparison;
    switch (random_.below(6)) {
      case 0:
        return infix(" < ", kBinding, std::less<>(), depth);
      case 1:
        return infix("<=", kBinding, std::less_equal<>(), depth);
      case 2:
        return infix(" > ", kBinding, std::greater<>(), depth);
      case 3:
        return infix(">=", kBinding, std::greater_equal<>(), depth);
      case 4:
        return infix(" == ", kBinding, std::equal_to<>(), depth);
      default:
        return infix(" != ", kBinding, std::not_equal_to<>(), depth);
    }
  }

  Sample logical(int depth) {
    if (random_.chance(2)) {
      return infix(
          " && ", Binding::kAnd, [](double a, double b) { return a != 0 && b != 0; }, depth);
    }
    return infix(
        " || ", Binding::kOr, [](double a, double b) { return a != 0 || b != 0; }, depth);
  }

  Sample sign(int depth) {
    const Sample a = make(depth - 1);
    const std::string text = wrap(a, Binding::kUnary);
    if (random_.chance(3)) {
      return {"!" + text, [=](double x, double y) { return a.value(x, y) == 0 ? 1.0 : 0.0; },
              Binding::kUnary};
    }
    return {"-" + text, [=](double x, double y) { return -a.value(x, y); }, Binding::kUnary};
  }

  Sample conditional(int depth) {
    const Sample c = make(depth - 1);
    const Sample a = make(depth - 1);
    const Sample b = make(depth - 1);
    return {wrap(c, Binding::kOr) + " ? " + a.text + " : " + b.text,
            [=](double x, double y) { return c.value(x, y) != 0 ? a.value(x, y) : b.value(x, y); },
            Binding::kConditional};
  }

  Sample power(int depth) {
    static const std::vector<std::pair<std::string, double>> kExponents = {
        {"2", 2},   {"3", 3},     {"-1", -1},   {"-2", -2}, {"5", 5},   {"16", 16},
        {"-7", -7}, {"0.5", 0.5}, {"1.5", 1.5}, {"0", 0},   {"17", 17}, {"-17", -17}};
    const auto& [text, exponent] = kExponents[random_.below(kExponents.size())];
    const Sample a = make(depth - 1);
    const Sample b{text, [v = exponent](double, double) { return v; }};
    return {wrap(a, Binding::kAtom) + "^" + text, power_value(a, b), Binding::kPower};
  }

  static double product(double v, int n) {
    if (n == 1) return v;
    const double half = product(v, n / 2);
    return n % 2 == 0 ? half * half : half * half * v;
  }

  // Which definition holds depends on what is constant, and on that the engine is asked.
  static Function power_value(const Sample& a, const Sample& b) {
    const auto is_constant = [](const Sample& s) {
      return Expression::parse(s.text)->constant().has_value();
    };
    const double n = b.value(0, 0);
    if (is_constant(b) && n == 0.5) return one(expr::Op::kSqrt, a);
    if (is_constant(b) && n == std::floor(n) && std::abs(n) <= 16) {
      const int times = static_cast<int>(std::abs(n));
      return [=](double x, double y) {
        if (n == 0) return 1.0;
        const double value = product(a.value(x, y), times);
        return n > 0 ? value : 1 / value;
      };
    }
    if (is_constant(a) && a.value(0, 0) == std::numbers::e) return one(expr::Op::kExp, b);
    return two(expr::Op::kPow, a, b);
  }

  static Function one(expr::Op op, const Sample& a) {
    return [=](double x, double y) { return expr::apply(op, 0, a.value(x, y)); };
  }
  static Function two(expr::Op op, const Sample& a, const Sample& b) {
    return [=](double x, double y) { return expr::apply(op, a.value(x, y), b.value(x, y)); };
  }

  static double least(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? std::nan("") : a < b ? a : b;
  }
  static double most(double a, double b) {
    return std::isnan(a) || std::isnan(b) ? std::nan("") : a > b ? a : b;
  }

  Sample call(int depth) {
    using expr::Op;
    static const std::vector<std::pair<std::string, Op>> kOne = {
        {"sqrt", Op::kSqrt},   {"abs", Op::kAbs},   {"exp", Op::kExp},
        {"log", Op::kLog},     {"sin", Op::kSin},   {"cos", Op::kCos},
        {"floor", Op::kFloor}, {"ceil", Op::kCeil}, {"tan", Op::kTan}};
    const Sample a = make(depth - 1);
    if (random_.chance(2)) {
      const auto& [name, op] = kOne[random_.below(kOne.size())];
      return {name + "(" + a.text + ")", one(op, a)};
    }
    const Sample b = make(depth - 1);
    const std::string both = "(" + a.text + ", " + b.text;
    switch (random_.below(6)) {
      case 0:
        return {"atan2" + both + ")", two(Op::kAtan2, a, b)};
      case 1:
        return {"hypot" + both + ")", two(Op::kHypot, a, b)};
      case 2:
        return {"pow" + both + ")", power_value(a, b)};
      case 3:
        return {"min" + both + ")",
                [=](double x, double y) { return least(a.value(x, y), b.value(x, y)); }};
      case 4:
        return {"max" + both + ")",
                [=](double x, double y) { return most(a.value(x, y), b.value(x, y)); }};
      default: {
        const Sample c = make(depth - 1);
        return {"clamp" + both + "," + c.text + ")", [=](double x, double y) {
                  return least(most(a.value(x, y), b.value(x, y)), c.value(x, y));
                }};
      }
    }
  }

  Random& random_;
};

}  // namespace weft::testing
