// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/csv_rings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/delimited_text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/number_text.h"
#include "files/formats/domains/feature_properties.h"
#include "files/formats/domains/geometry_builder.h"
#include "files/formats/domains/ring_breaks.h"
#include "files/formats/domains/wkt.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

using Record = DelimitedText::Record;
using Field = DelimitedText::Field;
using Separator = DelimitedText::Separator;

// Of columns of geometries in well-known text.
constexpr std::string_view kGeometryNames[] = {"wkt", "wkt_geom", "geom", "geometry", "the_geom"};

enum class Column { kX, kY, kRing, kMarker, kBulge, kGeometry, kOther };

// In small letters. Of "Easting [m]", the unit says nothing.
std::string without_unit(std::string_view name) {
  return lower_case(trimmed(name.substr(0, name.find_first_of("[("))));
}

// Whether the columns x and y may be called so where they are longitudes and latitudes alone.
bool is_of_degrees(std::string_view x, std::string_view y) {
  return without_unit(x).starts_with("lon") && without_unit(y).starts_with("lat");
}

Column column_of(std::string_view name) {
  struct Name {
    std::string_view text;
    Column column;
  };
  static constexpr Name kNames[] = {
      {"x", Column::kX},        {"lon", Column::kX},         {"long", Column::kX},
      {"lng", Column::kX},      {"longitude", Column::kX},   {"easting", Column::kX},
      {"point_x", Column::kX},  {"y", Column::kY},           {"lat", Column::kY},
      {"latitude", Column::kY}, {"northing", Column::kY},    {"point_y", Column::kY},
      {"ring", Column::kRing},  {"marker", Column::kMarker}, {"bulge", Column::kBulge}};
  const std::string known = without_unit(name);
  for (const Name& entry : kNames)
    if (entry.text == known) return entry.column;
  if (std::find(std::begin(kGeometryNames), std::end(kGeometryNames), known) !=
      std::end(kGeometryNames))
    return Column::kGeometry;
  return Column::kOther;
}

