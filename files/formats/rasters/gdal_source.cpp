// SPDX-License-Identifier: Apache-2.0
// Rasters by GDAL.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/gdal_library.h"
#include "files/formats/rasters/raster_source.h"

namespace weft::files {
namespace {

constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
constexpr double kTwoPi = 6.283185307179586;
// Values that are held in memory while they are converted.
constexpr std::uint32_t kChunkValues = 1U << 21;

using Dataset = std::unique_ptr<void, decltype(&GDALClose)>;
using Crs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>,
                            decltype(&OSRDestroySpatialReference)>;

tl::unexpected<Error> unreadable(const std::string& name, const std::string& why) {
  return fail(ExitCode::kUnreadableInput, name + ": " + why);
}

class ReprojectedPlane final : public PlaneToRaster {
 public:
  // `transform` is one of GDALReprojectionTransform, from the raster to the plane.
  ReprojectedPlane(const Gdal& gdal, void* transform) : gdal_(gdal), transform_(transform) {}
  ~ReprojectedPlane() override { gdal_.GDALDestroyReprojectionTransformer(transform_); }

  void transform(std::size_t n, double* x, double* y, double tolerance) const override {
    const GdalErrors quiet(gdal_);
    z_.assign(n, 0);
    succeeded_.assign(n, 0);
    void* approximate =
        gdal_.GDALCreateApproxTransformer(gdal_.GDALReprojectionTransform, transform_, tolerance);
    gdal_.GDALApproxTransform(approximate, TRUE, static_cast<int>(n), x, y, z_.data(),
                              succeeded_.data());
    gdal_.GDALDestroyApproxTransformer(approximate);
    for (std::size_t i = 0; i < n; ++i)
      if (succeeded_[i] == 0 || !std::isfinite(x[i]) || !std::isfinite(y[i]))
        x[i] = y[i] = std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const Gdal& gdal_;
  void* transform_;
  mutable std::vector<double> z_;
  mutable std::vector<int> succeeded_;
};

// Finds the band of a file that the user asks for.
class BandChoice {
 public:
  BandChoice(const Gdal& gdal, std::string name, std::string_view wanted)
      : gdal_(gdal), name_(std::move(name)), wanted_(wanted) {}

  struct Chosen {
    Dataset dataset;
    GDALRasterBandH band;
  };
  Result<Chosen> choose(const std::filesystem::path& path) {
    auto dataset = open(path.string());
    if (!dataset) return tl::unexpected(dataset.error());
    const auto variables = variables_of(dataset->get());
    if (gdal_.GDALGetRasterCount(dataset->get()) == 0 && !variables.empty()) {
      dataset = open_variable(variables);
      if (!dataset) return tl::unexpected(dataset.error());
    }
    const auto band = band_of(dataset->get());
    if (!band) return tl::unexpected(band.error());
    return Chosen{std::move(*dataset), *band};
  }

 private:
  struct Variable {
    std::string address;  // for GDALOpenEx
    std::string name;
  };

  Result<Dataset> open(const std::string& address) {
    const GdalErrors errors(gdal_);
    Dataset dataset(gdal_.GDALOpenEx(address.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR,
                                     nullptr, nullptr, nullptr),
                    gdal_.GDALClose);
    if (!dataset) return unreadable(name_, errors.first());
    return dataset;
  }

  std::vector<Variable> variables_of(GDALDatasetH dataset) const {
    std::vector<Variable> found;
    char** entries = gdal_.GDALGetMetadata(dataset, "SUBDATASETS");
    for (; entries != nullptr && *entries != nullptr; ++entries) {
      const std::string_view entry = *entries;
      const std::size_t equals = entry.find('=');
      if (equals == std::string_view::npos || !entry.substr(0, equals).ends_with("_NAME")) continue;
      const std::string_view address = entry.substr(equals + 1);
      std::string_view name = address.substr(address.find_last_of(":/") + 1);
      while (name.starts_with('"')) name.remove_prefix(1);
      while (name.ends_with('"')) name.remove_suffix(1);
      found.push_back({std::string(address), std::string(name)});
    }
    return found;
  }

  // The part of the wish up to a colon, which is dropped.
  std::string_view take_word() {
    const std::size_t end = std::min(wanted_.find(':'), wanted_.size());
    const std::string_view word = wanted_.substr(0, end);
    wanted_.remove_prefix(std::min(end + 1, wanted_.size()));
    return word;
  }

