#include "diagnostics/json_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnostics/quote.hpp"

namespace edsc {
namespace {

using Json = JsonFile::Json;
using Pointer = JsonFile::Pointer;

/// The place of a byte, for ascending bytes.
class PlaceCounter {
 public:
  explicit PlaceCounter(const SourceFile& source) : source_{source} {}

  [[nodiscard]] Position at(std::size_t byte, std::size_t length) {
    const std::string_view text = source_.text();
    for (; byte_ < std::min(byte, text.size()); ++byte_) {
      if (text[byte_] != '\n') continue;
      ++line_;
      line_start_ = byte_ + 1;
    }
    return {&source_, line_, static_cast<std::uint32_t>(byte - line_start_) + 1, static_cast<std::uint32_t>(length)};
  }

 private:
  const SourceFile& source_;
  std::size_t byte_ = 0;
  std::size_t line_start_ = 0;
  std::uint32_t line_ = 1;
};

/// The message of the parser without its position and number, which precede a colon.
std::string_view reason(std::string_view message) {
  const std::size_t colon = message.find(": ");
  return colon == std::string_view::npos ? message : message.substr(colon + 2);
}

/// The message without its number, which brackets enclose.
std::string_view without_number(std::string_view message) {
  const std::size_t bracket = message.find("] ");
  return bracket == std::string_view::npos ? message : message.substr(bracket + 2);
}

struct DuplicateMember {
  std::string name;
  Position position;
  Position first;
};

/// Finds the places of all values in a valid JSON text.
class JsonPlaceScanner {
 public:
  JsonPlaceScanner(const SourceFile& source, JsonPlaces& places)
      : places_{places}, text_{source.text()}, counter_{source} {}

  /// Returns the members whose name occurred before in their object; the parser uses the last one.
  std::vector<DuplicateMember> scan() {
    while (skip_blanks()) {
      switch (text_[at_]) {
        case '{':
        case '[': open(); break;
        case '}':
        case ']': close(); break;
        case ',': next(); break;
        case '"': string(); break;
        default: word(); break;
      }
    }
    return std::move(duplicates_);
  }

 private:
  struct Level {
    bool is_array = false;
    bool is_duplicate = false;  ///< below a member that is a duplicate
    std::size_t element = 0;
    std::string name;  ///< of the member
    Position name_position;
  };

  /// Skips blanks and comments; false at the end.
  bool skip_blanks() {
    while (at_ < text_.size()) {
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("//")) {
        at_ += std::min(rest.find('\n'), rest.size());
      } else if (rest.starts_with("/*")) {
        const std::size_t end = rest.find("*/", 2);
        at_ += end == std::string_view::npos ? rest.size() : end + 2;
      } else if (std::string_view{" \t\r\n"}.find(text_[at_]) != std::string_view::npos) {
        ++at_;
      } else {
        return true;
      }
    }
    return false;
  }

  void open() {
    const bool is_duplicate = record(at_, 1);
    levels_.push_back({text_[at_] == '[', is_duplicate, 0, {}, {}});
    ++at_;
  }

  void close() {
    if (!levels_.empty()) levels_.pop_back();
    ++at_;
  }

  void next() {
    if (!levels_.empty()) ++levels_.back().element;
    ++at_;
  }

  void string() {
    const std::size_t start = at_;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    at_ = std::min(at_ + 1, text_.size());
    const std::size_t length = at_ - start;
    if (skip_blanks() && text_[at_] == ':' && !levels_.empty()) {
      ++at_;
      Level& level = levels_.back();
      level.name = Json::parse(text_.substr(start, length)).get<std::string>();
      level.name_position = counter_.at(start, length);
    } else {
      record(start, length);
    }
  }

  void word() {
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_of(",]} \t\r\n/", at_), text_.size());
    record(start, at_ - start);
  }

  /// Whether the value belongs to a member that is a duplicate. The parser uses the last one, and so do the places.
  bool record(std::size_t start, std::size_t length) {
    if (levels_.size() > JsonFile::max_depth) return true;
    Pointer pointer;
    for (const Level& level : levels_) {
      if (level.is_array) {
        pointer.push_back(std::to_string(level.element));
      } else {
        pointer.push_back(level.name);
      }
    }
    const Position value = counter_.at(start, length);
    const bool is_member = !levels_.empty() && !levels_.back().is_array;
    const Position name = is_member ? levels_.back().name_position : value;
    const auto [at, is_new] = places_.try_emplace(pointer.to_string(), JsonPlace{name, value});
    if (is_new) return !levels_.empty() && levels_.back().is_duplicate;
    if (!levels_.back().is_duplicate) duplicates_.push_back({levels_.back().name, name, at->second.name});
    at->second = {name, value};
    return true;
  }

  JsonPlaces& places_;
  std::string_view text_;
  PlaceCounter counter_;
  std::size_t at_ = 0;
  std::vector<Level> levels_;
  std::vector<DuplicateMember> duplicates_;
};

}  // namespace

JsonFile::JsonFile(const SourceFile& source, ErrorRule syntax_rule, Diagnostics& diagnostics) : source_{source} {
  constexpr bool with_comments = true;
  try {
    root_ = Json::parse(source.text(), nullptr, true, with_comments);
  } catch (const Json::parse_error& problem) {
    Position position{&source};
    if (problem.byte > 0) position = PlaceCounter{source}.at(problem.byte - 1, 1);
    diagnostics.error(syntax_rule, position, fmt::format("not JSON: {}", reason(problem.what())));
    return;
  } catch (const Json::out_of_range& problem) {  // a number that does not fit into a double
    diagnostics.error(syntax_rule, Position{&source}, fmt::format("not JSON: {}", without_number(problem.what())));
    return;
  }
  is_valid_ = true;
  for (const DuplicateMember& one : JsonPlaceScanner{source, places_}.scan()) {
    diagnostics.error(syntax_rule, one.position, fmt::format("duplicate member {}", quote(one.name)),
                      {{one.first, "the first one"}});
  }
}

Position JsonFile::value_position(const Pointer& pointer) const {
  const auto at = places_.find(pointer.to_string());
  return at == places_.end() ? Position{&source_} : at->second.value;
}

Position JsonFile::name_position(const Pointer& pointer) const {
  const auto at = places_.find(pointer.to_string());
  return at == places_.end() ? Position{&source_} : at->second.name;
}

}  // namespace edsc
