#include "lookup/find_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "diagnostics/quote.hpp"
#include "eds/ini.hpp"
#include "text/ascii.hpp"
#include "text/number_text.hpp"
#include "text/snake_case.hpp"
#include "text/suggestion.hpp"

namespace edsc {
namespace {

constexpr std::size_t max_suggestions = 3;
constexpr std::size_t max_listed = 8;  ///< sub-indices in a message
constexpr std::size_t max_name_length = 1000;
constexpr std::size_t max_names_with_suggestions = 50;  ///< more messages of one kind are not printed

/// `2`, `0x2`, `02h`; after an index with h, all digits are hexadecimal.
std::optional<std::uint8_t> parse_sub_index(std::string_view text, int base) {
  const Digits digits = digits_of(text, base);
  return parse_whole<std::uint8_t>(digits.text, digits.base);
}

bool same_name(std::string_view text, std::string_view identifier, std::string_view name) {
  return equal_ignoring_case(text, identifier) || equal_ignoring_case(text, name) ||
         (!text.empty() && to_snake_case(text) == identifier);
}

const Entry* find_in(const Object& object, std::string_view text, const Identifiers& names) {
  const auto same = [&](const Entry& entry) { return same_name(text, names.of(entry), entry.parameter_name()); };
  const auto at = std::ranges::find_if(object.entries, same);
  if (at != object.entries.end()) return &*at;
  const auto sub_index = parse_sub_index(text, 10);
  return sub_index ? object.find(*sub_index) : nullptr;
}

FoundEntry found(const Object& object, const Entry* entry = nullptr) {
  if (entry == nullptr && !object.has_sub_indices() && !object.entries.empty()) entry = &object.entries.front();
  return {&object, entry, ""};
}

FoundEntry no_entry(std::string sentence) { return {nullptr, nullptr, std::move(sentence)}; }

std::string sub_indices_of(const Object& object, const Identifiers& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(object.entries.size(), max_listed); ++i) {
    const Entry& entry = object.entries[i];
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", entry_label(entry.index, entry.sub_index), names.of(entry));
  }
  if (object.entries.size() > max_listed) {
    const Entry& last = object.entries.back();
    text += fmt::format(" ... {} {}", entry_label(last.index, last.sub_index), names.of(last));
  }
  return text;
}

/// `1018h:01 identity_object.vendor_id`
std::string entry_title(const Object& object, const Entry& entry, const Identifiers& names) {
  const std::string label = entry_label(entry.index, entry.sub_index);
  if (!object.has_sub_indices()) return fmt::format("{} {}", label, names.of(object));
  return fmt::format("{} {}.{}", label, names.of(object), names.of(entry));
}

// Suggestions

/// Suggestions for a name: the fewest different letters first, then names that contain it.
class Suggestions {
 public:
  explicit Suggestions(std::string_view text)
      : wanted_{to_snake_case(text)}, most_{std::max<std::size_t>(2, wanted_.size() / 4)} {}

  void consider(std::string_view identifier, std::string label) {
    if (wanted_.empty() || identifier.size() > max_name_length) return;
    std::size_t cost = edit_distance(wanted_, identifier, most_);
    const bool inside = wanted_.size() >= 3 && identifier.find(wanted_) != std::string_view::npos;
    if (cost > most_ && !inside) return;
    if (cost > most_) cost = most_ + identifier.size();
    rows_.emplace_back(cost, std::move(label));
  }

  /// `; did you mean a or b?`
  [[nodiscard]] std::string text() {
    std::ranges::stable_sort(rows_, {}, &Row::first);
    const auto same = [](const Row& a, const Row& b) { return a.second == b.second; };
    rows_.erase(std::unique(rows_.begin(), rows_.end(), same), rows_.end());
    if (rows_.empty()) return "";
    std::string out = "; did you mean ";
    const std::size_t count = std::min(rows_.size(), max_suggestions);
    for (std::size_t i = 0; i < count; ++i) {
      out += i == 0 ? "" : i + 1 == count ? " or " : ", ";
      out += rows_[i].second;
    }
    return out + "?";
  }

 private:
  using Row = std::pair<std::size_t, std::string>;

