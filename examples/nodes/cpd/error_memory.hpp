/// The last errors of a drive, in non-volatile memory. They are read one after the other.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "shared/node_storage.hpp"

namespace cpd_node {

class ErrorMemory {
 public:
  static constexpr std::size_t capacity = 20;

  explicit ErrorMemory(nodes::NodeStorage& storage) : storage_{storage} {}

  /// Loads the stored errors. Call it after power-on.
  void load() {
    std::array<std::uint8_t, 2 * capacity> image{};
    count_ = next_ = 0;
    if (storage_.open() != canopen::StorageState::whole || storage_.size() > image.size()) return;
    if (!storage_.read(0, std::span{image}.first(storage_.size()))) return;
    count_ = storage_.size() / 2;
    for (std::size_t i = 0; i < count_; ++i) {
      codes_[i] = static_cast<std::uint16_t>(image[2 * i] | image[2 * i + 1] << 8);
    }
  }

  /// Adds an error; if the memory is full, deletes the oldest one. Returns false if it could not be stored.
  bool add(std::uint16_t code) {
    if (count_ == capacity) {
      std::copy(codes_.begin() + 1, codes_.end(), codes_.begin());
      --count_;
      if (next_ > 0) --next_;
    }
    codes_[count_++] = code;
    std::array<std::uint8_t, 2 * capacity> image{};
    for (std::size_t i = 0; i < count_; ++i) {
      image[2 * i] = static_cast<std::uint8_t>(codes_[i]);
      image[2 * i + 1] = static_cast<std::uint8_t>(codes_[i] >> 8);
    }
    return storage_.begin(static_cast<std::uint32_t>(2 * count_)) &&
           storage_.write(std::span{image}.first(2 * count_)) && storage_.commit();
  }

  /// Returns the next error, beginning with the oldest; 0 after the newest.
  [[nodiscard]] std::uint16_t next() { return next_ < count_ ? codes_[next_++] : std::uint16_t{0}; }

  /// Continues with the oldest error.
  void rewind() { next_ = 0; }

 private:
  nodes::NodeStorage& storage_;
  std::array<std::uint16_t, capacity> codes_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;
};

}  // namespace cpd_node
