/// Storage in memory, for simulations and tests: it lasts as long as the object. Host side.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "canopen/storage/storage.hpp"

namespace canopen {

/// Storage in memory. A copy has the same contents. The members of type bool make it fail.
struct MemoryStorage {
  std::vector<std::uint8_t> image;  ///< empty: nothing has been stored
  std::vector<std::uint8_t> fresh;  ///< the image that is being written
  bool damaged = false;             ///< `open` reports a damaged image
  bool fails_to_read = false;
  bool fails_to_commit = false;
  int commits = 0;  ///< images written so far

  [[nodiscard]] StorageState open() const {
    if (damaged) return StorageState::damaged;
    return image.empty() ? StorageState::empty : StorageState::whole;
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(image.size()); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    if (fails_to_read || position > image.size() || to.size() > image.size() - position) return false;
    if (!to.empty()) std::memcpy(to.data(), image.data() + position, to.size());
    return true;
  }
  [[nodiscard]] bool begin(std::uint32_t size) {
    fresh.clear();
    fresh.reserve(size);
    return true;
  }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    fresh.insert(fresh.end(), bytes.begin(), bytes.end());
    return true;
  }
  [[nodiscard]] bool commit() {
    if (fails_to_commit) return false;
    ++commits;
    image = fresh;
    return true;
  }
};

}  // namespace canopen
