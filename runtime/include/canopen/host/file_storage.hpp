/// Storage in a file, for devices on Linux: a new image replaces the file as a whole.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "canopen/base/crc16.hpp"
#include "canopen/host/descriptor.hpp"
#include "canopen/storage/storage.hpp"

namespace canopen {

/// Storage in a file with four letters, the checksum and the image. An image is written to PATH.new, synchronised to
/// disk and renamed: at any time either the old or the new file exists.
class FileStorage {
 public:
  explicit FileStorage(std::string path) : path_{std::move(path)} {}

  [[nodiscard]] StorageState open() {
    image_.clear();
    std::vector<std::uint8_t> file;
    if (!read_file(file)) return error_ == std::errc::no_such_file_or_directory ? StorageState::empty : damage();
    if (file.size() < header_bytes || std::memcmp(file.data(), magic.data(), magic.size()) != 0) return damage();
    image_.assign(file.begin() + header_bytes, file.end());
    if (std::memcmp(file.data(), header_of(image_).data(), header_bytes) == 0) return StorageState::whole;
    return damage();
  }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(image_.size()); }

  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    if (position > image_.size() || to.size() > image_.size() - position) return false;
    if (!to.empty()) std::memcpy(to.data(), image_.data() + position, to.size());
    return true;
  }

  [[nodiscard]] bool begin(std::uint32_t size) {
    fresh_.clear();
    fresh_.reserve(size);
    return true;
  }

  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    fresh_.insert(fresh_.end(), bytes.begin(), bytes.end());
    return true;
  }

  [[nodiscard]] bool commit() {
    error_.clear();
    if (!write_file() || !succeeded(std::rename(new_path().c_str(), path_.c_str()))) {
      static_cast<void>(::unlink(new_path().c_str()));
      return false;
    }
    image_ = std::move(fresh_);
    return sync_folder();  // false: the new file exists, but a power loss may restore the old one
  }

  /// Returns why the last `open` or `commit` has failed. Empty if the file was read, but its checksum is wrong.
  [[nodiscard]] std::error_code error() const { return error_; }

 private:
  static constexpr std::array<std::uint8_t, 4> magic = {'E', 'D', 'S', 'P'};
  static constexpr std::uint16_t first_crc = 0xFFFF;
  static constexpr std::uint32_t header_bytes = 6;

  [[nodiscard]] std::string new_path() const { return path_ + ".new"; }

  [[nodiscard]] static std::array<std::uint8_t, header_bytes> header_of(std::span<const std::uint8_t> image) {
    const std::uint16_t crc = crc16_ccitt(first_crc, image);
    return {
        magic[0], magic[1], magic[2], magic[3], static_cast<std::uint8_t>(crc), static_cast<std::uint8_t>(crc >> 8)};
  }

  StorageState damage() {
    image_.clear();
    return StorageState::damaged;
  }

  /// Records the error of a system call. Returns false if its result is negative.
  bool succeeded(int answer) {
    if (answer < 0) error_ = {errno, std::generic_category()};
    return answer >= 0;
  }

  bool read_file(std::vector<std::uint8_t>& file) {
    error_.clear();
    const Descriptor descriptor{::open(path_.c_str(), O_RDONLY | O_CLOEXEC)};
    if (!succeeded(descriptor.number())) return false;
    std::array<std::uint8_t, 4096> piece;
    for (;;) {
      const ssize_t got = ::read(descriptor.number(), piece.data(), piece.size());
      if (got < 0 && errno == EINTR) continue;
      if (!succeeded(static_cast<int>(got))) return false;
      if (got == 0) return true;
      file.insert(file.end(), piece.begin(), piece.begin() + got);
    }
  }

  bool write_file() {
    Descriptor descriptor{::open(new_path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    return succeeded(descriptor.number()) && write_all(descriptor.number(), header_of(fresh_)) &&
           write_all(descriptor.number(), fresh_) && succeeded(::fsync(descriptor.number())) &&
           succeeded(descriptor.close());
  }

  bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t put = ::write(descriptor, bytes.data(), bytes.size());
      if (put < 0 && errno == EINTR) continue;
      if (!succeeded(static_cast<int>(put))) return false;
      bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
    return true;
  }

  /// Synchronises the new name to disk.
  bool sync_folder() {
    const std::size_t slash = path_.rfind('/');
    const std::string folder = slash == std::string::npos ? "." : slash == 0 ? "/" : path_.substr(0, slash);
    const Descriptor descriptor{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
    return succeeded(descriptor.number()) && succeeded(::fsync(descriptor.number()));
  }

  std::string path_;
  std::vector<std::uint8_t> image_;
  std::vector<std::uint8_t> fresh_;
  std::error_code error_;
};

}  // namespace canopen
