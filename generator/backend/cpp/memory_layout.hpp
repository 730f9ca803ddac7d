/// The memory layout of a device: which struct holds each value, and the tables to find it. Decisions only:
/// layout_view() spells them in C++. canopen/od/dictionary.hpp describes the tables.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "backend/cpp/cpp_names.hpp"
#include "backend/cpp/placement.hpp"
#include "device/device.hpp"
#include "device/drive_modes.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A member of a generated struct: the value of an entry, the elements of an ARRAY, or a struct of a record type.
struct Member {
  std::string type;  ///< in C++
  std::string name;
  const Object* object = nullptr;  ///< the object of the value
  const Entry* entry = nullptr;    ///< of a single value
  std::vector<Member> parts;       ///< of a record type
  unsigned alignment = 1;
  std::size_t size = 0;  ///< bytes
};

struct Struct {
  std::string_view comment;
  std::string type;             ///< name of the struct
  std::string name;             ///< of the member or variable that has this type
  std::vector<Member> members;  ///< widest alignment first: no padding between them
  bool communication = false;   ///< a part of Values for 1000h..1FFFh
  bool preset = false;          ///< a part of Values with default values other than zero
};

/// A member of a struct, whose offset is the location of a value.
struct Location {
  std::string type;    ///< `Values`, `Constants` or a record type; empty: offset 0
  std::string member;  ///< its path: `application_preset.speed`

  auto operator<=>(const Location&) const = default;
};

/// The word of an entry.
struct Word {
  MemoryPlace place = MemoryPlace::ram;
  Location location = {};    ///< in RAM or flash
  std::uint16_t number = 0;  ///< an immediate value
  bool hexadecimal = false;  ///< its spelling
  std::string type = {};     ///< constant of canopen::entry, as `access`
  std::string_view access = {};
  bool tpdo = false, rpdo = false, limited = false;

  auto operator<=>(const Word&) const = default;
};

/// Consecutive indices from `first` on, and the position of the first one's row.
struct RunRow {
  std::uint16_t first;
  std::size_t position;
};

/// The row of an index: its word; of an object with sub-indices, the location of its values and the position of its
/// shape.
struct EntryRow {
  const Object* object;
  std::optional<Word> word;
  Location location = {};
  std::size_t shape = 0;
  bool is_array = false;  ///< the elements share one word
};

/// The row of a sub-index; nothing for a gap.
struct SubRow {
  std::optional<Word> word;
  const Object* first_of = nullptr;  ///< in the first row of a shape
};

/// The structure of objects with sub-indices.
struct ShapeRow {
  const Object* object;  ///< the first one with it
  std::size_t subs;      ///< position of its words
  std::uint8_t highest;  ///< sub-index
  unsigned stride;       ///< bytes between the elements of an array
};

struct LimitRow {
  const Entry* entry;
  std::uint64_t low, high;
};

/// Values that a mode of operation accepts.
struct AcceptedRow {
  const Entry* entry;
  ModeRange values;
};

/// A value to which the node-ID is added.
struct NodeIdRow {
  const Entry* entry;
  Location location;
  std::optional<std::size_t> offset;  ///< of an element, in its array
};

struct MemoryLayout {
  std::vector<Struct> record_types;  ///< shared by all records of equal shape
  std::vector<Struct> values;        ///< the non-empty parts of Values
  Struct constants;
  std::vector<RunRow> runs;
  std::vector<EntryRow> entries;
  std::vector<ShapeRow> shapes;
  std::vector<SubRow> subs;
  std::vector<LimitRow> limits, wide_limits;  ///< ascending
  std::vector<AcceptedRow> accepted;          ///< ascending
  std::vector<NodeIdRow> node_id_relative_communication, node_id_relative_application;
  std::uint32_t longest_download = 4;
};

/// Reports the first object that does not fit into the address range of the tables.
[[nodiscard]] MemoryLayout lay_out(const NamedDevice& named, const Options& options, Diagnostics& diagnostics);

}  // namespace edsc
