// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/delimited_text.h"

#include <algorithm>
#include <utility>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

using Separator = DelimitedText::Separator;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

// Past the quotation mark that closes the one at `open`; npos if none does.
std::size_t end_of_quoted(std::string_view text, std::size_t open) {
  for (std::size_t at = open + 1; (at = text.find('"', at)) != std::string_view::npos; at += 2) {
    if (at + 1 < text.size() && text[at + 1] == '"') continue;
    const bool ends = at + 1 == text.size() || is_blank(text[at + 1]) ||
                      std::string_view(",;\n").find(text[at + 1]) != std::string_view::npos;
    return ends ? at + 1 : std::string_view::npos;
  }
  return std::string_view::npos;
}

// The line without what is in quotation marks.
std::string unquoted_parts(std::string_view line) {
  std::string out;
  bool at_start = true;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && at_start) {
      i = std::min(end_of_quoted(line, i), line.size()) - 1;
      out += '"';
      at_start = false;
      continue;
    }
    at_start = is_blank(line[i]) || line[i] == ',' || line[i] == ';';
    out += line[i];
  }
  return out;
}

// Whether the words between blanks are two or more, and commas stand in numbers only.
bool has_decimal_commas(std::string_view line) {
  std::size_t words = 0;
  while (!(line = trimmed(line)).empty()) {
    const std::string_view word(line.begin(), std::find_if(line.begin(), line.end(), is_blank));
    line.remove_prefix(word.size());
    ++words;
    if (word.find(',') != std::string_view::npos &&
        (word.back() == ',' || !real_with_comma_of(word)))
      return false;
  }
  return words >= 2;
}

bool is_number_or_nan(std::string_view word) {
  return real_of(word) || real_with_comma_of(word) || is_nan_text(word);
}

std::string_view first_word(std::string_view line) {
  std::string_view word = trimmed(line);
  if (word.starts_with('"')) return trimmed(word.substr(1, word.find('"', 1) - 1));
  word = word.substr(0, word.find_first_of(" \t;"));
  // Of "1,2" as a first word, the 1 says enough.
  return is_number_or_nan(word) ? word : word.substr(0, word.find(','));
}

std::optional<Separator> separator_of_names(std::string_view unquoted) {
  for (const auto& [mark, separator] :
       {std::pair{';', Separator::kSemicolon}, {'\t', Separator::kTab}, {',', Separator::kComma}})
    if (unquoted.find(mark) != std::string_view::npos) return separator;
  return std::nullopt;
}

}  // namespace

bool is_nan_text(std::string_view text) {
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  const std::string word = lower_case(text.substr(0, 16));
  constexpr std::string_view kNames[] = {"nan",      "na",        "nan(ind)", "nan(snan)",
                                         "1.#qnan",  "1.#ind",    "1.#nan",   "1.#qnan0",
                                         "1.#ind00", "1.#qnan00", "nan0"};
  return std::find(std::begin(kNames), std::end(kNames), word) != std::end(kNames);
}

std::string DelimitedText::Field::value() const {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    out += text[i];
    if (quoted && text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') ++i;
  }
  return out;
}

tl::unexpected<Error> DelimitedText::error(std::uint64_t line, std::size_t column,
                                           const std::string& message) const {
  return fail(ExitCode::kUnreadableInput,
              name_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message);
}

std::optional<double> DelimitedText::real(const Field& field) const {
  const bool decimal_comma = separator_ != Separator::kComma || field.quoted;
  return decimal_comma ? real_with_comma_of(trimmed(field.text)) : real_of(field.text);
}

// The next line, and those after it that its quotation marks reach into.
Result<std::optional<DelimitedText::Line>> DelimitedText::next_line() {
  if (rest_.empty()) return std::nullopt;
  Line line{{}, line_ + 1, false};
  bool at_start = true;
  std::size_t at = 0;
  std::size_t end = std::string_view::npos;  // where the comment begins
  for (; at < rest_.size() && rest_[at] != '\n'; ++at) {
    const char c = rest_[at];
    if (c == '#' && at_start) {
      end = at;
      line.has_comment = true;
      at = std::min(rest_.find('\n', at), rest_.size());
      break;
    }
    if (c == '>' && trimmed(rest_.substr(0, at)).empty()) {  // any text may follow
      at = std::min(rest_.find('\n', at), rest_.size());
      break;
    }
    if (c == '"' && at_start) {
      const std::size_t after = end_of_quoted(rest_, at);
      if (after == std::string_view::npos)
        return error(line.number, at + 1, "the quotation mark is not closed before a separator");
      line_ += static_cast<std::uint64_t>(
          std::count(rest_.begin() + static_cast<std::ptrdiff_t>(at),
                     rest_.begin() + static_cast<std::ptrdiff_t>(after), '\n'));
      at = after - 1;
    }
    at_start = is_blank(c) || c == ',' || c == ';';
  }
  line.text = rest_.substr(0, std::min(at, end));
  rest_.remove_prefix(std::min(at + 1, rest_.size()));
  ++line_;
  return line;
}

