#include <fmt/format.h>

#include <canopen/nmt/error_control.hpp>
#include <canopen/nmt_master/nmt_master.hpp>
#include <cstring>
#include <nlohmann/json.hpp>

#include "commands/commands.hpp"
#include "configure/configure_node.hpp"
#include "diagnostics/place.hpp"
#include "eds/number.hpp"
#include "format/concise_dcf.hpp"
#include "format/configured_values.hpp"
#include "monitor/progress_line.hpp"
#include "online/identity.hpp"
#include "online/live_bus.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
#include "shared/live_device.hpp"
#include "shared/live_options.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc configure socketcan:can0 5 axis1.dcf --dry-run           the differences and the steps; nothing is written
  edsc configure socketcan:can0 5 axis1.dcf                     write what differs, read it back
  edsc configure socketcan:can0 5 axis1.dcf --store --start     store the parameters, then start the node
  edsc configure socketcan:can0 5 axis1.dcf --all               write all ParameterValues
  edsc configure socketcan:can0 5 axis1.bin --concise --eds drive.eds
  edsc format drive.eds --dcf --node-id 5 -o axis1.dcf          make the DCF)";

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
  bool all = false;
  bool node_id_and_bit_rate = false;
  bool dry_run = false;
  std::string format = "text";
  SdoSettings sdo;
};

/// The values to write, and the data to which they point.
struct Configuration {
  std::unique_ptr<LoadedDevice> loaded;    ///< null: a concise DCF without EDS
  std::vector<std::uint8_t> stream;        ///< of a concise DCF
  std::vector<ConfigurationValue> values;  ///< except those that are left out
  std::size_t left_out = 0;
  std::optional<ConfigurationTime> time;  ///< of 1020h

  [[nodiscard]] const Device* device() const { return loaded ? &*loaded->device : nullptr; }
};

/// A value that differs from that of the node.
struct Change {
  ConfigurationValue value;
  std::optional<std::vector<std::uint8_t>> before;  ///< nothing if it cannot be read
};

/// The values to write to the node.
struct Work {
  std::size_t compared = 0;
  std::vector<Change> changes;             ///< of the compared values
  std::vector<Change> withheld;            ///< node-ID and bit rate, without the flag
  std::vector<ConfigurationValue> values;  ///< to write
};

/// The result of a run other than its values.
struct Ending {
  std::string not_compared;  ///< numbers of the identity
  bool nothing_differs = false;
  bool time_written = false;
  bool stored = false;
  std::vector<std::string> problems;
};

using Json = nlohmann::ordered_json;

constexpr std::uint32_t store_signature = 0x6576'6173;  ///< "save"
constexpr unsigned shortest_store_ms = 5'000;           ///< a device may erase flash before it answers
constexpr canopen::Duration after_nmt = canopen::from_milliseconds(10);

