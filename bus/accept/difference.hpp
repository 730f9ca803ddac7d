/// Differences between the object dictionary of a device and its EDS, with the evidence and a decision which of the two
/// is wrong.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "conform/verdict.hpp"
#include "overlay/write_overlay.hpp"

namespace edsc::accept {

/// What differs.
enum class Kind : std::uint8_t {
  object_missing,     ///< the device has no entry of an object of the EDS
  sub_index_missing,  ///< the device has the object without the sub-index
  not_in_eds,         ///< the device has an entry that the EDS does not describe
  length,             ///< the number of bytes is not that of the data type
  access,             ///< readable instead of write-only, or the reverse
  value,              ///< a constant of the product has another value than DefaultValue
  limit,              ///< the present value is outside LowLimit and HighLimit
  unreadable,         ///< a read of an entry that the EDS declares readable fails
  no_response,        ///< no response to a read
};

struct KindRow {
  Kind kind;
  std::string_view name;  ///< in JSON
  std::string_view text;  ///< in reports
};

inline constexpr KindRow kinds[] = {
    {Kind::object_missing, "object_missing", "object missing in the device"},
    {Kind::sub_index_missing, "sub_index_missing", "sub-index missing in the device"},
    {Kind::not_in_eds, "not_in_eds", "entry missing in the EDS"},
    {Kind::length, "length", "length"},
    {Kind::access, "access", "access"},
    {Kind::value, "value", "value"},
    {Kind::limit, "limit", "limits"},
    {Kind::unreadable, "unreadable", "entry not readable"},
    {Kind::no_response, "no_response", "no response"},
};

[[nodiscard]] constexpr const KindRow& row_of(Kind kind) { return kinds[static_cast<std::size_t>(kind)]; }

/// Which of the two is wrong.
enum class Mark : std::uint8_t { eds_wrong, device_wrong, undecided };

struct MarkRow {
  Mark mark;
  std::string_view name;  ///< in JSON
  std::string_view text;  ///< in reports
};

inline constexpr MarkRow marks[] = {
    {Mark::eds_wrong, "eds_wrong", "EDS wrong"},
    {Mark::device_wrong, "device_wrong", "device wrong"},
    {Mark::undecided, "undecided", "undecided"},
};

[[nodiscard]] constexpr const MarkRow& row_of(Mark mark) { return marks[static_cast<std::size_t>(mark)]; }

/// A key of the EDS that would describe the device as it is. Its reason is that of the difference.
using Correction = OverlayChange;

struct Difference {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::string name;  ///< as in the EDS; of an entry that it does not have that of the object, or empty
  Kind kind = Kind::value;
  std::string in_eds;     ///< `UNSIGNED16, 2 bytes`
  std::string in_device;  ///< `1 byte: 05`
  Mark mark = Mark::undecided;
  std::string_view evidence;  ///< id of the row that decided: `mandatory-object`
  std::string reason;         ///< why, with the clause
  /// How the EDS would describe the device. Empty if the device is wrong, or if the frames do not show enough.
  std::vector<Correction> corrections;
  std::vector<conform::SeenFrame> frames;  ///< request and response
  std::string deviation;                   ///< the reason in the file of deviations; empty: not declared

  [[nodiscard]] bool is_declared() const { return !deviation.empty(); }
};

/// The result of one property of an entry.
enum class Aspect : std::uint8_t {
  not_compared,  ///< the EDS does not state it, or a read does not show it
  same,
  differs,
  may_differ,  ///< a value that is stored, measured or counted: not a difference
};

struct AspectRow {
  Aspect aspect;
  std::string_view name;  ///< in JSON
};

inline constexpr AspectRow aspects[] = {
    {Aspect::not_compared, "not_compared"},
    {Aspect::same, "same"},
    {Aspect::differs, "differs"},
    {Aspect::may_differ, "may_differ"},
};

[[nodiscard]] constexpr const AspectRow& row_of(Aspect aspect) { return aspects[static_cast<std::size_t>(aspect)]; }

/// An entry of the EDS, or one that only the device has.
struct ComparedEntry {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  bool in_eds = true;
  std::string name, type, access;  ///< as in the EDS
  std::string default_value;       ///< empty: none
  std::string device_value;        ///< value, or why there is none; empty: not read
  Aspect exists = Aspect::not_compared, length = Aspect::not_compared, readable = Aspect::not_compared,
         value = Aspect::not_compared, limits = Aspect::not_compared;
  std::string remark;  ///< why something was not compared
};

}  // namespace edsc::accept
