/// The object dictionary that the services of a dynamic device are compiled for: each object that a service of the
/// runtime knows, with as many PDOs, entries and elements as an EDS can reasonably have. The tables are made by loops
/// at compile time. An object that the EDS does not have keeps its neutral value, which disables its service.
#pragma once

#include <array>
#include <canopen/can/cob_id.hpp>
#include <canopen/od/dictionary.hpp>
#include <canopen/od/value.hpp>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace edsc::frame {

using canopen::entry::Word;

/// PDOs of each direction, by their order in the EDS, and entries of a mapping (CiA 301, 7.5.2.36).
inline constexpr std::uint16_t max_pdos = 64;
inline constexpr std::uint8_t max_mapped = 64;
/// SDO servers, 1200h and the following ones.
inline constexpr std::uint16_t max_sdo_servers = 4;

/// A sub-index, or consecutive ones of one type; of a VAR, sub-index 0.
struct Part {
  std::uint8_t first;
  std::uint8_t last;
  Word type;
  std::uint32_t neutral = 0;
};

/// Objects of equal structure with consecutive indices.
struct Objects {
  std::uint16_t first;
  std::uint16_t count;
  std::span<const Part> parts;
  bool is_var = false;
};

namespace detail {

using canopen::CobId;
using namespace canopen::entry;

/// A CAN-ID of 29 bits without the bit for it: no frame has it.
inline constexpr std::uint32_t no_sync = 0x1FFF'FFFF;
/// Bit 2 of 1F80h: the device does not enter Operational by itself.
inline constexpr std::uint32_t no_self_start = 4;
inline constexpr std::uint8_t event_driven = 255;

inline constexpr Part byte_0[] = {{0, 0, u8}};
inline constexpr Part word_0[] = {{0, 0, u16}};
inline constexpr Part long_0[] = {{0, 0, u32}};
inline constexpr Part sync[] = {{0, 0, u32, no_sync}};
inline constexpr Part emcy[] = {{0, 0, u32, CobId::invalid_bit}};
inline constexpr Part start_up[] = {{0, 0, u32, no_self_start}};
inline constexpr Part error_history[] = {{0, 0, u8}, {1, 254, u32}};
inline constexpr Part heartbeats[] = {{0, 0, u8}, {1, 127, u32}};
inline constexpr Part emergencies[] = {{0, 0, u8}, {1, 127, u32, CobId::invalid_bit}};
inline constexpr Part error_behavior[] = {{0, 0, u8}, {1, 1, u8}};
inline constexpr Part first_sdo_server[] = {{0, 0, u8}, {1, 2, u32}};
inline constexpr Part sdo_server[] = {{0, 0, u8}, {1, 2, u32, CobId::invalid_bit}, {3, 3, u8}};
inline constexpr Part rpdo[] = {
    {0, 0, u8}, {1, 1, u32, CobId::invalid_bit}, {2, 2, u8, event_driven}, {3, 3, u16}, {5, 5, u16}};
inline constexpr Part tpdo[] = {
    {0, 0, u8}, {1, 1, u32, CobId::invalid_bit}, {2, 2, u8, event_driven}, {3, 3, u16}, {5, 5, u16}, {6, 6, u8}};
inline constexpr Part mapping[] = {{0, 0, u8}, {1, max_mapped, u32}};

// One entry of each kind, so that the services have the code for it: no EDS object is here.
inline constexpr Part text[] = {{0, 0, visible_string}};
inline constexpr Part memory[] = {{0, 0, domain}};
inline constexpr Part flag[] = {{0, 0, boolean}};
inline constexpr Part padded[] = {{0, 0, i24}};
inline constexpr Part wide[] = {{0, 0, u64}};

/// Ascending.
inline constexpr Objects objects[] = {
    {0x1001, 1, byte_0, true},   {0x1003, 1, error_history},    {0x1005, 1, sync, true},
    {0x1006, 1, long_0, true},   {0x1007, 1, long_0, true},     {0x100C, 1, word_0, true},
    {0x100D, 1, byte_0, true},   {0x1012, 1, long_0, true},     {0x1013, 1, long_0, true},
    {0x1014, 1, emcy, true},     {0x1015, 1, word_0, true},     {0x1016, 1, heartbeats},
    {0x1017, 1, word_0, true},   {0x1019, 1, byte_0, true},     {0x1028, 1, emergencies},
    {0x1029, 1, error_behavior}, {0x1200, 1, first_sdo_server}, {0x1201, max_sdo_servers - 1, sdo_server},
    {0x1400, max_pdos, rpdo},    {0x1600, max_pdos, mapping},   {0x1800, max_pdos, tpdo},
    {0x1A00, max_pdos, mapping}, {0x1F80, 1, start_up, true},   {0x2000, 1, text, true},
    {0x2001, 1, memory, true},   {0x2002, 1, flag, true},       {0x2003, 1, padded, true},
    {0x2004, 1, wide, true},     {0x2005, 1, word_0, true},  // a constant in flash
    {0x2006, 1, word_0, true},                               // a negative immediate value
};
inline constexpr std::uint16_t first_kind = 0x2000;
inline constexpr std::uint16_t constant_index = 0x2005, negative_index = 0x2006;

/// Longest string of the frame, in bytes: the buffer of an SDO server.
inline constexpr std::uint32_t text_bytes = 2048;

/// Bytes of a value in memory, which is also its alignment up to 8.
[[nodiscard]] constexpr std::size_t memory_bytes(Word type) {
  if (is_domain(type)) return sizeof(canopen::Domain);
  if (is_string(type)) return 4;  // never accessed
  const std::size_t bytes = wire_bytes(type);
  return bytes <= 2 ? bytes : bytes <= 4 ? 4 : 8;
}
[[nodiscard]] constexpr std::size_t aligned(std::size_t offset, std::size_t bytes) {
  const std::size_t to = bytes < 8 ? bytes : 8;
  return (offset + to - 1) / to * to;
}

struct Sizes {
  std::size_t objects = 0, runs = 1, shapes = 0, subs = 0, bytes = 0;
};

/// The tables, whose arrays have the sizes of a first pass.
template <Sizes Of>
struct Tables {
  std::array<canopen::Run, Of.runs> runs{};
  std::array<Word, Of.objects> entries{};
  std::array<canopen::Shape, Of.shapes> shapes{};
  std::array<Word, Of.subs> subs{};
};

/// Takes what a pass over the objects makes; `at` is the offset of the next value.
template <class Take>
constexpr std::size_t for_each_object(Take&& take) {
  std::size_t at = 0;
  for (const Objects& group : objects) {
    for (std::uint16_t i = 0; i < group.count; ++i) {
      at = aligned(at, 8);
      at = take(group, static_cast<std::uint16_t>(group.first + i), i == 0, at);
    }
  }
  return aligned(at, 8);
}

/// Calls `visit(sub_index, part, offset)` for each entry of an object, with its offset from the object.
template <class Visit>
constexpr std::size_t for_each_part(const Objects& group, Visit&& visit) {
  std::size_t at = 0;
  for (const Part& part : group.parts) {
    for (unsigned sub_index = part.first; sub_index <= part.last; ++sub_index) {
      at = aligned(at, memory_bytes(part.type));
      visit(static_cast<std::uint8_t>(sub_index), part, at);
      at += memory_bytes(part.type);
    }
  }
  return at;
}

inline constexpr Sizes sizes = [] {
  Sizes sum;
  std::uint32_t next = 0;
  sum.bytes = for_each_object([&](const Objects& group, std::uint16_t index, bool first, std::size_t at) {
    ++sum.objects;
    if (index != next) ++sum.runs;
    next = index + 1u;
    if (first && !group.is_var) {
      ++sum.shapes;
      sum.subs += group.parts.back().last + 1u;
    }
    return at + for_each_part(group, [](std::uint8_t, const Part&, std::size_t) {});
  });
  return sum;
}();

/// The word of a type with all rights: the sheet of a node has those of its EDS.
[[nodiscard]] constexpr Word word_of(std::uint16_t index, Word type, std::size_t offset) {
  if (index == constant_index) return rom | ro | type;
  if (index == negative_index) return immediate | ro | i16 | 0xFFFF;
  const Word rights = rw | (is_domain(type) || is_string(type) ? 0 : canopen::entry::tpdo | canopen::entry::rpdo);
  const bool has_limits = is_string(type) || (index >= first_kind && wire_bytes(type) == 8);
  return ram | rights | type | static_cast<Word>(offset) | (has_limits ? limited : 0);
}

inline constexpr Tables<sizes> tables = [] {
  Tables<sizes> made;
  std::size_t objects_made = 0, runs = 0, shapes = 0, subs = 0;
  std::uint32_t next = 0;
  for_each_object([&](const Objects& group, std::uint16_t index, bool first, std::size_t at) {
    if (index != next) made.runs[runs++] = {index, static_cast<std::uint16_t>(objects_made)};
    next = index + 1u;
    if (group.is_var) {
      made.entries[objects_made++] = word_of(index, group.parts.front().type, at);
    } else {
      if (first) {
        made.shapes[shapes++] = {static_cast<std::uint16_t>(subs), group.parts.back().last, 0};
        for_each_part(group, [&](std::uint8_t sub_index, const Part& part, std::size_t offset) {
          made.subs[subs + sub_index] = word_of(index, part.type, offset);
        });
        subs += group.parts.back().last + 1u;
      }
      made.entries[objects_made++] = record | shape(static_cast<Word>(shapes - 1)) | static_cast<Word>(at);
    }
    return at + for_each_part(group, [](std::uint8_t, const Part&, std::size_t) {});
  });
  made.runs[runs] = {0xFFFF, static_cast<std::uint16_t>(objects_made)};
  return made;
}();

inline constexpr canopen::Limits limits[] = {{canopen::object_key(first_kind, 0), 0, text_bytes}};
inline constexpr canopen::WideLimits wide_limits[] = {
    {canopen::object_key(first_kind + 4, 0), 0, std::numeric_limits<std::uint64_t>::max()}};
inline constexpr std::uint16_t constant = 0;

}  // namespace detail

/// Bytes of the values.
inline constexpr std::size_t bytes = detail::sizes.bytes;

inline constexpr canopen::Dictionary dictionary{
    .runs = detail::tables.runs,
    .entries = detail::tables.entries,
    .shapes = detail::tables.shapes,
    .subs = detail::tables.subs,
    .limits = detail::limits,
    .wide_limits = detail::wide_limits,
    .constants = &detail::constant,
};
static_assert(dictionary.well_formed());

/// Calls `visit(offset, neutral, bytes)` for each value that is not zero in a node without the object.
template <class Visit>
constexpr void for_each_neutral(Visit&& visit) {
  detail::for_each_object([&](const Objects& group, std::uint16_t, bool, std::size_t at) {
    return at + detail::for_each_part(group, [&](std::uint8_t, const Part& part, std::size_t offset) {
             if (part.neutral != 0) visit(at + offset, part.neutral, canopen::entry::wire_bytes(part.type));
           });
  });
}

}  // namespace edsc::frame
