// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/netcdf_header.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "files/bytes/big_endian.h"

namespace weft::files {
namespace {

constexpr std::int32_t kDimensions = 10;
constexpr std::int32_t kVariables = 11;
constexpr std::int32_t kAttributes = 12;
constexpr std::int32_t kFloat = 5;

template <class T>
std::string bytes_of(T value) {
  const auto bytes = big_endian(value);
  return {bytes.data(), bytes.size()};
}

std::string padded(std::string text) {
  text.resize((text.size() + 3) / 4 * 4, '\0');
  return text;
}

// Writes the parts of a header, in one of the two variants.
class Text {
 public:
  explicit Text(bool large) : large_(large) {}
  void tag(std::int32_t value) { text_ += bytes_of(value); }
  void count(std::uint64_t value) {
    text_ += large_ ? bytes_of(value) : bytes_of(static_cast<std::uint32_t>(value));
  }
  void offset(std::uint64_t value) { text_ += bytes_of(value); }
  void name(const std::string& value) {
    count(value.size());
    text_ += padded(value);
  }
  void bytes(const std::string& value) { text_ += value; }
  // The tag before a list.
  void list(std::int32_t kind, std::size_t size) {
    tag(size == 0 ? 0 : kind);
    count(size);
  }
  std::string take() { return std::move(text_); }

 private:
  bool large_;
  std::string text_;
};

}  // namespace

NetcdfHeader::Attributes& NetcdfHeader::Attributes::text(std::string_view name,
                                                         std::string_view value) {
  all_.push_back({std::string(name), static_cast<std::int32_t>(NetcdfType::kChar), value.size(),
                  padded(std::string(value))});
  return *this;
}

NetcdfHeader::Attributes& NetcdfHeader::Attributes::number(std::string_view name,
                                                           std::int32_t value) {
  all_.push_back(
      {std::string(name), static_cast<std::int32_t>(NetcdfType::kInt), 1, bytes_of(value)});
  return *this;
}

NetcdfHeader::Attributes& NetcdfHeader::Attributes::numbers(std::string_view name,
                                                            std::span<const std::int32_t> values) {
  std::string bytes;
  for (const std::int32_t value : values) bytes += bytes_of(value);
  all_.push_back({std::string(name), static_cast<std::int32_t>(NetcdfType::kInt), values.size(),
                  std::move(bytes)});
  return *this;
}

NetcdfHeader::Attributes& NetcdfHeader::Attributes::number(std::string_view name, float value) {
  all_.push_back({std::string(name), kFloat, 1, bytes_of(value)});
  return *this;
}

NetcdfHeader::Attributes& NetcdfHeader::Attributes::number(std::string_view name, double value) {
  all_.push_back(
      {std::string(name), static_cast<std::int32_t>(NetcdfType::kDouble), 1, bytes_of(value)});
  return *this;
}

std::size_t NetcdfHeader::dimension(std::string_view name, std::size_t length) {
  dimensions_.push_back({std::string(name), length});
  return dimensions_.size() - 1;
}

NetcdfHeader::Attributes& NetcdfHeader::variable(std::string_view name, NetcdfType type,
                                                 std::vector<std::size_t> dimensions) {
  variables_.push_back({std::string(name), type, std::move(dimensions), {}});
  return variables_.back().attributes;
}

std::uint64_t NetcdfHeader::bytes(const Variable& variable) const {
  std::uint64_t size = variable.type == NetcdfType::kChar  ? 1
                       : variable.type == NetcdfType::kInt ? 4
                                                           : 8;
  for (const std::size_t d : variable.dimensions) size *= dimensions_[d].length;
  return (size + 3) / 4 * 4;
}

std::string NetcdfHeader::header(bool large, std::uint64_t begin) const {
  std::vector<std::size_t> number;  // The number of each dimension in the file, from which those of
                                    // length 0 are left out.
  Text dimensions(large);
  std::size_t count = 0;
  for (const Dimension& dimension : dimensions_) {
    number.push_back(count);
    if (dimension.length == 0) continue;
    ++count;
    dimensions.name(dimension.name);
    dimensions.count(dimension.length);
  }
  const auto put_attributes = [](Text& out, const Attributes& attributes) {
    out.list(kAttributes, attributes.all_.size());
    for (const auto& attribute : attributes.all_) {
      out.name(attribute.name);
      out.tag(attribute.type);
      out.count(attribute.count);
      out.bytes(attribute.bytes);
    }
  };
  Text variables(large);
  std::size_t in_file = 0;
  for (const Variable& variable : variables_) {
    const std::uint64_t size = bytes(variable);
    if (size == 0) continue;
    ++in_file;
    variables.name(variable.name);
    variables.count(variable.dimensions.size());
    for (const std::size_t d : variable.dimensions) variables.count(number[d]);
    put_attributes(variables, variable.attributes);
    variables.tag(static_cast<std::int32_t>(variable.type));
    variables.count(size);
    variables.offset(begin);
    begin += size;
  }
  Text all(large);
  all.bytes(std::string("CDF") + (large ? '\5' : '\2'));
  all.count(0);  // records
  all.list(kDimensions, count);
  all.bytes(dimensions.take());
  put_attributes(all, attributes_);
  all.list(kVariables, in_file);
  all.bytes(variables.take());
  return all.take();
}

void NetcdfHeader::put(OutputFile& out) const {
  constexpr std::uint64_t kMaxBytes = std::numeric_limits<std::uint32_t>::max() - 3;
  constexpr std::uint64_t kMaxLength = std::numeric_limits<std::int32_t>::max();
  const bool large = std::any_of(dimensions_.begin(), dimensions_.end(),
                                 [](const Dimension& d) { return d.length > kMaxLength; }) ||
                     std::any_of(variables_.begin(), variables_.end(),
                                 [this](const Variable& v) { return bytes(v) > kMaxBytes; });
  out.put(header(large, header(large, 0).size()));
}

}  // namespace weft::files
