#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "decode/log/node_silence.hpp"
#include "decode/log/ordered_time.hpp"
#include "decode/log/value_number.hpp"
#include "device/entry_text.hpp"
#include "diagnostics/quote.hpp"
#include "lookup/find_entry.hpp"
#include "monitor/progress_line.hpp"
#include "plot/plot_svg.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/log_options.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"
#include "text/counted.hpp"
#include "text/number_text.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"
#include "values/append.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc plot can0.log position_actual_value --node 5=drive.eds -o position.svg
  edsc plot can0.log 6064h 606Ch 6041h --node 5=drive.eds -o drive.svg    panels by unit, a band of states
  edsc plot trip.asc 5/6064h 6/6064h --node 5=drive.eds --node 6=drive.eds -o axes.svg
  edsc plot can0.log axis1/6064h --network plant.json -o axis1.svg        the node by its name in the network file
  edsc plot capture.pcapng 6064h --node axis1.dcf --title "Axis 1" > axis1.svg)";

struct Settings : LogSettings {
  std::vector<std::string> objects;
  std::string title;
  std::string output;
};

/// An object of a node whose values are plotted.
struct Wanted {
  std::uint8_t node_id = 0;
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  const MaskedGroup* group = nullptr;  ///< of a word: its states are the masked values of the group
  PlotLine line;
};

/// The state of a word that has no masked value of the group.
constexpr std::int64_t no_masked_value = -1;

/// The number of the masked value that the word has.
std::int64_t state_of(const MaskedGroup& group, std::uint64_t word) {
  const MaskedValue* const found = group.find(word);
  return found != nullptr ? found - group.values.data() : no_masked_value;
}

/// Makes a line a band with the names of an enumeration.
void name_states(PlotLine& line, const Enumeration& values) {
  line.is_band = true;
  line.panel = line.name;
  for (const NamedValue& one : values.values) line.state_names.emplace(one.value, one.name);
}

/// Makes a line a band with the names of masked values, such as the states of a drive.
void name_states(PlotLine& line, const MaskedGroup& group) {
  line.is_band = true;
  line.name += " " + group.name;
  line.panel = line.name;
  line.state_names.emplace(no_masked_value, "none");
  for (const MaskedValue& one : group.values) line.state_names.emplace(state_of(group, one.value), one.name);
}

PlotLine line_of(std::uint8_t node_id, const NodeLabels& labels, const Object& object, const Entry& entry) {
  using canopen::DataClass;
  PlotLine line;
  const std::string_view node_name = labels.name(node_id);
  line.name =
      fmt::format("node {} {}{}{} ", node_id, node_name, node_name.empty() ? "" : " ", display_name(object, entry));
  append_entry_label(line.name, object.index, entry.sub_index);
  const Quantity* const quantity = quantity_of(entry);
  if (quantity != nullptr) line.unit = quantity->symbol;
  line.panel = line.unit.empty() ? fmt::format("{:04X}:{:02X}", object.index, entry.sub_index) : "unit " + line.unit;
  line.whole = entry.type->kind != DataClass::real && (quantity == nullptr || quantity->is_raw());
  line.steps = entry.type->kind == DataClass::boolean || (line.whole && line.unit.empty());
  return line;
}

bool is_plain(const Entry& entry) {
  using canopen::DataClass;
  switch (entry.type->kind) {
    case DataClass::boolean:
    case DataClass::unsigned_integer:
    case DataClass::signed_integer:
    case DataClass::real: return true;
    case DataClass::time:
    case DataClass::string:
    case DataClass::domain: break;
  }
  return false;
}

/// A line; for a word with masked values, a band for each group of them.
void add_lines(std::uint8_t node_id, const NodeLabels& labels, const Object& object, const Entry& entry,
               std::vector<Wanted>& wanted) {
  const Meaning* const meaning = meaning_of_integer(entry);
  const Wanted one{node_id, object.index, entry.sub_index, nullptr, line_of(node_id, labels, object, entry)};
  if (meaning == nullptr || meaning->quantity || (!meaning->values && meaning->masked.empty())) {
    wanted.push_back(one);
    return;
  }
  if (meaning->values) {
    wanted.push_back(one);
    name_states(wanted.back().line, *meaning->values);
  }
  for (const MaskedGroup& group : meaning->masked) {
    wanted.push_back(one);
    wanted.back().group = &group;
    name_states(wanted.back().line, group);
  }
}