Result<void> DelimitedText::begin(std::span<const std::string_view> texts) {
  const std::string_view whole = rest_;
  if (auto decided = decide(texts); !decided) return decided;
  rest_ = whole;
  line_ = 0;
  while (line_ < line_of_names_)
    if (auto line = next_line(); !line) return tl::unexpected(line.error());
  return {};
}

// Reads all lines once.
Result<void> DelimitedText::decide(std::span<const std::string_view> texts) {
  bool any_comma = false;
  bool any_semicolon = false;
  bool any_tab = false;
  bool all_decimal = true;
  bool first = true;
  std::string_view names;
  for (;;) {
    const auto line = next_line();
    if (!line) return tl::unexpected(line.error());
    if (!*line) break;
    const std::string_view text = trimmed((*line)->text);
    const bool nothing = text.find_first_not_of(" \t,;") == std::string_view::npos;
    if (nothing) {
      any_semicolon |= text.find(';') != std::string_view::npos;
      any_comma |= text.find(',') != std::string_view::npos;
      all_decimal = all_decimal && !any_comma;
    }
    if (nothing || text.starts_with('>')) continue;
    if (first && text.size() == 5 && lower_case(text.substr(0, 4)) == "sep=") {
      told_ = separator_of_names(text.substr(4));
      line_of_names_ = line_;
      continue;
    }
    if (first && !is_number_or_nan(first_word(text))) {
      names = (*line)->text;
      line_of_names_ = line_;
      first = false;
      continue;
    }
    first = false;
    const std::string unquoted = unquoted_parts(text);
    any_semicolon |= unquoted.find(';') != std::string::npos;
    any_tab |= unquoted.find('\t') != std::string::npos;
    const bool comma = unquoted.find(',') != std::string::npos;
    any_comma |= comma;
    all_decimal = all_decimal && has_decimal_commas(unquoted);
  }
  const std::string unquoted_names =
      unquoted_parts(names.substr(0, names.find_last_not_of(" \t\r") + 1));
  const auto of_names = separator_of_names(unquoted_names);
  const bool tabs = of_names == Separator::kTab && unquoted_names.find(',') == std::string::npos;
  if (told_)
    separator_ = *told_;
  else if (any_semicolon)
    separator_ = Separator::kSemicolon;
  else if (any_tab && tabs)
    separator_ = Separator::kTab;
  else if (any_comma)
    separator_ = all_decimal ? Separator::kBlanks : Separator::kComma;
  const Separator between_names = told_ ? *told_ : of_names.value_or(Separator::kBlanks);
  for (const Field& field : split(names, between_names)) names_.push_back(field.value());
  const bool has_text = std::any_of(names_.begin(), names_.end(), [&](const std::string& name) {
    return std::find(texts.begin(), texts.end(), lower_case(trimmed(name))) != texts.end();
  });
  if (has_text) separator_ = names_.size() == 1 ? Separator::kNone : between_names;
  return {};
}

std::vector<DelimitedText::Field> DelimitedText::split(std::string_view line,
                                                       Separator separator) const {
  std::vector<Field> fields;
  const bool by_blanks = separator == Separator::kBlanks;
  const char mark = separator == Separator::kSemicolon ? ';'
                    : separator == Separator::kTab     ? '\t'
                    : separator == Separator::kComma   ? ','
                                                       : '\n';
  const auto skipped = [&](char c) { return is_blank(c) && (by_blanks || c != mark); };
  const auto ends = [&](char c) { return by_blanks ? is_blank(c) : c == mark; };
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && skipped(line[at])) ++at;
    if (at == line.size() && (by_blanks || fields.empty())) break;
    Field field{{}, at + 1, false};
    if (at < line.size() && line[at] == '"') {
      const std::size_t after = std::min(end_of_quoted(line, at), line.size());
      field.text = line.substr(at + 1, after - at - 2);
      field.quoted = true;
      at = after;
    }
    const std::size_t start = at;
    if (separator == Separator::kNone) at = line.size();
    while (at < line.size() && !ends(line[at])) ++at;
    if (!field.quoted) field.text = trimmed(line.substr(start, at - start));
    fields.push_back(field);
    if (by_blanks) continue;
    if (at == line.size()) break;
    ++at;
  }
  return fields;
}

Result<std::optional<DelimitedText::Record>> DelimitedText::next() {
  const auto line = next_line();
  if (!line) return tl::unexpected(line.error());
  if (!*line) return std::nullopt;
  Record record{Record::Kind::kBlank, {}, (*line)->number, trimmed((*line)->text), false};
  if (record.text.starts_with('>')) {
    record.kind = Record::Kind::kMark;
    return record;
  }
  record.fields = split((*line)->text, separator_);
  const bool blank = std::all_of(record.fields.begin(), record.fields.end(),
                                 [](const Field& field) { return trimmed(field.text).empty(); });
  if (!blank) record.kind = Record::Kind::kFields;
  record.is_comment = blank && (*line)->has_comment;
  return record;
}

}  // namespace weft::files
