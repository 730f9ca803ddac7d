/// Storage in memory that fails when it is told to.
#pragma once

#include <canopen/storage.hpp>
#include <cstring>
#include <span>
#include <vector>

namespace bench {

struct MemoryStorage {
  std::vector<std::uint8_t> image;
  std::vector<std::uint8_t> fresh;
  bool damaged = false;
  bool fails_to_read = false;
  bool fails_to_commit = false;
  int commits = 0;

  [[nodiscard]] canopen::StorageState open() const {
    if (damaged) return canopen::StorageState::damaged;
    return image.empty() ? canopen::StorageState::empty : canopen::StorageState::whole;
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(image.size()); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    if (fails_to_read || position + to.size() > image.size()) return false;
    if (!to.empty()) std::memcpy(to.data(), &image.at(position), to.size());
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

}  // namespace bench
