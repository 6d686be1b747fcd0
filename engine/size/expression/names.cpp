// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/names.h"

#include <algorithm>
#include <array>
#include <vector>

#include "engine/size/expression/source_position.h"

namespace weft::expr {

namespace {

constexpr std::array<Function, 18> kFunctions = {{
    {"sqrt", 1, 1, Op::kSqrt},
    {"abs", 1, 1, Op::kAbs},
    {"exp", 1, 1, Op::kExp},
    {"log", 1, 1, Op::kLog},
    {"sin", 1, 1, Op::kSin},
    {"cos", 1, 1, Op::kCos},
    {"tan", 1, 1, Op::kTan},
    {"floor", 1, 1, Op::kFloor},
    {"ceil", 1, 1, Op::kCeil},
    {"pow", 2, 2, std::nullopt},
    {"atan2", 2, 2, Op::kAtan2},
    {"hypot", 2, 2, Op::kHypot},
    {"min", 2, std::nullopt, Op::kMin},
    {"max", 2, std::nullopt, Op::kMax},
    {"clamp", 3, 3, std::nullopt},
    {"slope", 1, 1, std::nullopt},
    {"defined", 1, 1, Op::kDefined},
    {"coalesce", 2, std::nullopt, Op::kCoalesce},
}};

constexpr std::array<std::string_view, 4> kValues = {"x", "y", "pi", "e"};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Levenshtein's distance, letter case ignored.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string> fields) {
  constexpr std::size_t kLongest = 64;  // names of fields are no longer
  if (name.size() > kLongest) return std::nullopt;
  std::optional<std::string_view> best;
  std::size_t best_distance = (name.size() + 2) / 3;  // one error per three letters
  if (name.size() == 1) best_distance = 1;
  const auto consider = [&](std::string_view candidate) {
    // One wrong letter alone is no misspelling: z is not a misspelt x.
    const std::size_t d = distance(name, candidate);
    if (d < best_distance || (d == best_distance && !best && name.size() > 1)) {
      best = candidate;
      best_distance = d;
    }
  };
  for (const std::string& field : fields) consider(field);
  for (const Function& function : kFunctions) consider(function.name);
  for (std::string_view value : kValues) consider(value);
  return best;
}

}  // namespace

const Function* find_function(std::string_view name) {
  const auto* found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                   [&](const Function& f) { return f.name == name; });
  return found == kFunctions.end() ? nullptr : found;
}

bool is_taken(std::string_view name) {
  return find_function(name) != nullptr ||
         std::find(kValues.begin(), kValues.end(), name) != kValues.end();
}

std::string explain_unknown(std::string_view name, std::span<const std::string> fields) {
  if (name == "and") return "unexpected 'and'; logical and is written &&";
  if (name == "or") return "unexpected 'or'; logical or is written ||";
  if (name == "not") return "unexpected 'not'; logical not is written !";
  std::string text = "unknown name " + quoted(name);
  if (const auto near = nearest(name, fields))
    return text + "; did you mean " + quoted(*near) + "?";
  if (fields.empty()) return text + "; the variables are x and y";
  text += "; the variables are x, y";
  for (const std::string& field : fields)
    text += &field == &fields.back() ? " and " + field : ", " + field;
  return text;
}

}  // namespace weft::expr
