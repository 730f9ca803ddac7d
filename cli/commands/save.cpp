#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "configure/read_configuration.hpp"
#include "configure/saved_dcf.hpp"
#include "eds/ini.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"
#include "xdd/read_xdd.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf                  the values that differ from the EDS
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf --all            all values
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf --bit-rate 500   with the bit rate in [DeviceComissioning]
  edsc configure socketcan:can0 5 axis1.dcf --store                  write them to a node of this kind)";

struct Settings : NodeSettings {
  std::string output;
  std::string format = "text";
  std::optional<unsigned> bit_rate;
  bool all = false;
  bool force = false;
};

using Json = nlohmann::ordered_json;

Json address_json(const LiveEntry& entry) {
  return {{"index", entry_label(entry.index, entry.sub_index)}, {"name", entry.name}};
}

Json as_json(const Settings& settings, const NodeConfiguration& found, const SavedDcf& saved) {
  Json json{{"schema", 2},
            {"node_id", settings.node},
            {"file", settings.output},
            {"read", found.values.size() + found.process_data.size()},
            {"saved", saved.values.size()},
            {"process_data", Json::array()},
            {"missing", Json::array()}};
  for (const LiveEntry& entry : found.process_data) json["process_data"].push_back(address_json(entry));
  for (const NotSaved& one : saved.missing) {
    json["missing"].push_back(address_json(one.entry));
    json["missing"].back()["text"] = one.what;
  }
  return json;
}

void report(const Settings& settings, const NodeConfiguration& found, const SavedDcf& saved) {
  for (const NotSaved& one : saved.missing) print_to_stderr("edsc: {}: {}\n", title(one.entry), one.what);
  if (settings.format == "json") {
    fmt::print("{}\n", json_text(as_json(settings, found, saved)));
    return;
  }
  std::string text = fmt::format("node {}: {} entries read, {} values saved", settings.node,
                                 found.values.size() + found.process_data.size(), saved.values.size());
  if (!settings.output.empty()) text += " to " + settings.output;
  if (!found.process_data.empty()) text += fmt::format(", {} skipped (process data)", found.process_data.size());
  if (!saved.missing.empty()) text += fmt::format(", {} not saved", saved.missing.size());
  if (settings.output.empty()) {
    print_to_stderr("{}\n", text);
  } else {
    print_visibly(stdout, "{}\n", text);
  }
}

NodeConfiguration read_node(SdoAccess& node, const Settings& settings, const Device& device) {
  const std::vector<LiveEntry> entries = configuration_entries(device);
  ProgressLine progress;
  return read_configuration(node, device, entries, [&](std::size_t done) {
    if (progress.due()) progress.show(fmt::format("node {}: {} of {} read", settings.node, done, entries.size()));
  });
}

int save(LiveBus& bus, const Settings& settings, const LoadedDevice& loaded) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  if (node.upload(0x1000, 0).end == SdoEnd::no_answer) {
    fail(fmt::format("node {} does not answer", settings.node), exit_device_failed);
  }
  if (!settings.force) check_node(node, *loaded.device, settings.sheet, "--force saves anyway");
  const NodeConfiguration found = read_node(node, settings, *loaded.device);
  if (found.lost) fail(fmt::format("node {} no longer answers; nothing saved", settings.node), exit_device_failed);
  if (found.restarted) {
    fail(fmt::format("node {} has restarted while its values were read; nothing saved", settings.node),
         exit_device_failed);
  }
  const SavedDcf saved = make_saved_dcf(
      {*loaded.source, loaded.sheet, *loaded.device, found, settings.node, settings.bit_rate, settings.all});
  std::vector<std::string> inputs;
  const bool is_plain_dcf = loaded.sheet.is_dcf && loaded.parts.empty();  // may be replaced by a newer one
  if (!is_plain_dcf) inputs = input_files(loaded);
  write_output(settings.output, saved.text, inputs);
  report(settings, found, saved);
  return saved.missing.empty() ? exit_fine : exit_device_failed;
}

int run_save(const Settings& settings) {
  if (settings.format == "json" && settings.output.empty()) throw_requires("--format json", "--output");
  if (settings.sheet.empty()) throw_required("FILE or --network");
  const auto loaded = load_live_device(settings.sheet, settings.node);
  Diagnostics ignored;
  if (parse_ini(*loaded->source, ignored).sections.empty()) {
    fail(settings.sheet + " is not an EDS or DCF; a DCF is made from one of them");
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return save(bus, settings, *loaded); });
}

}  // namespace

void add_save_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_save, exit_code);
  add_node_arguments(command, settings);
  command.add_option("FILE", settings.sheet, "EDS of the node, or a DCF (default: that of the network file)");
  command.add_option("--output", settings.output, "the DCF (default: standard output)").check(xdd_name_problem);
  command.add_flag("--all", settings.all);
  command.add_option("--bit-rate", settings.bit_rate, "for [DeviceComissioning]").range(5, 1000);
  command.add_flag("--force", settings.force, "the device does not match FILE");
  add_format_option(command, settings.format);
  add_timeout_option(command, settings.sdo.timeout_ms);
}

}  // namespace edsc
