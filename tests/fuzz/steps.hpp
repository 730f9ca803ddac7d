/// The input of fuzz targets that drive a state machine: a sequence of steps of twelve bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace edsc::fuzz {

struct Step {
  std::uint8_t what;
  std::uint8_t choice;
  std::array<std::uint8_t, 8> data;
  std::uint8_t number;
  std::uint8_t other;
};
static_assert(sizeof(Step) == 12);

/// The complete steps of an input, in order. Allocates no memory.
class Steps {
 public:
  Steps(const std::uint8_t* data, std::size_t size) : begin_{data}, end_{data + size - size % sizeof(Step)} {}

  class Iterator {
   public:
    explicit Iterator(const std::uint8_t* at) : at_{at} {}
    Step operator*() const {
      Step step;
      std::memcpy(&step, at_, sizeof step);
      return step;
    }
    Iterator& operator++() {
      at_ += sizeof(Step);
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const std::uint8_t* at_;
  };

  [[nodiscard]] Iterator begin() const { return Iterator{begin_}; }
  [[nodiscard]] Iterator end() const { return Iterator{end_}; }

 private:
  const std::uint8_t* begin_;
  const std::uint8_t* end_;
};

/// How many more frames a bus accepts, and how many it has accepted.
struct Room {
  unsigned room = 1000;
  unsigned sent = 0;

  [[nodiscard]] bool take() {
    if (room == 0) return false;
    --room;
    ++sent;
    return true;
  }
};

}  // namespace edsc::fuzz
