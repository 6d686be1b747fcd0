// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/line_scanner.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/number_text.h"

namespace weft::files {

bool LineScanner::skip_line() {
  column_ = 1;
  if (rest_.empty()) {
    content_ = field_ = {};
    return false;
  }
  const std::size_t end = rest_.find('\n');
  content_ = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++line_;
  line_start_ = content_.data();
  content_ = content_.substr(0, content_.find(syntax_.comment));
  advance();
  return true;
}

bool LineScanner::try_next_line() {
  while (skip_line()) {
    if (field_.empty()) continue;
    column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
    return true;
  }
  return false;
}

Result<void> LineScanner::next_line(std::string_view what) {
  if (try_next_line()) return {};
  return fail(ExitCode::kUnreadableInput, name_ + ":" + std::to_string(line_ + 1) +
                                              ": the file ends where " + std::string(what) +
                                              " should follow");
}

// Finds the field at the start of content_, and removes it from there.
void LineScanner::advance() {
  const std::size_t start = content_.find_first_not_of(syntax_.blanks);
  if (start == std::string_view::npos) {
    content_ = field_ = {};
    return;
  }
  content_.remove_prefix(start);
  const std::size_t length = std::min(content_.find_first_of(syntax_.blanks), content_.size());
  field_ = content_.substr(0, length);
  content_.remove_prefix(length);
}

tl::unexpected<Error> LineScanner::error(const std::string& message) const {
  return fail(ExitCode::kUnreadableInput,
              name_ + ":" + std::to_string(line_) + ":" + std::to_string(column_) + ": " + message);
}

tl::unexpected<Error> LineScanner::unexpected_field(std::string_view what) {
  if (field_.empty()) return error("the line ends where " + std::string(what) + " should follow");
  column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
  return error("expected " + std::string(what) + ", found " + in_quotes(field_));
}

Result<std::string_view> LineScanner::word(std::string_view what) {
  if (field_.empty()) return unexpected_field(what);
  column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
  const std::string_view found = field_;
  advance();
  return found;
}

std::string_view LineScanner::rest_of_line() const {
  if (field_.empty()) return {};
  return {field_.data(),
          static_cast<std::size_t>(content_.data() + content_.size() - field_.data())};
}

Result<std::int64_t> LineScanner::integer(std::string_view what) {
  const auto value = whole_of(field_);
  if (!value) return unexpected_field(what);
  column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
  advance();
  return *value;
}

Result<std::int32_t> LineScanner::marker(std::string_view what) {
  const Result<std::int64_t> value = integer(what);
  if (!value) return tl::unexpected(value.error());
  if (*value < std::numeric_limits<std::int32_t>::min() ||
      *value > std::numeric_limits<std::int32_t>::max())
    return error(std::string(what) + " is " + std::to_string(*value) + ", it must fit in 32 bits");
  return static_cast<std::int32_t>(*value);
}

Result<double> LineScanner::real(std::string_view what) {
  const auto value = real_of(field_);
  if (!value)
    return unexpected_field(std::string(what) + (is_number_like() ? ", a finite number" : ""));
  if (auto ok = check_comma(what); !ok) return tl::unexpected(ok.error());
  column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
  advance();
  return *value;
}

// Whether the field would be a number, were it finite.
bool LineScanner::is_number_like() const {
  double value = 0;
  const auto [end, problem] = std::from_chars(field_.data(), field_.data() + field_.size(), value);
  return !field_.empty() && problem != std::errc::invalid_argument &&
         end == field_.data() + field_.size();
}

// Where commas are blanks, "1 0,5 0,5" would be five numbers, but its author means three: a comma
// between whole numbers is refused if it has no blank beside it and the line has others.
Result<void> LineScanner::check_comma(std::string_view what) {
  constexpr auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (content_.size() < 2 || content_[0] != ',' || !is_digit(content_[1])) return {};
  const std::string_view next =
      content_.substr(1, std::min(content_.find_first_of(" \t\r,", 1), content_.size()) - 1);
  constexpr std::string_view kNotWhole = ".eEdD";
  if (field_.find_first_of(kNotWhole) != std::string_view::npos ||
      next.find_first_of(kNotWhole) != std::string_view::npos)
    return {};
  const std::string_view before(line_start_, static_cast<std::size_t>(field_.data() - line_start_));
  const std::string_view after = content_.substr(1 + next.size());
  const bool after_a_blank =
      !trimmed(before).empty() && before.find_last_of(" \t") + 1 == before.size();
  const bool before_a_blank = !trimmed(after).empty() && after[0] != ',';
  if (!after_a_blank && !before_a_blank) return {};
  column_ = static_cast<std::size_t>(field_.data() - line_start_) + 1;
  return error(std::string(what) + " may be " +
               in_quotes(std::string(field_) + "," + std::string(next)) +
               " with a decimal comma, or " + in_quotes(field_) +
               " before another number: write a decimal point, or blanks alone between numbers");
}

Result<std::uint64_t> LineScanner::count(std::string_view what) {
  const Result<std::int64_t> value = integer(what);
  if (!value) return tl::unexpected(value.error());
  if (*value < 0) return error(std::string(what) + " is negative: " + std::to_string(*value));
  constexpr std::uint64_t kShortestLine = 4;  // "1 2\n"
  if (static_cast<std::uint64_t>(*value) > (rest_.size() + 1) / kShortestLine)
    return error(std::string(what) + " is " + std::to_string(*value) +
                 ", more than the rest of the file can hold");
  return static_cast<std::uint64_t>(*value);
}

}  // namespace weft::files
