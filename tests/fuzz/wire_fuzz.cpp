// SPDX-License-Identifier: Apache-2.0
// The bytes of a request, on their way through the server's own admission: scanned, freed of
// unknown fields, parsed, checked, weighed, named and meshed. A byte chooses whether the rest is a
// SubmitJobRequest as it stands, or the choices that make one, whose bytes may then be damaged, or
// those of bytes that are nearly one (strange_wire.h). Asserts:
//   malformed  what protobuf parses is not called malformed
//   counts     as much is counted before the message is parsed as it then has, or more
//   unknown    what is left without unknown fields is the same message without them, and no longer
//   admission  a request is admitted if it parses and passes the checks, as the message that it is
//   failure    a refusal has a sentence, and a status that clients can take
//   budget     an admitted job may use no more than the limits allow, and weighs no more
//   key        the key has 32 bytes, and is the same once more and for its canonical spelling
//   internal   the engine calls nothing that it was given an internal error
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/run/memory_estimate.h"
#include "server/wire/limits.h"
#include "server/wire/request_key.h"
#include "server/wire/request_reader.h"
#include "server/wire/translate.h"
#include "server/wire/wire_scan.h"
#include "tests/fuzz/law.h"
#include "tests/fuzz/random_message.h"
#include "tests/fuzz/strange_wire.h"
#include "tests/support/collected_mesh.h"
#include "weft/v1/job_service.pb.h"

namespace weft::fuzz {
namespace {

using namespace server;

// Small, so that inputs of a few hundred bytes reach them.
constexpr Limits kLimits{.max_points = 60,
                         .max_segments = 60,
                         .max_seeds = 12,
                         .max_expression_bytes = 30,
                         .max_raster_values = 50,
                         .max_triangles = 500,
                         .max_bytes = std::uint64_t{64} << 20,
                         .max_seconds = 20,
                         .max_request_bytes = 1 << 20};

// In two slices, as a message may come.
grpc::ByteBuffer buffer_of(const std::string& bytes, std::size_t cut) {
  cut = bytes.empty() ? 0 : cut % bytes.size();
  const grpc::Slice slices[] = {grpc::Slice(bytes.data(), cut),
                                grpc::Slice(bytes.data() + cut, bytes.size() - cut)};
  return {slices, 2};
}

std::string text_of(const grpc::ByteBuffer& buffer) {
  grpc::Slice slice;
  if (!buffer.DumpToSingleSlice(&slice).ok()) return "";
  return {reinterpret_cast<const char*>(slice.begin()), slice.size()};
}

// At any depth.
bool has_unknown_fields(const google::protobuf::Message& message) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  if (!reflection.GetUnknownFields(message).empty()) return true;
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* field : fields) {
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      if (has_unknown_fields(reflection.GetMessage(message, field))) return true;
      continue;
    }
    for (int i = 0; i < reflection.FieldSize(message, field); ++i)
      if (has_unknown_fields(reflection.GetRepeatedMessage(message, field, i))) return true;
  }
  return false;
}

std::string request_of(ByteSource& bytes) {
  const std::size_t mode = bytes.byte();
  if (mode % 4 == 0) return std::string(bytes.rest());
  if (mode % 4 == 2) return strange_wire(*v1::SubmitJobRequest::descriptor(), bytes);
  std::string damage(mode % 4 == 3 ? bytes.take(8) : std::string_view());
  v1::SubmitJobRequest request;
  fill(request, bytes);
  std::string whole = request.SerializePartialAsString();
  for (std::size_t i = 0; i + 1 < damage.size() && !whole.empty(); i += 2)
    whole[static_cast<std::uint8_t>(damage[i]) * 7 % whole.size()] = damage[i + 1];
  return whole;
}