  // The index, from 0, of the one with that name or number; nullopt if there is none.
  static std::optional<std::size_t> find(std::string_view word,
                                         const std::vector<std::string>& names) {
    if (const auto at = std::find(names.begin(), names.end(), word); at != names.end())
      return at - names.begin();
    std::size_t number = 0;
    const char* end = word.data() + word.size();
    const auto [stop, problem] = std::from_chars(word.data(), end, number);
    if (problem != std::errc() || stop != end || number < 1 || number > names.size())
      return std::nullopt;
    return number - 1;
  }

  static std::string label(const std::vector<std::string>& names, std::size_t index) {
    const std::string number = std::to_string(index + 1);
    return names[index].empty() ? number : number + " " + in_quotes(names[index]);
  }

  static std::string list(const std::vector<std::string>& names) {
    constexpr std::size_t kMax = 24;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kMax); ++i) {
      if (i > 0) text += ", ";
      text += label(names, i);
    }
    return names.size() > kMax ? text + ", ..." : text;
  }

  // "there are 1 'depth', 2 'speed'"
  static std::string all_of(const std::vector<std::string>& names) {
    return (names.size() == 1 ? "there is only " : "there are ") + list(names);
  }

  tl::unexpected<Error> several(const std::string& what, const std::vector<std::string>& names) {
    return unreadable(name_, "has " + std::to_string(names.size()) + " " + what +
                                 "; name one as in " + name_ + ":1; " + all_of(names));
  }

  Result<Dataset> open_variable(const std::vector<Variable>& variables) {
    std::vector<std::string> names;
    for (const Variable& variable : variables) names.push_back(variable.name);
    if (wanted_.empty() && variables.size() > 1) return several("variables", names);
    const std::string_view word = take_word();
    const auto index = word.empty() ? std::optional<std::size_t>(0) : find(word, names);
    if (!index)
      return unreadable(name_, "has no variable " + in_quotes(word) + "; " + all_of(names));
    name_ += ":" + names[*index];
    return open(variables[*index].address);
  }

  Result<GDALRasterBandH> band_of(GDALDatasetH dataset) {
    const int count = gdal_.GDALGetRasterCount(dataset);
    std::vector<std::string> names;
    std::optional<std::size_t> index;  // the only band that is not for transparency
    std::size_t opaque = 0;
    bool of_one_variable = true;
    for (int i = 1; i <= count; ++i) {
      GDALRasterBandH band = gdal_.GDALGetRasterBand(dataset, i);
      const char* variable = gdal_.GDALGetMetadataItem(band, "NETCDF_VARNAME", nullptr);
      names.emplace_back(variable != nullptr ? variable : gdal_.GDALGetDescription(band));
      of_one_variable &= variable != nullptr && names.back() == names.front();
      if (gdal_.GDALGetRasterColorInterpretation(band) == GCI_AlphaBand) continue;
      index = names.size() - 1;
      ++opaque;
    }
    if (names.empty()) return unreadable(name_, "has no band");
    std::string_view asked = wanted_;
    std::string_view word = take_word();
    if (of_one_variable && word == names.front()) {
      asked = wanted_;
      word = take_word();
    }
    if (asked.empty()) {
      if (opaque != 1) return several("bands", names);
    } else {
      index = find(word, names);
      if (!index || !wanted_.empty())
        return unreadable(name_, "has no band " + in_quotes(asked) + "; " + all_of(names));
    }
    GDALRasterBandH band = gdal_.GDALGetRasterBand(dataset, static_cast<int>(*index) + 1);
    if (gdal_.GDALDataTypeIsComplex(gdal_.GDALGetRasterDataType(band)) != 0)
      return unreadable(name_,
                        "the values of band " + label(names, *index) + " are complex numbers");
    return band;
  }

  const Gdal& gdal_;
  std::string name_;
  std::string_view wanted_;  // the part that is not used yet
};

class GdalSource final : public RasterSource {
 public:
  GdalSource(const Gdal& gdal, std::string name, BandChoice::Chosen chosen)
      : gdal_(gdal), dataset_(std::move(chosen.dataset)) {
    shape_.name = std::move(name);
    levels_.push_back(chosen.band);
    for (int i = 0; i < gdal_.GDALGetOverviewCount(chosen.band); ++i)
      if (GDALRasterBandH overview = gdal_.GDALGetOverview(chosen.band, i); overview != nullptr)
        levels_.push_back(overview);
  }

