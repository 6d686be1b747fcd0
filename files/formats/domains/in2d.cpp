// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/in2d.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/malformed.h"
#include "files/bytes/number_text.h"
#include "files/formats/area_bound.h"
#include "files/formats/domains/spline.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

struct Flags {
  std::optional<std::int32_t> number;  // of the boundary condition
  std::string name;
  std::optional<double> max_edge;
};

class Reader {
 public:
  Reader(const std::string& name, std::string_view text) : scanner_(name, text), names_(name) {}

  Result<Domain> read() {
    try {
      const std::string_view header = word("the header");
      if (header == "splinecurves2dv2") {
        read_sections();
      } else if (header == "splinecurves2dnew" || header == "splinecurves2d") {
        read_counted(header == "splinecurves2dnew");
      } else {
        fail_here("expected 'splinecurves2dv2', 'splinecurves2dnew' or 'splinecurves2d', found " +
                  in_quotes(header));
      }
      return finish();
    } catch (const Malformed& malformed) {
      return tl::unexpected(malformed.error);
    }
  }

 private:
  struct NumberedPoint {
    Point at;
    std::uint64_t line = 0;
    bool is_used = false;
  };
  // Where segments may end.
  struct End {
    std::uint64_t line = 0;
    std::optional<std::uint32_t> vertex;  // in the domain
  };
  struct Side {
    std::uint32_t area = 0;             // 1 + its index
    std::set<std::uint32_t> open_ends;  // points where an odd number of its segments end
  };

  [[noreturn]] void fail_here(const std::string& message) const {
    throw Malformed{scanner_.error(message).value()};
  }
  // Fields may go on below.
  double real(const char* what) {
    must(scanner_.to_field(what));
    return must(scanner_.real(what));
  }
  std::int32_t integer(const char* what) {
    must(scanner_.to_field(what));
    return must(scanner_.marker(what));
  }
  std::string_view word(const char* what) {
    must(scanner_.to_field(what));
    return must(scanner_.word(what));
  }

  void read_sections() {
    real("the grading");
    bool more = scanner_.try_next_line();
    while (more) {
      const std::string_view section = must(scanner_.word("the name of a section"));
      const auto row = section == "points"      ? &Reader::numbered_point
                       : section == "segments"  ? &Reader::segment
                       : section == "materials" ? &Reader::material
                                                : nullptr;
      if (row == nullptr)
        fail_here("expected 'points', 'segments' or 'materials', found " + in_quotes(section));
      expect_line_end();
      while ((more = scanner_.try_next_line()) && !begins_section()) (this->*row)();
    }
  }
  bool begins_section() const {
    const char first = static_cast<char>(scanner_.rest_of_line()[0] | 0x20);
    return first >= 'a' && first <= 'z';
  }

  void read_counted(bool is_numbered) {
    real("the grading");
    rows("the number of points", is_numbered ? &Reader::numbered_point : &Reader::next_point);
    rows("the number of segments", &Reader::segment);
    if (is_numbered && scanner_.try_next_line()) rows("the number of materials", &Reader::material);
    if (scanner_.try_next_line()) {
      must(scanner_.word("the end"));
      fail_here("the file goes on after its last section");
    }
  }
  void rows(const char* what, void (Reader::*row)()) {
    must(scanner_.to_field(what));
    const std::uint64_t count = must(scanner_.count(what));
    for (std::uint64_t i = 0; i < count; ++i) {
      must(scanner_.next_line("a row of that section"));
      (this->*row)();
    }
  }
  void expect_line_end() {
    if (scanner_.at_line_end()) return;
    const std::string_view word = must(scanner_.word("the end of the line"));
    fail_here("expected the end of the line, found " + in_quotes(word));
  }

