/// The device: a data sheet with every formula, compact form and missing key resolved. Each value still knows its line.
/// It owns its text: the data sheet may go before it. Positions point into the source file.
#pragma once

#include <canopen/access.hpp>
#include <canopen/data_type.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/information.hpp"
#include "diagnostics/diagnostics.hpp"

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

/// A value of the data sheet. Numbers are held as the bits of their type: two's complement extended to 64 bits, or the
/// IEEE 754 pattern.
struct Value {
  std::uint64_t bits = 0;
  bool plus_node_id = false;  ///< the node-ID is added when it is known
  bool hexadecimal = false;   ///< spelled so in the data sheet
  std::string bytes;          ///< of strings
  Position position;          ///< where the file has it, or would have it
  std::string_view clause;    ///< of CiA 301, which gives the value; empty when the file does
};

/// One entry of the object dictionary: what an SDO can name.
struct Entry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string name;        ///< ParameterName
  std::string identifier;  ///< the same in C++: unique in its object, of a VAR unique in the device
  const canopen::DataTypeRow* type = nullptr;
  std::uint32_t octets = 0;  ///< of a string: the length that its DEFTYPE states, in bytes; 0 where none does
  canopen::Access access = canopen::Access::rw;
  bool pdo_mapping = false;
  std::uint32_t obj_flags = 0;  ///< what configuration tools leave alone: bit 0 writing, bit 1 reading
  std::optional<Value> default_value;  ///< of a DCF the ParameterValue, where there is one
  std::optional<Value> low_limit;
  std::optional<Value> high_limit;
  Position position;            ///< the section
  Position access_position;     ///< where a rule about its access points
  Position mapping_position;    ///< where a rule about PDOMapping points

  // What a DCF says besides.
  std::string denotation;     ///< the user's name
  std::string param_refd;     ///< the parameter of a network variable
  std::string upload_file;    ///< of a DOMAIN: where its value comes from
  std::string download_file;  ///< of a DOMAIN: where its value goes to

  // What some vendors say besides.
  std::string unit, factor, description;

  /// In which PDOs it may be mapped.
  [[nodiscard]] canopen::Mappable mappable() const {
    return pdo_mapping ? canopen::mappable_by(access) : canopen::Mappable::no;
  }
};

struct Object {
  std::uint16_t index = 0;
  ObjectType type = ObjectType::var;
  std::string name;
  std::string identifier;        ///< unique in the device
  std::vector<Entry> entries;    ///< ascending by sub-index; of a VAR or DOMAIN exactly one
  Position position;
  std::string denotation;
  std::uint32_t obj_flags = 0;
  std::vector<std::uint16_t> links;  ///< objects that belong with it: ObjectLinks

  [[nodiscard]] bool has_sub_indices() const { return type == ObjectType::array || type == ObjectType::record; }
  [[nodiscard]] const Entry* find(std::uint8_t sub_index) const;
  /// Without FFh, which describes the structure of the object (CiA 301, 7.4.4).
  [[nodiscard]] std::uint8_t highest_sub_index() const;
};

enum class PdoDirection : std::uint8_t { receive, transmit };

/// One entry of a default mapping.
struct PdoEntry {
  std::uint8_t position = 0;  ///< 1..64: its sub-index in the mapping parameter
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t bits = 0;
  const Entry* object = nullptr;                 ///< null when the device has no such entry
  const canopen::DataTypeRow* dummy = nullptr;   ///< set when the index is that of a data type
  Position place;                                ///< the mapping value
};

/// A PDO with its default communication and mapping parameters.
struct Pdo {
  PdoDirection direction = PdoDirection::receive;
  std::uint16_t number = 1;            ///< 1..512
  const Object* communication = nullptr;
  const Object* mapping = nullptr;     ///< null when the object is missing
  std::vector<PdoEntry> entries;       ///< as many as sub-index 0 says
  Position position;                   ///< the communication parameter's section, else the mapping parameter's
  bool multiplexed = false;            ///< sub-index 0 of its mapping is 254 or 255: an MPDO, which has no entries
  bool dynamic = false;                ///< its mapping may change: the mapping parameter lies in RAM
  bool broken = false;                 ///< its mapping is invalid: no layout can be made

  [[nodiscard]] unsigned bits() const;
};

/// What a type of the data sheet's own stands for.
struct TypeReference {
  const canopen::DataTypeRow* row = nullptr;  ///< null where none is known
  std::uint32_t octets = 0;                   ///< of a string: its length in bytes, where a DEFTYPE states one
};

/// A data type of the data sheet's own: DEFTYPE, DEFSTRUCT, or a range of a basic type as CANFestival writes it.
struct TypeDefinition {
  std::uint16_t index = 0;
  std::string name;
  ObjectType kind = ObjectType::deftype;
  TypeReference type;  ///< of a DEFTYPE what it stands for
  std::optional<Value> low_limit, high_limit;
  std::vector<TypeReference> members;  ///< of a DEFSTRUCT, by sub-index - 1
  Position position;
};

struct Device {
  const SourceFile* source = nullptr;
  std::string name;             ///< C++ namespace
  std::string vendor_name;
  std::string product_name;
  std::uint32_t vendor_number = 0;
  std::uint32_t product_number = 0;
  std::uint32_t revision_number = 0;
  std::optional<std::uint8_t> node_id;    ///< fixed at generation
  std::vector<std::uint16_t> dummies;     ///< data type indices that RPDOs may use as dummy entries
  std::vector<Object> objects;            ///< ascending by index
  std::vector<TypeDefinition> types;      ///< ascending by index: named by DataType, not part of the dictionary
  std::vector<Pdo> pdos;                  ///< RPDOs, then TPDOs, each ascending by number
  Information information;                ///< what the data sheet says besides its objects

  [[nodiscard]] const Object* find(std::uint16_t index) const;
  [[nodiscard]] const Entry* find(std::uint16_t index, std::uint8_t sub_index) const;
};

/// `1018h:01`
[[nodiscard]] std::string entry_label(std::uint16_t index, std::uint8_t sub_index);
/// `1018h`
[[nodiscard]] std::string index_label(std::uint16_t index);
/// `RPDO 2`
[[nodiscard]] std::string pdo_label(const Pdo& pdo);

}  // namespace edsc
