// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/femm.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/code_page.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/malformed.h"
#include "files/bytes/number_text.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

// A text may have any character.
constexpr LineSyntax kSyntax{.comment = '\0'};

class Reader {
 public:
  Reader(const std::string& name, std::string_view text, FemmProblem problem)
      : problem_(problem), scanner_(name, text, kSyntax), names_(name) {}

  Result<Domain> read() {
    try {
      while (scanner_.try_next_line()) line();
      return finish();
    } catch (const Malformed& malformed) {
      return tl::unexpected(malformed.error);
    }
  }

 private:
  // A boundary or a material.
  struct Property {
    std::string name{};
    bool is_used = false;
  };
  // What warnings tell of, once for all.
  struct Note {
    std::uint64_t count = 0;
    std::uint64_t line = 0;  // of the first
    std::string name{};      // of the first
  };

  [[noreturn]] void fail_here(const std::string& message) const {
    throw Malformed{scanner_.error(message).value()};
  }

  // "[NumPoints] = 4", "<BdryName> = "outer"".
  void line() {
    const std::string_view text = trimmed(scanner_.rest_of_line());
    const std::size_t end = text.find(text[0] == '[' ? ']' : '>');
    if ((text[0] != '[' && text[0] != '<') || end == std::string_view::npos)
      fail_here("expected a line like '[NumPoints] = 4', found " + in_quotes(text));
    const std::string key = lower_case(text.substr(0, end + 1));
    const std::size_t sign = text.find('=', end);
    const std::string_view value =
        sign == std::string_view::npos ? std::string_view() : trimmed(text.substr(sign + 1));
    property(key, value);
    struct Section {
      std::string_view key;
      void (Reader::*row)();
    };
    static constexpr Section kSections[] = {
        {"[numpoints]", &Reader::point},      {"[numsegments]", &Reader::segment},
        {"[numarcsegments]", &Reader::arc},   {"[numholes]", &Reader::hole},
        {"[numblocklabels]", &Reader::label}, {"<bhpoints>", &Reader::nothing},
        {"<tkpoints>", &Reader::nothing},
    };
    for (const Section& section : kSections)
      if (section.key == key) rows(section.row, count(value));
  }

  void property(const std::string& key, std::string_view value) {
    if (key == "[lengthunits]") unit_ = lower_case(value);
    if (key == "<beginbdry>") boundaries_.emplace_back();
    if (key == "<bdryname>") name_last(boundaries_, key, value);
    if (key == "<bdrytype>") boundary_type(count(value));
    if (key == "<beginblock>") materials_.emplace_back();
    if (key == "<blockname>") name_last(materials_, key, value);
  }
  void name_last(std::vector<Property>& properties, const std::string& key,
                 std::string_view value) const {
    if (properties.empty())
      fail_here("expected the beginning of a property before " + in_quotes(key));
    if (value.size() >= 2 && value.starts_with('"') && value.ends_with('"'))
      value = value.substr(1, value.size() - 2);
    properties.back().name = to_utf8(std::string(value), "");
  }
  void boundary_type(std::int64_t type) {
    const bool is_from_4 =
        problem_ == FemmProblem::kMagnetics || problem_ == FemmProblem::kHeatFlow;
    if (type < (is_from_4 ? 4 : 3) || boundaries_.empty()) return;
    note(periodic_);
    if (periodic_.count == 1) periodic_.name = boundaries_.back().name;
  }

