/// What keeps parameters without power, as a node sees it: one image of bytes that is replaced as a whole.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>

namespace canopen {

/// What a storage holds when it is opened. Damaged: there was an image, and it cannot be read or its checksum is wrong;
/// `size` and `read` give an older one, if there is one.
enum class StorageState : std::uint8_t { empty, whole, damaged };

/// `begin`, `write` and `commit` make a new image. Whenever power is lost there is the old image or the new one; until
/// `commit` `size` and `read` mean the old one. False is an error of the medium.
template <class T>
concept Storage = requires(T& storage, std::uint32_t number, std::span<std::uint8_t> to,
                           std::span<const std::uint8_t> from) {
  { storage.open() } -> std::same_as<StorageState>;    ///< looks for an image; once at power-on
  { storage.size() } -> std::same_as<std::uint32_t>;   ///< bytes of the image; 0: there is none
  { storage.read(number, to) } -> std::same_as<bool>;  ///< bytes of the image from a position on
  { storage.begin(number) } -> std::same_as<bool>;     ///< a new image of so many bytes
  { storage.write(from) } -> std::same_as<bool>;       ///< its next bytes
  { storage.commit() } -> std::same_as<bool>;          ///< it is whole
};

/// The storage of a node, named among its handlers. It must outlive the node.
template <Storage S>
struct StoredIn {
  S* storage;
};

/// Gives a node its storage:
///     auto drive = canopen::make_node<Device>(bus, NodeId{5}, canopen::stored_in(flash), canopen::on_write<...>(...));
template <Storage S>
[[nodiscard]] constexpr StoredIn<S> stored_in(S& storage) {
  return {&storage};
}

/// A node without storage: 1010h and 1011h refuse what is written to them.
struct NoStorage {};

namespace storage_detail {

template <class Handler>
inline constexpr bool is_stored_in = false;
template <Storage S>
inline constexpr bool is_stored_in<StoredIn<S>> = true;

}  // namespace storage_detail

}  // namespace canopen
