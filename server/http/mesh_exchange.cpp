// SPDX-License-Identifier: Apache-2.0
#include "server/http/mesh_exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include "files/base/text.h"
#include "files/formats/names.h"
#include "server/http/byte_range.h"
#include "server/http/form.h"
#include "server/http/formats.h"
#include "server/http/mesh_warnings.h"
#include "server/version.h"
#include "server/wire/request_key.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

// Files that are read with so much memory are read in some milliseconds, without asking for it.
constexpr std::uint64_t kBytesOfShortFile = std::uint64_t{4} << 20;
// Meshes that are written in some milliseconds.
constexpr std::uint64_t kShortMesh = 50'000;

// The name of a file, with its extension, from what may be any text.
std::string harmless_name(const std::string& text) {
  constexpr std::size_t kMax = 100;
  std::string name = std::filesystem::path(text).filename().string();
  if (name.size() > kMax) name.erase(kMax / 2, name.size() - kMax);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
  return name;
}

std::string hexadecimal(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) text += fmt::format("{:02x}", static_cast<unsigned char>(c));
  return text;
}

// The names that a stored request has.
files::Names names_of(const v1::Domain& domain) {
  files::NameReader names("the job");
  for (const v1::Name& name : domain.marker_names())
    names.add(files::NameKind::kMarker, name.id(), name.name());
  for (const v1::Name& name : domain.region_names())
    names.add(files::NameKind::kRegion, name.id(), name.name());
  return names.take();
}

// The wish, whose mesh can be written.
Outcome<MeshWish> read_wish(const Query& query, ParameterUses uses, MeshExchange::Purpose purpose,
                            std::string_view accept) {
  using Purpose = MeshExchange::Purpose;
  auto wish = server::read_wish(query, uses);
  if (!wish) return wish;
  const auto refuse = [](const std::string& detail, const char* field) {
    return tl::unexpected(
        Problem{.status = 400, .reason = "BAD_OPTION", .detail = detail, .field = field});
  };
  if (purpose == Purpose::kMesh || purpose == Purpose::kStored) {
    if (wish->to.empty()) wish->to = format_wanted(accept);
    if (wish->to.empty())
      return tl::unexpected(Problem{
          .status = 406,
          .reason = "UNKNOWN_FORMAT",
          .detail = "nothing of Accept is a format of meshes; the parameter `format` names one: " +
                    fmt::format("{}", fmt::join(written_formats(), ", "))});
    const files::DataPath mesh = std::filesystem::path("mesh" + wish->to);
    if (const auto writable = files::check_writable(mesh, wish->writing); !writable)
      return refuse(writable.error().message, "order");
    if (wish->stream && wish->to != kStreamed)
      return refuse(
          "no file of this format can be sent while the mesh is made: give format=geojson",
          "stream");
  }
  if ((purpose == Purpose::kJob || purpose == Purpose::kDomain) && wish->projection.wanted() &&
      !wish->projection.to_metres)
    return refuse("what comes back is kept without its projection, in metres: give to_metres, too",
                  "lonlat");
  return wish;
}

Problem too_many_files() {
  return {.status = 507,
          .reason = "STORE_FULL",
          .detail =
              "the server has no more room for files of meshes that are on their way to this "
              "client",
          .retry = true};
}

// Of a body that is a GenerateMeshRequest.
bool is_of_message(std::string_view content_type) {
  return content_type == "application/x-protobuf" || content_type == "application/protobuf";
}

grpc::ByteBuffer buffer_of(std::string bytes) {
  auto* const owned = new std::string(std::move(bytes));
  const grpc::Slice slice(
      owned->data(), owned->size(), [](void* text) { delete static_cast<std::string*>(text); },
      owned);
  return {&slice, 1};
}

struct Begun {
  SentDomain sent;
  std::shared_ptr<ArrivingMesh> mesh;
};

Outcome<Begun> begun(SentDomain sent, bool stream, const std::filesystem::path& folder,
                     std::stop_token stop) {
  auto mesh = ArrivingMesh::make(folder, stream ? &sent.domain.names : nullptr, std::move(stop));
  if (!mesh) return tl::unexpected(mesh.error());
  return Begun{std::move(sent), std::move(*mesh)};
}

}  // namespace

