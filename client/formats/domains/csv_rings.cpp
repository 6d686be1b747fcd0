// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/csv_rings.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/base/text.h"
#include "client/formats/domains/geometry_builder.h"
#include "client/formats/files/file_contents.h"
#include "client/formats/files/line_scanner.h"
#include "client/formats/triangle/triangle_points.h"

namespace weft::client {
namespace {

enum class Column { kX, kY, kRing, kMarker };

std::optional<Column> column_of(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  struct Name {
    std::string_view text;
    Column column;
  };
  static constexpr Name kNames[] = {{"x", Column::kX},         {"lon", Column::kX},
                                    {"longitude", Column::kX}, {"y", Column::kY},
                                    {"lat", Column::kY},       {"latitude", Column::kY},
                                    {"ring", Column::kRing},   {"marker", Column::kMarker}};
  for (const Name& known : kNames)
    if (known.text == lower) return known.column;
  return std::nullopt;
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view text)
      : scanner_(name, text, {.blanks = " \t\r\f\v,;"}), builder_(name) {}

  Result<Domain> read() {
    builder_.begin_polygon();  // all rings are one: those inside others are holes
    bool first = true;
    while (scanner_.skip_line()) {
      Result<void> done;
      if (scanner_.at_line_end()) {
        done = end_ring();
      } else if (first && !starts_with_number()) {
        done = header();
        first = false;
      } else {
        done = corner();
        first = false;
      }
      if (!done) return tl::unexpected(done.error());
    }
    if (auto done = end_ring(); !done) return tl::unexpected(done.error());
    builder_.end_polygon("the rings", {});
    return builder_.finish();
  }

 private:
  bool starts_with_number() const {
    return std::string_view("+-.0123456789").find(scanner_.rest_of_line()[0]) !=
           std::string_view::npos;
  }

  Result<void> header() {
    columns_.clear();
    while (!scanner_.at_line_end()) {
      const auto name = scanner_.word("a column");
      if (!name) return tl::unexpected(name.error());
      const auto column = column_of(*name);
      if (!column)
        return scanner_.error("the column is " + in_quotes(*name) +
                              ", only x, y, ring and marker are read");
      if (has(*column)) return scanner_.error("the column " + in_quotes(*name) + " comes twice");
      columns_.push_back(*column);
    }
    if (!has(Column::kX) || !has(Column::kY))
      return scanner_.error("the columns x and y must be there");
    return {};
  }
  bool has(Column column) const {
    return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
  }

  Result<void> corner() {
    Point at;
    std::int64_t ring = 0;
    std::uint32_t marker = builder_.marker(0);
    for (const Column column : columns_) {
      if (column == Column::kMarker) {
        const auto value = read_marker();
        if (!value) return tl::unexpected(value.error());
        marker = *value;
      } else if (column == Column::kRing) {
        const auto value = scanner_.integer("the ring");
        if (!value) return tl::unexpected(value.error());
        ring = *value;
      } else {
        const bool x = column == Column::kX;
        const auto value = scanner_.real(x ? "the x coordinate" : "the y coordinate");
        if (!value) return tl::unexpected(value.error());
        (x ? at.x : at.y) = *value;
      }
    }
    if (!scanner_.at_line_end())
      return scanner_.error("the line goes on after its " + std::to_string(columns_.size()) +
                            " columns");
    if (ring != ring_)
      if (auto done = end_ring(); !done) return done;
    ring_ = ring;
    if (corners_.empty()) first_line_ = scanner_.line();
    corners_.push_back(at);
    markers_.push_back(marker);
    return {};
  }

  // An integer, or a name that does not begin like a number.
  Result<std::uint32_t> read_marker() {
    if (!scanner_.at_line_end() && !starts_with_number()) {
      const auto name = scanner_.word("the marker");
      if (!name) return tl::unexpected(name.error());
      return builder_.marker(*name);
    }
    const auto number = scanner_.marker("the marker");
    if (!number) return tl::unexpected(number.error());
    return builder_.marker(*number);
  }

  Result<void> end_ring() {
    if (corners_.empty()) return {};
    const std::string path = "the ring from line " + std::to_string(first_line_);
    auto added = builder_.ring(corners_, path, {}, markers_, false);
    corners_.clear();
    markers_.clear();
    return added;
  }

  LineScanner scanner_;
  GeometryBuilder builder_;
  std::vector<Column> columns_ = {Column::kX, Column::kY};
  std::vector<Point> corners_;          // of the ring so far
  std::vector<std::uint32_t> markers_;  // labels
  std::int64_t ring_ = 0;
  std::uint64_t first_line_ = 0;
};

}  // namespace

Result<Domain> read_csv_rings(const std::filesystem::path& path) {
  const auto contents = read_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path.string(), contents->text()).read();
}

}  // namespace weft::client
