#include <fmt/format.h>

#include <canopen/nmt_master.hpp>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "commands/live_device.hpp"
#include "commands/live_options.hpp"
#include "diagnostics/place.hpp"
#include "eds/number.hpp"
#include "format/concise_dcf.hpp"
#include "format/configured_values.hpp"
#include "live/configure_node.hpp"
#include "live/exit_code.hpp"
#include "live/identity.hpp"
#include "live/live_bus.hpp"
#include "live/progress_line.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc configure socketcan:can0 5 axis1.dcf                     write all ParameterValues, read them back
  edsc configure socketcan:can0 5 axis1.dcf --store --start     keep them without power, then start the node
  edsc configure socketcan:can0 5 axis1.dcf --dry-run           the steps in their order; nothing is sent
  edsc configure socketcan:can0 5 axis1.bin --concise --eds drive.eds
  edsc format drive.eds --dcf --node-id 5 -o axis1.dcf          where the DCF comes from)";

struct Settings {
  std::string bus;
  std::uint8_t node = 0;
  std::string path;
  std::string sheet;  ///< of a concise DCF
  bool concise = false;
  bool keep_state = false;
  bool start = false;
  bool store = false;
  bool force = false;
  bool dry_run = false;
  std::string format = "text";
  SdoSettings sdo;
};

/// What is to be written, and all that it points into.
struct Configuration {
  std::unique_ptr<LoadedDevice> loaded;  ///< null: a concise DCF without data sheet
  std::vector<std::uint8_t> stream;      ///< of a concise DCF
  std::vector<ConfigurationValue> values;
  std::size_t left_out = 0;
  std::optional<ConfigurationTime> time;  ///< of 1020h

  [[nodiscard]] const Device* device() const { return loaded ? &*loaded->device : nullptr; }
};

/// What a run came to besides its values.
struct Ending {
  bool configured_already = false;
  bool time_written = false;
  bool stored = false;
  std::vector<std::string> problems;
};

using Json = nlohmann::ordered_json;

constexpr std::uint32_t store_signature = 0x6576'6173;  ///< "save"
constexpr unsigned shortest_store_ms = 5'000;           ///< a device may erase its flash before it answers
constexpr canopen::Duration after_nmt = canopen::from_milliseconds(10);

LiveEntry entry_or_address(const Device* device, std::uint16_t index, std::uint8_t sub_index) {
  const Object* object = device == nullptr ? nullptr : device->find(index);
  const Entry* entry = object == nullptr ? nullptr : object->find(sub_index);
  if (entry != nullptr) return live_entry(*object, *entry);
  LiveEntry address;
  address.index = index;
  address.sub_index = sub_index;
  return address;
}

bool refuse(const std::string& sentence) {
  fmt::print(stderr, "edsc: {}\n", sentence);
  return false;
}

/// The date of the file, unless the DCF has values for 1020h.
std::optional<ConfigurationTime> time_of(const Configuration& configuration,
                                         const std::vector<ConfiguredValue>& values) {
  ConfigurationTime time;
  for (const ConfiguredValue& value : values) {
    if (value.entry->index != 0x1020 || value.data.size() != sizeof(std::uint32_t)) continue;
    std::uint32_t word = 0;
    std::memcpy(&word, value.data.data(), sizeof word);
    (value.entry->sub_index == 1 ? time.date : time.time) = word;
  }
  if (time.date != 0) return time;
  if (configuration.device()->find(0x1020, 1) == nullptr) return std::nullopt;
  const FileInformation& file = configuration.device()->information.file;
  return parse_configuration_time(file.modification_date, file.modification_time);
}

bool read_dcf(const Settings& settings, Configuration& configuration) {
  configuration.loaded = load_live_device(settings.path, settings.node);
  if (!configuration.loaded) return false;
  if (!configuration.loaded->sheet.is_dcf) {
    return refuse(settings.path + " is no DCF: \"edsc format --dcf\" makes one of a data sheet");
  }
  Diagnostics diagnostics;
  const auto values = configured_values(configuration.loaded->sheet, *configuration.device(), diagnostics);
  print_findings(stderr, diagnostics, ColorOption{});
  if (diagnostics.errors() > 0) return false;
  for (const ConfiguredValue& value : values) {
    configuration.values.push_back(
        {entry_or_address(configuration.device(), value.entry->index, value.entry->sub_index),
         {value.data.begin(), value.data.end()},
         value.position});
  }
  configuration.time = time_of(configuration, values);
  return true;
}

