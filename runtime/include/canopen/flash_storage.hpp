/// Storage in two pages of flash: a new image goes into the page that does not hold the present one.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "canopen/crc16.hpp"
#include "canopen/storage.hpp"

namespace canopen {

/// Two pages, 0 and 1, of `page_size` bytes. What is erased can be written once, in words of `word_size` bytes: a power
/// of two, 32 at most. Offsets and sizes of `write` are multiples of it. False is an error of the medium.
template <class T>
concept FlashPages = requires(T& pages, std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words,
                              std::span<std::uint8_t> to) {
  { T::page_size } -> std::convertible_to<std::uint32_t>;
  { T::word_size } -> std::convertible_to<std::uint32_t>;
  { pages.erase(page) } -> std::same_as<bool>;
  { pages.write(page, offset, words) } -> std::same_as<bool>;
  { pages.read(page, offset, to) } -> std::same_as<bool>;
};

/// A page holds a header and the image. The header is written last: until its last word stands, its checksum is wrong
/// and the other page counts. The pages must outlive the storage.
template <FlashPages Pages>
class FlashStorage {
 public:
  explicit constexpr FlashStorage(Pages& flash_pages) : pages_{flash_pages} {}

  [[nodiscard]] StorageState open() {
    std::optional<Header> best;
    bool blank = true;
    page_ = 1;
    for (std::uint8_t page = 0; page < 2; ++page) {
      const std::optional<Header> header = header_of(page, blank);
      if (!header || (best && best->erasures >= header->erasures)) continue;
      best = header;
      page_ = page;
    }
    size_ = best ? best->size : 0;
    erasures_ = best ? best->erasures : 0;
    if (best) return StorageState::whole;
    return blank ? StorageState::empty : StorageState::damaged;
  }

  [[nodiscard]] std::uint32_t size() const { return size_; }

  /// How often the two pages have been erased, together. Of a cut of power in the middle of an image it is not known.
  [[nodiscard]] std::uint32_t erasures() const { return erasures_; }

  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    return pages_.read(page_, image_at + position, to);
  }

  [[nodiscard]] bool begin(std::uint32_t size) {
    if (size > Pages::page_size - image_at) return false;
    fresh_ = {};
    fresh_.size = size;
    fresh_.erasures = ++erasures_;
    written_ = 0;
    return pages_.erase(spare());
  }

  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > fresh_.size - written_) return false;
    fresh_.image_crc = crc16_ccitt(fresh_.image_crc, bytes);
    for (const std::uint8_t byte : bytes) {
      word_[written_ % word_size] = byte;
      if (++written_ % word_size == 0 && !write_word(image_at + written_ - word_size)) return false;
    }
    return true;
  }

  [[nodiscard]] bool commit() {
    if (written_ != fresh_.size) return false;
    if (const std::uint32_t rest = written_ % word_size; rest != 0) {
      std::fill(word_.begin() + rest, word_.end(), std::uint8_t{0xFF});
      if (!write_word(image_at + written_ - rest)) return false;
    }
    fresh_.crc = crc_of(fresh_);
    std::array<std::uint8_t, image_at> bytes;
    bytes.fill(0xFF);
    std::memcpy(bytes.data(), &fresh_, sizeof fresh_);
    if (!pages_.write(spare(), 0, bytes)) return false;
    bool blank = true;
    if (!header_of(spare(), blank)) return false;  // the medium has not kept it
    page_ = spare();
    size_ = fresh_.size;
    return true;
  }

 private:
  static constexpr std::uint32_t word_size = Pages::word_size;
  static_assert(word_size >= 1 && word_size <= 32 && (word_size & (word_size - 1)) == 0);

  struct Header {
    std::uint32_t erasures = 0;  ///< of both pages; of two images the one with the higher number is the newer
    std::uint32_t size = 0;      ///< bytes of the image
    std::uint16_t image_crc = first_crc;
    std::uint16_t crc = 0;  ///< of what stands before
  };
  static constexpr std::uint16_t first_crc = 0xFFFF;
  static constexpr std::uint32_t header_bytes = 12;
  static_assert(sizeof(Header) == header_bytes);

  /// Where the image begins: behind the header, at a whole word.
  static constexpr std::uint32_t image_at = (header_bytes + word_size - 1) / word_size * word_size;
  static_assert(Pages::page_size > image_at && Pages::page_size % word_size == 0);

  [[nodiscard]] std::uint8_t spare() const { return static_cast<std::uint8_t>(page_ ^ 1u); }

  [[nodiscard]] static std::uint16_t crc_of(const Header& header) {
    return crc16_ccitt(first_crc, {reinterpret_cast<const std::uint8_t*>(&header), sizeof header - sizeof header.crc});
  }

  [[nodiscard]] bool write_word(std::uint32_t offset) { return pages_.write(spare(), offset, word_); }

  /// The header of a page that holds a whole image. `blank` becomes false where something else stands in its place.
  [[nodiscard]] std::optional<Header> header_of(std::uint8_t page, bool& blank) const {
    Header header;
    const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&header), sizeof header};
    const bool readable = pages_.read(page, 0, bytes);
    if (readable && std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0xFF; })) return std::nullopt;
    blank = false;
    if (!readable || header.crc != crc_of(header) || header.size > Pages::page_size - image_at) return std::nullopt;
    if (image_crc(page, header.size) != header.image_crc) return std::nullopt;
    return header;
  }

  /// Nothing where the page cannot be read.
  [[nodiscard]] std::optional<std::uint16_t> image_crc(std::uint8_t page, std::uint32_t size) const {
    std::array<std::uint8_t, 16> bytes;
    std::uint16_t crc = first_crc;
    for (std::uint32_t done = 0; done < size;) {
      const std::span<std::uint8_t> piece{bytes.data(), std::min<std::uint32_t>(bytes.size(), size - done)};
      if (!pages_.read(page, image_at + done, piece)) return std::nullopt;
      crc = crc16_ccitt(crc, piece);
      done += static_cast<std::uint32_t>(piece.size());
    }
    return crc;
  }

  Pages& pages_;
  Header fresh_{};             ///< of the image in the making
  std::uint32_t written_ = 0;  ///< bytes of it
  std::uint32_t size_ = 0;     ///< of the present image
  std::uint32_t erasures_ = 0;
  alignas(8) std::array<std::uint8_t, word_size> word_{};
  std::uint8_t page_ = 1;  ///< which holds the present image; at first page 0 is the spare one
};

}  // namespace canopen
