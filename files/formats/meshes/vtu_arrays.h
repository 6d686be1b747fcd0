// SPDX-License-Identifier: Apache-2.0
// The arrays of VTK's XML files (VTK file formats, "XML file formats"): numbers as text, or bytes,
// inline in base64 or appended, raw or in base64, whole or in blocks that are compressed by zlib,
// LZ4 or LZMA.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <type_traits>
#include <vector>

#include "files/bytes/compression.h"

namespace weft::files {

// An array whose values are not read yet.
struct VtuArray {
  enum class Place { kText, kInline, kAppended };
  std::string_view type;  // "Float64"
  Place place = Place::kText;
  std::string_view text;     // between the tags
  std::uint64_t offset = 0;  // of an appended one
};

class VtuArrays {
 public:
  void set_headers(bool are_wide) { header_ = are_wide ? 8 : 4; }
  void set_compressor(Packing packing) { packing_ = packing; }
  void set_appended(std::string_view bytes, bool is_base64) {
    appended_ = bytes;
    is_base64_ = is_base64;
  }
  void add_offset(std::uint64_t offset) { offsets_.insert(offset); }

  // The numbers of an array. The error follows "the array 'NAME' ".
  template <class T>
  tl::expected<std::vector<T>, std::string> values(const VtuArray& array) const {
    std::vector<T> out;
    bool read = false;
    if (array.place == VtuArray::Place::kText) {
      read = append_text(array.text, out);
    } else {
      std::string made;
      const auto bytes = bytes_of(array, made);
      if (!bytes) return tl::unexpected(bytes.error());
      if (array.type == "Float64") read = append_raw<T, double>(*bytes, out);
      if (array.type == "Float32") read = append_raw<T, float>(*bytes, out);
      if (array.type == "Int64") read = append_raw<T, std::int64_t>(*bytes, out);
      if (array.type == "UInt64") read = append_raw<T, std::uint64_t>(*bytes, out);
      if (array.type == "Int32") read = append_raw<T, std::int32_t>(*bytes, out);
      if (array.type == "UInt32") read = append_raw<T, std::uint32_t>(*bytes, out);
      if (array.type == "Int16") read = append_raw<T, std::int16_t>(*bytes, out);
      if (array.type == "UInt16") read = append_raw<T, std::uint16_t>(*bytes, out);
      if (array.type == "Int8") read = append_raw<T, std::int8_t>(*bytes, out);
      if (array.type == "UInt8") read = append_raw<T, std::uint8_t>(*bytes, out);
    }
    if (!read)
      return tl::unexpected("of type '" + std::string(array.type) +
                            "' holds a value that does not belong there");
    return out;
  }

 private:
  using Bytes = tl::expected<std::string_view, std::string>;

  // Converts one value; nullopt if it does not fit into T.
  template <class T, class From>
  static std::optional<T> convert(From value) {
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(value);
    } else {
      const auto number = static_cast<long double>(value);  // holds all integers of 64 bits
      if (!(number >= static_cast<long double>(std::numeric_limits<T>::min()) &&
            number <= static_cast<long double>(std::numeric_limits<T>::max())))
        return std::nullopt;
      return static_cast<T>(value);
    }
  }

  template <class T, class From>
  static bool append_raw(std::string_view bytes, std::vector<T>& out) {
    for (std::size_t at = 0; at + sizeof(From) <= bytes.size(); at += sizeof(From)) {
      From value;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      const auto converted = convert<T>(value);
      if (!converted) return false;
      out.push_back(*converted);
    }
    return true;
  }

  template <class T>
  static bool append_text(std::string_view text, std::vector<T>& out) {
    for (;;) {
      const std::size_t start = text.find_first_not_of(" \t\r\n");
      if (start == std::string_view::npos) return true;
      text.remove_prefix(start);
      T value{};
      const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (problem != std::errc()) return false;
      out.push_back(value);
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
  }

  // The values as bytes, in `made` unless they lie in the file like that.
  Bytes bytes_of(const VtuArray& array, std::string& made) const;
  // The number of a header, or nullopt if the bytes end before it.
  std::optional<std::uint64_t> number(std::string_view bytes, std::uint64_t index) const;
  Bytes unpack(std::string_view stored, std::string& made) const;

  std::size_t header_ = 4;  // bytes of a number in the headers of arrays
  std::optional<Packing> packing_;
  std::string_view appended_;
  bool is_base64_ = false;           // the appended data
  std::set<std::uint64_t> offsets_;  // of the appended arrays
};

}  // namespace weft::files