bool read_concise(const Settings& settings, Configuration& configuration) {
  if (!settings.sheet.empty()) {
    configuration.loaded = load_live_device(settings.sheet, settings.node);
    if (!configuration.loaded) return false;
  }
  std::string problem;
  if (!read_bytes(settings.path, configuration.stream, problem)) return refuse(problem);
  const auto entries =
      read_concise_dcf({reinterpret_cast<const char*>(configuration.stream.data()), configuration.stream.size()});
  if (!entries) return refuse(settings.path + " is no concise DCF: it is shorter or longer than it says");
  for (const ConciseEntry& entry : *entries) {
    configuration.values.push_back({entry_or_address(configuration.device(), entry.index, entry.sub_index),
                                    {entry.data.begin(), entry.data.end()},
                                    {}});
  }
  return true;
}

std::string_view verb_of(StepKind kind) {
  switch (kind) {
    case StepKind::write: return "write";
    case StepKind::switch_off: return "switch off";
    case StepKind::switch_on: return "switch on";
    case StepKind::clear: return "clear";
  }
  return {};
}

void print_steps(const std::vector<ConfigurationStep>& steps) {
  for (const ConfigurationStep& step : steps) {
    const bool writes = step.kind == StepKind::write || step.kind == StepKind::switch_on;
    fmt::print("{:<10}  {}{}\n", verb_of(step.kind), title(step.entry),
               !writes              ? ""
               : step.bytes.empty() ? " as before"
                                    : " = " + value_of(step.entry, step.bytes));
  }
}

std::optional<std::uint32_t> read_number(SdoAccess& node, std::uint16_t index, std::uint8_t sub_index) {
  const SdoOutcome outcome = node.upload(index, sub_index);
  if (!outcome.done() || outcome.bytes.size() != sizeof(std::uint32_t)) return std::nullopt;
  std::uint32_t number = 0;
  std::memcpy(&number, outcome.bytes.data(), sizeof number);
  return number;
}

/// Whether the node is the device of the DCF, as far as both know. What speaks against it is told.
bool is_right_device(SdoAccess& node, const Settings& settings, const Configuration& configuration) {
  const SdoOutcome first = node.upload(0x1000, 0);
  if (first.end == SdoEnd::no_answer) return refuse(fmt::format("node {} does not answer", settings.node));
  if (configuration.device() == nullptr || settings.force) return true;
  const auto meant = parse_unsigned(configuration.loaded->sheet.commissioning.node_id.text);
  if (meant && *meant != settings.node) {
    return refuse(fmt::format("{} is for node {}, not for node {} (--force writes nevertheless)", settings.path, *meant,
                              settings.node));
  }
  Identity device;
  if (first.done() && first.bytes.size() == sizeof(std::uint32_t)) device.device_type = read_number(node, 0x1000, 0);
  device.vendor_id = read_number(node, 0x1018, 1);
  device.product_code = read_number(node, 0x1018, 2);
  device.revision_number = read_number(node, 0x1018, 3);
  device.serial_number = read_number(node, 0x1018, 4);
  const Identity sheet = identity_of(*configuration.device());
  const Fit fit = compare_identity(sheet, device);
  if (fit == Fit::same || fit == Fit::minor_revision || fit == Fit::unknown) return true;
  return refuse(fmt::format("node {} is not the device of {}: {} (--force writes nevertheless)", settings.node,
                            settings.path, identity_differences(sheet, device)));
}

std::string place_of_value(const ConfigurationValue* value) {
  if (value == nullptr || value->position.file == nullptr) return "edsc: ";
  const Place place = place_of(value->position);
  return fmt::format("{}:{}:{}: error: ", place.file, place.line, place.column);
}

void print_failures(const ConfigurationResult& result, const Ending& ending) {
  for (const ConfigurationFailure& failure : result.failures) {
    const std::string wanted = failure.value == nullptr ? "" : " = " + value_of(failure.entry, failure.value->bytes);
    fmt::print(stderr, "{}{}{}: {}\n", place_of_value(failure.value), title(failure.entry), wanted, failure.what);
  }
  for (const std::string& problem : ending.problems) fmt::print(stderr, "edsc: {}\n", problem);
}

void print_summary(const Settings& settings, const Configuration& configuration, const ConfigurationResult& result,
                   const Ending& ending) {
  if (ending.configured_already) {
    fmt::print("node {}: configured already, as 1020h says; nothing written\n", settings.node);
    return;
  }
  std::string text = fmt::format("node {}: {} of {} values written, {} verified", settings.node, result.written,
                                 result.values, result.verified);
  if (!result.failures.empty()) text += fmt::format(", {} failed", result.failures.size());
  if (configuration.left_out != 0) text += fmt::format(", {} left out", configuration.left_out);
  if (ending.time_written) text += ", 1020h written";
  if (ending.stored) text += ", stored";
  fmt::print("{}\n", text);
}

