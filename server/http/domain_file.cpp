// SPDX-License-Identifier: Apache-2.0
#include "server/http/domain_file.h"

#include <google/protobuf/io/coded_stream.h>

#include <algorithm>
#include <utility>

#include "files/formats/domain_formats.h"
#include "files/message/domain_message.h"

namespace weft::server {
namespace {

// In degrees and in metres.
constexpr std::uint64_t kBytesOfProjectedPoint = 2 * sizeof(files::Point);

// The bytes of `options` with the domain, without a message of its own for it.
std::string request_of(const files::Domain& domain, v1::GenerateMeshRequest& options) {
  using google::protobuf::io::CodedOutputStream;
  constexpr char kDomain = 1 << 3 | 2;  // the tag of GenerateMeshRequest.domain
  const std::string more = options.domain().SerializeAsString();  // such as `snap`
  options.clear_domain();
  const std::string message = files::domain_message(domain);
  std::uint8_t length[10];
  const auto* const end =
      CodedOutputStream::WriteVarint64ToArray(message.size() + more.size(), length);
  std::string request(1, kDomain);
  request.reserve(message.size() + more.size() + options.ByteSizeLong() + 16);
  request.append(reinterpret_cast<const char*>(length), static_cast<std::size_t>(end - length));
  request += message;
  request += more;
  options.AppendToString(&request);
  return request;
}

}  // namespace

std::string FileTexts::operator()(std::string text) const {
  const auto replace = [&text](std::string_view from, std::string_view to) {
    if (from.empty()) return;
    for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace(path_, name_);
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

Outcome<SentDomain> read_domain_file(DomainFile file, MeshWish wish,
                                     const std::filesystem::path& folder) {
  const auto open = files::open_unlinked(folder);
  if (!open) return tl::unexpected(FileTexts(folder.string(), "server").problem(open.error()));
  if (!files::write_all(open->get(), file.bytes.data(), file.bytes.size()))
    return tl::unexpected(Problem{
        .status = 507, .reason = "STORE_FULL", .detail = "the server has no room for the file"});
  file.bytes = {};
  files::DataPath path = std::filesystem::path("/proc/self/fd/" + std::to_string(open->get()));
  path.format = file.extension;
  const FileTexts texts(path.string(), file.name);
  auto domain = files::read_own_domain(
      path,
      {.lonlat = wish.projection.wanted(), .even_odd = wish.fill == files::PolygonFill::kEvenOdd});
  if (!domain) return tl::unexpected(texts.problem(domain.error()));
  if (const auto named = files::set_names(wish.names, domain->names); !named)
    return tl::unexpected(Problem{
        .status = 400, .reason = "BAD_OPTION", .detail = named.error().message, .field = "names"});
  files::fill_polygons(*domain, wish.fill);
  if (auto problem = complete(domain->names.markers, wish)) return tl::unexpected(*problem);
  auto projection = files::DomainProjection::project_file(path, *domain, wish.projection);
  if (!projection) return tl::unexpected(texts.problem(projection.error()));

  SentDomain sent{.projection = std::move(*projection), .writing = std::move(wish.writing)};
  for (const std::string& warning : files::sentences(domain->warnings))
    sent.warnings.push_back(texts(warning));
  if (sent.projection != nullptr)
    for (const std::string& warning : sent.projection->warnings())
      sent.warnings.push_back(texts(warning));
  sent.request = request_of(*domain, wish.request);
  sent.bytes = (sent.projection == nullptr ? 0 : domain->points.size() * kBytesOfProjectedPoint) +
               domain->point_markers.size() * sizeof(std::int32_t);
  for (const files::Provenance* const places :
       {&domain->point_places, &domain->segment_places, &domain->hole_places,
        &domain->region_places, &domain->area_places})
    sent.bytes += places->bytes();
  sent.domain = std::move(*domain);
  sent.domain.points = {};
  sent.domain.segments = {};
  sent.domain.arcs = {};
  sent.texts = texts;
  return sent;
}

// Measured, of files that hold nothing but what takes most of their format. Rings with arcs are
// judged by chords, up to 10,000 arcs at a time; blocks of drawings are placed up to 5,000,000
// times.
std::uint64_t bytes_to_read(const DomainFile& file) {
  const std::uint64_t size = file.bytes.size();
  const auto chords = [size](std::uint64_t most) { return std::min(1500 * size, most << 20); };
  if (file.extension == ".geojson" || file.extension == ".json" || file.extension == ".poly")
    return 40 * size;
  if (file.extension == ".dxf") return (std::uint64_t{128} << 20) + 512 * size + chords(256);
  return 48 * size + chords(128);
}

Problem located(Problem problem, const SentDomain& sent, const Query& query) {
  problem.detail = sent.texts(problem.detail);
  if (problem.field.empty()) return problem;
  problem.place = sent.texts(files::locate_field(problem.field, sent.domain));
  if (std::string parameter = parameter_of(problem.field, query); !parameter.empty())
    problem.field = std::move(parameter);
  return problem;
}

}  // namespace weft::server
