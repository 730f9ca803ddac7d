#include "configure/configuration_run.hpp"

#include <algorithm>
#include <canopen/nmt_master/nmt_master.hpp>
#include <cstring>
#include <utility>

namespace edsc {

void choose_all(ConfigurationRun& run, const Configuration& configuration, bool node_id_and_bit_rate) {
  for (const ConfigurationValue& value : configuration.values) {
    if (sets_node_id_or_bit_rate(value.entry) && !node_id_and_bit_rate) {
      run.withheld.push_back({value, {}});
    } else {
      run.values.push_back(value);
    }
  }
}

bool choose_different(ConfigurationRun& run, SdoAccess& node, const Configuration& configuration,
                      bool node_id_and_bit_rate, const ConfigurationHooks& hooks) {
  Comparison comparison = compare_configuration(node, configuration.values, hooks);
  if (comparison.lost) {
    run.result.lost = true;
    run.result.lost_at = configuration.values[comparison.values.size()].entry;
    return false;
  }
  std::vector<bool> differs(configuration.values.size());
  for (std::size_t i = 0; i < differs.size(); ++i) {
    ComparedValue& compared = comparison.values[i];
    const ConfigurationValue& value = configuration.values[i];
    if (has_effect(value, configuration.values)) ++run.compared;
    if (!compared.differs) continue;
    ConfigurationChange change{value, {}};
    if (compared.known()) change.before = std::move(compared.found.bytes);
    differs[i] = !sets_node_id_or_bit_rate(value.entry) || node_id_and_bit_rate;
    (differs[i] ? run.changes : run.withheld).push_back(std::move(change));
  }
  run.values = values_to_write(configuration.values, differs);
  return true;
}

void enter_pre_operational(LiveBus& bus, canopen::NodeId node) {
  bus.send_all(canopen::nmt_frame(canopen::NmtCommand::enter_pre_operational, node));
  bus.listen(canopen::from_milliseconds(10));
}

void write_time(ConfigurationRun& run, SdoAccess& node, const Configuration& configuration) {
  if (!configuration.time || !run.withheld.empty()) return;
  if (!run.all && read_configuration_time(node) == configuration.time) return;
  const std::string problem = write_configuration_time(node, *configuration.time);
  run.time_written = problem.empty();
  if (!problem.empty()) run.problems.push_back("1020h Verify configuration: " + problem);
}

void store_parameters(ConfigurationRun& run, SdoAccess& node, unsigned timeout_ms) {
  constexpr unsigned shortest_ms = 5'000;
  constexpr std::uint32_t signature = 0x6576'6173;  // "save"
  node.set_timeout(std::max(timeout_ms, shortest_ms));
  std::vector<std::uint8_t> bytes(sizeof signature);
  std::memcpy(bytes.data(), &signature, sizeof signature);
  const SdoOutcome outcome = node.download(0x1010, 1, bytes);
  run.stored = outcome.done();
  if (!outcome.done()) run.problems.push_back("1010h:01 Store parameters: " + failure_text(outcome));
}

}  // namespace edsc
