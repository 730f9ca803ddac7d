#include "json/json_edit.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace edsc {
namespace {

using Value = nlohmann::ordered_json;

constexpr std::string_view blanks = " \t";
constexpr std::string_view line_ends = "\r\n";

bool is_blank(std::string_view text) { return text.find_first_not_of(blanks) == std::string_view::npos; }
bool has_line_end(std::string_view text) { return text.find_first_of(line_ends) != std::string_view::npos; }

std::string scalar_text(const Value& value) { return value.dump(-1, ' ', false, Value::error_handler_t::replace); }

/// Edits of one text, in any order.
class JsonTextEdits {
 public:
  void cut(std::size_t begin, std::size_t end) { edits_.push_back({begin, end, {}}); }
  void put(std::size_t at, std::string text) { edits_.push_back({at, at, std::move(text)}); }
  void replace(std::size_t begin, std::size_t end, std::string text) {
    edits_.push_back({begin, end, std::move(text)});
  }

  [[nodiscard]] std::string made_in(std::string_view text) {
    std::ranges::stable_sort(edits_, {}, &Edit::begin);
    std::string result;
    std::size_t at = 0;
    for (const Edit& edit : edits_) {
      if (edit.begin > at) result += text.substr(at, edit.begin - at);
      result += edit.text;
      at = std::max(at, edit.end);
    }
    return result += text.substr(at);
  }

 private:
  struct Edit {
    std::size_t begin, end;
    std::string text;
  };
  std::vector<Edit> edits_;
};

/// The lines of a text.
class JsonLines {
 public:
  explicit JsonLines(std::string_view text) : text_{text} {}

  [[nodiscard]] std::size_t start(std::size_t at) const {
    const std::size_t before = at == 0 ? std::string_view::npos : text_.find_last_of(line_ends, at - 1);
    return before == std::string_view::npos ? 0 : before + 1;
  }
  [[nodiscard]] std::string_view before(std::size_t at) const { return text_.substr(start(at), at - start(at)); }
  [[nodiscard]] std::string_view indent(std::size_t at) const {
    const std::string_view line = before(at);
    return line.substr(0, std::min(line.find_first_not_of(blanks), line.size()));
  }
  /// The line end at this offset; empty if there is none.
  [[nodiscard]] std::string_view end_at(std::size_t at) const {
    const std::string_view rest = text_.substr(at);
    if (rest.starts_with("\r\n")) return rest.substr(0, 2);
    return rest.substr(0, has_line_end(rest.substr(0, 1)) ? 1 : 0);
  }
  /// The line end of the line with this offset; of the last line, that of the line before.
  [[nodiscard]] std::string_view end_of(std::size_t at) const {
    if (const std::size_t next = text_.find_first_of(line_ends, at); next != std::string_view::npos)
      return end_at(next);
    if (start(at) == 0) return "\n";
    const std::size_t last = start(at) - 1;
    return end_at(last > 0 && text_[last] == '\n' && text_[last - 1] == '\r' ? last - 1 : last);
  }
  /// The end of the line without its line end, if only blanks and comments are before it.
  [[nodiscard]] std::optional<std::size_t> tail(std::size_t at) const {
    while (at < text_.size() && !has_line_end(text_.substr(at, 1))) {
      const std::string_view rest = text_.substr(at);
      if (blanks.find(rest.front()) != std::string_view::npos) {
        ++at;
      } else if (rest.starts_with("//")) {
        at += std::min(rest.find_first_of(line_ends), rest.size());
      } else if (rest.starts_with("/*")) {
        const std::size_t end = rest.find("*/", 2);
        if (end == std::string_view::npos || has_line_end(rest.substr(0, end))) return std::nullopt;
        at += end + 2;
      } else {
        return std::nullopt;
      }
    }
    return at;
  }

 private:
  std::string_view text_;
};

/// Writes new values like those that the text has.
class JsonPrinter {
 public:
  explicit JsonPrinter(const JsonRanges& ranges) : ranges_{ranges}, lines_{ranges.text()} {}

