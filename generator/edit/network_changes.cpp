#include "edit/network_changes.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "diagnostics/quote.hpp"
#include "json/json_edit.hpp"
#include "json/json_ranges.hpp"
#include "network/network_members.hpp"
#include "text/ascii.hpp"
#include "text/counted.hpp"
#include "text/number_text.hpp"

namespace edsc::edit {
namespace {

using Wanted = nlohmann::json;
using FormJson = nlohmann::ordered_json;

/// Ends a request that is not possible.
struct RefusedChange {
  std::string problem;
};

[[noreturn]] void refuse_change(std::string problem) { throw RefusedChange{std::move(problem)}; }

/// What a member can be.
struct MemberKind {
  std::string_view name;
  MemberForm form = MemberForm::text;
  std::uint32_t min = 0;
  std::uint32_t max = 0;
};

std::vector<MemberKind> kinds_of_members(std::span<const std::string> object) {
  std::vector<MemberKind> kinds;
  visit_network_members(object, [&](const auto& rows) {
    for (const auto& row : rows) kinds.push_back({row.name, row.form(), row.min, row.max});
  });
  return kinds;
}

std::string form_text(const Wanted& value, std::string_view member) {
  if (!value.is_string()) refuse_change(fmt::format("{}: expected a text", member));
  return std::string{trim(value.get_ref<const std::string&>())};
}

FormJson number_value(const std::string& text, const MemberKind& kind) {
  const Digits digits = digits_of(text);
  const auto number = parse_whole<std::uint32_t>(digits.text, digits.base);
  if (!number || *number < kind.min || *number > kind.max) {
    refuse_change(
        fmt::format("{}: expected a number from {} to {}, got {}", kind.name, kind.min, kind.max, quote(text)));
  }
  return *number;
}

FormJson flag_value(const std::string& text, const MemberKind& kind) {
  if (text == "1" || text == "true") return true;
  if (text == "0" || text == "false") return false;
  refuse_change(fmt::format("{}: expected 1 (true) or 0 (false), got {}", kind.name, quote(text)));
}

/// A list of texts; one text is written without brackets, unless the file has them.
FormJson list_value(const Wanted& value, const MemberKind& kind, bool has_brackets) {
  FormJson list = FormJson::array();
  const auto add = [&](const Wanted& one) {
    if (std::string text = form_text(one, kind.name); !text.empty()) list.push_back(std::move(text));
  };
  if (value.is_array()) {
    for (const Wanted& one : value) add(one);
  } else {
    add(value);
  }
  return list.size() == 1 && !has_brackets ? FormJson(list.front()) : list;
}

/// The value of an entry: a number is written as a number, unless the file has it as a text.
FormJson entry_value(const std::string& text, bool is_text) {
  const FormJson number = FormJson::parse(text, nullptr, false);
  return !is_text && number.is_number() && number.dump() == text ? number : FormJson(text);
}

/// The value that a form states; null removes the member.
FormJson value_of_form(const Wanted& value, const MemberKind& kind, std::string_view before) {
  if (kind.form == MemberForm::texts) {
    FormJson list = list_value(value, kind, before.starts_with('['));
    return list.empty() ? FormJson(nullptr) : list;
  }
  const std::string text = form_text(value, kind.name);
  if (text.empty()) return nullptr;
  switch (kind.form) {
    case MemberForm::number: return number_value(text, kind);
    case MemberForm::flag: return flag_value(text, kind);
    case MemberForm::values: refuse_change(fmt::format("{}: set one entry", kind.name));
    default: return text;
  }
}

std::string shown_value(const Wanted& value) {
  if (!value.is_array()) return value.is_string() ? value.get<std::string>() : value.dump();
  std::string text;
  for (const Wanted& one : value) text += (text.empty() ? "" : ", ") + shown_value(one);
  return text;
}

/// `node axis1`, `signal 4`, `SYNC`, `eds of node axis1`.
std::string part_text(std::span<const std::string> path) {
  if (path.empty()) return "the network";
  const std::span<const std::string> owner = path.first(path.size() - 1);
  if (path.size() == 1) return path[0] == "sync" ? "SYNC" : path[0] == "assume" ? "the assumed intervals" : path[0];
  if (path.size() == 2 && path[0] == "signals") {
    const auto number = parse_whole<std::size_t>(path[1]);
    return number ? fmt::format("signal {}", *number + 1) : "a new signal";
  }
  if (path.size() == 2 && path[0] == "nodes") return fmt::format("node {}", path[1]);
  if (path.size() == 3 && path[0] == "nodes" && path[2] == "set") return part_text(owner);
  return fmt::format("{} of {}", path.back(), part_text(owner));
}

class NetworkChanger {
 public:
  explicit NetworkChanger(std::string_view text) : text_{text} {}

