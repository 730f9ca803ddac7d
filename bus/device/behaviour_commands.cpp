#include "device/behaviour_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "device/entry_text.hpp"
#include "device/io_loop.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"
#include "values/nmt_text.hpp"

namespace edsc {
namespace {

constexpr std::uint8_t generic_error = 0x01;
constexpr std::uint32_t max_emergency_code = 0xFFFF;

CommandAnswer run_set(Behaviour& behaviour, const CommandArguments& arguments) {
  return behaviour.set(*arguments.entry, arguments.bytes);
}

CommandAnswer run_get(Behaviour& behaviour, const CommandArguments& arguments) {
  const Entry& entry = *arguments.entry;
  const auto bytes = behaviour.target().get(entry.index, entry.sub_index);
  if (!bytes) return {false, fmt::format("{:04X}h:{:02X} does not exist in the node", entry.index, entry.sub_index)};
  return {true, value_text(entry, *bytes)};
}

CommandAnswer run_stop(Behaviour& behaviour, const CommandArguments& arguments) {
  return behaviour.stop(*arguments.entry);
}

CommandAnswer run_emcy(Behaviour& behaviour, const CommandArguments& arguments) {
  if (*arguments.code > max_emergency_code) return {false, "an emergency error code has four digits"};
  behaviour.target().emergency(
      static_cast<std::uint16_t>(*arguments.code),
      canopen::ErrorRegister{static_cast<std::uint8_t>(arguments.count.value_or(generic_error))});
  return {};
}

CommandAnswer run_emcy_over(Behaviour& behaviour, const CommandArguments& arguments) {
  behaviour.target().emergency_over(
      canopen::ErrorRegister{static_cast<std::uint8_t>(arguments.count.value_or(generic_error))});
  return {};
}

CommandAnswer run_nmt(Behaviour& behaviour, const CommandArguments& arguments) {
  behaviour.target().request(find_nmt_command(&NmtCommandText::argument, std::string_view{arguments.word})->command);
  return {};
}

CommandAnswer run_power_cycle(Behaviour& behaviour, const CommandArguments& /*arguments*/) {
  behaviour.target().power_cycle();
  return {};
}

CommandAnswer run_can(Behaviour& behaviour, const CommandArguments& arguments) {
  behaviour.target().set_connected(arguments.word == "active");
  return {};
}

CommandAnswer run_fire(Behaviour& behaviour, const CommandArguments& arguments) {
  return behaviour.fire(arguments.word);
}

CommandAnswer run_state(Behaviour& behaviour, const CommandArguments& /*arguments*/) {
  return {true, behaviour.target().state_text()};
}

struct Runner {
  NodeCommandRow row;
  CommandAnswer (*run)(Behaviour&, const CommandArguments&);  ///< null: not by the pattern of its arguments
};

// clang-format off
constexpr Runner runner_table[] = {
    {{"set",         "OBJ VALUE...",                "set a value, as the application of the device does", true},  run_set},
    {{"get",         "OBJ",                         "print a value",                                      false}, run_get},
    {{"stop",        "OBJ",                         "end the generator and the copies of an object",      true},  run_stop},
    {{"emcy",        "CODE [BITS]",                 "report an error, with bits of 1001h (01h)",          true},  run_emcy},
    {{"emcy-over",   "[BITS]",                      "the error is over, and its bits of 1001h (01h)",     true},  run_emcy_over},
    {{"nmt",         "start|stop|pre-operational|reset-node|reset-communication", "an NMT command by local control", true}, run_nmt},
    {{"power-cycle", "",                            "switch off and on",                                  true},  run_power_cycle},
    {{"can",         "off|active",                  "disconnect from the bus, connect again",             true},  run_can},
    {{"fault",       "NAME [ARGUMENTS] [for TIME]", "a fault; fault clear ends all faults",               true},  nullptr},
    {{"loop",        "on|off",                      "wire the outputs of an I/O module (CiA 401) to its inputs", true}, nullptr},
    {{"fire",        "WORD",                        "execute the actions of a rule",                      true},  run_fire},
    {{"script",      "FILE",                        "add a behaviour script",                             false}, nullptr},
    {{"state",       "",                            "print the NMT state and the faults",                 false}, run_state},
    {{"help",        "",                            "print the commands and faults",                      false}, nullptr},
    {{"quit",        "",                            "end edsc node",                                      false}, nullptr},
};
// clang-format on

std::vector<NodeCommandRow> make_rows() {
  std::vector<NodeCommandRow> all;
  for (const Runner& runner : runner_table) all.push_back(runner.row);
  const auto place = std::next(all.begin(), 2);
  std::vector<NodeCommandRow> generators;
  for (const GeneratorKind& kind : generator_kinds())
    generators.push_back({kind.name, kind.arguments, kind.help, true});
  all.insert(place, generators.begin(), generators.end());
  return all;
}

ParsedCommand parse_fault(std::span<const std::string> words, EntryFinder& names) {
  ParsedCommand command;
  if (words.size() == 1 && words[0] == "clear") {
    command.action = [](Behaviour& behaviour) {
      behaviour.target().clear_faults();
      return CommandAnswer{};
    };
    return command;
  }
  NodeFault fault;
  command.problem = read_fault(words, names, fault);
  command.action = [fault](Behaviour& behaviour) {
    behaviour.target().start_fault(fault);
    return CommandAnswer{};
  };
  return command;
}

ParsedCommand parse_loop(std::span<const std::string> words, EntryFinder& names) {
  ParsedCommand command;
  CommandArguments arguments;
  command.problem = read_arguments("on|off", words, names, arguments);
  const std::vector<ValueCopy> copies = io_loop(names);
  if (command.problem.empty() && copies.empty())
    command.problem = "the device does not have an output and an input of CiA 401 with the same number";
  command.action = [copies, is_on = arguments.word == "on"](Behaviour& behaviour) {
    for (const ValueCopy& copy : copies) {
      static_cast<void>(behaviour.stop(*copy.to));
      if (is_on) behaviour.follow(copy);
    }
    return CommandAnswer{};
  };
  return command;
}

ParsedCommand parse_generator(std::span<const std::string> words, EntryFinder& names) {
  ParsedCommand command;
  Generator generator;
  command.problem = read_generator(words, names, generator);
  command.action = [generator](Behaviour& behaviour) {
    behaviour.start(generator);
    return CommandAnswer{};
  };
  return command;
}

void append_help(std::string& text, std::string_view name, std::string_view arguments, std::string_view help) {
  const std::string left = arguments.empty() ? std::string{name} : fmt::format("{} {}", name, arguments);
  fmt::format_to(std::back_inserter(text), "  {:<36} {}\n", left, help);
}

}  // namespace

std::span<const NodeCommandRow> command_rows() {
  static const std::vector<NodeCommandRow> table = make_rows();
  return table;
}

std::string commands_help() {
  std::string text = "Commands:\n";
  for (const NodeCommandRow& row : command_rows()) append_help(text, row.name, row.arguments, row.help);
  text += "Faults:\n";
  for (const NodeFaultRow& row : node_fault_rows()) append_help(text, row.name, row.arguments, row.help);
  return text;
}

std::string read_generator(std::span<const std::string> words, EntryFinder& names, Generator& generator) {
  if (words.empty()) return "the name of a generator is missing";
  generator.kind = find_generator(words[0]);
  if (generator.kind == nullptr) {
    std::vector<std::string_view> all;
    for (const GeneratorKind& kind : generator_kinds()) all.push_back(kind.name);
    return fmt::format("\"{}\" is not a generator{}", printable(words[0]), did_you_mean(words[0], all));
  }
  CommandArguments arguments;
  if (std::string problem = read_arguments(generator.kind->arguments, words.subspan(1), names, arguments);
      !problem.empty())
    return problem;
  generator.entry = arguments.entry;
  std::copy_n(arguments.numbers.begin(), std::min(arguments.numbers.size(), generator.settings.numbers.size()),
              generator.settings.numbers.begin());
  generator.settings.time_us = arguments.time_us.value_or(0);
  generator.interval_us = generator.kind->steps ? *arguments.time_us : arguments.every_us.value_or(default_interval_us);
  return {};
}

ParsedCommand parse_command(std::string_view line, EntryFinder& names) {
  const std::vector<std::string> words = command_words(line);
  ParsedCommand command;
  if (words.empty()) {
    command.problem = "the command is missing";
    return command;
  }
  if (find_generator(words[0]) != nullptr) return parse_generator(words, names);
  const std::span<const std::string> rest = std::span{words}.subspan(1);
  if (words[0] == "fault") return parse_fault(rest, names);
  if (words[0] == "loop") return parse_loop(rest, names);
  const auto* const runner =
      std::ranges::find_if(runner_table, [&](const Runner& one) { return one.row.name == words[0]; });
  if (runner == std::end(runner_table)) {
    std::vector<std::string_view> all;
    for (const NodeCommandRow& row : command_rows()) all.push_back(row.name);
    command.problem = fmt::format("\"{}\" is not a command{}", printable(words[0]), did_you_mean(words[0], all));
    return command;
  }
  CommandArguments arguments;
  const bool is_script = words[0] == "script";
  command.problem = read_arguments(is_script ? "WORD" : runner->row.arguments, rest, names, arguments);
  if (runner->run == nullptr) {
    command.program_command = words[0];
    command.argument = arguments.word;
  } else {
    command.action = [run = runner->run, arguments](Behaviour& behaviour) { return run(behaviour, arguments); };
  }
  return command;
}

}  // namespace edsc
