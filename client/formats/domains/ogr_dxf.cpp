// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ogr_dxf.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>

#include "client/base/text.h"
#include "client/base/words.h"

namespace weft::client {
namespace {

// Entities with a geometry, and what belongs to one before it.
constexpr std::string_view kRead[] = {
    "3DFACE",   "ARC",   "CIRCLE", "ELLIPSE", "HATCH",  "INSERT", "LINE",  "LWPOLYLINE", "POINT",
    "POLYLINE", "SOLID", "SPLINE", "TRACE",   "VERTEX", "SEQEND", "BLOCK", "ENDBLK"};
// What says something about the drawing, or only helps to draw it.
constexpr std::string_view kAnnotations[] = {"ACAD_TABLE",
                                             "ARC_DIMENSION",
                                             "ATTDEF",
                                             "ATTRIB",
                                             "DIMENSION",
                                             "IMAGE",
                                             "LARGE_RADIAL_DIMENSION",
                                             "LEADER",
                                             "LIGHT",
                                             "MLEADER",
                                             "MTEXT",
                                             "MULTILEADER",
                                             "OLE2FRAME",
                                             "OLEFRAME",
                                             "PDFUNDERLAY",
                                             "DWFUNDERLAY",
                                             "DGNUNDERLAY",
                                             "RAY",
                                             "RTEXT",
                                             "SHAPE",
                                             "TABLE",
                                             "TEXT",
                                             "TOLERANCE",
                                             "VIEWPORT",
                                             "WIPEOUT",
                                             "XLINE"};

bool is_in(const auto& list, std::string_view kind) {
  return std::ranges::find(list, kind) != std::end(list);
}

// A code and its value, on a line each.
struct Pair {
  int code = 0;
  std::string_view value;
  std::string_view lines;  // both, with their ends
};

class Model {
 public:
  explicit Model(std::string_view drawing) : rest_(drawing) {}

  DxfModel make() {
    while (const auto pair = next()) {
      if (pair->code == 0) begin(pair->value);
      if (pair->code == 2 && kind_ == "SECTION" && section_.empty()) section_ = pair->value;
      if (pair->code == 67 && section_ == "ENTITIES") is_on_paper_ = pair->value == "1";
      entity_ += pair->lines;
    }
    end();
    model_ += rest_;
    return {(has_header_ ? "" : "  0\nSECTION\n  2\nHEADER\n  0\nENDSEC\n") + with_paper(),
            sentences()};
  }

