// SPDX-License-Identifier: Apache-2.0
// A domain, a request for its mesh or the list of its faults, made of the file that a stranger
// sent.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"
#include "server/http/mesh_wish.h"
#include "server/http/workers.h"

namespace weft::server {

// What files/ says of a file of the server, for whoever sent it: by the name that the sender knows,
// and with parameters instead of flags.
class FileTexts {
 public:
  FileTexts() = default;
  FileTexts(std::string path, std::string name) : path_(std::move(path)), name_(std::move(name)) {}

  std::string operator()(std::string text) const;
  Problem problem(const files::Error& error) const;

 private:
  std::string path_;
  std::string name_;
};

// A grid of values (.asc) that is a field of the size.
struct FieldFile {
  std::string field;
  std::string name;  // of the file, as texts call it
  std::string bytes;
};

struct DomainFile {
  std::string bytes;
  std::string name;       // as texts call it, such as "coast.geojson"
  std::string extension;  // that says how it is read
  std::vector<FieldFile> fields{};
};

// What is left of a domain once it has been sent: its names, its places, and how to bring the mesh
// back.
struct SentDomain {
  std::string request;                                        // a GenerateMeshRequest
  files::Domain domain;                                       // without points, segments and arcs
  std::shared_ptr<const files::DomainProjection> projection;  // may be null
  files::MeshWriteOptions writing;
  std::vector<std::string> warnings;  // sentences
  FileTexts texts;
  std::uint64_t bytes = 0;  // that all this takes, but for the request
};

// The file is put into `folder`, without a name, while it is read. Problems: 400 for a file that
// cannot be read, with the place; those of `complete`.
Outcome<SentDomain> read_domain_file(DomainFile file, MeshWish wish,
                                     const std::filesystem::path& folder);

// The faults of the domain in the file, as JSON. Problems: as above.
Outcome<std::string> lint_domain_file(DomainFile file, MeshWish wish,
                                      const std::filesystem::path& folder);

// A file without a name.
struct NamelessFile {
  files::FileDescriptor file;
  std::uint64_t bytes = 0;
};

// The same with one more member, "domain": the weft.v1.Domain in base64, in the plane if the wish
// has a projection. `most_bytes`: of that message. Problems: 413 for more, too; 507 if there is no
// room for the file.
Outcome<NamelessFile> convert_domain_file(DomainFile file, MeshWish wish,
                                          const std::filesystem::path& folder,
                                          std::uint64_t most_bytes);

// A GenerateMeshRequest that somebody sent, with the names in its domain. Problem: 400 if it is not
// one, as far as its names tell.
Outcome<SentDomain> take_request(std::string request, MeshWish wish);

// The bytes that reading the file, and finding its faults, may take at most.
std::uint64_t bytes_to_read(const DomainFile& file);
std::uint64_t bytes_to_lint(const DomainFile& file);

// A message of two parts: `field` is the number of one that is a message, `rest` has the others.
std::string with_part(unsigned field, const std::string& message, const std::string& rest);

// The problem that the server has with the domain, or with another part of the request, with the
// place in the file or the parameter that is at fault.
Problem located(Problem problem, const SentDomain& sent, const Query& query);

}  // namespace weft::server
