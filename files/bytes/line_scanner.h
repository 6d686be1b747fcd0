// SPDX-License-Identifier: Apache-2.0
// Reads text files that are lines of numbers and words between blanks, such as Triangle's: `#`
// starts a comment, blank lines are ignored. Numbers are those of number_text.h; if commas are
// blanks, a number that may have a decimal comma is an error. Errors (kUnreadableInput) read
// "file:line:column: expected the x coordinate, found 'abc'".
//
//   LineScanner scanner("box.poly", text);
//   if (auto line = scanner.next_line("the point count"); !line) return line.error();
//   Result<std::uint64_t> count = scanner.count("the point count");
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/base/error.h"

namespace weft::files {

struct LineSyntax {
  std::string_view blanks = " \t\r\f\v,";
  char comment = '#';
};

class LineScanner {
 public:
  // `text` must outlive the scanner.
  LineScanner(std::string name, std::string_view text, LineSyntax syntax = {})
      : name_(std::move(name)), rest_(text), syntax_(syntax) {}

  // Moves to the next line that is not empty; an error at the end of the file names `what`.
  Result<void> next_line(std::string_view what);
  // Moves to the next field, on this line or below, as next_line.
  Result<void> to_field(std::string_view what) {
    return at_line_end() ? next_line(what) : Result<void>{};
  }
  // Moves to the next line that is not empty; returns false at the end of the file.
  bool try_next_line();
  // Moves to the next line, even if it is empty; returns false at the end of the file.
  bool skip_line();
  // Whether the line has no more fields.
  bool at_line_end() const { return field_.empty(); }

  // The next field of the line.
  Result<std::string_view> word(std::string_view what);
  Result<std::int64_t> integer(std::string_view what);
  Result<std::int32_t> marker(std::string_view what);
  Result<double> real(std::string_view what);  // finite
  // A number of lines to come; refused if so many cannot fit in the rest of the file.
  Result<std::uint64_t> count(std::string_view what);

  // The line from its next field on; reads none of it.
  std::string_view rest_of_line() const;

  // An error at the field that was read last.
  tl::unexpected<Error> error(const std::string& message) const;
  std::uint64_t line() const { return line_; }
  const std::string& name() const { return name_; }

 private:
  void advance();
  tl::unexpected<Error> unexpected_field(std::string_view what);
  bool is_number_like() const;
  Result<void> check_comma(std::string_view what);

  std::string name_;
  std::string_view rest_;  // after the current line
  std::string_view content_;
  std::string_view field_;  // to be read next
  std::uint64_t line_ = 0;
  std::size_t column_ = 1;  // of the field that was read last, or opens the line; from 1
  const char* line_start_ = nullptr;
  LineSyntax syntax_;
};

}  // namespace weft::files
