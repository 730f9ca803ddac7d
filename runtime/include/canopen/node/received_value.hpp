/// Values that a node receives: the checks of services and handlers, and what follows from a new value.
///
/// The functions are `inline`: GCC then inlines them like functions that are defined in a class.
#pragma once

#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/optimization.hpp"
#include "canopen/node/handler_calls.hpp"
#include "canopen/node/value_check.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Whether `check_received` may have anything to check.
template <class Host>
[[nodiscard]] inline bool has_checks(Host& host, std::uint16_t index, std::uint8_t sub_index) {
  return Host::Handlers::has_write_handlers || is_communication_index(index) ||
         host.services.checks_application_object(index, sub_index);
}

/// Checks whether a received value, whose length and limits are correct, may be written: asks the services, then calls
/// the write handlers of the object. Both may change the bytes.
template <class Host>
[[nodiscard]] inline AbortCode check_received(Host& host, std::uint16_t index, std::uint8_t sub_index,
                                              std::span<std::uint8_t> bytes) {
  if (is_communication_index(index) || host.services.checks_application_object(index, sub_index)) {
    if (const AbortCode code = host.services.check_write(host, index, sub_index, bytes); code != ok) return code;
  }
  if constexpr (Host::Handlers::has_write_handlers) {
    const std::uint32_t key = object_key(index, sub_index);
    const HandlerCall call{host.handler_calls, key};
    return host.handlers.before_write(host.node(), key, bytes);
  }
  return ok;
}

/// Calls the handlers that use an object after it has been written. A command that they request is executed after the
/// response of the SDO server.
template <class Host>
inline void notify_written([[maybe_unused]] Host& host, [[maybe_unused]] std::uint16_t index,
                           [[maybe_unused]] std::uint8_t sub_index) {
  if constexpr (Host::Handlers::has_written_handlers) {
    const HandlerCall call{host.handler_calls};
    host.handlers.after_write(host.node(), object_key(index, sub_index), host.store);
  }
}

/// Applies a value from a PDO to an object by index and sub-index. A value outside its limits, or rejected by its
/// handler, is ignored.
template <class Host>
inline void take_received(Host& host, std::uint16_t index, std::uint8_t sub_index, std::span<std::uint8_t> bytes) {
  using Entries = EntryAccess<typename Host::Device>;
  const entry::Word word = host.store.entries().find(index, sub_index);
  if (Entries::kinds.booleans && entry::is_boolean(word)) bytes[0] = bytes[0] != 0 ? 1 : 0;
  if (host.store.entries().check(index, sub_index, word, bytes) != ok) return;
  if (check_received(host, index, sub_index, bytes) != ok) return;
  if (!host.handler_calls.set_by_handler() && !host.store.entries().holds(word, bytes)) {
    host.store.entries().write_value(word, bytes);
    host.after_write(index, sub_index, true);
  }
  notify_written(host, index, sub_index);
}

/// The same for an object that is known at compile time.
template <DictionaryObject Object, class Host>
inline void take_received(Host& host, const typename Object::type& value) {
  // A mode of operation that equals the stored one, which a master sends in each frame, is ignored: saves 4
  // instructions of a Cortex-M4, takes 12 bytes of a Cortex-M0+.
  if constexpr (!prefers_size && requires { Object::accepted; } && !Host::Handlers::template handles_write<Object> &&
                !Host::Handlers::template handles_written<Object>) {
    if (value == host.store.template get<Object>()) return;
  }
  if (check_limits<Object>(value) != ok) return;
  if constexpr (Host::Handlers::template handles_write<Object>) {
    {
      const HandlerCall call{host.handler_calls, object_key(Object::index, Object::sub_index)};
      if (host.handlers.template before_write<Object>(host.node(), value) != ok) return;
    }
    if (host.handler_calls.set_by_handler()) return notify_written(host, Object::index, Object::sub_index);
  }
  if (host.store.template set<Object>(value)) host.template on_new_value<Object>();
  if constexpr (Host::Handlers::template handles_written<Object>)
    notify_written(host, Object::index, Object::sub_index);
}

}  // namespace canopen