  void make(const Wanted& request) {
    const std::string kind = text_of(request, "do");
    const auto path = json_path(text_of(request, "pointer"));
    if (!path) refuse_change("\"pointer\" is not a JSON pointer");
    if (kind == "set") return set(*path, member_of(request, "value"));
    if (kind == "add") return add(*path, member_of(request, "members"));
    if (path->empty()) refuse_change("the network itself is not removed, renamed or moved");
    if (kind == "remove") return remove(*path);
    if (kind == "rename") return rename(*path, text_of(request, "name"));
    if (kind == "move") return move(*path, member_of(request, "to"));
    refuse_change(fmt::format("unknown change {}", quote(kind)));
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] bool is_renamed() const { return is_renamed_; }

 private:
  static const Wanted& member_of(const Wanted& request, const char* name) {
    const auto found = request.is_object() ? request.find(name) : request.end();
    if (!request.is_object() || found == request.end()) refuse_change(fmt::format("missing \"{}\"", name));
    return *found;
  }
  static std::string text_of(const Wanted& request, const char* name) {
    const Wanted& text = member_of(request, name);
    if (!text.is_string()) refuse_change(fmt::format("\"{}\" is a text", name));
    return text.get<std::string>();
  }

  void set(const JsonPath& path, const Wanted& value) {
    if (path.empty()) refuse_change("name a member of the network");
    const std::span<const std::string> object = std::span{path}.first(path.size() - 1);
    FormJson wanted;
    if (object.size() == 3 && object[0] == "nodes" && object[2] == "set") {
      const std::string text = form_text(value, path.back());
      if (path.back().empty()) refuse_change("name an entry, such as 6083h");
      if (!text.empty()) wanted = entry_value(text, value_text(path).starts_with('"'));
    } else {
      wanted = value_of_member(object, path.back(), value, value_text(path));
    }
    if (wanted.is_null()) {
      if (exists(path)) cut(path);
      name_ = fmt::format("remove {} of {}", path.back(), part_text(object));
      return;
    }
    name_ = fmt::format("set {} of {} to {}", path.back(), part_text(object), shown_value(value));
    if (!exists({path.begin(), path.end() - 1})) return put_with_object(path, std::move(wanted));
    const std::string before = value_text(path);
    if (before.empty() || FormJson::parse(before, nullptr, false, true) != wanted) put(path, wanted);
  }

  static FormJson value_of_member(std::span<const std::string> object, const std::string& member, const Wanted& value,
                                  std::string_view before) {
    for (const MemberKind& kind : kinds_of_members(object)) {
      if (kind.name == member) return value_of_form(value, kind, before);
    }
    if (form_text(value, member).empty()) return nullptr;  // an unknown member can be removed
    refuse_change(fmt::format("{} does not have a member {}", part_text(object), quote(member)));
  }

  /// `sync`, `assume`, and `set` of a node are added with their first member, and removed with the last one.
  static bool is_made_with_members(const JsonPath& object) {
    if (object.size() == 1) return object[0] == "sync" || object[0] == "assume";
    return object.size() == 3 && object[0] == "nodes" && object[2] == "set";
  }

  /// Adds the object too.
  void put_with_object(const JsonPath& path, FormJson value) {
    const JsonPath object{path.begin(), path.end() - 1};
    const bool has_owner = object.empty() || exists({object.begin(), object.end() - 1});
    if (!is_made_with_members(object) || !has_owner) refuse_change(fmt::format("{} does not exist", part_text(object)));
    FormJson owner = FormJson::object();
    owner[path.back()] = std::move(value);
    put(object, owner);
  }

  void add(const JsonPath& path, const Wanted& members) {
    const bool is_node = path.size() == 2 && path[0] == "nodes";
    if (!is_node && !(path.size() == 2 && path[0] == "signals" && path[1] == "-")) {
      refuse_change("a node is added at /nodes/NAME, a signal at /signals/-");
    }
    if (!members.is_object()) refuse_change("\"members\" is an object");
    if (is_node && path[1].empty()) refuse_change("a node needs a name");
    if (is_node && exists(path)) refuse_change(fmt::format("a node {} exists", quote(path[1])));
    const std::vector<MemberKind> kinds = kinds_of_members(path);
    FormJson value = FormJson::object();
    for (const MemberKind& kind : kinds) {
      const auto member = members.find(kind.name);
      if (member == members.end()) continue;
      if (FormJson one = value_of_form(*member, kind, {}); !one.is_null())
        value[std::string{kind.name}] = std::move(one);
    }
    for (const auto& [name, ignored] : members.items()) {
      (void)value_of_member(path, name, ignored, {});
    }
    const JsonPath owner{path[0]};
    if (exists(owner)) {
      if (!is_node && !value_text(owner).starts_with('[')) refuse_change("signals is not an array");
      put(path, value);
    } else {
      FormJson whole = is_node ? FormJson::object() : FormJson::array();
      if (is_node) {
        whole[path[1]] = std::move(value);
      } else {
        whole.push_back(std::move(value));
      }
      put(owner, whole);
    }
    name_ = is_node ? fmt::format("add node {}", path[1]) : "add a signal";
  }

