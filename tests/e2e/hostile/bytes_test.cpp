// SPDX-License-Identifier: Apache-2.0
// Bytes that no client of weft sends, for every method: each call is answered, and the server goes
// on.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/dynamic_message.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tests/e2e/fleet.h"
#include "tests/e2e/programs.h"
#include "tests/fuzz/random_message.h"
#include "tests/server/raw_call.h"

namespace weft::e2e {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::Message;
using google::protobuf::MethodDescriptor;
using server::testing::raw_stream;

constexpr std::size_t kMiB = std::size_t{1} << 20;

std::vector<const MethodDescriptor*> methods() {
  std::vector<const MethodDescriptor*> all;
  // Names that the linker cannot leave out.
  for (const auto* file :
       {v1::GenerateMeshRequest::descriptor()->file(), v1::SubmitJobRequest::descriptor()->file()})
    for (int s = 0; s < file->service_count(); ++s)
      for (int m = 0; m < file->service(s)->method_count(); ++m)
        all.push_back(file->service(s)->method(m));
  return all;
}

class Scribbler {
 public:
  explicit Scribbler(std::uint64_t seed) : random_(seed) {}

  std::string bytes(std::size_t at_most) {
    std::string bytes(below(at_most + 1), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random_());
    return bytes;
  }

  // A message of this type with some of its fields, all of them of the right types.
  std::string message(const Descriptor& type) {
    const std::unique_ptr<Message> message(factory_.GetPrototype(&type)->New());
    std::string choices(2000, '\0');
    for (char& byte : choices) byte = static_cast<char>(random_());
    fuzz::ByteSource source(reinterpret_cast<const std::uint8_t*>(choices.data()), choices.size());
    fuzz::fill(*message, source);
    return message->SerializeAsString();
  }

  // With a few bytes changed, and its end lost now and then.
  std::string damaged(std::string bytes) {
    if (bytes.empty()) return bytes;
    for (std::size_t i = 0; i <= below(4); ++i)
      bytes[below(bytes.size())] = static_cast<char>(random_());
    if (below(3) == 0) bytes.resize(below(bytes.size()));
    return bytes;
  }

 private:
  std::size_t below(std::size_t end) { return random_() % end; }

  std::mt19937_64 random_;
  google::protobuf::DynamicMessageFactory factory_;
};

// Bytes that parsers have failed on.
std::vector<std::string> malformed() {
  return {
      "",
      std::string(1, '\0'),                    // the tag 0
      std::string(11, '\xff'),                 // a varint without an end
      "\x0a\xff\xff\xff\xff\x07",              // a string of 2 GiB, of which nothing comes
      "\x0a\xff\xff\xff\xff\xff\xff\xff\x7f",  // of 2^63 bytes
      std::string(100'000, '\x0b'),            // groups in groups
      std::string(100'000, '\x0c'),            // ends of groups that never began
      "\x0a\x04\xc3\x28\xa0\xa1",              // no UTF-8
      "\x0f\x00",                              // a wire type that there is not
      std::string("\x0a\x03\x0a\x7f\x00", 5),  // an inner length beyond the outer
      std::string(50'000, '\x32') + "\x00",    // fields that nobody knows
  };
}

bool is_answer(const grpc::Status& status) {
  return status.error_code() != grpc::UNAVAILABLE && status.error_code() != grpc::UNKNOWN &&
         status.error_code() != grpc::DEADLINE_EXCEEDED;
}

class HostileBytes : public ::testing::TestWithParam<const MethodDescriptor*> {
 protected:
  static std::vector<std::string> arguments(const Folder& folder) {
    return {"--data",          folder / "data", "--max-request-bytes", "1MiB",
            "--max-triangles", "20000",         "--max-seconds",       "10"};
  }
};

TEST_P(HostileBytes, AreAnsweredAndHarmNobody) {
  const MethodDescriptor& method = *GetParam();
  const std::string path = "/" + method.service()->full_name() + "/" + method.name();
  const Folder folder;
  const Server server(arguments(folder));
  const auto channel = connect(server.address());
  const auto send = [&](const std::string& bytes) {
    const grpc::Status status = raw_stream(channel, path.c_str(), bytes);
    EXPECT_TRUE(is_answer(status)) << status.error_code() << " " << status.error_message();
    return status;
  };
  const std::uint64_t before = server.resident_bytes();
  for (const std::string& bytes : malformed()) send(bytes);
  Scribbler scribbler(7);
  for (int round = 0; round < few_or_many(60, 5000); ++round) {
    send(scribbler.bytes(200));
    const std::string message = scribbler.message(*method.input_type());
    send(message);
    send(scribbler.damaged(message));
  }
  EXPECT_EQ(send(std::string(kMiB + 1, '\x0a')).error_code(), grpc::RESOURCE_EXHAUSTED);
  if (kMemoryTells) {
    EXPECT_LT(server.resident_bytes(), before + 256 * kMiB);
  }

  Reference reference;
  const v1::GenerateMeshRequest good = mixed_request(2);
  grpc::ClientContext context;
  v1::GenerateMeshResponse message;
  const auto reader = v1::MeshService::NewStub(channel)->GenerateMesh(&context, good);
  EXPECT_EQ(digest_of_stream(*reader, message), reference.digest(good));
  EXPECT_TRUE(reader->Finish().ok());
}

INSTANTIATE_TEST_SUITE_P(On, HostileBytes, ::testing::ValuesIn(methods()),
                         [](const auto& info) { return info.param->name(); });

}  // namespace
}  // namespace weft::e2e
