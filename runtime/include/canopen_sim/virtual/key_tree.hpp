/// Finds the smallest of many keys, each of which may change at any time. Host side.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace canopen {

/// A key for each position 0, 1, 2, ...; all operations except `resize` take logarithmic time. Equal keys are found in
/// the order of their positions.
class KeyTree {
 public:
  using Key = std::uint64_t;
  /// The key of a position that does not have one.
  static constexpr Key none = std::numeric_limits<Key>::max();
  static constexpr std::size_t no_place = std::numeric_limits<std::size_t>::max();

  /// Adds positions without a key.
  void resize(std::size_t places) {
    if (places <= leaves_) return;
    const std::vector<Key> old(least_.begin() + static_cast<std::ptrdiff_t>(leaves_), least_.end());
    while (leaves_ < places) leaves_ *= 2;
    least_.assign(2 * leaves_, none);
    for (std::size_t place = 0; place < old.size(); ++place) set(place, old[place]);
  }

  void set(std::size_t place, Key key) {
    std::size_t at = leaves_ + place;
    if (least_[at] == key) return;
    least_[at] = key;
    for (at /= 2; at != 0; at /= 2) {
      const Key least = std::min(least_[2 * at], least_[2 * at + 1]);
      if (least_[at] == least) return;
      least_[at] = least;
    }
  }

  /// Returns the smallest key; `none` if no position has one.
  [[nodiscard]] Key least() const { return least_[1]; }

  /// Returns the first position from `from` on whose key is not greater than `key`; `no_place` if there is none.
  [[nodiscard]] std::size_t first_up_to(Key key, std::size_t from = 0) const {
    std::size_t at = leaves_ + from;
    if (from >= leaves_) return no_place;
    while (least_[at] > key) {
      while (at % 2 == 1) at /= 2;  // a right branch: continue after its parent
      if (at == 0) return no_place;
      ++at;
    }
    while (at < leaves_) at = least_[2 * at] <= key ? 2 * at : 2 * at + 1;
    return at - leaves_;
  }

 private:
  std::size_t leaves_ = 1;                 ///< a power of two
  std::vector<Key> least_ = {none, none};  ///< of each subtree; root 1, leaves in the last half
};

}  // namespace canopen