  void remove(const JsonPath& path) {
    if (!exists(path)) refuse_change(fmt::format("{} does not exist", part_text(path)));
    cut(path);
    name_ = fmt::format("remove {}", part_text(path));
  }

  void rename(const JsonPath& path, const std::string& wanted) {
    const std::string name{trim(wanted)};
    const bool is_node = path.size() == 2 && path[0] == "nodes";
    const bool is_entry = path.size() == 4 && path[0] == "nodes" && path[2] == "set";
    if (!is_node && !is_entry) refuse_change("a node or an entry of \"set\" can be renamed");
    if (!exists(path)) refuse_change(fmt::format("{} does not exist", part_text(path)));
    if (name.empty()) refuse_change("the name is empty");
    if (name == path.back()) return;
    JsonPath after = path;
    after.back() = name;
    if (exists(after)) refuse_change(fmt::format("{} exists", quote(name)));
    if (is_node) rename_in_uses(path[1], name);
    text_ = *with_json_name(text_, path, name);
    name_ = fmt::format("rename {} to {}", part_text(path), name);
    is_renamed_ = true;
  }

  /// `sync.producer`, and `from`, `to` and `object` of the signals.
  void rename_in_uses(const std::string& name, const std::string& other) {
    const auto renamed = [&](const std::string& text) {
      return text == name || text.starts_with(name + ".") ? other + text.substr(name.size()) : text;
    };
    const auto rename_at = [&](const JsonPath& path) {
      const auto text = text_at(path);
      if (text && renamed(*text) != *text) put(path, renamed(*text));
    };
    if (text_at({"sync", "producer"}) == name) put({"sync", "producer"}, other);
    for (std::size_t i = 0; exists({"signals", std::to_string(i)}); ++i) {
      const JsonPath signal{"signals", std::to_string(i)};
      const auto member = [&](const char* one) { return JsonPath{signal[0], signal[1], one}; };
      if (is_of_master(text_at(member("from")))) rename_at(member("object"));
      if (text_at(member("from")) == name) put(member("from"), other);
      rename_at(member("to"));
      for (std::size_t j = 0; exists({signal[0], signal[1], "to", std::to_string(j)}); ++j) {
        rename_at({signal[0], signal[1], "to", std::to_string(j)});
      }
    }
  }

  /// Whether the objects of signals of this node have the name of another node: it is a master without a file.
  [[nodiscard]] bool is_of_master(const std::optional<std::string>& node) const {
    return node && exists({"nodes", *node}) && !exists({"nodes", *node, "eds"}) && !exists({"nodes", *node, "dcf"});
  }

  void move(const JsonPath& path, const Wanted& to) {
    if (!to.is_number_unsigned()) refuse_change("\"to\" is a place, from 0");
    const auto moved = with_json_moved(text_, path, to.get<std::size_t>());
    if (!moved) refuse_change(fmt::format("{} cannot be moved to place {}", part_text(path), to.dump()));
    text_ = *moved;
    name_ = fmt::format("move {} to place {}", part_text(path), to.get<std::size_t>() + 1);
  }

  // The text.

  [[nodiscard]] bool exists(const JsonPath& path) const { return JsonRanges{text_}.find(path).has_value(); }

  /// The text of a value; empty if there is none.
  [[nodiscard]] std::string value_text(const JsonPath& path) const {
    const JsonRanges ranges{text_};
    const auto at = ranges.find(path);
    return at ? std::string{ranges.value_text(ranges[*at])} : "";
  }
  [[nodiscard]] std::optional<std::string> text_at(const JsonPath& path) const {
    const std::string text = value_text(path);
    return text.starts_with('"') ? std::optional{Wanted::parse(text).get<std::string>()} : std::nullopt;
  }

  void put(const JsonPath& path, const FormJson& value) {
    auto changed = with_json_value(text_, path, value);
    if (!changed) refuse_change(fmt::format("{} is not an object", part_text({path.begin(), path.end() - 1})));
    text_ = *std::move(changed);
  }

  /// Removes a value, and its object if nothing is left in it that was made with it.
  void cut(const JsonPath& path) {
    text_ = *without_json_value(text_, path);
    const JsonPath object{path.begin(), path.end() - 1};
    if (!is_made_with_members(object)) return;
    if (value_text(object).find_first_not_of("{} \t\r\n") == std::string::npos)
      text_ = *without_json_value(text_, object);
  }

  std::string text_;
  std::string name_;
  bool is_renamed_ = false;
};

}  // namespace

ChangedNetwork change_network(std::string_view text, const nlohmann::json& list, std::size_t count) {
  NetworkChanger changer{text};
  std::string name;
  for (std::size_t i = 0; i < count; ++i) {
    try {
      changer.make(list[i]);
    } catch (const RefusedChange& refused) {
      return {std::string{text}, {}, false, refused.problem, i};
    }
    if (i == 0) name = changer.name();
  }
  if (count > 1) name = fmt::format("{} and {}", name, counted(count - 1, "more change"));
  return {changer.text(), std::move(name), changer.is_renamed(), {}, 0};
}

}  // namespace edsc::edit
