// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/base/text.h"
#include "client/formats/files/file_contents.h"
#include "client/formats/mesh_formats.h"
#include "client/formats/meshes/vtu.h"

namespace weft::client {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 30;
constexpr std::string_view kBlanks = " \t\r\n";

using Attributes = std::map<std::string_view, std::string_view>;

// A start tag and the text after it.
struct Tag {
  std::string_view name;
  Attributes attributes;
  std::string_view text;  // up to the next '<'
};

// An array of the grid whose values are not read yet.
struct Array {
  std::string_view type;
  bool ascii = false;
  std::string_view text;     // of an ASCII array
  std::uint64_t offset = 0;  // of an appended one
};
using Arrays = std::map<std::string_view, Array>;

class Reader {
 public:
  Reader(std::filesystem::path path, std::string_view text) : path_(std::move(path)), rest_(text) {}

  Result<Mesh> read() {
    if (auto scanned = scan(); !scanned) return tl::unexpected(scanned.error());
    return mesh();
  }

  Result<MeshWithArrays> read_values(const std::optional<std::string>& wanted) {
    if (auto scanned = scan(); !scanned) return tl::unexpected(scanned.error());
    std::vector<std::string> names;
    for (const auto& [name, array] : point_arrays_) names.emplace_back(name);
    const auto chosen = chosen_arrays(path_, std::move(names), wanted);
    if (!chosen) return tl::unexpected(chosen.error());
    auto read = mesh();
    if (!read) return tl::unexpected(read.error());
    MeshWithArrays all{std::move(*read), {}};
    for (const std::string& name : *chosen)
      all.arrays.push_back({name, values<double>(point_arrays_, name, points_)});
    return all;
  }

 private:
  Result<Mesh> mesh() const {
    const auto points = values<double>(arrays_, "Points", 3 * points_);
    if (!points) return tl::unexpected(points.error());
    const auto types = values<std::uint64_t>(arrays_, "types", cells_);
    if (!types) return tl::unexpected(types.error());
    const auto offsets = values<std::uint64_t>(arrays_, "offsets", cells_);
    if (!offsets) return tl::unexpected(offsets.error());
    const auto corners =
        values<std::uint64_t>(arrays_, "connectivity", offsets->empty() ? 0 : offsets->back());
    if (!corners) return tl::unexpected(corners.error());
    const auto regions = optional_values("region");
    if (!regions) return tl::unexpected(regions.error());
    const auto markers = optional_values("marker");
    if (!markers) return tl::unexpected(markers.error());
    const auto parts = optional_values("part");

    Mesh mesh;
    read_names(mesh);
    mesh.coordinates.reserve(2 * points_);
    for (std::size_t i = 0; i < points_; ++i)
      mesh.coordinates.insert(mesh.coordinates.end(), {(*points)[3 * i], (*points)[3 * i + 1]});
    std::uint64_t first = 0;
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      const std::uint64_t end = (*offsets)[cell];
      const std::uint64_t type = (*types)[cell];
      constexpr std::uint64_t kCorners[] = {0, 1, 0, 2, 0, 3};  // vertex, line and triangle
      if (type >= std::size(kCorners) || kCorners[type] == 0)
        return refuse("cell " + std::to_string(cell) + " has the type " + std::to_string(type) +
                      ", which is no vertex, line or triangle");
      if (end < first || end - first != kCorners[type] || end > corners->size())
        return refuse("cell " + std::to_string(cell) + " has a wrong offset");
      auto& list = type == 5 ? mesh.triangles : mesh.edges;
      for (; first < end; ++first) {
        const std::uint64_t v = (*corners)[first];
        if (v >= points_)
          return refuse("cell " + std::to_string(cell) + " has vertex " + std::to_string(v) +
                        " of " + std::to_string(points_));
        if (type != 1) list.push_back(static_cast<std::uint32_t>(v));
      }
      if (type == 5) mesh.regions.push_back(regions->empty() ? 0 : (*regions)[cell]);
      if (type == 5 && parts && !parts->empty()) mesh.parts.push_back((*parts)[cell]);
      if (type == 3) mesh.edge_markers.push_back(markers->empty() ? 0 : (*markers)[cell]);
    }
    // Other programs may use the name for something else.
    if (std::any_of(mesh.parts.begin(), mesh.parts.end(), [](std::int32_t p) { return p < 0; }))
      mesh.parts.clear();
    return validated(path_, std::move(mesh));
  }

  tl::unexpected<Error> refuse(const std::string& why) const {
    return fail(ExitCode::kUnreadableInput, path_.string() + ": " + why);
  }

