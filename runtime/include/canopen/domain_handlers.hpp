/// DOMAINs that the application gives and takes piece by piece while SDO transfers them: no memory holds them whole.
///
///     canopen::on_domain_read<od::log_file>([&](std::uint32_t offset, std::span<std::uint8_t> bytes) {
///       return flash.read(offset, bytes);  // how many bytes there were; fewer than asked for: the end
///     }),
///     canopen::on_domain_write<od::firmware>([&](std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last)
///     {
///       return flash.program(offset, bytes) ? canopen::ok : canopen::AbortCode::hardware;
///     })
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "canopen/abort_code.hpp"
#include "canopen/dictionary.hpp"
#include "canopen/object.hpp"
#include "canopen/result.hpp"
#include "canopen/value.hpp"

namespace canopen {

template <DictionaryObject O, class F>
struct DomainReadHandler {
  using object = O;
  [[no_unique_address]] F call;
};

template <DictionaryObject O, class F>
struct DomainWriteHandler {
  using object = O;
  [[no_unique_address]] F call;
};

/// Called for each piece of an upload: `handler(offset, bytes)` or `handler(node, offset, bytes)` fills the bytes and
/// answers how many there were, or an AbortCode as a Result. Fewer than asked for are the last. A piece that was lost
/// on the bus is asked for again.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr DomainReadHandler<O, F> on_domain_read(F handler) {
  static_assert(std::is_same_v<typename O::type, Domain>, "only a DOMAIN is read piece by piece");
  static_assert(readable(O::access), "this DOMAIN is not read over the bus");
  return {std::move(handler)};
}

/// Called for each piece of a download, once and in order: `handler(offset, bytes, last)` or `handler(node, offset,
/// bytes, last)`. An AbortCode other than `ok` ends the transfer; no answer is a yes. The last piece comes when the
/// transfer is good; what broke off has none, and the next download begins at offset 0 again.
template <DictionaryObject O, class F>
[[nodiscard]] constexpr DomainWriteHandler<O, F> on_domain_write(F handler) {
  static_assert(std::is_same_v<typename O::type, Domain>, "only a DOMAIN is written piece by piece");
  static_assert(writable(O::access), "this DOMAIN is not written over the bus");
  return {std::move(handler)};
}

namespace domain_detail {

template <class Handler>
inline constexpr bool is_reader = false;
template <class O, class F>
inline constexpr bool is_reader<DomainReadHandler<O, F>> = true;

template <class Handler>
inline constexpr bool is_writer = false;
template <class O, class F>
inline constexpr bool is_writer<DomainWriteHandler<O, F>> = true;

/// Calls with the arguments, with the node before them if the callable wants it.
template <class F, class Node, class... Arguments>
constexpr decltype(auto) call(F& handler, [[maybe_unused]] Node& node, Arguments... arguments) {
  if constexpr (std::is_invocable_v<F&, Arguments...>) {
    return handler(arguments...);
  } else {
    static_assert(std::is_invocable_v<F&, Node&, Arguments...>,
                  "a handler of a DOMAIN takes (offset, bytes) or (offset, bytes, last), the node before them or not");
    return handler(node, arguments...);
  }
}

}  // namespace domain_detail

/// What an SDO server asks of those of a node's handlers that stream DOMAINs: the functions of DomainStreamHooks.
template <class... Handlers>
struct DomainHandlerSet {
  /// Whether there are any: without them a server has no code for streams.
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
    const auto offer = [&]<class H>([[maybe_unused]] H& handler) {
      if constexpr (domain_detail::is_reader<H>) {
        if (matches<H, true>(key)) result = domain_detail::call(handler.call, node, offset, bytes);
      }
    };
    std::apply([&](auto&... handler) { (offer(handler), ...); }, handlers);
    return result;
  }

  template <class Node>
  [[nodiscard]] static AbortCode write(std::tuple<Handlers...>& handlers, Node& node, std::uint32_t key,
                                       std::uint32_t offset, std::span<const std::uint8_t> bytes, bool last) {
    AbortCode code = AbortCode::not_stored;
    const auto offer = [&]<class H>([[maybe_unused]] H& handler) {
      if constexpr (domain_detail::is_writer<H>) {
        if (matches<H, true>(key)) code = take(handler, node, offset, bytes, last);
      }
    };
    std::apply([&](auto&... handler) { (offer(handler), ...); }, handlers);
    return code;
  }

 private:
  template <class H, bool Streams>
  [[nodiscard]] static constexpr bool matches([[maybe_unused]] std::uint32_t key) {
    if constexpr (Streams) {
      return key == object_key(H::object::index, H::object::sub_index);
    } else {
      return false;
    }
  }

  template <class H, class Node>
  [[nodiscard]] static AbortCode take(H& handler, Node& node, std::uint32_t offset, std::span<const std::uint8_t> bytes,
                                      bool last) {
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
