#include "rules/check_device.hpp"

#include "rules/object_rules.hpp"
#include "rules/pdo_rules.hpp"

namespace edsc {

void check_device(Device& device, Diagnostics& diagnostics) {
  check_objects(device, diagnostics);
  check_pdos(device, diagnostics);
}

}  // namespace edsc
