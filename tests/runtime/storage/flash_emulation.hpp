/// Two pages of flash as in a microcontroller; power can be cut during each erasure and each word.
#pragma once

#include <array>
#include <canopen/storage/flash_storage.hpp>
#include <cstring>
#include <limits>
#include <span>

namespace bench {

template <std::uint32_t PageSize, std::uint32_t WordSize>
struct FlashEmulation {
  static constexpr std::uint32_t page_size = PageSize;
  static constexpr std::uint32_t word_size = WordSize;

  /// What the cells contain of a word or page that was being written or erased when power was lost.
  enum class Cut { nothing_done, half_done, all_done };

  std::array<std::array<std::uint8_t, PageSize>, 2> pages{};
  std::array<int, 2> erased{};  ///< number of erasures
  int steps = 0;                ///< erasures and words so far
  int last_step = std::numeric_limits<int>::max();
  Cut cut = Cut::half_done;
  bool misused = false;  ///< a word was written twice or across a boundary

  FlashEmulation() {
    for (auto& page : pages) page.fill(0xFF);
  }

  void power_on() { last_step = std::numeric_limits<int>::max(); }
  [[nodiscard]] bool has_power() const { return steps <= last_step; }

  [[nodiscard]] bool erase(std::uint8_t page) {
    const std::size_t done = step(PageSize);
    std::memset(pages.at(page).data(), 0xFF, done);
    ++erased.at(page);
    return has_power();
  }

  [[nodiscard]] bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    if (offset % WordSize != 0 || words.size() % WordSize != 0 || offset + words.size() > PageSize) misused = true;
    for (std::uint32_t at = 0; at < words.size() && has_power(); at += WordSize) {
      const std::size_t done = step(WordSize);
      std::uint8_t* const cells = &pages.at(page).at(offset + at);
      for (std::size_t i = 0; i < done; ++i) {
        misused = misused || cells[i] != 0xFF;
        cells[i] = words[at + i];
      }
    }
    return has_power();
  }

  [[nodiscard]] bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) const {
    if (offset + to.size() > PageSize) return false;
    if (!to.empty()) std::memcpy(to.data(), &pages.at(page).at(offset), to.size());
    return true;
  }

 private:
  /// The number of bytes of this step that are completed.
  [[nodiscard]] std::size_t step(std::size_t bytes) {
    if (!has_power()) return 0;
    if (++steps <= last_step) return bytes;
    switch (cut) {
      case Cut::nothing_done: return 0;
      case Cut::half_done: return bytes / 2;
      case Cut::all_done: break;
    }
    return bytes;
  }
};

}  // namespace bench