  void numbered_point() { add_point(integer("the number of the point")); }
  void next_point() { add_point(static_cast<std::int32_t>(points_.size()) + 1); }
  void add_point(std::int32_t number) {
    NumberedPoint point;
    point.line = scanner_.line();
    point.at.x = real("the x coordinate");
    point.at.y = real("the y coordinate");
    constexpr double kLargest = 1e50;  // of the service
    if (!(std::abs(point.at.x) <= kLargest && std::abs(point.at.y) <= kLargest))
      fail_here("the point is " + coordinates(point.at.x, point.at.y) +
                ", magnitudes go up to 1e50");
    if (!points_.emplace(number, point).second)
      fail_here("the point " + std::to_string(number) + " is there twice");
    ends_.try_emplace({point.at.x, point.at.y}, End{point.line, std::nullopt});
    if (flags().max_edge) leave_out("-maxh");
  }

  Point point(const char* what) {
    const std::int32_t number = integer(what);
    const auto found = points_.find(number);
    if (found == points_.end()) fail_here("there is no point " + std::to_string(number) + " above");
    found->second.is_used = true;
    return found->second.at;
  }
  // The same for all segments that end there.
  std::uint32_t end_at(Point at, std::uint64_t line) {
    End& end = ends_.try_emplace({at.x, at.y}, End{line, std::nullopt}).first->second;
    if (!end.vertex) end.vertex = add_vertex(at, end.line);
    return *end.vertex;
  }
  std::uint32_t add_vertex(Point at, std::uint64_t line) {
    if (domain_.points.size() == std::numeric_limits<std::uint32_t>::max())
      fail_here("there are more than 4294967295 points");
    const auto index = static_cast<std::uint32_t>(domain_.points.size());
    domain_.point_places.extend(index, scanner_.name() + ":", line);
    domain_.points.push_back(at);
    return index;
  }