  /// `like`: a value whose style it takes, if it is of the same kind; `indent` and `line_end`: of its first line.
  [[nodiscard]] std::string print(const Value& value, std::optional<std::size_t> like, const std::string& indent,
                                  std::string_view line_end) const {
    if (!value.is_structured() || value.empty()) return scalar_text(value);
    if (like && !(value.is_object() ? ranges_.is_object(ranges_[*like]) : ranges_.is_array(ranges_[*like])))
      like.reset();
    if (like && ranges_[*like].children.empty()) like.reset();
    const bool is_broken = like ? is_first_broken(*like) : !is_flat(value) && !is_on_one_line();
    const std::string inner_indent = is_broken ? indent + unit(like) : indent;
    const std::string inner =
        is_broken ? std::string{line_end} + inner_indent : one_line_blank(value.is_object(), like);
    std::string text = value.is_object() ? "{" : "[";
    bool is_first = true;
    for (const auto& [name, one] : value.items()) {
      if (!is_first) text += is_broken ? "," : one_line_separator(like);
      if (is_first || is_broken) text += inner;
      is_first = false;
      if (value.is_object()) text += scalar_text(name) + colon(like);
      text += print(one, child_like(like, value.is_object() ? name : "0"), inner_indent, line_end);
    }
    text += is_broken ? std::string{line_end} + indent : inner;
    return text + (value.is_object() ? "}" : "]");
  }

  /// Whether both are objects or both arrays, and both have scalars or both only objects and arrays.
  [[nodiscard]] bool is_like(const Value& value, std::size_t other) const {
    const JsonRange& range = ranges_[other];
    if (range.children.empty() || !(value.is_object() ? ranges_.is_object(range) : ranges_.is_array(range)))
      return false;
    const bool has_scalar = std::ranges::any_of(value, [](const Value& one) { return !one.is_structured(); });
    const auto is_scalar = [&](std::size_t one) {
      return !ranges_.is_object(ranges_[one]) && !ranges_.is_array(ranges_[one]);
    };
    return has_scalar == std::ranges::any_of(range.children, is_scalar);
  }

  /// The text between a name and its value.
  [[nodiscard]] std::string colon(std::optional<std::size_t> object) const {
    if (!object || ranges_[*object].children.empty() || !ranges_.is_object(ranges_[*object])) object = JsonRanges::root;
    if (!ranges_.is_object(ranges_[*object]) || ranges_[*object].children.empty()) return ": ";
    const JsonRange& member = ranges_[ranges_[*object].children.front()];
    const std::string_view between = ranges_.text().substr(member.name_end, member.begin - member.name_end);
    return between.find_first_not_of(" \t:") == std::string_view::npos ? std::string{between} : ": ";
  }

  /// What an indent grows by in this object or array.
  [[nodiscard]] std::string unit(std::optional<std::size_t> container) const {
    for (const std::size_t one : {container.value_or(JsonRanges::root), JsonRanges::root}) {
      const JsonRange& range = ranges_[one];
      if (range.children.empty() || !is_first_broken(one)) continue;
      const std::string_view outer = lines_.indent(range.begin);
      const std::string_view inner = lines_.indent(ranges_[range.children.front()].first());
      if (inner.size() > outer.size() && inner.starts_with(outer)) return std::string{inner.substr(outer.size())};
    }
    return "  ";
  }

  /// Whether the first child is on another line than the bracket.
  [[nodiscard]] bool is_first_broken(std::size_t container) const {
    const JsonRange& range = ranges_[container];
    return !range.children.empty() &&
           has_line_end(ranges_.text().substr(range.begin, ranges_[range.children.front()].first() - range.begin));
  }

  /// Between two values on one line.
  [[nodiscard]] std::string one_line_separator(std::optional<std::size_t> like) const {
    if (like && ranges_[*like].children.size() > 1) {
      const std::vector<std::size_t>& children = ranges_[*like].children;
      const JsonRange& last = ranges_[children.back()];
      const std::size_t end = ranges_[children[children.size() - 2]].end;
      const std::string_view between = ranges_.text().substr(end, last.first() - end);
      if (between.find_first_not_of(" \t,") == std::string_view::npos) return std::string{between};
    }
    return ", ";
  }

 private:
  /// Only scalars, and arrays of them.
  static bool is_flat(const Value& value) {
    return std::ranges::all_of(value, [&](const Value& one) {
      return !one.is_structured() || one.empty() || (value.is_object() && one.is_array() && is_flat(one));
    });
  }

  /// Whether all values are on one line.
  [[nodiscard]] bool is_on_one_line() const {
    const JsonRange& root = ranges_[JsonRanges::root];
    return !root.children.empty() && !has_line_end(ranges_.value_text(root));
  }

