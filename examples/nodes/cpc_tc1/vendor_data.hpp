/// Data of the servo drive that are not objects: 1010h stores them by its sub-indices 04h to 06h, and 1011h restores
/// their defaults.
#pragma once

#include <array>
#include <canopen/base/abort_code.hpp>
#include <canopen/base/bytes.hpp>
#include <canopen/storage/storage.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "shared/node_storage.hpp"

namespace cpc_tc1_node {

/// The manual names the data and not their contents: the program and the table are bytes of the vendor's software.
struct VendorValues {
  std::uint32_t rs232_rate = 115'200;       ///< bit/s; the manual does not state the default
  std::vector<std::uint8_t> program;        ///< of the virtual machine
  bool maps_errors = false;                 ///< the function error mapping is active
  std::vector<std::uint8_t> error_mapping;  ///< its table
};

/// The values in use, and their stored copies. The storage must outlive it.
class VendorData {
  using Bytes = std::vector<std::uint8_t>;

 public:
  explicit VendorData(nodes::NodeStorage& storage) : storage_{&storage} {}

  VendorValues values;

  /// Power-on, or a reset: the stored values, and the defaults of values that are not stored.
  void reset() {
    const Image stored = read();
    values = {};
    if (const Bytes& rate = stored[rs232]; rate.size() == 4) {
      values.rs232_rate = canopen::little_endian_number(rate);
    }
    values.program = stored[program];
    if (const Bytes& mapping = stored[error_mapping]; !mapping.empty()) {
      values.maps_errors = mapping[0] != 0;
      values.error_mapping.assign(mapping.begin() + 1, mapping.end());
    }
  }

  /// "save" to a sub-index of 1010h: 01h stores all parts, 04h to 06h one. hardware: the storage has failed.
  [[nodiscard]] canopen::AbortCode save(std::uint8_t sub_index) { return change(sub_index, present()); }

  /// "load" to a sub-index of 1011h: the next reset sets the defaults.
  [[nodiscard]] canopen::AbortCode restore(std::uint8_t sub_index) { return change(sub_index, {}); }

 private:
  enum Part : std::uint8_t { rs232, program, error_mapping, parts };
  static constexpr std::uint8_t first_sub_index = 4;
  using Image = std::array<Bytes, parts>;  ///< an empty part is not stored

  [[nodiscard]] Image present() const {
    Image image;
    for (unsigned shift = 0; shift < 32; shift += 8) {
      image[rs232].push_back(static_cast<std::uint8_t>(values.rs232_rate >> shift));
    }
    image[program] = values.program;
    image[error_mapping] = values.error_mapping;
    image[error_mapping].insert(image[error_mapping].begin(), values.maps_errors);
    return image;
  }

  /// Replaces the parts of a sub-index in the storage.
  [[nodiscard]] canopen::AbortCode change(std::uint8_t sub_index, const Image& image) {
    Image stored = read();
    for (std::uint8_t part = 0; part < parts; ++part) {
      if (sub_index == 1 || sub_index == first_sub_index + part) stored[part] = image[part];
    }
    return write(stored) ? canopen::ok : canopen::AbortCode::hardware;
  }

  // In the storage, each part has its length (4 bytes) before its bytes.

  [[nodiscard]] Image read() {
    Image image;
    if (storage_->open() == canopen::StorageState::empty) return image;
    std::uint32_t at = 0;
    for (Bytes& part : image) {
      std::array<std::uint8_t, 4> length{};
      if (!storage_->read(at, length)) return {};
      const std::uint32_t size = canopen::little_endian_number(length);
      at += 4;
      if (size > storage_->size() - at) return {};
      part.resize(size);
      if (!storage_->read(at, part)) return {};
      at += size;
    }
    return image;
  }

  [[nodiscard]] bool write(const Image& image) {
    Bytes bytes;
    for (const Bytes& part : image) {
      for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(part.size() >> shift));
      }
      bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return storage_->begin(static_cast<std::uint32_t>(bytes.size())) && storage_->write(bytes) && storage_->commit();
  }

  nodes::NodeStorage* storage_;
};

}  // namespace cpc_tc1_node
