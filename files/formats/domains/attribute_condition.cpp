// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/attribute_condition.h"

#include <algorithm>
#include <compare>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

using Truth = std::optional<bool>;  // nothing: unknown
using Test = std::function<Truth(const AttributeValues&)>;
using Operand = std::function<AttributeValue(const AttributeValues&)>;

constexpr int kMaxDepth = 64;  // of parentheses and NOT

// Thrown and caught in this file only.
struct Malformed {
  std::string what;
};

bool is_null(const AttributeValue& value) {
  return std::holds_alternative<std::monostate>(value);
}

// A text that is a number is compared with numbers as one.
std::optional<double> number_of(const AttributeValue& value) {
  if (const double* number = std::get_if<double>(&value)) return *number;
  const std::string* text = std::get_if<std::string>(&value);
  return text == nullptr ? std::nullopt : real_of(trimmed(*text));
}

std::optional<std::partial_ordering> compare(const AttributeValue& a, const AttributeValue& b) {
  const std::string* const text_a = std::get_if<std::string>(&a);
  const std::string* const text_b = std::get_if<std::string>(&b);
  if (text_a != nullptr && text_b != nullptr) {
    if (lower_case(*text_a) == lower_case(*text_b)) return std::partial_ordering::equivalent;
    return *text_a <=> *text_b;
  }
  const auto x = number_of(a);
  const auto y = number_of(b);
  if (!x || !y) return std::nullopt;
  return *x <=> *y;
}

// % stands for any text, _ for any character.
bool is_like(std::string_view text, std::string_view pattern) {
  std::size_t t = 0, p = 0, star = pattern.npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '%') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && (pattern[p] == '_' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != pattern.npos) {
      p = star + 1;
      t = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('%', p) == pattern.npos;
}

class Parser {
 public:
  Parser(std::string_view text, std::span<const std::string_view> attributes)
      : rest_(text), attributes_(attributes) {
    advance();
  }

  Test parse() {
    Test test = any(0);
    if (kind_ != Kind::kEnd) expected("AND, OR or the end");
    return test;
  }

 private:
  enum class Kind { kEnd, kWord, kQuoted, kText, kNumber, kSign };

  [[noreturn]] void expected(const std::string& what) const {
    throw Malformed{"expected " + what + ", found " +
                    (kind_ == Kind::kEnd ? "the end" : in_quotes(token_))};
  }

