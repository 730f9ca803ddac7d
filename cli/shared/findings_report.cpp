#include "shared/findings_report.hpp"

#include <fmt/format.h>

#include <utility>

#include "diagnostics/place.hpp"
#include "diagnostics/print.hpp"
#include "rules/check_rules.hpp"
#include "shared/documents.hpp"
#include "shared/left_out_text.hpp"
#include "text/printable.hpp"

namespace edsc {

std::string url_of(const Rule& rule) { return url_of_document(fmt::format("rules.md#{}", rule.id)); }

FindingsReport::FindingsReport(std::string format, const ColorOption& color, bool all)
    : format_{std::move(format)},
      color_{color},
      all_{all},
      json_{{"schema", 2},
            {"diagnostics", nlohmann::json::array()},
            {"allowed_diagnostics", nlohmann::json::array()},
            {"suppressed", nlohmann::json::array()},
            {"left_out", nlohmann::json::array()},
            {"causes", 0},
            {"errors", 0},
            {"warnings", 0},
            {"notes", 0},
            {"allowed", 0}} {
  if (format_ == "sarif") sarif_.emplace(EDSC_VERSION, check_rules, url_of);
}

void FindingsReport::add(const Diagnostics& diagnostics) {
  if (format_ == "text") {
    print_text(stdout, diagnostics, {.colour = color_.on(stdout), .of_check = true, .all = all_});
  } else if (sarif_) {
    sarif_->add(diagnostics);
  } else {
    add_json(print_json(diagnostics));
  }
}

void FindingsReport::add_left_out(const std::vector<LeftOut>& left_out) {
  if (format_ == "text") fmt::print("{}", left_out_text(left_out));
  for (const LeftOut& one : left_out) {
    if (sarif_) sarif_->notify(one.position, "skipped: " + one.what);
    const Place place = place_of(one.position);
    json_["left_out"].push_back(
        {{"file", place.file}, {"line", place.line}, {"column", place.column}, {"what", one.what}});
  }
}

void FindingsReport::add_network(nlohmann::json network) { json_["networks"].push_back(std::move(network)); }

void FindingsReport::finish() const {
  if (format_ == "json") fmt::print("{}\n", json_text(json_));
  if (sarif_) fmt::print("{}\n", json_text(sarif_->document()));
}

void FindingsReport::add_json(const nlohmann::json& one) {
  const std::size_t listed_before = json_["diagnostics"].size();
  for (const nlohmann::json& one_finding : one["diagnostics"]) {
    nlohmann::json& row = json_["diagnostics"].emplace_back(one_finding);
    if (row.contains("follows_from")) row["follows_from"] = row["follows_from"].get<std::size_t>() + listed_before;
  }
  for (const char* list : {"allowed_diagnostics", "suppressed"}) {
    for (const auto& row : one[list]) json_[list].push_back(row);
  }
  for (const char* count : {"causes", "errors", "warnings", "notes", "allowed"}) {
    json_[count] = json_[count].get<std::size_t>() + one[count].get<std::size_t>();
  }
}

}  // namespace edsc