 private:
  std::optional<std::string_view> line(std::string_view& rest, std::string_view& whole) const {
    if (rest.empty()) return std::nullopt;
    const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
    std::size_t next = end;
    if (next < rest.size()) next += rest.substr(next).starts_with("\r\n") ? 2 : 1;
    whole = {whole.data(), whole.size() + next};
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(next);
    return text;
  }
  std::optional<Pair> next() {
    std::string_view rest = rest_;
    std::string_view whole = rest_.substr(0, 0);
    const auto code = line(rest, whole);
    const auto value = code ? line(rest, whole) : std::nullopt;
    const auto number = value ? whole_number(trimmed(*code)) : std::nullopt;
    if (!number) return std::nullopt;
    rest_ = rest;
    lines_ += 2;
    return Pair{*number, trimmed(*value), whole};
  }
  static std::optional<int> whole_number(std::string_view text) {
    int value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  // Of the entity, or the mark of a section, of that kind.
  void begin(std::string_view kind) {
    end();
    kind_ = kind;
    line_ = lines_;
  }
  void end() {
    const bool is_part = kind_ == "VERTEX" || kind_ == "SEQEND" || kind_ == "ATTRIB";
    if (!is_part) fate_ = fate_of_entity();
    has_header_ = has_header_ || section_ == "HEADER";
    std::string& out = fate_ == Fate::kPaper ? paper_ : model_;
    if (fate_ == Fate::kPaper) {
      if (!is_part) count(paper_kinds_, kind_);
    } else if (!is_part && section_ == "ENTITIES" && is_in(kRead, kind_)) {
      has_model_ = true;
    }
    if (fate_ != Fate::kLeftOut && kind_ != "ATTRIB") {
      // Entities on paper come before the end of their section.
      if (kind_ == "ENDSEC" && section_ == "ENTITIES") paper_at_ = model_.size();
      out += entity_;
    }
    if (kind_ == "ENDSEC") section_ = "";
    entity_.clear();
    is_on_paper_ = false;
  }

  enum class Fate { kKept, kLeftOut, kPaper };
  Fate fate_of_entity() {
    if (kind_ == "SECTION" || kind_ == "ENDSEC" || (section_ != "ENTITIES" && section_ != "BLOCKS"))
      return Fate::kKept;
    if (is_in(kAnnotations, kind_)) return Fate::kLeftOut;
    if (is_on_paper_) return Fate::kPaper;
    if (!is_in(kRead, kind_) && !kind_.empty()) count(unread_kinds_, kind_);
    return Fate::kKept;
  }

  struct Count {
    std::size_t number = 0;
    std::size_t line = 0;  // of the first
  };
  using Counts = std::map<std::string, Count, std::less<>>;
  void count(Counts& counts, std::string_view kind) const {
    Count& of_kind = counts[std::string(kind)];
    if (of_kind.number++ == 0) of_kind.line = line_;
  }

  // A drawing that is on paper alone is that.
  std::string with_paper() {
    if (!has_model_) model_.insert(std::min(paper_at_, model_.size()), paper_);
    return std::move(model_);
  }

  std::vector<std::string> sentences() const {
    std::vector<std::string> all;
    for (const auto& [kind, counted] : unread_kinds_)
      all.push_back(said(kind, counted) + " not read: it has no lines that GDAL knows");
    for (const auto& [kind, counted] : paper_kinds_)
      if (has_model_) all.push_back(said(kind, counted) + " left out: on paper, not in the model");
    return all;
  }
  static std::string said(const std::string& kind, const Count& counted) {
    const bool one = counted.number == 1;
    return with_separators(counted.number) + (one ? " entity" : " entities") + " of the kind " +
           in_quotes(kind) + (one ? ", line " : ", the first in line ") +
           std::to_string(counted.line) + ", " + (one ? "is" : "are");
  }

  std::string_view rest_;
  std::size_t lines_ = 0;
  std::string_view kind_;  // of the entity
  std::string_view section_;
  std::string entity_;        // its lines so far
  std::size_t line_ = 0;      // of its kind
  bool is_on_paper_ = false;  // the entity
  Fate fate_ = Fate::kKept;   // of the entity, and of its parts
  bool has_header_ = false;
  bool has_model_ = false;
  std::string model_;
  std::string paper_;
  std::size_t paper_at_ = 0;
  Counts unread_kinds_;
  Counts paper_kinds_;
};

}  // namespace

DxfModel dxf_model(std::string_view drawing) {
  return Model(drawing).make();
}

DxfCopy::DxfCopy(const Gdal& gdal, const std::string& file)
    : gdal_(gdal),
      // No other file in memory has the name, as no other object has the address.
      address_("/vsimem/weft-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".dxf") {
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (gdal_.VSIIngestFile(nullptr, file.c_str(), &bytes, &size, -1) != 0)
    model_ = dxf_model({reinterpret_cast<const char*>(bytes), size});
  gdal_.VSIFree(bytes);
  VSILFILE* made =
      gdal_.VSIFileFromMemBuffer(address_.c_str(), reinterpret_cast<GByte*>(model_.text.data()),
                                 model_.text.size(), /*bTakeOwnership=*/FALSE);
  if (made != nullptr) gdal_.VSIFCloseL(made);
}

DxfCopy::~DxfCopy() {
  gdal_.VSIUnlink(address_.c_str());
}

}  // namespace weft::client