MeshExchange::MeshExchange(ExchangeParts& parts, Purpose purpose, ParameterUses uses, MeshWish wish,
                           Query query, Visit& visit, std::shared_ptr<Meshes::Place> place)
    : parts_(parts),
      purpose_(purpose),
      uses_(uses),
      wish_(std::move(wish)),
      query_(std::move(query)),
      client_(visit.client),
      metadata_(std::move(visit.metadata)),
      place_(std::move(place)),
      answers_to_(std::move(visit.answers_to)),
      accept_(view(visit.headers[http::field::accept])),
      range_(view(visit.headers[http::field::range])),
      if_range_(view(visit.headers[http::field::if_range])),
      content_type_(view(visit.headers[http::field::content_type])),
      held_(parts.context.budget, visit.client) {}

Outcome<std::shared_ptr<MeshExchange>> MeshExchange::open(ExchangeParts& parts, Purpose purpose,
                                                          ParameterUses uses, const Query& query,
                                                          const std::string& word, Visit& visit) {
  const bool is_message =
      purpose == Purpose::kMesh && is_of_message(view(visit.headers[http::field::content_type]));
  if (is_message) uses &= ~static_cast<ParameterUses>(ParameterUse::kDomain);
  auto wish = read_wish(query, uses, purpose, view(visit.headers[http::field::accept]));
  if (!wish) return tl::unexpected(wish.error());
  const std::string_view told = view(visit.headers[http::field::content_length]);
  std::uint64_t length = 0;
  std::from_chars(told.data(), told.data() + told.size(), length);
  auto place = parts.meshes.enter(visit.client);
  if (place == nullptr)
    return tl::unexpected(Problem{.status = 429,
                                  .reason = "QUEUE_FULL",
                                  .detail = "too many meshes are on their way over HTTP",
                                  .retry = true});
  std::shared_ptr<MeshExchange> exchange(
      new MeshExchange(parts, purpose, uses, std::move(*wish), query, visit, std::move(place)));
  (purpose == Purpose::kStored ? exchange->job_ : exchange->file_.name) =
      purpose == Purpose::kStored ? word : harmless_name(word);
  exchange->is_message_ = is_message;
  if (length > parts.context.most_request_bytes) return tl::unexpected(exchange->too_large());
  return exchange;
}

Problem MeshExchange::too_large() const {
  return {.status = 413,
          .reason = "LIMIT_EXCEEDED",
          .detail = fmt::format("the file has more than {} bytes, which this server takes",
                                parts_.context.most_request_bytes)};
}

template <class Task, class Then>
void MeshExchange::work(bool is_long, Task task, Then then) {
  Workers::run(place_->for_work(is_long), parts_.context.io, std::move(task),
               [self = shared_from_this(), then = std::move(then)](auto outcome) mutable {
                 if (self->answers_to_ == nullptr) return;
                 if (!outcome) return self->refuse(outcome.error());
                 then(*self, std::move(*outcome));
               });
}

bool MeshExchange::is_large() const {
  return mesh_->triangles() > kShortMesh;
}

// ---- the file ----

bool MeshExchange::take(std::string_view bytes) {
  const std::size_t most = parts_.context.most_request_bytes;
  const std::size_t size = file_.bytes.size() + bytes.size();
  if (size > most) return refuse(too_large()), false;
  if (size > file_.bytes.capacity()) {
    const std::size_t room = std::max(size, std::min(2 * file_.bytes.capacity(), most));
    if (!held_.hold(room)) return refuse(out_of_memory()), false;
    file_.bytes.reserve(room);
  }
  file_.bytes += bytes;
  return true;
}

void MeshExchange::body_late() {
  refuse({.status = 408,
          .reason = "DEADLINE_EXCEEDED",
          .detail = "the file did not arrive within --request-timeout"});
}

std::optional<Problem> MeshExchange::take_form() {
  const auto malformed = [](const std::string& why) {
    return Problem{.status = 400, .reason = "MALFORMED_REQUEST", .detail = why};
  };
  const std::string form = std::exchange(file_.bytes, {});
  const std::string content_type = std::exchange(content_type_, {});
  if (!held_.hold(held_.bytes() + form.size())) return out_of_memory();
  const auto parts = parts_of(content_type, form);
  if (!parts) return malformed(parts.error());
  bool has_domain = false;
  for (const FormPart& part : *parts) {
    if (!files::is_plain_text(part.name) || (!part.filename && !files::is_plain_text(part.body)))
      return malformed("a part of the form is neither a file nor UTF-8 without control characters");
    if (!part.filename) {
      query_.emplace_back(part.name, part.body);
    } else if (part.name != "domain") {
      file_.fields.push_back({part.name, harmless_name(*part.filename), std::string(part.body)});
    } else {
      if (std::exchange(has_domain, true)) return malformed("the form has two domains");
      file_.name = harmless_name(*part.filename);
      content_type_ = part.content_type;
      file_.bytes = part.body;
    }
  }
  if (!has_domain) return malformed("the form has no file whose name is `domain`");
  auto wish = read_wish(query_, uses_, purpose_, accept_);
  if (!wish) return wish.error();
  wish_ = std::move(*wish);
  return std::nullopt;
}

