// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/mfem.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

// A name may hold any of these; comments are lines of their own between sections.
constexpr LineSyntax kSyntax{" \t\r\f\v", '\0'};

// Fields stand between blanks; lines mean nothing but for names and comments.
class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view text)
      : path_(path), scanner_(path.string(), text, kSyntax), names_(path.string()) {}

  Result<Mesh> read() {
    if (auto line = scanner_.next_line("MFEM mesh v1.0"); !line)
      return tl::unexpected(line.error());
    const std::string_view first = scanner_.rest_of_line();
    for (const std::string_view word : {"MFEM", "mesh", "v1."}) {
      const auto found = scanner_.word(word);
      if (!found) return tl::unexpected(found.error());
      if (!found->starts_with(word))
        return scanner_.error("expected MFEM mesh v1.0 to v1.3, found " + in_quotes(first));
    }
    while (scanner_.try_next_line()) {
      const auto key = scanner_.word("a section");
      if (!key) return tl::unexpected(key.error());
      if (key->starts_with('#')) continue;
      if (*key == "mfem_mesh_end") break;
      if (auto done = section(*key); !done) return tl::unexpected(done.error());
      if (!scanner_.at_line_end())
        return scanner_.error("the section " + in_quotes(*key) + " has more fields than it says");
    }
    mesh_.warnings = names_.warnings();
    mesh_.names = names_.take();
    return validated(path_, std::move(mesh_));
  }

 private:
  Result<std::int32_t> integer(std::string_view what) {
    if (auto done = scanner_.to_field(what); !done) return tl::unexpected(done.error());
    return scanner_.marker(what);
  }
  Result<std::uint64_t> count(std::string_view what) {
    if (auto done = scanner_.to_field(what); !done) return tl::unexpected(done.error());
    return scanner_.count(what);
  }

  Result<void> section(std::string_view key) {
    if (key == "dimension") return dimension();
    if (key == "elements") return elements("the element count", /*are_lines=*/false);
    if (key == "boundary") return elements("the edge count", /*are_lines=*/true);
    if (key == "vertices") return vertices();
    if (key == "attribute_sets") return sets(NameKind::kRegion);
    if (key == "bdr_attribute_sets") return sets(NameKind::kMarker);
    return scanner_.error("the section " + in_quotes(key) +
                          " is not read: only straight, conforming triangles are");
  }

  Result<void> dimension() {
    const auto found = integer("the dimension");
    if (!found) return tl::unexpected(found.error());
    if (*found != 2)
      return scanner_.error("the dimension is " + std::to_string(*found) + ", only 2 is read");
    return {};
  }

  // "attribute type v0 v1 ...": MFEM's number for a line, a triangle and a square is one less than
  // that of its corners.
  Result<void> elements(std::string_view what, bool are_lines) {
    const auto number = count(what);
    if (!number) return tl::unexpected(number.error());
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < *number; ++i) {
      const auto attribute = integer("the attribute");
      if (!attribute) return tl::unexpected(attribute.error());
      const auto type = integer("the element's type");
      if (!type) return tl::unexpected(type.error());
      if (are_lines ? *type != 1 : *type != 2 && *type != 3)
        return scanner_.error("the element's type is " + std::to_string(*type) + ", only " +
                              (are_lines ? "1 is" : "2 and 3 are") + " read here");
      corners.clear();
      for (int k = 0; k <= *type; ++k) {
        if (auto done = scanner_.to_field("a vertex"); !done) return done;
        // Vertices come later, so that their numbers are checked at the end.
        const auto v =
            read_index(scanner_, "a vertex", 0, std::numeric_limits<std::uint32_t>::max());
        if (!v) return tl::unexpected(v.error());
        corners.push_back(*v);
      }
      if (corners.size() > 3) {
        mesh_.faces.add(corners, *attribute);
        continue;
      }
      auto& list = are_lines ? mesh_.edges : mesh_.triangles;
      list.insert(list.end(), corners.begin(), corners.end());
      (are_lines ? mesh_.edge_markers : mesh_.regions).push_back(*attribute);
    }
    return {};
  }

  Result<void> vertices() {
    const auto number = count("the vertex count");
    if (!number) return tl::unexpected(number.error());
    const auto axes = integer("the number of coordinates");
    if (!axes) return tl::unexpected(axes.error());
    if (*axes != 2 && *axes != 3)
      return scanner_.error("vertices have " + std::to_string(*axes) +
                            " coordinates, only 2 and 3 are read");
    mesh_.coordinates.reserve(2 * *number);
    for (std::uint64_t i = 0; i < *number; ++i)
      for (int axis = 0; axis < *axes; ++axis) {
        if (auto done = scanner_.to_field("a coordinate"); !done) return done;
        const auto value = scanner_.real("a coordinate");
        if (!value) return tl::unexpected(value.error());
        if (axis < 2) mesh_.coordinates.push_back(*value);
      }
    return {};
  }

  // Names, each in quotes on a line of its own, then how many attributes it has, and these.
  Result<void> sets(NameKind kind) {
    const auto number = count("the count of sets");
    if (!number) return tl::unexpected(number.error());
    for (std::uint64_t i = 0; i < *number; ++i) {
      if (auto line = scanner_.next_line("the name of a set"); !line) return line;
      std::string_view name = scanner_.rest_of_line();
      name = name.substr(0, name.find_last_not_of(kSyntax.blanks) + 1);
      if (name.size() < 2 || name.front() != '"' || name.back() != '"')
        return scanner_.error("expected a name in quotes, found " + in_quotes(name));
      if (auto line = scanner_.next_line("the count of attributes"); !line) return line;
      const auto attributes = count("the count of attributes");
      if (!attributes) return tl::unexpected(attributes.error());
      for (std::uint64_t k = 0; k < *attributes; ++k) {
        const auto attribute = integer("an attribute");
        if (!attribute) return tl::unexpected(attribute.error());
        names_.add(kind, *attribute, name.substr(1, name.size() - 2));
      }
    }
    return {};
  }

  const std::filesystem::path& path_;
  LineScanner scanner_;
  NameReader names_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_mfem(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

}  // namespace weft::files
