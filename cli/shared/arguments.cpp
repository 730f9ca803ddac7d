#include "shared/arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "diagnostics/quote.hpp"
#include "shared/command_line.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr const char* bus_forms =
    "socketcan:INTERFACE, slcan:DEVICE[@BIT-RATE], socketcand:HOST:PORT/INTERFACE or simulated:PROGRAM@NODE-ID";

bool is_number_without_unit(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
}

/// `5min` of previous versions.
bool ends_with_old_minutes(std::string_view text) {
  return text.ends_with("min") && text.size() > 3 && text[text.size() - 4] >= '0' && text[text.size() - 4] <= '9';
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }
bool needs_value(const CLI::Option& option) { return option.get_items_expected_min() > 0; }

const char* default_bus() {
  const char* const bus = std::getenv("EDSC_BUS");
  return bus != nullptr && *bus != '\0' ? bus : nullptr;
}

/// Reads the arguments from left to right.
class Reader {
 public:
  Reader(const CLI::App& program, const std::vector<std::string>& words) : words_{words}, levels_{{&program}} {}

  ReadArguments read() {
    while (at_ < words_.size() && !result_.wants_help && !result_.wants_version) take_word();
    if (!result_.wants_help && !result_.wants_version) complete();
    return std::move(result_);
  }

 private:
  /// A command and its subcommands that were chosen so far.
  struct Level {
    const CLI::App* app;
    std::vector<std::string> options = {};
    std::vector<std::string> arguments = {};
    bool has_argument = false;
  };

  [[nodiscard]] const CLI::App& app() const { return *levels_.back().app; }
  [[nodiscard]] std::string path() const { return fmt::format("{}", fmt::join(result_.command, " ")); }
  [[nodiscard]] std::string command_name() const { return result_.command.empty() ? "edsc" : "edsc " + path(); }
  [[nodiscard]] std::string of_command() const { return result_.command.empty() ? "" : " of " + command_name(); }
  [[noreturn]] void fail(const std::string& message) const { throw WrongUsage{message, result_.command}; }

  void take_word() {
    const std::string& word = words_[at_++];
    if (!only_arguments_ && word == "--") {
      only_arguments_ = true;
    } else if (!only_arguments_ && word.starts_with("--")) {
      take_long_option(word);
    } else if (!only_arguments_ && is_short_option(word)) {
      take_short_option(word);
    } else {
      take_argument(word);
    }
  }

  /// `-o`; a negative number is a value.
  static bool is_short_option(const std::string& word) {
    return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9');
  }

  /// The option of the command, or of its parent, whose options may follow those of a subcommand.
  [[nodiscard]] const CLI::Option* find_option(const std::string& name) const {
    for (std::size_t i = levels_.size(); i-- > 0;) {
      if (const CLI::Option* const option = levels_[i].app->get_option_no_throw(name)) return option;
      if (!levels_[i].app->get_fallthrough()) return nullptr;
    }
    return nullptr;
  }

  [[nodiscard]] const OldOptionRow* find_old(std::string_view name) const {
    const std::string command = path();
    const auto applies = [&](const OldOptionRow& row) {
      return row.name == name &&
             (row.command.empty() || row.command == command || command.starts_with(std::string{row.command} + " "));
    };
    const auto found = std::ranges::find_if(old_option_rows(), applies);
    return found == old_option_rows().end() ? nullptr : &*found;
  }

  [[noreturn]] void fail_unknown(const std::string& word) const {
    std::vector<std::string> names;
    for (std::size_t i = levels_.size(); i-- > 0;) {
      for (const CLI::Option* const option : levels_[i].app->get_options()) {
        if (!option->get_positional()) names.push_back(option->get_name());
      }
      if (!levels_[i].app->get_fallthrough()) break;
    }
    fail(fmt::format("unknown option {}{}{}", quote(word), of_command(), did_you_mean(word, names)));
  }

