// SPDX-License-Identifier: Apache-2.0
// Tables in files: a row on a line, words between blanks. Empty lines and lines that begin with #
// are ignored.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace weft::server {

struct TableLine {
  std::size_t number = 0;  // from 1
  std::vector<std::string_view> words{};
};

std::vector<TableLine> table_lines(std::string_view text);

bool visible_ascii(std::string_view word);

// The error that begins with the number of the line.
tl::unexpected<std::string> bad_line(const TableLine& line, std::string_view reason);

// Why that cannot be the name of a client; empty if it can.
std::string fault_of_name(std::string_view name);

}  // namespace weft::server
