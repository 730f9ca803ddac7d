/// The non-volatile memory of a node: a file, or memory of the process.
#pragma once

#include <canopen/host/file_storage.hpp>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace nodes {

class NodeStorage {
 public:
  /// An empty path: memory of the process.
  explicit NodeStorage(const std::string& path = {}) {
    if (!path.empty()) file_.emplace(path);
  }

  [[nodiscard]] canopen::StorageState open() {
    if (file_) return state_ = file_->open();
    return state_ = image_.empty() ? canopen::StorageState::empty : canopen::StorageState::whole;
  }
  /// The result of the last `open`.
  [[nodiscard]] canopen::StorageState state() const { return state_; }
  [[nodiscard]] std::uint32_t size() const { return file_ ? file_->size() : static_cast<std::uint32_t>(image_.size()); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    if (file_) return file_->read(position, to);
    if (position > image_.size() || to.size() > image_.size() - position) return false;
    if (!to.empty()) std::memcpy(to.data(), image_.data() + position, to.size());
    return true;
  }
  [[nodiscard]] bool begin(std::uint32_t size) {
    if (fails_) return noted(false);
    if (file_) return noted(file_->begin(size));
    fresh_.clear();
    return true;
  }
  /// Whether the memory cannot be written.
  void fail(bool fails) { fails_ = fails; }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    if (file_) return noted(file_->write(bytes));
    fresh_.insert(fresh_.end(), bytes.begin(), bytes.end());
    return true;
  }
  [[nodiscard]] bool commit() {
    if (file_) return noted(file_->commit());
    image_ = std::move(fresh_);
    return true;
  }

  /// Returns whether a write to the file has failed since the last call.
  [[nodiscard]] bool take_failure() { return std::exchange(failed_, false); }

 private:
  [[nodiscard]] bool noted(bool succeeded) {
    failed_ = failed_ || !succeeded;
    return succeeded;
  }

  bool fails_ = false;   ///< now
  bool failed_ = false;  ///< since the last `take_failure`
  std::optional<canopen::FileStorage> file_;
  canopen::StorageState state_ = canopen::StorageState::empty;
  std::vector<std::uint8_t> image_;  ///< without a file
  std::vector<std::uint8_t> fresh_;  ///< the next image, until `commit`
};

}  // namespace nodes
