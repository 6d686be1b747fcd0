// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/number_text.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/msh.h"
#include "files/formats/meshes/msh_group_losses.h"

namespace weft::files {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 30;
constexpr std::string_view kBlanks = " \t\r\n";

// The types of elements. The first two are also their dimensions.
constexpr std::int32_t kLine = 1;
constexpr std::int32_t kTriangle = 2;
constexpr std::int32_t kQuadrilateral = 3;
constexpr std::int32_t kLineOfThree = 8;
constexpr std::int32_t kTriangleOfSix = 9;
constexpr std::int32_t kPoint = 15;

// Thrown and caught in this file only: a format of nested counts is easiest to read without a check
// after every field.
struct Malformed {
  std::string why;
};

class Reader {
 public:
  Reader(std::filesystem::path path, std::string_view text)
      : path_(std::move(path)), whole_(text), rest_(text), names_(path_.string()) {}

  Result<Mesh> read() {
    return read_or_refuse<Mesh>([this] {
      read_sections();
      return validated(path_, std::move(mesh_));
    });
  }

  Result<MeshWithArrays> read_values(const std::optional<std::string>& wanted) {
    return read_or_refuse<MeshWithArrays>([&]() -> Result<MeshWithArrays> {
      read_sections();
      std::vector<std::string> names;
      for (const auto& [name, data] : node_data_) names.push_back(name);
      const auto chosen = chosen_arrays(path_, std::move(names), wanted);
      if (!chosen) return tl::unexpected(chosen.error());
      std::vector<NamedArray> arrays;
      for (const std::string& name : *chosen) {
        rest_ = node_data_.at(name);
        arrays.push_back(
            {name, read_or_refuse<std::vector<double>>(
                       [this]() -> Result<std::vector<double>> { return read_node_data(); })});
      }
      auto mesh = validated(path_, std::move(mesh_));
      if (!mesh) return tl::unexpected(mesh.error());
      return MeshWithArrays{std::move(*mesh), std::move(arrays)};
    });
  }

 private:
  using Tag = std::pair<std::int32_t, std::int32_t>;  // dimension, number

  template <class T, class Read>
  Result<T> read_or_refuse(const Read& read) {
    try {
      return read();
    } catch (const Malformed& malformed) {
      return fail(ExitCode::kUnreadableInput, path_.string() + ": byte " +
                                                  std::to_string(whole_.size() - rest_.size()) +
                                                  ": " + malformed.why);
    }
  }

  void read_sections() {
    bool has_format = false;
    for (std::string_view line = next_line(); !line.empty(); line = next_line()) {
      if (line == "$MeshFormat") {
        read_format();
        has_format = true;
      } else if (!has_format) {
        throw Malformed{"is not a Gmsh mesh: it does not start with $MeshFormat"};
      } else if (line == "$PhysicalNames") {  // text even in binary files
        read_names();
      } else if (line == "$Entities") {
        read_entities();
      } else if (line == "$Nodes") {
        is_22_ ? read_nodes_22() : read_nodes();
      } else if (line == "$Elements") {
        is_22_ ? read_elements_22() : read_elements();
      } else if (line.starts_with("$")) {
        if (line == "$NodeData") keep_node_data();
        skip_to("$End" + std::string(line.substr(1)));
        continue;
      } else {
        throw Malformed{"a section should start here, found " + in_quotes(line)};
      }
      expect("$End" + std::string(line.substr(1)));
    }
    if (!has_format) throw Malformed{"is empty"};
    if (!has_nodes_ || !has_elements_) throw Malformed{"has no $Nodes or no $Elements"};
    if (is_22_) losses_.remove_repeated(mesh_, groups_);
    losses_.keep(groups_);
    mesh_.warnings = names_.warnings();
    for (const std::string& sentence : losses_.sentences())
      mesh_.warnings.push_back(
          {.kind = WarningKind::kGroup, .file = path_.string(), .text = sentence});
    mesh_.names = names_.take();
  }

  // The next line that is not blank; empty at the end.
  std::string_view next_line() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::string_view line = rest_.substr(0, rest_.find_first_of("\r\n"));
    rest_.remove_prefix(line.size());
    return trimmed(line);
  }

  void expect(const std::string& marker) {
    const std::string_view line = next_line();
    if (line != marker) throw Malformed{"expected " + marker + ", found " + in_quotes(line)};
  }

  void skip_to(const std::string& marker) {
    const std::size_t at = rest_.find(marker);
    if (at == std::string_view::npos) throw Malformed{"a section does not end with " + marker};
    rest_.remove_prefix(at + marker.size());
  }

