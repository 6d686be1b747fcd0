// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/vtu.h"
#include "files/formats/meshes/vtu_arrays.h"

namespace weft::files {
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

using Arrays = std::map<std::string_view, VtuArray>;

// VTK's numbers for the kinds of cells, of as many nodes as are listed beside them; 0: any number
// from `least` on.
struct CellKind {
  std::uint64_t type;
  std::uint64_t nodes;
  std::uint64_t least;
  std::size_t middles = 0;  // the last of the nodes, in the middles of its sides
};
constexpr std::uint64_t kVertex = 1;
constexpr std::uint64_t kVertices = 2;
constexpr std::uint64_t kLine = 3;
constexpr std::uint64_t kChain = 4;
constexpr std::uint64_t kPixel = 8;
constexpr CellKind kCells[] = {{kVertex, 1, 1}, {kVertices, 0, 1}, {kLine, 2, 2},  {kChain, 0, 2},
                               {5, 3, 3},       {7, 0, 3},         {kPixel, 4, 4}, {9, 4, 4},
                               {21, 3, 3, 1},   {22, 6, 6, 3}};

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
    std::vector<std::uint32_t> chain;  // the corners of a cell
    for (std::size_t cell = 0; cell < cells_; ++cell) {
      const std::uint64_t end = (*offsets)[cell];
      const std::uint64_t type = (*types)[cell];
      const auto* const kind = std::find_if(std::begin(kCells), std::end(kCells),
                                            [type](const CellKind& k) { return k.type == type; });
      if (kind == std::end(kCells))
        return refuse("cell " + std::to_string(cell) + " has the type " + std::to_string(type) +
                      ", which is no vertex, line, triangle or polygon");
      if (end < first || end > corners->size() || end - first < kind->least ||
          (kind->nodes != 0 && end - first != kind->nodes))
        return refuse("cell " + std::to_string(cell) + " has a wrong offset");
      chain.assign(corners->begin() + static_cast<std::ptrdiff_t>(first),
                   corners->begin() + static_cast<std::ptrdiff_t>(end));
      first = end;
      for (const std::uint64_t v : chain)
        if (v >= points_)
          return refuse("cell " + std::to_string(cell) + " has vertex " + std::to_string(v) +
                        " of " + std::to_string(points_));
      if (type == kVertex || type == kVertices) continue;
      const std::size_t ends = chain.size() - kind->middles;
      for (std::size_t k = 0; k < kind->middles; ++k)
        mesh.middles.push_back({chain[k], chain[(k + 1) % ends], chain[ends + k]});
      chain.resize(ends);
      if (type == kLine || type == kChain || ends == 2) {
        for (std::size_t k = 1; k < chain.size(); ++k) {
          mesh.edges.insert(mesh.edges.end(), {chain[k - 1], chain[k]});
          mesh.edge_markers.push_back(markers->empty() ? 0 : (*markers)[cell]);
        }
        continue;
      }
      if (type == kPixel) std::swap(chain[2], chain[3]);
      const std::int32_t region = regions->empty() ? 0 : (*regions)[cell];
      const bool is_triangle = chain.size() == 3;
      if (is_triangle) {
        mesh.triangles.insert(mesh.triangles.end(), chain.begin(), chain.end());
        mesh.regions.push_back(region);
      } else {
        mesh.faces.add(chain, region);
      }
      if (parts && !parts->empty())
        (is_triangle ? mesh.parts : mesh.faces.parts).push_back((*parts)[cell]);
    }
    // Other programs may use the name for something else.
    const auto is_none = [](std::int32_t part) { return part < 0; };
    if (std::ranges::any_of(mesh.parts, is_none) || std::ranges::any_of(mesh.faces.parts, is_none))
      mesh.parts = mesh.faces.parts = {};
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
        data_.set_headers(tag.attributes["header_type"] == "UInt64");
        if (auto known = set_compressor(tag.attributes["compressor"]); !known) return known;
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
        const std::string_view encoding = tag.attributes["encoding"];
        if (encoding != "raw" && encoding != "base64")
          return refuse("its appended data is in the encoding " + in_quotes(encoding) +
                        ", only raw and base64 are read");
        const std::size_t start = rest_.find('_');
        if (start == std::string_view::npos) return refuse("its appended data is missing");
        const std::string_view bytes = rest_.substr(start + 1);
        const bool is_base64 = encoding == "base64";
        data_.set_appended(is_base64 ? bytes.substr(0, bytes.find('<')) : bytes, is_base64);
        return {};
      }
    }
  }

  Result<void> set_compressor(std::string_view name) {
    if (name.empty()) return {};
    if (name == "vtkZLibDataCompressor")
      return data_.set_compressor(Packing::kZlib), Result<void>{};
    if (name == "vtkLZ4DataCompressor") return data_.set_compressor(Packing::kLz4), Result<void>{};
    if (name == "vtkLZMADataCompressor")
      return data_.set_compressor(Packing::kLzma), Result<void>{};
    return refuse("is compressed by " + in_quotes(name) +
                  ", only vtkZLibDataCompressor, vtkLZ4DataCompressor and vtkLZMADataCompressor "
                  "are read");
  }

  // Field data may hold anything; what is not a name is skipped.
  void keep_field(Tag& tag) {
    if (const auto array = array_of(tag)) fields_.emplace_back(tag.attributes["Name"], *array);
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

  // Nullopt if the tag does not say where the values are.
  std::optional<VtuArray> array_of(Tag& tag) {
    const std::string_view format = tag.attributes["format"];
    VtuArray array{.type = tag.attributes["type"], .text = tag.text};
    if (format == "ascii") return array;
    array.place = VtuArray::Place::kInline;
    if (format == "binary") return array;
    const auto offset = number(tag.attributes["offset"]);
    if (format != "appended" || !offset) return std::nullopt;
    array.place = VtuArray::Place::kAppended;
    array.offset = *offset;
    data_.add_offset(*offset);
    return array;
  }

  Result<void> keep(Tag& tag, bool is_points, Arrays& arrays) {
    const std::string_view name = is_points ? "Points" : tag.attributes["Name"];
    const auto array = array_of(tag);
    if (!array)
      return refuse("the array " + in_quotes(name) + " is in the format " +
                    in_quotes(tag.attributes["format"]) +
                    ", only ascii, binary and appended are read");
    arrays[name] = *array;
    return {};
  }

  template <class T>
  Result<std::vector<T>> values(const Arrays& arrays, std::string_view name,
                                std::uint64_t count) const {
    const auto found = arrays.find(name);
    if (found == arrays.end()) return refuse("has no array " + in_quotes(name));
    return values_of<T>(found->second, name, count);
  }

  template <class T>
  Result<std::vector<T>> values_of(const VtuArray& array, std::string_view name,
                                   std::uint64_t count) const {
    auto out = data_.values<T>(array);
    if (!out) return refuse("the array " + in_quotes(name) + " " + out.error());
    if (out->size() != count)
      return refuse("the array " + in_quotes(name) + " has " + std::to_string(out->size()) +
                    " values, it should have " + std::to_string(count));
    return std::move(*out);
  }

  Result<std::vector<std::int32_t>> optional_values(std::string_view name) const {
    if (!arrays_.contains(name)) return std::vector<std::int32_t>{};
    return values<std::int32_t>(arrays_, name, cells_);
  }

  std::filesystem::path path_;
  std::string_view rest_;
  Arrays point_arrays_;
  Arrays arrays_;                                              // all others
  std::vector<std::pair<std::string_view, VtuArray>> fields_;  // of the grid
  VtuArrays data_;
  bool has_piece_ = false;
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

}  // namespace weft::files