/// A node by its node-ID, or by its name in the network file or DCF; nothing if there is none. Ends the command for a
/// node-ID that is not given.
std::optional<std::uint8_t> find_node_of(const std::string& text, std::string_view node, const GivenNodes& nodes) {
  const auto is_named = [&](const auto& one) { return nodes.labels.name(one.first) == node; };
  if (const auto named = std::ranges::find_if(nodes.devices, is_named); named != nodes.devices.end()) {
    return named->first;
  }
  const auto node_id = parse_whole<std::uint8_t>(node);
  if (node_id && !nodes.devices.contains(*node_id)) {
    fail(fmt::format("{}: node {} is not one of --node and --network", text, *node_id));
  }
  return node_id;
}

/// `; "drvie" is not a node; did you mean "drive"?`
std::string unknown_node_text(std::string_view node, const GivenNodes& nodes) {
  std::vector<std::string> names;
  for (const auto& [id, one] : nodes.devices) names.emplace_back(nodes.labels.name(id));
  return fmt::format("; {} is not the name of a node{}", quote(node), did_you_mean(node, names));
}

/// `6064h`, of all nodes that have it, `5/6064h` or `axis1/6064h`.
void add_object(const std::string& text, const GivenNodes& nodes, std::vector<Wanted>& wanted) {
  const std::size_t slash = text.find('/');
  const std::string_view node = slash == std::string::npos ? "" : std::string_view{text}.substr(0, slash);
  const std::optional<std::uint8_t> node_id = node.empty() ? std::nullopt : find_node_of(text, node, nodes);
  const std::string name = node_id ? text.substr(slash + 1) : text;
  std::string problem;
  const std::size_t before = wanted.size();
  for (const auto& [id, given] : nodes.devices) {
    if (node_id && id != *node_id) continue;
    const FoundEntry found = find_one_entry(given.named, name);
    if (!found.ok()) {
      problem = found.problem;
      continue;
    }
    if (found.entry->type == nullptr || !is_plain(*found.entry)) {
      problem = fmt::format("{}: the values are not numbers", text);
      continue;
    }
    const bool known = std::ranges::any_of(wanted, [&, id = id](const Wanted& one) {
      return one.node_id == id && one.index == found.object->index && one.sub_index == found.entry->sub_index;
    });
    if (known) fail(fmt::format("{}: the object of node {} is given twice", text, id));
    add_lines(id, nodes.labels, *found.object, *found.entry, wanted);
  }
  if (wanted.size() != before) return;
  fail(node.empty() || node_id ? problem : problem + unknown_node_text(node, nodes));
}

/// PDOs, and the ends of SDO transfers; the request of a write has the value, too, but it may be rejected.
bool has_values(const Message& message) {
  return message.service != Service::sdo || message.step == TransferStep::finished;
}

struct PlottedLog {
  static constexpr std::uint64_t max_shown_steps = 10;

  OrderedTime times;
  std::uint64_t frames = 0, steps_back = 0;

  /// Puts the time of the frame in order.
  void count(LogLine& line, const Settings& settings, std::string& complaints) {
    ++frames;
    if (!line.has_time) return;
    const std::int64_t back_us = times.add(line.microseconds);
    if (back_us > 0 && ++steps_back <= max_shown_steps) {
      complaints += fmt::format("{}:{}: the times go back by {:.3f} s; the plot continues without a gap\n",
                                printable(settings.log_name()), line.number, static_cast<double>(back_us) / 1e6);
    }
    line.microseconds = *times.first_us() + times.now_us();
  }
};

void take_values(const LogLine& line, const Message& message, std::vector<Wanted>& wanted) {
  if (!line.has_time || !has_values(message)) return;
  const std::uint8_t node_id = message.values_node != 0 ? message.values_node : message.node_id;
  for (const MessageValue& value : message.values) {
    for (Wanted& one : wanted) {
      if (one.node_id != node_id || one.index != value.index || one.sub_index != value.sub_index) continue;
      if (one.line.is_band) {
        const auto raw = integer_of(value);
        if (!raw) continue;
        const auto state = one.group != nullptr ? state_of(*one.group, static_cast<std::uint64_t>(*raw)) : *raw;
        one.line.states.add(line.microseconds, state);
        continue;
      }
      if (const auto number = finite_number_of(value)) one.line.series.add(line.microseconds, *number);
    }
  }
}

