#include "conform/case.hpp"

namespace edsc::conform {

std::span<const CaseRow> sync_cases() { return {}; }

}  // namespace edsc::conform
