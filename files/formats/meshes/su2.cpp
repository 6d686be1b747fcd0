// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/su2.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/text_writer.h"
#include "files/formats/derived/mesh_edges.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

// VTK's numbers for the kinds of elements.
constexpr int kLine = 3;
constexpr int kTriangle = 5;
constexpr int kQuadrilateral = 9;

// The numbers at the ends of the lines of points: they may be missing, count up, or be those from 0
// to the last one in any order.
class PointNumbers {
 public:
  explicit PointNumbers(std::uint64_t count) : seen_(count) {}

  // Reads the end of the next line.
  Result<void> next(LineScanner& scanner) {
    if (scanner.at_line_end()) {
      numbers_.push_back(static_cast<std::int64_t>(numbers_.size()));
    } else {
      const auto number = scanner.integer("the number of the point");
      if (!number) return tl::unexpected(number.error());
      numbers_.push_back(*number);
    }
    const std::int64_t number = numbers_.back();
    counts_up_ &= number - numbers_.front() == static_cast<std::int64_t>(numbers_.size()) - 1;
    const bool is_free = number >= 0 && static_cast<std::uint64_t>(number) < seen_.size() &&
                         !seen_[static_cast<std::size_t>(number)];
    if (is_free)
      seen_[static_cast<std::size_t>(number)] = true;
    else if (!first_fault_)
      first_fault_ = scanner.error("the number of the point is " + std::to_string(number) +
                                   ", but points have the numbers from 0 to " +
                                   std::to_string(seen_.size() - 1) + ", each once");
    return {};
  }

  // Brings the coordinates into the order of the numbers. Error: no order has these numbers.
  Result<void> sort(std::vector<double>& coordinates) const {
    if (counts_up_) return {};
    if (first_fault_) return *first_fault_;
    const std::vector<double> listed = coordinates;
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      std::copy_n(&listed[2 * i], 2, &coordinates[2 * static_cast<std::size_t>(numbers_[i])]);
    return {};
  }