void print_json(const Settings& settings, const Configuration& configuration, const ConfigurationResult& result,
                const Ending& ending) {
  Json json{{"version", 1},
            {"node_id", settings.node},
            {"configured_already", ending.configured_already},
            {"values", result.values},
            {"written", result.written},
            {"verified", result.verified},
            {"left_out", configuration.left_out},
            {"time_written", ending.time_written},
            {"stored", ending.stored},
            {"failures", Json::array()},
            {"problems", ending.problems}};
  for (const ConfigurationFailure& failure : result.failures) {
    Json row{{"index", failure.entry.index}, {"sub_index", failure.entry.sub_index}};
    row["name"] = failure.entry.name.empty() ? Json(nullptr) : Json(failure.entry.name);
    const bool placed = failure.value != nullptr && failure.value->position.file != nullptr;
    row["line"] = placed ? Json(failure.value->position.line) : Json(nullptr);
    row["text"] = failure.what;
    json["failures"].push_back(std::move(row));
  }
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

/// Behind all values: when they were made, and that they stay.
void finish(LiveBus& bus, SdoAccess& node, const Settings& settings, const Configuration& configuration,
            Ending& ending) {
  if (configuration.time) {
    const std::string problem = write_configuration_time(node, *configuration.time);
    ending.time_written = problem.empty();
    if (!problem.empty()) ending.problems.push_back("1020h Verify configuration: " + problem);
  }
  if (!settings.store) return;
  SdoSettings patient = settings.sdo;
  patient.timeout_ms = std::max(patient.timeout_ms, shortest_store_ms);
  SdoAccess storing{bus, node.node(), patient};
  std::vector<std::uint8_t> signature(sizeof store_signature);
  std::memcpy(signature.data(), &store_signature, sizeof store_signature);
  const SdoOutcome outcome = storing.download(0x1010, 1, signature);
  ending.stored = outcome.done();
  if (!outcome.done()) ending.problems.push_back("1010h:01 Store parameters: " + failure_text(outcome));
}

int configure(LiveBus& bus, const Settings& settings, const Configuration& configuration,
              const std::vector<ConfigurationStep>& steps) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  if (!settings.keep_state) {
    bus.send_all(canopen::nmt_frame(canopen::NmtCommand::enter_pre_operational, node.node()));
    bus.listen(after_nmt);
  }
  if (!is_right_device(node, settings, configuration)) return exit_device_failed;
  Ending ending;
  ConfigurationResult result;
  ending.configured_already =
      configuration.time && !settings.force && read_configuration_time(node) == configuration.time;
  if (!ending.configured_already) {
    ProgressLine progress;
    result = configure_node(node, steps, [&](std::size_t done, std::size_t of) {
      if (progress.due()) progress.show(fmt::format("node {}: {} of {}", settings.node, done, of));
    });
    if (result.done()) finish(bus, node, settings, configuration, ending);
  }
  const bool fine = result.done() && ending.problems.empty();
  if (fine && settings.start) bus.send_all(canopen::nmt_frame(canopen::NmtCommand::start, node.node()));
  print_failures(result, ending);
  if (settings.format == "json") {
    print_json(settings, configuration, result, ending);
  } else {
    print_summary(settings, configuration, result, ending);
  }
  return fine ? int{exit_fine} : exit_device_failed;
}

int run_configure(const Settings& settings) {
  Configuration configuration;
  const bool read = settings.concise ? read_concise(settings, configuration) : read_dcf(settings, configuration);
  if (!read) return exit_wrong_usage;
  for (const ConfigurationValue& value : configuration.values)
    configuration.left_out += is_left_out(value.entry) ? 1 : 0;
  const auto steps = plan_configuration(configuration.values, configuration.device());
  if (settings.dry_run) {
    print_steps(steps);
    return exit_fine;
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return configure(bus, settings, configuration, steps); });
}

}  // namespace

void add_configure_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("configure", "write the values of a DCF to a node");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  add_node_argument(*command, settings->node);
  command->add_option("FILE", settings->path, "DCF, XDC or, with --concise, concise DCF")->required();
  auto* concise = command->add_flag("--concise", settings->concise, "FILE is a concise DCF, as object 1F22h holds it");
  command->add_option("--eds", settings->sheet, "data sheet for a concise DCF: names, and the identity to check")
      ->type_name("FILE")
      ->needs(concise);
  command->add_flag("--store", settings->store, "let the node store its parameters (1010h) when all went well");
  command->add_flag("--start", settings->start, "start the node when all went well");
  command->add_flag("--keep-state", settings->keep_state, "do not put the node into Pre-operational first");
  command->add_flag("--force", settings->force, "write to another device, and what 1020h says is written already");
  command->add_flag("--dry-run", settings->dry_run, "print the steps and send nothing");
  add_format_option(*command, settings->format);
  add_timeout_option(*command, settings->sdo.timeout_ms);
  command->callback([settings, &exit_code] { exit_code = run_configure(*settings); });
}

}  // namespace edsc
