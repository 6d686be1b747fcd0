// SPDX-License-Identifier: Apache-2.0
// What a client of --http sends: the target of a request, then, after a line feed, the first bytes
// of a file, or a message instead of one. Asserts:
//   path       a target that is decoded is UTF-8 without control characters, not longer than it was
//   wish       parameters are taken, or refused with a sentence and a status of 400, 406 or 415
//   request    what is taken can be sent, and read again
//   names      the names of a message that is taken are those that protobuf finds in it
//   format     the format of the file is one that is read here, or none
//   form       the file, as a form, has parts with names within it, or is refused with a sentence
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/http/domain_file.h"
#include "server/http/form.h"
#include "server/http/formats.h"
#include "server/http/mesh_wish.h"
#include "server/http/target.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

using namespace server;

void judge(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto must = [&](bool holds, std::string_view law, const std::string& evidence) {
    if (!holds) broken(law, evidence, data, size);
  };
  const auto line = std::min(bytes.find('\n'), size);
  const std::string_view text = bytes.substr(0, line);
  const std::string_view file = bytes.substr(std::min(line + 1, size));
  const auto target = parse_target(text);
  const std::string path = target ? target->path : "";
  must(path.size() <= text.size() && files::is_plain_text(path), "path", path);
  const std::string format = format_read(path, "", file);
  const auto read = read_formats();
  must(format.empty() || std::ranges::find(read, format.substr(1)) != read.end(), "format", format);
  (void)format_wanted(text);
  const auto parts = parts_of("multipart/form-data; boundary=x", file);
  if (!parts) must(!parts.error().empty(), "form", "no sentence");
  if (parts)
    for (const FormPart& part : *parts)
      must(!part.name.empty() && part.body.size() < file.size(), "form", part.name);
  const auto taken = take_request(std::string(file), {});
  v1::GenerateMeshRequest sent;
  if (taken && sent.ParseFromArray(file.data(), static_cast<int>(file.size()))) {
    files::NameReader names("");
    for (const v1::Name& name : sent.domain().marker_names())
      names.add(files::NameKind::kMarker, name.id(), name.name());
    for (const v1::Name& name : sent.domain().region_names())
      names.add(files::NameKind::kRegion, name.id(), name.name());
    must(taken->domain.names == names.take(), "names", std::string(file));
  }
  if (!target) return;
  auto wish = read_wish(target->query, ~ParameterUses{});
  if (!wish) {
    const Problem& problem = wish.error();
    must(!problem.detail.empty() && !problem.field.empty() &&
             (problem.status == 400 || problem.status == 406 || problem.status == 415),
         "wish", problem.detail);
    (void)problem_page(problem);
    return;
  }
  if (const auto problem = complete({{2, "inlet"}}, *wish))
    return must(!problem->detail.empty(), "wish", problem->field);
  v1::GenerateMeshRequest again;
  must(again.ParseFromString(wish->request.SerializeAsString()), "request", std::string(text));
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}
