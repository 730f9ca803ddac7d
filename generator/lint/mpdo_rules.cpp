#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/mpdo_lists.hpp>
#include <canopen/pdo/pdo_mapping.hpp>
#include <canopen/pdo/transmission_type.hpp>

#include "device/options/option_table.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "lint/rule_groups.hpp"

namespace edsc {
namespace {

constexpr unsigned max_mpdo_bits = 32;

bool served(const Options& options) {
  const OptionRow* const mpdo = find_option("pdo", "mpdo");
  return std::ranges::any_of(options.runtime,
                             [&](const RuntimeOption& option) { return option.row == mpdo && option.value != 0; });
}

std::uint64_t mapped_objects(const Pdo& pdo) { return pdo.mapping->find(0)->default_value->bits; }

bool is_source_multiplexed(const Pdo& pdo) {
  return pdo.multiplexed && mapped_objects(pdo) == canopen::source_multiplexed;
}

void check_option(const RuleContext& context, const Pdo& pdo) {
  if (served(context.options)) return;
  context.report("mpdo-option", default_place(*pdo.mapping->find(0)),
                 fmt::format("{} is a multiplex PDO ({} mapped objects), which requires the option \"pdo.mpdo\"",
                             pdo_label(pdo), mapped_objects(pdo)));
}

void check_type(const RuleContext& context, const Pdo& pdo) {
  const auto type = communication_default(pdo, transmission_type_sub_index);
  if (!type || canopen::transmission_of(static_cast<std::uint32_t>(*type)) == canopen::Transmission::event_driven) {
    return;
  }
  context.report(
      "mpdo-transmission-type", default_place(*pdo.communication->find(transmission_type_sub_index)),
      fmt::format("{} is a multiplex PDO: its transmission type must be 254 or 255, not {}", pdo_label(pdo), *type));
}

template <class Element>
bool is_list(const Object& object) {
  return object.index >= Element::first_list && object.index <= Element::last_list;
}

template <class Element>
void check_has_list(const RuleContext& context, const Pdo& pdo, std::string_view name) {
  if (std::ranges::any_of(context.device.objects, is_list<Element>)) return;
  context.report(
      "mpdo-list", default_place(*pdo.mapping->find(0)),
      fmt::format("{} is a multiplex PDO in source addressing mode, but the object {} list ({} to {}) is missing",
                  pdo_label(pdo), name, index_label(Element::first_list), index_label(Element::last_list)));
}

/// Why an MPDO cannot map an object in this direction; empty if it can.
std::string_view obstacle(const Device& device, std::uint16_t index, unsigned sub_index, canopen::Mappable direction) {
  const Entry* object = sub_index > 0xFF ? nullptr : device.find(index, static_cast<std::uint8_t>(sub_index));
  if (object == nullptr) return "does not exist";
  if (!canopen::allows(object->mappable(), direction)) return "is not PDO-mappable";
  return object->type->bits == 0 || object->type->bits > max_mpdo_bits ? "does not have a length of 1 to 32 bits" : "";
}

/// Checks the objects in the default values of a list.
template <class Element>
void check_elements(const RuleContext& context, const Object& list, canopen::Mappable direction) {
  for (const Entry& entry : list.entries) {
    if (entry.sub_index == 0 || !entry.default_value || entry.default_value->bits == 0) continue;
    const Element element{static_cast<typename Element::Value>(entry.default_value->bits)};
    for (unsigned i = 0; i < element.size(); ++i) {
      const unsigned sub_index = element.sub_index() + i;
      const std::string_view why = obstacle(context.device, element.index(), sub_index, direction);
      if (why.empty()) continue;
      context.report(
          "mpdo-list-object", default_place(entry),
          fmt::format("{} lists {}:{:02X}, which {}", named(entry), index_label(element.index()), sub_index, why));
      break;
    }
  }
}

void check_lists(const RuleContext& context) {
  for (const Object& object : context.device.objects) {
    if (is_list<canopen::ScannedObjects>(object)) {
      check_elements<canopen::ScannedObjects>(context, object, canopen::Mappable::tpdo);
    } else if (is_list<canopen::DispatchedObjects>(object)) {
      check_elements<canopen::DispatchedObjects>(context, object, canopen::Mappable::rpdo);
    }
  }
}

}  // namespace

void check_mpdos(const RuleContext& context) {
  const Pdo* producer = nullptr;
  for (const Pdo& pdo : context.device.pdos) {
    if (!pdo.multiplexed) continue;
    check_option(context, pdo);
    check_type(context, pdo);
    if (!is_source_multiplexed(pdo)) continue;
    if (pdo.direction == PdoDirection::receive) {
      check_has_list<canopen::DispatchedObjects>(context, pdo, "dispatching");
      continue;
    }
    check_has_list<canopen::ScannedObjects>(context, pdo, "scanner");
    if (producer != nullptr) {
      context.report(
          "mpdo-second-producer", default_place(*pdo.mapping->find(0)),
          fmt::format("{} is a second producer in source addressing mode; a device can have only one", pdo_label(pdo)),
          {{default_place(*producer->mapping->find(0)), pdo_label(*producer)}});
    }
    producer = &pdo;
  }
  check_lists(context);
}

}  // namespace edsc
