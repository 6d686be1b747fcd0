// SPDX-License-Identifier: Apache-2.0
#include "server/http/domain_file.h"

#include <google/protobuf/io/coded_stream.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <protozero/pbf_reader.hpp>
#include <utility>

#include "files/formats/domain_formats.h"
#include "files/formats/domains/zipped_shapefile.h"
#include "files/formats/field_raster.h"
#include "files/lint/lint_json.h"
#include "files/message/domain_message.h"
#include "server/console/frames.h"

namespace weft::server {
namespace {

// In degrees and in metres.
constexpr std::uint64_t kBytesOfProjectedPoint = 2 * sizeof(files::Point);
// A value takes two bytes of a file at least, and is there as a double, and twice as a float.
constexpr std::uint64_t kBytesPerGridByte = 12;

Problem no_room() {
  return {.status = 507, .reason = "STORE_FULL", .detail = "the server has no room for the file"};
}

// A file that is open as long as this is.
struct Opened {
  files::FileDescriptor file;
  std::filesystem::path path;
  FileTexts texts;
};

Outcome<Opened> open_file(std::string bytes, const std::string& name,
                          const std::filesystem::path& folder) {
  auto nameless = files::open_unlinked(folder);
  if (!nameless || !files::write_all(nameless->get(), bytes.data(), bytes.size()))
    return tl::unexpected(no_room());
  Opened opened{.file = std::move(*nameless)};
  opened.path = "/proc/self/fd/" + std::to_string(opened.file.get());
  opened.texts = FileTexts(opened.path.string(), name);
  return opened;
}

struct OpenedDomain {
  files::FileDescriptor file;
  files::DataPath path;
  FileTexts texts;
  files::Domain domain{};
};

Outcome<OpenedDomain> open_domain(DomainFile& file, const MeshWish& wish,
                                  const std::filesystem::path& folder) {
  auto found = open_file(std::exchange(file.bytes, {}), file.name, folder);
  if (!found) return tl::unexpected(found.error());
  OpenedDomain opened{std::move(found->file), std::move(found->path), std::move(found->texts)};
  opened.path.format = file.extension;
  auto domain = files::read_own_domain(
      opened.path,
      {.lonlat = wish.projection.wanted(), .even_odd = wish.fill == files::PolygonFill::kEvenOdd});
  if (!domain) return tl::unexpected(opened.texts.problem(domain.error()));
  if (const auto named = files::set_names(wish.names, domain->names); !named)
    return tl::unexpected(Problem{
        .status = 400, .reason = "BAD_OPTION", .detail = named.error().message, .field = "names"});
  opened.domain = std::move(*domain);
  return opened;
}

files::RasterBox box_of(const files::Domain& domain) {
  files::RasterBox box;
  for (const files::Point& p : domain.points) {
    if (&p == domain.points.data()) box = {p.x, p.y, p.x, p.y};
    box = {std::min(box.min_x, p.x), std::min(box.min_y, p.y), std::max(box.max_x, p.x),
           std::max(box.max_y, p.y)};
  }
  return box;
}

// Adds the fields to the size, and what there is to say of them to the warnings. The grids of a
// domain in longitude and latitude are so, too.
std::optional<Problem> add_fields(std::vector<FieldFile> fields, const files::Domain& domain,
                                  const files::DomainProjection* projection,
                                  const std::filesystem::path& folder, v1::SizeField& size,
                                  std::vector<std::string>& warnings) {
  std::function<files::Point(files::Point)> to_degrees;
  if (projection != nullptr)
    to_degrees = [projection](files::Point p) { return projection->to_lonlat(p); };
  const std::uint64_t most = files::kMaxFieldValues / std::max<std::size_t>(1, fields.size());
  for (FieldFile& field : fields) {
    const auto opened = open_file(std::move(field.bytes), field.name, folder);
    if (!opened) return opened.error();
    auto read = files::read_ascii_field(opened->path, box_of(domain), to_degrees, most);
    if (!read) return opened->texts.problem(read.error());
    v1::NamedField& named = *size.add_fields();
    named.set_name(field.field);
    wire::fill(*read, named);
    for (const std::string& warning : read->warnings) warnings.push_back(opened->texts(warning));
  }
  return std::nullopt;
}

// Null if no projection is wanted.
Outcome<std::shared_ptr<const files::DomainProjection>> project(OpenedDomain& opened,
                                                                const MeshWish& wish) {
  auto projection = files::DomainProjection::project_file(
      opened.path, opened.domain, wish.projection, wish.request.domain().snap());
  if (projection) return std::move(*projection);
  Problem problem = opened.texts.problem(projection.error());
  if (projection.error().exit == files::ExitCode::kUsage) {
    problem.reason = "BAD_OPTION";
    problem.field = "crs";
  }
  return tl::unexpected(std::move(problem));
}

// Fills its polygons, too.
Outcome<files::Lint> find_faults(OpenedDomain& opened, const MeshWish& wish) {
  files::Domain& domain = opened.domain;
  if (!wish.projection.wanted())
    files::warn_of_degrees(opened.path, domain);
  else if (const auto ok = files::check_lonlat(opened.path, domain); !ok)
    return tl::unexpected(opened.texts.problem(ok.error()));
  files::fill_polygons(domain, wish.fill);
  auto lint = files::lint_domain(
      domain, opened.path,
      {.snap = wish.request.domain().snap(), .lonlat = wish.projection.wanted()});
  if (!lint) return tl::unexpected(opened.texts.problem(lint.error()));
  return std::move(*lint);
}

std::string json_of(const files::Lint& lint, const FileTexts& texts) {
  using Json = nlohmann::ordered_json;
  return texts(files::lint_json(lint).dump(-1, ' ', true, Json::error_handler_t::replace));
}

// Padded. A block is coded at a time.
bool write_base64(int file, std::string_view bytes, std::uint64_t& written) {
  constexpr std::size_t kBlock = std::size_t{48} << 10;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(kBlock, bytes.size()))) {
    std::string text = to_base64(bytes.substr(0, kBlock));
    text.resize((text.size() + 3) / 4 * 4, '=');
    if (!files::write_all(file, text.data(), text.size())) return false;
    written += text.size();
  }
  return true;
}

}  // namespace

