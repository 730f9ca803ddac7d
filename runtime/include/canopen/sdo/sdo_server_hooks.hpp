/// The functions of a node that its SDO servers call.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/base/result.hpp"
#include "canopen/od/object_store.hpp"

namespace canopen {

/// Functions of the node that a server calls. They are passed by value, and have a reference to what they change:
///   EntryAccess<Device> entries();
///   AbortCode before_read(index, sub_index);            may refresh the value, or reject the access
///   AbortCode write(index, sub_index, word, bytes);     the bytes fit the entry: stores them, or rejects the access;
///                                                       those of a DOMAIN in memory are already there
///   void written(index, sub_index);                     the application has taken all bytes of a DOMAIN
///   AbortCode command(index, sub_index, bytes);         a write to an entry without a value, such as 1010h
/// and, optionally:
///   bool started_command();                             whether the request started a command that has not ended yet
template <class Type, class Device>
concept SdoServerHooks = requires(Type hooks, std::uint16_t index, std::uint8_t sub_index, entry::Word word,
                                  std::span<std::uint8_t> bytes) {
  { hooks.entries() } -> std::same_as<EntryAccess<Device>>;
  { hooks.before_read(index, sub_index) } -> std::same_as<AbortCode>;
  { hooks.write(index, sub_index, word, bytes) } -> std::same_as<AbortCode>;
  hooks.written(index, sub_index);
  { hooks.command(index, sub_index, bytes) } -> std::same_as<AbortCode>;
};

/// Further functions if the application streams DOMAINs, which then need no memory of their own:
///   bool streams_upload(index, sub_index);      whether `read_domain` provides the bytes of this entry
///   Result<std::uint32_t> read_domain(index, sub_index, offset, bytes);
///       fills `bytes` and returns how many there are: fewer than requested end the value. A lost block is read again.
///   bool streams_download(index, sub_index);    whether `write_domain` accepts the bytes of this entry
///   AbortCode write_domain(index, sub_index, offset, bytes, last);
///       each byte once and in order. `last` is passed when the transfer has succeeded, including its CRC; an aborted
///       transfer has none, and the next one starts at offset 0.
template <class Type, class Device>
concept DomainStreamHooks = SdoServerHooks<Type, Device> &&
    requires(Type hooks, std::uint16_t index, std::uint8_t sub_index, std::uint32_t offset,
             std::span<std::uint8_t> into, std::span<const std::uint8_t> from) {
  { hooks.streams_upload(index, sub_index) } -> std::same_as<bool>;
  { hooks.read_domain(index, sub_index, offset, into) } -> std::same_as<Result<std::uint32_t>>;
  { hooks.streams_download(index, sub_index) } -> std::same_as<bool>;
  { hooks.write_domain(index, sub_index, offset, from, true) } -> std::same_as<AbortCode>;
};

}  // namespace canopen
