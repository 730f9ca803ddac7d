/// Non-volatile memory for parameters, as a node uses it: one image of bytes that is replaced as a whole.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>

namespace canopen {

/// Result of opening a storage. Damaged: an image exists, but cannot be read or has a wrong checksum; `size` and `read`
/// then access an older one, if it exists.
enum class StorageState : std::uint8_t { empty, whole, damaged };

/// `begin`, `write` and `commit` write a new image. After a power loss either the old or the new image exists; until
/// `commit`, `size` and `read` access the old one. False: the medium has failed.
template <class Type>
concept Storage = requires(Type& storage, std::uint32_t number, std::span<std::uint8_t> to,
                           std::span<const std::uint8_t> from) {
  { storage.open() } -> std::same_as<StorageState>;    ///< looks for an image; once at power-on
  { storage.size() } -> std::same_as<std::uint32_t>;   ///< bytes of the image; 0: none
  { storage.read(number, to) } -> std::same_as<bool>;  ///< reads the image from a position on
  { storage.begin(number) } -> std::same_as<bool>;     ///< starts a new image of this size
  { storage.write(from) } -> std::same_as<bool>;       ///< appends bytes to it
  { storage.commit() } -> std::same_as<bool>;          ///< completes it
};

/// A storage that `commit` only asks to write the image, of at most `capacity` bytes: `step` does so, a part at a time,
/// as long as it is busy. BackgroundStorage is one.
template <class Type>
concept SteppedStorage = Storage<Type> && requires(Type& storage) {
  { Type::capacity } -> std::convertible_to<std::uint32_t>;
  { storage.busy() } -> std::same_as<bool>;    ///< steps are left
  { storage.ready() } -> std::same_as<bool>;   ///< the next one can be executed now
  { storage.failed() } -> std::same_as<bool>;  ///< the last image could not be written
  storage.step();
  storage.finish();  ///< all steps that are left
};

/// The storage of a node, passed with its handlers. It must outlive the node.
template <Storage StorageType>
struct StoredIn {
  StorageType* storage;
};

/// Gives a node its storage:
///     auto drive = canopen::make_node<Device>(bus, NodeId{5}, canopen::stored_in(flash), canopen::on_write<...>(...));
template <Storage StorageType>
[[nodiscard]] constexpr StoredIn<StorageType> stored_in(StorageType& storage) {
  return {&storage};
}

/// A node without storage: 1010h and 1011h reject every write.
struct NoStorage {};

namespace storage_detail {

/// Calls of `ready` of a medium in one wait, unless it has a `max_polls` of its own. At 10 cycles for each, 10 s at
/// 100 MHz: longer than any erase of a page.
template <class Medium>
inline constexpr std::uint32_t max_polls = 100'000'000;
template <class Medium>
requires requires { Medium::max_polls; }
inline constexpr std::uint32_t max_polls<Medium> = Medium::max_polls;

template <class Handler>
inline constexpr bool is_stored_in = false;
template <Storage StorageType>
inline constexpr bool is_stored_in<StoredIn<StorageType>> = true;

/// Whether a storage is among the handlers of a node.
template <class... Handlers>
inline constexpr bool has_storage = (is_stored_in<Handlers> || ...);

template <class Handler>
inline constexpr bool is_stepped = false;
template <Storage StorageType>
inline constexpr bool is_stepped<StoredIn<StorageType>> = SteppedStorage<StorageType>;

}  // namespace storage_detail

}  // namespace canopen