std::string FileTexts::operator()(std::string text) const {
  const auto replace = [&text](std::string_view from, std::string_view to) {
    if (from.empty()) return;
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace(path_, name_);
  replace("--snap ", "snap=");  // a remedy
  replace(" --", " ");
  return text;
}

Problem FileTexts::problem(const files::Error& error) const {
  Problem problem{.status = 400, .reason = "UNREADABLE_FILE", .detail = (*this)(error.message)};
  // "coast.geojson:3:14: expected a number"
  if (problem.detail.starts_with(name_))
    problem.place = problem.detail.substr(0, problem.detail.find(": "));
  if (error.exit == files::ExitCode::kUnwritableOutput) {
    problem.status = 507;
    problem.reason = "STORE_FULL";
  } else if (error.exit == files::ExitCode::kInternal) {
    problem.status = 501;
    problem.reason = "UNIMPLEMENTED";
  }
  return problem;
}

std::string with_part(unsigned field, const std::string& message, const std::string& rest) {
  using google::protobuf::io::CodedOutputStream;
  std::uint8_t length[10];
  const auto* const end = CodedOutputStream::WriteVarint64ToArray(message.size(), length);
  std::string whole(1, static_cast<char>(field << 3 | 2));
  whole.reserve(message.size() + rest.size() + 16);
  whole.append(reinterpret_cast<const char*>(length), static_cast<std::size_t>(end - length));
  return whole.append(message).append(rest);
}

Outcome<SentDomain> read_domain_file(DomainFile file, MeshWish wish,
                                     const std::filesystem::path& folder) {
  auto opened = open_domain(file, wish, folder);
  if (!opened) return tl::unexpected(opened.error());
  files::Domain& domain = opened->domain;
  const FileTexts& texts = opened->texts;
  files::fill_polygons(domain, wish.fill);
  if (auto problem = complete(domain.names.markers, wish)) return tl::unexpected(*problem);
  auto projection = project(*opened, wish);
  if (!projection) return tl::unexpected(projection.error());

  SentDomain sent{.projection = std::move(*projection), .writing = std::move(wish.writing)};
  for (const std::string& warning : files::sentences(domain.warnings))
    sent.warnings.push_back(texts(warning));
  if (sent.projection != nullptr)
    for (const std::string& warning : sent.projection->warnings())
      sent.warnings.push_back(texts(warning));
  if (!file.fields.empty())
    if (auto problem = add_fields(std::move(file.fields), domain, sent.projection.get(), folder,
                                  *wish.request.mutable_size(), sent.warnings))
      return tl::unexpected(*problem);
  const std::string part =
      files::domain_message(domain) + wish.request.domain().SerializeAsString();  // its `snap`
  wish.request.clear_domain();
  sent.request = with_part(v1::GenerateMeshRequest::kDomainFieldNumber, part,
                           wish.request.SerializeAsString());
  sent.bytes = (sent.projection == nullptr ? 0 : domain.points.size() * kBytesOfProjectedPoint) +
               domain.point_markers.size() * sizeof(std::int32_t);
  for (const files::Provenance* const places :
       {&domain.point_places, &domain.segment_places, &domain.hole_places, &domain.region_places,
        &domain.area_places})
    sent.bytes += places->bytes();
  sent.domain = std::move(domain);
  sent.domain.points = {};
  sent.domain.segments = {};
  sent.domain.arcs = {};
  sent.texts = texts;
  return sent;
}

Outcome<std::string> lint_domain_file(DomainFile file, MeshWish wish,
                                      const std::filesystem::path& folder) {
  auto opened = open_domain(file, wish, folder);
  if (!opened) return tl::unexpected(opened.error());
  const auto lint = find_faults(*opened, wish);
  if (!lint) return tl::unexpected(lint.error());
  return json_of(*lint, opened->texts) + "\n";
}

Outcome<NamelessFile> convert_domain_file(DomainFile file, MeshWish wish,
                                          const std::filesystem::path& folder,
                                          std::uint64_t most_bytes) {
  auto opened = open_domain(file, wish, folder);
  if (!opened) return tl::unexpected(opened.error());
  auto lint = find_faults(*opened, wish);
  if (!lint) return tl::unexpected(lint.error());
  const auto projection = project(*opened, wish);
  if (!projection) return tl::unexpected(projection.error());
  if (*projection != nullptr)
    for (std::string& warning : (*projection)->warnings())
      files::add_warning(*lint, std::move(warning));
  const std::string message = files::domain_message(opened->domain);
  opened->domain = {};
  if (message.size() > most_bytes)
    return tl::unexpected(Problem{.status = 413,
                                  .reason = "LIMIT_EXCEEDED",
                                  .detail = "the domain is larger than a request may be, " +
                                            std::to_string(most_bytes) + " bytes"});
  std::string head = json_of(*lint, opened->texts);
  head.replace(head.size() - 1, 1, ",\"domain\":\"");
  constexpr std::string_view kEnd = "\"}\n";
  auto made = files::open_unlinked(folder);
  NamelessFile answer{.bytes = head.size() + kEnd.size()};
  if (!made || !files::write_all(made->get(), head.data(), head.size()) ||
      !write_base64(made->get(), message, answer.bytes) ||
      !files::write_all(made->get(), kEnd.data(), kEnd.size()))
    return tl::unexpected(no_room());
  answer.file = std::move(*made);
  return answer;
}

Outcome<SentDomain> take_request(std::string request, MeshWish wish) try {
  files::NameReader names("the request");
  protozero::pbf_reader message(request);
  constexpr auto kMessage = protozero::pbf_wire_type::length_delimited;
  while (message.next()) {
    if (message.tag() == v1::GenerateMeshRequest::kSamplePointsFieldNumber)
      return tl::unexpected(Problem{.status = 400,
                                    .reason = "BAD_OPTION",
                                    .detail = "sample_points ask for a size, and make no mesh"});
    if (message.tag() != v1::GenerateMeshRequest::kDomainFieldNumber ||
        message.wire_type() != kMessage) {
      message.skip();
      continue;
    }
    protozero::pbf_reader domain = message.get_message();
    while (domain.next()) {
      const bool of_marker = domain.tag() == v1::Domain::kMarkerNamesFieldNumber;
      const bool is_name = of_marker || domain.tag() == v1::Domain::kRegionNamesFieldNumber;
      if (!is_name || domain.wire_type() != kMessage) {
        domain.skip();
        continue;
      }
      v1::Name name;
      const auto bytes = domain.get_view();
      if (!name.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        throw protozero::exception();
      names.add(of_marker ? files::NameKind::kMarker : files::NameKind::kRegion, name.id(),
                name.name());
    }
  }
  SentDomain sent;
  sent.domain.names = names.take();
  if (auto problem = complete(sent.domain.names.markers, wish)) return tl::unexpected(*problem);
  sent.writing = std::move(wish.writing);
  sent.request = std::move(request);
  return sent;
} catch (const protozero::exception&) {
  return tl::unexpected(Problem{.status = 400,
                                .reason = "MALFORMED_REQUEST",
                                .detail = "the body is not a weft.v1.GenerateMeshRequest"});
}

namespace {

// Unpacked.
std::uint64_t size_of(const DomainFile& file) {
  const std::uint64_t size = file.bytes.size();
  return file.extension == ".zip" ? size + files::zipped_shapefile_bytes(file.bytes) : size;
}

}  // namespace

// Measured, of files that hold nothing but what takes most of their format. Rings with arcs are
// judged by chords, up to 10,000 arcs at a time; blocks of drawings are placed up to 5,000,000
// times.
std::uint64_t bytes_to_read(const DomainFile& file) {
  const std::uint64_t size = size_of(file);
  std::uint64_t grids = 0;
  for (const FieldFile& field : file.fields) grids += kBytesPerGridByte * field.bytes.size();
  const auto chords = [size](std::uint64_t most) { return std::min(1500 * size, most << 20); };
  if (file.extension == ".zip") return grids + 25 * size;
  if (file.extension == ".geojson" || file.extension == ".json" || file.extension == ".poly")
    return grids + 40 * size;
  if (file.extension == ".dxf")
    return grids + (std::uint64_t{128} << 20) + 512 * size + chords(256);
  return grids + 48 * size + chords(128);
}

// Arcs are judged by chords, all at once.
std::uint64_t bytes_to_lint(const DomainFile& file) {
  const bool has_arcs =
      file.extension != ".geojson" && file.extension != ".json" && file.extension != ".zip";
  return bytes_to_read(file) + (has_arcs ? 3000 : 100) * size_of(file);
}

Problem located(Problem problem, const SentDomain& sent, const Query& query) {
  if (problem.field.empty()) return problem;
  problem.place = sent.texts(files::locate_field(problem.field, sent.domain));
  if (std::string parameter = parameter_of(problem.field, query); !parameter.empty())
    problem.field = std::move(parameter);
  return problem;
}

}  // namespace weft::server
