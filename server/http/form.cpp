// SPDX-License-Identifier: Apache-2.0
#include "server/http/form.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <utility>

#include "server/console/frames.h"

namespace weft::server {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view kForm = "multipart/form-data";
constexpr std::size_t kMaxParts = 100;

// "form-data; name=a" is a value with parameters.
std::optional<std::string> parameter(std::string_view text, std::string_view name) {
  const std::string_view list = text.substr(std::min(text.find(';'), text.size()));
  for (const auto& [key, value] : http::param_list({list.data(), list.size()}))
    if (boost::beast::iequals(key, {name.data(), name.size()})) return std::string(view(value));
  return std::nullopt;
}

// Takes a line off the text, without its end; nullopt if it has no end.
std::optional<std::string_view> take_line(std::string_view& text) {
  const auto end = text.find("\r\n");
  if (end == text.npos) return std::nullopt;
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 2);
  return line;
}

tl::expected<FormPart, std::string> part_of(std::string_view text) {
  FormPart part;
  while (true) {
    const auto line = take_line(text);
    if (!line) return tl::unexpected<std::string>("a part of the form has no body");
    if (line->empty()) break;
    const auto colon = std::min(line->find(':'), line->size());
    const std::string_view name = line->substr(0, colon);
    std::string_view value = line->substr(std::min(colon + 1, line->size()));
    value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
    const auto is = [name](boost::beast::string_view other) {
      return boost::beast::iequals({name.data(), name.size()}, other);
    };
    if (is("Content-Type")) part.content_type = value;
    if (!is("Content-Disposition")) continue;
    part.name = parameter(value, "name").value_or("");
    part.filename = parameter(value, "filename");
  }
  if (part.name.empty()) return tl::unexpected<std::string>("a part of the form has no name");
  part.body = text;
  return part;
}

}  // namespace

bool is_form(std::string_view content_type) {
  const std::string_view type = content_type.substr(0, content_type.find_first_of("; "));
  return boost::beast::iequals({type.data(), type.size()}, {kForm.data(), kForm.size()});
}

tl::expected<std::vector<FormPart>, std::string> parts_of(std::string_view content_type,
                                                          std::string_view body) {
  const auto boundary = parameter(content_type, "boundary");
  if (!boundary || boundary->empty())
    return tl::unexpected<std::string>("Content-Type names no boundary of the form's parts");
  const std::string delimiter = "\r\n--" + *boundary;
  std::vector<FormPart> parts;
  // The first one may begin the body.
  auto at = body.starts_with(delimiter.substr(2)) ? 0 : body.find(delimiter);
  auto after = at == 0 ? delimiter.size() - 2 : at + delimiter.size();
  while (true) {
    if (at == body.npos) return tl::unexpected<std::string>("the form ends within a part");
    std::string_view rest = body.substr(after);
    if (rest.starts_with("--")) return parts;
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (!rest.starts_with("\r\n") || parts.size() == kMaxParts)
      return tl::unexpected<std::string>(parts.size() == kMaxParts
                                             ? "the form has more than 100 parts"
                                             : "a boundary of the form goes on");
    rest.remove_prefix(2);
    const auto start = body.size() - rest.size();
    // The lines of a part without any may end where its body does.
    at = body.find(delimiter, start - 2);
    if (at == body.npos) continue;
    auto part = part_of(body.substr(start, std::max(at, start) - start));
    if (!part) return tl::unexpected(part.error());
    parts.push_back(std::move(*part));
    after = at + delimiter.size();
  }
}

}  // namespace weft::server
