// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf_entities.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/code_page.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

tl::unexpected<Error> bad(const std::string& file, std::uint64_t line, const std::string& what) {
  return fail(ExitCode::kUnreadableInput, file + ":" + std::to_string(line) + ": " + what);
}

std::optional<int> small_integer(std::string_view text) {
  const auto value = integer_of(text);
  if (!value || *value < std::numeric_limits<int>::min() ||
      *value > std::numeric_limits<int>::max())
    return std::nullopt;
  return static_cast<int>(*value);
}

}  // namespace

const DxfGroup* DxfRecord::find(int code) const {
  const auto found = std::ranges::find(groups, code, &DxfGroup::code);
  return found == groups.end() ? nullptr : &*found;
}

tl::unexpected<Error> DxfRecord::expected(const char* what, const DxfGroup& group) const {
  return bad(*file_, group.line,
             std::string("expected ") + what + " in group " + std::to_string(group.code) +
                 ", found " + in_quotes(group.value));
}

double DxfRecord::real_of(const DxfGroup& group) const {
  const auto value = files::real_of(group.value);
  if (!value) throw DxfFault{expected("a number", group).value()};
  return *value;
}

int DxfRecord::integer_of(const DxfGroup& group) const {
  const auto value = small_integer(group.value);
  if (!value) throw DxfFault{expected("a whole number", group).value()};
  return *value;
}

double DxfRecord::real(int code, double otherwise) const {
  const DxfGroup* const group = find(code);
  return group == nullptr ? otherwise : real_of(*group);
}

int DxfRecord::integer(int code, int otherwise) const {
  const DxfGroup* const group = find(code);
  return group == nullptr ? otherwise : integer_of(*group);
}

std::string_view DxfRecord::text(int code) const {
  const DxfGroup* const group = find(code);
  return group == nullptr ? std::string_view() : group->value;
}

std::array<double, 3> DxfRecord::vector(int code, std::array<double, 3> otherwise) const {
  return {real(code, otherwise[0]), real(code + 10, otherwise[1]), real(code + 20, otherwise[2])};
}

// Reads groups one after another. A copy is a place in the text.
class DxfDrawing::Groups {
 public:
  Groups(const std::string& file, Slice slice)
      : file_(&file), rest_(slice.text), lines_(slice.lines) {}

  // Empty at the end of the text.
  std::optional<DxfGroup> next() {
    if (trimmed(rest_.substr(0, 1)).empty() && trimmed(rest_).empty()) return std::nullopt;
    const std::string_view code = line();
    const auto number = small_integer(code);
    if (!number)
      throw DxfFault{
          bad(*file_, lines_, "expected the code of a group, found " + in_quotes(code)).value()};
    if (rest_.empty())
      throw DxfFault{bad(*file_, lines_,
                         "expected a value after the code " + std::to_string(*number) +
                             ", found the end of the file")
                         .value()};
    const std::string_view value = line();
    return DxfGroup{*number, value, lines_};
  }
  DxfGroup need(const std::string& what) {
    const auto group = next();
    if (!group)
      throw DxfFault{
          bad(*file_, lines_, "expected " + what + ", found the end of the file").value()};
    return *group;
  }
  // From here to a later place.
  Slice up_to(const Groups& end) const {
    return {rest_.substr(0, rest_.size() - end.rest_.size()), lines_};
  }

 private:
  std::string_view line() {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end);
    rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(rest_.size(), 1));
    ++lines_;
    return trimmed(text);
  }

  const std::string* file_;
  std::string_view rest_;
  std::uint64_t lines_;
};

DxfDrawing::DxfDrawing(std::string file, std::string_view text) : file_(std::move(file)) {
  const auto refuse = [this](const char* what) {
    throw DxfFault{fail(ExitCode::kUnreadableInput, file_ + ": " + what).value()};
  };
  if (text.starts_with("AutoCAD Binary DXF"))
    refuse("is a DXF in binary form; save it as a DXF in text form (ASCII)");
  if (text.starts_with("AC10"))
    refuse("is a DWG, not a DXF; save it as a DXF in text form (ASCII)");
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  read_sections(text);
  if (!has_entities_) refuse("is no drawing in DXF: it has no section ENTITIES");
}

void DxfDrawing::read_sections(std::string_view text) {
  Groups groups(file_, {text, 0});
  while (const auto group = groups.next()) {
    if (group->code == 0 && group->value == "EOF") return;
    if (group->code != 0 || group->value != "SECTION") continue;
    const std::string name(groups.need("the name of a section").value);
    if (name == "HEADER") {
      read_header(groups);
    } else if (name == "BLOCKS") {
      read_blocks(groups);
    } else {
      const Groups start = groups;
      Groups end = groups;
      for (;; end = groups) {
        const DxfGroup inner = groups.need("ENDSEC of the section " + in_quotes(name));
        if (inner.code == 0 && inner.value == "ENDSEC") break;
      }
      if (name != "ENTITIES") continue;
      entities_ = start.up_to(end);
      has_entities_ = true;
    }
  }
}

void DxfDrawing::read_header(Groups& groups) {
  std::string_view variable;
  for (;;) {
    const DxfGroup group = groups.need("ENDSEC of the section 'HEADER'");
    if (group.code == 0 && group.value == "ENDSEC") return;
    if (group.code == 9) variable = group.value;
    if (group.code == 3 && variable == "$DWGCODEPAGE") code_page_ = group.value;
    std::ranges::replace(code_page_, '_', ' ');
  }
}

void DxfDrawing::read_blocks(Groups& groups) {
  for (;;) {
    const DxfGroup group = groups.need("ENDSEC of the section 'BLOCKS'");
    if (group.code == 0 && group.value == "ENDSEC") return;
    if (group.code == 0 && group.value == "BLOCK") read_block(groups);
  }
}

void DxfDrawing::read_block(Groups& groups) {
  DxfRecord head(file_);
  Groups start = groups;
  const auto next = [&groups] { return groups.need("ENDBLK of a block"); };
  for (DxfGroup group = next(); group.code != 0; group = next()) {
    head.groups.push_back(group);
    start = groups;
  }
  Groups end = start;
  groups = start;
  for (;; end = groups) {
    const DxfGroup group = next();
    if (group.code == 0 && group.value == "ENDBLK") break;
  }
  blocks_[lower_case(head.text(2))] = {head.point(10), start.up_to(end)};
}

const DxfDrawing::Block* DxfDrawing::block(std::string_view name) const {
  const auto found = blocks_.find(lower_case(name));
  return found == blocks_.end() ? nullptr : &found->second;
}

void DxfDrawing::for_each(const Slice& slice,
                          const std::function<void(const DxfEntity&)>& each) const {
  Groups groups(file_, slice);
  DxfEntity entity(file_);
  DxfRecord attribute(file_);
  DxfRecord* part = &attribute;
  const auto end = [&] {
    if (!entity.kind.empty()) each(entity);
  };
  while (const auto group = groups.next()) {
    if (group->code != 0) {
      part->groups.push_back(*group);
    } else if (group->value == "VERTEX" && entity.kind == "POLYLINE") {
      part = &entity.vertices.emplace_back(file_);
    } else if (group->value == "VERTEX" || group->value == "ATTRIB" || group->value == "SEQEND") {
      attribute.groups.clear();
      part = &attribute;
    } else {
      end();
      entity = DxfEntity(file_);
      entity.kind = group->value;
      entity.line = group->line;
      part = &entity;
    }
  }
  end();
}

std::string DxfDrawing::utf8(std::string_view value) const {
  return to_utf8(std::string(value), code_page_);
}

}  // namespace weft::files
