#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "commands/commands.hpp"
#include "configure/read_configuration.hpp"
#include "device/index_range.hpp"
#include "device/resolve.hpp"
#include "format/canonical_form.hpp"
#include "format/configured_values.hpp"
#include "format/make_dcf.hpp"
#include "format/parameter_text.hpp"
#include "format/section_order.hpp"
#include "monitor/progress_line.hpp"
#include "online/live_bus.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/printable.hpp"
#include "text/write_files.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf                  the values that differ from the EDS
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf --all            all values
  edsc save socketcan:can0 5 drive.eds -o axis1.dcf --bit-rate 500   with the bit rate in [DeviceComissioning]
  edsc configure socketcan:can0 5 axis1.dcf --store                  write them to a node of this kind)";

struct Settings {
  std::string bus;
  std::uint8_t node = 0;
  std::string path;
  std::string output;
  std::string format = "text";
  std::optional<unsigned> bit_rate;
  bool all = false;
  bool force = false;
  SdoSettings sdo;
};

using Json = nlohmann::ordered_json;

/// An entry that is not in the DCF, with the reason.
struct Missing {
  LiveEntry entry;
  std::string what;
};

struct Saved {
  NodeConfiguration found;
  ParameterValues values;
  std::vector<Missing> missing;
  std::string text;  ///< of the DCF
};

bool fail(const std::string& sentence) {
  print_visibly(stderr, "edsc: {}\n", sentence);
  return false;
}

/// Whether the value is the default value of the EDS for this node.
bool is_default(const Entry& entry, const std::vector<std::uint8_t>& bytes) {
  if (!entry.default_value) return false;
  const std::string data = data_of(*entry.default_value, *entry.type);
  std::string value{bytes.begin(), bytes.end()};
  if (entry.type->type == canopen::DataType::visible_string) {
    while (value.ends_with('\0')) value.pop_back();
  }
  return value == data;
}

/// Whether the element of a compact form does not have its own section.
bool is_compact(const DataSheet& sheet, const LiveEntry& entry) {
  const ObjectDescription* object = find_object(sheet, entry.index);
  if (object == nullptr || entry.sub_index == 0 || !object->compact_sub_obj.present) return false;
  return std::ranges::find(object->sub_objects, entry.sub_index, &SubObjectDescription::sub_index) ==
         object->sub_objects.end();
}

/// Chooses the values that differ from the EDS.
class Choice {
 public:
  Choice(const LoadedDevice& loaded, const std::vector<ReadValue>& values) {
    note_parameter_values(loaded);
    for (const ReadValue& value : values) {
      const std::uint16_t index = value.entry.index;
      const bool belongs_together = contains(mapping_parameters, index) || is_compact(loaded.sheet, value.entry);
      if (belongs_together && !has_default(value)) whole_.insert(index);
    }
  }

  [[nodiscard]] bool takes(const ReadValue& value) const {
    return whole_.contains(value.entry.index) || !has_default(value);
  }

 private:
  /// With a DCF, the default values of the device are the ParameterValues.
  void note_parameter_values(const LoadedDevice& loaded) {
    if (!loaded.sheet.is_dcf) return;
    Diagnostics ignored;
    for (const ConfiguredValue& value : configured_values(loaded.sheet, *loaded.device, ignored)) {
      if (value.differs) not_default_.insert(value.entry);
    }
  }

  [[nodiscard]] bool has_default(const ReadValue& value) const {
    return !not_default_.contains(value.entry.entry) && is_default(*value.entry.entry, value.bytes);
  }

  std::set<const Entry*> not_default_;
  std::set<std::uint16_t> whole_;  ///< objects with all values saved: mappings and compact forms
};

void choose_values(const Settings& settings, const LoadedDevice& loaded, Saved& saved) {
  const Choice choice{loaded, saved.found.values};
  for (const ReadValue& value : saved.found.values) {
    const Entry& entry = *value.entry.entry;
    const bool by_clause = entry.default_value && !entry.default_value->clause.empty();
    if (!(settings.all && !by_clause) && !choice.takes(value)) continue;
    if (auto text = parameter_text(entry, value.bytes)) {
      saved.values[&entry] = std::move(*text);
    } else if (!value.bytes.empty()) {
      saved.missing.push_back({value.entry, "a DCF cannot hold the value " + value_of(value.entry, value.bytes)});
    }
  }
}

