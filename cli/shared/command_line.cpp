#include "shared/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

namespace edsc {
namespace {

using ValueType = OptionValueKind::Type;

/// CLI11 keeps what a value is as text of the help alone.
std::map<const CLI::Option*, OptionValueKind>& value_kinds() {
  static std::map<const CLI::Option*, OptionValueKind> kinds;
  return kinds;
}

template <class Value>
constexpr ValueType type_of = std::is_arithmetic_v<Value> ? ValueType::number : ValueType::text;
template <class Value>
constexpr ValueType type_of<std::optional<Value>> = type_of<Value>;

Option added(CLI::Option& option, ValueType type) {
  value_kinds()[&option] = {type, {}};
  return Option{option};
}

}  // namespace

OptionValueKind value_kind_of(const CLI::Option& option) {
  const auto found = value_kinds().find(&option);
  return found == value_kinds().end() ? OptionValueKind{} : found->second;
}

bool Option::is_given() const { return option_->count() != 0; }
std::string Option::name() const { return option_->get_name(); }

Option Option::required(bool is_required) const { return Option{*option_->required(is_required)}; }
Option Option::needs(Option other) const { return Option{*option_->needs(other.option_)}; }
Option Option::needs(const std::string& other) const { return Option{*option_->needs(other)}; }
Option Option::excludes(Option other) const { return Option{*option_->excludes(other.option_)}; }

Option Option::excludes(const std::string& other) const { return Option{*option_->excludes(other)}; }

Option Option::check(std::function<std::string(const std::string& text)> problem) const {
  return Option{*option_->check(std::move(problem))};
}

template <class Number>
Option Option::range(Number min, Number max) const {
  return Option{*option_->check(CLI::Range(min, max))};
}
template Option Option::range(int, int) const;
template Option Option::range(double, double) const;
template Option Option::range(std::uint32_t, std::uint32_t) const;
template Option Option::range(std::uint64_t, std::uint64_t) const;

Option Option::one_of(const std::vector<std::string>& words) const {
  value_kinds()[option_].words = words;
  return Option{*option_->check(CLI::IsMember(words))};
}
Option Option::existing_folder() const {
  value_kinds()[option_].type = ValueType::folder;
  return Option{*option_->check(CLI::ExistingDirectory)};
}
Option Option::type_name(const std::string& name) const { return Option{*option_->type_name(name)}; }
Option Option::show_default() const { return Option{*option_->capture_default_str()}; }
Option Option::show_default(const std::string& text) const { return Option{*option_->default_str(text)}; }
Option Option::one_value_each() const { return Option{*option_->allow_extra_args(false)}; }
Option Option::optional_value() const { return Option{*option_->expected(0, 1)}; }

template <class Value>
Option Command::add_option(const std::string& name, Value& value, const std::string& description) const {
  return added(*app_->add_option(name, value, description), type_of<Value>);
}
template Option Command::add_option(const std::string&, std::string&, const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint8_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint16_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint32_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::int64_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint32_t>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&) const;

Option Command::add_text_option(const std::string& name, const std::function<void(const std::string& text)>& take,
                                const std::string& description) const {
  return added(*app_->add_option_function<std::string>(name, take, description), ValueType::text);
}

Option Command::add_number_option(const std::string& name, const std::function<void(unsigned number)>& take,
                                  const std::string& description) const {
  return added(*app_->add_option_function<unsigned>(name, take, description), ValueType::number);
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& description) const {
  return added(*app_->add_flag(name, value, description), ValueType::text);
}

Command Command::add_subcommand(const std::string& name, const std::string& description) const {
  app_->require_subcommand(1);
  return Command{*app_->add_subcommand(name, description)};
}

void Command::take_options_of_parent() const { app_->fallthrough(); }
Command Command::parent() const { return Command{*app_->get_parent()}; }
void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::on_chosen(std::function<void()> run) const { app_->callback(std::move(run)); }

void throw_invalid(const std::string& name, const std::string& problem) { throw CLI::ValidationError{name, problem}; }
void throw_requires(const std::string& name, const std::string& other) { throw CLI::RequiresError{name, other}; }
void throw_required(const std::string& name) { throw CLI::RequiredError{name}; }

}  // namespace edsc
