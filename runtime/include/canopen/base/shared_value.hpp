/// The latest value of any size, which one context writes and another one reads: neither waits for the other.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>

#include "canopen/base/shared_number.hpp"

namespace canopen {

namespace shared_detail {

template <std::size_t Size>
struct WordOf {};
template <>
struct WordOf<1> {
  using type = std::uint8_t;
};
template <>
struct WordOf<2> {
  using type = std::uint16_t;
};
template <>
struct WordOf<4> {
  using type = std::uint32_t;
};

/// A value that every core loads and stores at once.
template <class Type>
class WordCell {
  using Word = typename WordOf<sizeof(Type)>::type;

 public:
  void write(const Type& value) {
    Word word;
    std::memcpy(&word, &value, sizeof word);
    word_.store(word, std::memory_order_release);
  }
  [[nodiscard]] Type read() {
    const Word word = word_.load(std::memory_order_acquire);
    Type value;
    std::memcpy(static_cast<void*>(&value), &word, sizeof word);
    return value;
  }

 private:
  std::atomic<Word> word_{0};
};

/// A wider value in one of four places: H. R. Simpson, "Four-slot fully asynchronous communication mechanism", IEE
/// Proceedings 137 (1990). The writer uses the pair of places that the reader has not announced, and in it the place
/// that is not the newest. The order of a store and the following load matters: both are sequentially consistent.
template <class Type>
class FourPlaces {
 public:
  void write(const Type& value) {
    const std::uint8_t pair = other(reading_.load());
    const std::uint8_t place = other(newest_[pair].load());
    places_[pair][place] = value;
    newest_[pair].store(place);
    written_.store(pair);
  }
  [[nodiscard]] Type read() {
    const std::uint8_t pair = written_.load();
    reading_.store(pair);
    return places_[pair][newest_[pair].load()];
  }

 private:
  [[nodiscard]] static std::uint8_t other(std::uint8_t number) { return number == 0 ? 1 : 0; }

  std::array<std::array<Type, 2>, 2> places_{};
  std::array<std::atomic<std::uint8_t>, 2> newest_{};  ///< place in each pair
  std::atomic<std::uint8_t> written_{0};               ///< pair that was written last
  std::atomic<std::uint8_t> reading_{0};               ///< pair that the reader uses
};

template <class Type>
inline constexpr bool is_word = sizeof(Type) == 1 || sizeof(Type) == 2 || sizeof(Type) == 4;

}  // namespace shared_detail

/// One context calls `publish`, any other one `is_new` and `take`. Values between two calls of `take` are lost, the
/// last one never is, and no value is torn. Loads and stores alone: a Cortex-M0 needs no library and no lock. RAM: the
/// size of a value of up to four bytes, four times that of a wider one and four bytes; and eight bytes.
template <class Type>
class SharedValue {
  static_assert(std::is_trivially_copyable_v<Type>);

 public:
  // ---- the writer ----

  void publish(const Type& value) {
    cell_.write(value);
    published_.publish(published_.own() + 1);
  }

  // ---- the reader ----

  /// Whether a value has been published since the last `take`.
  [[nodiscard]] bool is_new() const { return published_.read() != taken_; }

  /// Returns the latest value if one has been published since the last call.
  [[nodiscard]] std::optional<Type> take() {
    const std::uint32_t published = published_.read();
    if (published == taken_) return std::nullopt;
    taken_ = published;
    return cell_.read();
  }

 private:
  using Cell =
      std::conditional_t<shared_detail::is_word<Type>, shared_detail::WordCell<Type>, shared_detail::FourPlaces<Type>>;

  Cell cell_;
  SharedNumber<std::uint32_t> published_;  ///< number of values
  std::uint32_t taken_ = 0;                ///< of the reader: that number at the last `take`
};

}  // namespace canopen
