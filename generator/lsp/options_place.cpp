#include "lsp/options_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "device/options/option_table.hpp"
#include "lookup/find_entry.hpp"
#include "lsp/network_place.hpp"
#include "text/markdown.hpp"

namespace edsc::lsp {
namespace {

/// A member that the table of options does not have.
struct NamedMember {
  std::string_view name;
  std::string_view meaning;
};

/// Of an object or entry in `meaning`.
constexpr NamedMember meaning_members[] = {
    {"unit", "unit of the physical value"},
    {"scale", "physical value of a raw value of 1: a number or a fraction"},
    {"offset", "added to the scaled value"},
    {"values", "names of numbers"},
    {"closed", "other numbers are rejected"},
    {"bits", "names of bits and of ranges of bits"},
    {"masked", "groups of named values of some bits together"},
    {"depends_on", "object whose value selects further fields"},
    {"cases", "fields for some values of the object of depends_on"},
    {"same_as", "the values or fields of another object"},
    {"text", "a sentence for documents"},
    {"place", "where the manual says it"},
};

/// Of a file of deviations.
constexpr NamedMember deviation_members[] = {
    {"case", "number of the case, as edsc conform --list prints it"},
    {"object", "object or entry for which the failure is expected; without it, all"},
    {"reason", "behaviour of the device, and why"},
    {"source", "where it is documented: the manual, its page or line"},
};

constexpr std::string_view deviations_member = "deviations";
constexpr std::string_view meaning_option = "meaning";

/// Without its link into docs/options.md.
std::string meaning_of(const OptionRow& row) { return std::string{row.meaning.substr(0, row.meaning.find(", [see "))}; }

std::string default_of(const OptionRow& row) {
  const std::string_view text = row.default_value.empty() ? row.default_text : row.default_value;
  return text.empty() ? std::string{} : fmt::format("default: {}", text);
}

const OptionRow* find_option(std::string_view group, std::string_view name) {
  const auto* const found = std::ranges::find_if(
      option_table::rows, [&](const OptionRow& row) { return row.group.name == group && row.name == name; });
  return found == std::end(option_table::rows) ? nullptr : found;
}

const OptionGroup* find_group(std::string_view name) {
  const auto* const found =
      std::ranges::find(option_table::rows, name, [](const OptionRow& row) { return row.group.name; });
  return name.empty() || found == std::end(option_table::rows) ? nullptr : &found->group;
}

/// Whether the names of the members here are objects or entries of the device.
bool names_objects(const std::vector<std::string>& path) {
  if (path.size() != 1) return false;
  constexpr std::string_view options[] = {meaning_option, "names", "string_capacity"};
  return std::ranges::find(options, path.front()) != std::end(options);
}

void offer_objects(const View& view, std::vector<JsonOffer>& offers) {
  const Device* const device = view.analysis.device();
  if (device == nullptr) return;
  for (const Object& object : device->objects) {
    if (!object.has_sub_indices()) {
      const std::string label = fmt::format("{:04X}h", object.index);
      offers.push_back({label, object.name, label});
      continue;
    }
    for (const Entry& entry : object.entries) {
      const std::string label = fmt::format("{:04X}h:{:02X}", entry.index, entry.sub_index);
      offers.push_back({label, object.name + ", " + entry.name, label});
    }
  }
}

template <class Members>
void offer_named(const Members& members, std::vector<JsonOffer>& offers) {
  for (const NamedMember& member : members) {
    offers.push_back({std::string{member.name}, std::string{member.meaning}, std::string{member.name}});
  }
}

void offer_option_members(const std::vector<std::string>& path, std::vector<JsonOffer>& offers) {
  const std::string_view group = path.empty() ? std::string_view{} : path.front();
  for (const OptionRow& row : option_table::rows) {
    const bool is_first_of_group =
        path.empty() && !row.group.name.empty() &&
        std::ranges::none_of(offers, [&](const JsonOffer& offer) { return offer.label == row.group.name; });
    if (is_first_of_group) {
      offers.push_back({std::string{row.group.name}, std::string{row.group.title}, std::string{row.group.name}});
    } else if (row.group.name == group) {
      offers.push_back({std::string{row.name}, meaning_of(row), std::string{row.name}});
    }
  }
}

void offer_options(const View& view, const JsonPlaceInText& place, std::vector<JsonOffer>& offers) {
  const std::vector<std::string>& path = place.path;
  if (names_objects(path)) return offer_objects(view, offers);
  if (path.size() == 2 && path.front() == meaning_option) return offer_named(meaning_members, offers);
  if (path.size() <= 1) offer_option_members(path, offers);
}

void offer_deviations(const View& view, const JsonPlaceInText& place, std::vector<JsonOffer>& offers) {
  const std::vector<std::string>& path = place.path;
  if (place.is_name && path.empty()) {
    offers.push_back({std::string{deviations_member}, "", std::string{deviations_member}});
  } else if (place.is_name) {
    offer_named(deviation_members, offers);
  } else if (!path.empty() && path.back() == "case") {
    for (const ConformanceCase& one : view.workspace.conformance_cases()) {
      offers.push_back({one.id, one.title, one.id});
    }
  }
}

/// `meaning` is Markdown.
std::string named_member_text(std::string_view name, std::string_view meaning, const std::string& more = {}) {
  return fmt::format("**{}**: {}{}{}", markdown_text(name), meaning, more.empty() ? "" : "; ", more);
}

template <class Members>
std::string describe_named(const Members& members, std::string_view name) {
  const auto* const found = std::ranges::find(members, name, &NamedMember::name);
  return found == std::end(members) ? std::string{} : named_member_text(found->name, found->meaning);
}

std::string describe_option(const View& view, const JsonPlaceInText& place) {
  const std::vector<std::string>& path = place.path;
  if (names_objects(path)) {
    const auto address = parse_entry_address(place.text);
    const Device* const device = view.analysis.device();
    return address && device != nullptr ? describe(*view.analysis.loaded, *device, *address) : std::string{};
  }
  if (path.size() == 2 && path.front() == meaning_option) return describe_named(meaning_members, place.text);
  if (path.size() > 1) return {};
  if (const OptionRow* const row = find_option(path.empty() ? std::string_view{} : path.front(), place.text)) {
    return named_member_text(row->name, meaning_of(*row), default_of(*row));
  }
  const OptionGroup* const group = path.empty() ? find_group(place.text) : nullptr;
  return group == nullptr ? std::string{} : named_member_text(group->name, group->title);
}

std::string describe_deviation(const View& view, const JsonPlaceInText& place) {
  if (place.is_name) return describe_named(deviation_members, place.text);
  if (place.path.empty() || place.path.back() != "case") return {};
  for (const ConformanceCase& one : view.workspace.conformance_cases()) {
    if (one.id == place.text) return named_member_text(one.id, markdown_text(one.title));
  }
  return {};
}

}  // namespace

std::string describe_options_place(const View& view, const TextPosition& at) {
  const JsonPlaceInText place = json_place(view.analysis.own->text(), offset_in(view, at));
  if (!place.is_in_string) return {};
  if (view.document.kind == DocumentKind::deviations) return describe_deviation(view, place);
  return place.is_name ? describe_option(view, place) : std::string{};
}

Json options_completion(const View& view, const TextPosition& at) {
  const JsonPlaceInText place = json_place(view.analysis.own->text(), offset_in(view, at));
  if (!place.is_in_string) return Json::array();
  std::vector<JsonOffer> offers;
  if (view.document.kind == DocumentKind::deviations) {
    offer_deviations(view, place, offers);
  } else if (place.is_name) {
    offer_options(view, place, offers);
  }
  return completion_items(view, at, place, std::move(offers));
}

}  // namespace edsc::lsp