  static std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  // The next start tag; none at the end of the text.
  Result<std::optional<Tag>> next_tag() {
    for (;;) {
      const std::size_t open = rest_.find('<');
      if (open == std::string_view::npos) return std::nullopt;
      rest_.remove_prefix(open + 1);
      if (!rest_.starts_with('/') && !rest_.starts_with('?') && !rest_.starts_with('!')) break;
    }
    const std::size_t close = rest_.find('>');
    if (close == std::string_view::npos) return refuse("a tag does not end");
    std::string_view inside = rest_.substr(0, close);
    rest_.remove_prefix(close + 1);
    Tag tag;
    tag.text = rest_.substr(0, rest_.find('<'));
    tag.name = inside.substr(0, inside.find_first_of(" \t\r\n/"));
    inside.remove_prefix(tag.name.size());
    for (;;) {
      const std::size_t start = inside.find_first_not_of(kBlanks);
      if (start == std::string_view::npos || inside[start] == '/') return tag;
      inside.remove_prefix(start);
      const std::size_t equals = inside.find('=');
      if (equals == std::string_view::npos || equals + 1 >= inside.size())
        return refuse("the tag " + in_quotes(tag.name) + " is malformed");
      const char quote = inside[equals + 1];
      const std::size_t end = inside.find(quote, equals + 2);
      if ((quote != '"' && quote != '\'') || end == std::string_view::npos)
        return refuse("the tag " + in_quotes(tag.name) + " is malformed");
      tag.attributes[inside.substr(0, equals)] = inside.substr(equals + 2, end - equals - 2);
      inside.remove_prefix(end + 1);
    }
  }

  // Finds the counts, the arrays and the appended data.
  Result<void> scan() {
    bool is_grid = false;
    bool in_points = false;
    bool in_point_data = false;
    bool in_field_data = false;
    for (;;) {
      const auto next = next_tag();
      if (!next) return tl::unexpected(next.error());
      if (!*next) return is_grid ? Result<void>{} : refuse("is not a VTK unstructured grid");
      Tag tag = **next;
      if (tag.name == "VTKFile") {
        is_grid = tag.attributes["type"] == "UnstructuredGrid";
        if (!is_grid) return refuse("is not a VTK unstructured grid");
        if (tag.attributes["byte_order"] == "BigEndian") return refuse("is big-endian");
        if (tag.attributes.contains("compressor")) return refuse("is compressed");
        wide_headers_ = tag.attributes["header_type"] == "UInt64";
      } else if (tag.name == "FieldData") {
        in_field_data = true;
      } else if (tag.name == "Piece") {
        in_field_data = false;
        const auto points = number(tag.attributes["NumberOfPoints"]);
        const auto cells = number(tag.attributes["NumberOfCells"]);
        if (!points || !cells || *points > std::numeric_limits<std::uint32_t>::max() ||
            *cells > std::numeric_limits<std::uint32_t>::max())
          return refuse("its piece has no valid counts of points and cells");
        if (has_piece_) return refuse("has more than one piece");
        has_piece_ = true;
        points_ = *points;
        cells_ = *cells;
      } else if (tag.name == "Points") {
        in_points = true;
        in_point_data = false;
      } else if (tag.name == "PointData") {
        in_point_data = true;
      } else if (tag.name == "Cells" || tag.name == "CellData") {
        in_point_data = false;
      } else if (tag.name == "DataArray" && in_field_data) {
        keep_field(tag);
      } else if (tag.name == "DataArray") {
        if (auto kept = keep(tag, in_points, in_point_data ? point_arrays_ : arrays_); !kept)
          return kept;
        in_points = false;
      } else if (tag.name == "AppendedData") {
        if (tag.attributes["encoding"] != "raw") return refuse("its appended data is not raw");
        const std::size_t start = rest_.find('_');
        if (start == std::string_view::npos) return refuse("its appended data is missing");
        appended_ = rest_.substr(start + 1);
        return {};
      }
    }
  }

  // Field data may hold anything; what is not a name is skipped.
  void keep_field(Tag& tag) {
    Array array;
    array.type = tag.attributes["type"];
    array.ascii = tag.attributes["format"] == "ascii";
    array.text = tag.text;
    const auto offset = number(tag.attributes["offset"]);
    if (!array.ascii && !(tag.attributes["format"] == "appended" && offset)) return;
    array.offset = offset.value_or(0);
    fields_.emplace_back(tag.attributes["Name"], array);
  }

  void read_names(Mesh& mesh) const {
    NameReader names(path_.string());
    for (const auto& [name, array] : fields_) {
      if (!array.type.starts_with("Int")) continue;
      const auto entry = values_of<std::int32_t>(array, name, 2);
      if (!entry || ((*entry)[1] != 1 && (*entry)[1] != 2)) continue;
      names.add((*entry)[1] == 1 ? NameKind::kMarker : NameKind::kRegion, (*entry)[0],
                unescaped(name));
    }
    mesh.warnings = names.warnings();
    mesh.names = names.take();
  }