  std::int64_t count(std::string_view value) const {
    const auto number = whole_of(value);
    if (!number || *number < 0) fail_here("expected a number from 0 on, found " + in_quotes(value));
    return *number;
  }
  void rows(void (Reader::*row)(), std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      must(scanner_.next_line("a row of that list"));
      (this->*row)();
    }
  }
  void nothing() {}
  double real(const char* what) { return must(scanner_.real(what)); }

  void point() {
    const double x = real("the x coordinate");
    const double y = real("the y coordinate");
    domain_.point_places.extend(domain_.points.size(), scanner_.name() + ":", scanner_.line());
    domain_.points.push_back({x, y});
  }

  std::uint32_t point_number(const char* what) {
    const std::int64_t number = must(scanner_.integer(what));
    if (number < 0 || number >= static_cast<std::int64_t>(domain_.points.size()))
      fail_here("there is no point " + std::to_string(number) + " above, numbers count from 0");
    return static_cast<std::uint32_t>(number);
  }
  // 1 and on, of a property; 0: none.
  std::int32_t property_number(const char* what, std::vector<Property>& properties) {
    if (scanner_.at_line_end()) return 0;
    const std::int64_t number = must(scanner_.integer(what));
    if (number < 0 || number > static_cast<std::int64_t>(properties.size()))
      fail_here(std::string("there is no ") + what + " " + std::to_string(number) + " above");
    if (number == 0) return 0;
    // FEMM knows them by name: those of one name are one.
    const auto first = std::ranges::find(
        properties, properties[static_cast<std::size_t>(number - 1)].name, &Property::name);
    first->is_used = true;
    return static_cast<std::int32_t>(first - properties.begin()) + 1;
  }
  void add_segment(std::uint32_t a, std::uint32_t b, std::int32_t marker) {
    domain_.segment_places.extend(domain_.segments.size(), scanner_.name() + ":", scanner_.line());
    domain_.segments.push_back({a, b, marker});
  }

  void segment() {
    const std::uint32_t a = point_number("the first point");
    const std::uint32_t b = point_number("the second point");
    if (!scanner_.at_line_end() && real("the greatest length of a side") > 0) note(sizes_);
    add_segment(a, b, property_number("boundary property", boundaries_));
  }
  void arc() {
    const std::uint32_t a = point_number("the first point");
    const std::uint32_t b = point_number("the second point");
    const double degrees = real("the angle of the arc");
    if (!(degrees > 0 && degrees < 360))
      fail_here("the angle of an arc is between 0 and 360 degrees, not " + shortest(degrees));
    if (domain_.points[a] == domain_.points[b]) fail_here("the arc ends where it begins");
    if (!scanner_.at_line_end()) real("the greatest angle of a side");
    const double bulge = degrees == 180 ? 1 : std::tan(degrees * (std::numbers::pi / 720));
    domain_.arcs.push_back({static_cast<std::uint32_t>(domain_.segments.size()), bulge});
    add_segment(a, b, property_number("boundary property", boundaries_));
  }

  Point seed() {
    const double x = real("the x coordinate");
    return {x, real("the y coordinate")};
  }
  void hole() {
    domain_.hole_places.extend(domain_.holes.size(), scanner_.name() + ":", scanner_.line());
    domain_.holes.push_back(seed());
  }
  void label() {
    Domain::Region region{.at = seed()};
    region.id = property_number("material", materials_);
    if (!scanner_.at_line_end()) {
      const double diameter = real("the mesh size");
      const double area = std::numbers::pi / 4 * diameter * diameter;
      if (diameter > 0) region.max_area = area;
      if (diameter > 0 && !(area > 0 && std::isfinite(area)))
        fail_here("the mesh size is " + shortest(diameter) + ", and its square no number");
    }
    // The circuit, the direction of magnetization, the group and the turns; or the group.
    const int between = problem_ == FemmProblem::kMagnetics ? 4 : 1;
    for (int i = 0; i < between && !scanner_.at_line_end(); ++i) must(scanner_.word("a number"));
    if (!scanner_.at_line_end()) {
      constexpr std::int64_t kDefault = 2;
      if ((must(scanner_.integer("the kind of the label")) & kDefault) != 0) note(defaults_);
    }
    domain_.region_places.extend(domain_.regions.size(), scanner_.name() + ":", scanner_.line());
    domain_.regions.push_back(region);
  }

  void note(Note& note) const {
    if (note.count++ == 0) note.line = scanner_.line();
  }

  Result<Domain> finish() {
    if (domain_.points.empty())
      throw Malformed{
          fail(ExitCode::kUnreadableInput, scanner_.name() + ": holds no points").value()};
    name_used(NameKind::kMarker, boundaries_);
    name_used(NameKind::kRegion, materials_);
    domain_.warnings = names_.warnings();
    domain_.names = names_.take();
    if (!unit_.empty() && unit_ != "meters")
      warn(WarningKind::kCoordinates, {1, 0},
           "its coordinates are in " + harmless(unit_) + ", and so are those of the mesh");
    warn(WarningKind::kProperty, periodic_,
         "a boundary property is periodic, " + in_quotes(periodic_.name) +
             ": its edges have its marker, but those of both sides need not match");
    warn(WarningKind::kProperty, sizes_,
         "segments have a size of their own, which has no effect: --edge-at gives a marker one");
    warn(WarningKind::kProperty, defaults_,
         "a label is the default of faces without one, which has no effect: their region is 0");
    return std::move(domain_);
  }
  void name_used(NameKind kind, const std::vector<Property>& properties) {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].is_used)
        names_.add(kind, static_cast<std::int32_t>(i + 1), properties[i].name);
  }
  void warn(WarningKind kind, const Note& note, const std::string& text) {
    if (note.count > 0)
      domain_.warnings.push_back({.kind = kind,
                                  .file = scanner_.name(),
                                  .line = note.line,
                                  .count = note.count,
                                  .text = text});
  }

  const FemmProblem problem_;
  LineScanner scanner_;
  NameReader names_;
  Domain domain_;
  std::vector<Property> boundaries_;
  std::vector<Property> materials_;
  std::string unit_{};
  Note periodic_, sizes_, defaults_;
};

}  // namespace

Result<Domain> read_femm(const std::filesystem::path& path, FemmProblem problem) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path.string(), contents->text(), problem).read();
}

}  // namespace weft::files
