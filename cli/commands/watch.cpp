#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/commands.hpp"
#include "decode/log/ordered_time.hpp"
#include "lookup/find_entry.hpp"
#include "online/elapsed_time.hpp"
#include "online/live_bus.hpp"
#include "shared/arguments.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/given_nodes.hpp"
#include "shared/live_options.hpp"
#include "shared/log_options.hpp"
#include "shared/node_names.hpp"
#include "shared/output.hpp"
#include "shared/with_bus.hpp"
#include "text/counted.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"
#include "watch/alarm_command.hpp"
#include "watch/alarm_report.hpp"
#include "watch/guard.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc watch socketcan:can0 --network plant.json              until Ctrl-C; a line for each alarm
  edsc watch socketcan:can0 --network plant.json --for 1h --format json > alarms.jsonl
  edsc watch bus.log --network plant.json                     the same alarms for a log; exit code 1 if there is one
  edsc watch socketcan:can0 --network plant.json --run 'logger -t can "$EDSC_ALARM $EDSC_ALARM_NODE $EDSC_ALARM_TEXT"'
  edsc watch socketcan:can0 --network plant.json --exit-on nmt-command --exit-on lss-command
  edsc watch socketcan:can0 --network plant.json --allow axis1.6040h --silence pdo-rate
  edsc watch --list-alarms                                    every alarm with its meaning)";

constexpr std::string_view any_alarm = "any";

struct Settings {
  std::string source;  ///< a bus, or the path of a log
  std::string network;
  std::string log_format = automatic_format;
  std::string interface;
  std::string format = "text";
  std::string command_line;
  std::vector<std::string> silence, exit_on, allow;
  std::optional<std::uint64_t> span_us;  ///< of a bus
  std::uint64_t remind_us = 60'000'000;
  bool list_alarms = false;
  ColorOption color;
};

int list_alarms(const Settings& settings) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Rule& rule : watch::alarm_rows) {
    if (settings.format == "text") {
      fmt::print("{:<18}  {:<7}  {}: {}\n", rule.id, to_string(rule.severity), rule.title, rule.explanation);
    }
    rows.push_back({{"id", rule.id},
                    {"severity", to_string(rule.severity)},
                    {"meaning", rule.title},
                    {"advice", rule.explanation}});
  }
  if (settings.format != "text")
    fmt::print("{}\n", json_text(nlohmann::ordered_json{{"schema", 2}, {"alarms", std::move(rows)}}));
  return exit_fine;
}

/// `axis1.6040h`, by the names of the network file.
watch::GuardSettings guard_settings(const Settings& settings, const Network& network) {
  watch::GuardSettings result;
  for (const std::string& text : settings.allow) {
    const std::size_t dot = text.find('.');
    if (dot == std::string::npos) throw_invalid("--allow", "\"" + text + "\" is not NODE.OBJECT, such as axis1.6040h");
    const NetworkNode* const node = network.find(text.substr(0, dot));
    if (node == nullptr) throw_invalid("--allow", network.unknown_node(text.substr(0, dot)));
    EntryFinder finder{node->named()};
    const FoundEntry found = finder.find(text.substr(dot + 1));
    if (!found.ok()) throw_invalid("--allow", found.problem);
    for (const Entry& entry : found.object->entries) {
      if (found.entry != nullptr && &entry != found.entry) continue;
      result.allowed_writes.insert({node->node_id, entry.index, entry.sub_index});
    }
  }
  return result;
}

/// The times of a log: in order for the guard, for the alarms as the log has them.
class LogTimes {
 public:
  /// Adds the time of a frame. Returns how far it goes back, if that is more than disorder; else 0.
  std::int64_t add(std::int64_t us) {
    const std::int64_t back_us = times_.add(us);
    if (back_us > 0) {
      shift_before_us_ = std::exchange(shift_us_, us - ordered_us());
      shifted_since_us_ = ordered_us();
    }
    return back_us;
  }

  /// The time of the last frame, for the guard.
  [[nodiscard]] std::int64_t ordered_us() const { return *times_.first_us() + times_.now_us(); }
  [[nodiscard]] std::int64_t span_us() const { return times_.now_us(); }
  /// A time of the guard, as in the log.
  [[nodiscard]] std::int64_t logged_us(std::int64_t us) const {
    return us + (us < shifted_since_us_ ? shift_before_us_ : shift_us_);
  }