/// The values of a lost node are not known until its next frame.
void interrupt(std::uint8_t node_id, std::int64_t lost_us, std::vector<Wanted>& wanted) {
  for (Wanted& one : wanted) {
    if (one.node_id == node_id) one.line.interrupt(lost_us);
  }
}

/// Also the master whose EDS the network generates: its 1016h has the times of the other nodes.
std::vector<const Device*> devices_of(const GivenNodes& nodes) {
  std::vector<const Device*> devices;
  for (const KnownNode& node : nodes.known_with_masters()) devices.push_back(node.device);
  return devices;
}

int plot(const Settings& settings) {
  if (!settings.describe_nodes()) fail("--node ID=FILE or --network FILE is missing; the EDS has the objects");
  const GivenNodes nodes = load_given_nodes(settings, settings.color);
  std::vector<Wanted> wanted;
  for (const std::string& text : settings.objects) add_object(text, nodes, wanted);

  NodeSilence silence{devices_of(nodes)};
  LogDecoder decoder{
      nodes.known(), nodes.labels, {settings.log_name(), settings.interface, LogOutput::text, false, {}}};
  PlottedLog log;
  std::string complaints;
  ProgressLine progress;
  const auto print_complaints = [&] {
    if (complaints.empty()) return;
    progress.hide();
    write_to_stderr(complaints);
    complaints.clear();
  };
  const auto use = [&](LogLine& line) {
    const Message* const message = decoder.evaluate(line, complaints);
    if (message == nullptr) return;
    log.count(line, settings, complaints);
    if (line.has_time) {
      const NodeModel* const sender = decoder.decoder().find_model(message->node_id);
      const auto lost = silence.see(*message, sender, line.microseconds);
      if (lost) interrupt(message->node_id, *lost, wanted);
    }
    take_values(line, *message, wanted);
    constexpr std::uint64_t some_frames = 4096;
    if (log.frames % some_frames == 0 && progress.due()) progress.show(counted(log.frames, "frame"));
  };
  const auto fail_if_unreadable = read_log(settings, use, print_complaints);
  decoder.finish(complaints);
  print_complaints();
  progress.hide();
  fail_if_unreadable();
  if (log.frames == 0) fail(settings.log_name() + ": the log has no frames", exit_input_has_errors);
  if (!log.times.first_us()) {
    fail(settings.log_name() + ": the frames have no times; candump writes them with -L or -t a",
         exit_input_has_errors);
  }
  const std::string log_name{file_name_of(settings.log_name())};  // the same plot in each folder
  Plot picture{settings.title.empty() ? log_name : settings.title,
               *log.times.first_us(),
               *log.times.first_us() + log.times.now_us(),
               {}};
  for (Wanted& one : wanted) {
    if (const auto lost = silence.lost_at(one.node_id, picture.last_us)) one.line.interrupt(*lost);
    if (one.line.empty()) {
      print_to_stderr("{}: {} has no values\n", settings.log_name(), one.line.name);
    } else {
      picture.lines.push_back(std::move(one.line));
    }
  }
  if (picture.lines.empty()) throw Exit{exit_input_has_errors};
  write_output(settings.output, plot_svg(picture),
               settings.log == "-" ? std::vector<std::string>{} : std::vector{settings.log});
  return decoder.skipped_lines() ? exit_input_has_errors : exit_fine;
}

}  // namespace

void add_plot_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, plot, exit_code);
  add_log_options(command, settings).required();
  command
      .add_option("OBJECT", settings.objects,
                  "index or name of an object, of all nodes that have it; NODE/OBJECT: of one node, by node-ID or name")
      .required();
  command.add_option("--output", settings.output, "SVG (default: standard output)");
  command.add_option("--title", settings.title, "default: the name of the log, without its folder");
}

}  // namespace edsc
