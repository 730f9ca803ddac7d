/// The device: a data sheet with every formula, compact form and missing key resolved. Each value has its source
/// position. The device owns its texts and may outlive the data sheet, but not the source file, to which positions
/// point.
#pragma once

#include <canopen/od/access.hpp>
#include <canopen/od/data_type.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/information.hpp"
#include "device/meaning/meaning.hpp"
#include "diagnostics/diagnostics.hpp"
#include "pdo/mapping.hpp"
#include "values/little_endian.hpp"
#include "values/value.hpp"

namespace edsc {

/// Object codes of CiA 301, 7.4.3, table 42.
enum class ObjectType : std::uint8_t {
  null = 0x00,
  domain = 0x02,
  deftype = 0x05,
  defstruct = 0x06,
  var = 0x07,
  array = 0x08,
  record = 0x09,
};

[[nodiscard]] std::string_view to_string(ObjectType type);

/// One entry of the object dictionary, with an index and sub-index.
struct Entry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string name;           ///< for texts: the one that the options give, else ParameterName
  std::string replaced_name;  ///< ParameterName if the options give another name; else empty
  const canopen::DataTypeRow* type = nullptr;
  const canopen::DataTypeRow* stated_type = nullptr;  ///< of the file, if a service of the device needs `type` instead
  std::uint32_t octets = 0;  ///< of a string: the length that its DEFTYPE states, in bytes; 0 where none does
  canopen::Access access = canopen::Access::rw;
  bool pdo_mapping = false;
  std::uint32_t obj_flags = 0;         ///< not accessed by configuration tools: bit 0 write, bit 1 read
  std::optional<Value> default_value;  ///< of a DCF: the ParameterValue, if any
  std::optional<Value> low_limit;
  std::optional<Value> high_limit;
  Position position;          ///< the section
  Position access_position;   ///< for findings about AccessType
  Position mapping_position;  ///< for findings about PDOMapping

  // Further keys of a DCF.
  std::string denotation;     ///< the user's name
  std::string param_refd;     ///< the parameter of a network variable
  std::string upload_file;    ///< of a DOMAIN: file for the upload
  std::string download_file;  ///< of a DOMAIN: file for the download

  // Keys of some vendors.
  std::string unit, factor, offset, description;

  std::shared_ptr<const Meaning> meaning;  ///< shared by entries with the same one; null without one

  [[nodiscard]] const std::string& parameter_name() const { return replaced_name.empty() ? name : replaced_name; }
  /// The PDOs to which the entry can be mapped.
  [[nodiscard]] canopen::Mappable mappable() const {
    return pdo_mapping ? canopen::mappable_by(access) : canopen::Mappable::no;
  }
};

struct Object {
  std::uint16_t index = 0;
  ObjectType type = ObjectType::var;
  std::string name;            ///< as in an entry
  std::string replaced_name;   ///< as in an entry
  std::vector<Entry> entries;  ///< ascending by sub-index; exactly one for a VAR or DOMAIN
  Position position;
  std::string denotation;
  std::uint32_t obj_flags = 0;
  std::vector<std::uint16_t> links;  ///< related objects: ObjectLinks

  [[nodiscard]] const std::string& parameter_name() const { return replaced_name.empty() ? name : replaced_name; }
  [[nodiscard]] bool has_sub_indices() const { return type == ObjectType::array || type == ObjectType::record; }
  [[nodiscard]] const Entry* find(std::uint8_t sub_index) const;
  /// Except FFh, which describes the structure of the object (CiA 301, 7.4.4).
  [[nodiscard]] std::uint8_t highest_sub_index() const;
};

/// One entry of a default mapping.
struct PdoEntry : PlacedObject {
  const Entry* object = nullptr;                ///< null if the entry does not exist
  const canopen::DataTypeRow* dummy = nullptr;  ///< set if the index is that of a data type
  Position place;                               ///< the mapping value
};

