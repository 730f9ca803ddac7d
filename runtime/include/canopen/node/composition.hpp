/// The composition of a device: which parts its node has.
///
/// An EDS promises services that need a part of the program: storage for 1010h and 1011h, a port for LSS, memory for a
/// DOMAIN. A node without such a part does not compile, unless its composition states that the device omits it:
///
///     // pump.hpp: named once, for the program and for its conformance test
///     using PumpParts = canopen::Composition<pump::Device, Pump, canopen::without<canopen::part::lss>>;
///
///     canopen::Node<PumpParts, Bus, canopen::StoredIn<Flash>> node{bus, node_id, canopen::stored_in(flash)};
///     auto node = canopen::make_node<PumpParts>(bus, node_id, canopen::stored_in(flash));
///
///     edsc_add_conformance_test(pump_conforms pump COMPOSITION pump.hpp PumpParts)
///
/// The composition has everything that determines the behaviour of the device. What depends on the hardware follows in
/// the node: `stored_in`, `configured_by_lss`, `bound_to`, `on_domain_read`, `on_domain_write` and `values_from`. The
/// conformance test uses the same composition with its own storage, LSS port and memory, and lists what is omitted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "canopen/base/label.hpp"
#include "canopen/lss/lss_handler.hpp"
#include "canopen/node/application.hpp"
#include "canopen/node/handled.hpp"
#include "canopen/node/values_from.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/object_list.hpp"
#include "canopen/od/sheet.hpp"
#include "canopen/od/value.hpp"
#include "canopen/sdo/domain_handlers.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

template <class Device, class BusType, class... Parts>
class Node;

/// A device, its application classes and handlers, and `without<...>`. The parts are default-constructible, or their
/// values are passed to the node.
template <class Device, class... Parts>
struct Composition {};

/// Parts that a device omits although its EDS promises them: `part::lss`, `part::storage`, or objects of type DOMAIN. A
/// device without LSS ignores LSS; without storage, 1010h and 1011h reject every write; a DOMAIN without memory has no
/// data.
template <class... Parts>
struct without {};

// One row for each kind of part: what promises it, and what keeps the promise. The third kind are DOMAINs, each by its
// object.
namespace part {

/// LSS_Supported in the EDS.
struct lss {
  static constexpr char name[] = "lss";
  template <class Device>
  static constexpr bool is_promised = lss_detail::HasLss<Device>;
  template <class Handler>
  static constexpr bool is_kept_by = lss_detail::is_handler<Handler>;
};

/// 1010h or 1011h in the EDS.
struct storage {
  static constexpr char name[] = "storage";
  template <class Device>
  static constexpr bool is_promised = Device::dictionary.has(0x1010, 0) || Device::dictionary.has(0x1011, 0);
  template <class Handler>
  static constexpr bool is_kept_by = storage_detail::is_stored_in<Handler>;
};

}  // namespace part

