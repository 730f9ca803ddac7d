/// A model of PDO mapping, written only from CiA 301 (version 4.2.0, 7.2.2, 7.5.2.35 to 7.5.2.38): each bit of a PDO is
/// copied separately. Numbers in comments are clauses of CiA 301.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace model {

/// An object that can be mapped.
struct Mappable {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  unsigned bits = 0;
  bool to_rpdo = false;
  bool to_tpdo = false;
  std::uint64_t low = 0;
  std::uint64_t high = ~std::uint64_t{0};
  std::uint64_t value = 0;
  [[nodiscard]] bool dummy() const { return index < 0x20; }
};

using Code = std::uint32_t;
using Codes = std::vector<Code>;  ///< allowed abort codes; empty: the write must be accepted

class Pdo {
 public:
  Pdo(std::vector<Mappable>& objects, bool transmitted, bool valid, std::vector<std::uint32_t> mapping)
      : objects_{&objects}, transmitted_{transmitted}, valid_{valid}, count_{mapping.size()} {
    std::copy(mapping.begin(), mapping.end(), entries_.begin());
  }

  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] bool exists() const { return valid_ && count_ != 0; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::uint32_t entry(std::size_t i) const { return entries_[i]; }

  // ---- the procedure of 7.5.2.36: make the PDO invalid, set the number of objects to 0, write the objects and their
  // number, make the PDO valid. Each function returns the allowed answers to a write.

  Codes write_valid(bool valid) {
    valid_ = valid;
    return {};
  }

  /// 1600h:01 to :08. Objects are checked now: 0602 0000h or 0604 0041h if one does not exist or cannot be mapped.
  Codes write_entry(std::size_t i, std::uint32_t mapped) {
    if (valid_ || count_ != 0) return not_now;
    const Mappable* const object = find(mapped);
    if (object == nullptr || !(transmitted_ ? object->to_tpdo : object->to_rpdo)) {
      // If only the sub-index does not exist, its own code is allowed, too.
      return {0x0602'0000, 0x0604'0041, 0x0609'0011};
    }
    // The length must be that of the object; the standard does not specify the code of a wrong length.
    if ((mapped & 0xFF) != object->bits) return {0x0602'0000, 0x0604'0041, 0x0604'0042};
    entries_[i] = mapped;
    return {};
  }

  /// Returns whether the standard does not specify a mapping entry: it maps nothing.
  [[nodiscard]] static bool is_free(std::uint32_t mapped) { return mapped == 0; }
  void set_entry(std::size_t i, std::uint32_t mapped) { entries_[i] = mapped; }

  /// 1600h:00: the whole mapping is checked now: 0602 0000h or 0604 0042h. A number above the number of sub-indices is
  /// also an invalid value.
  Codes write_count(std::size_t count) {
    if (valid_) return not_now;
    if (count > entries_.size()) return {0x0602'0000, 0x0604'0042, 0x0609'0030, 0x0609'0031};
    unsigned bits = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (find(entries_[i]) == nullptr) return {0x0602'0000, 0x0604'0042};
      bits += entries_[i] & 0xFF;
    }
    if (bits > 64) return {0x0602'0000, 0x0604'0042};
    count_ = count;
    return {};
  }

  // ---- frames

  [[nodiscard]] unsigned bits() const {
    unsigned sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += entries_[i] & 0xFF;
    return sum;
  }
  [[nodiscard]] std::size_t bytes() const { return (bits() + 7) / 8; }

  /// The data of a TPDO: the first object in the lowest bits (7.2.2.5.1; 7.1.4).
  [[nodiscard]] std::array<std::uint8_t, 8> pack() const {
    std::array<std::uint8_t, 8> data{};
    unsigned at = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const Mappable& object = *find(entries_[i]);
      for (unsigned bit = 0; bit < object.bits; ++bit, ++at) {
        if ((object.value >> bit & 1) != 0) data[at / 8] = static_cast<std::uint8_t>(data[at / 8] | 1u << at % 8);
      }
    }
    return data;
  }

  /// A received PDO. With too few bytes it is ignored; of more bytes the first ones are used (7.2.2.5.2). An object
  /// whose limits do not allow its value keeps the old one.
  void unpack(const std::array<std::uint8_t, 8>& data, std::size_t size) {
    if (size < bytes()) return;
    unsigned at = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      Mappable& object = *find(entries_[i]);
      std::uint64_t value = 0;
      for (unsigned bit = 0; bit < object.bits; ++bit, ++at) {
        if ((data[at / 8] >> at % 8 & 1) != 0) value |= std::uint64_t{1} << bit;
      }
      if (!object.dummy() && value >= object.low && value <= object.high) object.value = value;
    }
  }

 private:
  /// A mapping cannot be written while the PDO is valid or its number of objects is not 0. The clause does not name a
  /// code; codes with this meaning: unsupported access, cannot be mapped, not in this state of the device.
  inline static const Codes not_now{0x0601'0000, 0x0604'0041, 0x0800'0022};

  [[nodiscard]] Mappable* find(std::uint32_t mapped) const {
    for (Mappable& object : *objects_) {
      if (object.index == mapped >> 16 && object.sub_index == (mapped >> 8 & 0xFF)) return &object;
    }
    return nullptr;
  }

  std::vector<Mappable>* objects_;
  bool transmitted_;
  bool valid_;
  std::size_t count_;
  std::array<std::uint32_t, 8> entries_{};
};

}  // namespace model
