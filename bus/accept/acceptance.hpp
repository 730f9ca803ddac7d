/// The acceptance of a device: the findings in its EDS, its identity, the comparison of its dictionary, and its
/// conformance test.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accept/compare_dictionary.hpp"
#include "conform/verdict.hpp"
#include "diagnostics/diagnostics.hpp"
#include "online/identity.hpp"

namespace edsc::accept {

/// A number of the identity; `differs` only if both are known.
struct IdentityRow {
  const IdentityNumber* number = nullptr;
  std::optional<std::uint32_t> in_eds, in_device;
  bool differs = false;
  std::string deviation;  ///< the reason in the file of deviations; empty: not declared
};

struct Acceptance {
  const Diagnostics& findings;  ///< of `edsc check`
  const Device& sheet;
  const conform::RunReport& run;
  Comparison comparison;

  [[nodiscard]] std::vector<IdentityRow> identity() const;
  /// Why the device is not accepted; empty: it is accepted.
  [[nodiscard]] std::vector<std::string> objections() const;
};

/// `accepted`, `accepted (level read: 26 of 207 cases run)`, `not accepted`
[[nodiscard]] std::string headline(const Acceptance& acceptance);

/// `2 differences: 1 EDS wrong, 1 undecided`; `no difference`; `not complete`
[[nodiscard]] std::string differences_sentence(const Comparison& comparison);

/// `182 of 190 entries read`
[[nodiscard]] std::string entries_sentence(const Comparison& comparison);

/// `length differs`; `differs from its default value, as stored or live values may`; `same`; why the entry was not
/// compared.
[[nodiscard]] std::string result_text(const ComparedEntry& entry);
/// Whether a property of the entry differs.
[[nodiscard]] bool differs(const ComparedEntry& entry);

/// `[1018sub2] DefaultValue=0x41 => 0x00000042`
[[nodiscard]] std::string correction_text(const Correction& correction);

}  // namespace edsc::accept
