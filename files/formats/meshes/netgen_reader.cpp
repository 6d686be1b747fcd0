// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/netgen.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::string_view kFirstWord = "mesh3d";
constexpr LineSyntax kSyntax{" \t\r\f\v", '#'};

// The name of each number of a section such as bcnames.
using NumberNames = std::map<std::int32_t, std::string>;

bool is_keyword(std::string_view field) {
  return !field.empty() && (field.front() | 0x20) >= 'a' && (field.front() | 0x20) <= 'z';
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view text)
      : path_(path), scanner_(path.string(), text, kSyntax) {}

  Result<Mesh> read() {
    if (auto line = scanner_.next_line(kFirstWord); !line) return tl::unexpected(line.error());
    const auto first = scanner_.word(kFirstWord);
    if (!first) return tl::unexpected(first.error());
    if (*first != kFirstWord)
      return scanner_.error("expected the word mesh3d, found " + in_quotes(*first));
    bool more = scanner_.try_next_line();
    while (more) {
      const auto key = scanner_.word("a keyword");
      if (!key) return tl::unexpected(key.error());
      if (!is_keyword(*key)) return scanner_.error("expected a keyword, found " + in_quotes(*key));
      if (*key == "endmesh") break;
      if (auto done = section(std::string(*key)); !done) return tl::unexpected(done.error());
      // What is left of a section, or all of one that is not read.
      do more = scanner_.try_next_line();
      while (more && !is_keyword(scanner_.rest_of_line()));
    }
    number(NameKind::kRegion, materials_, {&mesh_.regions, &mesh_.faces.regions});
    number(NameKind::kMarker, conditions_, {&mesh_.edge_markers});
    return finished();
  }

 private:
  Result<Mesh> finished() {
    mesh_.warnings = names_.warnings();
    mesh_.names = names_.take();
    return validated(path_, std::move(mesh_));
  }

  Result<void> section(const std::string& key) {
    if (key == "dimension") return dimension();
    if (key == "points") return rows("the point count", &Reader::point);
    if (key.starts_with("surfaceelements")) return rows("the triangle count", &Reader::triangle);
    if (key.starts_with("edgesegments")) return rows("the edge count", &Reader::edge);
    if (key == "volumeelements") return rows("the element count", &Reader::volume_element);
    if (key == "materials")
      return rows("the count of materials", [this](Reader&) { return name_in(materials_); });
    if (key == "bcnames")
      return rows("the count of conditions", [this](Reader&) { return name_in(conditions_); });
    return {};
  }

  // A count on a line, and a line for each.
  template <class Row>
  Result<void> rows(std::string_view what, const Row& row) {
    if (auto line = scanner_.next_line(what); !line) return line;
    const auto count = scanner_.count(what);
    if (!count) return tl::unexpected(count.error());
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (auto line = scanner_.next_line("another line of the section"); !line) return line;
      if (auto done = std::invoke(row, *this); !done) return done;
    }
    return {};
  }

  Result<void> dimension() {
    if (auto line = scanner_.next_line("the dimension"); !line) return line;
    const auto found = scanner_.integer("the dimension");
    if (!found) return tl::unexpected(found.error());
    if (*found != 2)
      return scanner_.error("the dimension is " + std::to_string(*found) + ", only 2 is read");
    return {};
  }

  Result<void> point() {
    for (const char* what : {"the x coordinate", "the y coordinate"}) {
      const auto value = scanner_.real(what);
      if (!value) return tl::unexpected(value.error());
      mesh_.coordinates.push_back(*value);
    }
    return {};
  }

  // Points come later, so that their numbers are checked at the end.
  Result<void> corners(int count, std::vector<std::uint32_t>& into) {
    for (int k = 0; k < count; ++k) {
      const auto v = read_index(scanner_, "a point", 1, std::numeric_limits<std::uint32_t>::max());
      if (!v) return tl::unexpected(v.error());
      into.push_back(*v);
    }
    return {};
  }

  // "surfnr bcnr domin domout np p1 p2 p3", and what tells of the geometry.
  Result<void> triangle() {
    std::array<std::int32_t, 5> head{};
    constexpr std::array<const char*, 5> kHead = {"the number of the surface", "the domain",
                                                  "domin", "domout", "the number of points"};
    for (std::size_t k = 0; k < head.size(); ++k) {
      const auto value = scanner_.marker(kHead[k]);
      if (!value) return tl::unexpected(value.error());
      head[k] = *value;
    }
    if (head[4] != 3 && head[4] != 4)
      return scanner_.error("the element has " + std::to_string(head[4]) +
                            " points, only 3 and 4 are read");
    std::vector<std::uint32_t> points;
    if (auto read = corners(head[4], points); !read) return read;
    if (points.size() > 3) return mesh_.faces.add(points, head[1]), Result<void>{};
    mesh_.triangles.insert(mesh_.triangles.end(), points.begin(), points.end());
    mesh_.regions.push_back(head[1]);
    return {};
  }

  // "surfid 0 p1 p2", and what tells of triangles, domains and geometry.
  Result<void> edge() {
    const auto condition = scanner_.marker("the boundary condition");
    if (!condition) return tl::unexpected(condition.error());
    if (auto nothing = scanner_.integer("0"); !nothing) return tl::unexpected(nothing.error());
    mesh_.edge_markers.push_back(*condition);
    return corners(2, mesh_.edges);
  }

  Result<void> volume_element() {
    return scanner_.error("there are volume elements, only triangles are read");
  }

  // "3 the inlet"
  Result<void> name_in(NumberNames& names) {
    const auto number = scanner_.marker("a number");
    if (!number) return tl::unexpected(number.error());
    std::string_view name = scanner_.rest_of_line();
    name = name.substr(0, name.find_last_not_of(kSyntax.blanks) + 1);
    names.emplace(*number, name);
    return {};
  }

  // A number is what its name says, "region_7", or the number of its name, or itself if it has
  // none.
  void number(NameKind kind, const NumberNames& names,
              std::initializer_list<std::vector<std::int32_t>*> of_elements) {
    const std::string prefix = std::string(word_of(kind)) + "_";
    Labels labels;
    std::map<std::int32_t, std::uint32_t> label_of;
    for (const auto& [number, name] : names) {
      std::int32_t said = number;
      const char* const digits = name.data() + prefix.size();
      const char* const end = name.data() + name.size();
      const bool says = name.starts_with(prefix) && std::from_chars(digits, end, said).ptr == end;
      const bool named = !says && !name.empty() && name != "default";
      label_of.emplace(number, named ? labels.of(name) : labels.of(said));
    }
    for (const auto* list : of_elements)
      for (const std::int32_t number : *list)
        if (!label_of.contains(number)) label_of.emplace(number, labels.of(number));
    const std::vector<std::int32_t> numbers = labels.numbers();
    for (auto* list : of_elements)
      for (std::int32_t& value : *list) value = numbers[label_of.at(value)];
    labels.name_all(kind, names_);
  }

  const std::filesystem::path& path_;
  LineScanner scanner_;
  NumberNames materials_;
  NumberNames conditions_;
  NameReader names_{path_.string()};
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_netgen(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

}  // namespace weft::files
