// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/netcdf_file.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <type_traits>
#include <utility>

#include "files/base/text.h"

namespace weft::files {
namespace {

// The sizes of the types, by number: char is 2.
constexpr std::size_t kSizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
constexpr std::int32_t kChar = 2;

template <class T>
T number_at(const char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  char turned[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) turned[i] = bytes[sizeof(T) - 1 - i];
  T value;
  std::memcpy(&value, turned, sizeof value);
  return value;
}

// Calls visit(value) for each number of the type.
template <class Visit>
void for_each(std::string_view bytes, std::int32_t type, const Visit& visit) {
  const auto all = [&]<class T>(T) {
    for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T))
      visit(number_at<T>(bytes.data() + at));
  };
  switch (type) {
    case 1:
      return all(std::int8_t{});
    case 3:
      return all(std::int16_t{});
    case 4:
      return all(std::int32_t{});
    case 5:
      return all(float{});
    case 6:
      return all(double{});
    case 7:
      return all(std::uint8_t{});
    case 8:
      return all(std::uint16_t{});
    case 9:
      return all(std::uint32_t{});
    case 10:
      return all(std::int64_t{});
    case 11:
      return all(std::uint64_t{});
    default:  // text
      return;
  }
}

std::uint64_t padded(std::uint64_t size) {
  return (size + 3) / 4 * 4;
}

}  // namespace

std::string_view NetcdfFile::Variable::text(std::string_view name) const {
  const auto found = attributes.find(name);
  return found == attributes.end() ? std::string_view() : found->second.text;
}

double NetcdfFile::Variable::number(std::string_view name, double otherwise) const {
  const auto found = attributes.find(name);
  return found == attributes.end() || found->second.numbers.empty() ? otherwise
                                                                    : found->second.numbers[0];
}

NetcdfFile::NetcdfFile(std::string_view bytes) : bytes_(bytes), rest_(bytes) {
  if (bytes.starts_with("\x89HDF"))
    throw Malformed{
        "is NetCDF-4, which is HDF5; the classic format is read: nccopy -k cdf2 makes it"};
  version_ = bytes.size() >= 4 && bytes.starts_with("CDF") ? bytes[3] : 0;
  if (version_ != 1 && version_ != 2 && version_ != 5)
    throw Malformed{"is not a NetCDF file in the classic format"};
  take(4);
  version_ == 5 ? take(8) : take(4);  // how many records
  constexpr std::int32_t kDimensions = 10;
  constexpr std::int32_t kVariables = 11;
  const auto begins = [this](std::int32_t kind) {
    const auto tag = number_at<std::int32_t>(take(4).data());
    if (tag != 0 && tag != kind) throw Malformed{"its header is damaged"};
    const std::uint64_t things = count();
    if (tag == 0 && things != 0) throw Malformed{"its header is damaged"};
    return things;
  };
  std::vector<std::uint64_t> dimensions;
  for (std::uint64_t i = begins(kDimensions); i > 0; --i) {
    name();
    dimensions.push_back(offset_or_length());
  }
  attributes();
  for (std::uint64_t i = begins(kVariables); i > 0; --i) {
    std::string key = name();
    Variable variable;
    for (std::uint64_t k = count(); k > 0; --k) {
      const std::uint64_t dimension = offset_or_length();
      if (dimension >= dimensions.size()) throw Malformed{"its header is damaged"};
      variable.grows |= dimensions[dimension] == 0;
      variable.shape.push_back(dimensions[dimension]);
    }
    variable.attributes = attributes();
    variable.type = type();
    offset_or_length();  // the size of the data, which the shape gives
    variable.begin = version_ == 1 ? number_at<std::uint32_t>(take(4).data())
                                   : number_at<std::uint64_t>(take(8).data());
    variables_.insert_or_assign(std::move(key), std::move(variable));
  }
}

std::string_view NetcdfFile::take(std::uint64_t size) {
  if (size > rest_.size()) throw Malformed{"is cut short"};
  const std::string_view taken = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return taken;
}

std::uint64_t NetcdfFile::offset_or_length() {
  return version_ == 5 ? number_at<std::uint64_t>(take(8).data())
                       : number_at<std::uint32_t>(take(4).data());
}

std::uint64_t NetcdfFile::count() {
  const std::uint64_t things = offset_or_length();
  if (things > rest_.size()) throw Malformed{"is cut short"};
  return things;
}

std::int32_t NetcdfFile::type() {
  const auto type = number_at<std::int32_t>(take(4).data());
  if (type < 1 || type >= static_cast<std::int32_t>(std::size(kSizes)))
    throw Malformed{"has values of the type " + std::to_string(type)};
  return type;
}

std::string NetcdfFile::name() {
  const std::uint64_t size = count();
  const std::string text(take(size));
  take(padded(size) - size);
  return text;
}

std::map<std::string, NetcdfFile::Attribute, std::less<>> NetcdfFile::attributes() {
  constexpr std::int32_t kAttributes = 12;
  const auto tag = number_at<std::int32_t>(take(4).data());
  std::map<std::string, Attribute, std::less<>> all;
  std::uint64_t things = count();
  if (tag != kAttributes && !(tag == 0 && things == 0)) throw Malformed{"its header is damaged"};
  for (; things > 0; --things) {
    std::string key = name();
    const std::int32_t kind = type();
    const std::uint64_t values = count();
    const std::uint64_t size = values * kSizes[kind];
    const std::string_view data = take(size);
    take(padded(size) - size);
    Attribute attribute;
    if (kind == kChar) attribute.text = data;
    for_each(data, kind,
             [&](auto value) { attribute.numbers.push_back(static_cast<double>(value)); });
    all.insert_or_assign(std::move(key), std::move(attribute));
  }
  return all;
}

const NetcdfFile::Variable* NetcdfFile::find(std::string_view name) const {
  const auto found = variables_.find(name);
  return found == variables_.end() ? nullptr : &found->second;
}

std::string_view NetcdfFile::values_of(const Variable& variable) const {
  std::uint64_t size = kSizes[variable.type];
  for (const std::uint64_t extent : variable.shape) {
    if (extent != 0 && size > bytes_.size() / extent) throw Malformed{"is cut short"};
    size *= extent;
  }
  if (variable.begin > bytes_.size() || size > bytes_.size() - variable.begin)
    throw Malformed{"is cut short"};
  return bytes_.substr(variable.begin, size);
}

std::vector<double> NetcdfFile::reals(const Variable& variable) const {
  std::vector<double> out;
  for_each(values_of(variable), variable.type,
           [&out](auto value) { out.push_back(static_cast<double>(value)); });
  return out;
}

std::vector<std::int64_t> NetcdfFile::integers(const Variable& variable) const {
  std::vector<std::int64_t> out;
  for_each(values_of(variable), variable.type, [&out]<class T>(T value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!(std::abs(value) < 9e15) || value != std::nearbyint(value))
        throw Malformed{"has " + shortest(value) + " where an integer should be"};
    } else if (!std::in_range<std::int64_t>(value)) {
      throw Malformed{"has an integer of more than 63 bits"};
    }
    out.push_back(static_cast<std::int64_t>(value));
  });
  return out;
}

}  // namespace weft::files
