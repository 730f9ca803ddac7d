#include "shared/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <type_traits>
#include <utility>

#include "diagnostics/quote.hpp"
#include "shared/parse_number.hpp"
#include "system/path.hpp"
#include "text/duration.hpp"

namespace edsc {
namespace {

/// CLI11 keeps what a value is as text of the help alone.
std::map<const CLI::Option*, OptionFacts>& all_facts() {
  static std::map<const CLI::Option*, OptionFacts> facts;
  return facts;
}

template <class Value>
struct NumberOf {
  using type = void;
};
template <class Value>
requires std::is_unsigned_v<Value>
struct NumberOf<Value> {
  using type = Value;
};
template <class Value>
struct NumberOf<std::optional<Value>> {
  using type = Value;
};

bool is_argument(const std::string& name) { return !name.starts_with('-'); }

const CommandOptionRow& row_of(const std::string& name) {
  if (const CommandOptionRow* const row = find_command_option(name)) return *row;
  throw std::logic_error{"the vocabulary does not have " + name};
}

/// `-o,--output`, as CLI11 wants it. In the name of an argument it refuses `=`; `facts_of` has the name as it is shown.
std::string names_of(const std::string& name) {
  if (is_argument(name)) {
    std::string accepted = name;
    std::ranges::replace(accepted, '=', '-');
    return accepted;
  }
  const char short_name = row_of(name).short_name;
  return short_name == 0 ? name : fmt::format("-{},{}", short_name, name);
}

/// The meaning, then the detail.
std::string description_of(const std::string& name, const std::string& detail) {
  if (is_argument(name)) return detail;
  const std::string meaning{row_of(name).meaning};
  return detail.empty() ? meaning : meaning + "; " + detail;
}

Option added(CLI::Option& option, const std::string& name) {
  OptionFacts& facts = all_facts()[&option];
  if (is_argument(name)) {
    const ArgumentRow* const row = find_argument_row(name);
    facts.kind = row != nullptr ? row->kind : OptionValueKind::text;
    facts.value = name;
  } else {
    facts.kind = row_of(name).kind;
    facts.value = row_of(name).value;
  }
  option.type_name(facts.value);
  return Option{option};
}

std::string number_problem(const CLI::Option& option, const std::string& text) {
  const OptionFacts& facts = facts_of(option);
  const auto number = parse_number(text);
  if (number && *number >= facts.min && *number <= facts.max) return {};
  return fmt::format("{} is not a number from {} to {}", quote(text), facts.min, facts.max);
}

/// An option with a number: 31, 0x1F or 1Fh.
Option add_number(CLI::App& app, const std::string& name, std::uint64_t max,
                  const std::function<void(std::uint64_t)>& take, const std::string& detail) {
  CLI::Option& option = *app.add_option_function<std::string>(
      names_of(name), [take](const std::string& text) { take(parse_number(text).value_or(0)); },
      description_of(name, detail));
  const Option handle = added(option, name);
  all_facts()[&option].max = max;
  option.check([&option](const std::string& text) { return number_problem(option, text); });
  return handle;
}

}  // namespace

const OptionFacts& facts_of(const CLI::Option& option) { return all_facts()[&option]; }

bool Option::is_given() const { return option_->count() != 0; }
std::string Option::name() const { return option_->get_positional() ? facts_of(*option_).value : option_->get_name(); }

Option Option::required(bool is_required) const { return Option{*option_->required(is_required)}; }
Option Option::needs(Option other) const { return Option{*option_->needs(other.option_)}; }
Option Option::needs(const std::string& other) const { return Option{*option_->needs(other)}; }
Option Option::excludes(Option other) const { return Option{*option_->excludes(other.option_)}; }

Option Option::excludes(const std::string& other) const { return Option{*option_->excludes(other)}; }

Option Option::check(std::function<std::string(const std::string& text)> problem) const {
  return Option{*option_->check(std::move(problem))};
}

Option Option::range(std::uint64_t min, std::uint64_t max) const {
  all_facts()[option_].min = min;
  all_facts()[option_].max = max;
  return *this;
}
Option Option::one_of(const std::vector<std::string>& words) const {
  all_facts()[option_].words = words;
  return check([words](const std::string& text) {
    const bool is_word = std::ranges::find(words, text) != words.end();
    return is_word ? std::string{} : fmt::format("{} is not one of {}", quote(text), fmt::join(words, ", "));
  });
}
Option Option::suggest(std::vector<std::string> values) const {
  all_facts()[option_].suggestions = std::move(values);
  return *this;
}
Option Option::existing_folder() const {
  return check([](const std::string& text) {
    std::error_code error;
    const bool is_folder = std::filesystem::is_directory(to_native(text), error);
    if (error) return fmt::format("{}: {}", text, error.default_error_condition().message());
    return is_folder ? std::string{} : text + ": not a folder";
  });
}
Option Option::show_default() const {
  OptionFacts& facts = all_facts()[option_];
  if (facts.default_text.empty()) {
    option_->capture_default_str();
    facts.default_text = option_->get_default_str();
  }
  return *this;
}
Option Option::show_default(const std::string& text) const {
  all_facts()[option_].default_text = text;
  return Option{*option_->default_str(text)};
}
Option Option::one_value_each() const {
  all_facts()[option_].repeats = true;
  return Option{*option_->allow_extra_args(false)};
}
Option Option::optional_value() const { return Option{*option_->expected(0, 1)}; }

template <class Value>
Option Command::add_option(const std::string& name, Value& value, const std::string& detail) const {
  using Number = typename NumberOf<Value>::type;
  if constexpr (std::is_void_v<Number>) {
    return added(*app_->add_option(names_of(name), value, description_of(name, detail)), name);
  } else {
    const Option option = add_number(
        *app_, name, std::numeric_limits<Number>::max(),
        [&value](std::uint64_t number) { value = static_cast<Number>(number); }, detail);
    // Kept for show_default, which CLI11 cannot do for an option of a function.
    if constexpr (std::is_same_v<Value, Number>) option.cli11().default_str(fmt::format("{}", value));
    return option;
  }
}
template Option Command::add_option(const std::string&, std::string&, const std::string&) const;
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint8_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint16_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint32_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::uint64_t&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint8_t>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint32_t>&, const std::string&) const;
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&, const std::string&) const;

