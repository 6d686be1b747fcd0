// SPDX-License-Identifier: Apache-2.0
// Reads Triangle's text files (.node, .ele, .poly): lines of numbers between blanks, `#` starts a
// comment, blank lines do not count. Errors (kUnreadableInput) read "file:line:column: expected
// the x coordinate, found 'abc'".
//
//   LineScanner scanner("box.poly", text);
//   if (auto line = scanner.next_line("the point count"); !line) return line.error();
//   Result<std::uint64_t> count = scanner.count("the point count");
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "client/error.h"

namespace weft::client {

class LineScanner {
 public:
  // `text` must outlive the scanner.
  LineScanner(std::string name, std::string_view text) : name_(std::move(name)), rest_(text) {}

  // Moves to the next line that holds something; an error at the end of the file names `what`.
  Result<void> next_line(std::string_view what);
  // Moves to the next line that holds something; false at the end of the file.
  bool try_next_line();
  // Whether the line has no more fields.
  bool at_line_end() const { return field_.empty(); }

  // The next field of the line.
  Result<std::int64_t> integer(std::string_view what);
  Result<std::int32_t> marker(std::string_view what);
  Result<double> real(std::string_view what);  // finite
  // A number of lines to come; refused when so many cannot fit in the rest of the file.
  Result<std::uint64_t> count(std::string_view what);

  // An error at the field that was read last.
  tl::unexpected<Error> error(const std::string& message) const;
  std::uint64_t line() const { return line_; }
  const std::string& name() const { return name_; }

 private:
  void advance();
  tl::unexpected<Error> unexpected_field(std::string_view what);

  std::string name_;
  std::string_view rest_;  // after the current line
  std::string_view content_;
  std::string_view field_;  // to be read next
  std::uint64_t line_ = 0;
  std::size_t column_ = 1;  // of the field that was read last, or opens the line; from 1
  const char* line_start_ = nullptr;
};

}  // namespace weft::client
