// SPDX-License-Identifier: Apache-2.0
// What exchanges share, and what each has of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/console/byte_budget.h"
#include "server/console/session.h"
#include "server/http/workers.h"
#include "server/observe/bounded_log.h"
#include "server/observe/log.h"
#include "server/run/memory_budget.h"

namespace weft::server {

// Meshes that are on their way at the same time, by client: until their files are sent.
class Meshes : public std::enable_shared_from_this<Meshes> {
 public:
  // `share`: that one client has, of the meshes, of the bytes of their files and of the threads for
  // long work.
  Meshes(std::size_t most, std::uint64_t file_bytes, double share, Workers& workers)
      : most_(most),
        files_(file_bytes, share),
        most_of_client_(
            std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(most)))),
        lines_of_client_(share < 1 ? workers.threads() - 1 : workers.threads()),
        workers_(workers) {}

  // One of them. The last owner of its mesh or of its file has it.
  class Place {
   public:
    ~Place() { meshes_->leave(client_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    // Where the client's next work is done.
    Workers::Executor for_work(bool is_long) const {
      if (!is_long) return meshes_->workers_.for_short();
      OfClient& mine = meshes_->of_clients_.at(client_);
      return mine.lines[mine.next++ % mine.lines.size()];
    }
    // Whether its files may have so many bytes from now on.
    bool hold(std::uint64_t bytes) { return files_.hold(bytes); }

   private:
    friend class Meshes;
    Place(std::shared_ptr<Meshes> meshes, const std::string& client)
        : meshes_(std::move(meshes)), client_(client), files_(meshes_->files_, client) {}

    const std::shared_ptr<Meshes> meshes_;
    const std::string client_;
    ByteBudget::Held files_;
  };

  // Call before the workers end. No work is done any more.
  void close() {
    for (auto& [client, mine] : of_clients_) mine.lines.clear();
  }

  // Null if there are too many.
  std::shared_ptr<Place> enter(const std::string& client) {
    const auto found = of_clients_.find(client);
    if (all_ == most_ || (found != of_clients_.end() && found->second.count == most_of_client_))
      return nullptr;
    OfClient& mine = of_clients_[client];
    while (mine.lines.size() < lines_of_client_) mine.lines.push_back(workers_.line_for_long());
    ++mine.count;
    ++all_;
    return std::shared_ptr<Place>(new Place(shared_from_this(), client));
  }

 private:
  struct OfClient {
    std::size_t count = 0;
    std::vector<Workers::Executor> lines{};
    std::size_t next = 0;
  };

  void leave(const std::string& client) {
    --all_;
    const auto mine = of_clients_.find(client);
    if (--mine->second.count == 0) of_clients_.erase(mine);
  }

  const std::size_t most_;
  ByteBudget files_;
  const std::size_t most_of_client_;
  const std::size_t lines_of_client_;
  Workers& workers_;
  std::size_t all_ = 0;
  std::map<std::string, OfClient> of_clients_;
};

// Of requests that were refused before they became a call, which has a line of its own.
class RefusalLog {
 public:
  explicit RefusalLog(Logger log) : log_(std::move(log)), lines_(log_, "http_refused", kLines) {}
  void note(const std::string& client, const Problem& problem) {
    lines_.flush_suppressed();
    if (!lines_.allow()) return;
    log_->info("event=http_refused client={} status={} reason={} field={}", log_value(client),
               problem.status, problem.reason, log_value(problem.field));
  }

 private:
  static constexpr std::uint64_t kLines = 20;  // in a second
  const Logger log_;
  BoundedLog lines_;
};

struct ExchangeParts {
  SessionContext& context;
  MemoryBudget& memory;
  std::filesystem::path folder;  // of nameless files
  Meshes& meshes;
  RefusalLog refusals;
};

}  // namespace weft::server
