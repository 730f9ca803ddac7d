/// Storage in two pages of flash: a new image is written to the page that does not contain the present one.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/crc16.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

/// Two pages, 0 and 1, of `page_size` bytes. After an erase each word can be written once; a word has `word_size`
/// bytes, a power of two, 32 at most. Offsets and sizes of `write` are multiples of it. False: the medium has failed.
/// Pages with a function `bool ready()` may return from `erase` before it is complete: it is then false until it is.
/// Such pages may have a constant `max_polls`: how often `ready` is called in one wait, before the medium has failed.
template <class Type>
concept FlashPages = requires(Type& pages, std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words,
                              std::span<std::uint8_t> to) {
  { Type::page_size } -> std::convertible_to<std::uint32_t>;
  { Type::word_size } -> std::convertible_to<std::uint32_t>;
  { pages.erase(page) } -> std::same_as<bool>;
  { pages.write(page, offset, words) } -> std::same_as<bool>;
  { pages.read(page, offset, to) } -> std::same_as<bool>;
};

/// Keeps a header, the image and, at the end of the page, a copy of the header in each page. The header is written
/// after the image and the copy after the header: after a power loss the newer page has a valid header and a valid
/// image, or no copy, so that the other page is used. A page with a copy and without a valid header and image is
/// reported as damaged, and the older image is used. A page without a copy, of the first format, is read too. The pages
/// must outlive the storage.
template <FlashPages Pages>
class FlashStorage {
 public:
  /// Calls of `ready` in one wait, after which the medium has failed.
  static constexpr std::uint32_t max_polls = storage_detail::max_polls<Pages>;

  explicit constexpr FlashStorage(Pages& flash_pages) : pages_{flash_pages} {}

  [[nodiscard]] StorageState open() {
    StorageState state = StorageState::empty;
    page_ = 1;
    size_ = 0;
    erasures_ = 0;
    std::uint32_t broken = 0;   // count of a damaged page
    bool may_be_newer = false;  // a damaged page without a count
    for (std::uint8_t page = 0; page < 2; ++page) {
      const StorageState found = look_into(page);
      if (found == StorageState::damaged) {
        if (state == StorageState::empty) state = found;
        if (header_.erasures == unknown) {
          may_be_newer = true;
        } else {
          broken = std::max(broken, header_.erasures);
        }
      }
      if (found != StorageState::whole || (state == found && erasures_ >= header_.erasures)) continue;
      state = found;
      size_ = header_.size;
      erasures_ = header_.erasures;
      page_ = page;
    }
    header_ = {};
    if (broken <= erasures_) return may_be_newer ? StorageState::damaged : state;
    erasures_ = broken;
    return StorageState::damaged;
  }

  [[nodiscard]] std::uint32_t size() const { return size_; }