 private:
  OrderedTime times_;
  std::int64_t shift_us_ = 0, shift_before_us_ = 0;
  std::int64_t shifted_since_us_ = 0;  ///< the last step back
};

/// What becomes of the alarms: lines on standard output, commands, and the exit code.
class Alarms {
 public:
  /// `times` of a log; null: the times of the alarms are right.
  explicit Alarms(const Settings& settings, const LogTimes* times = nullptr)
      : settings_{settings},
        times_{times},
        limit_{static_cast<std::int64_t>(settings.remind_us)},
        is_colored_{settings.color.on(stdout)} {
    if (!settings.command_line.empty()) command_ = std::make_unique<watch::AlarmCommand>(settings.command_line);
  }

  void take(watch::Alarm&& alarm) {
    const auto is_named = [&](const std::vector<std::string>& ids) {
      return std::ranges::find(ids, alarm.id.text()) != ids.end();
    };
    if (ended_ || is_named(settings_.silence) || !limit_.passes(alarm)) return;
    ++count_;
    if (times_ != nullptr) alarm.us = times_->logged_us(alarm.us);
    if (settings_.format == "json") {
      fmt::print("{}\n", watch::alarm_json(alarm));
    } else {
      fmt::print("{}\n", watch::alarm_text(alarm, is_colored_));
    }
    flush_output();
    if (command_) command_->run(alarm);
    ended_ = is_named(settings_.exit_on) || std::ranges::find(settings_.exit_on, any_alarm) != settings_.exit_on.end();
  }

  [[nodiscard]] bool ended() const { return ended_; }

  /// Prints what was watched, and returns the exit code.
  [[nodiscard]] int end(std::uint64_t frames, std::int64_t us) const {
    if (settings_.format == "text") {
      print_visibly(stdout, "{}: {} in {:.1f} s: {}\n", settings_.source == "-" ? "<stdin>" : settings_.source,
                    counted(frames, "frame"), static_cast<double>(us) / 1e6,
                    count_ == 0 ? "no alarms" : counted(count_, "alarm"));
    }
    return count_ == 0 ? exit_fine : exit_input_has_errors;
  }

 private:
  const Settings& settings_;
  const LogTimes* times_;
  watch::AlarmLimit limit_;
  bool is_colored_;
  std::unique_ptr<watch::AlarmCommand> command_;
  std::size_t count_ = 0;
  bool ended_ = false;
};

int watch_bus(LiveBus& bus, const Network& network, const Settings& settings) {
  using namespace std::chrono;
  Alarms alarms{settings};
  watch::Guard guard{network, guard_settings(settings, network),
                     [&](watch::Alarm&& alarm) { alarms.take(std::move(alarm)); }};
  const std::int64_t start_us = duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
  constexpr std::int64_t longest_wait_us = 50'000;
  const auto span_us = static_cast<std::int64_t>(settings.span_us.value_or(max_duration_us));
  ElapsedTime elapsed{bus.now()};
  std::uint64_t frames = 0;
  while (!Interruption::noted() && !alarms.ended() && elapsed.us() < span_us) {
    const std::int64_t wait_us = std::min(longest_wait_us, span_us - elapsed.us());
    const auto frame = bus.receive(canopen::Duration{static_cast<std::uint32_t>(wait_us)});
    const canopen::TimePoint present = bus.now();
    elapsed.advance(present);
    if (!frame) {
      guard.pass(start_us + elapsed.us());
      continue;
    }
    ++frames;
    guard.see(*frame, start_us + elapsed.us() - (present - bus.received_at()).count());
  }
  return alarms.end(frames, elapsed.us());
}