  void segment() {
    const std::int32_t left = side("the domain on the left");
    const std::int32_t right = side("the domain on the right");
    const std::string_view type = word("the type of the segment");
    const std::uint64_t line = scanner_.line();
    ArcChain chain;
    if (type == "2") {
      const Point from = point("the first point");
      chain = ArcChain({from, point("the last point")});
    } else if (type == "3" || type == "4") {
      const Point from = point("the first point");
      const Point tip = point("the point where the tangents meet");
      chain = curve(from, tip, point("the last point"), type == "4");
    } else if (type == "discretepoints" || type == "bsplinepoints") {
      chain = curve_of_points(type == "bsplinepoints");
    } else {
      fail_here("expected a segment of type 2, 3, 4, discretepoints or bsplinepoints, found " +
                in_quotes(type));
    }
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = 0; i < chain.points.size(); ++i)
      vertices.push_back(i == 0 || i + 1 == chain.points.size()
                             ? end_at(chain.points[i], line)
                             : add_vertex(chain.points[i], line));
    const std::uint32_t label = label_of(flags());
    if (left == right) return add(chain, vertices, label, nullptr, line);
    for (const std::int32_t number : {left, right})
      if (number != 0) add(chain, vertices, label, &sides_[number], line);
  }
  std::int32_t side(const char* what) {
    const std::int32_t number = integer(what);
    if (number >= 0) return number;
    fail_here(std::string(what) + " is " + std::to_string(number));
  }

  // Netgen's rational curve: the weight of its tip makes it an arc of a circle if it can be one.
  ArcChain curve(Point from, Point tip, Point to, bool must_be_circle) const {
    const double a = std::hypot(tip.x - from.x, tip.y - from.y);
    const double b = std::hypot(to.x - tip.x, to.y - tip.y);
    const double chord = std::hypot(to.x - from.x, to.y - from.y);
    const double weight = chord / std::sqrt(2 * (a * a + b * b));
    if (!(weight > 0)) fail_here("the curve ends where it begins");
    if (must_be_circle && std::abs(a - b) > 1e-6 * a)
      fail_here("the tangents of an arc of a circle have the lengths " + shortest(a) + " and " +
                shortest(b));
    return arcs_of(Spline{2, {0, 0, 0, 1, 1, 1}, {1, weight, 1}, {from, tip, to}});
  }
  ArcChain curve_of_points(bool is_spline) {
    const std::int32_t count = integer("the number of points");
    if (count < 2) fail_here("a curve has two points at least");
    const std::int32_t order = is_spline ? integer("the order of the spline") : 2;
    if (order < 2 || order > 4 || order > count)
      fail_here("the order is " + std::to_string(order) +
                ", it is from 2 to 4, and at most the number of points");
    Spline spline{.degree = order - 1};
    for (std::int32_t i = 0; i < count; ++i) {
      const double x = real("the x coordinate");
      spline.control.push_back({x, real("the y coordinate")});
    }
    // Those on the next line are this segment's, too.
    if (LineScanner ahead = scanner_;
        scanner_.at_line_end() && ahead.try_next_line() && ahead.rest_of_line()[0] == '-')
      scanner_ = ahead;
    if (!is_spline) return ArcChain(std::move(spline.control));
    for (std::int32_t i = 0; i < count + order; ++i)
      spline.knots.push_back(std::clamp(i - order + 1, 0, count - order + 1));
    return arcs_of(spline);
  }

  void add(const ArcChain& chain, const std::vector<std::uint32_t>& vertices, std::uint32_t label,
           Side* side, std::uint64_t line) {
    if (side != nullptr && side->area == 0) {
      domain_.areas.emplace_back();
      side->area = static_cast<std::uint32_t>(domain_.areas.size());
      domain_.area_places.extend(side->area - 1, scanner_.name() + ":", line);
    }
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      if (vertices[i] == vertices[i + 1]) continue;
      const auto index = static_cast<std::uint32_t>(domain_.segments.size());
      if (chain.bulges[i] != 0) domain_.arcs.push_back({index, chain.bulges[i]});
      domain_.segment_places.extend(index, scanner_.name() + ":", line);
      domain_.segments.push_back({vertices[i], vertices[i + 1], static_cast<std::int32_t>(label),
                                  side == nullptr ? 0 : side->area});
    }
    if (side == nullptr) return;
    for (const std::uint32_t end : {vertices.front(), vertices.back()})
      if (!side->open_ends.insert(end).second) side->open_ends.erase(end);
  }

  void material() {
    const std::int32_t number = integer("the number of the domain");
    const std::string_view name = word("the material");
    names_.add(NameKind::kRegion, number, name);
    if (const auto max_edge = flags().max_edge) max_edges_[number] = *max_edge;
  }

  // To the end of the line.
  Flags flags() {
    Flags found;
    while (!scanner_.at_line_end()) {
      const std::string_view word = must(scanner_.word("a flag"));
      if (const auto factor = real_of(word); factor && !word.starts_with('-')) {
        if (*factor != 1) leave_out("a factor of refinement");
        continue;
      }
      if (!word.starts_with('-')) fail_here("expected a flag, found " + in_quotes(word));
      const std::string_view name = word.substr(0, word.find('='));
      const std::string_view value =
          name.size() < word.size() ? word.substr(name.size() + 1) : std::string_view();
      if (name == "-bc" || name == "-bcname") {
        condition(name, value, found);
      } else if (name == "-maxh") {
        found.max_edge = real_of(value);
        const double area = area_of_edge(found.max_edge.value_or(0));
        if (!(area > 0 && std::isfinite(area) && *found.max_edge > 0))
          fail_here("expected a positive number after -maxh=, found " + in_quotes(value));
      } else {
        leave_out(std::string(name));
      }
    }
    return found;
  }
  void condition(std::string_view flag, std::string_view value, Flags& found) const {
    const auto number = integer_of(value);
    if (flag == "-bcname" || !number) {
      if (value.empty()) fail_here("expected a value after " + std::string(flag) + "=");
      found.name = value;
    } else if (*number < std::numeric_limits<std::int32_t>::min() ||
               *number > std::numeric_limits<std::int32_t>::max()) {
      fail_here("the boundary condition is " + std::to_string(*number) +
                ", it must fit in 32 bits");
    } else {
      found.number = static_cast<std::int32_t>(*number);
    }
  }
  std::uint32_t label_of(const Flags& flags) {
    if (flags.max_edge) leave_out("-maxh");
    if (!flags.number) return flags.name.empty() ? markers_.of(0) : markers_.of(flags.name);
    if (!flags.name.empty()) names_.add(NameKind::kMarker, *flags.number, flags.name);
    return markers_.of(*flags.number);
  }
  void leave_out(const std::string& flag) {
    if (left_out_.empty()) left_out_line_ = scanner_.line();
    left_out_.insert(flag);
  }

  Result<Domain> finish() {
    if (domain_.segments.empty())
      throw Malformed{
          fail(ExitCode::kUnreadableInput, scanner_.name() + ": holds no segments").value()};
    for (const auto& [number, side] : sides_) {
      check_closed(number, side);
      domain_.areas[side.area - 1].region = number;
    }
    for (const auto& [number, max_edge] : max_edges_)
      if (const auto side = sides_.find(number); side != sides_.end())
        domain_.areas[side->second.area - 1].max_area = area_of_edge(max_edge);
    domain_.fill = Domain::Fill::kUnion;
    const std::vector<std::int32_t> numbers = markers_.numbers();
    for (Domain::Segment& segment : domain_.segments)
      segment.marker = numbers[static_cast<std::size_t>(segment.marker)];
    markers_.name_all(NameKind::kMarker, names_);
    domain_.warnings = names_.warnings();
    warn_of_left_out();
    domain_.names = names_.take();
    return std::move(domain_);
  }
  void check_closed(std::int32_t number, const Side& side) const {
    if (side.open_ends.empty()) return;
    const std::uint32_t end = *side.open_ends.begin();
    const Point at = domain_.points[end];
    throw Malformed{fail(ExitCode::kUnreadableInput,
                         domain_.point_places.locate(end) + ": the border of domain " +
                             std::to_string(number) + " is not closed: an odd number of its " +
                             "segments ends at " + coordinates(at.x, at.y))
                        .value()};
  }
  void warn_of_left_out() {
    if (!left_out_.empty())
      domain_.warnings.push_back(
          {.kind = WarningKind::kProperty,
           .file = scanner_.name(),
           .line = left_out_line_,
           .count = left_out_.size(),
           .text = "sizes and refinements other than -maxh of a material are left out: " +
                   in_quotes(std::vector<std::string>(left_out_.begin(), left_out_.end()))});
    std::uint64_t unused = 0;
    std::uint64_t first = 0;
    for (const auto& [number, point] : points_)
      if (!point.is_used && (unused++ == 0 || point.line < first)) first = point.line;
    if (unused > 0)
      domain_.warnings.push_back(
          {.kind = WarningKind::kLeftOut,
           .file = scanner_.name(),
           .line = first,
           .count = unused,
           .text = with_separators(unused) +
                   (unused == 1 ? " point is left out: no segment has it"
                                : " points are left out, this is the first: no segment has them")});
  }

  LineScanner scanner_;
  NameReader names_;
  Labels markers_;
  Domain domain_;  // the markers of its segments are labels
  std::map<std::int32_t, NumberedPoint> points_;
  std::map<std::pair<double, double>, End> ends_;
  std::map<std::int32_t, Side> sides_;  // by the number of the domain
  std::map<std::int32_t, double> max_edges_;
  std::set<std::string> left_out_;  // flags
  std::uint64_t left_out_line_ = 0;
};

}  // namespace

Result<Domain> read_in2d(const std::filesystem::path& path, bool) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path.string(), contents->text()).read();
}

}  // namespace weft::files