  /// Returns how often the two pages have been erased in total. An erase whose image was cut off by a power loss is
  /// not counted.
  [[nodiscard]] std::uint32_t erasures() const { return erasures_; }

  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    return pages_.read(page_, image_at + position, to);
  }

  [[nodiscard]] bool begin(std::uint32_t size) {
    if (size > max_size) return false;
    header_ = {};
    header_.size = size;
    header_.erasures = ++erasures_;
    written_ = 0;
    return pages_.erase(spare());
  }

  /// Whether the last erase is complete.
  [[nodiscard]] bool ready() requires requires(Pages& pages) { pages.ready(); }
  { return pages_.ready(); }

  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > header_.size - written_) return false;
    header_.image_crc = crc16_ccitt(header_.image_crc, bytes);
    for (const std::uint8_t byte : bytes) {
      word_[written_ % word_size] = byte;
      if (++written_ % word_size == 0 && !write_word(image_at + written_ - word_size)) return false;
    }
    return true;
  }

  [[nodiscard]] bool commit() {
    if (written_ != header_.size) return false;
    if (const std::uint32_t rest = written_ % word_size; rest != 0) {
      std::fill(word_.begin() + rest, word_.end(), std::uint8_t{0xFF});
      if (!write_word(image_at + written_ - rest)) return false;
    }
    header_.crc = crc_of(header_);
    if (!write_header(0) || !write_header(copy_at)) return false;
    if (look_into(spare()) != StorageState::whole) return false;  // the medium has not stored it
    page_ = spare();
    size_ = header_.size;
    return true;
  }

 private:
  static constexpr std::uint32_t word_size = Pages::word_size;
  static_assert(word_size >= 1 && word_size <= 32 && (word_size & (word_size - 1)) == 0);

  struct Header {
    std::uint32_t erasures = 0;  ///< of both pages; the image with the higher number is the newer one
    std::uint32_t size = 0;      ///< bytes of the image
    std::uint16_t image_crc = first_crc;
    std::uint16_t crc = 0;  ///< of the fields before it
  };
  static constexpr std::uint16_t first_crc = 0xFFFF;
  static constexpr std::uint32_t header_bytes = 12;
  static_assert(sizeof(Header) == header_bytes);

  /// Start of the image: after the header, at a word boundary.
  static constexpr std::uint32_t image_at = (header_bytes + word_size - 1) / word_size * word_size;
  static_assert(Pages::page_size > 2 * image_at && Pages::page_size % word_size == 0);
  /// Start of the copy of the header.
  static constexpr std::uint32_t copy_at = Pages::page_size - image_at;
  static constexpr std::uint32_t max_size = copy_at - image_at;
  /// In place of the count of a page whose headers are both damaged: it may be the newer one.
  static constexpr std::uint32_t unknown = 0xFFFF'FFFF;

  [[nodiscard]] std::uint8_t spare() const { return static_cast<std::uint8_t>(page_ ^ 1u); }

  [[nodiscard]] static std::uint16_t crc_of(const Header& header) {
    return crc16_ccitt(first_crc, {reinterpret_cast<const std::uint8_t*>(&header), sizeof header - sizeof header.crc});
  }

  [[nodiscard]] bool write_word(std::uint32_t offset) {
    return wait_until_erased() && pages_.write(spare(), offset, word_);
  }

  /// Returns false if the pages do not become ready. A BackgroundStorage writes only when they are, and does not wait
  /// here.
  [[nodiscard]] bool wait_until_erased() const {
    if constexpr (requires { pages_.ready(); }) {
      for (std::uint32_t polls = 0; !pages_.ready(); ++polls) {
        if (polls == max_polls) return false;
      }
    }
    return true;
  }

  // Separate functions, so that their buffers are not on the stack at the same time.
  [[nodiscard, gnu::noinline]] bool write_header(std::uint32_t offset) const {
    std::array<std::uint8_t, image_at> bytes;
    bytes.fill(0xFF);
    std::memcpy(bytes.data(), &header_, sizeof header_);
    return wait_until_erased() && pages_.write(spare(), offset, bytes);
  }

  /// Returns the state of a page; `header_` is then its header.
  [[nodiscard, gnu::noinline]] StorageState look_into(std::uint8_t page) {
    const bool has_copy = read_header(page, copy_at);
    const bool is_copy_sound = header_is_sound();
    const Header copy = header_;
    const bool has_header = read_header(page, 0);
    if (!header_is_sound()) {
      if (!has_header && !has_copy) return StorageState::empty;
      // Without the header, the erase has begun; without the copy, the header was being written.
      if (!is_copy_sound) return damage(has_header && has_copy ? unknown : 0);
      header_ = copy;
    }
    return image_is_whole(page) ? StorageState::whole : StorageState::damaged;
  }

  StorageState damage(std::uint32_t erasures) {
    header_ = {};
    header_.erasures = erasures;
    return StorageState::damaged;
  }

  /// Reads a header, or its copy. Returns whether its memory has been written.
  [[nodiscard]] bool read_header(std::uint8_t page, std::uint32_t offset) {
    const std::span<std::uint8_t> bytes{reinterpret_cast<std::uint8_t*>(&header_), sizeof header_};
    if (!pages_.read(page, offset, bytes)) {
      header_ = {};
      return true;
    }
    return !std::ranges::all_of(bytes, [](std::uint8_t byte) { return byte == 0xFF; });
  }

  [[nodiscard]] bool header_is_sound() const {
    return header_.crc == crc_of(header_) && header_.size <= Pages::page_size - image_at;
  }

  [[nodiscard]] bool image_is_whole(std::uint8_t page) const {
    std::array<std::uint8_t, 16> bytes;
    std::uint16_t crc = first_crc;
    for (std::uint32_t done = 0; done < header_.size;) {
      const std::span<std::uint8_t> piece{bytes.data(), std::min<std::uint32_t>(bytes.size(), header_.size - done)};
      if (!pages_.read(page, image_at + done, piece)) return false;
      crc = crc16_ccitt(crc, piece);
      done += static_cast<std::uint32_t>(piece.size());
    }
    return crc == header_.image_crc;
  }

  Pages& pages_;
  Header header_{};            ///< of the image being written, or of the page that was checked
  std::uint32_t written_ = 0;  ///< of the image being written
  std::uint32_t size_ = 0;     ///< of the present image
  std::uint32_t erasures_ = 0;
  alignas(8) std::array<std::uint8_t, word_size> word_{};
  std::uint8_t page_ = 1;  ///< page of the present image; at first page 0 is the spare one
};

}  // namespace canopen
