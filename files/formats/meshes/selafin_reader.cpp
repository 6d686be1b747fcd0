// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/selafin.h"

namespace weft::files {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 30;

// Thrown and caught in this file only.
struct Malformed {
  std::string why;
};

// Records of Fortran: their length in bytes, these bytes, their length again.
class Records {
 public:
  explicit Records(std::string_view bytes) : rest_(bytes) {
    constexpr std::int32_t kTitle = 80;
    is_swapped_ = number<std::int32_t>(rest_, 0) != kTitle;
    if (number<std::int32_t>(rest_, 0) != kTitle)
      throw Malformed{"is not in TELEMAC's format: it does not begin with a title"};
  }

  bool at_end() const { return rest_.empty(); }
  std::string_view next(const char* what) {
    const auto size = static_cast<std::uint32_t>(number<std::int32_t>(rest_, 0));
    constexpr std::size_t kLength = 4;
    if (rest_.size() < 2 * kLength || size > rest_.size() - 2 * kLength)
      throw Malformed{std::string("ends inside ") + what};
    const std::string_view record = rest_.substr(kLength, size);
    rest_.remove_prefix(kLength + size);
    if (static_cast<std::uint32_t>(number<std::int32_t>(rest_, 0)) != size)
      throw Malformed{std::string("is damaged at ") + what};
    rest_.remove_prefix(kLength);
    return record;
  }

  template <class T>
  T number(std::string_view record, std::size_t i) const {
    char bytes[sizeof(T)];
    if (record.size() / sizeof bytes <= i) throw Malformed{"is cut short"};
    std::memcpy(bytes, record.data() + i * sizeof bytes, sizeof bytes);
    if (is_swapped_) std::reverse(std::begin(bytes), std::end(bytes));
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  std::vector<std::int32_t> integers(const char* what, std::size_t count) {
    const std::string_view record = sized(what, count, sizeof(std::int32_t));
    std::vector<std::int32_t> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(number<std::int32_t>(record, i));
    return out;
  }
  std::vector<double> reals(const char* what, std::size_t count, bool is_double) {
    const std::string_view record = sized(what, count, is_double ? sizeof(double) : sizeof(float));
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i)
      out.push_back(is_double ? number<double>(record, i) : number<float>(record, i));
    return out;
  }

 private:
  std::string_view sized(const char* what, std::size_t count, std::size_t size) {
    const std::string_view record = next(what);
    if (record.size() != count * size)
      throw Malformed{std::string(what) + " have " + std::to_string(record.size()) +
                      " bytes, not " + std::to_string(count * size)};
    return record;
  }

  std::string_view rest_;
  bool is_swapped_ = false;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : records_(bytes) {
    is_double_ = records_.next("the title").ends_with("SERAFIND");
    const auto variables = records_.integers("the counts of variables", 2);
    if (variables[0] < 0 || variables[1] < 0) throw Malformed{"has a negative count of variables"};
    for (std::int64_t i = 0; i < std::int64_t{variables[0]} + variables[1]; ++i) {
      const std::string name(trimmed(records_.next("the name of a variable").substr(0, 16)));
      names_.push_back(name == "BOTTOM" || name == "FOND" ? "elevation" : name);
    }
    const auto parameters = records_.integers("the parameters", 10);
    if (parameters[6] > 1)
      throw Malformed{"has " + std::to_string(parameters[6]) + " planes, only one is read"};
    if (parameters[9] == 1) records_.integers("the date", 6);
    read_mesh(parameters);
  }

  const std::vector<std::string>& names() const { return names_; }
  Mesh take_mesh() { return std::move(mesh_); }
  // The values of all variables at the last time.
  std::vector<std::vector<double>> values() {
    std::vector<std::vector<double>> last(names_.size());
    while (!records_.at_end()) {
      records_.reals("the time", 1, is_double_);
      for (auto& values : last) values = records_.reals("values", nodes_, is_double_);
    }
    return last;
  }

 private:
  void read_mesh(const std::vector<std::int32_t>& parameters) {
    const auto counts = records_.integers("the counts of elements and points", 4);
    const std::int32_t corners = counts[2];
    if (counts[0] < 0 || counts[1] < 0)
      throw Malformed{"has a negative count of elements or points"};
    if (corners != 3 && corners != 4)
      throw Malformed{"has elements of " + std::to_string(corners) +
                      " points, only those of 3 and 4 are read"};
    nodes_ = static_cast<std::size_t>(counts[1]);
    const auto width = static_cast<std::size_t>(corners);
    const auto rows = records_.integers("elements", width * static_cast<std::size_t>(counts[0]));
    std::vector<std::uint32_t> element;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i] < 1 || static_cast<std::size_t>(rows[i]) > nodes_)
        throw Malformed{"element " + std::to_string(i / width + 1) + " has the point " +
                        std::to_string(rows[i]) + " of " + std::to_string(nodes_)};
      element.push_back(static_cast<std::uint32_t>(rows[i]) - 1);
      if (element.size() < width) continue;
      if (width > 3)
        mesh_.faces.add(element, 0);
      else
        mesh_.triangles.insert(mesh_.triangles.end(), element.begin(), element.end());
      element.clear();
    }
    records_.integers("the numbers of boundary points", nodes_);
    const auto x = records_.reals("x coordinates", nodes_, is_double_);
    const auto y = records_.reals("y coordinates", nodes_, is_double_);
    for (std::size_t v = 0; v < nodes_; ++v)
      mesh_.coordinates.insert(mesh_.coordinates.end(),
                               {x[v] + parameters[2], y[v] + parameters[3]});
  }

  Records records_;
  bool is_double_ = false;
  std::vector<std::string> names_;
  std::size_t nodes_ = 0;
  Mesh mesh_;
};

template <class T, class Read>
Result<T> read_file_by(const std::filesystem::path& path, const Read& read) {
  const auto contents = read_file(path, kMaxFileBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    return read(Reader(contents->text()));
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + malformed.why);
  }
}

}  // namespace

Result<Mesh> read_selafin(const std::filesystem::path& path) {
  return read_file_by<Mesh>(path,
                            [&](Reader reader) { return validated(path, reader.take_mesh()); });
}

Result<MeshWithArrays> read_selafin_values(const std::filesystem::path& path,
                                           const std::optional<std::string>& wanted) {
  return read_file_by<MeshWithArrays>(path, [&](Reader reader) -> Result<MeshWithArrays> {
    const auto chosen = chosen_arrays(path, reader.names(), wanted);
    if (!chosen) return tl::unexpected(chosen.error());
    auto mesh = validated(path, reader.take_mesh());
    if (!mesh) return tl::unexpected(mesh.error());
    MeshWithArrays all{std::move(*mesh), {}};
    auto values = reader.values();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::string& name = reader.names()[i];
      const auto is_known = [](double value) { return value != 0; };
      const bool is_filler = name == "elevation" && !wanted &&  // written if it is unknown, too
                             std::ranges::none_of(values[i], is_known);
      if (!is_filler && std::ranges::find(*chosen, name) != chosen->end())
        all.arrays.push_back({name, std::move(values[i])});
    }
    return all;
  });
}

}  // namespace weft::files