Option Command::add_text_option(const std::string& name, const std::function<void(const std::string& text)>& take,
                                const std::string& detail) const {
  return added(*app_->add_option_function<std::string>(names_of(name), take, description_of(name, detail)), name);
}

Option Command::add_number_option(const std::string& name, const std::function<void(unsigned number)>& take,
                                  const std::string& detail) const {
  return add_number(
      *app_, name, std::numeric_limits<unsigned>::max(),
      [take](std::uint64_t number) { take(static_cast<unsigned>(number)); }, detail);
}

Option Command::add_duration(const std::string& name, std::uint64_t min_us, std::uint64_t max_us,
                             const std::function<void(std::uint64_t microseconds)>& take_us,
                             const std::string& detail) const {
  return add_text_option(
             name, [take_us](const std::string& text) { take_us(parse_duration(text).value_or(0)); }, detail)
      .check([min_us, max_us](const std::string& text) -> std::string {
        const auto duration = parse_duration(text);
        if (!duration) return fmt::format("{} is not {}", quote(text), duration_form);
        if (*duration >= min_us && *duration <= max_us) return {};
        return fmt::format("{} is not from {} to {}", quote(text), duration_text(min_us), duration_text(max_us));
      });
}

Option Command::add_milliseconds(const std::string& name, unsigned& milliseconds, unsigned min, unsigned max,
                                 const std::string& detail) const {
  constexpr std::uint64_t us_per_ms = 1000;
  return add_duration(
             name, min * us_per_ms, max * us_per_ms,
             [&milliseconds](std::uint64_t us) { milliseconds = static_cast<unsigned>(us / us_per_ms); }, detail)
      .check([](const std::string& text) {
        const bool is_whole = parse_duration(text).value_or(0) % us_per_ms == 0;
        return is_whole ? std::string{} : quote(text) + " has a fraction of a millisecond";
      })
      .show_default(duration_text(milliseconds * us_per_ms));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& detail) const {
  return added(*app_->add_flag(names_of(name), value, description_of(name, detail)), name);
}

Command Command::add_subcommand(const std::string& name, const std::string& description) const {
  app_->require_subcommand(1);
  return Command{*app_->add_subcommand(name, description)};
}

void Command::take_options_of_parent() const { app_->fallthrough(); }
Command Command::parent() const { return Command{*app_->get_parent()}; }
std::string Command::version() const { return app_->version(); }
void Command::footer(const std::string& text) const { app_->footer(text); }
void Command::on_chosen(std::function<void()> run) const { app_->callback(std::move(run)); }

void throw_invalid(const std::string& name, const std::string& problem) { throw CLI::ValidationError{name, problem}; }
void throw_requires(const std::string& name, const std::string& other) { throw CLI::RequiresError{name, other}; }
void throw_required(const std::string& name) { throw CLI::RequiredError{name}; }

}  // namespace edsc
