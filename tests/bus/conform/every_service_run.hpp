/// Runs cases with the every-service device, unchanged or as a mutant.
#pragma once

#include <string>
#include <vector>

#include "conform/run_cases.hpp"
#include "mutant.hpp"

namespace edsc::conform {

/// With all permissions. `only` as in RunSettings.
[[nodiscard]] RunReport run_every_service(const Mutant& mutant, const std::vector<std::string>& only = {});

}  // namespace edsc::conform