  std::string wanted_;
  std::size_t most_;
  std::vector<Row> rows_;
};

/// The neighbours of a missing index.
std::string near_indices(const NamedDevice& named, std::uint16_t index) {
  const Identifiers& names = named.identifiers();
  const auto above = std::ranges::upper_bound(named.device.objects, index, {}, &Object::index);
  std::string text;
  const auto add = [&](const Object& object) {
    text += fmt::format("{}{} {}", text.empty() ? "; the nearest objects are " : " and ", index_label(object.index),
                        names.of(object));
  };
  if (above != named.device.objects.begin()) add(*std::prev(above));
  if (above != named.device.objects.end()) add(*above);
  return text;
}

FoundEntry by_address(const NamedDevice& named, const EntryAddress& address) {
  const Object* object = named.device.find(address.index);
  if (object == nullptr) {
    return no_entry(
        fmt::format("the device has no object {}{}", index_label(address.index), near_indices(named, address.index)));
  }
  if (!address.sub_index) return found(*object);
  const Entry* entry = object->find(*address.sub_index);
  if (entry == nullptr) {
    return no_entry(fmt::format("{} \"{}\" has no sub-index {:02X}h; it has {}", index_label(object->index),
                                object->name, *address.sub_index, sub_indices_of(*object, named.identifiers())));
  }
  return found(*object, entry);
}

std::string lower_case(std::string_view text) {
  std::string lower{text};
  for (char& c : lower) c = to_lower(c);
  return lower;
}

/// Adds one with its names. Nothing is found by an empty identifier.
template <class Names, class Named>
void add_names(Names& names, const Named& named, std::string_view identifier, std::string_view name) {
  const std::string lower_identifier = lower_case(identifier);
  const std::string lower_name = lower_case(name);
  names.by_name[lower_identifier].push_back(named);
  if (lower_name != lower_identifier) names.by_name[lower_name].push_back(named);
  names.by_identifier[std::string{identifier}].push_back(named);
}

}  // namespace

std::optional<EntryAddress> parse_entry_address(std::string_view text) {
  text = trim(text);
  const std::size_t colon = text.find(':');
  const std::string_view index_text = text.substr(0, colon);
  const std::string_view digits = digits_of(index_text).text;
  const auto index = parse_whole<std::uint16_t>(digits, 16);
  if (!index || digits.size() != 4) return std::nullopt;
  if (colon == std::string_view::npos) return EntryAddress{*index, std::nullopt};
  const bool has_prefix = digits.data() != index_text.data();
  const auto sub_index = parse_sub_index(text.substr(colon + 1), has_prefix ? 10 : 16);
  return sub_index ? std::optional{EntryAddress{*index, sub_index}} : std::nullopt;
}

EntryFinder::EntryFinder(const NamedDevice& named) : named_{named} {
  for (const Object& object : named.device.objects) {
    add_names(objects_, &object, named.identifiers().of(object), object.parameter_name());
    if (!object.has_sub_indices()) continue;
    for (const Entry& entry : object.entries) {
      add_names(entries_, NamedEntry{&object, &entry}, named.identifiers().of(entry), entry.parameter_name());
      by_full_name_.emplace(named.identifiers().full(entry), NamedEntry{&object, &entry});
    }
  }
}

template <class Named>
EntryFinder::Matches<Named> EntryFinder::find_named(const Names<Named>& names, std::string_view text) {
  Matches<Named> matches;
  if (const auto at = names.by_name.find(lower_case(text)); at != names.by_name.end()) matches.by_name = at->second;
  if (text.empty()) return matches;
  const auto at = names.by_identifier.find(to_snake_case(text));
  if (at != names.by_identifier.end()) matches.by_identifier = at->second;
  return matches;
}

const Object* EntryFinder::find_object(std::string_view text) const {
  const auto [by_name, by_identifier] = find_named(objects_, text);
  if (by_name.empty()) return by_identifier.empty() ? nullptr : by_identifier.front();
  return by_identifier.empty() ? by_name.front() : std::min(by_name.front(), by_identifier.front());
}

