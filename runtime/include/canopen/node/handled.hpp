/// Which objects and events each handler of a node handles, and how it is called. An application class handles several:
/// node/application.hpp.
#pragma once

#include <cstdint>
#include <type_traits>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/node/functions.hpp"
#include "canopen/node/handlers.hpp"
#include "canopen/od/object_list.hpp"

namespace canopen::handler_detail {

template <class T>
inline constexpr bool is_result = false;
template <class T>
inline constexpr bool is_result<Result<T>> = true;

/// Calls a write handler and returns its answer as an abort code.
template <class Ask>
[[nodiscard]] constexpr AbortCode code_of(Ask&& ask) {
  using Answer = decltype(ask());
  if constexpr (std::is_same_v<Answer, AbortCode>) {
    return ask();
  } else if constexpr (std::is_same_v<Answer, Result<void>>) {
    return ask().abort_code();
  } else {
    static_assert(std::is_void_v<Answer>, "a write handler returns an AbortCode, a Result<void> or nothing");
    ask();
    return ok;
  }
}

/// Calls a read handler and sets the value that it returns.
template <DictionaryObject O, class Node, class Ask>
[[nodiscard]] constexpr AbortCode supply(Node& node, Ask&& ask) {
  using Answer = decltype(ask());
  if constexpr (std::is_void_v<Answer>) {
    ask();
    return ok;
  } else if constexpr (std::is_same_v<Answer, AbortCode>) {
    return ask();
  } else if constexpr (is_result<Answer>) {
    const Answer answer = ask();
    return answer ? node.template set<O>(*answer) : answer.abort_code();
  } else {
    return node.template set<O>(ask());
  }
}

/// What a handler without further specialization handles: nothing.
struct HandlesNothing {
  using BeforeWrite = ObjectList<>;  ///< objects, before a received value is stored
  using AfterWrite = ObjectList<>;   ///< the same, after it has been stored
  using Read = ObjectList<>;         ///< objects, before they are sent
  /// Whether the handler has the function of an event.
  template <class Event>
  static constexpr bool has_event_function = false;

  template <DictionaryObject O, class H, class Node>
  static constexpr AbortCode before_write(H&, Node&, const typename O::type&) {
    return ok;
  }
  template <DictionaryObject O, class H, class Node>
  static constexpr void after_write(H&, Node&, const typename O::type&) {}
  template <DictionaryObject O, class H, class Node>
  static constexpr AbortCode read(H&, Node&) {
    return ok;
  }
  /// Calls the function of an event, if the handler has it.
  template <class Event, class H, class Node, class... Arguments>
  static constexpr void notify(H&, Node&, const Arguments&...) {}
  /// Calls the function of one of its periods.
  template <class P, class H, class Node>
  static constexpr void every(H&, Node&) {}
};

/// `Node` may be incomplete.
template <class Device, class Node, class H>
struct Handled : HandlesNothing {};

template <class Device, class Node, class O, class F>
struct Handled<Device, Node, WriteHandler<O, F>> : HandlesNothing {
  using BeforeWrite = ObjectList<O>;
  template <DictionaryObject>
  static constexpr AbortCode before_write(WriteHandler<O, F>& handler, Node& node, const typename O::type& value) {
    return code_of([&]() -> decltype(auto) { return call(handler.call, node, value); });
  }
};

template <class Device, class Node, class O, class F>
struct Handled<Device, Node, WrittenHandler<O, F>> : HandlesNothing {
  using AfterWrite = ObjectList<O>;
  template <DictionaryObject>
  static constexpr void after_write(WrittenHandler<O, F>& handler, Node& node, const typename O::type& value) {
    call(handler.call, node, value);
  }
};

template <class Device, class Node, class O, class F>
struct Handled<Device, Node, ReadHandler<O, F>> : HandlesNothing {
  using Read = ObjectList<O>;
  template <DictionaryObject>
  static constexpr AbortCode read(ReadHandler<O, F>& handler, Node& node) {
    return supply<O>(node, [&]() -> decltype(auto) { return call(handler.call, node); });
  }
};

template <class Device, class Node, class Event, class F>
struct Handled<Device, Node, EventHandler<Event, F>> : HandlesNothing {
  template <class Asked>
  static constexpr bool has_event_function = std::is_same_v<Asked, Event>;
  template <class Notified, class... Arguments>
  static constexpr void notify(EventHandler<Event, F>& handler, Node& node, const Arguments&... arguments) {
    if constexpr (std::is_same_v<Notified, Event>) call(handler.call, node, arguments...);
  }
};

template <class Device, class Node, class P, class F>
struct Handled<Device, Node, PeriodicHandler<P, F>> : HandlesNothing {
  template <class>
  static constexpr void every(PeriodicHandler<P, F>& handler, Node& node) {
    call(handler.call, node);
  }
};

}  // namespace canopen::handler_detail
