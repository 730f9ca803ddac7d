/// Devices with a wrong SDO server or object dictionary.
#include <canopen/base/abort_code.hpp>
#include <canopen/sdo/sdo_protocol.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mutant.hpp"

namespace edsc::conform {
namespace sdo_mutant {
namespace {

namespace sdo = canopen::sdo;
using canopen::AbortCode;
using canopen::Frame;
using sdo::Data;

constexpr std::uint32_t request_id = canopen::function_code::sdo_request + Wire::node_id;
constexpr std::uint32_t answer_id = canopen::function_code::sdo_response + Wire::node_id;
constexpr std::uint8_t abort_byte = sdo::abort_command;

bool is_request(const Frame& frame) { return frame.id == request_id && frame.size == 8 && !frame.remote; }
bool is_answer(const Frame& frame) { return frame.id == answer_id && frame.size == 8 && !frame.remote; }

Data bytes_of(std::uint8_t command, std::uint32_t multiplexer, std::uint32_t word) {
  Data data{command};
  sdo::put_multiplexer(data, static_cast<std::uint16_t>(multiplexer >> 8),
                       static_cast<std::uint8_t>(multiplexer >> 24));
  sdo::put_word(data, word);
  return data;
}

Data abort_of(const Frame& request, AbortCode code) {
  return bytes_of(abort_byte, sdo::multiplexer_of(request.data), static_cast<std::uint32_t>(code));
}

/// The device answers with these bytes and does not receive the request.
void answer(Wire& wire, const Data& data) {
  Frame frame;
  frame.id = answer_id;
  frame.size = 8;
  frame.data = data;
  wire.drop();
  wire.send(frame);
}

bool is_upload(const Frame& frame) { return is_request(frame) && frame.data[0] == 0x40; }
bool is_download(const Frame& frame) {
  return is_request(frame) && sdo::client_command(frame.data[0]) == sdo::ClientCommand::initiate_download;
}
bool names(const Frame& frame, std::uint16_t index, std::uint8_t sub_index) {
  return sdo::multiplexer_of(frame.data) == sdo::multiplexer(index, sub_index);
}

// Kinds of wrong devices

/// One abort code instead of another.
Mutant abort_code(std::string_view name, AbortCode right, AbortCode wrong) {
  return {name,
          [=](Wire&, Frame& frame) {
            if (!is_answer(frame) || frame.data[0] != abort_byte) return;
            if (sdo::word_of(frame.data) == static_cast<std::uint32_t>(right))
              sdo::put_word(frame.data, static_cast<std::uint32_t>(wrong));
          },
          {}};
}

/// A download that is rejected with this code is confirmed.
Mutant accepted(std::string_view name, AbortCode code) {
  return {name,
          [=](Wire&, Frame& frame) {
            if (!is_answer(frame) || frame.data[0] != abort_byte) return;
            if (sdo::word_of(frame.data) == static_cast<std::uint32_t>(code))
              frame.data = bytes_of(0x60, sdo::multiplexer_of(frame.data), 0);
          },
          {}};
}

/// An upload that is answered with four bytes, or with an abort.
Mutant upload_gives(std::string_view name, std::uint16_t index, std::uint8_t sub_index, std::uint8_t command,
                    std::uint32_t word) {
  return {name, {}, [=](Wire& wire, Frame& frame) {
            if (is_upload(frame) && names(frame, index, sub_index))
              answer(wire, bytes_of(command, sdo::multiplexer(index, sub_index), word));
          }};
}

Mutant upload_refused(std::string_view name, std::uint16_t index, std::uint8_t sub_index, AbortCode code) {
  return upload_gives(name, index, sub_index, abort_byte, static_cast<std::uint32_t>(code));
}

/// A download to these entries is answered without being executed: with an abort, or with a confirmation (`ok`).
Mutant download_gives(std::string_view name, std::function<bool(const Frame&)> condition, AbortCode code) {
  return {name, {}, [=](Wire& wire, Frame& frame) {
            if (!is_download(frame) || !condition(frame)) return;
            answer(wire,
                   code == canopen::ok ? bytes_of(0x60, sdo::multiplexer_of(frame.data), 0) : abort_of(frame, code));
          }};
}

/// Changes each answer whose byte 0, in the bits of the mask, is `command`.
Mutant answers(std::string_view name, std::uint8_t command, std::uint8_t mask, std::function<void(Data&)> change) {
  return {name,
          [=](Wire&, Frame& frame) {
            if (is_answer(frame) && (frame.data[0] & mask) == command) change(frame.data);
          },
          {}};
}

Mutant requests(std::string_view name, std::uint8_t command, std::uint8_t mask, std::function<void(Data&)> change) {
  return {name, {}, [=](Wire&, Frame& frame) {
            if (is_request(frame) && (frame.data[0] & mask) == command) change(frame.data);
          }};
}

// Devices with state

/// 1000h:00 is sent in a segment with the given command byte.
Mutant device_type_in_segment(std::string_view name, std::uint8_t segment) {
  return {name, {}, [segment, open = false](Wire& wire, Frame& frame) mutable {
            if (!is_request(frame)) return;
            if (is_upload(frame) && names(frame, 0x1000, 0)) {
              open = true;
              return answer(wire, bytes_of(0x41, sdo::multiplexer(0x1000, 0), 4));
            }
            if (open && frame.data[0] == 0x60) answer(wire, Data{segment});
            open = false;
          }};
}

/// Each answer to a read of 1000h:00 is sent twice.
Mutant answered_twice() {
  return {"device-type-twice",
          [](Wire& wire, Frame& frame) {
            if (is_answer(frame) && frame.data[0] == 0x43 && names(frame, 0x1000, 0)) wire.send(frame);
          },
          {}};
}

/// A default value of the EDS is not a number.
Mutant wrong_default_in_eds() {
  return {"eds-with-an-error", {}, {}, [](std::string& eds) {
            constexpr std::string_view key = "DefaultValue=";
            const std::size_t at = eds.find(key, eds.find("\n[1017]"));
            eds.replace(at + key.size(), 1, "zero");
          }};
}

/// The toggle bit of upload requests is not checked.
Mutant toggle_bit_ignored() {
  return {"toggle-bit-ignored", {}, [next = std::uint8_t{0}](Wire&, Frame& frame) mutable {
            if (!is_request(frame)) return;
            if (frame.data[0] == 0x40) next = 0x60;
            if ((frame.data[0] & 0xE0) != 0x60) return;
            frame.data[0] = next;
            next ^= sdo::toggle;
          }};
}

/// A block upload starts with segment 2.
Mutant block_sequence_from_2() {
  return {"block-sequence-from-2",
          [](Wire&, Frame& frame) {
            if (is_answer(frame) && frame.data[0] == 0x81) frame.data[0] = 0x82;
          },
          {}};
}

/// 1201h:01 keeps its written value after reset communication.
Mutant server_not_reset() {
  return {
      "sdo-server-not-reset", {}, [written = std::uint32_t{0}, was_reset = false](Wire& wire, Frame& frame) mutable {
        if (frame.id == 0 && frame.data[0] == 0x82) was_reset = written != 0;
        if (is_download(frame) && names(frame, 0x1201, 1)) {
          written = sdo::word_of(frame.data);
          was_reset = false;
        }
        if (was_reset && is_upload(frame) && names(frame, 0x1201, 1))
          answer(wire, bytes_of(0x43, sdo::multiplexer(0x1201, 1), written));
      }};
}

bool is_short_parameter(const Frame& frame) {
  const std::uint16_t index = sdo::index_of(frame.data);
  const bool pdo = (index & 0xFE00) == 0x1400 || (index & 0xFE00) == 0x1800;
  const bool short_pdo_parameter = pdo && (frame.data[3] == 2 || frame.data[3] == 5);
  return index == 0x100C || index == 0x100D || index == 0x1017 || index == 0x1029 || short_pdo_parameter;
}

bool is_of(const Frame& frame, std::uint8_t command, std::uint16_t index, std::uint8_t sub_index, std::uint32_t word) {
  return frame.data[0] == command && names(frame, index, sub_index) && sdo::word_of(frame.data) == word;
}

/// A transmission type of four bytes is rejected, but the device changes it.
Mutant refused_and_changed() {
  return {"refused-values-change-the-entry", {}, [](Wire& wire, Frame& frame) {
            const std::uint16_t index = sdo::index_of(frame.data);
            const bool is_type = (index & 0xFE00) == 0x1800 && frame.data[3] == 2;
            if (!is_download(frame) || frame.data[0] != 0x23 || !is_type) return;
            Frame change = frame;
            change.data = bytes_of(0x2F, sdo::multiplexer_of(frame.data), frame.data[4] == 1 ? 2 : 1);
            wire.request(change);
            answer(wire, abort_of(frame, AbortCode::length_too_high));
          }};
}

std::vector<Mutant> expedited() {
  return {
      device_type_in_segment("device-type-in-a-segment", 0x07),
      device_type_in_segment("device-type-in-a-segment-with-toggle", 0x17),
      answered_twice(),
      upload_gives("device-type-of-one-byte", 0x1000, 0, 0x4F, 0),
      upload_gives("device-type-of-another-profile", 0x1000, 0, 0x43, 0x0002'0192),
      download_gives(
          "parameters-not-writable", [](const Frame& frame) { return is_short_parameter(frame) && frame.data[3] == 2; },
          AbortCode::read_only),
      download_gives(
          "device-type-writable", [](const Frame& frame) { return names(frame, 0x1000, 0); }, canopen::ok),
      abort_code("code-of-read-only", AbortCode::read_only, AbortCode::no_object),
      upload_gives("write-only-entry-readable", 0x200C, 0, 0x43, 0),
      abort_code("code-of-write-only", AbortCode::write_only, AbortCode::read_only),
      abort_code("code-of-missing-sub-index", AbortCode::no_sub_index, AbortCode::no_object),
      abort_code("code-of-missing-object", AbortCode::no_object, AbortCode::no_sub_index),
      {"unknown-command-ignored",
       {},
       [](Wire& wire, Frame& frame) {
         if (is_request(frame) && frame.data[0] == 0xE0) wire.drop();
       }},
      abort_code("code-of-unknown-command", AbortCode::command_specifier, AbortCode::no_object),
      download_gives(
          "too-long-values-taken",
          [](const Frame& frame) { return frame.data[0] == 0x23 && is_short_parameter(frame); }, canopen::ok),
      download_gives(
          "too-short-values-taken",
          [](const Frame& frame) {
            const bool one_byte_type =
                sdo::index_of(frame.data) == 0x100D || frame.data[3] == 2 || sdo::index_of(frame.data) == 0x1029;
            const bool wide = is_short_parameter(frame) && !one_byte_type;
            return frame.data[0] == 0x2F && (wide || sdo::index_of(frame.data) == 0x1016);
          },
          canopen::ok),
      refused_and_changed(),
      accepted("values-above-the-limit-taken", AbortCode::value_too_high),
      accepted("values-below-the-limit-taken", AbortCode::value_too_low),
      abort_code("code-of-value-too-low", AbortCode::value_too_low, AbortCode::length_mismatch),
      upload_gives("default-sdo-of-another-node", 0x1200, 1, 0x43, 0x606),
  };
}

std::vector<Mutant> segmented() {
  return {
      answers("segmented-upload-of-another-sub-index", 0x41, 0xFF, [](Data& data) { ++data[3]; }),
      answers("download-segment-toggle", 0x20, 0xE0, [](Data& data) { data[0] ^= sdo::toggle; }),
      requests("segment-written-as-0", 0x0B, 0xFF, [](Data& data) { data = {data[0]}; }),
      answers("indicated-size-too-high", 0x41, 0xFF, [](Data& data) { ++data[4]; }),
      answers("upload-segment-toggle", 0x00, 0xE0, [](Data& data) { data[0] ^= sdo::toggle; }),
      answers("whole-last-segment-not-last", 0x01, 0xEF, [](Data& data) { data[0] &= 0xFE; }),
      answers("last-segment-one-byte-less", 0x01, 0xE1,
              [](Data& data) { data[0] = static_cast<std::uint8_t>(data[0] + 2); }),
      toggle_bit_ignored(),
      requests("toggle-bit-of-downloads-ignored", 0x1B, 0xFF, [](Data& data) { data[0] = 0x0B; }),
      abort_code("code-of-toggle-bit", AbortCode::toggle_bit, AbortCode::command_specifier),
  };
}

std::vector<Mutant> blocks() {
  return {
      block_sequence_from_2(),
      answers("block-size-indicated-too-low", 0xC2, 0xE3, [](Data& data) { --data[4]; }),
      answers("block-end-without-unused-bytes", 0xC1, 0xE3, [](Data& data) { data[0] = 0xC1; }),
      answers("block-crc-wrong", 0xC1, 0xE3, [](Data& data) { data[1] ^= 1; }),
      answers("block-confirms-no-segment", 0xA2, 0xFF, [](Data& data) { data[1] = 0; }),
      answers("block-end-not-confirmed", 0xA1, 0xFF, [](Data& data) { data[0] = 0xA3; }),
      requests("block-segment-written-as-0", 0x81, 0xFF, [](Data& data) { data = {data[0]}; }),
      {"block-crc-not-compared",
       [](Wire&, Frame& frame) {
         const bool crc = is_answer(frame) && frame.data[0] == abort_byte &&
                          sdo::word_of(frame.data) == static_cast<std::uint32_t>(AbortCode::crc);
         if (crc) frame.data = {0xA1};
       },
       {}},
      requests("block-size-128-taken", 0xA0, 0xE3,
               [](Data& data) {
                 if (data[4] == 128) data[4] = 127;
               }),
      requests("block-size-0-taken", 0xA0, 0xE3,
               [](Data& data) {
                 if (data[4] == 0) data[4] = 127;
               }),
      requests("block-sequence-128-taken", 0xA2, 0xFF,
               [](Data& data) {
                 if (data[1] == 128) data[1] = 1;
               }),
      requests("lost-block-not-sent-again", 0xA2, 0xFF,
               [](Data& data) {
                 if (data[1] == 0) data[1] = 2;
               }),
      requests("block-of-127-segments-always", 0xA0, 0xE3,
               [](Data& data) {
                 if (data[4] == 1) data[4] = 127;
               }),
  };
}

std::vector<Mutant> dictionary() {
  return {
      wrong_default_in_eds(),
      upload_gives("sdo-server-of-no-eds", 0x1205, 0, 0x4F, 2),
      server_not_reset(),
      upload_gives("sdo-client-of-no-eds", 0x1283, 0, 0x4F, 3),
      upload_refused("parameter-not-readable", 0x1007, 0, AbortCode::hardware),
      upload_gives("parameter-of-one-byte", 0x1006, 0, 0x4F, 0),
      upload_gives("product-code-of-another-product", 0x1018, 2, 0x43, 5),
      download_gives(
          "serial-number-writable", [](const Frame& frame) { return names(frame, 0x1018, 4); }, canopen::ok),
      upload_gives("structure-of-an-array", 0x1018, 0xFF, 0x43, 0x2308),
      download_gives(
          "high-limit-refused", [](const Frame& frame) { return is_of(frame, 0x2F, 0x2005, 0, 100); },
          AbortCode::value_too_high),
      upload_gives("application-entry-of-four-bytes", 0x2003, 0, 0x43, 0),
      upload_refused("application-entry-not-readable", 0x200D, 0, AbortCode::unsupported_access),
      upload_gives("highest-sub-index-of-application", 0x2002, 0, 0x4F, 4),
      download_gives(
          "text-not-writable", [](const Frame& frame) { return names(frame, 0x2006, 0); }, AbortCode::read_only),
  };
}

}  // namespace
}  // namespace sdo_mutant

std::vector<Mutant> sdo_mutants() {
  using namespace sdo_mutant;
  std::vector<Mutant> all;
  for (const auto table : {expedited, segmented, blocks, dictionary}) {
    for (Mutant& mutant : table()) all.push_back(std::move(mutant));
  }
  return all;
}

}  // namespace edsc::conform
