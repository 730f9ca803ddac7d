/// Walks through the entries of a concise DCF (CiA 302-2, 1F22h).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "canopen/base/bytes.hpp"

namespace canopen {

/// A place in a concise DCF: the number of its entries, 32 bits, then for each of them index, sub-index, the number of
/// its bytes in 32 bits, and these bytes. The DCF is passed to each call.
class ConciseDcfPlace {
 public:
  using Dcf = std::span<const std::uint8_t>;

  /// Goes to the first entry.
  void begin(Dcf dcf) {
    position_ = sizeof(std::uint32_t);
    left_ = dcf.empty() ? 0 : little_endian_number(dcf.first(std::min(dcf.size(), sizeof(std::uint32_t))));
  }

  /// Goes to the next entry; `data` must have returned the bytes of the present one.
  void advance(Dcf dcf) {
    position_ += static_cast<std::uint32_t>(head + data(dcf)->size());
    --left_;
  }

  [[nodiscard]] bool at_end() const { return left_ == 0; }

  [[nodiscard]] std::uint16_t index(Dcf dcf) const {
    return static_cast<std::uint16_t>(little_endian_number(dcf.subspan(position_, 2)));
  }
  [[nodiscard]] std::uint8_t sub_index(Dcf dcf) const { return dcf[position_ + 2]; }

  /// Returns the bytes of the present entry; empty if the DCF is too short.
  [[nodiscard]] std::optional<Dcf> data(Dcf dcf) const {
    const std::size_t at = position_;
    if (dcf.size() < at || dcf.size() - at < head) return std::nullopt;
    const std::size_t size = little_endian_number(dcf.subspan(at + 3, 4));
    if (dcf.size() - at - head < size) return std::nullopt;
    return dcf.subspan(at + head, size);
  }

  /// Whether the present entry is written again by a later one.
  [[nodiscard]] bool is_written_again(Dcf dcf) const {
    ConciseDcfPlace other = *this;
    for (other.advance(dcf); !other.at_end() && other.data(dcf); other.advance(dcf)) {
      if (other.index(dcf) == index(dcf) && other.sub_index(dcf) == sub_index(dcf)) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t head = 7;  ///< bytes of an entry before its data

  std::uint32_t position_ = 0;
  std::uint32_t left_ = 0;  ///< entries from the present one on
};

}  // namespace canopen
