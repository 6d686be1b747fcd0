// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size_expression.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "checker/text.h"

namespace weft::check {
namespace {

using Values = const double*;
using Operation = double (*)(Values, std::size_t);

constexpr std::size_t kMaxNameLength = 64;
constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool any_nan(Values v, std::size_t n) {
  return std::any_of(v, v + n, [](double of) { return std::isnan(of); });
}

struct Binary {
  std::string_view symbol;
  int level;  // how tight it binds
  Operation function;
};

// Longer symbols before those that they start with.
constexpr int kComparison = 3;
constexpr std::array<Binary, 12> kBinary = {{
    {"||", 1, [](Values v, std::size_t) { return v[0] != 0 || v[1] != 0 ? 1.0 : 0.0; }},
    {"&&", 2, [](Values v, std::size_t) { return v[0] != 0 && v[1] != 0 ? 1.0 : 0.0; }},
    {"<=", kComparison, [](Values v, std::size_t) { return v[0] <= v[1] ? 1.0 : 0.0; }},
    {">=", kComparison, [](Values v, std::size_t) { return v[0] >= v[1] ? 1.0 : 0.0; }},
    {"==", kComparison, [](Values v, std::size_t) { return v[0] == v[1] ? 1.0 : 0.0; }},
    {"!=", kComparison, [](Values v, std::size_t) { return v[0] != v[1] ? 1.0 : 0.0; }},
    {"<", kComparison, [](Values v, std::size_t) { return v[0] < v[1] ? 1.0 : 0.0; }},
    {">", kComparison, [](Values v, std::size_t) { return v[0] > v[1] ? 1.0 : 0.0; }},
    {"+", 4, [](Values v, std::size_t) { return v[0] + v[1]; }},
    {"-", 4, [](Values v, std::size_t) { return v[0] - v[1]; }},
    {"*", 5, [](Values v, std::size_t) { return v[0] * v[1]; }},
    {"/", 5, [](Values v, std::size_t) { return v[0] / v[1]; }},
}};
constexpr Operation kPower = [](Values v, std::size_t) { return std::pow(v[0], v[1]); };
constexpr Operation kMinus = [](Values v, std::size_t) { return -v[0]; };
constexpr Operation kNot = [](Values v, std::size_t) { return v[0] == 0 ? 1.0 : 0.0; };
constexpr Operation kChoose = [](Values v, std::size_t) { return v[0] != 0 ? v[1] : v[2]; };

struct Named {
  std::string_view name;
  std::size_t fewest;  // arguments
  std::size_t most;
  Operation function;
};

constexpr std::array<Named, 17> kFunctions = {{
    {"sqrt", 1, 1, [](Values v, std::size_t) { return std::sqrt(v[0]); }},
    {"abs", 1, 1, [](Values v, std::size_t) { return std::fabs(v[0]); }},
    {"exp", 1, 1, [](Values v, std::size_t) { return std::exp(v[0]); }},
    {"log", 1, 1, [](Values v, std::size_t) { return std::log(v[0]); }},
    {"sin", 1, 1, [](Values v, std::size_t) { return std::sin(v[0]); }},
    {"cos", 1, 1, [](Values v, std::size_t) { return std::cos(v[0]); }},
    {"tan", 1, 1, [](Values v, std::size_t) { return std::tan(v[0]); }},
    {"floor", 1, 1, [](Values v, std::size_t) { return std::floor(v[0]); }},
    {"ceil", 1, 1, [](Values v, std::size_t) { return std::ceil(v[0]); }},
    {"defined", 1, 1, [](Values v, std::size_t) { return std::isnan(v[0]) ? 0.0 : 1.0; }},
    {"pow", 2, 2, kPower},
    {"atan2", 2, 2, [](Values v, std::size_t) { return std::atan2(v[0], v[1]); }},
    {"hypot", 2, 2, [](Values v, std::size_t) { return std::hypot(v[0], v[1]); }},
    {"clamp", 3, 3,
     [](Values v, std::size_t n) {
       return any_nan(v, n) ? kNan : std::min(std::max(v[0], v[1]), v[2]);
     }},
    {"min", 2, kAny,
     [](Values v, std::size_t n) { return any_nan(v, n) ? kNan : *std::min_element(v, v + n); }},
    {"max", 2, kAny,
     [](Values v, std::size_t n) { return any_nan(v, n) ? kNan : *std::max_element(v, v + n); }},
    {"coalesce", 2, kAny,
     [](Values v, std::size_t n) {
       const auto* const found = std::find_if(v, v + n, [](double of) { return !std::isnan(of); });
       return found == v + n ? kNan : *found;
     }},
}};
constexpr std::array<std::string_view, 5> kOtherNames = {"x", "y", "pi", "e", "slope"};

const Named* function_named(std::string_view name) {
  const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                         [&](const Named& f) { return f.name == name; });
  return found == kFunctions.end() ? nullptr : found;
}

// The character classes of the grammar, whatever the locale.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

// Bytes of the name that `text` starts with; 0 if there is none.
std::size_t name_length(std::string_view text) {
  if (text.empty() || !is_letter(text[0])) return 0;
  std::size_t length = 1;
  while (length < text.size() && (is_letter(text[length]) || is_digit(text[length]))) ++length;
  return length;
}

}  // namespace