void judge(const std::uint8_t* data, std::size_t size) {
  ByteSource bytes(data, size);
  const std::size_t cut = bytes.byte();
  const std::string whole = request_of(bytes);
  std::string shown;  // once it is parsed
  const auto must = [&](bool holds, std::string_view law, const std::string& evidence) {
    if (!holds) broken(law, evidence + "\n" + shown, data, size);
  };
  const auto refuse = [&](const Failure& failure) {
    const grpc::Status status = to_status(failure, "");
    must(!failure.message.empty() && !status.ok() && status.error_details().size() < 8192,
         "failure", failure.message);
  };

  const auto& type = *v1::SubmitJobRequest::descriptor();
  const grpc::ByteBuffer buffer = buffer_of(whole, cut);
  const WireScan scan = scan_wire(buffer, type);
  v1::SubmitJobRequest submission;
  const bool parses = submission.ParseFromString(whole);
  if (parses) shown = submission.ShortDebugString();
  must(!(parses && scan.malformed), "malformed", "it parses");
  if (!scan.malformed) {
    const grpc::ByteBuffer known = without_unknown_fields(buffer, type);
    must(known.Length() <= whole.size(), "unknown", "longer than before");
    must(scan_wire(known, type).unknown_fields == 0, "unknown", "some are left");
    v1::SubmitJobRequest of_known;
    must(of_known.ParseFromString(text_of(known)) || !parses, "unknown", "no longer parses");
    // Not the other way: what a later member of a oneof replaces is scanned, and not kept.
    must(!parses || scan.unknown_fields != 0 || !has_unknown_fields(submission), "unknown",
         "one was missed");
    submission.DiscardUnknownFields();
    must(!parses || of_known.SerializeAsString() == submission.SerializeAsString(), "unknown",
         "another message");
  }
  const auto read = read_submission(buffer, kLimits);
  if (!read) refuse(read.error());
  // What protobuf alone refuses is forgiven where it is taken out, such as groups too deep.
  if (!parses) return must(!read || scan.unknown_fields != 0, "admission", "it does not parse");
  const v1::GenerateMeshRequest& request = submission.mesh();
  const v1::Domain& domain = request.domain();
  const auto counted = [&](int field) { return scan.count(*v1::Domain::descriptor(), field); };
  const auto held = [](int elements) { return static_cast<std::uint64_t>(elements); };
  must(counted(v1::Domain::kRegionsFieldNumber) == held(domain.regions_size()) &&
           counted(v1::Domain::kPointsFieldNumber) == held(domain.points_size()) &&
           counted(v1::Domain::kSegmentsFieldNumber) == held(domain.segments_size()) &&
           counted(v1::Domain::kSegmentMarkersFieldNumber) == held(domain.segment_markers_size()) &&
           counted(v1::Domain::kHolesFieldNumber) == held(domain.holes_size()) &&
           scan.count(*v1::Raster::descriptor(), v1::Raster::kValuesFieldNumber) >=
               held(request.size().raster().values_size()),
       "counts", std::to_string(counted(v1::Domain::kRegionsFieldNumber)));
  if (!read) return;
  must(read->SerializeAsString() == submission.SerializeAsString(), "admission", "another message");
  const auto converted = admissible(request, kLimits);
  if (!converted) return refuse(converted.error());
  must(!check_limits(request, kLimits), "admission", "it passes no check");

  const std::string key = mesh_key(request);
  v1::GenerateMeshRequest again;
  must(again.ParseFromString(request.SerializeAsString()), "key", "no longer parses");
  again.DiscardUnknownFields();
  must(key.size() == 32 && key == mesh_key(again), "key", "another key");

  const Budget budget = to_budget(request.budget(), kLimits);
  const double seconds = to_seconds(request.budget(), kLimits);
  must(budget.triangle_limit <= kLimits.max_triangles && budget.max_bytes <= kLimits.max_bytes &&
           seconds >= 0 && seconds <= kLimits.max_seconds,
       "budget", "beyond the limits");
  must(estimate(*converted, budget).bytes <= kLimits.max_bytes, "budget", "it weighs more");
  must(to_threads(request.threads(), 4) <= 4, "budget", "threads");

  weft::Run run(budget);
  CollectedMesh mesh;
  const auto summary = stream(*converted, mesh, run);
  if (!summary) {
    must(summary.error().code != ErrorCode::kInternal, "internal", summary.error().message);
    return refuse(failure_of(summary.error()));
  }
  v1::Summary told = to_wire(*summary, 1);
  add_quadtree(*summary, told);
  must(!told.SerializeAsString().empty(), "summary", "empty");
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto silent = google::protobuf::SetLogHandler(nullptr);  // of strings, no UTF-8
  (void)silent;
  weft::fuzz::judge(data, size);
  return 0;
}
