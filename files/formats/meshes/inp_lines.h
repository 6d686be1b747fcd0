// SPDX-License-Identifier: Apache-2.0
// The lines of an input file of Abaqus: keywords with parameters, in letters of either case, and
// lines of data below them; "**" begins a comment. Blanks mean nothing but between quotation marks.
//
//   InpLines lines("mesh.inp", text);
//   while (lines.next())
//     if (lines.is_keyword()) ... const InpKeyword keyword = lines.keyword() ...
//     else ... lines.fields(), or lines.scanner() for the numbers of the line ...
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "files/bytes/line_scanner.h"

namespace weft::files {

struct InpKeyword {
  std::string name;                               // "*solidsection"
  std::map<std::string, std::string> parameters;  // "elset": "Fluid"

  bool has(const std::string& parameter) const { return parameters.contains(parameter); }
  // Empty if there is none.
  std::string value(const std::string& parameter) const;
};

class InpLines {
 public:
  // `text` must outlive this.
  InpLines(std::string name, std::string_view text)
      : scanner_(std::move(name), text, {.blanks = " \t\r\f\v,", .comment = '\0'}) {}

  // Moves to the next line that is neither empty nor a comment; false at the end of the file.
  bool next();
  bool is_keyword() const { return scanner_.rest_of_line().starts_with('*'); }
  // The keyword, with the lines that go on with it: a line that ends with a comma does so.
  // REQUIRES: the line is one.
  InpKeyword keyword();
  // What stands between the commas of the line.
  std::vector<std::string> fields() const;
  // Whether there is nothing between two commas of the line.
  bool has_empty_field() const;
  // Whether the line ends with a comma.
  bool goes_on() const;
  LineScanner& scanner() { return scanner_; }

 private:
  LineScanner scanner_;
  bool is_read_ahead_ = false;
};

}  // namespace weft::files
