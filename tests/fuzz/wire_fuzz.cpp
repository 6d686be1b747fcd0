// SPDX-License-Identifier: Apache-2.0
// The bytes of a request, on their way through the server: counted, parsed, checked, weighed, named
// and meshed. The first byte chooses whether the rest is a SubmitJobRequest as it stands, or the
// choices that make one, whose bytes may then be damaged. Asserts:
//   regions    as many regions are counted before the message is parsed as it then has
//   failure    a refusal has a sentence, and a status that clients can take
//   budget     an admitted job may use no more than the limits allow, and weighs no more
//   key        the key has 32 bytes, and is the same once more and for its canonical spelling
//   internal   the engine calls nothing that it was given an internal error
#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "server/jobs/mesh_key.h"
#include "server/limits.h"
#include "server/translate.h"
#include "server/weight.h"
#include "server/wire_scan.h"
#include "tests/fuzz/law.h"
#include "tests/fuzz/random_message.h"
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

std::string request_of(ByteSource& bytes) {
  const std::size_t mode = bytes.byte();
  if (mode % 4 == 0) return std::string(bytes.rest());
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

  const std::uint64_t counted = count_submitted_regions(buffer_of(whole, cut));
  if (auto failure = check_seed_count(counted, kLimits)) return refuse(*failure);
  v1::SubmitJobRequest submission;
  if (!submission.ParseFromString(whole)) return;
  shown = submission.ShortDebugString();
  const v1::GenerateMeshRequest& request = submission.mesh();
  const auto regions = static_cast<std::uint64_t>(request.domain().regions_size());
  must(counted == regions, "regions", std::to_string(counted));
  must(count_regions(buffer_of(request.SerializeAsString(), cut)) == regions, "regions", "alone");
  if (auto failure = check_shape(request)) return refuse(*failure);

  const std::string key = mesh_key(request);
  v1::GenerateMeshRequest again;
  must(again.ParseFromString(request.SerializeAsString()), "key", "no longer parses");
  again.DiscardUnknownFields();
  must(key.size() == 32 && key == mesh_key(again), "key", "another key");
  if (auto failure = check_limits(request, kLimits)) return refuse(*failure);

  const Budget budget = to_budget(request.budget(), kLimits);
  const double seconds = to_seconds(request.budget(), kLimits);
  must(budget.triangle_limit <= kLimits.max_triangles && budget.max_bytes <= kLimits.max_bytes &&
           seconds >= 0 && seconds <= kLimits.max_seconds,
       "budget", "beyond the limits");
  must(expected_bytes(request, kLimits) <= kLimits.max_bytes, "budget", "it weighs more");
  must(to_threads(request.threads(), 4) <= 4, "budget", "threads");

  ExecutionContext context(budget);
  CollectedMesh mesh;
  const auto summary = generate_mesh(to_engine(request), mesh, context);
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