  /// The blanks between a bracket and what is inside.
  [[nodiscard]] std::string one_line_blank(bool is_object, std::optional<std::size_t> like) const {
    if (!like) like = first_on_one_line(is_object);
    if (!like) return "";
    const JsonRange& range = ranges_[*like];
    const std::size_t begin = range.begin + 1;
    const std::string_view inside = ranges_.text().substr(begin, ranges_[range.children.front()].first() - begin);
    return is_blank(inside) ? std::string{inside} : "";
  }

  [[nodiscard]] std::optional<std::size_t> first_on_one_line(bool is_object) const {
    for (std::size_t one = 0; one < ranges_.size(); ++one) {
      const bool is_same = is_object ? ranges_.is_object(ranges_[one]) : ranges_.is_array(ranges_[one]);
      if (is_same && !ranges_[one].children.empty() && !is_first_broken(one)) return one;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<std::size_t> child_like(std::optional<std::size_t> like, const std::string& name) const {
    return like ? ranges_.child(*like, name) : std::nullopt;
  }

  const JsonRanges& ranges_;
  JsonLines lines_;
};

class JsonEditor {
 public:
  explicit JsonEditor(std::string_view text) : text_{text}, ranges_{text}, lines_{text}, printer_{ranges_} {}

  std::optional<std::string> set(const JsonPath& path, const Value& value) {
    if (const auto at = ranges_.find(path)) return replaced(*at, value);
    if (path.empty()) return std::nullopt;
    const auto owner = ranges_.find({path.begin(), path.end() - 1});
    if (!owner) return std::nullopt;
    const bool is_array = ranges_.is_array(ranges_[*owner]);
    if (is_array ? path.back() != "-" : !ranges_.is_object(ranges_[*owner])) return std::nullopt;
    return added(*owner, is_array ? nullptr : &path.back(), value);
  }

  std::optional<std::string> remove(const JsonPath& path) {
    const auto at = ranges_.find(path);
    if (!at || path.empty()) return std::nullopt;
    const JsonRange& range = ranges_[*at];
    const std::size_t place = ranges_.place_of(*at);
    const std::vector<std::size_t>& siblings = siblings_of(range);
    const JsonRange* const before = place > 0 ? &ranges_[siblings[place - 1]] : nullptr;
    if (!cut_lines(range, before)) {
      if (range.comma) {
        cut_with_comma(range, ranges_[siblings[place + 1]]);
      } else {
        cut_last(range, before);
      }
    }
    return edits_.made_in(text_);
  }

  std::optional<std::string> rename(const JsonPath& path, std::string_view name) {
    const auto at = ranges_.find(path);
    if (!at || ranges_[*at].name_end == 0) return std::nullopt;
    edits_.replace(ranges_[*at].name_begin, ranges_[*at].name_end, scalar_text(name));
    return edits_.made_in(text_);
  }

  std::optional<std::string> move(const JsonPath& path, std::size_t to) {
    const auto at = ranges_.find(path);
    if (!at || path.empty() || to >= siblings_of(ranges_[*at]).size()) return std::nullopt;
    std::vector<std::size_t> order = siblings_of(ranges_[*at]);
    const std::vector<std::size_t> before = order;
    const std::size_t from = ranges_.place_of(*at);
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(from));
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(to), *at);
    if (const auto moved = with_moved_lines(*ranges_[*at].parent, before, order)) return moved;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const JsonRange& slot = ranges_[before[i]];
      const JsonRange& one = ranges_[order[i]];
      edits_.replace(slot.first(), slot.end, std::string{text_.substr(one.first(), one.end - one.first())});
    }
    return edits_.made_in(text_);
  }

 private:
  [[nodiscard]] const std::vector<std::size_t>& siblings_of(const JsonRange& range) const {
    return ranges_[*range.parent].children;
  }
  [[nodiscard]] std::string_view between(std::size_t begin, std::size_t end) const {
    return text_.substr(begin, end - begin);
  }

  std::string replaced(std::size_t at, const Value& value) {
    const JsonRange& range = ranges_[at];
    edits_.replace(range.begin, range.end,
                   printer_.print(value, at, std::string{lines_.indent(range.first())}, lines_.end_of(range.begin)));
    return edits_.made_in(text_);
  }

