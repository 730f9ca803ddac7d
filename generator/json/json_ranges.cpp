#include "json/json_ranges.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

namespace edsc {
namespace {

std::size_t after_json_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return std::min(at + 1, text.size());
}

std::optional<std::size_t> element_number(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return text.size() > 1 && text.front() == '0' ? std::nullopt : std::optional{number};
}

/// Without recursion: a text can be as deep as it is long.
class JsonRangeScanner {
 public:
  JsonRangeScanner(std::string_view text, std::vector<JsonRange>& ranges) : text_{text}, ranges_{ranges} {}

  void scan() {
    for (at_ = after_json_blanks(text_, 0); at_ < text_.size(); at_ = after_json_blanks(text_, at_)) {
      switch (text_[at_]) {
        case '{':
        case '[': open_.push_back(add(at_ + 1)); break;
        case '}':
        case ']': close(); break;
        case ',': comma(); break;
        case '"': string(); break;
        default: add(std::min(text_.find_first_of(",]} \t\r\n/", at_), text_.size()));
      }
    }
  }

 private:
  /// Adds the value at the position, and continues at its end.
  std::size_t add(std::size_t end) {
    const std::size_t index = ranges_.size();
    JsonRange range = std::exchange(named_, JsonRange{});
    range.begin = std::exchange(at_, end);
    range.end = end;
    if (!open_.empty()) {
      range.parent = open_.back();
      ranges_[open_.back()].children.push_back(index);
    }
    ranges_.push_back(std::move(range));
    return index;
  }

  void close() {
    ++at_;
    if (open_.empty()) return;
    ranges_[open_.back()].end = at_;
    open_.pop_back();
  }

  void comma() {
    if (!open_.empty() && !ranges_[open_.back()].children.empty()) {
      ranges_[ranges_[open_.back()].children.back()].comma = at_;
    }
    ++at_;
  }

  void string() {
    const std::size_t end = after_json_string(text_, at_);
    const std::size_t next = after_json_blanks(text_, end);
    if (next == text_.size() || text_[next] != ':') {
      add(end);
      return;
    }
    named_.name_begin = at_;
    named_.name_end = end;
    named_.name = nlohmann::json::parse(text_.substr(at_, end - at_)).get<std::string>();
    at_ = next + 1;
  }

  std::string_view text_;
  std::vector<JsonRange>& ranges_;
  std::size_t at_ = 0;
  JsonRange named_;  ///< the name of the next value
  std::vector<std::size_t> open_;
};

}  // namespace

std::optional<JsonPath> json_path(std::string_view pointer) {
  JsonPath path;
  try {
    nlohmann::json::json_pointer parsed{std::string{pointer}};
    for (; !parsed.empty(); parsed.pop_back()) path.push_back(parsed.back());
  } catch (const nlohmann::json::parse_error&) {
    return std::nullopt;
  }
  std::ranges::reverse(path);
  return path;
}

std::string json_pointer(const JsonPath& path) {
  nlohmann::json::json_pointer pointer;
  for (const std::string& one : path) pointer.push_back(one);
  return pointer.to_string();
}

std::size_t after_json_blanks(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("//")) {
      at += std::min(rest.find_first_of("\r\n"), rest.size());
    } else if (rest.starts_with("/*")) {
      const std::size_t end = rest.find("*/", 2);
      at += end == std::string_view::npos ? rest.size() : end + 2;
    } else if (std::string_view{" \t\r\n"}.find(text[at]) != std::string_view::npos) {
      ++at;
    } else {
      break;
    }
  }
  return at;
}

JsonRanges::JsonRanges(std::string_view text) : text_{text} { JsonRangeScanner{text, ranges_}.scan(); }

std::optional<std::size_t> JsonRanges::child(std::size_t index, std::string_view name) const {
  const JsonRange& range = ranges_[index];
  if (is_array(range)) {
    const auto number = element_number(name);
    return number && *number < range.children.size() ? std::optional{range.children[*number]} : std::nullopt;
  }
  const auto last = std::find_if(range.children.rbegin(), range.children.rend(),
                                 [&](std::size_t one) { return ranges_[one].name == name; });
  return last == range.children.rend() ? std::nullopt : std::optional{*last};
}

std::optional<std::size_t> JsonRanges::find(const JsonPath& path) const {
  if (ranges_.empty()) return std::nullopt;
  std::optional<std::size_t> at = root;
  for (const std::string& name : path) {
    at = child(*at, name);
    if (!at) break;
  }
  return at;
}

JsonPath JsonRanges::path_at(std::size_t offset) const {
  JsonPath path;
  if (ranges_.empty()) return path;
  for (std::size_t at = root;;) {
    const std::vector<std::size_t>& children = ranges_[at].children;
    const auto next = std::ranges::find_if(
        children, [&](std::size_t one) { return ranges_[one].first() <= offset && offset < ranges_[one].end; });
    if (next == children.end()) return path;
    path.push_back(is_array(ranges_[at]) ? std::to_string(next - children.begin()) : ranges_[*next].name);
    at = *next;
  }
}

std::size_t JsonRanges::place_of(std::size_t index) const {
  const std::vector<std::size_t>& siblings = ranges_[*ranges_[index].parent].children;
  return static_cast<std::size_t>(std::ranges::find(siblings, index) - siblings.begin());
}

}  // namespace edsc