void MeshExchange::body_ended() {
  if (purpose_ == Purpose::kStored) return begin_fetch();
  if (is_message_) return take_request_in();
  if (is_form(content_type_))
    if (const auto problem = take_form()) return refuse(*problem);
  file_.extension =
      wish_.from.empty() ? format_read(file_.name, content_type_, file_.bytes) : wish_.from;
  if (file_.extension.empty())
    return refuse({.status = 415,
                   .reason = "UNKNOWN_FORMAT",
                   .detail = "the file looks like none of the formats that are read here; the "
                             "parameter `from` names one: " +
                             fmt::format("{}", fmt::join(read_formats(), ", "))});
  if (file_.name.empty())
    file_.name = "domain" + file_.extension;
  else
    stem_ = std::filesystem::path(file_.name).stem().string();
  const bool linted = purpose_ == Purpose::kLint || purpose_ == Purpose::kDomain;
  const std::uint64_t needed = linted ? bytes_to_lint(file_) : bytes_to_read(file_);
  std::shared_ptr<MemoryBudget::Reservation> memory;
  if (needed > kBytesOfShortFile) {
    auto reserved = parts_.memory.reserve(
        {.estimate = needed, .client = client_, .purpose = MemoryBudget::Purpose::kInput});
    if (!reserved) return refuse(out_of_memory());
    memory = std::make_shared<MemoryBudget::Reservation>(std::move(*reserved));
  }
  if (purpose_ == Purpose::kLint) return lint(std::move(memory));
  if (purpose_ == Purpose::kDomain) return convert(std::move(memory));
  work(
      memory != nullptr,
      [file = std::move(file_), wish = wish_, folder = parts_.folder, stop = stop_.get_token(),
       is_mesh = purpose_ == Purpose::kMesh, memory]() mutable -> Outcome<Begun> {
        const bool stream = wish.stream;
        auto sent = read_domain_file(std::move(file), std::move(wish), folder);
        if (!sent) return tl::unexpected(sent.error());
        if (!is_mesh) return Begun{std::move(*sent), nullptr};
        return begun(std::move(*sent), stream, folder, stop);
      },
      [](MeshExchange& self, Begun begun) {
        self.begin(std::move(begun.sent), std::move(begun.mesh));
      });
}

void MeshExchange::take_request_in() {
  work(
      false,
      [bytes = std::move(file_.bytes), wish = wish_, folder = parts_.folder,
       stop = stop_.get_token()]() mutable -> Outcome<Begun> {
        const bool stream = wish.stream;
        auto sent = take_request(std::move(bytes), std::move(wish));
        if (!sent) return tl::unexpected(sent.error());
        return begun(std::move(*sent), stream, folder, stop);
      },
      [](MeshExchange& self, Begun begun) {
        self.begin(std::move(begun.sent), std::move(begun.mesh));
      });
}

void MeshExchange::lint(std::shared_ptr<void> memory) {
  const bool is_long = memory != nullptr;
  work(
      is_long,
      [file = std::move(file_), wish = wish_, folder = parts_.folder,
       memory = std::move(memory)]() mutable {
        return lint_domain_file(std::move(file), std::move(wish), folder);
      },
      [](MeshExchange& self, const std::string& json) {
        self.answer({.head = make_page(http::status::ok, "application/json", json)});
      });
}

void MeshExchange::convert(std::shared_ptr<void> memory) {
  const bool is_long = memory != nullptr;
  work(
      is_long,
      [file = std::move(file_), wish = wish_, folder = parts_.folder,
       most = parts_.context.most_request_bytes, memory = std::move(memory)]() mutable {
        return convert_domain_file(std::move(file), std::move(wish), folder, most);
      },
      [](MeshExchange& self, NamelessFile json) {
        self.answer({.head = make_page(http::status::ok, "application/json", ""),
                     .file = std::move(json.file),
                     .file_bytes = json.bytes});
      });
}

// ---- the call ----

