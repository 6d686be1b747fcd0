// SPDX-License-Identifier: Apache-2.0
// Reads NetCDF files in the classic format and its variants of 64 bits (netcdf_header.h): what
// variables there are, their attributes, and their values.
//
//   NetcdfFile file(contents);                        // throws NetcdfFile::Malformed
//   const NetcdfFile::Variable* x = file.find("mesh2d_node_x");
//   std::vector<double> xs = file.reals(*x);
//
// Every length is held against that of the file before anything is allocated.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace weft::files {

class NetcdfFile {
 public:
  struct Malformed {
    std::string why;
  };
  // Numbers, whatever their type, or a text.
  struct Attribute {
    std::vector<double> numbers;
    std::string text;
  };
  struct Variable {
    std::int32_t type = 0;
    std::vector<std::uint64_t> shape;
    std::map<std::string, Attribute, std::less<>> attributes;
    std::uint64_t begin = 0;  // of its values, in bytes
    bool grows = false;       // with records, which are not read

    // Empty if there is no such attribute, or it is no text.
    std::string_view text(std::string_view name) const;
    // The attribute's first number, or else `otherwise`.
    double number(std::string_view name, double otherwise) const;
  };

  // `bytes` outlive the file. Throws Malformed.
  explicit NetcdfFile(std::string_view bytes);

  const std::map<std::string, Variable, std::less<>>& variables() const { return variables_; }
  // Null if there is none.
  const Variable* find(std::string_view name) const;
  // All values, row by row. Throws Malformed, for `integers` also if a value has no 64 bits.
  std::vector<double> reals(const Variable& variable) const;
  std::vector<std::int64_t> integers(const Variable& variable) const;

 private:
  std::string_view take(std::uint64_t size);
  std::uint64_t count();  // of things to come
  std::uint64_t offset_or_length();
  std::int32_t type();
  std::string name();
  std::map<std::string, Attribute, std::less<>> attributes();
  std::string_view values_of(const Variable& variable) const;

  std::string_view bytes_;
  std::string_view rest_;
  int version_ = 0;
  std::map<std::string, Variable, std::less<>> variables_;
};

}  // namespace weft::files
