// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/medit.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/text_writer.h"
#include "files/formats/derived/marked_edges.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::string_view kFirstWord = "MeshVersionFormatted";
constexpr std::array<std::string_view, 6> kOtherElements = {"Tetrahedra", "Hexahedra",   "Prisms",
                                                            "Pyramids",   "TrianglesP2", "EdgesP2"};

// Fields stand between blanks; lines mean nothing.
class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view text)
      : path_(path), scanner_(path.string(), text) {}

  Result<Mesh> read() {
    if (auto done = scanner_.to_field(kFirstWord); !done) return tl::unexpected(done.error());
    const auto first = scanner_.word(kFirstWord);
    if (!first) return tl::unexpected(first.error());
    if (*first != kFirstWord)
      return scanner_.error("expected the word MeshVersionFormatted, found " + in_quotes(*first));
    if (const auto version = integer("the version"); !version)
      return tl::unexpected(version.error());
    while (has_field()) {
      const auto key = scanner_.word("a keyword");
      if (!key) return tl::unexpected(key.error());
      if (*key == "End") break;
      if (auto done = section(*key); !done) return tl::unexpected(done.error());
    }
    return validated(path_, std::move(mesh_));
  }

 private:
  // Whether there is another field, on this line or below.
  bool has_field() { return !scanner_.at_line_end() || scanner_.try_next_line(); }
  Result<std::int64_t> integer(std::string_view what) {
    if (auto done = scanner_.to_field(what); !done) return tl::unexpected(done.error());
    return scanner_.integer(what);
  }
  Result<std::uint64_t> count(std::string_view what) {
    if (auto done = scanner_.to_field(what); !done) return tl::unexpected(done.error());
    return scanner_.count(what);
  }

  Result<void> section(std::string_view key) {
    if (key == "Dimension") return dimension();
    if (key == "Vertices") return vertices();
    if (key == "Edges") return elements("the edge count", 2, mesh_.edges, mesh_.edge_markers);
    if (key == "Triangles")
      return elements("the triangle count", 3, mesh_.triangles, mesh_.regions);
    if (key == "Quadrilaterals") return quadrilaterals();
    return other(key);
  }

  Result<void> dimension() {
    const auto found = integer("the dimension");
    if (!found) return tl::unexpected(found.error());
    if (*found != 2 && *found != 3)
      return scanner_.error("the dimension is " + std::to_string(*found) +
                            ", only 2 and 3 are read");
    dimension_ = *found;
    return {};
  }

  Result<void> vertices() {
    if (dimension_ == 0) return scanner_.error("Vertices stand before the Dimension");
    const auto number = count("the vertex count");
    if (!number) return tl::unexpected(number.error());
    mesh_.coordinates.reserve(2 * *number);
    for (std::uint64_t i = 0; i < *number; ++i) {
      for (std::int64_t axis = 0; axis < dimension_; ++axis) {
        if (auto done = scanner_.to_field("a coordinate"); !done) return done;
        const auto value = scanner_.real("a coordinate");
        if (!value) return tl::unexpected(value.error());
        if (axis < 2) mesh_.coordinates.push_back(*value);
      }
      if (auto reference = integer("the vertex's reference"); !reference)
        return tl::unexpected(reference.error());
    }
    return {};
  }

  Result<void> elements(std::string_view what, int corners, std::vector<std::uint32_t>& nodes,
                        std::vector<std::int32_t>& references) {
    const auto number = count(what);
    if (!number) return tl::unexpected(number.error());
    for (std::uint64_t i = 0; i < *number; ++i) {
      for (int k = 0; k < corners; ++k) {
        if (auto done = scanner_.to_field("a vertex"); !done) return done;
        // Vertices may come later, so that their numbers are checked at the end.
        const auto v =
            read_index(scanner_, "a vertex", 1, std::numeric_limits<std::uint32_t>::max());
        if (!v) return tl::unexpected(v.error());
        nodes.push_back(*v);
      }
      if (auto done = scanner_.to_field("a reference"); !done) return done;
      const auto reference = scanner_.marker("a reference");
      if (!reference) return tl::unexpected(reference.error());
      references.push_back(*reference);
    }
    return {};
  }

  Result<void> quadrilaterals() {
    std::vector<std::uint32_t> corners;
    std::vector<std::int32_t> references;
    auto done = elements("the quadrilateral count", 4, corners, references);
    for (std::size_t i = 0; done && i < references.size(); ++i)
      mesh_.faces.add(std::span(corners).subspan(4 * i, 4), references[i]);
    return done;
  }

  // Passes over the numbers of a section that is not read.
  Result<void> other(std::string_view key) {
    const auto is_letter = [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; };
    if (!is_letter(key.front()))
      return scanner_.error("expected a keyword, found " + in_quotes(key));
    const bool is_element =
        std::find(kOtherElements.begin(), kOtherElements.end(), key) != kOtherElements.end();
    bool is_first = true;
    while (has_field() && !is_letter(scanner_.rest_of_line().front())) {
      const auto field = scanner_.word("a number");
      if (!field) return tl::unexpected(field.error());
      if (is_element && is_first && *field != "0")
        return scanner_.error("there are " + std::string(key) +
                              ", only Triangles and Edges are read");
      is_first = false;
    }
    return {};
  }

  const std::filesystem::path& path_;
  LineScanner scanner_;
  std::int64_t dimension_ = 0;
  Mesh mesh_;
};

}  // namespace

void write_medit(const MeshView& mesh, OutputFile& file) {
  put_line(file, kFirstWord, 2);
  put_line(file, "Dimension", 2);
  put_line(file, "Vertices");
  put_line(file, mesh.vertex_count());
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], 0);
  const MeshEdges edges(mesh);
  const MarkedEdges marked(mesh, edges);
  put_line(file, "Edges");
  put_line(file, marked.size());
  for (const std::size_t i : mesh.up_to(marked.size())) {
    const auto [from, to] = marked.ends(i);
    put_line(file, from + std::int64_t{1}, to + std::int64_t{1}, marked.marker(i));
  }
  put_line(file, "Triangles");
  put_line(file, mesh.triangle_count());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, corner[0] + std::int64_t{1}, corner[1] + std::int64_t{1},
             corner[2] + std::int64_t{1}, mesh.regions[t]);
  }
  put_line(file, "End");
}

Result<Mesh> read_medit(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

}  // namespace weft::files
