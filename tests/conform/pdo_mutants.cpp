#include "mutant.hpp"

namespace edsc::conform {

std::vector<Mutant> pdo_mutants() { return {}; }

}  // namespace edsc::conform
