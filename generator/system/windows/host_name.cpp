#include "system/host_name.hpp"

#include "system/environment.hpp"

namespace edsc {

std::string host_name() { return environment_variable("COMPUTERNAME").value_or(""); }

}  // namespace edsc
