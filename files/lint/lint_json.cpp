// SPDX-License-Identifier: Apache-2.0
#include "files/lint/lint_json.h"

#include <utility>

namespace weft::files {

using Json = nlohmann::ordered_json;

Json position(Point p) {
  return Json::array({p.x, p.y});
}

Json properties_of(const Finding& finding) {
  Json json = {{"kind", finding.kind}, {"text", finding.text}};
  if (!finding.warning.empty()) json["warning"] = finding.warning;
  if (!finding.remedy.empty()) json["remedy"] = finding.remedy;
  if (finding.measure) json["measure"] = *finding.measure;
  if (!finding.offenders.empty()) json["offenders"] = finding.offenders;
  return json;
}

Json lint_json(const Lint& lint) {
  Json json = {{"file", lint.file}, {"faults", lint.total}, {"complete", lint.complete}};
  json["counts"] = Json::object();
  for (const auto& [kind, total] : lint.counts) json["counts"][kind] = total;
  json["findings"] = Json::array();
  for (const Finding& finding : lint.findings) {
    Json one = properties_of(finding);
    if (finding.at) one["at"] = position(*finding.at);
    if (finding.to) one["to"] = position(*finding.to);
    json["findings"].push_back(std::move(one));
  }
  return json;
}

}  // namespace weft::files
