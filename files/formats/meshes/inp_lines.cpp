// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/inp_lines.h"

#include "files/base/words.h"

namespace weft::files {
namespace {

// Without blanks and quotation marks, but with the blanks between these.
std::vector<std::string> split(std::string_view text, char at) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : text) {
    if (c == '"')
      quoted = !quoted;
    else if (c == at && !quoted)
      fields.emplace_back();
    else if (quoted || trimmed({&c, 1}).size() == 1)
      fields.back() += c;
  }
  return fields;
}

bool is_letter(char c) {
  return (c | 0x20) >= 'a' && (c | 0x20) <= 'z';
}

}  // namespace

std::string InpKeyword::value(const std::string& parameter) const {
  const auto found = parameters.find(parameter);
  return found != parameters.end() ? found->second : "";
}

bool InpLines::next() {
  if (std::exchange(is_read_ahead_, false)) return true;
  while (scanner_.try_next_line())
    if (!scanner_.rest_of_line().starts_with("**")) return true;
  return false;
}

bool InpLines::has_empty_field() const {
  bool after_comma = false;
  for (const char c : scanner_.rest_of_line()) {
    if (c == ',' && after_comma) return true;
    after_comma = c == ',' || (after_comma && trimmed({&c, 1}).empty());
  }
  return false;
}

bool InpLines::goes_on() const {
  return trimmed(scanner_.rest_of_line()).ends_with(',');
}

InpKeyword InpLines::keyword() {
  std::string text(scanner_.rest_of_line());
  while (trimmed(text).ends_with(',') && next()) {
    is_read_ahead_ = !is_letter(scanner_.rest_of_line().front());
    if (is_read_ahead_) break;
    text += scanner_.rest_of_line();
  }
  const std::vector<std::string> words = split(text, ',');
  InpKeyword keyword{lower_case(words.front()), {}};
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    keyword.parameters.emplace(lower_case(words[i].substr(0, equals)),
                               equals == std::string::npos ? "" : words[i].substr(equals + 1));
  }
  return keyword;
}

std::vector<std::string> InpLines::fields() const {
  std::vector<std::string> fields = split(scanner_.rest_of_line(), ',');
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

}  // namespace weft::files