std::string EntryFinder::near_names(std::string_view text) {
  if (suggestions_++ >= max_names_with_suggestions) return "";
  const Identifiers& names = named_.identifiers();
  Suggestions suggestions{text};
  for (const Object& object : named_.device.objects) {
    suggestions.consider(names.of(object), fmt::format("{} ({})", names.of(object), index_label(object.index)));
    if (!object.has_sub_indices()) continue;
    for (const Entry& entry : object.entries) {
      if (entry.sub_index == 0) continue;
      const std::string label = entry_title(object, entry, names);
      suggestions.consider(names.of(entry), label);
      suggestions.consider(names.full(entry), label);
    }
  }
  return suggestions.text();
}

/// `identity_object.vendor_id`, `identity_object:1`, `Identity object, Vendor-ID`, `read_input_8_bit[1]`: every place
/// where the object name may end is tried, since names may contain all of these characters.
std::optional<FoundEntry> EntryFinder::by_both_names(std::string_view text) const {
  for (std::size_t at = text.find_first_of(".,:[<"); at != std::string_view::npos;
       at = text.find_first_of(".,:[<", at + 1)) {
    const Object* object = find_object(trim(text.substr(0, at)));
    if (object == nullptr) continue;
    std::string_view rest = text.substr(at + 1);
    if ((text[at] == '[' && rest.ends_with(']')) || (text[at] == '<' && rest.ends_with('>'))) rest.remove_suffix(1);
    if (text[at] == ':' && rest.starts_with(':')) rest.remove_prefix(1);
    if (const Entry* entry = find_in(*object, trim(rest), named_.identifiers())) return found(*object, entry);
    return no_entry(fmt::format("{} \"{}\" has no entry \"{}\"; it has {}", index_label(object->index), object->name,
                                trim(rest), sub_indices_of(*object, named_.identifiers())));
  }
  return std::nullopt;
}

/// The name of a sub-index alone.
FoundEntry EntryFinder::by_entry_name(std::string_view text) {
  const auto [by_name, by_identifier] = find_named(entries_, text);
  std::vector<NamedEntry> matches;
  std::ranges::set_union(by_name, by_identifier, std::back_inserter(matches));
  if (matches.size() == 1) return found(*matches.front().object, matches.front().entry);
  if (matches.empty()) return no_entry(fmt::format("the device has no object \"{}\"{}", text, near_names(text)));
  std::string sentence = fmt::format("\"{}\" is ambiguous:", text);
  for (std::size_t i = 0; i < std::min(matches.size(), max_suggestions); ++i) {
    sentence += fmt::format("{} {}", i == 0 ? "" : " or",
                            entry_title(*matches[i].object, *matches[i].entry, named_.identifiers()));
  }
  if (matches.size() > max_suggestions) sentence += fmt::format(" or {} more", matches.size() - max_suggestions);
  return no_entry(std::move(sentence));
}

FoundEntry EntryFinder::find_new(std::string_view text) {
  if (text.size() > max_name_length)
    return no_entry(fmt::format("{} is too long for the name of an entry", quote(text)));
  if (const Object* object = find_object(text)) return found(*object);
  if (const auto address = parse_entry_address(text)) return by_address(named_, *address);
  if (const auto at = by_full_name_.find(to_snake_case(text)); at != by_full_name_.end()) {
    return found(*at->second.object, at->second.entry);
  }
  if (auto both = by_both_names(text)) return *std::move(both);
  return by_entry_name(text);
}

FoundEntry EntryFinder::find(std::string_view text) {
  text = trim(text);
  if (text.starts_with("od::")) text.remove_prefix(4);
  const auto [at, is_new] = found_.try_emplace(std::string{text});
  if (is_new) at->second = find_new(text);
  return at->second;
}

FoundEntry EntryFinder::find_one(std::string_view text) {
  FoundEntry result = find(text);
  if (result.ok() && result.entry == nullptr) {
    result.problem = fmt::format("{} \"{}\" has sub-indices: {}", index_label(result.object->index),
                                 result.object->name, sub_indices_of(*result.object, named_.identifiers()));
  }
  return result;
}

FoundEntry find_entry(const NamedDevice& named, std::string_view text) { return EntryFinder{named}.find(text); }

FoundEntry find_one_entry(const NamedDevice& named, std::string_view text) { return EntryFinder{named}.find_one(text); }

}  // namespace edsc
