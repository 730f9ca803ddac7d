#include "mutant.hpp"

namespace edsc::conform {

std::vector<Mutant> control_mutants() { return {}; }

}  // namespace edsc::conform