  void take_long_option(const std::string& word) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    std::optional<std::string> value;
    if (equals != word.size()) value = word.substr(equals + 1);
    take_option(word, name, std::move(value));
  }

  void take_short_option(const std::string& word) {
    const std::string name = word.substr(0, 2);
    const CLI::Option* const option = find_option(name);
    if (option == nullptr && find_old(name) == nullptr) fail_unknown(word);
    const std::string rest = word.substr(2);
    if (rest.empty()) {
      take_option(word, name, std::nullopt);
    } else if (option != nullptr && takes_value(*option)) {
      take_option(word, name, rest);
    } else {
      take_short_flags(word);
    }
  }

  /// Several flags, `-iv`. A file name such as `-h.eds` is not an option.
  void take_short_flags(const std::string& word) {
    for (const char letter : word.substr(1)) {
      const CLI::Option* const option = find_option(std::string{'-', letter});
      if (option == nullptr || takes_value(*option) || letter == 'h') {
        fail(fmt::format("unknown option {}{}; write \"-- {}\" for a file of this name", quote(word), of_command(),
                         word));
      }
    }
    add_option(word);
  }

  void add_option(const std::string& word) { levels_.back().options.push_back(word); }
  void add_argument(const std::string& word) { levels_.back().arguments.push_back(word); }

  void take_option(const std::string& word, std::string name, std::optional<std::string> value) {
    const OldOptionRow* const old = find_old(name);
    const bool is_renamed = old != nullptr && old->now != name;
    if (is_renamed) name = old->now;
    const CLI::Option* const option = name.empty() ? nullptr : find_option(name);
    if (option == nullptr && !name.empty()) fail_unknown(word);
    if (option != nullptr && option == app().get_help_ptr()) {
      result_.wants_help = true;
      return;
    }
    if (option != nullptr && option == app().get_version_ptr()) {
      result_.wants_version = true;
      return;
    }
    const bool needs = option == nullptr || needs_value(*option);
    if (value && !needs && !takes_value(*option)) fail(name + " does not take a value");
    const bool is_joined = value.has_value() || !needs;
    if (!value && (needs || takes_value(*option)) && has_value_next(needs, old)) value = words_[at_++];
    if (!value && needs && old != nullptr && !old->value.empty()) {
      note(fmt::format("{} is written \"{} {}\" now", old->name, name, old->value));
      value = old->value;
    }
    if (!value && needs)
      fail(fmt::format("{} needs a value: {} {}", name, name, option != nullptr ? facts_of(*option).value : "VALUE"));
    const std::string before = value.value_or("");
    if (value) *value = present_notation(before, name, option, old);
    if (value && *value != before) {
      note(fmt::format("\"{} {}\" is written \"{} {}\" now", old != nullptr ? old->name : name, before, name, *value));
    } else if (is_renamed) {
      note_new_name(*old);
    }
    if (name.empty()) {  // it has become an argument
      take_argument(*value);
    } else if (is_joined && value && !value->empty() && name.starts_with("--")) {
      add_option(name + "=" + *value);
    } else {
      add_option(name);
      if (value) add_option(*value);
    }
  }

  /// Whether the next word is the value of an option. An old flag has none before the next option.
  [[nodiscard]] bool has_value_next(bool needs, const OldOptionRow* old) const {
    if (at_ == words_.size()) return false;
    const std::string& next = words_[at_];
    if (!needs) return !next.starts_with('-') && !is_bus_address(next);
    return old == nullptr || old->value.empty() || next == old->value || !next.starts_with('-');
  }

  /// Adds the unit to a duration without one, and replaces minutes as they were written.
  static std::string present_notation(std::string value, const std::string& name, const CLI::Option* option,
                                      const OldOptionRow* old) {
    if (option == nullptr) return value;
    const bool has_duration = facts_of(*option).kind == OptionValueKind::duration || name == "--fault";
    if (old != nullptr && !old->unit.empty() && is_number_without_unit(value)) return value.append(old->unit);
    if (has_duration && ends_with_old_minutes(value)) value.erase(value.size() - 2);
    return value;
  }

  static void note_new_name(const OldOptionRow& old) {
    note(old.now.empty() ? fmt::format("the value of {} is written without it now", old.name)
                         : fmt::format("{} is called {} now", old.name, old.now));
  }

  static void note(const std::string& text) { print_to_stderr("edsc: note: {}\n", text); }

  void take_argument(const std::string& word) {
    Level& level = levels_.back();
    if (!level.has_argument) {
      level.has_argument = true;
      if (has_bus(app()) && take_bus(word)) return;
    }
    const auto commands = app().get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); });
    if (commands.empty()) {
      add_argument(word);
      return;
    }
    const auto found = std::ranges::find_if(commands, [&](const CLI::App* one) { return one->get_name() == word; });
    if (found == commands.end()) fail_unknown_command(word, commands);
    result_.command.push_back(word);
    levels_.push_back({*found});
  }

  static std::vector<std::string> names_of(const std::vector<const CLI::App*>& commands) {
    std::vector<std::string> names(commands.size());
    std::ranges::transform(commands, names.begin(), &CLI::App::get_name);
    return names;
  }

  [[noreturn]] void fail_unknown_command(const std::string& word, const std::vector<const CLI::App*>& commands) const {
    const std::vector<std::string> names = names_of(commands);
    fail(fmt::format("unknown command {}{}{}", quote(word), of_command(), did_you_mean(word, names)));
  }

  static bool has_bus(const CLI::App& app) {
    const CLI::Option* const bus = app.get_option_no_throw("BUS");
    return bus != nullptr && bus->get_positional();
  }

  /// Whether help is asked for, which needs no bus.
  [[nodiscard]] bool wants_help_later() const {
    return std::any_of(words_.begin() + static_cast<std::ptrdiff_t>(at_), words_.end(),
                       [](const std::string& word) { return word == "--help" || word == "-h"; });
  }

  /// Whether the word is BUS; otherwise EDSC_BUS is inserted.
  bool take_bus(const std::string& word) {
    if (!is_bus_address(word)) {
      insert_default_bus();
      if (default_bus() == nullptr && !wants_help_later()) {
        fail(fmt::format("{} is not a bus address: write {}; the environment variable EDSC_BUS states the default",
                         quote(word), bus_forms));
      }
      return false;
    }
    add_argument(word);
    return true;
  }

  void insert_default_bus() {
    if (default_bus() == nullptr) return;
    add_argument(default_bus());
  }

  /// At the end: a command that no argument follows, and a missing subcommand.
  void complete() {
    if (has_bus(app()) && !levels_.back().has_argument) insert_default_bus();
    const auto commands = app().get_subcommands([](const CLI::App* one) { return !one->get_name().empty(); });
    if (commands.empty() || result_.command.empty()) {
      assemble();
      return;
    }
    const std::vector<std::string> names = names_of(commands);
    fail(fmt::format("{} needs a command: {}", command_name(), fmt::join(names, ", ")));
  }

  /// Options first: CLI11 rejects a "--" that follows an argument.
  void assemble() {
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const Level& level = levels_[i];
      const bool is_last = i + 1 == levels_.size();
      append(level.options);
      if (is_last && !level.arguments.empty()) {
        if (!takes_arguments(*level.app)) fail("unexpected argument " + quote(level.arguments.front()));
        result_.arguments.emplace_back("--");
      }
      append(level.arguments);
      if (!is_last) result_.arguments.push_back(result_.command[i]);
    }
  }

  static bool takes_arguments(const CLI::App& app) {
    return std::ranges::any_of(app.get_options(), [](const CLI::Option* one) { return one->get_positional(); });
  }

  void append(const std::vector<std::string>& words) {
    result_.arguments.insert(result_.arguments.end(), words.begin(), words.end());
  }

  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  bool only_arguments_ = false;
  std::vector<Level> levels_;
  ReadArguments result_;
};

}  // namespace

bool is_bus_address(const std::string& text) {
  constexpr std::string_view schemes[] = {"socketcan:", "slcan:", "socketcand:", "simulated:"};
  return std::ranges::any_of(schemes, [&](std::string_view scheme) { return text.starts_with(scheme); });
}

ReadArguments read_arguments(const CLI::App& program, const std::vector<std::string>& arguments) {
  return Reader{program, arguments}.read();
}

}  // namespace edsc
