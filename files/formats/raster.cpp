// SPDX-License-Identifier: Apache-2.0
#include "files/formats/raster.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/text_writer.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{4} << 30;
// More than any server accepts.
constexpr std::int64_t kMaxNodes = std::int64_t{1} << 28;

struct Header {
  std::optional<std::int64_t> columns, rows;
  std::optional<double> corner_x, corner_y, centre_x, centre_y, size, dx, dy, no_data;
};

class Reader {
 public:
  Reader(const std::string& name, std::string_view text, RasterValues wanted)
      : most_values_((text.size() + 1) / 2), wanted_(wanted), scanner_(name, text) {}

  Result<Raster> read() {
    if (auto header = read_header(); !header) return tl::unexpected(header.error());
    if (auto placed = place(); !placed) return tl::unexpected(placed.error());
    if (auto values = read_values(); !values) return tl::unexpected(values.error());
    return std::move(grid_);
  }

 private:
  // Reads lines of a word and a number, up to the first line of values.
  Result<void> read_header() {
    while (true) {
      if (auto line = scanner_.next_line("the values"); !line) return line;
      const std::string_view rest = scanner_.rest_of_line();
      if (rest.find_first_of("+-.0123456789") == 0) return {};
      if (auto field = read_field(); !field) return field;
    }
  }

  Result<void> read_field() {
    const auto word = scanner_.word("a word of the header");
    if (!word) return tl::unexpected(word.error());
    const std::string name = lower_case(*word);
    struct Count {
      std::string_view name;
      std::optional<std::int64_t> Header::*field;
    };
    static constexpr Count kCounts[] = {{"ncols", &Header::columns}, {"nrows", &Header::rows}};
    for (const Count& count : kCounts) {
      if (count.name != name) continue;
      const auto value = scanner_.integer(name);
      if (!value) return tl::unexpected(value.error());
      if (*value < 1 || *value > kMaxNodes)
        return scanner_.error(name + " is " + std::to_string(*value) + ", not from 1 to " +
                              std::to_string(kMaxNodes));
      header_.*count.field = *value;
      return {};
    }
    struct Real {
      std::string_view name;
      std::optional<double> Header::*field;
    };
    static constexpr Real kReals[] = {{"xllcorner", &Header::corner_x},
                                      {"yllcorner", &Header::corner_y},
                                      {"xllcenter", &Header::centre_x},
                                      {"yllcenter", &Header::centre_y},
                                      {"cellsize", &Header::size},
                                      {"dx", &Header::dx},
                                      {"dy", &Header::dy},
                                      {"nodata_value", &Header::no_data}};
    for (const Real& real : kReals) {
      if (real.name != name) continue;
      const auto value = scanner_.real(name);
      if (!value) return tl::unexpected(value.error());
      header_.*real.field = *value;
      return {};
    }
    return scanner_.error("'" + harmless(std::string(*word)) + "' is no word of a grid's header");
  }

  Result<void> place() {
    const Header& h = header_;
    const auto missing = [this](const char* what) {
      return scanner_.error(std::string("the header has no ") + what);
    };
    if (!h.columns) return missing("ncols");
    if (!h.rows) return missing("nrows");
    if (!h.size && !(h.dx && h.dy)) return missing("cellsize");
    if (!h.corner_x && !h.centre_x) return missing("xllcorner");
    if (!h.corner_y && !h.centre_y) return missing("yllcorner");
    if (*h.columns > kMaxNodes / *h.rows)
      return scanner_.error("ncols times nrows is over " + std::to_string(kMaxNodes));
    grid_.dx = h.dx ? *h.dx : *h.size;
    grid_.dy = h.dy ? *h.dy : *h.size;
    if (!(grid_.dx > 0 && grid_.dy > 0))
      return scanner_.error("the size of a cell is not positive");
    grid_.x = h.centre_x ? *h.centre_x : *h.corner_x + grid_.dx / 2;
    grid_.y = h.centre_y ? *h.centre_y : *h.corner_y + grid_.dy / 2;
    grid_.columns = static_cast<std::uint32_t>(*h.columns);
    grid_.rows = static_cast<std::uint32_t>(*h.rows);
    return {};
  }

  // A row may be divided over lines.
  Result<void> read_values() {
    std::vector<double>& values = grid_.values;
    const std::size_t columns = grid_.columns;
    if (columns * grid_.rows > most_values_)
      return scanner_.error("fewer values than ncols times nrows");
    values.resize(columns * grid_.rows);
    for (std::size_t row = grid_.rows; row-- > 0;) {
      for (std::size_t column = 0; column < columns; ++column) {
        if (scanner_.at_line_end())
          if (auto line = scanner_.next_line("a value"); !line) return line;
        const auto value = scanner_.real("a value");
        if (!value) return tl::unexpected(value.error());
        const bool absent = header_.no_data && *value == *header_.no_data;
        if (wanted_ == RasterValues::kPositive) {
          if (absent)
            return scanner_.error("a cell without a value, but a size needs one in every cell");
          if (!(*value > 0)) return scanner_.error("the bound on the area is not positive");
        }
        values[row * columns + column] = absent ? std::numeric_limits<double>::quiet_NaN() : *value;
      }
    }
    if (!scanner_.at_line_end() || scanner_.try_next_line())
      return scanner_.error("more values than ncols times nrows");
    return {};
  }

  const std::size_t most_values_;  // that the file can hold, by its size
  const RasterValues wanted_;
  LineScanner scanner_;
  Header header_;
  Raster grid_;
};

}  // namespace

bool is_raster_path(const std::filesystem::path& path) {
  return lower_extension(path) == ".asc";
}

Result<Raster> read_raster(const std::filesystem::path& path, RasterValues wanted) {
  const auto file = read_text_file(path, kMaxFileBytes);
  if (!file) return tl::unexpected(file.error());
  return Reader(path.string(), file->text(), wanted).read();
}

void write_raster(const Raster& grid, OutputFile& file) {
  put_line(file, "ncols", grid.columns);
  put_line(file, "nrows", grid.rows);
  put_line(file, "xllcenter", grid.x);
  put_line(file, "yllcenter", grid.y);
  if (grid.dx == grid.dy) {
    put_line(file, "cellsize", grid.dx);
  } else {
    put_line(file, "dx", grid.dx);
    put_line(file, "dy", grid.dy);
  }
  put_line(file, "NODATA_value -9999");
  for (std::size_t row = grid.rows; row-- > 0;)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double value = grid.values[row * grid.columns + column];
      if (std::isfinite(value))
        file.number(value);
      else
        file.put("-9999");
      file.put(column + 1 < grid.columns ? ' ' : '\n');
    }
}

}  // namespace weft::files