void MeshExchange::begin(SentDomain sent, std::shared_ptr<ArrivingMesh> mesh) {
  if (sent.request.size() > parts_.context.most_request_bytes) return refuse(too_large());
  if (!held_.hold(sent.request.size() + sent.bytes)) return refuse(out_of_memory());
  std::string request = std::move(sent.request);
  sent_ = std::make_shared<const SentDomain>(std::move(sent));
  mesh_ = std::move(mesh);
  if (purpose_ == Purpose::kJob) return begin_job(std::move(request));
  begin_stream("/weft.v1.MeshService/GenerateMesh", std::move(request));
}

void MeshExchange::begin_job(std::string mesh) {
  v1::SubmitJobRequest job;
  job.set_request_id(wish_.request_id);
  job.set_notify(wish_.notify);
  job.set_no_cache(wish_.request.no_cache());
  std::vector<UnaryCall> calls;
  calls.push_back({"/weft.v1.JobService/SubmitJob", with_part(1, mesh, job.SerializeAsString()),
                   std::make_unique<v1::SubmitJobResponse>()});
  submission_ = std::make_shared<CallExchange>(
      parts_, std::move(calls), metadata_, std::exchange(answers_to_, nullptr),
      CallWords{
          .dress =
              [sent = sent_](Response& head, const auto& message) {
                head.result(http::status::created);
                const auto& made = dynamic_cast<const v1::SubmitJobResponse&>(message);
                head.set(http::field::location, "/v1/jobs/" + made.job().id());
                warn(sent->warnings, head);
              },
          .explain = [sent = sent_, query = query_](
                         Problem problem) { return located(std::move(problem), *sent, query); }});
  submission_->body_ended();
}

void MeshExchange::begin_fetch() {
  work(
      false,
      [folder = parts_.folder, stop = stop_.get_token()] {
        return ArrivingMesh::make(folder, nullptr, stop);
      },
      [](MeshExchange& self, std::shared_ptr<ArrivingMesh> mesh) {
        v1::FetchMeshRequest request;
        request.set_id(self.job_);
        self.mesh_ = std::move(mesh);
        self.sent_ = std::make_shared<const SentDomain>();
        self.begin_stream("/weft.v1.JobService/FetchMesh", request.SerializeAsString());
      });
}

void MeshExchange::begin_stream(const char* method, std::string request) {
  auto pass = parts_.context.calls.enter();
  if (!pass) return refuse({.status = 503, .reason = "STOPPING", .retry = true});
  std::optional<std::chrono::system_clock::time_point> deadline;
  if (wish_.timeout)
    deadline = std::chrono::system_clock::now() +
               std::chrono::milliseconds(static_cast<std::int64_t>(*wish_.timeout * 1000));
  call_ = BridgeCall::start(parts_.context.stub, method, metadata_, deadline, parts_.context.io,
                            std::move(*pass),
                            std::shared_ptr<BridgeCall::Listener>(shared_from_this(), this));
  call_->read();
  call_->write(buffer_of(std::move(request)));
}

void MeshExchange::wrote(bool) {
  held_.hold(sent_->bytes);
  if (call_ != nullptr) call_->end_writing();
}

void MeshExchange::received(grpc::ByteBuffer message) {
  work(
      is_large(),
      [mesh = mesh_, sent = sent_, message = std::move(message)] {
        return mesh->take(message, *sent);
      },
      [](MeshExchange& self, std::optional<v1::Summary> summary) {
        if (!self.place_->hold(self.mesh_->bytes())) return self.refuse(too_many_files());
        if (summary) self.summary_ = std::move(summary);
        if (self.mesh_->streams()) self.send_on(self.mesh_->so_far());
        if (self.call_ != nullptr) self.call_->read();
      });
}

void MeshExchange::ended(const grpc::Status& status, const Metadata&) {
  call_.reset();
  if (!status.ok()) return refuse(located(problem_of(status), *sent_, query_));
  if (!summary_)
    return refuse({.status = 500, .reason = "INTERNAL", .detail = "the mesh has no summary"});
  if (purpose_ == Purpose::kStored) {
    SentDomain kept{.writing = wish_.writing};
    kept.domain.names = names_of(summary_->request().domain());
    kept.writing.periodic = wire::periodic_sides(summary_->request().quality());
    summary_->clear_request();
    if (const auto found = find_open_boundaries(kept.writing, kept.domain.names.markers); !found)
      return refuse({.status = 400,
                     .reason = "BAD_OPTION",
                     .detail = found.error().message,
                     .field = "open_boundary"});
    sent_ = std::make_shared<const SentDomain>(std::move(kept));
  }
  write_file();
}