/// A PDO with its default communication and mapping parameters.
struct Pdo {
  PdoDirection direction = PdoDirection::receive;
  std::uint16_t number = 1;  ///< 1..512
  const Object* communication = nullptr;
  const Object* mapping = nullptr;  ///< null if the object is missing
  std::vector<PdoEntry> entries;    ///< those that are not empty
  Position position;                ///< the communication parameter's section, else the mapping parameter's
  bool multiplexed = false;         ///< sub-index 0 of its mapping is 254 or 255: an MPDO, which has no entries
  bool dynamic = false;             ///< the mapping can be changed: the mapping parameter is in RAM
  bool broken = false;              ///< the mapping is invalid
  bool can_id_is_allowed = false;   ///< CiA 301 restricts the default CAN-ID, and the options allow it

  [[nodiscard]] unsigned bits() const { return total_bits(entries); }
  [[nodiscard]] unsigned bytes() const { return static_cast<unsigned>(bytes_for(bits())); }
};

/// The basic type of a type that the EDS defines.
struct TypeReference {
  const canopen::DataTypeRow* row = nullptr;  ///< null if unknown
  std::uint32_t octets = 0;                   ///< of a string: its length in bytes, if a DEFTYPE states one
};

/// A data type that the EDS defines: DEFTYPE, DEFSTRUCT, or a range of a basic type in the format of CANFestival.
struct TypeDefinition {
  std::uint16_t index = 0;
  std::string name;
  ObjectType kind = ObjectType::deftype;
  TypeReference type;  ///< of a DEFTYPE: its basic type
  std::optional<Value> low_limit, high_limit;
  std::vector<TypeReference> members;  ///< of a DEFSTRUCT, by sub-index - 1
  Position position;
};

struct Options;
class ValueOverlay;

/// It does not change after it has been resolved. It is moved or shared, not copied: its PDOs point to its objects.
struct Device {
  Device() = default;
  Device(Device&&) = default;
  Device& operator=(Device&&) = default;
  ~Device() = default;
  Device& operator=(const Device&) = delete;

  const SourceFile* source = nullptr;
  std::string vendor_name;
  std::string product_name;
  std::uint32_t vendor_number = 0;
  std::uint32_t product_number = 0;
  std::uint32_t revision_number = 0;
  std::optional<std::uint8_t> node_id;     ///< fixed at generation time
  std::vector<std::uint16_t> dummies;      ///< data type indices that RPDOs may map as dummy entries
  std::vector<Object> objects;             ///< ascending by index
  std::vector<TypeDefinition> types;       ///< ascending by index: for DataType, not part of the dictionary
  std::vector<Pdo> pdos;                   ///< RPDOs, then TPDOs, each ascending by number
  Information information;                 ///< the other contents of the data sheet
  std::vector<ErrorCodeName> error_codes;  ///< of EMCY, 1003h and 603Fh, ascending

  [[nodiscard]] const Object* find(std::uint16_t index) const;
  [[nodiscard]] const Entry* find(std::uint16_t index, std::uint8_t sub_index) const;

 private:
  /// Resolves the PDOs of the copy.
  friend Device with_values(const Device& device, const ValueOverlay& values, const Options& options,
                            Diagnostics& of_mapping);
  Device(const Device&) = default;
};

/// The position of the default value of an entry, or of its section if it has none.
[[nodiscard]] Position default_place(const Entry& entry);

/// `1018h:01`
[[nodiscard]] std::string entry_label(std::uint16_t index, std::uint8_t sub_index);
/// `1018h`
[[nodiscard]] std::string index_label(std::uint16_t index);
/// `6040h:00 "Controlword"`
[[nodiscard]] std::string named(const Entry& entry);
/// `1018h "Identity object"`
[[nodiscard]] std::string named(const Object& object);
/// `RPDO 2`
[[nodiscard]] std::string pdo_label(const Pdo& pdo);

}  // namespace edsc
