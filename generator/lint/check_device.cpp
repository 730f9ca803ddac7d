#include "lint/check_device.hpp"

#include "lint/rule_groups.hpp"

namespace edsc {

void check_device(const NamedDevice& named, const DataSheet& sheet, const Options& options, Diagnostics& diagnostics,
                  const MeaningProfile* user_profile) {
  const RuleContext context{named.device, sheet, options, diagnostics, user_profile};
  check_file(context);
  check_device_info(context);
  check_objects(context);
  check_presence(context);
  check_standard_objects(context);
  check_sub_index_0(context);
  check_entries(context);
  check_communication_values(context);
  check_cob_ids(context);
  check_pdo_communication(context);
  check_pdo_mapping(context);
  check_writes(context);
  check_mpdos(context);
  check_profile(context);
  check_meanings(context);
  check_names(context, named.names);
}

}  // namespace edsc
