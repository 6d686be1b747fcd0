// SPDX-License-Identifier: Apache-2.0
// Tables in text, as spreadsheets, GIS and Fortran write them: a record to a line, fields between
// semicolons, tabs, commas or blanks, perhaps the names of the columns first.
//
// What separates fields is decided by the whole file. Semicolons do if there are any, or else tabs
// if they separate the names; then a comma is a decimal mark. If there are blanks and commas, and
// every comma is one in a number between blanks, blanks separate; otherwise commas do, if there are
// any. A line "sep=;" at the start decides it. A field may be in quotation marks, and then hold
// separators, line ends, and its own marks twice. `#` starts a comment at the start of a field or
// after a blank.
//
//   DelimitedText table("coast.csv", text);
//   if (auto begun = table.begin(); !begun) ...   // decides, and reads the names
//   for (auto record = table.next(); ...; record = table.next())
//
// Errors (kUnreadableInput) carry file:line:column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/error.h"

namespace weft::files {

class DelimitedText {
 public:
  enum class Separator { kSemicolon, kTab, kComma, kBlanks, kNone };

  struct Field {
    std::string_view text;  // without quotation marks and the blanks around it
    std::size_t column = 1;
    bool quoted = false;

    // With its quotation marks once.
    std::string value() const;
  };
  struct Record {
    // A line of nothing but separators is blank; a mark begins with GMT's '>'.
    enum class Kind { kFields, kBlank, kMark } kind = Kind::kBlank;
    std::vector<Field> fields{};
    std::uint64_t line = 0;
    std::string_view text{};  // all of it
    bool is_comment = false;  // it is blank but for a comment
  };

  // `text` must outlive the table.
  DelimitedText(std::string name, std::string_view text) : name_(std::move(name)), rest_(text) {}

  // If there is a column of one of these names, in lower case, its fields have commas and blanks of
  // their own: what separates the names separates fields.
  Result<void> begin(std::span<const std::string_view> texts = {});
  // Of the first record, if that is no record of numbers; otherwise empty.
  const std::vector<std::string>& names() const { return names_; }
  std::uint64_t line_of_names() const { return line_of_names_; }
  Separator separator() const { return separator_; }

  // Empty at the end.
  Result<std::optional<Record>> next();

  // A number as the file writes it: with a decimal point, or a decimal comma, if a comma does not
  // separate or the field is in quotation marks.
  std::optional<double> real(const Field& field) const;

  tl::unexpected<Error> error(std::uint64_t line, std::size_t column,
                              const std::string& message) const;

 private:
  struct Line {
    std::string_view text;  // without its comment
    std::uint64_t number = 0;
    bool has_comment = false;
  };

  Result<std::optional<Line>> next_line();
  Result<void> decide(std::span<const std::string_view> texts);
  std::vector<Field> split(std::string_view line, Separator separator) const;

  std::string name_;
  std::string_view rest_;
  std::uint64_t line_ = 0;
  std::optional<Separator> told_;  // by "sep="
  Separator separator_ = Separator::kBlanks;
  std::vector<std::string> names_;
  std::uint64_t line_of_names_ = 0;
};

// Whether a text stands for no number: "NaN", "nan", "NA", and what C's libraries print.
bool is_nan_text(std::string_view text);

}  // namespace weft::files