 private:
  std::vector<bool> seen_;
  std::vector<std::int64_t> numbers_;
  bool counts_up_ = true;
  std::optional<tl::unexpected<Error>> first_fault_;
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view text)
      : scanner_(path.string(), text, {.blanks = " \t\r\f\v,=", .comment = '%'}) {}

  Result<Mesh> read(const std::filesystem::path& path) {
    while (scanner_.try_next_line()) {
      const auto key = scanner_.word("a keyword");
      if (!key) return tl::unexpected(key.error());
      if (auto done = section(*key); !done) return tl::unexpected(done.error());
    }
    if (!has_points_ || !has_elements_)
      return fail(ExitCode::kUnreadableInput, path.string() + ": has no NPOIN or no NELEM");
    number_markers(path.string());
    return validated(path, std::move(mesh_));
  }

 private:
  Result<void> section(std::string_view key) {
    if (key == "NDIME") {
      const auto dimension = scanner_.integer("the dimension");
      if (!dimension) return tl::unexpected(dimension.error());
      if (*dimension != 2)
        return scanner_.error("the dimension is " + std::to_string(*dimension) +
                              ", only 2 is read");
      return {};
    }
    if (key == "NELEM") return elements("the element count", /*are_lines=*/false);
    if (key == "NPOIN") return points();
    if (key == "NMARK") return {};
    if (key == "MARKER_TAG") return tag();
    if (key == "MARKER_ELEMS") return marker_elements();
    return scanner_.error("expected a keyword of SU2's two-dimensional meshes, found " +
                          in_quotes(key));
  }

  Result<void> elements(std::string_view what, bool are_lines) {
    const auto count = scanner_.count(what);
    if (!count) return tl::unexpected(count.error());
    has_elements_ |= !are_lines;
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (auto line = scanner_.next_line("an element"); !line) return line;
      const auto type = scanner_.integer("the element's type");
      if (!type) return tl::unexpected(type.error());
      if (are_lines ? *type != kLine : *type != kTriangle && *type != kQuadrilateral)
        return scanner_.error("the element's type is " + std::to_string(*type) + ", only " +
                              (are_lines ? "3 is" : "5 and 9 are") + " read here");
      corners.clear();
      for (int k = 0; k < (are_lines ? 2 : *type == kTriangle ? 3 : 4); ++k) {
        // Points may come later, so their numbers are checked at the end.
        const auto v = read_index(scanner_, "a point of the element", 0,
                                  std::numeric_limits<std::uint32_t>::max());
        if (!v) return tl::unexpected(v.error());
        corners.push_back(*v);
      }
      auto& list = are_lines ? mesh_.edges : mesh_.triangles;
      if (corners.size() > 3)
        mesh_.faces.add(corners, 0);
      else
        list.insert(list.end(), corners.begin(), corners.end());
    }
    return {};
  }

  Result<void> points() {
    const auto count = scanner_.count("the point count");
    if (!count) return tl::unexpected(count.error());
    has_points_ = true;
    mesh_.coordinates.reserve(2 * *count);
    PointNumbers numbers(*count);
    for (std::uint64_t i = 0; i < *count; ++i) {
      if (auto line = scanner_.next_line("a point"); !line) return line;
      for (const char* what : {"the x coordinate", "the y coordinate"}) {
        const auto value = scanner_.real(what);
        if (!value) return tl::unexpected(value.error());
        mesh_.coordinates.push_back(*value);
      }
      if (auto number = numbers.next(scanner_); !number) return number;
    }
    return numbers.sort(mesh_.coordinates);
  }

  Result<void> tag() {
    const auto name = scanner_.word("the marker's tag");
    if (!name) return tl::unexpected(name.error());
    tags_.emplace_back(*name);
    first_edges_.push_back(mesh_.edges.size() / 2);
    return {};
  }

  Result<void> marker_elements() {
    if (tags_.empty()) return scanner_.error("MARKER_ELEMS stands before any MARKER_TAG");
    return elements("the marker's element count", /*are_lines=*/true);
  }

  // A tag that is an integer is the marker itself; any other tag is the name of a marker.
  void number_markers(const std::string& file) {
    Labels labels;
    std::vector<std::uint32_t> label_of_tag;
    for (const std::string& tag : tags_) {
      std::int32_t value = 0;
      const auto [end, problem] = std::from_chars(tag.data(), tag.data() + tag.size(), value);
      const bool is_number = problem == std::errc() && end == tag.data() + tag.size();
      label_of_tag.push_back(is_number ? labels.of(value) : labels.of(tag));
    }
    const std::vector<std::int32_t> numbers = labels.numbers();
    mesh_.edge_markers.resize(mesh_.edges.size() / 2);
    for (std::size_t i = 0; i < tags_.size(); ++i) {
      const auto at = [this](std::size_t k) {
        return k < first_edges_.size() ? first_edges_[k] : mesh_.edge_markers.size();
      };
      std::fill(mesh_.edge_markers.begin() + static_cast<std::ptrdiff_t>(at(i)),
                mesh_.edge_markers.begin() + static_cast<std::ptrdiff_t>(at(i + 1)),
                numbers[label_of_tag[i]]);
    }
    NameReader names(file);
    labels.name_all(NameKind::kMarker, names);
    mesh_.warnings = names.warnings();
    mesh_.names = names.take();
  }

  LineScanner scanner_;
  bool has_points_ = false;
  bool has_elements_ = false;
  std::vector<std::string> tags_;
  std::vector<std::size_t> first_edges_;  // of each tag
  Mesh mesh_;
};

}  // namespace

void write_su2(const MeshView& mesh, OutputFile& file) {
  put_line(file, "NDIME= 2");
  put_line(file, "NELEM=", mesh.triangle_count());
  for (const std::size_t t : mesh.up_to(mesh.triangle_count())) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    put_line(file, kTriangle, corner[0], corner[1], corner[2], t);
  }
  put_line(file, "NPOIN=", mesh.vertex_count());
  for (const std::size_t v : mesh.up_to(mesh.vertex_count()))
    put_line(file, mesh.coordinates[2 * v], mesh.coordinates[2 * v + 1], v);

  const BoundaryRings rings = boundary_rings(mesh, MeshEdges(mesh));
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::map<std::int32_t, std::vector<Edge>> by_marker;
  for (std::size_t r = 0; r < rings.size(); ++r)
    for (std::size_t i = rings.starts[r]; i < rings.starts[r + 1]; ++i)
      by_marker[rings.markers[i]].emplace_back(
          rings.vertices[i], rings.vertices[i + 1 < rings.starts[r + 1] ? i + 1 : rings.starts[r]]);
  put_line(file, "NMARK=", by_marker.size());
  for (const auto& [marker, edges] : by_marker) {
    const std::string* const name = name_of(mesh.names->markers, marker);
    put_line(file, "MARKER_TAG=", name ? *name : std::to_string(marker));
    put_line(file, "MARKER_ELEMS=", edges.size());
    for (const auto& [a, b] : edges) put_line(file, kLine, a, b);
  }
}

Result<Mesh> read_su2(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read(path);
}

}  // namespace weft::files
