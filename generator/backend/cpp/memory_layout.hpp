/// The memory layout of a device: constants in flash, values in RAM, and the tables to find them, as lines of C++ for
/// the templates. canopen/od/dictionary.hpp describes the words of the tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/options/options.hpp"

namespace edsc {

/// A member of a generated struct.
struct Member {
  std::string type;
  std::string name;
  std::string initializer;  ///< empty in structs that are zero after a reset
  std::string comment;
  unsigned alignment = 1;
  std::size_t size = 0;            ///< bytes
  const Object* object = nullptr;  ///< the object of the value
};

struct Struct {
  std::string type;  ///< name of the struct
  std::string name;  ///< of the member or variable that has this type
  std::string comment;
  std::vector<Member> members;  ///< widest alignment first: no padding between them
};

/// A row of a table, and its comment.
struct TableRow {
  std::string text;
  std::string comment;
};

struct MemoryLayout {
  std::vector<Struct> record_types;  ///< shared by all records of equal shape
  std::vector<Struct> values;        ///< the non-empty parts of Values
  Struct constants;
  std::vector<TableRow> runs, entries, groups, subs, limits, wide_limits;
  std::vector<TableRow> node_id_relative_communication, node_id_relative_application;
  std::uint32_t longest_download = 4;
};

[[nodiscard]] MemoryLayout lay_out(const Device& device, const Options& options, Diagnostics& diagnostics);

/// An ARRAY whose elements 1..N have the same numeric type, access and limits: one template in C++.
[[nodiscard]] bool describes_uniform_array(const Object& object);

/// The C++ type of an entry; a string with its capacity.
[[nodiscard]] std::string cpp_type(const Entry& entry, const Options& options);

}  // namespace edsc
