// SPDX-License-Identifier: Apache-2.0
// A drawing in the text form of DXF, as the entities of its model and of its blocks. A group is a
// code, which is a whole number, and a value, on a line each; a group of code 0 begins an entity.
//
// Entities are made of the text when they are asked for, so a drawing takes no memory beside it.
// Every function here throws DxfFault for what cannot be read; it names the file, the line and what
// was expected there.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// Caught where a drawing is read (dxf.h).
struct DxfFault {
  Error error;
};

struct DxfGroup {
  int code = 0;
  std::string_view value;  // without the blanks around it
  std::uint64_t line = 0;  // of the value, from 1
};

// Groups of an entity, or of a part of it.
class DxfRecord {
 public:
  explicit DxfRecord(const std::string& file) : file_(&file) {}

  std::vector<DxfGroup> groups{};

  // Of the first group of the code; if there is none, the other value.
  double real(int code, double otherwise = 0) const;
  int integer(int code, int otherwise = 0) const;
  std::string_view text(int code) const;
  bool has(int code) const { return find(code) != nullptr; }
  // x has the code, y that plus 10, z that plus 20.
  Point point(int code) const { return {real(code), real(code + 10)}; }
  std::array<double, 3> vector(int code, std::array<double, 3> otherwise = {0, 0, 0}) const;

  double real_of(const DxfGroup& group) const;
  int integer_of(const DxfGroup& group) const;

 private:
  const DxfGroup* find(int code) const;
  tl::unexpected<Error> expected(const char* what, const DxfGroup& group) const;

  const std::string* file_;
};

struct DxfEntity : DxfRecord {
  using DxfRecord::DxfRecord;
  std::string_view kind{};
  std::uint64_t line = 0;             // of its kind
  std::vector<DxfRecord> vertices{};  // of a POLYLINE

  bool is_on_paper() const { return integer(67) == 1; }
  std::array<double, 3> extrusion() const { return vector(210, {0, 0, 1}); }
};

class DxfDrawing {
 public:
  // Entities, with the number of lines before them.
  struct Slice {
    std::string_view text;
    std::uint64_t lines = 0;
  };
  struct Block {
    Point base;
    Slice entities;
  };

  // `text` must outlive the drawing. A binary DXF, a DWG and a text without a section ENTITIES are
  // faults.
  DxfDrawing(std::string file, std::string_view text);
  DxfDrawing(const DxfDrawing&) = delete;
  DxfDrawing& operator=(const DxfDrawing&) = delete;

  const std::string& file() const { return file_; }
  const Slice& entities() const { return entities_; }
  // By their names in lower case.
  const std::map<std::string, Block, std::less<>>& blocks() const { return blocks_; }
  const Block* block(std::string_view name) const;
  // Calls `each` with the entities of a slice, in their order. Attributes of blocks are none.
  void for_each(const Slice& slice, const std::function<void(const DxfEntity&)>& each) const;
  // A value of the drawing, by its code page.
  std::string utf8(std::string_view value) const;

 private:
  class Groups;
  void read_sections(std::string_view text);
  void read_header(Groups& groups);
  void read_blocks(Groups& groups);
  void read_block(Groups& groups);

  std::string file_;
  Slice entities_;
  bool has_entities_ = false;
  std::map<std::string, Block, std::less<>> blocks_;
  std::string code_page_;
};

}  // namespace weft::files
