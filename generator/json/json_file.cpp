#include "json/json_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "diagnostics/place.hpp"
#include "diagnostics/quote.hpp"

namespace edsc {
namespace {

using Json = JsonFile::Json;
using JsonPlaces = std::unordered_map<const Json*, JsonPlace>;

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

/// Finds the places of all values in a valid JSON text.
class JsonPlaceScanner {
 public:
  /// `root` is the value of the text.
  JsonPlaceScanner(const SourceFile& source, const Json& root, JsonPlaces& places, std::vector<JsonFault>& faults)
      : source_{source}, text_{source.text()}, root_{root}, places_{places}, faults_{faults} {}

  /// Reports the members whose name occurred before in their object.
  void scan() {
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
  }

 private:
  /// An object or array around the position.
  struct Level {
    const Json* json = nullptr;  ///< null for a value that a member of the same name replaces
    bool is_array = false;
    bool is_duplicate = false;  ///< below a member that is a duplicate
    std::size_t element = 0;
    const Json* member = nullptr;
    std::string name;  ///< of the member
    Position name_position;
  };

  /// Skips blanks and comments; false at the end.
  bool skip_blanks() {
    while (at_ < text_.size()) {
      const std::string_view rest = text_.substr(at_);
      if (rest.starts_with("//")) {
        at_ += std::min(rest.find_first_of("\r\n"), rest.size());
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
    Level level;
    level.is_array = text_[at_] == '[';
    const Json* const json = current();
    if (json != nullptr && (level.is_array ? json->is_array() : json->is_object())) level.json = json;
    level.is_duplicate = record(at_, 1);
    levels_.push_back(std::move(level));
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
      name_member(start, length);
    } else {
      record(start, length);
    }
  }

  void name_member(std::size_t start, std::size_t length) {
    Level& level = levels_.back();
    level.member = nullptr;
    if (level.json == nullptr) return;
    level.name = Json::parse(text_.substr(start, length)).get<std::string>();
    level.name_position = position_at(source_, start, length);
    const auto member = level.json->find(level.name);
    if (member != level.json->end()) level.member = &*member;
  }

  void word() {
    const std::size_t start = at_;
    at_ = std::min(text_.find_first_of(",]} \t\r\n/", at_), text_.size());
    record(start, at_ - start);
  }

  /// The value at the position, or null.
  [[nodiscard]] const Json* current() const {
    if (levels_.empty()) return &root_;
    const Level& level = levels_.back();
    if (!level.is_array) return level.member;
    return level.json != nullptr && level.element < level.json->size() ? &(*level.json)[level.element] : nullptr;
  }

  /// Whether the value belongs to a member that is a duplicate. The parser uses the last one, and so do the places.
  bool record(std::size_t start, std::size_t length) {
    const Json* const json = current();
    if (json == nullptr) return false;
    const Position value = position_at(source_, start, length);
    const bool is_member = !levels_.empty() && !levels_.back().is_array;
    const bool is_in_duplicate = !levels_.empty() && levels_.back().is_duplicate;
    const JsonPlace place{is_member ? levels_.back().name_position : value, value};
    const auto [at, is_new] = places_.try_emplace(json, place);
    if (is_new) return is_in_duplicate;
    if (!is_in_duplicate) {
      faults_.push_back({place.name,
                         fmt::format("duplicate member {}", quote(levels_.back().name)),
                         {{at->second.name, "the first one"}}});
    }
    at->second = place;
    return true;
  }

  const SourceFile& source_;
  std::string_view text_;
  const Json& root_;
  JsonPlaces& places_;
  std::vector<JsonFault>& faults_;
  std::size_t at_ = 0;
  std::vector<Level> levels_;
};

}  // namespace

JsonFile::JsonFile(const SourceFile& source) : source_{source} {
  constexpr bool with_comments = true;
  // The parser takes a NUL for the end of the text, and does not read what follows.
  if (const std::size_t nul = source.text().find('\0'); nul != std::string_view::npos) {
    faults_.push_back({position_at(source, nul), "not JSON: NUL character", {}});
    return;
  }
  try {
    root_ = Json::parse(source.text(), nullptr, true, with_comments);
  } catch (const Json::parse_error& problem) {
    const Position position = problem.byte > 0 ? position_at(source, problem.byte - 1) : Position{&source};
    faults_.push_back({position, fmt::format("not JSON: {}", reason(problem.what())), {}});
    return;
  } catch (const Json::out_of_range& problem) {  // a number that does not fit into a double
    faults_.push_back({Position{&source}, fmt::format("not JSON: {}", without_number(problem.what())), {}});
    return;
  }
  is_valid_ = true;
  JsonPlaceScanner{source, root_, places_, faults_}.scan();
}

void JsonFile::report_faults(ErrorRule rule, Diagnostics& diagnostics) const {
  for (const JsonFault& fault : faults_) diagnostics.error(rule, fault.position, fault.message, fault.notes);
}

std::vector<JsonFile::Member> JsonFile::members(const Json& object) const {
  std::vector<Member> members;
  members.reserve(object.size());
  for (const auto& [name, value] : object.items()) members.push_back({name, &value});
  std::ranges::sort(members, {}, [&](const Member& member) {
    const Position position = name_position(*member.value);
    return std::pair{position.line, position.column};
  });
  return members;
}

JsonPlace JsonFile::place_of(const Json& value) const {
  const auto at = places_.find(&value);
  return at == places_.end() ? JsonPlace{{&source_}, {&source_}} : at->second;
}

}  // namespace edsc