  // What the file says about the raster.
  Result<void> describe() {
    const GdalErrors errors(gdal_);
    int has_scale = 0;
    int has_offset = 0;
    const double scale = gdal_.GDALGetRasterScale(levels_[0], &has_scale);
    const double offset = gdal_.GDALGetRasterOffset(levels_[0], &has_offset);
    if (has_scale != 0) scale_ = scale;
    if (has_offset != 0) offset_ = offset;
    if (auto done = locate(); !done) return done;
    OGRSpatialReferenceH crs = gdal_.GDALGetSpatialRef(dataset_.get());
    if (crs == nullptr) return {};
    const char* name = gdal_.OSRGetName(crs);
    shape_.crs = name != nullptr && *name != '\0' ? name : "an unnamed coordinate system";
    if (gdal_.OSRIsGeographic(crs) != 0) {
      const double radians = gdal_.OSRGetAngularUnits(crs, nullptr);
      shape_.turn = std::abs(radians * 360 - kTwoPi) < 1e-9 ? 360 : kTwoPi / radians;
    }
    return {};
  }

  Result<void> read(std::size_t grid, const RasterPart& part, float* out,
                    std::size_t stride) override {
    const std::uint32_t most = std::max(1U, kChunkValues / part.columns);
    for (std::uint32_t row = 0; row < part.rows; row += most) {
      const RasterPart chunk{part.column, part.row + row, part.columns,
                             std::min(most, part.rows - row)};
      if (auto done = read_chunk(grid, chunk, out + row * stride, stride); !done) return done;
    }
    return {};
  }

  bool is_in(const CoordinateSystem& system) const override {
    const GdalErrors quiet(gdal_);
    OGRSpatialReferenceH given = gdal_.GDALGetSpatialRef(dataset_.get());
    if (given == nullptr) return true;
    if (gdal_.OSRIsGeographic(given) != 0) return system.geographic;
    const Crs wanted = own(gdal_.OSRNewSpatialReference(nullptr));
    return gdal_.OSRSetFromUserInput(wanted.get(), system.definition.c_str()) == OGRERR_NONE &&
           gdal_.OSRIsSame(given, wanted.get()) != 0;
  }

  Result<std::unique_ptr<PlaneToRaster>> from_plane(const std::string& crs) override {
    const GdalErrors errors(gdal_);
    const Crs plane = own(gdal_.OSRNewSpatialReference(nullptr));
    if (gdal_.OSRSetFromUserInput(plane.get(), crs.c_str()) != OGRERR_NONE)
      return fail(ExitCode::kUnreadableInput, "the coordinate system " + in_quotes(crs) +
                                                  " is not understood: " + errors.first());
    OGRSpatialReferenceH given = gdal_.GDALGetSpatialRef(dataset_.get());
    const Crs raster =
        own(given != nullptr ? gdal_.OSRClone(given) : gdal_.OSRNewSpatialReference(nullptr));
    if (given == nullptr) gdal_.OSRSetFromUserInput(raster.get(), "EPSG:4326");
    void* transform = gdal_.GDALCreateReprojectionTransformerEx(raster.get(), plane.get(), nullptr);
    if (transform == nullptr)
      return unreadable(shape_.name, "no way from " + in_quotes(crs) +
                                         " to its coordinate system: " + errors.first());
    return std::make_unique<ReprojectedPlane>(gdal_, transform);
  }

 private:
  // Longitude comes before latitude.
  Crs own(OGRSpatialReferenceH handle) const {
    gdal_.OSRSetAxisMappingStrategy(handle, OAMS_TRADITIONAL_GIS_ORDER);
    return Crs(handle, gdal_.OSRDestroySpatialReference);
  }