/// The entries whose ParameterValue in FILE is ignored: those that `save` reads, and 1020h, which would have the date
/// of FILE.
std::set<const Entry*> known_entries(const Device& device) {
  std::set<const Entry*> known;
  for (const LiveEntry& entry : configuration_entries(device)) known.insert(entry.entry);
  if (const Object* const date = device.find(0x1020)) {
    for (const Entry& entry : date->entries) known.insert(&entry);
  }
  return known;
}

std::string dcf_text(const Settings& settings, const LoadedDevice& loaded, const ParameterValues& values) {
  Diagnostics ignored;
  const IniFile ini = parse_ini(*loaded.source, ignored);
  Document document = canonical_form(ini, loaded.sheet, *loaded.device);
  make_dcf(document, loaded.sheet, *loaded.device, {values, known_entries(*loaded.device)}, settings.bit_rate);
  return to_text(document);
}

/// The values that a reader of the DCF gets, by address.
std::map<std::pair<std::uint16_t, std::uint8_t>, std::string> values_in(const Settings& settings,
                                                                        const std::string& text) {
  Diagnostics ignored;
  const SourceFile source{"saved.dcf", text};
  const IniFile ini = parse_ini(source, ignored);
  const DataSheet sheet = read_data_sheet(ini, ignored);
  const Device device = resolve_device(sheet, {}, {"", settings.node}, ignored);
  std::map<std::pair<std::uint16_t, std::uint8_t>, std::string> values;
  for (ConfiguredValue& value : configured_values(sheet, device, ignored)) {
    values[{value.entry->index, value.entry->sub_index}] = std::move(value.data);
  }
  return values;
}

/// Writes the DCF and reads it back: values that it does not preserve are removed and reported.
void make_text(const Settings& settings, const LoadedDevice& loaded, Saved& saved) {
  saved.text = dcf_text(settings, loaded, saved.values);
  const auto held = values_in(settings, saved.text);
  bool complete = true;
  for (const ReadValue& value : saved.found.values) {
    const auto chosen = saved.values.find(value.entry.entry);
    if (chosen == saved.values.end()) continue;
    const auto read = held.find({value.entry.index, value.entry.sub_index});
    std::string bytes{value.bytes.begin(), value.bytes.end()};
    if (value.entry.type->type == canopen::DataType::visible_string) {
      while (bytes.ends_with('\0')) bytes.pop_back();
    }
    if (read != held.end() && read->second == bytes) continue;
    saved.missing.push_back({value.entry, "a DCF cannot hold the value " + value_of(value.entry, value.bytes)});
    saved.values.erase(chosen);
    complete = false;
  }
  if (!complete) saved.text = dcf_text(settings, loaded, saved.values);
}

Json rows_of(const std::vector<Missing>& missing) {
  Json rows = Json::array();
  for (const Missing& one : missing) {
    rows.push_back(
        {{"index", one.entry.index}, {"sub_index", one.entry.sub_index}, {"name", one.entry.name}, {"text", one.what}});
  }
  return rows;
}

void report(const Settings& settings, const Saved& saved) {
  for (const Missing& one : saved.missing) print_visibly(stderr, "edsc: {}: {}\n", title(one.entry), one.what);
  if (settings.format == "json") {
    Json json{{"version", 1},
              {"node_id", settings.node},
              {"file", settings.output},
              {"read", saved.found.values.size() + saved.found.process_data.size()},
              {"saved", saved.values.size()},
              {"process_data", Json::array()},
              {"missing", rows_of(saved.missing)}};
    for (const LiveEntry& entry : saved.found.process_data) {
      json["process_data"].push_back({{"index", entry.index}, {"sub_index", entry.sub_index}, {"name", entry.name}});
    }
    fmt::print("{}\n", json_text(json));
    return;
  }
  std::string text = fmt::format("node {}: {} entries read, {} values saved", settings.node,
                                 saved.found.values.size() + saved.found.process_data.size(), saved.values.size());
  if (!settings.output.empty()) text += " to " + settings.output;
  if (!saved.found.process_data.empty())
    text += fmt::format(", {} left out (process data)", saved.found.process_data.size());
  if (!saved.missing.empty()) text += fmt::format(", {} not saved", saved.missing.size());
  print_visibly(settings.output.empty() ? stderr : stdout, "{}\n", text);
}