bool is_property(std::string_view name) {
  static constexpr std::string_view kNames[] = {"marker",      "region",   "marker_name",
                                                "region_name", "max_area", "max_edge"};
  return std::find(std::begin(kNames), std::end(kNames), lower_case(name)) != std::end(kNames);
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view text, bool lonlat)
      : name_(name), table_(name, text), builder_(name, lonlat) {}

  Result<Domain> read() {
    if (auto begun = table_.begin(kGeometryNames); !begun) return tl::unexpected(begun.error());
    if (auto named = take_names(); !named) return tl::unexpected(named.error());
    for (;;) {
      const auto record = table_.next();
      if (!record) return tl::unexpected(record.error());
      if (!*record) break;
      auto taken = geometry_ ? feature(**record) : row(**record);
      if (!taken) return tl::unexpected(taken.error());
    }
    if (!grouped_.empty() && !has_fractions_)
      return table_.error(grouped_place_.first, grouped_place_.second,
                          "the commas of " + grouped_ +
                              " and all the others may be decimal marks, or group the digits of "
                              "thousands: write no commas in numbers, or separate columns by "
                              "semicolons");
    warn_of_columns();
    if (comment_line_ > 0)
      builder_.warn({.kind = WarningKind::kRow,
                     .line = comment_line_,
                     .text = "a line with nothing but a comment ends the ring before it"});
    if (returned_line_ > 0)
      builder_.warn({.kind = WarningKind::kRepeatedRing,
                     .line = returned_line_,
                     .text = "a ring that ended before comes again; it is taken for another ring"});
    if (auto added = add_rings(); !added) return tl::unexpected(added.error());
    auto domain = builder_.finish();
    if (domain) domain->system = system();
    return domain;
  }

 private:
  static constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

  std::size_t place_of(Column column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    return found == columns_.end() ? kAbsent : static_cast<std::size_t>(found - columns_.begin());
  }

  // Degrees if the columns' names say so.
  std::optional<CoordinateSystem> system() const {
    const std::vector<std::string>& names = table_.names();
    if (geometry_ || names.empty()) return std::nullopt;
    const std::string &x = names[place_of(Column::kX)], &y = names[place_of(Column::kY)];
    if (!is_of_degrees(x, y)) return std::nullopt;
    return CoordinateSystem{"columns " + in_quotes(x) + " and " + in_quotes(y), true, kLonLat};
  }

  Result<void> take_names() {
    const std::vector<std::string>& names = table_.names();
    if (names.empty()) {
      columns_ = {Column::kX, Column::kY};
      return {};
    }
    for (const std::string& name : names) columns_.push_back(column_of(trimmed(name)));
    geometry_ = place_of(Column::kGeometry) != kAbsent;
    const auto refuse = [this](const std::string& why) {
      return table_.error(table_.line_of_names(), 1, why);
    };
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (columns_[i] == Column::kOther) continue;
      const std::size_t first = place_of(columns_[i]);
      if (first < i)
        return refuse(names[first] == names[i]
                          ? "the column " + in_quotes(names[i]) + " comes twice"
                          : "the columns " + in_quotes(names[first]) + " and " +
                                in_quotes(names[i]) + " mean the same");
    }
    if (!geometry_ && (place_of(Column::kX) == kAbsent || place_of(Column::kY) == kAbsent))
      return refuse("the columns x and y must be there, or WKT; there are " + in_quotes(names));
    return {};
  }

  void warn_of_columns() {
    std::vector<std::string> ignored;
    for (std::size_t i = 0; i < table_.names().size(); ++i) {
      const std::string& name = table_.names()[i];
      const bool used = geometry_ ? columns_[i] == Column::kGeometry || is_property(trimmed(name))
                                  : columns_[i] != Column::kOther;
      if (!used && !trimmed(name).empty()) ignored.push_back(name);
    }
    if (!ignored.empty())
      builder_.warn({.kind = WarningKind::kColumn,
                     .count = ignored.size(),
                     .text = (ignored.size() == 1 ? "this column is ignored: "
                                                  : "these columns are ignored: ") +
                             in_quotes(ignored)});
    if (unnamed_line_ > 0)
      builder_.warn(
          {.kind = WarningKind::kColumn,
           .line = unnamed_line_,
           .text = "columns after the first two are ignored, because no line names them"});
  }

  tl::unexpected<Error> error(const Record& record, std::size_t field,
                              const std::string& message) const {
    const std::size_t column = field < record.fields.size() ? record.fields[field].column
                               : record.fields.empty()      ? 1
                                                            : record.fields.back().column;
    return table_.error(record.line, column, message);
  }
  tl::unexpected<Error> missing(const Record& record, const std::string& what) const {
    const Separator separator = table_.separator();
    const std::string about = separator == Separator::kSemicolon
                                  ? "; semicolons separate columns here"
                              : separator == Separator::kTab ? "; tabs separate columns here"
                                                             : "";
    return error(record, record.fields.size(),
                 "the line ends where " + what + " should follow" + about);
  }

  Result<void> feature(const Record& record) {
    if (record.kind != Record::Kind::kFields) return {};
    const auto property = [&](const char* name) -> PropertyValue {
      for (std::size_t i = 0; i < columns_.size() && i < record.fields.size(); ++i) {
        if (lower_case(trimmed(table_.names()[i])) != name) continue;
        const auto number = table_.real(record.fields[i]);
        return number ? PropertyValue{number, "", ""}
                      : PropertyValue{std::nullopt, record.fields[i].value(), ""};
      }
      return {};
    };
    const std::string line = "line " + std::to_string(record.line);
    const auto properties = feature_properties(builder_, line + ", column ", property);
    if (!properties) return tl::unexpected(properties.error());
    const std::size_t place = place_of(Column::kGeometry);
    if (place >= record.fields.size() || trimmed(record.fields[place].text).empty()) {
      builder_.leave_out(LeftOut::kGeometry, line);
      return {};
    }
    const Field& field = record.fields[place];
    return add_wkt(name_, field.text, {record.line, field.column + (field.quoted ? 1 : 0)},
                   *properties, builder_);
  }

  Result<void> row(const Record& record) {
    const bool is_end = record.kind != Record::Kind::kFields ||
                        std::all_of(record.fields.begin(), record.fields.end(), [](const Field& f) {
                          return f.text.empty() || is_nan_text(f.text);
                        });
    if (is_end || stands_for_none(record)) {
      // Only a comment's line may not be meant to end a ring.
      open_comment_ = record.is_comment && (!starts_ring_ || open_comment_ > 0) ? record.line : 0;
      starts_ring_ = true;
      return {};
    }
    if (open_comment_ > 0 && comment_line_ == 0) comment_line_ = open_comment_;
    open_comment_ = 0;
    if (auto fits = check_count(record); !fits) return fits;
    return corner(record);
  }

  // Nothing or NaN in both of the two columns.
  bool stands_for_none(const Record& record) const {
    const auto is_none = [&](Column column) {
      const std::size_t place = place_of(column);
      if (place >= record.fields.size()) return false;
      const std::string_view text = record.fields[place].text;
      return text.empty() || is_nan_text(text);
    };
    return is_none(Column::kX) && is_none(Column::kY);
  }

  // Whether the fields are those of the columns.
  Result<void> check_count(const Record& record) {
    const std::size_t columns = columns_.size();
    std::size_t fields = record.fields.size();
    const bool by_commas = table_.separator() == Separator::kComma;
    // A comma at the end may follow a decimal comma's fraction; another separator follows a field.
    const bool may_end_in_separators = !by_commas || (table_.names().empty() && fields == 3);
    while (may_end_in_separators && fields > columns && record.fields[fields - 1].text.empty())
      --fields;
    if (fields <= columns) return {};
    if (by_commas) return error(record, columns, two_readings(record));
    if (table_.names().empty()) {
      if (unnamed_line_ == 0) unnamed_line_ = record.line;
      return {};
    }
    return error(record, columns,
                 "the line goes on after its " + std::to_string(columns) + " columns");
  }

  // What is wrong with a line of too many fields between commas, if there is more than one reading.
  std::string two_readings(const Record& record) const {
    std::string text = "the line goes on after its " + std::to_string(columns_.size()) + " columns";
    const auto is_whole = [&record](std::size_t i) {
      const Field& field = record.fields[i];
      return !field.quoted && integer_of(field.text).has_value();
    };
    if (!is_whole(0) || !is_whole(1)) return text;
    const auto field = [&record](std::size_t i) { return std::string(record.fields[i].text); };
    const bool has_fraction = record.fields.size() > 3 && is_whole(2) && is_whole(3);
    return text + ": its first two are " + in_quotes(field(0)) + " and " + in_quotes(field(1)) +
           ", or with decimal commas " + in_quotes(field(0) + "," + field(1)) + " and " +
           in_quotes(field(2) + (has_fraction ? "," + field(3) : "")) +
           "; write decimal points, or separate columns by semicolons";
  }

  Result<void> corner(const Record& record) {
    RingCorner corner{{}, false};
    for (const Column column : {Column::kX, Column::kY}) {
      const bool x = column == Column::kX;
      const auto value =
          coordinate(record, place_of(column), x ? "the x coordinate" : "the y coordinate");
      if (!value) return tl::unexpected(value.error());
      (x ? corner.at.x : corner.at.y) = *value;
    }
    std::uint32_t marker = builder_.marker(0);
    if (const std::size_t place = place_of(Column::kMarker); place != kAbsent) {
      if (place >= record.fields.size()) return missing(record, "the marker");
      const auto read = read_marker(record, place);
      if (!read) return tl::unexpected(read.error());
      marker = *read;
    }
    if (const std::size_t place = place_of(Column::kRing); place != kAbsent) {
      if (place >= record.fields.size()) return missing(record, "the ring");
      const std::string_view ring = record.fields[place].text;
      if (corners_.empty() || ring != ring_) {
        starts_ring_ = true;
        if (!rings_.insert(ring).second && returned_line_ == 0) returned_line_ = record.line;
      }
      ring_ = ring;
    }
    double bulge = 0;
    if (const std::size_t place = place_of(Column::kBulge); place != kAbsent) {
      if (place >= record.fields.size()) return missing(record, "the bulge");
      const auto read = read_bulge(record, place);
      if (!read) return tl::unexpected(read.error());
      bulge = *read;
    }
    corner.starts_ring = starts_ring_ || corners_.empty();
    starts_ring_ = false;
    corners_.push_back(corner);
    markers_.push_back(marker);
    bulges_.push_back(bulge);
    lines_.push_back(record.line);
    return {};
  }

  Result<double> coordinate(const Record& record, std::size_t place, const std::string& what) {
    if (place >= record.fields.size()) return missing(record, what);
    const Field& field = record.fields[place];
    const auto value = table_.real(field);
    if (field.text.empty()) return error(record, place, what + " is missing");
    if (!value) {
      const bool is_nan = is_nan_text(field.text);
      return error(record, place,
                   "expected " + what + (is_nan ? ", a finite number" : "") + ", found " +
                       in_quotes(field.text));
    }
    if (groups_digits(field)) {
      if (grouped_.empty())
        grouped_ = in_quotes(field.text), grouped_place_ = {record.line, field.column};
    } else if (field.text.find(',') != std::string_view::npos) {
      has_fractions_ = true;
    }
    // Two decimal marks in one file mean that one of them groups digits.
    for (const auto& [mark, seen] : {std::pair{'.', &point_}, {',', &comma_}})
      if (seen->empty() && field.text.find(mark) != std::string_view::npos)
        *seen = in_quotes(field.text) + " in line " + std::to_string(record.line);
    if (!point_.empty() && !comma_.empty())
      return error(record, place,
                   "numbers have decimal points, " + point_ + ", and decimal commas, " + comma_);
    return *value;
  }

  // Whether a quoted field between commas may be as Excel writes it in English, "4,000", or may
  // have a decimal comma.
  bool groups_digits(const Field& field) const {
    if (!field.quoted || table_.separator() != Separator::kComma) return false;
    std::string_view digits = trimmed(field.text);
    if (digits.starts_with('-') || digits.starts_with('+')) digits.remove_prefix(1);
    const std::size_t comma = digits.find(',');
    return comma >= 1 && comma <= 3 && digits[0] != '0' && digits.size() == comma + 4;
  }

  // An integer, or a name; none if the field is empty.
  Result<std::uint32_t> read_marker(const Record& record, std::size_t place) {
    const Field& field = record.fields[place];
    const std::string_view text = trimmed(field.text);
    if (text.empty() || is_nan_text(text)) return builder_.marker(0);
    const auto number = table_.real(field);
    if (!number) return builder_.marker(field.value());
    const auto whole = static_cast<std::int64_t>(std::clamp(*number, -1e15, 1e15));
    if (static_cast<double>(whole) != *number)
      return error(record, place, "expected the marker, found " + in_quotes(text));
    if (whole < std::numeric_limits<std::int32_t>::min() ||
        whole > std::numeric_limits<std::int32_t>::max())
      return error(record, place,
                   "the marker is " + std::to_string(whole) + ", it must fit in 32 bits");
    return builder_.marker(static_cast<std::int32_t>(whole));
  }

  // None if the field is empty.
  Result<double> read_bulge(const Record& record, std::size_t place) const {
    const Field& field = record.fields[place];
    const std::string_view text = trimmed(field.text);
    if (text.empty() || is_nan_text(text)) return 0;
    const auto bulge = table_.real(field);
    if (!bulge) return error(record, place, "expected the bulge, found " + in_quotes(text));
    if (std::abs(*bulge) > Domain::Arc::kMaxBulge)
      return error(record, place, "the bulge is " + shortest(*bulge) + ", magnitudes go up to 1e6");
    return *bulge;
  }

  // Hands the corners to the builder, ring by ring.
  Result<void> add_rings() {
    const RingBreaks breaks = ring_breaks(corners_);
    warn_of(breaks.ends, "the end of a ring", "ends of rings");
    warn_of(breaks.doubtful, "a corner", "corners");
    // All rings are one polygon: those inside others are holes.
    builder_.begin_polygon(RingRoles::kByPlace);
    std::size_t start = 0;
    auto end_row = breaks.ends.begin();
    for (std::size_t i = 0; i <= corners_.size(); ++i) {
      const bool is_row = end_row != breaks.ends.end() && *end_row == i;
      if (i < corners_.size() && !is_row && !corners_[i].starts_ring) continue;
      if (auto added = add_ring(start, i); !added) return added;
      start = is_row ? i + 1 : i;
      if (is_row) ++end_row;
    }
    builder_.end_polygon("the rings", {});
    return {};
  }

  void warn_of(const std::vector<std::size_t>& rows, const char* one, const char* many) {
    if (rows.empty()) return;
    const Point at = corners_[rows[0]].at;
    const std::string row = "the row " + coordinates(at.x, at.y);
    builder_.warn({.kind = WarningKind::kRow,
                   .line = lines_[rows[0]],
                   .count = rows.size(),
                   .text = rows.size() == 1 ? row + " is taken for " + one
                                            : row + " and " + with_separators(rows.size() - 1) +
                                                  " more like it are taken for " + many});
  }

  Result<void> add_ring(std::size_t start, std::size_t end) {
    if (start == end) return {};
    std::vector<Point> points;
    for (std::size_t i = start; i < end; ++i) points.push_back(corners_[i].at);
    const std::string path = "the ring from line " + std::to_string(lines_[start]);
    return builder_.ring(points, path, {}, std::span(markers_).subspan(start, end - start),
                         std::span(bulges_).subspan(start, end - start), false);
  }

  std::string name_;
  DelimitedText table_;
  GeometryBuilder builder_;
  std::vector<Column> columns_;
  bool geometry_ = false;           // lines are features
  std::uint64_t unnamed_line_ = 0;  // the first that has more columns than the two
  std::vector<RingCorner> corners_;
  std::vector<std::uint32_t> markers_;  // labels, of the corners
  std::vector<double> bulges_;          // of the segments that begin at the corners
  std::vector<std::uint64_t> lines_;    // of the corners
  bool starts_ring_ = true;             // the next corner
  std::uint64_t open_comment_ = 0;      // the line of a comment that alone parts the next corner
  std::uint64_t comment_line_ = 0;      // the first that did
  std::string_view ring_;               // of the last corner
  std::string point_;                   // where a decimal point was seen first, and a comma
  std::string comma_;
  bool has_fractions_ = false;  // some comma can only be a decimal mark
  std::string grouped_;         // the first number whose comma may be none
  std::pair<std::uint64_t, std::size_t> grouped_place_;
  std::set<std::string_view> rings_;
  std::uint64_t returned_line_ = 0;  // the first where a ring comes again
};

}  // namespace

Result<Domain> read_csv_rings(const std::filesystem::path& path, bool lonlat) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path.string(), contents->text(), lonlat).read();
}

}  // namespace weft::files