std::optional<std::string> fault_of_names(std::span<const Field> fields) {
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view name = fields[i].name;
    if (name.size() > kMaxNameLength)
      return say("the name of field ", i, " has ", name.size(), " bytes, the limit is ",
                 kMaxNameLength);
    if (name.empty() || name_length(name) != name.size())
      return say("the name of field ", i, " is '", name, "', which is no name");
    if (function_named(name) != nullptr ||
        std::find(kOtherNames.begin(), kOtherNames.end(), name) != kOtherNames.end())
      return say("the name of field ", i, " is '", name, "', which means something else");
    if (!seen.insert(name).second) return say("two fields have the name '", name, "'");
  }
  return std::nullopt;
}

// Reads an expression from the left: an operand, then operators that bind tight enough, each with
// the operand to its right (V. Pratt, "Top down operator precedence", 1973). A step is added for
// each once its operands' steps are there. Throws Fault.
class ExpressionReader {
 public:
  struct Fault {
    std::string what;
  };

  ExpressionReader(std::string_view source, std::span<const Field> fields)
      : source_(source), fields_(fields) {
    made_.inputs_ = {[](Vec2 p) { return p.x; }, [](Vec2 p) { return p.y; }};
  }

  SizeExpression read() {
    choice(0);
    if (at_ < source_.size()) refuse("unexpected ", found());
    return std::move(made_);
  }