void MeshExchange::write_file() {
  work(
      is_large(), [mesh = mesh_, sent = sent_, to = wish_.to] { return mesh->write(*sent, to); },
      [](MeshExchange& self, MeshFile file) { self.answer_mesh(std::move(file)); });
}

void MeshExchange::cut(Answer& answer) const {
  // A file is made anew for each request, of the same mesh in the same way.
  std::string made_of = summary_->sha256() + std::string(kVersion) + wish_.to;
  for (const auto& [name, text] : query_) made_of += '&' + name + '=' + text;
  const std::string tag = '"' + hexadecimal(sha256(made_of)) + '"';
  answer.head.set(http::field::accept_ranges, "bytes");
  answer.head.set(http::field::etag, tag);
  if (range_.empty() || (!if_range_.empty() && if_range_ != tag)) return;
  const std::uint64_t size = answer.file_bytes;
  const auto range = range_of(range_, size);
  if (!range) {
    answer.file.reset();
    answer.head.result(http::status::range_not_satisfiable);
    answer.head.set(http::field::content_range, fmt::format("bytes */{}", size));
  } else if (range->bytes < size) {
    answer.file_first = range->first;
    answer.file_bytes = range->bytes;
    answer.head.result(http::status::partial_content);
    answer.head.set(http::field::content_range, fmt::format("bytes {}-{}/{}", range->first,
                                                            range->first + range->bytes - 1, size));
  }
}

Response MeshExchange::head() const {
  Response head = make_page(http::status::ok, media_type(wish_.to), "");
  head.set(http::field::content_disposition,
           fmt::format("attachment; filename=\"{}{}\"", stem_, wish_.to));
  head.set(http::field::cache_control, "no-store");
  return head;
}

void MeshExchange::send_on(MeshFile so_far) {
  const std::uint64_t more = so_far.bytes - std::exchange(sent_bytes_, so_far.bytes);
  if (more == 0) return;
  if (more < so_far.bytes) return answers_to_->grow(more);
  Answer answer{.head = head(),
                .file = std::move(so_far.file),
                .file_bytes = more,
                .grows = true,
                .place = place_};
  answer.head.set(http::field::trailer, "Weft-Vertices, Weft-Triangles, Weft-Sha256, Weft-Warning");
  answers_to_->answer(std::move(answer));
}

void MeshExchange::describe(std::vector<std::string> warnings, http::fields& head) const {
  head.set("Weft-Vertices", std::to_string(summary_->vertices()));
  head.set("Weft-Triangles", std::to_string(summary_->triangles()));
  head.set("Weft-Sha256", hexadecimal(summary_->sha256()));
  warnings.insert(warnings.begin(), sent_->warnings.begin(), sent_->warnings.end());
  add_warnings(*summary_, *sent_, wish_.request.budget().max_triangles(), warnings);
  warn(std::move(warnings), head);
}

void MeshExchange::answer_mesh(MeshFile file) {
  if (mesh_->streams()) {
    send_on(std::move(file));
    http::fields trailers;
    describe({}, trailers);
    std::exchange(answers_to_, nullptr)->end(trailers);
    return;
  }
  if (!place_->hold(mesh_->bytes() + file.bytes)) return refuse(too_many_files());
  place_->hold(file.bytes);
  Answer answer{.head = head(), .file = std::move(file.file), .file_bytes = file.bytes};
  describe(std::move(file.warnings), answer.head);
  if (purpose_ == Purpose::kStored) cut(answer);
  this->answer(std::move(answer));
}

// ---- the end ----

void MeshExchange::answer(Answer answer) {
  answer.head.set(http::field::cache_control, "no-store");
  answer.place = place_;
  if (const auto client = std::exchange(answers_to_, nullptr)) client->answer(std::move(answer));
}

void MeshExchange::refuse(const Problem& problem) {
  stop_.request_stop();
  if (sent_ == nullptr) parts_.refusals.note(client_, problem);
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
  const auto client = std::exchange(answers_to_, nullptr);
  if (client == nullptr) return;
  sent_bytes_ > 0 ? client->end(std::nullopt) : client->answer({.head = problem_page(problem)});
}

void MeshExchange::drop() {
  answers_to_ = nullptr;
  if (submission_ != nullptr) submission_->drop();
  stop_.request_stop();
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
}

}  // namespace weft::server
