/// Commands and their options. CLI11 reads the command line; only `command_line.cpp`, the main program and the
/// completions see it, since it takes seconds of each file that includes it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace edsc {

/// What the value of an option or argument is, for completions and the manual page.
struct OptionValueKind {
  enum class Type : std::uint8_t { text, number, folder };

  Type type = Type::text;
  std::vector<std::string> words;  ///< the only values; empty: any
};

[[nodiscard]] OptionValueKind value_kind_of(const CLI::Option& option);

/// An option, a flag or an argument of a command; a handle.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_{&option} {}

  [[nodiscard]] CLI::Option& cli11() const { return *option_; }
  [[nodiscard]] bool is_given() const;
  [[nodiscard]] std::string name() const;

  // These return the option itself.
  Option required(bool is_required = true) const;
  Option needs(Option other) const;
  Option needs(const std::string& other) const;
  Option excludes(Option other) const;
  Option excludes(const std::string& other) const;
  /// `problem` returns what is wrong with a text, or nothing.
  Option check(std::function<std::string(const std::string& text)> problem) const;
  /// A number from `min` to `max`: an int, a double, or one of the unsigned types of add_option.
  template <class Number>
  Option range(Number min, Number max) const;
  Option one_of(const std::vector<std::string>& words) const;
  Option existing_folder() const;
  /// What its value is called in the help.
  Option type_name(const std::string& name) const;
  /// Shows its present value in the help.
  Option show_default() const;
  Option show_default(const std::string& text) const;
  /// Takes one value each time that it is given, not all words that follow it.
  Option one_value_each() const;
  /// The option can be given without a value.
  Option optional_value() const;

 private:
  CLI::Option* option_;
};

/// A command with its options; a handle.
class Command {
 public:
  explicit Command(CLI::App& app) : app_{&app} {}

  [[nodiscard]] CLI::App& cli11() const { return *app_; }

  /// `Value`: a string, a number, an optional number or a list of strings; see the instantiations in
  /// command_line.cpp.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& description) const;
  /// An option whose text `take` gets.
  Option add_text_option(const std::string& name, const std::function<void(const std::string& text)>& take,
                         const std::string& description) const;
  /// The same for a number.
  Option add_number_option(const std::string& name, const std::function<void(unsigned number)>& take,
                           const std::string& description) const;
  Option add_flag(const std::string& name, bool& value, const std::string& description) const;

  /// A subcommand; one of them must be given.
  [[nodiscard]] Command add_subcommand(const std::string& name, const std::string& description) const;
  /// Options of the command around it may follow its own.
  void take_options_of_parent() const;
  [[nodiscard]] Command parent() const;
  /// The lines below the options in the help.
  void footer(const std::string& text) const;
  /// What is called when the command is chosen, after its options have been read.
  void on_chosen(std::function<void()> run) const;

 private:
  CLI::App* app_;
};

// Errors of a command line that only the command can find. Each is reported with the usage.

/// `NAME: PROBLEM`
[[noreturn]] void throw_invalid(const std::string& name, const std::string& problem);
/// `NAME requires OTHER`
[[noreturn]] void throw_requires(const std::string& name, const std::string& other);
/// `NAME is required`
[[noreturn]] void throw_required(const std::string& name);

}  // namespace edsc