bool refuse(const std::string& sentence) {
  print_visibly(stderr, "edsc: {}\n", sentence);
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
    return refuse(settings.path + " is not a DCF; \"edsc format --dcf\" makes one from an EDS");
  }
  Diagnostics diagnostics;
  const auto values = configured_values(configuration.loaded->sheet, *configuration.device(), diagnostics);
  print_findings(stderr, diagnostics, ColorOption{});
  if (diagnostics.errors() > 0) return false;
  for (const ConfiguredValue& value : values) {
    configuration.values.push_back({live_entry(configuration.device(), value.entry->index, value.entry->sub_index),
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
  if (!entries) return refuse(settings.path + " is not a concise DCF: its length does not match its contents");
  for (const ConciseEntry& entry : *entries) {
    configuration.values.push_back(
        {live_entry(configuration.device(), entry.index, entry.sub_index), {entry.data.begin(), entry.data.end()}, {}});
  }
  return true;
}

/// Removes values that are never written.
void leave_out(Configuration& configuration) {
  configuration.left_out =
      std::erase_if(configuration.values, [](const ConfigurationValue& value) { return is_left_out(value.entry); });
}

std::string_view verb_of(StepKind kind) {
  switch (kind) {
    case StepKind::write: return "write";
    case StepKind::switch_off: return "switch off";
    case StepKind::switch_on: return "switch on";
    case StepKind::clear: return "clear";
    case StepKind::restore: return "restore";
  }
  return {};
}

/// The value; of many bytes without a type, the first ones.
std::string shown(const LiveEntry& entry, const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t max_bytes = 32;
  if (entry.type != nullptr || bytes.size() <= max_bytes) return value_of(entry, bytes);
  LiveEntry domain = entry;
  set_type(domain, *canopen::find_data_type(static_cast<std::uint32_t>(canopen::DataType::domain)));
  return value_of(domain, bytes);
}

std::string written_by(const ConfigurationStep& step) {
  switch (step.kind) {
    case StepKind::write: return " = " + shown(step.entry, step.bytes);
    case StepKind::switch_on: return step.bytes.empty() ? " as before" : " = " + shown(step.entry, step.bytes);
    case StepKind::restore:
      return step.bytes.empty() ? " as before" : fmt::format(" as before, at least {}", shown(step.entry, step.bytes));
    case StepKind::switch_off:
    case StepKind::clear: break;
  }
  return {};
}

void print_steps(const std::vector<ConfigurationStep>& steps) {
  for (const ConfigurationStep& step : steps) {
    print_visibly(stdout, "{:<10}  {}{}\n", verb_of(step.kind), title(step.entry), written_by(step));
  }
}

std::string text_before(const Change& change) {
  if (change.before) return shown(change.value.entry, *change.before);
  const Entry* entry = change.value.entry.entry;
  return entry != nullptr && !canopen::readable(entry->access) ? "(write-only)" : "(cannot be read)";
}

std::string change_text(const Change& change) {
  return fmt::format("{}: {} -> {}", title(change.value.entry), text_before(change),
                     shown(change.value.entry, change.value.bytes));
}

void print_withheld(const Work& work, bool compared) {
  for (const Change& change : work.withheld) {
    const std::string what = compared
                                 ? change_text(change)
                                 : title(change.value.entry) + " = " + shown(change.value.entry, change.value.bytes);
    print_visibly(
        stderr, "edsc: not written, the node's own node-ID or bit rate: {} (--node-id-and-bit-rate writes it)\n", what);
  }
}

void enter_pre_operational(LiveBus& bus, const SdoAccess& node) {
  bus.send_all(canopen::nmt_frame(canopen::NmtCommand::enter_pre_operational, node.node()));
  bus.listen(after_nmt);
}

/// Whether the DCF is for this node, if it states a node-ID. Reports a DCF for another node.
bool is_for_this_node(const Settings& settings, const Configuration& configuration) {
  if (settings.force || !configuration.loaded) return true;
  const auto meant = parse_unsigned(configuration.loaded->sheet.commissioning.node_id.text);
  if (!meant || *meant == settings.node) return true;
  return refuse(fmt::format("{} is for node {}, not for node {} (--force writes anyway)",
                            settings.concise ? settings.sheet : settings.path, *meant, settings.node));
}

/// Whether the identities of the node and the DCF match. Reports differences. A node that does not answer may be in
/// Stopped.
bool is_right_device(LiveBus& bus, SdoAccess& node, const Settings& settings, const Configuration& configuration,
                     Ending& ending) {
  SdoOutcome first = node.upload(0x1000, 0);
  if (first.end == SdoEnd::no_answer && !settings.keep_state && !settings.dry_run) {
    enter_pre_operational(bus, node);
    first = node.upload(0x1000, 0);
  }
  if (first.end == SdoEnd::no_answer) return refuse(fmt::format("node {} does not answer", settings.node));
  if (settings.force) return true;
  if (configuration.device() == nullptr) {
    ending.not_compared = "identity (a concise DCF does not state it; --eds names the EDS of the device)";
    return true;
  }
  const NodeCheck check = check_node(node, *configuration.device(), settings.concise ? settings.sheet : settings.path);
  ending.not_compared = check.not_compared;
  return check.problem.empty() || refuse(check.problem + "; --force writes anyway");
}

std::string place_of_value(const ConfigurationValue* value) {
  if (value == nullptr || value->position.file == nullptr) return "edsc: ";
  const Place place = place_of(value->position);
  return fmt::format("{}:{}:{}: error: ", place.file, place.line, place.column);
}

void print_failures(const ConfigurationResult& result, const Ending& ending) {
  for (const ConfigurationFailure& failure : result.failures) {
    const std::string wanted = failure.value == nullptr ? "" : " = " + shown(failure.entry, failure.value->bytes);
    print_visibly(stderr, "{}{}{}: {}\n", place_of_value(failure.value), title(failure.entry), wanted, failure.what);
  }
  for (const std::string& problem : ending.problems) print_visibly(stderr, "edsc: {}\n", problem);
}

std::string compared_text(const Work& work) {
  const auto unknown = static_cast<std::size_t>(
      std::ranges::count_if(work.changes, [](const Change& change) { return !change.before.has_value(); }));
  const std::size_t differing = work.changes.size() - unknown;
  std::string text =
      fmt::format("{} of {} {}", differing, counted(work.compared, "value"), differing == 1 ? "differs" : "differ");
  if (unknown != 0) text += fmt::format(", {} cannot be compared", unknown);
  return text;
}

void print_summary(const Settings& settings, const Configuration& configuration, const Work& work,
                   const ConfigurationResult& result, const Ending& ending) {
  std::string text = fmt::format("node {}: ", settings.node);
  if (!settings.all) text += compared_text(work);
  if (settings.dry_run) {
    text += "; nothing written";
  } else if (settings.all || result.values != 0) {
    text += fmt::format("{}{} of {} written, {} verified", settings.all ? "" : "; ", result.written,
                        counted(result.values, "value"), result.verified);
  }
  if (!result.failures.empty()) text += fmt::format(", {} failed", result.failures.size());
  if (configuration.left_out != 0) text += fmt::format(", {} left out", configuration.left_out);
  if (!work.withheld.empty()) text += fmt::format(", {} not written (node-ID, bit rate)", work.withheld.size());
  if (ending.time_written) text += ", 1020h written";
  if (ending.stored) text += ", stored";
  print_visibly(stdout, "{}\n", text);
}

Json entry_json(const LiveEntry& entry, const ConfigurationValue* value) {
  Json row{{"index", entry.index}, {"sub_index", entry.sub_index}};
  row["name"] = entry.name.empty() ? Json(nullptr) : Json(entry.name);
  const bool placed = value != nullptr && value->position.file != nullptr;
  row["line"] = placed ? Json(value->position.line) : Json(nullptr);
  return row;
}

Json changes_json(const std::vector<Change>& changes) {
  Json rows = Json::array();
  for (const Change& change : changes) {
    Json row = entry_json(change.value.entry, &change.value);
    row["before"] = change.before ? Json(shown(change.value.entry, *change.before)) : Json(nullptr);
    row["wanted"] = shown(change.value.entry, change.value.bytes);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json steps_json(const std::vector<ConfigurationStep>& steps) {
  Json rows = Json::array();
  for (const ConfigurationStep& step : steps) {
    Json row = entry_json(step.entry, step.value);
    row["action"] = verb_of(step.kind);
    const bool has_value = step.kind != StepKind::switch_off && step.kind != StepKind::clear && !step.bytes.empty();
    row["value"] = !has_value ? Json(nullptr) : Json(shown(step.entry, step.bytes));
    rows.push_back(std::move(row));
  }
  return rows;
}

void print_json(const Settings& settings, const Configuration& configuration, const Work& work,
                const std::vector<ConfigurationStep>& steps, const ConfigurationResult& result, const Ending& ending) {
  Json json{{"version", 1},
            {"node_id", settings.node},
            {"dry_run", settings.dry_run},
            {"configured_already", ending.nothing_differs},
            {"compared", work.compared},
            {"changes", changes_json(work.changes)},
            {"withheld", changes_json(work.withheld)},
            {"steps", settings.dry_run ? steps_json(steps) : Json::array()},
            {"values", result.values},
            {"written", result.written},
            {"verified", result.verified},
            {"left_out", configuration.left_out},
            {"time_written", ending.time_written},
            {"stored", ending.stored},
            {"failures", Json::array()},
            {"problems", ending.problems}};
  for (const ConfigurationFailure& failure : result.failures) {
    Json row = entry_json(failure.entry, failure.value);
    row["text"] = failure.what;
    json["failures"].push_back(std::move(row));
  }
  fmt::print("{}\n", json_text(json));
}

/// After all values: writes 1020h and stores the parameters.
void finish(SdoAccess& node, const Settings& settings, const Configuration& configuration, bool complete,
            Ending& ending) {
  if (complete && configuration.time && (settings.all || read_configuration_time(node) != configuration.time)) {
    const std::string problem = write_configuration_time(node, *configuration.time);
    ending.time_written = problem.empty();
    if (!problem.empty()) ending.problems.push_back("1020h Verify configuration: " + problem);
  }
  if (!settings.store) return;
  node.set_timeout(std::max(settings.sdo.timeout_ms, shortest_store_ms));
  std::vector<std::uint8_t> signature(sizeof store_signature);
  std::memcpy(signature.data(), &store_signature, sizeof store_signature);
  const SdoOutcome outcome = node.download(0x1010, 1, signature);
  ending.stored = outcome.done();
  if (!outcome.done()) ending.problems.push_back("1010h:01 Store parameters: " + failure_text(outcome));
}

/// Detects the boot-up message of the node.
class RestartWatch {
 public:
  RestartWatch(LiveBus& bus, std::uint8_t node) : bus_{bus} {
    bus.on_frame = [this, node](const canopen::Frame& frame, canopen::TimePoint) {
      const auto message = canopen::error_control_message(frame);
      if (!message || message->node_id.value() != node) return;
      if (message->state == canopen::NmtState::initialisation) restarted_ = true;
    };
  }
  ~RestartWatch() { bus_.on_frame = nullptr; }
  RestartWatch(const RestartWatch&) = delete;
  RestartWatch& operator=(const RestartWatch&) = delete;

  [[nodiscard]] bool restarted() const { return restarted_; }

 private:
  LiveBus& bus_;
  bool restarted_ = false;
};

/// All values except node-ID and bit rate, which require their option.
Work all_values(const Settings& settings, const Configuration& configuration) {
  Work work;
  for (const ConfigurationValue& value : configuration.values) {
    if (sets_node_id_or_bit_rate(value.entry) && !settings.node_id_and_bit_rate) {
      work.withheld.push_back({value, {}});
    } else {
      work.values.push_back(value);
    }
  }
  return work;
}

/// The values that differ from those of the node; nothing if it stops answering.
std::optional<Work> what_differs(SdoAccess& node, const Settings& settings, const Configuration& configuration,
                                 const ConfigurationHooks& hooks) {
  Comparison comparison = compare_configuration(node, configuration.values, hooks);
  if (comparison.lost) return std::nullopt;
  Work work;
  std::vector<bool> differs(configuration.values.size());
  for (std::size_t i = 0; i < differs.size(); ++i) {
    ComparedValue& compared = comparison.values[i];
    const ConfigurationValue& value = configuration.values[i];
    if (has_effect(value, configuration.values)) ++work.compared;
    if (!compared.differs) continue;
    Change change{value, {}};
    if (compared.known()) change.before = std::move(compared.found.bytes);
    differs[i] = !sets_node_id_or_bit_rate(value.entry) || settings.node_id_and_bit_rate;
    (differs[i] ? work.changes : work.withheld).push_back(std::move(change));
  }
  work.values = values_to_write(configuration.values, differs);
  return work;
}

int configure(LiveBus& bus, const Settings& settings, const Configuration& configuration) {
  SdoAccess node{bus, canopen::NodeId{settings.node}, settings.sdo};
  const RestartWatch watch{bus, settings.node};
  Ending ending;
  if (!is_right_device(bus, node, settings, configuration, ending)) return exit_device_failed;
  if (!ending.not_compared.empty()) {
    print_visibly(stderr, "edsc: node {}: not compared: {}\n", settings.node, ending.not_compared);
  }
  ConfigurationHooks hooks{{}, [&] { return watch.restarted(); }};
  /// Shows the progress.
  const auto with_progress = [&](std::string_view doing, const auto& work) {
    ProgressLine progress;
    hooks.progress = [&](std::size_t done, std::size_t of) {
      if (progress.due()) progress.show(fmt::format("node {}: {} of {} {}", settings.node, done, of, doing));
    };
    return work();
  };
  const std::optional<Work> work =
      settings.all ? all_values(settings, configuration)
                   : with_progress("compared", [&] { return what_differs(node, settings, configuration, hooks); });
  if (!work) {
    refuse(fmt::format("node {} no longer answers; nothing written", settings.node));
    return exit_device_failed;
  }
  const bool text = settings.format == "text";
  const auto steps = plan_configuration(work->values, configuration.device());
  if (text) {
    for (const Change& change : work->changes) print_visibly(stdout, "{}\n", change_text(change));
    std::fflush(stdout);
  }
  print_withheld(*work, !settings.all);
  ending.nothing_differs = !settings.all && work->changes.empty() && work->withheld.empty();
  ConfigurationResult result;
  if (settings.dry_run) {
    if (text && !steps.empty()) print_visibly(stdout, "steps:\n");
    if (text) print_steps(steps);
  } else {
    if (!steps.empty() && !settings.keep_state) enter_pre_operational(bus, node);
    result = with_progress("done", [&] { return configure_node(node, steps, hooks); });
    if (result.done()) finish(node, settings, configuration, work->withheld.empty(), ending);
    if (watch.restarted()) {
      ending.problems.push_back(fmt::format(
          "node {} restarted meanwhile: it may have lost what was written before; configure it again", settings.node));
    }
  }
  const bool fine = result.done() && ending.problems.empty();
  if (fine && settings.start && !settings.dry_run) {
    bus.send_all(canopen::nmt_frame(canopen::NmtCommand::start, node.node()));
  }
  print_failures(result, ending);
  if (text) {
    print_summary(settings, configuration, *work, result, ending);
  } else {
    print_json(settings, configuration, *work, steps, result, ending);
  }
  return fine ? exit_fine : exit_device_failed;
}

int run_configure(const Settings& settings) {
  Configuration configuration;
  const bool read = settings.concise ? read_concise(settings, configuration) : read_dcf(settings, configuration);
  if (!read) return exit_wrong_usage;
  if (!is_for_this_node(settings, configuration)) return exit_device_failed;
  leave_out(configuration);
  if (settings.dry_run && settings.all) {
    const Work work = all_values(settings, configuration);
    const auto steps = plan_configuration(work.values, configuration.device());
    if (settings.format == "json") {
      print_json(settings, configuration, work, steps, {}, {});
    } else {
      print_steps(steps);
    }
    print_withheld(work, false);
    return exit_fine;
  }
  return with_bus(settings.bus, [&](LiveBus& bus) { return configure(bus, settings, configuration); });
}

}  // namespace

void add_configure_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("configure", "write the values of a DCF that differ from those of a node");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  add_bus_argument(*command, settings->bus);
  add_node_argument(*command, settings->node);
  command->add_option("FILE", settings->path, "DCF, XDC or, with --concise, concise DCF")->required();
  auto* concise = command->add_flag("--concise", settings->concise, "FILE is a concise DCF, as object 1F22h holds it");
  command->add_option("--eds", settings->sheet, "EDS for a concise DCF: names, and the identity to check")
      ->type_name("FILE")
      ->needs(concise);
  command->add_flag("--store", settings->store,
                    "store the parameters of the node (1010h) after a successful configuration");
  command->add_flag("--start", settings->start, "start the node after a successful configuration");
  command->add_flag("--keep-state", settings->keep_state, "do not set the node to Pre-operational first");
  command->add_flag("--all", settings->all, "write all values, not only those that differ from the node's");
  command->add_flag("--node-id-and-bit-rate", settings->node_id_and_bit_rate,
                    "also write the node's own node-ID and bit rate");
  command->add_flag("--force", settings->force, "write even if the device does not match");
  command->add_flag("--dry-run", settings->dry_run,
                    "print the differences and the steps without writing; with --all all steps, without the bus");
  add_format_option(*command, settings->format);
  add_timeout_option(*command, settings->sdo.timeout_ms);
  command->callback([settings, &exit_code] { exit_code = run_configure(*settings); });
}

}  // namespace edsc
