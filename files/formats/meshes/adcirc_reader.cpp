// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/node_numbers.h"
#include "files/bytes/number_text.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/adcirc.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::int32_t kOpenMarker = 1;
constexpr std::int32_t kLandMarker = 2;
constexpr std::int32_t kIslandMarker = 3;

// The number that follows the word "marker".
std::int32_t marker_of(std::string_view comment, std::int32_t otherwise) {
  constexpr std::string_view kWord = "marker";
  const std::size_t at = comment.rfind(kWord);
  if (at == std::string_view::npos) return otherwise;
  comment = trimmed(comment.substr(at + kWord.size()));
  std::int32_t marker = otherwise;
  std::from_chars(comment.data(), comment.data() + comment.size(), marker);
  return marker;
}

// Depths are stored if there is a place for them.
Result<void> read_nodes(LineScanner& scanner, std::uint64_t count, NodeNumbers& numbers, Mesh& mesh,
                        std::vector<double>* depths) {
  mesh.coordinates.reserve(2 * count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (auto line = scanner.next_line("a node"); !line) return line;
    if (auto number = numbers.add(scanner, "the node number"); !number) return number;
    for (const char* what : {"the x coordinate", "the y coordinate"}) {
      const auto value = scanner.real(what);
      if (!value) return tl::unexpected(value.error());
      mesh.coordinates.push_back(*value);
    }
    if (depths == nullptr) continue;
    const auto depth = scanner.word("the depth");
    if (!depth) return tl::unexpected(depth.error());
    const auto value = real_of(*depth);
    if (!value && lower_case(*depth).find("nan") == std::string::npos)
      return scanner.error("expected the depth, found " + in_quotes(*depth));
    depths->push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return {};
}

Result<void> read_elements(LineScanner& scanner, std::uint64_t count, const NodeNumbers& numbers,
                           Mesh& mesh) {
  mesh.triangles.reserve(3 * count);
  std::vector<std::uint32_t> face;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (auto line = scanner.next_line("an element"); !line) return line;
    if (auto number = scanner.integer("the element number"); !number)
      return tl::unexpected(number.error());
    const auto corners = scanner.integer("the nodes per element");
    if (!corners) return tl::unexpected(corners.error());
    if (*corners != 3 && *corners != 4)
      return scanner.error("the nodes per element are " + std::to_string(*corners) +
                           ", only 3 and 4 are read");
    face.clear();
    for (std::int64_t k = 0; k < *corners; ++k) {
      const auto v = numbers.read(scanner, "a corner");
      if (!v) return tl::unexpected(v.error());
      face.push_back(*v);
    }
    if (face.size() > 3)
      mesh.faces.add(face, 0);
    else
      mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
  }
  return {};
}

Result<void> read_boundaries(LineScanner& scanner, bool open, const NodeNumbers& numbers,
                             Mesh& mesh) {
  if (!scanner.try_next_line()) return {};  // a grid may end before this
  const auto count = scanner.count("the boundary count");
  if (!count) return tl::unexpected(count.error());
  if (auto line = scanner.next_line("the boundary node count"); !line) return line;
  for (std::uint64_t i = 0; i < *count; ++i) {
    if (auto line = scanner.next_line("the nodes of a boundary"); !line) return line;
    const auto nodes = scanner.integer("the nodes of a boundary");
    if (!nodes) return tl::unexpected(nodes.error());
    std::int64_t type = 0;
    if (!open) {
      const auto value = scanner.integer("the boundary's type");
      if (!value) return tl::unexpected(value.error());
      type = *value;
    }
    const bool island = type % 10 == 1;
    const std::int32_t marker = marker_of(scanner.rest_of_line(), open     ? kOpenMarker
                                                                  : island ? kIslandMarker
                                                                           : kLandMarker);
    if (open && std::ranges::find(mesh.open_markers, marker) == mesh.open_markers.end())
      mesh.open_markers.push_back(marker);
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    const auto add_edge = [&](std::uint32_t from, std::uint32_t to) {
      mesh.edges.insert(mesh.edges.end(), {from, to});
      mesh.edge_markers.push_back(marker);
    };
    for (std::int64_t k = 0; k < *nodes; ++k) {
      if (auto line = scanner.next_line("a boundary node"); !line) return line;
      const auto v = numbers.read(scanner, "a boundary node");
      if (!v) return tl::unexpected(v.error());
      if (k == 0) first = *v;
      if (k > 0) add_edge(last, *v);
      last = *v;
    }
    if (island && last != first) add_edge(last, first);
  }
  return {};
}

Result<Mesh> read_grid(const std::filesystem::path& path, std::vector<double>* depths) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text(), {.comment = '!'});
  scanner.skip_line();  // the title
  if (auto line = scanner.next_line("the element count"); !line)
    return tl::unexpected(line.error());
  const auto elements = scanner.count("the element count");
  if (!elements) return tl::unexpected(elements.error());
  const auto nodes = scanner.count("the node count");
  if (!nodes) return tl::unexpected(nodes.error());
  Mesh mesh;
  NodeNumbers numbers;
  if (auto read = read_nodes(scanner, *nodes, numbers, mesh, depths); !read)
    return tl::unexpected(read.error());
  if (auto read = read_elements(scanner, *elements, numbers, mesh); !read)
    return tl::unexpected(read.error());
  for (const bool open : {true, false})
    if (auto read = read_boundaries(scanner, open, numbers, mesh); !read)
      return tl::unexpected(read.error());
  return validated(path, std::move(mesh));
}

}  // namespace

Result<Mesh> read_adcirc(const std::filesystem::path& path) {
  return read_grid(path, nullptr);
}

Result<MeshWithArrays> read_adcirc_values(const std::filesystem::path& path,
                                          const std::optional<std::string>& wanted) {
  const auto chosen = chosen_arrays(path, {"depth"}, wanted);
  if (!chosen) return tl::unexpected(chosen.error());
  std::vector<double> depths;
  auto mesh = read_grid(path, &depths);
  if (!mesh) return tl::unexpected(mesh.error());
  return with_bed_column(std::move(*mesh), chosen->front(), std::move(depths), wanted);
}

}  // namespace weft::files