  void advance() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    const char c = rest_.empty() ? '\0' : rest_.front();
    constexpr std::string_view kDigits = "0123456789.";
    if (rest_.empty()) {
      kind_ = Kind::kEnd;
      token_.clear();
    } else if (c == '\'' || c == '"') {
      kind_ = c == '"' ? Kind::kQuoted : Kind::kText;
      take_quoted(c);
    } else if (kDigits.find(c) != kDigits.npos || ((c == '-' || c == '+') && rest_.size() > 1 &&
                                                   kDigits.find(rest_[1]) != kDigits.npos)) {
      kind_ = Kind::kNumber;
      take(std::min(rest_.find_first_not_of("0123456789.eE+-"), rest_.size()));
    } else if (const std::size_t end = rest_.find_first_of(" \t\r\n()=<>!,'\"+-"); end != 0) {
      kind_ = Kind::kWord;
      take(std::min(end, rest_.size()));
    } else {
      kind_ = Kind::kSign;
      constexpr std::string_view kPairs[] = {"<>", "!=", "<=", ">="};
      take(std::ranges::find(kPairs, rest_.substr(0, 2)) == std::end(kPairs) ? 1 : 2);
    }
  }
  void take(std::size_t size) {
    token_ = rest_.substr(0, size);
    rest_.remove_prefix(size);
  }
  // The mark itself is there twice.
  void take_quoted(char mark) {
    token_.clear();
    for (rest_.remove_prefix(1);; rest_.remove_prefix(1)) {
      if (rest_.empty()) throw Malformed{"a quotation mark is not closed"};
      if (rest_.front() == mark) {
        rest_.remove_prefix(1);
        if (rest_.empty() || rest_.front() != mark) return;
      }
      token_ += rest_.front();
    }
  }

  bool take_word(std::string_view word) {
    if (kind_ != Kind::kWord || lower_case(token_) != word) return false;
    advance();
    return true;
  }
  bool take_sign(std::string_view sign) {
    if (kind_ != Kind::kSign || token_ != sign) return false;
    advance();
    return true;
  }

  // Either of the two decides if it is `decisive`, whatever the other is.
  static Test joined(Test left, Test right, bool decisive) {
    return [=](const AttributeValues& values) -> Truth {
      const Truth x = left(values);
      const Truth y = right(values);
      if (x == decisive || y == decisive) return decisive;
      return x && y ? Truth(!decisive) : std::nullopt;
    };
  }
  Test any(int depth) {
    Test test = all(depth);
    while (take_word("or")) test = joined(std::move(test), all(depth), true);
    return test;
  }
  Test all(int depth) {
    Test test = single(depth);
    while (take_word("and")) test = joined(std::move(test), single(depth), false);
    return test;
  }
  static Test negated(Test test) {
    return [test = std::move(test)](const AttributeValues& values) -> Truth {
      const Truth x = test(values);
      return x ? Truth(!*x) : std::nullopt;
    };
  }
  Test single(int depth) {
    if (depth > kMaxDepth) throw Malformed{"is nested deeper than 64 levels"};
    if (take_word("not")) return negated(single(depth + 1));
    if (take_sign("(")) {
      Test test = any(depth + 1);
      if (!take_sign(")")) expected("')'");
      return test;
    }
    Operand left = operand();
    const bool is_negated = take_word("not");
    Test test = comparison(std::move(left), is_negated);
    return is_negated ? negated(std::move(test)) : test;
  }

  Operand operand() {
    AttributeValue value;
    if (kind_ == Kind::kWord || kind_ == Kind::kQuoted) {
      const auto found = std::ranges::find_if(attributes_, [&](std::string_view name) {
        return lower_case(name) == lower_case(token_);
      });
      if (found == attributes_.end()) throw Malformed{"there is no attribute " + in_quotes(token_)};
      const auto index = static_cast<std::size_t>(found - attributes_.begin());
      advance();
      return [index](const AttributeValues& values) { return values(index); };
    }
    if (kind_ == Kind::kText) {
      value = token_;
    } else if (const auto number = kind_ == Kind::kNumber ? real_of(token_) : std::nullopt) {
      value = *number;
    } else {
      expected("an attribute, a number or a text");
    }
    advance();
    return [value](const AttributeValues&) { return value; };
  }

  static Test ordered(Operand left, Operand right, bool (*holds)(std::partial_ordering)) {
    return [=](const AttributeValues& values) -> Truth {
      const auto order = compare(left(values), right(values));
      return order ? Truth(holds(*order)) : std::nullopt;
    };
  }

  Test comparison(Operand left, bool is_negated) {
    if (take_word("in")) return is_one_of(std::move(left));
    if (take_word("like")) return like(std::move(left), false);
    if (take_word("ilike")) return like(std::move(left), true);
    if (take_word("between")) return is_between(std::move(left));
    if (is_negated) expected("IN, LIKE, ILIKE or BETWEEN");
    if (take_word("is")) {
      const bool is_there = take_word("not");
      if (!take_word("null")) expected("NULL");
      return [left = std::move(left), is_there](const AttributeValues& values) -> Truth {
        return is_null(left(values)) != is_there;
      };
    }
    using Order = std::partial_ordering;
    constexpr std::pair<std::string_view, bool (*)(Order)> kSigns[] = {
        {"=", [](Order o) { return o == 0; }},  {"<>", [](Order o) { return o != 0; }},
        {"!=", [](Order o) { return o != 0; }}, {"<", [](Order o) { return o < 0; }},
        {"<=", [](Order o) { return o <= 0; }}, {">", [](Order o) { return o > 0; }},
        {">=", [](Order o) { return o >= 0; }}};
    for (const auto& [sign, holds] : kSigns)
      if (take_sign(sign)) return ordered(std::move(left), operand(), holds);
    expected("a comparison");
  }

  Test is_one_of(Operand left) {
    if (!take_sign("(")) expected("'('");
    std::vector<Operand> list;
    do list.push_back(operand());
    while (take_sign(","));
    if (!take_sign(")")) expected("')'");
    return
        [left = std::move(left), list = std::move(list)](const AttributeValues& values) -> Truth {
          const AttributeValue value = left(values);
          if (is_null(value)) return std::nullopt;
          return std::ranges::any_of(list, [&](const Operand& one) {
            const auto order = compare(value, one(values));
            return order && *order == 0;
          });
        };
  }

  Test like(Operand left, bool any_case) {
    if (kind_ != Kind::kText) expected("a text");
    std::string pattern = any_case ? lower_case(token_) : token_;
    advance();
    return [left = std::move(left), pattern = std::move(pattern),
            any_case](const AttributeValues& values) -> Truth {
      const AttributeValue value = left(values);
      const std::string* const text = std::get_if<std::string>(&value);
      if (text == nullptr) return std::nullopt;
      return is_like(any_case ? lower_case(*text) : *text, pattern);
    };
  }

  Test is_between(Operand left) {
    Operand low = operand();
    if (!take_word("and")) expected("AND");
    Operand high = operand();
    return [=](const AttributeValues& values) -> Truth {
      const AttributeValue value = left(values);
      const auto from = compare(value, low(values));
      const auto to = compare(value, high(values));
      return from && to ? Truth(*from >= 0 && *to <= 0) : std::nullopt;
    };
  }

  std::string_view rest_;
  std::span<const std::string_view> attributes_;
  Kind kind_ = Kind::kEnd;
  std::string token_;
};

}  // namespace

Result<AttributeCondition> AttributeCondition::parse(std::string_view text,
                                                     std::span<const std::string_view> attributes) {
  AttributeCondition condition;
  if (trimmed(text).empty()) return condition;
  try {
    condition.test_ = Parser(text, attributes).parse();
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, malformed.what);
  }
  return condition;
}

}  // namespace weft::files
