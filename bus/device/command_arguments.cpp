#include "device/command_arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <iterator>
#include <system_error>

#include "device/entry_number.hpp"
#include "device/entry_text.hpp"
#include "text/ascii.hpp"
#include "text/duration.hpp"
#include "text/printable.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::uint64_t shortest_time_us = 1'000;
constexpr unsigned max_pdo_number = 512, max_bytes = 8, max_divisor = 1'000'000;

template <class Number>
std::optional<Number> decimal(std::string_view text, Number least, Number most) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || number < least || number > most) return std::nullopt;
  return number;
}

std::string in_marks(std::string_view text) { return fmt::format("\"{}\"", printable(text)); }

class ArgumentsReader {
 public:
  ArgumentsReader(std::span<const std::string> words, EntryFinder& names, CommandArguments& arguments)
      : words_{words}, names_{names}, arguments_{arguments} {}

  std::string read(std::string_view pattern) {
    bool may_end = false;
    for (std::string part : command_words(pattern)) {
      if (part.starts_with('[')) may_end = true;
      std::erase_if(part, [](char c) { return c == '[' || c == ']'; });
      if (is_interval_) may_end = false;
      if (next_ == words_.size()) return may_end ? "" : fmt::format("{} is missing", part);
      if (std::string problem = take(part); !problem.empty()) return problem;
    }
    return next_ == words_.size() ? "" : fmt::format("{} is not expected", in_marks(words_[next_]));
  }

 private:
  std::string take(const std::string& part) {
    const std::string& word = words_[next_++];
    if (part == "OBJ" || part == "OBJECT") return take_object(word, part == "OBJ");
    if (part == "VALUE...") return take_value();
    if (part == "VALUE" || part == "FROM" || part == "TO" || part == "LOW" || part == "HIGH") return take_number(word);
    if (part == "STEP") {
      const auto step = decimal(word, -1e18, 1e18);
      if (!step) return fmt::format("{} is not a number", in_marks(word));
      arguments_.numbers.push_back(*step);
      return {};
    }
    if (part == "TIME") return take_time(word);
    if (part == "CODE") return take_code(word, 0xFFFF'FFFF);
    if (part == "BITS") return take_code(word, 0xFF);
    if (part == "N") return take_decimal(arguments_.number, word, 1, max_pdo_number);
    if (part == "BYTES") return take_decimal(arguments_.count, word, 0, max_bytes);
    if (part == "1/N") {
      if (!word.starts_with("1/")) return fmt::format("{} is not a fraction such as 1/3", in_marks(word));
      return take_decimal(arguments_.number, std::string_view{word}.substr(2), 1, max_divisor);
    }
    if (part == "WORD") {
      arguments_.word = word;
      return {};
    }
    return take_choice(part, word);
  }

  std::string take_object(const std::string& word, bool is_one) {
    const FoundEntry found = is_one ? names_.find_one(word) : names_.find(word);
    if (!found.ok()) return found.problem;
    arguments_.object = found.object;
    arguments_.entry = found.entry;
    return {};
  }

  std::string take_value() {
    std::string text = words_[next_ - 1];
    while (next_ < words_.size()) text += " " + words_[next_++];
    const ParsedValue value = parse_value_text(*arguments_.entry, text);
    arguments_.bytes = value.bytes;
    return value.problem;
  }

  std::string take_number(const std::string& word) {
    if (!has_number(*arguments_.entry)) return fmt::format("{} is not a number", in_marks(arguments_.entry->name));
    const ParsedValue value = parse_value_text(*arguments_.entry, word);
    if (!value.ok()) return value.problem;
    arguments_.numbers.push_back(*entry_number(*arguments_.entry, value.bytes));
    return {};
  }

  std::string take_time(const std::string& word) {
    const std::optional<std::uint64_t> time = command_time(word);
    if (!time || *time < shortest_time_us) return fmt::format("{} is not {}", in_marks(word), duration_form);
    (is_interval_ ? arguments_.every_us : arguments_.time_us) = time;
    return {};
  }

  std::string take_code(const std::string& word, std::uint32_t max) {
    const std::optional<std::uint32_t> code = command_code(word, max);
    if (!code) return fmt::format("{} is not a hexadecimal code up to {:X}h", in_marks(word), max);
    if (max == 0xFF) {
      arguments_.count = *code;
    } else {
      arguments_.code = code;
    }
    return {};
  }

  static std::string take_decimal(std::optional<unsigned>& to, std::string_view word, unsigned least, unsigned most) {
    to = decimal(word, least, most);
    return to ? "" : fmt::format("{} is not a number from {} to {}", in_marks(word), least, most);
  }

  std::string take_choice(std::string_view part, const std::string& word) {
    std::vector<std::string_view> choices;
    for (std::size_t from = 0; from <= part.size();) {
      const std::size_t to = std::min(part.find('|', from), part.size());
      choices.push_back(part.substr(from, to - from));
      from = to + 1;
    }
    if (std::ranges::find(choices, word) == choices.end()) {
      std::string expected{choices.front()};
      for (std::size_t i = 1; i < choices.size(); ++i) {
        expected.append(i + 1 == choices.size() ? " or " : ", ").append(choices[i]);
      }
      return fmt::format("{} is not {}{}", in_marks(word), expected, did_you_mean(word, choices));
    }
    is_interval_ = word == "every";
    if (!is_interval_) arguments_.word = word;
    return {};
  }

  std::span<const std::string> words_;
  std::size_t next_ = 0;
  EntryFinder& names_;
  CommandArguments& arguments_;
  bool is_interval_ = false;
};

}  // namespace

std::string read_arguments(std::string_view pattern, std::span<const std::string> words, EntryFinder& names,
                           CommandArguments& arguments) {
  return ArgumentsReader{words, names, arguments}.read(pattern);
}

std::vector<std::string> command_words(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t at = 0;;) {
    while (at < line.size() && (is_blank(line[at]) || line[at] == '\r')) ++at;
    if (at == line.size()) return words;
    std::string& word = words.emplace_back();
    if (line[at] == '"') {
      const std::size_t end = std::min(line.find('"', at + 1), line.size());
      word = line.substr(at + 1, end - at - 1);
      at = std::min(end + 1, line.size());
    } else {
      while (at < line.size() && !is_blank(line[at]) && line[at] != '\r') word += line[at++];
    }
  }
}

std::optional<std::uint64_t> command_time(std::string_view text) {
  std::string joined{text};
  std::erase(joined, ' ');
  return parse_duration(joined);
}

std::optional<std::uint32_t> command_code(std::string_view text, std::uint32_t max) {
  std::string digits{text};
  std::erase(digits, ' ');
  if (digits.starts_with("0x") || digits.starts_with("0X")) {
    digits.erase(0, 2);
  } else if (digits.ends_with('h') || digits.ends_with('H')) {
    digits.pop_back();
  }
  std::uint32_t code = 0;
  const char* const end = digits.data() + digits.size();
  const auto [at, error] = std::from_chars(digits.data(), end, code, 16);
  if (error != std::errc{} || at != end || code > max) return std::nullopt;
  return code;
}

}  // namespace edsc
