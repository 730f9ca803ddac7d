/// A stored value that the dictionary of this device does not accept as it is, for the application.
///
///     struct Pump {
///       void on_stored_value(const canopen::StoredValue& old) {
///         if (old.is(0x2005, 0) && old.type() == canopen::entry::u16)  // it had the unit 0.1 bar
///           if (old.replace_by(od::pressure_limit{}, old.number() * 10) == canopen::ok) return;
///         if (old.is(0x2009, 0)) old.discard();                        // this version does not need it
///       }
///     };
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include "canopen/base/abort_code.hpp"
#include "canopen/od/dictionary.hpp"
#include "canopen/od/object.hpp"
#include "canopen/od/value_bits.hpp"
#include "canopen/od/value_for.hpp"
#include "canopen/storage/stored_format.hpp"

namespace canopen {

/// Why a stored value is not loaded.
enum class NotLoaded : std::uint8_t {
  none,        ///< it can be loaded
  no_object,   ///< this device does not have the entry
  not_stored,  ///< this device does not store the entry, or it is a constant
  type,        ///< the entry has another data type
  length,      ///< the string is longer than its entry
  value,       ///< the value could not be written over the bus: limits, COB-ID, mapping
  version,     ///< it was stored with another `storage.version` of the options; it is loaded if nothing replaces it
  layout,      ///< an image of the first format contains a section of another dictionary; index, type and bytes are 0
};

/// What the application does with a StoredValue.
struct StoredValueAnswer {
  std::uint32_t key = 0;   ///< of the object that gets `bytes`
  std::uint8_t size = 0;   ///< of `bytes`; 0: none
  bool discarded = false;  ///< or replaced
  std::array<std::uint8_t, 8> bytes{};
};

/// A stored value and why it is not loaded. Valid during the call that passes it.
class StoredValue {
 public:
  StoredValue(const stored_format::Record& record, NotLoaded why, std::span<const std::uint8_t> bytes,
              StoredValueAnswer* answer)
      : record_{record}, bytes_{bytes}, answer_{answer}, why_{why} {}

  [[nodiscard]] NotLoaded why() const { return why_; }
  [[nodiscard]] std::uint16_t index() const { return record_.index; }
  [[nodiscard]] std::uint8_t sub_index() const { return record_.sub_index; }
  [[nodiscard]] bool is(std::uint16_t index, std::uint8_t sub_index) const {
    return index == record_.index && sub_index == record_.sub_index;
  }

  /// Returns the type that the entry had: `canopen::entry::u16`, for example.
  [[nodiscard]] entry::Word type() const { return stored_format::word_of(record_.type); }
  /// Returns the length of the value in bytes.
  [[nodiscard]] std::uint16_t size() const { return record_.size; }
  /// Returns the bytes of the value, as SDO sends them; of a string, the first 32.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  /// Returns `storage.version` of the options with which the value was stored.
  [[nodiscard]] std::uint8_t version() const { return record_.version(); }

  /// Returns an unsigned integer, or the bits of another number.
  [[nodiscard]] std::uint64_t number() const {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < bytes_.size() && i < sizeof number; ++i) number |= std::uint64_t{bytes_[i]} << (8 * i);
    return number;
  }
  /// Returns a signed integer.
  [[nodiscard]] std::int64_t signed_number() const {
    const unsigned unused = 64 - 8 * (bytes_.size() < 8 ? static_cast<unsigned>(bytes_.size()) : 8);
    if (unused == 64) return 0;
    return static_cast<std::int64_t>(number() << unused) >> unused;
  }

  /// Sets an object to this value instead, which is checked as by the node's `set`; the stored value is then no longer
  /// reported, and the next "save" of all parameters removes it. The object must be in the same part of the dictionary,
  /// 1000h..1FFFh or the rest. A later stored value of that object replaces it.
  template <NumberObject Object, ValueFor<Object> Value>
  [[nodiscard]] AbortCode replace_by(Object, Value value) const {
    if (answer_ == nullptr) return AbortCode::device_state;
    if (const AbortCode code = check_value<Object>(value); code != ok) return code;
    const std::uint64_t bits = value_detail::to_bits(static_cast<typename Object::type>(value));
    answer_->key = object_key(Object::index, Object::sub_index);
    answer_->size = static_cast<std::uint8_t>((Object::bits + 7) / 8);
    answer_->discarded = true;
    std::memcpy(answer_->bytes.data(), &bits, sizeof bits);
    return ok;
  }

  /// The value is not needed: it is no longer reported, and the next "save" of all parameters removes it.
  void discard() const {
    if (answer_ == nullptr) return;
    answer_->size = 0;
    answer_->discarded = true;
  }

 private:
  stored_format::Record record_;
  std::span<const std::uint8_t> bytes_;
  StoredValueAnswer* answer_;
  NotLoaded why_;
};

}  // namespace canopen