  /// The member or element, on a line with this indent.
  [[nodiscard]] std::string text_of(std::size_t owner, const std::string* name, const Value& value,
                                    const std::string& indent, std::string_view line_end) const {
    std::optional<std::size_t> like;
    for (const std::size_t one : ranges_[owner].children) {
      if (printer_.is_like(value, one)) like = one;
    }
    const std::string printed = printer_.print(value, like, indent, line_end);
    return name == nullptr ? printed : scalar_text(*name) + printer_.colon(owner) + printed;
  }

  std::string added(std::size_t owner, const std::string* name, const Value& value) {
    if (ranges_[owner].children.empty()) {
      add_first(owner, name, value);
    } else {
      add_last(owner, name, value);
    }
    return edits_.made_in(text_);
  }

  void add_first(std::size_t owner, const std::string* name, const Value& value) {
    const JsonRange& range = ranges_[owner];
    const std::size_t close = range.end - 1;
    const std::string outer{lines_.indent(close)};
    const std::string_view line_end = lines_.end_of(range.begin);
    const std::string indent = outer + printer_.unit(std::nullopt);
    const std::string_view inside = between(range.begin + 1, close);
    if (has_line_end(inside) && is_blank(lines_.before(close))) {
      edits_.put(lines_.start(close), indent + text_of(owner, name, value, indent, line_end) + std::string{line_end});
    } else if (is_blank(inside) && value.is_structured() && printer_.is_first_broken(JsonRanges::root)) {
      edits_.replace(range.begin + 1, close,
                     std::string{line_end} + indent + text_of(owner, name, value, indent, line_end) +
                         std::string{line_end} + outer);
    } else {
      const std::size_t last = text_.find_last_not_of(blanks, close - 1) + 1;
      const std::string blank{is_blank(inside) ? inside : " "};
      edits_.put(last, blank + text_of(owner, name, value, outer, line_end));
    }
  }

  void add_last(std::size_t owner, const std::string* name, const Value& value) {
    const std::vector<std::size_t>& children = ranges_[owner].children;
    const JsonRange& last = ranges_[children.back()];
    const std::size_t before = children.size() > 1 ? ranges_[children[children.size() - 2]].end : ranges_[owner].begin;
    const std::string_view line_end = lines_.end_of(last.end);
    const std::string indent{lines_.indent(last.first())};
    const std::string text = text_of(owner, name, value, indent, line_end);
    if (!has_line_end(between(before, last.first()))) {
      edits_.put(last.end, printer_.one_line_separator(owner) + text);
      return;
    }
    const std::string_view prefix = lines_.before(last.first());
    const bool has_comma_first = is_comma_first(prefix);
    if (!has_comma_first) edits_.put(last.end, ",");
    edits_.put(lines_.tail(last.end).value_or(last.end),
               std::string{line_end} + (has_comma_first ? std::string{prefix} : indent) + text);
  }

  /// Whether a line begins with the comma before its value.
  static bool is_comma_first(std::string_view prefix) {
    return prefix.find(',') != std::string_view::npos && prefix.find_first_not_of(" \t,") == std::string_view::npos;
  }

  /// Cuts the lines of a value that has them alone; false if it does not.
  bool cut_lines(const JsonRange& range, const JsonRange* before) {
    const std::size_t start = lines_.start(range.first());
    const std::string_view prefix = lines_.before(range.first());
    const bool is_comma_here = range.comma && !has_line_end(between(range.end, *range.comma));
    const bool has_comma_first = before != nullptr && is_comma_first(prefix) && !is_comma_here;
    if (!is_blank(prefix) && !has_comma_first) return false;
    const auto tail = lines_.tail(is_comma_here ? *range.comma + 1 : range.end);
    if (!tail || lines_.end_at(*tail).empty()) return false;
    edits_.cut(start, *tail + lines_.end_at(*tail).size());
    if (has_comma_first) return true;
    if (range.comma) {
      edits_.cut(*range.comma, *range.comma + 1);
    } else if (before != nullptr) {
      edits_.cut(*before->comma, *before->comma + 1);
    }
    return true;
  }

