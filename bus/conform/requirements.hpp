/// What CiA 301 and CiA 305 require of a slave, and the cases that test it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace edsc::conform {

/// One requirement of a service that edsc implements, in our own words.
struct RequirementRow {
  std::string_view clause;       ///< `CiA 301, 7.2.8.3.1`
  std::string_view requirement;  ///< as a sentence
  std::string_view cases;        ///< their ids, with a blank between them; empty: see `reason`
  std::string_view reason;       ///< why no case tests it, or a part of it
};

/// Service by service. Each case is in at least one row.
[[nodiscard]] std::span<const RequirementRow> requirements();

/// The ids in `cases`.
[[nodiscard]] std::vector<std::string_view> case_ids(const RequirementRow& row);

}  // namespace edsc::conform