  template <class T>
  T text_number() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const auto is_blank = [](char c) { return kBlanks.find(c) != std::string_view::npos; };
    const std::string_view word(rest_.begin(), std::find_if(rest_.begin(), rest_.end(), is_blank));
    T value{};
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    bool whole = problem == std::errc() && end == word.data() + word.size();
    if constexpr (std::is_same_v<T, double>) {
      if (const auto real = whole ? std::nullopt : real_of(word)) {
        value = *real;
        whole = true;
      }
    }
    if (!whole) throw Malformed{"expected a number, found " + in_quotes(word)};
    rest_.remove_prefix(word.size());
    return value;
  }

  template <class T>
  T next() {
    if (!binary_) return text_number<T>();
    if (rest_.size() < sizeof(T)) throw Malformed{"the file ends inside a section"};
    T value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }

  // The number of items that follow, each of which takes one byte at least.
  std::uint64_t count() {
    const auto value = next<std::uint64_t>();
    if (value > rest_.size())
      throw Malformed{"announces " + std::to_string(value) + " items, more than the file can hold"};
    return value;
  }

  // Binary data starts right after the line that opens the section.
  void start_data() {
    if (!binary_) return;
    if (rest_.starts_with('\r')) rest_.remove_prefix(1);
    if (rest_.starts_with('\n')) rest_.remove_prefix(1);
  }

  void read_format() {
    const auto version = text_number<double>();
    if (version != 4.1 && version != 2.2)
      throw Malformed{"has the version " + shortest(version) + ", only 4.1 and 2.2 are read"};
    is_22_ = version == 2.2;
    binary_ = text_number<int>() == 1;
    if (text_number<int>() != 8) throw Malformed{"its numbers are not of 8 bytes"};
    start_data();
    if (binary_ && next<std::int32_t>() != 1) throw Malformed{"is big-endian"};
  }

  void read_names() {
    const auto names = text_number<std::uint64_t>();
    for (std::uint64_t i = 0; i < names; ++i) {
      const auto dimension = text_number<std::int32_t>();
      const auto tag = text_number<std::int32_t>();
      const std::string_view line = next_line();
      if (line.size() < 2 || !line.starts_with('"') || !line.ends_with('"'))
        throw Malformed{"a physical name is not in quotes"};
      read_name({dimension, tag}, line.substr(1, line.size() - 2));
    }
  }

  void read_name(Tag group, std::string_view name) {
    losses_.name(group, name);
    for (const std::string_view word : {"region ", "marker "}) {
      if (!name.starts_with(word)) continue;
      const std::string_view number = name.substr(word.size());
      std::int32_t id = 0;
      const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), id);
      if (problem != std::errc() || end != number.data() + number.size()) continue;
      id_of_group_[group] = id;
      return;
    }
    if (group.first == kLine) names_.add(NameKind::kMarker, group.second, name);
    if (group.first == kTriangle) names_.add(NameKind::kRegion, group.second, name);
  }

  void read_entities() {
    start_data();
    std::uint64_t counts[4];
    for (auto& n : counts) n = count();
    for (std::int32_t dimension = 0; dimension < 4; ++dimension) {
      for (std::uint64_t i = 0; i < counts[dimension]; ++i) {
        const auto tag = next<std::int32_t>();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) next<double>();
        const std::uint64_t groups = count();
        for (std::uint64_t g = 0; g < groups; ++g) {
          const auto group = next<std::int32_t>();
          groups_of_entity_[{dimension, tag}].push_back(group);
        }
        if (dimension == 0) continue;
        const std::uint64_t bounding = count();
        for (std::uint64_t b = 0; b < bounding; ++b) next<std::int32_t>();
      }
    }
  }

  // The group of the elements of an entity; 0 if it has none.
  std::int32_t group_of(Tag entity, std::uint64_t elements) {
    const auto groups = groups_of_entity_.find(entity);
    if (groups == groups_of_entity_.end()) return 0;
    const std::int32_t first = groups->second.front();
    for (const std::int32_t group : groups->second)
      if (group != first && elements > 0)
        losses_.lose({entity.first, group}, {entity.first, first}, elements);
    return first;
  }
  std::int32_t id_of_group(std::int32_t dimension, std::int32_t group) const {
    const auto id = id_of_group_.find({dimension, group});
    return id != id_of_group_.end() ? id->second : group;
  }

  void read_nodes() {
    start_data();
    has_nodes_ = true;
    const std::uint64_t blocks = count();
    const std::uint64_t total = count();
    if (total > std::numeric_limits<std::uint32_t>::max()) throw Malformed{"has too many nodes"};
    next<std::uint64_t>();
    next<std::uint64_t>();
    std::vector<std::pair<std::uint64_t, std::uint64_t>> place_of_tag;  // tag, place in the file
    std::vector<double> coordinates;
    place_of_tag.reserve(total);
    coordinates.reserve(2 * total);
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const auto dimension = next<std::int32_t>();
      next<std::int32_t>();
      const bool parametric = next<std::int32_t>() != 0;
      const std::uint64_t nodes = count();
      for (std::uint64_t i = 0; i < nodes; ++i) {
        const auto tag = next<std::uint64_t>();
        place_of_tag.emplace_back(tag, place_of_tag.size());
      }
      for (std::uint64_t i = 0; i < nodes; ++i) {
        const auto x = next<double>();
        const auto y = next<double>();
        next<double>();
        coordinates.insert(coordinates.end(), {x, y});
        for (std::int32_t k = 0; parametric && k < dimension; ++k) next<double>();
      }
    }
    take_nodes(place_of_tag, coordinates);
  }

  void read_nodes_22() {
    has_nodes_ = true;
    const auto nodes = text_count();
    std::vector<std::pair<std::uint64_t, std::uint64_t>> place_of_tag;
    std::vector<double> coordinates;
    place_of_tag.reserve(nodes);
    coordinates.reserve(2 * nodes);
    for (std::uint64_t i = 0; i < nodes; ++i) {
      const auto tag = next<std::int32_t>();
      place_of_tag.emplace_back(static_cast<std::uint32_t>(tag), i);
      const auto x = next<double>();
      const auto y = next<double>();
      next<double>();
      coordinates.insert(coordinates.end(), {x, y});
    }
    take_nodes(place_of_tag, coordinates);
  }

  // The number of items that follow, which is text even in binary files of 2.2.
  std::uint64_t text_count() {
    const auto value = text_number<std::uint64_t>();
    if (value > rest_.size() || value > std::numeric_limits<std::uint32_t>::max())
      throw Malformed{"announces " + std::to_string(value) + " items, more than the file can hold"};
    start_data();
    return value;
  }

  // `place_of_tag`: tag of a node, its place in `coordinates`.
  void take_nodes(std::vector<std::pair<std::uint64_t, std::uint64_t>>& place_of_tag,
                  const std::vector<double>& coordinates) {
    // Vertices are sorted by tag, so that a mesh is read back in the order in which it was written.
    std::sort(place_of_tag.begin(), place_of_tag.end());
    for (const auto& [tag, place] : place_of_tag) {
      if (!tags_.empty() && tags_.back() == tag)
        throw Malformed{"has two nodes with the tag " + std::to_string(tag)};
      tags_.push_back(tag);
      mesh_.coordinates.insert(mesh_.coordinates.end(),
                               {coordinates[2 * place], coordinates[2 * place + 1]});
    }
  }

  std::uint32_t vertex(std::uint64_t tag, std::string_view who) const {
    if (tags_.empty()) throw Malformed{"has elements before nodes"};
    // Where tags have no gaps, the number follows from the tag.
    if (tag >= tags_.front() && tag - tags_.front() < tags_.size() &&
        tags_[tag - tags_.front()] == tag)
      return static_cast<std::uint32_t>(tag - tags_.front());
    const auto found = std::lower_bound(tags_.begin(), tags_.end(), tag);
    if (found == tags_.end() || *found != tag)
      throw Malformed{std::string(who) + " names the node " + std::to_string(tag) +
                      ", which is missing"};
    return static_cast<std::uint32_t>(found - tags_.begin());
  }

  // The name of a section $NodeData, and where its rest begins.
  void keep_node_data() {
    const auto texts = text_number<std::uint64_t>();
    std::string_view name = next_line();
    if (texts == 0 || name.size() < 2 || !name.starts_with('"') || !name.ends_with('"'))
      throw Malformed{"the name of node data is not in quotes"};
    for (std::uint64_t i = 1; i < texts; ++i)
      if (next_line().empty()) throw Malformed{"the file ends inside a section"};
    node_data_.insert_or_assign(std::string(name.substr(1, name.size() - 2)), rest_);
  }

  // The value at each vertex of the node data whose name was read.
  std::vector<double> read_node_data() {
    const auto reals = text_number<std::uint64_t>();
    for (std::uint64_t i = 0; i < reals; ++i) text_number<double>();
    const auto integers = text_number<std::uint64_t>();
    if (integers < 3) throw Malformed{"node data has fewer than 3 integers"};
    text_number<std::int64_t>();  // the time step
    const auto components = text_number<std::int64_t>();
    if (components != 1)
      throw Malformed{"the node data has " + std::to_string(components) +
                      " components, only one is read"};
    const auto nodes = text_number<std::uint64_t>();
    for (std::uint64_t i = 3; i < integers; ++i) text_number<std::int64_t>();
    start_data();
    std::vector<double> values(tags_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::uint64_t i = 0; i < nodes; ++i) {
      const auto tag = next<std::int32_t>();
      const auto value = next<double>();
      values[vertex(static_cast<std::uint32_t>(tag), "node data")] = value;
    }
    return values;
  }

  void read_elements() {
    start_data();
    has_elements_ = true;
    const std::uint64_t blocks = count();
    for (int k = 0; k < 3; ++k) next<std::uint64_t>();
    for (std::uint64_t block = 0; block < blocks; ++block) {
      const auto dimension = next<std::int32_t>();
      const auto entity = next<std::int32_t>();
      const auto type = next<std::int32_t>();
      const std::uint64_t elements = count();
      check_type(type);
      const std::int32_t group = group_of({dimension, entity}, elements);
      for (std::uint64_t i = 0; i < elements; ++i) {
        next<std::uint64_t>();
        read_element<std::uint64_t>(type, group);
      }
    }
  }

  // Text: number, type, tags, nodes. Binary: blocks that start with type, elements, tags.
  void read_elements_22() {
    has_elements_ = true;
    const auto elements = text_count();
    std::int32_t type = 0;
    std::int32_t tags = 0;
    std::int32_t in_block = 0;
    for (std::uint64_t i = 0; i < elements; ++i) {
      if (binary_ && in_block == 0) {
        type = next<std::int32_t>();
        in_block = next<std::int32_t>();
        tags = next<std::int32_t>();
        if (in_block <= 0) throw Malformed{"has a block of no elements"};
      }
      --in_block;
      next<std::int32_t>();
      if (!binary_) {
        type = next<std::int32_t>();
        tags = next<std::int32_t>();
      }
      check_type(type);
      std::int32_t group = 0;
      for (std::int32_t k = 0; k < tags; ++k) {
        const auto tag = next<std::int32_t>();
        if (k == 0) group = tag;
      }
      read_element<std::int32_t>(type, group);
    }
  }

  static void check_type(std::int32_t type) {
    if (type != kLine && type != kTriangle && type != kQuadrilateral && type != kPoint &&
        type != kLineOfThree && type != kTriangleOfSix)
      throw Malformed{"has elements of type " + std::to_string(type) +
                      ", which are no triangles, quadrilaterals, lines or points"};
  }

  template <class NodeTag>
  void read_element(std::int32_t type, std::int32_t group) {
    const bool has_middles = type == kLineOfThree || type == kTriangleOfSix;
    if (has_middles) type -= kLineOfThree - kLine;
    std::array<std::uint32_t, 6> corners;
    const std::size_t count = type == kPoint ? 1 : static_cast<std::size_t>(type) + 1;
    const std::size_t middles = !has_middles ? 0 : type == kLine ? 1 : 3;
    for (std::size_t node = 0; node < count + middles; ++node) {
      const auto tag = next<NodeTag>();
      corners[node] = vertex(static_cast<std::make_unsigned_t<NodeTag>>(tag), "an element");
    }
    if (type == kPoint) return;
    for (std::size_t k = 0; k < middles; ++k)
      mesh_.middles.push_back({corners[k], corners[(k + 1) % count], corners[count + k]});
    const std::int32_t id = id_of_group(type == kLine ? 1 : 2, group);
    if (type == kQuadrilateral) {
      mesh_.faces.add(std::span(corners).first(4), id);
      groups_.of_faces.push_back(group);
      return;
    }
    auto& list = type == kLine ? mesh_.edges : mesh_.triangles;
    list.insert(list.end(), corners.begin(), corners.begin() + count);
    (type == kLine ? mesh_.edge_markers : mesh_.regions).push_back(id);
    (type == kLine ? groups_.of_edges : groups_.of_triangles).push_back(group);
  }

  std::filesystem::path path_;
  std::string_view whole_;
  std::string_view rest_;
  bool binary_ = false;
  bool is_22_ = false;
  bool has_nodes_ = false;
  bool has_elements_ = false;
  std::map<Tag, std::int32_t> id_of_group_;
  std::map<Tag, std::vector<std::int32_t>> groups_of_entity_;
  MshGroups groups_;
  MshGroupLosses losses_;
  std::vector<std::uint64_t> tags_;  // of the vertices, ascending
  // What follows each name of a section $NodeData.
  std::map<std::string, std::string_view> node_data_;
  NameReader names_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_msh(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxFileBytes, LineEnds::kAsTheyAre);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

Result<MeshWithArrays> read_msh_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted) {
  const auto contents = read_text_file(path, kMaxFileBytes, LineEnds::kAsTheyAre);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read_values(wanted);
}

}  // namespace weft::files
