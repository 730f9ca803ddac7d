/// DOMAINs that the application reads or writes piece by piece while SDO transfers them, without a buffer for the whole
/// value.
///
///     canopen::on_domain_read<od::log_file>([&](std::uint32_t offset, std::span<std::uint8_t> bytes) {
///       return flash.read(offset, bytes);  // number of bytes; fewer than requested: the end
///     }),
///     canopen::on_domain_write<od::firmware>(
///         [&](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
///           return flash.program(offset, bytes) ? canopen::ok : canopen::AbortCode::hardware;
///         })
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value.hpp"

namespace canopen {

template <DictionaryObject Object, class Function>
struct DomainReadHandler {
  using object = Object;
  [[no_unique_address]] Function call;
};

template <DictionaryObject Object, class Function>
struct DomainWriteHandler {
  using object = Object;
  [[no_unique_address]] Function call;
};

/// Calls `handler(offset, bytes)` or `handler(node, offset, bytes)` for each piece of an upload. The handler fills the
/// bytes and returns how many there are, or an AbortCode, as a Result. Fewer bytes than requested end the value. A
/// piece that was lost on the bus is requested again.
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr DomainReadHandler<Object, Function> on_domain_read(Function handler) {
  static_assert(std::is_same_v<typename Object::type, Domain>, "only a DOMAIN is read piece by piece");
  static_assert(readable(Object::access), "this DOMAIN is not read over the bus");
  return {std::move(handler)};
}

/// Calls `handler(offset, bytes, last)` or `handler(node, offset, bytes, last)` for each piece of a download, once and
/// in order. An AbortCode other than `ok` aborts the transfer; a handler that returns void accepts the piece. The last
/// piece is passed only if the transfer has succeeded; after an aborted one, the next download starts at offset 0.
template <DictionaryObject Object, class Function>
[[nodiscard]] constexpr DomainWriteHandler<Object, Function> on_domain_write(Function handler) {
  static_assert(std::is_same_v<typename Object::type, Domain>, "only a DOMAIN is written piece by piece");
  static_assert(writable(Object::access), "this DOMAIN is not written over the bus");
  return {std::move(handler)};
}

/// The memory of a DOMAIN, as a part of a node: a download may fill all of it, an upload sends its first `size` bytes.
/// It must outlive the node. Without memory, the application calls `bind` of the node.
template <DictionaryObject Object>
struct BoundTo {
  using object = Object;
  std::span<std::uint8_t> memory{};
  std::size_t size = 0;
};

/// Binds a DOMAIN to memory, which is also its value; a second number is the size of the value in bytes:
///     auto node = canopen::make_node<Device>(bus, node_id, canopen::bound_to<od::parameter_file>(memory));
template <DictionaryObject Object>
[[nodiscard]] constexpr BoundTo<Object> bound_to(std::span<std::uint8_t> memory, std::size_t size) {
  static_assert(std::is_same_v<typename Object::type, Domain>, "bound_to: only a DOMAIN is bound to memory");
  return {memory, size < memory.size() ? size : memory.size()};
}
template <DictionaryObject Object>
[[nodiscard]] constexpr BoundTo<Object> bound_to(std::span<std::uint8_t> memory) {
  return bound_to<Object>(memory, memory.size());
}

namespace domain_detail {

template <class Handler>
inline constexpr bool is_bound_to = false;
template <class Object>
inline constexpr bool is_bound_to<BoundTo<Object>> = true;

template <class Handler>
inline constexpr bool is_reader = false;
template <class Object, class Function>
inline constexpr bool is_reader<DomainReadHandler<Object, Function>> = true;

template <class Handler>
inline constexpr bool is_writer = false;
template <class Object, class Function>
inline constexpr bool is_writer<DomainWriteHandler<Object, Function>> = true;

/// Calls `handler` with the arguments, and with the node first if it does not accept them alone.
template <class Function, class Node, class... Arguments>
constexpr decltype(auto) call(Function& handler, [[maybe_unused]] Node& node, Arguments... arguments) {
  if constexpr (std::is_invocable_v<Function&, Arguments...>) {
    return handler(arguments...);
  } else {
    static_assert(std::is_invocable_v<Function&, Node&, Arguments...>,
                  "a handler of a DOMAIN takes (offset, bytes) or (offset, bytes, last), the node before them or not");
    return handler(node, arguments...);
  }
}

}  // namespace domain_detail

/// Those handlers of a node that stream DOMAINs, as an SDO server calls them: the functions of DomainStreamHooks.
template <class... Handlers>
struct DomainHandlerSet {
  /// Whether such handlers exist; if not, a server does not contain code for streams.
  static constexpr bool any =
      ((domain_detail::is_reader<Handlers> || domain_detail::is_writer<Handlers>) || ... || false);

  [[nodiscard]] static constexpr bool streams_upload(std::uint32_t key) {
    return (matches<Handlers, domain_detail::is_reader<Handlers>>(key) || ... || false);
  }
  [[nodiscard]] static constexpr bool streams_download(std::uint32_t key) {
    return (matches<Handlers, domain_detail::is_writer<Handlers>>(key) || ... || false);
  }

  template <class Node>
  [[nodiscard]] static Result<std::uint32_t> read(std::tuple<Handlers...>& handlers, Node& node, std::uint32_t key,
                                                  std::uint32_t offset, std::span<std::uint8_t> bytes) {
    Result<std::uint32_t> result = AbortCode::no_data;
    const auto offer = [&]<class HandlerType>([[maybe_unused]] HandlerType& handler) {
      if constexpr (domain_detail::is_reader<HandlerType>) {
        if (matches<HandlerType, true>(key)) result = domain_detail::call(handler.call, node, offset, bytes);
      }
    };
    std::apply([&](auto&... handler) { (offer(handler), ...); }, handlers);
    return result;
  }

  template <class Node>
  [[nodiscard]] static AbortCode write(std::tuple<Handlers...>& handlers, Node& node, std::uint32_t key,
                                       std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
    AbortCode code = AbortCode::not_stored;
    const auto offer = [&]<class HandlerType>([[maybe_unused]] HandlerType& handler) {
      if constexpr (domain_detail::is_writer<HandlerType>) {
        if (matches<HandlerType, true>(key)) code = take(handler, node, offset, bytes, last);
      }
    };
    std::apply([&](auto&... handler) { (offer(handler), ...); }, handlers);
    return code;
  }

 private:
  template <class HandlerType, bool Streams>
  [[nodiscard]] static constexpr bool matches([[maybe_unused]] std::uint32_t key) {
    if constexpr (Streams) {
      return key == object_key(HandlerType::object::index, HandlerType::object::sub_index);
    } else {
      return false;
    }
  }

  template <class HandlerType, class Node>
  [[nodiscard]] static AbortCode take(HandlerType& handler, Node& node, std::uint32_t offset,
                                      std::span<const std::uint8_t> bytes, bool last) {
    using Answer = decltype(domain_detail::call(handler.call, node, offset, bytes, last));
    if constexpr (std::is_same_v<Answer, AbortCode>) {
      return domain_detail::call(handler.call, node, offset, bytes, last);
    } else {
      static_assert(std::is_void_v<Answer>, "a handler of a DOMAIN's download answers an AbortCode or nothing");
      domain_detail::call(handler.call, node, offset, bytes, last);
      return ok;
    }
  }
};

}  // namespace canopen
