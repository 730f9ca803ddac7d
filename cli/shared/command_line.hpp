/// Commands and their options. CLI11 reads the command line; only `command_line.cpp`, the main program and the
/// completions see it, since it takes seconds of each file that includes it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shared/vocabulary.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace edsc {

/// What the help, completions and the manual page state of an option or argument.
struct OptionFacts {
  OptionValueKind kind = OptionValueKind::text;
  std::string value;                     ///< what its value is called; empty for a flag
  std::vector<std::string> words;        ///< the only values; empty: any
  std::vector<std::string> suggestions;  ///< values for completions, where there are others too
  std::string default_text;              ///< its value if it is not given; empty: not shown
  bool repeats = false;                  ///< it may be given more than once
  std::uint64_t min = 0;                 ///< of a number
  std::uint64_t max = 0;
};

[[nodiscard]] const OptionFacts& facts_of(const CLI::Option& option);

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
  /// A number from `min` to `max`.
  Option range(std::uint64_t min, std::uint64_t max) const;
  Option one_of(const std::vector<std::string>& words) const;
  Option existing_folder() const;
  /// Values that completions offer.
  Option suggest(std::vector<std::string> values) const;
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

  // The name, `--output`, is that of a row of the vocabulary, which states the meaning of the option; `detail` is what
  // it means in this command in addition. A name without dashes is an argument, and `detail` its description.

  /// `Value`: a string, an unsigned number, an optional one or a list of strings; see the instantiations in
  /// command_line.cpp.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& detail = "") const;
  /// An option whose text `take` gets.
  Option add_text_option(const std::string& name, const std::function<void(const std::string& text)>& take,
                         const std::string& detail = "") const;
  /// The same for a number.
  Option add_number_option(const std::string& name, const std::function<void(unsigned number)>& take,
                           const std::string& detail = "") const;
  /// A duration from `min_us` to `max_us`, which `take_us` gets in microseconds.
  Option add_duration(const std::string& name, std::uint64_t min_us, std::uint64_t max_us,
                      const std::function<void(std::uint64_t microseconds)>& take_us,
                      const std::string& detail = "") const;
  /// A duration of whole milliseconds; the help shows its present value.
  Option add_milliseconds(const std::string& name, unsigned& milliseconds, unsigned min, unsigned max,
                          const std::string& detail = "") const;
  Option add_flag(const std::string& name, bool& value, const std::string& detail = "") const;

  /// A subcommand; one of them must be given.
  [[nodiscard]] Command add_subcommand(const std::string& name, const std::string& description) const;
  /// Options of the command around it may follow its own.
  void take_options_of_parent() const;
  [[nodiscard]] Command parent() const;
  /// Of the program: `edsc 1.0`.
  [[nodiscard]] std::string version() const;
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
