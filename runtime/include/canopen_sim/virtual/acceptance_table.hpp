/// Which of many receivers accept a frame: a row of bits for each CAN-ID. Host side.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "canopen/can/frame.hpp"
#include "canopen/node/accepted_frames.hpp"

namespace canopen {

/// Receivers at positions 0, 1, 2, ..., each with a list of accepted frames. A receiver of any extended frame is a
/// receiver of all of them.
class AcceptanceTable {
 public:
  static constexpr std::size_t no_place = static_cast<std::size_t>(-1);

  /// Adds receivers, which do not accept a frame before `accept` or `accept_all`.
  void resize(std::size_t places) {
    lists_.resize(places);
    const std::size_t words = (places + bits - 1) / bits;
    if (words == words_) return;
    words_ = words;
    all_.resize(words);
    table_.assign(rows * words, 0);
    for (std::size_t place = 0; place < places; ++place) {
      for (const AcceptedFrame& frame : lists_[place]) set(row_of(frame), place);
    }
  }

  /// Replaces the list of a receiver. Takes little time if it is the same as before.
  void accept(std::size_t place, const std::vector<AcceptedFrame>& frames) {
    List& list = lists_[place];
    if (list == frames) return;
    for (const AcceptedFrame& frame : list) reset(row_of(frame), place);
    list = frames;
    for (const AcceptedFrame& frame : list) set(row_of(frame), place);
  }

  /// Whether the receiver accepts each frame; otherwise, those of its list.
  void accept_all(std::size_t place, bool all) {
    const Word bit = Word{1} << (place % bits);
    all ? all_[place / bits] |= bit : all_[place / bits] &= ~bit;
  }

  /// Returns the first receiver of this frame from `from` on; `no_place` if there is none.
  [[nodiscard]] std::size_t first_receiver(const Frame& frame, std::size_t from) const {
    const Word* row = &table_[row_of({frame.id, frame.extended, frame.remote}) * words_];
    std::size_t word = from / bits;
    if (word >= words_) return no_place;
    Word rest = (row[word] | all_[word]) & (~Word{0} << (from % bits));
    while (rest == 0) {
      if (++word == words_) return no_place;
      rest = row[word] | all_[word];
    }
    return word * bits + static_cast<std::size_t>(std::countr_zero(rest));
  }

 private:
  using Word = std::uint64_t;
  static constexpr std::size_t bits = 64;
  static constexpr std::size_t extended_row = 2 * 0x800;
  static constexpr std::size_t rows = extended_row + 1;

  using List = std::vector<AcceptedFrame>;

  [[nodiscard]] static std::size_t row_of(const AcceptedFrame& frame) {
    return frame.extended ? extended_row : (frame.id & 0x7FF) + (frame.remote ? 0x800u : 0u);
  }

  void set(std::size_t row, std::size_t place) { table_[row * words_ + place / bits] |= Word{1} << (place % bits); }
  void reset(std::size_t row, std::size_t place) {
    table_[row * words_ + place / bits] &= ~(Word{1} << (place % bits));
  }

  std::size_t words_ = 0;    ///< of a row
  std::vector<Word> all_;    ///< a row: the receivers of each frame
  std::vector<Word> table_;  ///< a row for each CAN-ID of data frames, then of remote frames, then for extended ones
  std::vector<List> lists_;  ///< of each receiver
};

}  // namespace canopen