namespace composition_detail {

template <class Parts, class Device>
inline constexpr bool is_of = false;
template <class Device, class... Parts>
inline constexpr bool is_of<Composition<Device, Parts...>, Device> = true;

/// What a composition omits, as a part of its node.
template <class... Parts>
struct Omits {};

template <class Part>
inline constexpr bool is_omits = false;
template <class... Parts>
inline constexpr bool is_omits<Omits<Parts...>> = true;
template <class Part>
inline constexpr bool is_without = false;
template <class... Parts>
inline constexpr bool is_without<without<Parts...>> = true;

template <class Part, class... Others>
inline constexpr bool is_among = (std::is_same_v<Part, Others> || ...);
template <class Part, class Handler>
inline constexpr bool is_omitted_by = false;
template <class Part, class... Parts>
inline constexpr bool is_omitted_by<Part, Omits<Parts...>> = is_among<Part, Parts...>;

struct IsDomain {
  template <class Object>
  static constexpr bool selects = std::is_same_v<typename Object::type, Domain>;
};

/// Whether a dictionary has a DOMAIN: most do not, and its objects need not be searched.
template <class Device>
inline constexpr bool has_domain = [] {
  for (const entry::Word word : Device::dictionary.entries) {
    if (entry::kind_of(word) <= entry::Kind::var && word != Dictionary::no_object && entry::is_domain(word))
      return true;
  }
  for (const entry::Word word : Device::dictionary.subs) {
    if (word != entry::gap && entry::is_domain(word)) return true;
  }
  return false;
}();

/// Whether a DOMAIN has its bytes from the generated device.
template <class Device, class Object>
inline constexpr bool is_generated = Object::index == 0x1021 && requires {
  Device::stored_eds;
};

template <class Object, class Handler>
inline constexpr bool is_of_object = false;
template <class Object, class Handler>
requires requires { typename Handler::object; }
inline constexpr bool is_of_object<Object, Handler> =
    Object::index == Handler::object::index && Object::sub_index == Handler::object::sub_index;

/// Whether handlers provide the bytes of a DOMAIN that is read, and take those of one that is written.
template <class Object, class... Handlers>
inline constexpr bool is_domain_kept =
    (!readable(Object::access) || ((is_of_object<Object, Handlers> &&
                                    (domain_detail::is_bound_to<Handlers> || domain_detail::is_reader<Handlers>)) ||
                                   ...)) &&
    (!writable(Object::access) || ((is_of_object<Object, Handlers> &&
                                    (domain_detail::is_bound_to<Handlers> || domain_detail::is_writer<Handlers>)) ||
                                   ...));

template <class Device, class Part>
[[nodiscard]] constexpr bool is_promised() {
  if constexpr (requires { Part::template is_promised<Device>; }) {
    return Part::template is_promised<Device>;
  } else if constexpr (DictionaryObject<Part>) {
    return IsDomain::selects<Part> && Device::dictionary.has(Part::index, Part::sub_index) &&
           !is_generated<Device, Part>;
  } else {
    return false;
  }
}

template <class Part, class... Handlers>
[[nodiscard]] constexpr bool is_kept() {
  if constexpr (DictionaryObject<Part>) {
    return is_domain_kept<Part, Handlers...>;
  } else {
    return (Part::template is_kept_by<Handlers> || ...);
  }
}

template <class Part, class... Handlers>
inline constexpr bool is_omitted = (is_omitted_by<Part, Handlers> || ...);

/// Whether the EDS of a device promises a part that its node neither has nor omits.
template <class Device, class Part, class... Handlers>
inline constexpr bool is_missing = is_promised<Device, Part>() && !is_kept<Part, Handlers...>() &&
                                   !is_omitted<Part, Handlers...>;

/// The DOMAINs among these parts.
template <class Device, class... Handlers>
struct IsMissingDomain {
  template <class Object>
  static constexpr bool selects = IsDomain::selects<Object>&& is_missing<Device, Object, Handlers...>;
};
template <bool HasAny, class Device, class... Handlers>
struct FindMissingDomains {
  using type = ObjectList<>;
};
template <class Device, class... Handlers>
struct FindMissingDomains<true, Device, Handlers...> {
  using type = SelectObjects<IsMissingDomain<Device, Handlers...>, typename Device::Objects>;
};
template <class Device, class... Handlers>
using MissingDomains = typename FindMissingDomains<has_domain<Device> && !has_sheet<Device>, Device, Handlers...>::type;

/// Types that a rule does not accept: they are in the message of the compiler.
template <class... Wrong>
struct Types {
  template <class... Others>
  friend Types<Wrong..., Others...> operator+(Types, Types<Others...>);
};
template <class List>
inline constexpr bool is_empty = false;
template <>
inline constexpr bool is_empty<Types<>> = true;
template <>
inline constexpr bool is_empty<ObjectList<>> = true;

template <bool IsWrong, class Part>
using If = std::conditional_t<IsWrong, Types<Part>, Types<>>;

/// The parts that a composition omits although the EDS does not promise them, or although the node has them.
template <class Device, class Handler>
struct Unpromised {
  using type = Types<>;
};
template <class Device, class... Parts>
struct Unpromised<Device, Omits<Parts...>> {
  using type = decltype((Types<>{} + ... + If<!is_promised<Device, Parts>(), Parts>{}));
};
template <class Device, class... Handlers>
using UnpromisedParts = decltype((Types<>{} + ... + typename Unpromised<Device, Handlers>::type{}));

template <class Handler, class... Handlers>
struct KeptAfterAll {
  using type = Types<>;
};
template <class... Parts, class... Handlers>
struct KeptAfterAll<Omits<Parts...>, Handlers...> {
  using type = decltype((Types<>{} + ... + If<is_kept<Parts, Handlers...>(), Parts>{}));
};
template <class... Handlers>
using KeptParts = decltype((Types<>{} + ... + typename KeptAfterAll<Handlers, Handlers...>::type{}));

/// Whether a part of a node depends on the hardware, so that it follows the composition.
template <class Part>
inline constexpr bool is_port =
    storage_detail::is_stored_in<Part> || lss_detail::is_handler<Part> || domain_detail::is_bound_to<Part> ||
    domain_detail::is_reader<Part> || domain_detail::is_writer<Part> || mailbox_detail::is_values_from<Part>;
template <class... Parts>
using NoPorts = decltype((Types<>{} + ... + If<!is_port<Parts>, Parts>{}));

/// Whether a part belongs to the hardware alone.
template <class Part>
inline constexpr bool is_hardware = storage_detail::is_stored_in<Part> || lss_detail::is_handler<Part>;
template <class... Parts>
using HardwareParts = decltype((Types<>{} + ... + If<is_hardware<Parts>, Parts>{}));

/// All parts that are missing, as one part that omits them: for nodes whose parts a library determines.
template <class... Parts, class... Domains>
Omits<Parts..., Domains...> omits(Types<Parts...>, ObjectList<Domains...>);
template <class Device, class... Handlers>
using OmitsMissing = decltype(omits(If<is_missing<Device, part::lss, Handlers...>, part::lss>{} +
                                        If<is_missing<Device, part::storage, Handlers...>, part::storage>{},
                                    MissingDomains<Device, Handlers...>{}));

/// The device of a composition, and the node of a device or a composition with parts that a library adds.
template <class Device>
struct Extended {
  using DeviceType = Device;
  template <class BusType, class Added, class... Parts>
  struct NodeWith;
  template <class BusType, class... Added, class... Parts>
  struct NodeWith<BusType, Types<Added...>, Parts...> {
    using type = Node<Device, BusType, Added..., Parts...>;
  };
};
template <class Device, class... Composed>
struct Extended<Composition<Device, Composed...>> {
  using DeviceType = Device;
  template <class BusType, class Added, class... Ports>
  struct NodeWith;
  template <class BusType, class... Added, class... Ports>
  struct NodeWith<BusType, Types<Added...>, Ports...> {
    using type = Node<Composition<Device, Composed..., Added...>, BusType, Ports...>;
  };
};
template <class Device>
using DeviceOf = typename Extended<Device>::DeviceType;
template <class Device, class BusType, class Added, class... Parts>
using NodeWith = typename Extended<Device>::template NodeWith<BusType, Added, Parts...>::type;

/// The node of a device with these parts; of a composition, those that it lists are not added to it.
template <class Device, class BusType, class... Given>
struct NodeFor {
  using type = Node<Device, BusType, Given...>;
};
template <class Device, class BusType, class... Ports>
Node<Device, BusType, Ports...>* node_with(Types<Ports...>);
template <class Device, class... Composed, class BusType, class... Given>
struct NodeFor<Composition<Device, Composed...>, BusType, Given...> {
  using type = std::remove_pointer_t<decltype(node_with<Composition<Device, Composed...>, BusType>(
      (Types<>{} + ... + If<!is_among<Given, Composed...>, Given>{})))>;
};

template <class Part>
struct Composed {
  using type = Part;
};
template <class... Parts>
struct Composed<without<Parts...>> {
  using type = Omits<Parts...>;
};

}  // namespace composition_detail

/// Whether a type is a composition of a device.
template <class Parts, class Device>
inline constexpr bool is_composition_of = composition_detail::is_of<Parts, Device>;

}  // namespace canopen
