#include "conform/case.hpp"

namespace edsc::conform {

std::span<const CaseRow> other_cases() { return {}; }

}  // namespace edsc::conform