/// Returns false if the file cannot be written.
bool write_text(const Settings& settings, const LoadedDevice& loaded, const Saved& saved) {
  if (!settings.output.empty()) {
    std::vector<std::string> inputs;
    if (!loaded.sheet.is_dcf) inputs.push_back(settings.path);  // a DCF may be replaced by a newer one
    const std::string problem = write_files({{settings.output, saved.text}}, inputs);
    return problem.empty() || fail(problem);
  }
  write_output(saved.text);
  return true;
}

int save(LiveBus& bus, const Settings& settings, const LoadedDevice& loaded) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  const Device& device = *loaded.device;
  const SdoOutcome first = node.upload(0x1000, 0);
  if (first.end == SdoEnd::no_answer) {
    fail(fmt::format("node {} does not answer", settings.node));
    return exit_device_failed;
  }
  if (!settings.force) {
    const NodeCheck check = check_node(node, device, settings.path);
    if (!check.problem.empty()) {
      fail(check.problem + "; --force saves anyway");
      return exit_device_failed;
    }
    if (!check.not_compared.empty()) {
      print_visibly(stderr, "edsc: node {}: not compared: {}\n", settings.node, check.not_compared);
    }
  }
  Saved saved;
  {
    const std::vector<LiveEntry> entries = configuration_entries(device);
    ProgressLine progress;
    saved.found = read_configuration(node, device, entries, [&](std::size_t done) {
      if (progress.due()) progress.show(fmt::format("node {}: {} of {} read", settings.node, done, entries.size()));
    });
  }
  if (saved.found.lost) {
    fail(fmt::format("node {} no longer answers; nothing saved", settings.node));
    return exit_device_failed;
  }
  if (saved.found.restarted) {
    fail(fmt::format("node {} has restarted while its values were read; nothing saved", settings.node));
    return exit_device_failed;
  }
  for (const UnreadValue& unread : saved.found.unread) {
    saved.missing.push_back({unread.entry, failure_text(unread.outcome)});
  }
  choose_values(settings, loaded, saved);
  make_text(settings, loaded, saved);
  if (!write_text(settings, loaded, saved)) return exit_wrong_usage;
  report(settings, saved);
  return saved.missing.empty() ? exit_fine : exit_device_failed;
}

int run_save(const Settings& settings) {
  const auto loaded = load_live_device(settings.path, settings.node);
  if (!loaded) return exit_wrong_usage;
  Diagnostics ignored;
  if (parse_ini(*loaded->source, ignored).sections.empty()) {
    fail(settings.path + " is not an EDS or DCF; a DCF is made from one of them");
    return exit_wrong_usage;
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return save(bus, settings, *loaded); });
}

}  // namespace

void add_save_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("save", "read the configuration of a node and write it as a DCF");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  add_node_argument(*command, settings->node);
  command->add_option("FILE", settings->path, "EDS of the node, or a DCF")->required();
  auto* output = command->add_option("-o,--output", settings->output, "DCF to write (default: standard output)")
                     ->type_name("FILE");
  command->add_flag("--all", settings->all, "all values, not only those that differ from the EDS");
  command->add_option("--bit-rate", settings->bit_rate, "kbit/s of the bus, for [DeviceComissioning]")
      ->check(CLI::Range(5, 1000));
  command->add_flag("--force", settings->force, "save even if the device does not match FILE");
  add_format_option(*command, settings->format);
  add_timeout_option(*command, settings->sdo.timeout_ms);
  command->callback([settings, output, &exit_code] {
    if (settings->format == "json" && output->count() == 0) throw CLI::RequiresError("--format json", "--output");
    exit_code = run_save(*settings);
  });
}

}  // namespace edsc