  // Pixel (column, row) of the file is at (t[0] + column * t[1] + row * t[2],
  // t[3] + column * t[4] + row * t[5]).
  Result<void> locate() {
    double t[6] = {};
    if (gdal_.GDALGetGeoTransform(dataset_.get(), t) != CE_None)
      return unreadable(shape_.name,
                        "has no place in the plane: no geotransform; gdalwarp gives it one");
    std::string text;
    for (const double number : t) text += (text.empty() ? "" : ", ") + shortest(number);
    const double columns = gdal_.GDALGetRasterBandXSize(levels_[0]);
    const double rows = gdal_.GDALGetRasterBandYSize(levels_[0]);
    // A shear that moves no pixel by a hundredth of itself is a rounding error.
    if (!(std::abs(t[2]) * rows <= std::abs(t[1]) / 100 &&
          std::abs(t[4]) * columns <= std::abs(t[5]) / 100))
      return unreadable(shape_.name, "its geotransform, " + text +
                                         ", is rotated or sheared; gdalwarp makes it upright");
    mirrored_ = t[1] < 0;
    south_up_ = t[5] > 0;
    const double west = mirrored_ ? t[0] + columns * t[1] : t[0];
    const double south = south_up_ ? t[3] : t[3] + rows * t[5];
    for (GDALRasterBandH level : levels_) {
      RasterGrid grid;
      grid.columns = static_cast<std::uint32_t>(gdal_.GDALGetRasterBandXSize(level));
      grid.rows = static_cast<std::uint32_t>(gdal_.GDALGetRasterBandYSize(level));
      grid.dx = std::abs(t[1]) * columns / grid.columns;
      grid.dy = std::abs(t[5]) * rows / grid.rows;
      grid.x = west + grid.dx / 2;
      grid.y = south + grid.dy / 2;
      if (!(grid.dx > 0 && grid.dy > 0 && std::isfinite(grid.dx) && std::isfinite(grid.dy) &&
            std::isfinite(grid.x) && std::isfinite(grid.y)))
        return unreadable(shape_.name, "has no place in the plane: its geotransform is " + text);
      shape_.grids.push_back(grid);
    }
    return {};
  }

  Result<void> read_chunk(std::size_t index, const RasterPart& part, float* out,
                          std::size_t stride) {
    const GdalErrors errors(gdal_);
    const RasterGrid& grid = shape_.grids[index];
    GDALRasterBandH band = levels_[index];
    const int x =
        static_cast<int>(mirrored_ ? grid.columns - part.column - part.columns : part.column);
    const int y = static_cast<int>(south_up_ ? part.row : grid.rows - part.row - part.rows);
    const int columns = static_cast<int>(part.columns);
    const int rows = static_cast<int>(part.rows);
    values_.resize(std::size_t{part.columns} * part.rows);
    if (gdal_.GDALRasterIO(band, GF_Read, x, y, columns, rows, values_.data(), columns, rows,
                           GDT_Float64, 0, 0) != CE_None)
      return unreadable(shape_.name, errors.first());
    const bool masked = (gdal_.GDALGetMaskFlags(band) & GMF_ALL_VALID) == 0;
    if (masked) {
      mask_.resize(values_.size());
      if (gdal_.GDALRasterIO(gdal_.GDALGetMaskBand(band), GF_Read, x, y, columns, rows,
                             mask_.data(), columns, rows, GDT_Byte, 0, 0) != CE_None)
        return unreadable(shape_.name, errors.first());
    }
    for (std::size_t j = 0; j < part.rows; ++j)
      for (std::size_t i = 0; i < part.columns; ++i) {
        const std::size_t from = (south_up_ ? j : part.rows - 1 - j) * part.columns +
                                 (mirrored_ ? part.columns - 1 - i : i);
        out[j * stride + i] =
            masked && mask_[from] == 0 ? kNoData : field_value(values_[from] * scale_ + offset_);
      }
    return {};
  }

  const Gdal& gdal_;
  Dataset dataset_;
  std::vector<GDALRasterBandH> levels_;  // the band, then its overviews
  double scale_ = 1;
  double offset_ = 0;
  bool mirrored_ = false;  // the first column is the eastmost
  bool south_up_ = false;  // the first row is the southmost
  std::vector<double> values_;
  std::vector<unsigned char> mask_;
};

}  // namespace

Result<std::unique_ptr<RasterSource>> open_with_gdal(const std::filesystem::path& path,
                                                     const std::string& band) {
  const auto gdal = load_gdal();
  if (!gdal) return unreadable(path.string(), gdal.error().message);
  const GdalErrors quiet(**gdal);
  auto chosen = BandChoice(**gdal, path.string(), band).choose(path);
  if (!chosen) return tl::unexpected(chosen.error());
  auto source = std::make_unique<GdalSource>(
      **gdal, path.string() + (band.empty() ? "" : ":" + band), std::move(*chosen));
  if (auto done = source->describe(); !done) return tl::unexpected(done.error());
  return source;
}

}  // namespace weft::files