  static std::string unescaped(std::string_view text) {
    static constexpr std::pair<std::string_view, char> kEntities[] = {
        {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
    std::string out;
    while (!text.empty()) {
      const auto* const found =
          std::find_if(std::begin(kEntities), std::end(kEntities),
                       [text](const auto& entity) { return text.starts_with(entity.first); });
      const bool is_entity = found != std::end(kEntities);
      out += is_entity ? found->second : text[0];
      text.remove_prefix(is_entity ? found->first.size() : 1);
    }
    return out;
  }

  Result<void> keep(Tag& tag, bool is_points, Arrays& arrays) {
    Array array;
    array.type = tag.attributes["type"];
    const std::string_view format = tag.attributes["format"];
    const std::string_view name = is_points ? "Points" : tag.attributes["Name"];
    if (format == "ascii") {
      array.ascii = true;
      array.text = tag.text;
    } else if (const auto offset = number(tag.attributes["offset"]);
               format == "appended" && offset) {
      array.offset = *offset;
    } else {
      return refuse("the array " + in_quotes(name) + " is neither ASCII nor appended");
    }
    arrays[name] = array;
    return {};
  }

  // Converts one value; nullopt if it does not fit into T.
  template <class T, class From>
  static std::optional<T> convert(From value) {
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(value);
    } else {
      const auto number = static_cast<long double>(value);  // holds all integers of 64 bits
      if (!(number >= static_cast<long double>(std::numeric_limits<T>::min()) &&
            number <= static_cast<long double>(std::numeric_limits<T>::max())))
        return std::nullopt;
      return static_cast<T>(value);
    }
  }

  template <class T, class From>
  bool append_raw(std::string_view bytes, std::vector<T>& out) const {
    for (std::size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From)) {
      From value;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      const auto converted = convert<T>(value);
      if (!converted) return false;
      out.push_back(*converted);
    }
    return true;
  }

  template <class T>
  static bool append_text(std::string_view text, std::vector<T>& out) {
    for (;;) {
      const std::size_t start = text.find_first_not_of(kBlanks);
      if (start == std::string_view::npos) return true;
      text.remove_prefix(start);
      T value{};
      const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (problem != std::errc()) return false;
      out.push_back(value);
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
  }

  template <class T>
  Result<std::vector<T>> values(const Arrays& arrays, std::string_view name,
                                std::uint64_t count) const {
    const auto found = arrays.find(name);
    if (found == arrays.end()) return refuse("has no array " + in_quotes(name));
    return values_of<T>(found->second, name, count);
  }

  template <class T>
  Result<std::vector<T>> values_of(const Array& array, std::string_view name,
                                   std::uint64_t count) const {
    std::vector<T> out;
    bool read = false;
    if (array.ascii) {
      read = append_text(array.text, out);
    } else {
      const std::size_t header = wide_headers_ ? 8 : 4;
      if (array.offset > appended_.size() || appended_.size() - array.offset < header)
        return refuse("the array " + in_quotes(name) + " lies beyond the end of the file");
      std::uint64_t size = 0;
      std::memcpy(&size, appended_.data() + array.offset, header);
      if (size > appended_.size() - array.offset - header)
        return refuse("the array " + in_quotes(name) + " goes on beyond the end of the file");
      const std::string_view bytes = appended_.substr(array.offset + header, size);
      if (array.type == "Float64") read = append_raw<T, double>(bytes, out);
      if (array.type == "Float32") read = append_raw<T, float>(bytes, out);
      if (array.type == "Int64") read = append_raw<T, std::int64_t>(bytes, out);
      if (array.type == "UInt64") read = append_raw<T, std::uint64_t>(bytes, out);
      if (array.type == "Int32") read = append_raw<T, std::int32_t>(bytes, out);
      if (array.type == "UInt32") read = append_raw<T, std::uint32_t>(bytes, out);
      if (array.type == "Int16") read = append_raw<T, std::int16_t>(bytes, out);
      if (array.type == "UInt16") read = append_raw<T, std::uint16_t>(bytes, out);
      if (array.type == "Int8") read = append_raw<T, std::int8_t>(bytes, out);
      if (array.type == "UInt8") read = append_raw<T, std::uint8_t>(bytes, out);
    }
    if (!read)
      return refuse("the array " + in_quotes(name) + " of type " + in_quotes(array.type) +
                    " holds a value that does not belong there");
    if (out.size() != count)
      return refuse("the array " + in_quotes(name) + " has " + std::to_string(out.size()) +
                    " values, it should have " + std::to_string(count));
    return out;
  }

  Result<std::vector<std::int32_t>> optional_values(std::string_view name) const {
    if (!arrays_.contains(name)) return std::vector<std::int32_t>{};
    return values<std::int32_t>(arrays_, name, cells_);
  }

  std::filesystem::path path_;
  std::string_view rest_;
  Arrays point_arrays_;
  Arrays arrays_;                                           // all others
  std::vector<std::pair<std::string_view, Array>> fields_;  // of the grid
  std::string_view appended_;
  bool has_piece_ = false;
  bool wide_headers_ = false;
  std::uint64_t points_ = 0;
  std::uint64_t cells_ = 0;
};

}  // namespace

Result<Mesh> read_vtu(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxFileBytes, LineEnds::kAsTheyAre);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

Result<MeshWithArrays> read_vtu_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted) {
  const auto contents = read_text_file(path, kMaxFileBytes, LineEnds::kAsTheyAre);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read_values(wanted);
}

}  // namespace weft::client