 private:
  template <class... Parts>
  [[noreturn]] void refuse_at(std::size_t at, const Parts&... parts) const {
    throw Fault{say("the size expression does not parse: ", parts..., " at column ", at + 1)};
  }
  template <class... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    refuse_at(at_, parts...);
  }
  std::string found() const {
    return at_ < source_.size() ? say("'", source_.substr(at_, 1), "'") : "end";
  }
  std::string_view rest() {
    at_ = std::min(source_.find_first_not_of(" \t\n\r", at_), source_.size());
    return source_.substr(at_);
  }
  bool accept(std::string_view symbol) {
    if (!rest().starts_with(symbol)) return false;
    at_ += symbol.size();
    return true;
  }
  void expect(std::string_view symbol) {
    if (!accept(symbol)) refuse("expected '", symbol, "' instead of ", found());
  }
  void add(Operation function, std::size_t operands) {
    made_.steps_.push_back({.function = function, .operands = operands});
  }
  void push(double number) { made_.steps_.push_back({.number = number}); }

  void choice(std::size_t depth) {
    std::size_t choices = 0;
    for (operators(1, depth); accept("?"); operators(1, depth), ++choices) {
      choice(depth + 1);
      expect(":");
    }
    for (; choices > 0; --choices) add(kChoose, 3);
  }

  const Binary* operator_here() {
    const std::string_view text = rest();
    const auto* const found = std::find_if(kBinary.begin(), kBinary.end(), [&](const Binary& b) {
      return text.starts_with(b.symbol);
    });
    return found == kBinary.end() ? nullptr : found;
  }

  void operators(int loosest, std::size_t depth) {
    operand(depth);
    bool compared = false;
    for (const Binary* next = operator_here(); next != nullptr && next->level >= loosest;
         next = operator_here()) {
      if (compared && next->level == kComparison) refuse("comparisons do not chain,");
      compared = next->level == kComparison;
      at_ += next->symbol.size();
      operators(next->level + 1, depth);
      add(next->function, 2);
    }
  }

  // With its unary operators and its exponent.
  void operand(std::size_t depth) {
    if (depth > SizeExpression::kMaxDepth) refuse("too many parentheses and signs");
    if (accept("+")) return operand(depth + 1);
    for (const auto& [sign, function] : {std::pair("-", kMinus), std::pair("!", kNot)}) {
      if (!accept(sign)) continue;
      operand(depth + 1);
      return add(function, 1);
    }
    if (accept("(")) {
      choice(depth + 1);
      expect(")");
    } else if (const std::size_t length = name_length(rest()); length > 0) {
      named(source_.substr(at_, length), depth);
    } else {
      number();
    }
    if (!accept("^")) return;
    operand(depth + 1);
    add(kPower, 2);
  }

  void number() {
    const std::string_view text = rest();
    double value = 0;
    const bool begins = !text.empty() && (is_digit(text[0]) || text[0] == '.');
    const auto [end, error] =
        begins ? std::from_chars(text.data(), text.data() + text.size(), value)
               : std::from_chars_result{text.data(), std::errc::invalid_argument};
    if (error == std::errc::result_out_of_range) refuse("a number that no double holds");
    if (error != std::errc()) refuse("unexpected ", found());
    const auto length = static_cast<std::size_t>(end - text.data());
    if (length < text.size() && (is_letter(text[length]) || text[length] == '.'))
      refuse("a number that does not end");
    at_ += length;
    push(value);
  }

  void named(std::string_view name, std::size_t depth) {
    const auto field = std::find_if(fields_.begin(), fields_.end(),
                                    [&](const Field& f) { return f.name == name; });
    const Named* const function = function_named(name);
    if (field == fields_.end() && function == nullptr &&
        std::find(kOtherNames.begin(), kOtherNames.end(), name) == kOtherNames.end())
      refuse("unknown name '", name, "'");
    at_ += name.size();
    if (field != fields_.end()) return input(*field, field->value);
    if (function != nullptr) return call(*function, depth, at_ - name.size());
    if (name == "slope") return slope(at_ - name.size());
    if (name == "pi" || name == "e") return push(name == "pi" ? std::numbers::pi : std::numbers::e);
    made_.steps_.push_back({.input = name == "x" ? 0 : 1});
  }

  void call(const Named& function, std::size_t depth, std::size_t start) {
    expect("(");
    std::size_t arguments = 0;
    do {
      choice(depth + 1);
      ++arguments;
    } while (accept(","));
    expect(")");
    if (arguments < function.fewest || arguments > function.most)
      refuse_at(start, function.name, " does not take ", arguments, " arguments,");
    add(function.function, arguments);
  }

  void slope(std::size_t start) {
    expect("(");
    const std::string_view name = rest().substr(0, name_length(rest()));
    const auto field = std::find_if(fields_.begin(), fields_.end(),
                                    [&](const Field& f) { return f.name == name; });
    if (field == fields_.end()) refuse_at(start, "slope takes the name of a field,");
    at_ += name.size();
    expect(")");
    input(*field, field->slope);
  }

  void input(const Field& field, const std::function<double(Vec2)>& of) {
    if (!of) throw Fault{say("the checker cannot judge sizes that use the field ", field.name)};
    made_.steps_.push_back({.input = made_.inputs_.size()});
    made_.inputs_.push_back(of);
  }

  std::string_view source_;
  std::span<const Field> fields_;
  std::size_t at_ = 0;
  SizeExpression made_;
};

tl::expected<SizeExpression, std::string> SizeExpression::parse(std::string_view source,
                                                                std::span<const Field> fields) {
  try {
    return ExpressionReader(source, fields).read();
  } catch (ExpressionReader::Fault& fault) {
    return tl::unexpected(std::move(fault.what));
  }
}

double SizeExpression::operator()(Vec2 p) const noexcept {
  stack_.clear();
  for (const Step& step : steps_) {
    if (step.function == nullptr) {
      stack_.push_back(step.input ? inputs_[*step.input](p) : step.number);
      continue;
    }
    const std::size_t first = stack_.size() - step.operands;
    const double value = step.function(stack_.data() + first, step.operands);
    stack_.resize(first);
    stack_.push_back(value);
  }
  return stack_.back();
}

}  // namespace weft::check
