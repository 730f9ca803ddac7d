#include "mutant.hpp"

namespace edsc::conform {

std::vector<Mutant> sdo_mutants() { return {}; }

}  // namespace edsc::conform