  void cut_with_comma(const JsonRange& range, const JsonRange& next) {
    const std::size_t comma_end = *range.comma + 1;
    if (between(range.end, next.first()).find('/') == std::string_view::npos) {
      edits_.cut(range.first(), next.first());
      return;
    }
    edits_.cut(range.first(), range.end);
    edits_.cut(*range.comma, std::min(text_.find_first_not_of(blanks, comma_end), next.first()));
  }

  void cut_last(const JsonRange& range, const JsonRange* before) {
    const std::size_t begin = text_.find_last_not_of(blanks, range.first() - 1) + 1;
    edits_.cut(begin, range.end);
    if (before == nullptr) return;
    const bool is_near = is_blank(between(before->end, *before->comma));
    edits_.cut(is_near ? before->end : *before->comma, *before->comma + 1);
  }

  /// Blocks of whole lines in another order, each with the comment lines before it; nothing if other text is on them.
  [[nodiscard]] std::optional<std::string> with_moved_lines(std::size_t owner, const std::vector<std::size_t>& before,
                                                            const std::vector<std::size_t>& order) const {
    std::vector<std::size_t> starts;
    std::size_t end = ranges_[owner].begin + 1;
    for (std::size_t i = 0; i <= before.size(); ++i) {
      const auto tail = lines_.tail(end);
      if (!tail || lines_.end_at(*tail).empty()) return std::nullopt;
      starts.push_back(*tail + lines_.end_at(*tail).size());
      if (i == before.size()) break;
      const JsonRange& range = ranges_[before[i]];
      if (!is_blank(lines_.before(range.first()))) return std::nullopt;
      end = range.comma ? *range.comma + 1 : range.end;
    }
    std::string result{text_.substr(0, starts.front())};
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto place = static_cast<std::size_t>(std::ranges::find(before, order[i]) - before.begin());
      const JsonRange& range = ranges_[order[i]];
      const std::size_t comma = range.comma.value_or(range.end);
      result += between(starts[place], comma);
      if (i + 1 < order.size()) result += ',';
      result += between(range.comma ? comma + 1 : comma, starts[place + 1]);
    }
    return result += text_.substr(starts.back());
  }

  std::string_view text_;
  JsonRanges ranges_;
  JsonLines lines_;
  JsonPrinter printer_;
  JsonTextEdits edits_;
};

/// Replaces the elements that differ, so that comments between the others remain.
std::string with_json_elements(std::string text, const JsonPath& path, const Value& value) {
  const JsonRanges ranges{text};
  const std::vector<std::size_t>& elements = ranges[*ranges.find(path)].children;
  std::vector<Value> before;
  before.reserve(elements.size());
  for (const std::size_t one : elements) {
    before.push_back(Value::parse(ranges.value_text(ranges[one]), nullptr, true, true));
  }
  std::size_t same = 0;
  while (same < std::min(before.size(), value.size()) && before[same] == value[same]) ++same;
  const auto element = [&](const std::string& number) {
    JsonPath of_element = path;
    of_element.push_back(number);
    return of_element;
  };
  // Of a shorter array, the elements after `same` that are too many.
  for (std::size_t count = before.size(); count > value.size(); --count) {
    text = *JsonEditor{text}.remove(element(std::to_string(same)));
    before.erase(before.begin() + static_cast<std::ptrdiff_t>(same));
  }
  for (std::size_t i = same; i < value.size(); ++i) {
    if (i < before.size() && before[i] == value[i]) continue;
    text = *JsonEditor{text}.set(element(i < before.size() ? std::to_string(i) : "-"), value[i]);
  }
  return text;
}

}  // namespace

std::optional<std::string> with_json_value(std::string_view text, const JsonPath& path, const Value& value) {
  const JsonRanges ranges{text};
  const auto at = ranges.find(path);
  if (at && value.is_array() && !value.empty() && !ranges[*at].children.empty() && ranges.is_array(ranges[*at])) {
    return with_json_elements(std::string{text}, path, value);
  }
  return JsonEditor{text}.set(path, value);
}

std::optional<std::string> without_json_value(std::string_view text, const JsonPath& path) {
  return JsonEditor{text}.remove(path);
}

std::optional<std::string> with_json_name(std::string_view text, const JsonPath& path, std::string_view name) {
  return JsonEditor{text}.rename(path, name);
}

std::optional<std::string> with_json_moved(std::string_view text, const JsonPath& path, std::size_t to) {
  return JsonEditor{text}.move(path, to);
}

}  // namespace edsc
