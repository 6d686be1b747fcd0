// SPDX-License-Identifier: Apache-2.0
// A request whose body is the file of a domain, or whose answer is that of a mesh, or both. For a
// mesh, the body may be a GenerateMeshRequest instead, by its type application/x-protobuf.
//
// The body is read into memory, bounded as a message of gRPC is, and becomes the request of a call
// within the process, which is admitted as every other. The chunks of a mesh go to nameless files,
// and from there, once all are there, into the file that is sent; one that streams is written, and
// sent, as they come. What takes long is done by the workers.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "server/console/bridge_call.h"
#include "server/console/exchange.h"
#include "server/http/call_exchange.h"
#include "server/http/domain_file.h"
#include "server/http/exchange_parts.h"
#include "server/http/mesh_file.h"
#include "server/http/mesh_wish.h"

namespace weft::server {

class MeshExchange final : public Exchange,
                           private BridgeCall::Listener,
                           public std::enable_shared_from_this<MeshExchange> {
 public:
  enum class Purpose {
    kMesh,    // a domain in, its mesh out; `word` is the name of the file, or empty
    kJob,     // a domain in, a job out
    kLint,    // a domain in, its faults out
    kDomain,  // a domain in, its message and its faults out; `word` as of kMesh
    kStored,  // the mesh of a job out; `word` is its id
  };

  // Problems: those of read_wish; 406 for an Accept of nothing that is written; 413 and 429 before
  // the body.
  static Outcome<std::shared_ptr<MeshExchange>> open(ExchangeParts& parts, Purpose purpose,
                                                     ParameterUses uses, const Query& query,
                                                     const std::string& word, Visit& visit);

  bool wants_body() const override { return purpose_ != Purpose::kStored; }
  bool take(std::string_view bytes) override;
  void body_ended() override;
  void body_late() override;
  void drop() override;

 private:
  MeshExchange(ExchangeParts& parts, Purpose purpose, ParameterUses uses, MeshWish wish,
               Query query, Visit& visit, std::shared_ptr<Meshes::Place> place);

  template <class Task, class Then>
  void work(bool is_long, Task task, Then then);
  // Takes the files and the parameters of a form, as which the body came; returns what is wrong.
  std::optional<Problem> take_form();
  // Whether work on the whole mesh takes long.
  bool is_large() const;
  void take_request_in();
  void lint(std::shared_ptr<void> memory);
  void convert(std::shared_ptr<void> memory);
  void answer(Answer answer);
  void begin(SentDomain sent, std::shared_ptr<ArrivingMesh> mesh);
  void begin_job(std::string mesh);
  void begin_fetch();
  void begin_stream(const char* method, std::string request);
  void wrote(bool ok) override;
  void received(grpc::ByteBuffer message) override;
  void ended(const grpc::Status& status, const Metadata& trailers) override;
  void write_file();
  // Of the mesh's file, with what is known before it is made.
  Response head() const;
  // Sends what there is of a file that streams.
  void send_on(MeshFile so_far);
  void answer_mesh(MeshFile file);
  // The figures and the warnings of the mesh.
  void describe(std::vector<std::string> warnings, boost::beast::http::fields& head) const;
  // Names the file of a stored mesh, and leaves of it the range that was asked for.
  void cut(Answer& answer) const;
  // Ends the call, if there is one.
  void refuse(const Problem& problem);
  Problem too_large() const;

  ExchangeParts& parts_;
  const Purpose purpose_;
  const ParameterUses uses_;
  MeshWish wish_;
  Query query_;
  const std::string client_;
  const Metadata metadata_;
  const std::shared_ptr<Meshes::Place> place_;
  std::shared_ptr<Client> answers_to_;  // null once it has its answer, or is gone
  const std::string accept_;
  const std::string range_, if_range_;  // of a stored mesh
  std::string content_type_;
  bool is_message_ = false;    // the body, not a file
  std::string job_;            // whose mesh it is
  std::string stem_ = "mesh";  // of the name of the file that is sent
  ByteBudget::Held held_;
  DomainFile file_;
  std::stop_source stop_;

  std::shared_ptr<const SentDomain> sent_;
  std::shared_ptr<ArrivingMesh> mesh_;
  std::uint64_t sent_bytes_ = 0;  // of its file, while it streams
  std::optional<v1::Summary> summary_;
  std::shared_ptr<BridgeCall> call_;
  std::shared_ptr<CallExchange> submission_;
};

}  // namespace weft::server
