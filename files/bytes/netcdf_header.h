// SPDX-License-Identifier: Apache-2.0
// The header of a NetCDF file in the classic format
// (https://docs.unidata.ucar.edu/netcdf-c/current/ file_format_specifications.html): dimensions,
// variables and their attributes. The arrays follow in the order in which the variables were added,
// each big-endian, without gaps.
//
//   NetcdfHeader header;
//   const auto nodes = header.dimension("node", 4);
//   header.text("Conventions", "CF-1.8");                      // of the file
//   header.variable("x", NetcdfType::kDouble, {nodes}).text("units", "m");
//   header.put(file);
//   for (double x : xs) put_big_endian(file, x);
//
// The variant is that of 64-bit offsets (CDF-2), which every NetCDF library since 2004 reads; if an
// array has 4 GiB or more, that of 64-bit data (CDF-5). libnetcdf would need a file with a name,
// and 20 libraries at each start; a header and arrays in order are all that a mesh needs.
//
// The format takes a dimension of length 0 for one that may grow: a variable with one is left out,
// and has no values anyway.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/atomic_file.h"

namespace weft::files {

enum class NetcdfType : std::int32_t { kChar = 2, kInt = 4, kDouble = 6 };

class NetcdfHeader {
 public:
  struct Dimension {
    std::string name;
    std::size_t length;
  };

  // Attributes, of a variable or of the file.
  class Attributes {
   public:
    Attributes& text(std::string_view name, std::string_view value);
    Attributes& number(std::string_view name, std::int32_t value);
    Attributes& numbers(std::string_view name, std::span<const std::int32_t> values);
    Attributes& number(std::string_view name, float value);
    Attributes& number(std::string_view name, double value);

   private:
    friend class NetcdfHeader;
    struct Attribute {
      std::string name;
      std::int32_t type;
      std::size_t count;
      std::string bytes;  // padded to four
    };
    std::vector<Attribute> all_;
  };

  // Returns the number of the dimension.
  std::size_t dimension(std::string_view name, std::size_t length);
  // The reference is valid as long as the header.
  Attributes& variable(std::string_view name, NetcdfType type, std::vector<std::size_t> dimensions);
  Attributes& file() { return attributes_; }

  // REQUIRES: nothing is added any more, and the arrays follow in `out`.
  void put(OutputFile& out) const;

 private:
  struct Variable {
    std::string name;
    NetcdfType type;
    std::vector<std::size_t> dimensions;
    Attributes attributes;
  };
  std::uint64_t bytes(const Variable& variable) const;  // of its values, padded to four
  // The header, if the values begin at `begin`.
  std::string header(bool large, std::uint64_t begin) const;

  std::vector<Dimension> dimensions_;
  std::deque<Variable> variables_;
  Attributes attributes_;
};

}  // namespace weft::files