int watch_log(const Network& network, const Settings& settings) {
  LogSettings log;
  log.log = settings.source;
  log.log_format = settings.log_format;
  log.interface = settings.interface;
  constexpr std::size_t max_complaints = 50;
  std::size_t complaints = 0;
  constexpr std::size_t max_shown_steps = 10;
  std::size_t steps_back = 0;
  LogTimes times;
  Alarms alarms{settings, &times};
  watch::Guard guard{network, guard_settings(settings, network),
                     [&](watch::Alarm&& alarm) { alarms.take(std::move(alarm)); }};
  std::uint64_t frames = 0;
  const auto use = [&](LogLine& line) {
    if (line.kind == LogLineKind::broken || line.kind == LogLineKind::unreadable) {
      if (++complaints <= max_complaints) {
        print_to_stderr("{}:{}: skipped: {}\n", log.log_name(), line.number, line.problem);
      }
      return;
    }
    const bool is_of_interface =
        settings.interface.empty() || line.interface.empty() || line.interface == settings.interface;
    if (line.kind != LogLineKind::frame || !is_of_interface || alarms.ended()) return;
    if (!line.has_time) fail(log.log_name() + ": the log does not have times", exit_input_has_errors);
    const std::int64_t back_us = times.add(line.microseconds);
    if (back_us > 0 && ++steps_back <= max_shown_steps) {
      print_to_stderr("{}:{}: the times go back by {:.3f} s; the watch continues without a gap\n", log.log_name(),
                      line.number, static_cast<double>(back_us) / 1e6);
    }
    ++frames;
    guard.see(line.frame, times.ordered_us());
  };
  const auto fail_if_unreadable = read_log(log, use, [] { flush_output(); });
  if (frames == 0) {
    fail_if_unreadable();
    fail(log.log_name() + ": the log has no frames", exit_input_has_errors);
  }
  guard.finish();
  const int exit_code = alarms.end(frames, times.span_us());
  fail_if_unreadable();
  return complaints > 0 ? exit_input_has_errors : exit_code;
}

int run_watch(const Settings& settings) {
  if (settings.list_alarms) return list_alarms(settings);
  if (settings.source.empty()) throw_required("SOURCE");
  if (settings.span_us && !is_bus_address(settings.source)) throw_requires("--for", "a bus; a log is read to its end");
  if (is_bus_address(settings.source) && settings.log_format != automatic_format)
    throw_requires("--log-format", "a log");
  if (is_bus_address(settings.source) && !settings.interface.empty()) throw_requires("--interface", "a log");
  for (const std::string& id : settings.exit_on) {
    if (id == any_alarm && std::ranges::all_of(watch::alarm_rows, [&](const Rule& rule) {
          return std::ranges::find(settings.silence, rule.id) != settings.silence.end();
        }))
      throw_invalid("--exit-on", "no alarm is reported, because of --silence");
    if (std::ranges::find(settings.silence, id) == settings.silence.end()) continue;
    throw_invalid("--exit-on", "\"" + id + "\" is not reported, because of --silence");
  }
  const std::string path = network_or_default(settings.network);
  if (path.empty()) throw_required("--network");
  const auto loaded = load_given_network(path, settings.color);
  const Network& network = loaded->network;
  if (!is_bus_address(settings.source)) return watch_log(network, settings);
  return with_bus(settings.source, [&](LiveBus& bus) { return watch_bus(bus, network, settings); });
}

}  // namespace

void add_watch_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_watch, exit_code);
  command.add_option(
      "SOURCE", settings.source,
      "socketcan:can0, slcan:/dev/ttyACM0 or socketcand:127.0.0.1:29536/vcan0; or the file of a log, \"-\" "
      "for standard input");
  add_network_option(command, settings.network);
  add_log_format_options(command, settings.log_format, settings.interface);
  command.add_duration("--for", 10'000, max_duration_us, [&settings](std::uint64_t us) { settings.span_us = us; });
  command.add_option("--allow", settings.allow, "an object allows all its sub-indices").one_value_each();
  take_rules(command.add_option("--silence", settings.silence).one_value_each(), watch::alarm_rows, "--list-alarms");
  std::vector<std::string> alarms{std::string{any_alarm}};
  for (const Rule& rule : watch::alarm_rows) alarms.emplace_back(rule.id);
  command.add_option("--exit-on", settings.exit_on).one_value_each().one_of(alarms);
  command.add_option("--run", settings.command_line,
                     "EDSC_ALARM, EDSC_ALARM_SEVERITY, _TIME, _NODE, _NODE_ID and _TEXT are in its environment");
  command
      .add_duration(
          "--remind", 0, max_duration_us, [&settings](std::uint64_t us) { settings.remind_us = us; },
          "alarms in between are counted")
      .show_default("1m");
  add_format_option(command, settings.format);
  command.add_flag("--list-alarms", settings.list_alarms);
  settings.color.add_to(command);
}

}  // namespace edsc
