// SPDX-License-Identifier: Apache-2.0
#include "tests/support/poly.h"
#include "tests/support/paths.h"

#include <cstdint>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace weft {
namespace {

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path) {
    if (!file_) throw std::runtime_error(path + ": cannot be read");
  }

  // The next line that says something, without its comment.
  std::istringstream line() {
    std::string text;
    while (std::getline(file_, text)) {
      ++line_;
      text = text.substr(0, text.find('#'));
      if (text.find_first_not_of(" \t\r") != std::string::npos) return std::istringstream(text);
    }
    fail("ends too early");
  }

  // As `line`, but the file may end here.
  bool at_end() {
    while (file_ && (std::isspace(file_.peek()) || file_.peek() == '#')) {
      std::string rest;
      if (file_.peek() == '#') {
        std::getline(file_, rest);
      } else {
        file_.get();
      }
    }
    return file_.peek() == std::ifstream::traits_type::eof();
  }

  template <class T>
  T take(std::istringstream& in) {
    T value;
    if (!(in >> value)) fail("a number is missing");
    return value;
  }

  [[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error(path_ + ":" + std::to_string(line_) + ": " + what);
  }

 private:
  std::string path_;
  std::ifstream file_;
  int line_ = 0;
};

}  // namespace

Pslg read_poly(const std::string& path) {
  Reader reader(path);
  Pslg pslg;

  auto head = reader.line();
  const auto points = reader.take<std::size_t>(head);
  std::uint32_t base = 0;
  for (std::size_t i = 0; i < points; ++i) {
    auto in = reader.line();
    const auto number = reader.take<std::uint32_t>(in);
    if (i == 0) base = number;
    const double x = reader.take<double>(in);
    pslg.points.push_back({x, reader.take<double>(in)});
  }

  head = reader.line();
  const auto segments = reader.take<std::size_t>(head);
  std::size_t markers = 0;
  head >> markers;
  for (std::size_t i = 0; i < segments; ++i) {
    auto in = reader.line();
    reader.take<std::uint32_t>(in);
    Segment s;
    s.a = reader.take<std::uint32_t>(in) - base;
    s.b = reader.take<std::uint32_t>(in) - base;
    if (markers > 0) s.marker = reader.take<std::int32_t>(in);
    pslg.segments.push_back(s);
  }

  head = reader.line();
  const auto holes = reader.take<std::size_t>(head);
  for (std::size_t i = 0; i < holes; ++i) {
    auto in = reader.line();
    reader.take<std::uint32_t>(in);
    const double x = reader.take<double>(in);
    pslg.holes.push_back({x, reader.take<double>(in)});
  }

  if (reader.at_end()) return pslg;
  head = reader.line();
  const auto regions = reader.take<std::size_t>(head);
  for (std::size_t i = 0; i < regions; ++i) {
    auto in = reader.line();
    reader.take<std::uint32_t>(in);
    RegionSeed seed;
    seed.at.x = reader.take<double>(in);
    seed.at.y = reader.take<double>(in);
    seed.id = static_cast<std::int32_t>(reader.take<double>(in));
    double max_area = 0;
    if (in >> max_area && max_area > 0) seed.max_area = max_area;
    pslg.regions.push_back(seed);
  }
  return pslg;
}

std::string model(const std::string& name) {
  return std::string(testing::kModels) + "/" + name;
}

}  // namespace weft
