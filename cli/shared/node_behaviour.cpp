#include "shared/node_behaviour.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "device/behaviour_script.hpp"
#include "device/io_loop.hpp"
#include "device/profile_behaviour.hpp"
#include "diagnostics/diagnostics.hpp"
#include "shared/exit_code.hpp"
#include "shared/output.hpp"

namespace edsc {
namespace {

constexpr std::uint16_t io_module_profile = 401;

}  // namespace

bool load_behaviour(const std::string& path, EntryFinder& names, const ColorOption& color, BehaviourScript& script,
                    std::string& problem) {
  const std::unique_ptr<SourceFile> source = read_source_file(path, problem);
  if (!source) return false;
  Diagnostics diagnostics;
  script = read_behaviour_script(*source, names, diagnostics);
  if (diagnostics.errors() > 0) print_findings(diagnostics, color);
  return diagnostics.errors() == 0;
}

void add_script(NodeBehaviour& behaviour, const std::string& path, EntryFinder& names, const ColorOption& color) {
  std::string problem;
  if (load_behaviour(path, names, color, behaviour.script, problem)) return;
  if (!problem.empty()) fail(problem);
  throw Exit{exit_input_has_errors};
}

bool add_device_profile(NodeBehaviour& behaviour, const Device& device, EntryFinder& names) {
  const std::uint16_t profile = device_profile(device);
  if (has_profile_behaviour(profile)) {
    behaviour.profile = profile;
    return true;
  }
  const std::vector<ValueCopy> wires = profile == io_module_profile ? io_loop(names) : std::vector<ValueCopy>{};
  behaviour.script.copies.insert(behaviour.script.copies.end(), wires.begin(), wires.end());
  return !wires.empty();
}

std::uint16_t device_profile(const Device& device) {
  const Entry* const type = device.find(0x1000, 0);
  return static_cast<std::uint16_t>(type != nullptr && type->default_value ? type->default_value->bits : 0);
}

}  // namespace edsc
