// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/surface_formats.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

Result<void> read_xy(LineScanner& scanner, Mesh& mesh) {
  for (const char* what : {"the x coordinate", "the y coordinate"}) {
    const auto value = scanner.real(what);
    if (!value) return tl::unexpected(value.error());
    mesh.coordinates.push_back(*value);
  }
  return {};
}

class ObjReader {
 public:
  explicit ObjReader(LineScanner scanner) : scanner_(std::move(scanner)), names_(scanner_.name()) {}

  Result<Mesh> read() {
    while (scanner_.try_next_line()) {
      const auto key = scanner_.word("a keyword");
      if (!key) return tl::unexpected(key.error());
      Result<void> done;
      if (*key == "v") done = read_xy(scanner_, mesh_);
      if (*key == "f") done = face();
      if (*key == "l") done = line();
      if (*key == "g") group();
      if (!done) return tl::unexpected(done.error());
    }
    number(regions_, mesh_.regions);
    number(regions_, mesh_.faces.regions);
    regions_.name_all(NameKind::kRegion, names_);
    number(markers_, mesh_.edge_markers);
    markers_.name_all(NameKind::kMarker, names_);
    mesh_.warnings = names_.warnings();
    mesh_.names = names_.take();
    return std::move(mesh_);
  }

 private:
  // "7", "7/1", "7//3": the number of a vertex, from 1, or backwards from the last one if it is
  // negative.
  Result<std::uint32_t> vertex() {
    const auto field = scanner_.word("a vertex");
    if (!field) return tl::unexpected(field.error());
    const std::string_view digits = field->substr(0, field->find('/'));
    const auto count = static_cast<std::int64_t>(mesh_.coordinates.size() / 2);
    std::int64_t number = 0;
    const auto [end, problem] =
        std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (problem != std::errc() || end != digits.data() + digits.size())
      return scanner_.error("expected a vertex, found " + in_quotes(*field));
    const std::int64_t index = number < 0 ? count + number : number - 1;
    if (index < 0 || index >= count)
      return scanner_.error("the vertex is " + std::to_string(number) + ", so far there are " +
                            std::to_string(count));
    return static_cast<std::uint32_t>(index);
  }

  Result<void> face() {
    std::vector<std::uint32_t> corners;
    while (corners.size() < 3 || !scanner_.at_line_end()) {
      const auto v = vertex();
      if (!v) return tl::unexpected(v.error());
      corners.push_back(*v);
    }
    const std::int32_t region = label_in(regions_, "region_");
    if (corners.size() > 3) return mesh_.faces.add(corners, region), Result<void>{};
    mesh_.triangles.insert(mesh_.triangles.end(), corners.begin(), corners.end());
    mesh_.regions.push_back(region);
    return {};
  }

  Result<void> line() {
    auto from = vertex();
    if (!from) return tl::unexpected(from.error());
    const std::int32_t marker = label_in(markers_, "marker_");
    do {
      const auto to = vertex();
      if (!to) return tl::unexpected(to.error());
      mesh_.edges.insert(mesh_.edges.end(), {*from, *to});
      mesh_.edge_markers.push_back(marker);
      from = to;
    } while (!scanner_.at_line_end());
    return {};
  }

  // "region_7" is region 7, and 0 for edges; any other group names the region or the marker.
  void group() {
    group_ = scanner_.rest_of_line();
    group_ = group_.substr(0, group_.find_first_of(" \t\r\f\v"));
  }

  std::int32_t label_in(Labels& labels, std::string_view word) const {
    std::int32_t number = 0;
    if (group_.starts_with(word))
      std::from_chars(group_.data() + word.size(), group_.data() + group_.size(), number);
    const bool is_name = !group_.empty() && group_ != "default" && !group_.starts_with("region_") &&
                         !group_.starts_with("marker_");
    return static_cast<std::int32_t>(is_name ? labels.of(group_) : labels.of(number));
  }

  static void number(const Labels& labels, std::vector<std::int32_t>& of_elements) {
    const std::vector<std::int32_t> numbers = labels.numbers();
    for (std::int32_t& label : of_elements) label = numbers[static_cast<std::size_t>(label)];
  }

  LineScanner scanner_;
  std::string_view group_;
  Labels regions_;
  Labels markers_;
  NameReader names_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_obj(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  auto mesh = ObjReader(LineScanner(path.string(), contents->text())).read();
  if (!mesh) return mesh;
  return validated(path, std::move(*mesh));
}

Result<Mesh> read_off(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  LineScanner scanner(path.string(), contents->text());
  if (auto line = scanner.next_line("the word OFF"); !line) return tl::unexpected(line.error());
  const auto word = scanner.word("the word OFF");
  if (!word) return tl::unexpected(word.error());
  // What may stand before it tells what follows x, y and z in the lines of vertices.
  std::string_view kind = *word;
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (kind.starts_with(prefix)) kind.remove_prefix(prefix.size());
  if (kind != "OFF")
    return scanner.error("expected the word OFF, COFF, NOFF or STOFF, found " + in_quotes(*word));
  if (!scanner.at_line_end() && scanner.rest_of_line().starts_with("BINARY"))
    return scanner.error("the file is binary, only text is read");
  if (scanner.at_line_end())
    if (auto line = scanner.next_line("the vertex count"); !line)
      return tl::unexpected(line.error());
  const auto vertices = scanner.count("the vertex count");
  if (!vertices) return tl::unexpected(vertices.error());
  const auto faces = scanner.count("the face count");
  if (!faces) return tl::unexpected(faces.error());

  Mesh mesh;
  mesh.coordinates.reserve(2 * *vertices);
  for (std::uint64_t i = 0; i < *vertices; ++i) {
    if (auto line = scanner.next_line("a vertex"); !line) return tl::unexpected(line.error());
    if (auto read = read_xy(scanner, mesh); !read) return tl::unexpected(read.error());
  }
  mesh.triangles.reserve(3 * *faces);
  std::vector<std::uint32_t> face;
  for (std::uint64_t i = 0; i < *faces; ++i) {
    if (auto line = scanner.next_line("a face"); !line) return tl::unexpected(line.error());
    const auto corners = scanner.integer("the corners of the face");
    if (!corners) return tl::unexpected(corners.error());
    if (*corners < 3)
      return scanner.error("the face has " + std::to_string(*corners) +
                           " corners, 3 are the least");
    face.clear();
    for (std::int64_t k = 0; k < *corners; ++k) {
      const auto v = read_index(scanner, "a corner", 0, *vertices);
      if (!v) return tl::unexpected(v.error());
      face.push_back(*v);
    }
    if (face.size() > 3)
      mesh.faces.add(face, 0);
    else
      mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
  }
  return validated(path, std::move(mesh));
}

}  // namespace weft::files
