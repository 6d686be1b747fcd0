// SPDX-License-Identifier: Apache-2.0
#include "checker/size/size_expression.h"

#include <muParserBase.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "checker/text.h"

namespace weft::check {
namespace {

// The character classes of the grammar, whatever the locale.
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

// Bytes of the number that `text` starts with: digits, fraction, exponent; 0 if there is none.
std::size_t number_length(std::string_view text) {
  std::size_t i = 0;
  std::size_t digits = 0;
  while (i < text.size() && is_digit(text[i])) ++i, ++digits;
  if (i < text.size() && text[i] == '.') {
    ++i;
    while (i < text.size() && is_digit(text[i])) ++i, ++digits;
  }
  if (digits == 0) return 0;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t j = i + 1;
    if (j < text.size() && (text[j] == '+' || text[j] == '-')) ++j;
    if (j < text.size() && is_digit(text[j])) {
      while (j < text.size() && is_digit(text[j])) ++j;
      i = j;
    }
  }
  return i;
}

// The hook of muParser that reads a number at the start of the text.
int read_number(const char* text, int* position, double* value) {
  const std::size_t length = number_length(text);
  if (length == 0) return 0;
  std::from_chars(text, text + length, *value);
  *position += static_cast<int>(length);
  return 1;
}

constexpr std::size_t kMaxNameLength = 64;
constexpr std::array<std::string_view, 22> kNames = {
    "x",     "y",   "pi",    "e",     "sqrt",    "abs",     "exp",  "log",
    "sin",   "cos", "tan",   "min",   "max",     "floor",   "ceil", "atan2",
    "hypot", "pow", "clamp", "slope", "defined", "coalesce"};

bool is_known(std::string_view name) {
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

// Bytes of the name that `text` starts with; 0 if there is none.
std::size_t name_length(std::string_view text) {
  if (text.empty() || !is_letter(text[0])) return 0;
  std::size_t length = 1;
  while (length < text.size() && (is_letter(text[length]) || is_digit(text[length]))) ++length;
  return length;
}

std::size_t blank_length(std::string_view text) {
  return std::min(text.find_first_not_of(" \t\n\r"), text.size());
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// In muParser, the slope of a field is a variable with a name that no field can have.
constexpr char kSlope = '$';
constexpr std::array<std::string_view, 19> kSymbols = {"<=", ">=", "==", "!=", "&&", "||", "+",
                                                       "-",  "*",  "/",  "^",  "<",  ">",  "!",
                                                       "?",  ":",  "(",  ")",  ","};

// A run of unary operators amounts to at most one -, and at most two !.
class UnaryRun {
 public:
  void add(char operation) { operations_ += operation; }
  bool empty() const { return operations_.empty(); }
  void clear() { operations_.clear(); }
  std::string folded() const {
    bool minus = false;
    std::size_t nots = 0;
    for (auto c = operations_.rbegin(); c != operations_.rend(); ++c) {
      if (*c == '-') minus = !minus;
      if (*c == '!') {
        minus = false;  // a number is 0 or not, whatever its sign
        nots = nots == 2 ? 1 : nots + 1;
      }
    }
    std::string result;
    if (minus) result += '-';
    return result.append(nots, '!');
  }

 private:
  std::string operations_;
};

// Translates a source into what muParser reads as the grammar means it. What the grammar lacks is
// refused, because muParser would accept more, such as a < b < c. Runs of unary operators, which it
// does not accept, are folded. White space becomes blanks, but a function moves next to its
// parenthesis. All other tokens keep their columns.
class Translator {
 public:
  Translator(std::string_view source, std::span<const Field> fields)
      : source_(source), text_(source.size(), ' ') {
    for (const Field& field : fields) fields_.insert(field.name);
  }

  // The variables other than x and y in the last translation, sorted.
  const std::set<std::string>& used() const { return used_; }

  tl::expected<std::string, std::string> translate() {
    UnaryRun run;
    bool operand_next = true;  // so that + - ! are unary
    std::string_view name;     // the last token, if it is a name
    std::size_t i = 0;
    while (i < source_.size()) {
      if (const std::size_t blanks = blank_length(source_.substr(i)); blanks > 0) {
        i += blanks;
        continue;
      }
      if (const auto slope = slope_at(i)) {
        if (slope->name.empty())
          return tl::unexpected(say("slope takes the name of a field, at column ", i + 1));
        operand(i, kSlope + slope->name, run);
        used_.insert(kSlope + slope->name);
        operand_next = false;
        name = {};
        i += slope->length;
        continue;
      }
      const auto length = token_length(i);
      if (!length) return tl::unexpected(length.error());
      const std::string_view token = source_.substr(i, *length);
      if (fields_.contains(token)) used_.emplace(token);
      if (chains(token)) return tl::unexpected(say("comparisons do not chain, at column ", i + 1));
      if (token == "(" && !name.empty()) {
        text_.replace(static_cast<std::size_t>(name.data() - source_.data()), name.size(),
                      name.size(), ' ');
        text_.replace(i - name.size(), name.size(), name);
      }
      name = is_letter(token[0]) ? token : std::string_view();
      if (operand_next && (token == "+" || token == "-" || token == "!")) {
        run.add(token[0]);
      } else {
        operand(i, token, run);
        const char last = token.back();
        operand_next = !is_digit(last) && !is_letter(last) && last != '.' && last != ')';
      }
      i += *length;
    }
    if (!run.empty()) return tl::unexpected(std::string("it ends with an operator"));
    return std::move(text_);
  }

 private:
  struct Slope {
    std::string name;  // of the field; empty if it is none
    std::size_t length;
  };

  // Whether the slope of a field begins at i.
  std::optional<Slope> slope_at(std::size_t i) const {
    std::string_view rest = source_.substr(i);
    if (rest.substr(0, name_length(rest)) != "slope") return std::nullopt;
    const auto skip = [&](std::size_t bytes) {
      rest.remove_prefix(bytes);
      rest.remove_prefix(blank_length(rest));
    };
    skip(name_length(rest));
    if (!rest.starts_with('(')) return Slope{"", 0};
    skip(1);
    const std::string_view name = rest.substr(0, name_length(rest));
    skip(name.size());
    if (!fields_.contains(name) || !rest.starts_with(')')) return Slope{"", 0};
    return Slope{std::string(name), source_.size() - i - rest.size() + 1};
  }

  // Writes what a run of unary operators, and the token at i after it, amount to.
  void operand(std::size_t i, std::string_view token, UnaryRun& run) {
    const std::string unary = run.folded();
    text_.replace(i - unary.size(), unary.size(), unary);
    text_.replace(i, token.size(), token);
    run.clear();
  }

  // Whether the token would compare the result of a comparison without parentheses between.
  bool chains(std::string_view token) {
    if (token == "(") compared_.push_back(false);
    if (token == ")" && compared_.size() > 1) compared_.pop_back();
    if (token == "&&" || token == "||" || token == "?" || token == ":" || token == ",")
      compared_.back() = false;
    if (token != "<" && token != "<=" && token != ">" && token != ">=" && token != "==" &&
        token != "!=")
      return false;
    const bool twice = compared_.back();
    compared_.back() = true;
    return twice;
  }

  tl::expected<std::size_t, std::string> token_length(std::size_t i) const {
    const auto refuse = [i](const auto&... parts) {
      return tl::unexpected(say(parts..., " at column ", i + 1));
    };
    const std::string_view rest = source_.substr(i);
    if (const std::size_t length = number_length(rest); length > 0) {
      double value = 0;
      if (std::from_chars(rest.data(), rest.data() + length, value).ec != std::errc())
        return refuse("a number that no double holds");
      if (length < rest.size() && (is_letter(rest[length]) || rest[length] == '.'))
        return refuse("a number that does not end");
      return length;
    }
    if (const std::size_t length = name_length(rest); length > 0) {
      const std::string_view name = rest.substr(0, length);
      if (!is_known(name) && !fields_.contains(name)) return refuse("unknown name '", name, "'");
      return length;
    }
    const auto symbol =
        std::find_if(kSymbols.begin(), kSymbols.end(),
                     [&](std::string_view candidate) { return rest.starts_with(candidate); });
    if (symbol == kSymbols.end()) return refuse("unexpected '", rest.substr(0, 1), "'");
    return symbol->size();
  }

  std::string_view source_;
  std::string text_;
  std::set<std::string_view> fields_;  // names
  std::set<std::string> used_;
  std::vector<bool> compared_{false};  // per open parenthesis: whether its operand is a comparison
};

// muParser with nothing but the grammar's functions, constants and unary operators. The binary
// operators are its built-in ones, whose precedence and association are the grammar's.
class GrammarParser : public mu::ParserBase {
 public:
  GrammarParser() {
    InitCharSets();
    InitFun();
    InitConst();
    InitOprt();
    AddValIdent(read_number);
    EnableOptimizer(false);  // because it reorders arithmetic
  }

 protected:
  void InitCharSets() override {
    DefineNameChars("$0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    DefineOprtChars("+-*^/?<>=!&|");
    DefineInfixOprtChars("-!");
  }
  void InitFun() override {
    using Unary = double (*)(double);
    using Binary = double (*)(double, double);
    using Variadic = double (*)(const double*, int);
    DefineFun("sqrt", static_cast<Unary>(std::sqrt));
    DefineFun("abs", static_cast<Unary>(std::fabs));
    DefineFun("exp", static_cast<Unary>(std::exp));
    DefineFun("log", static_cast<Unary>(std::log));
    DefineFun("sin", static_cast<Unary>(std::sin));
    DefineFun("cos", static_cast<Unary>(std::cos));
    DefineFun("tan", static_cast<Unary>(std::tan));
    DefineFun("floor", static_cast<Unary>(std::floor));
    DefineFun("ceil", static_cast<Unary>(std::ceil));
    DefineFun("pow", static_cast<Binary>(std::pow));
    DefineFun("atan2", static_cast<Binary>(std::atan2));
    DefineFun("hypot", static_cast<Binary>(std::hypot));
    DefineFun("min", static_cast<Variadic>(minimum));
    DefineFun("max", static_cast<Variadic>(maximum));
    DefineFun("defined", static_cast<Unary>([](double v) { return std::isnan(v) ? 0.0 : 1.0; }));
    DefineFun("coalesce", static_cast<Variadic>(coalesce));
    DefineFun("clamp", static_cast<double (*)(double, double, double)>(clamp));
  }
  void InitConst() override {
    DefineConst("pi", std::numbers::pi);
    DefineConst("e", std::numbers::e);
  }
  void InitOprt() override {
    DefineInfixOprt("-", [](double v) { return -v; });
    DefineInfixOprt("!", [](double v) { return v == 0 ? 1.0 : 0.0; });
    DefineInfixOprt("!!", [](double v) { return v == 0 ? 0.0 : 1.0; });
    DefineInfixOprt("-!", [](double v) { return v == 0 ? -1.0 : 0.0; });
    DefineInfixOprt("-!!", [](double v) { return v == 0 ? 0.0 : -1.0; });
  }

 private:
  // One argument is refused: the grammar wants two or more.
  static void require_two(int count) {
    if (count < 2) throw mu::ParserError("min, max and coalesce take two arguments or more");
  }
  static bool any_nan(const double* values, int count) {
    return std::any_of(values, values + count, [](double v) { return std::isnan(v); });
  }
  static double minimum(const double* values, int count) {
    require_two(count);
    return any_nan(values, count) ? kNan : *std::min_element(values, values + count);
  }
  static double maximum(const double* values, int count) {
    require_two(count);
    return any_nan(values, count) ? kNan : *std::max_element(values, values + count);
  }
  static double coalesce(const double* values, int count) {
    require_two(count);
    const double* const end = values + count;
    const double* const found = std::find_if(values, end, [](double v) { return !std::isnan(v); });
    return found == end ? kNan : *found;
  }
  static double clamp(double value, double low, double high) {
    if (std::isnan(value) || std::isnan(low) || std::isnan(high)) return kNan;
    return std::min(std::max(value, low), high);
  }
};

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
    if (is_known(name))
      return say("the name of field ", i, " is '", name, "', which means something else");
    if (!seen.insert(name).second) return say("two fields have the name '", name, "'");
  }
  return std::nullopt;
}

struct SizeExpression::Evaluator {
  struct Input {
    std::function<double(Vec2)> field;
    double value = 0;
  };

  GrammarParser parser;
  double x = 0;
  double y = 0;
  std::deque<Input> inputs;  // stay where they are

  // Returns the name of a field without a value, if there is one.
  std::optional<std::string> define(const std::set<std::string>& used,
                                    std::span<const Field> fields) {
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    for (const Field& field : fields) {
      for (const bool slope : {false, true}) {
        const std::string name = slope ? kSlope + field.name : field.name;
        if (!used.contains(name)) continue;
        inputs.push_back({slope ? field.slope : field.value});
        if (!inputs.back().field) return field.name;
        parser.DefineVar(name, &inputs.back().value);
      }
    }
    return std::nullopt;
  }
};

SizeExpression::SizeExpression(std::unique_ptr<Evaluator> evaluator)
    : evaluator_(std::move(evaluator)) {}
SizeExpression::SizeExpression(SizeExpression&&) noexcept = default;
SizeExpression& SizeExpression::operator=(SizeExpression&&) noexcept = default;
SizeExpression::~SizeExpression() = default;

tl::expected<SizeExpression, std::string> SizeExpression::parse(std::string_view source,
                                                                std::span<const Field> fields) {
  if (source.size() > kMaxLength)
    return tl::unexpected(say("the size expression has ", source.size(),
                              " bytes, the checker reads at most ", kMaxLength));
  Translator translator(source, fields);
  const auto text = translator.translate();
  if (!text) return tl::unexpected(say("the size expression does not parse: ", text.error()));
  try {
    auto evaluator = std::make_unique<Evaluator>();
    if (const auto name = evaluator->define(translator.used(), fields))
      return tl::unexpected(say("the checker cannot judge sizes that use the field ", *name));
    evaluator->parser.SetExpr(*text);
    int results = 0;
    evaluator->parser.Eval(results);
    if (results != 1) return tl::unexpected(say("the size expression has ", results, " values"));
    return SizeExpression(std::move(evaluator));
  } catch (const mu::ParserError& error) {
    return tl::unexpected(say("the size expression does not parse: ", error.GetMsg()));
  }
}

double SizeExpression::operator()(Vec2 p) const noexcept {
  evaluator_->x = p.x;
  evaluator_->y = p.y;
  for (Evaluator::Input& input : evaluator_->inputs) input.value = input.field(p);
  try {
    return evaluator_->parser.Eval();
  } catch (const mu::ParserError&) {
    return kNan;
  }
}

}  // namespace weft::check
