/// The comparison of an acceptance for a terminal, and the verdict.
#pragma once

#include <string>

#include "accept/acceptance.hpp"

namespace edsc::accept {

/// The findings in the EDS, the identity, and each difference with its frames.
[[nodiscard]] std::string comparison_text(const Acceptance& acceptance, bool color);
/// `accepted`, or `not accepted` with the objections.
[[nodiscard]] std::string verdict_text(const Acceptance& acceptance, bool color);

}  // namespace edsc::accept
