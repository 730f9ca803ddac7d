/// Block upload and block download of an SDO server (CiA 301, 7.2.4.3.9 to 7.2.4.3.16).
#pragma once

#include <cstdint>

#include "canopen/base/abort_code.hpp"
#include "canopen/sdo/sdo_block_progress.hpp"
#include "canopen/sdo/sdo_protocol.hpp"
#include "canopen/sdo/sdo_server_transfer.hpp"

namespace canopen {

/// The messages of block transfers. Each function works on the transfer of a server, which also has the progress of its
/// blocks, and sets the response; an abort code other than `ok` ends the transfer.
template <class Device>
class SdoServerBlocks {
 public:
  using Transfer = SdoServerTransfer<Device>;
  using State = typename Transfer::State;

  // Upload

  /// Starts a block upload; a value that is short enough for the client is sent without blocks.
  [[nodiscard]] static AbortCode initiate_upload(const sdo::Data& request, Transfer& transfer, auto hooks) {
    if (!transfer.progress().set_size(request[4])) return AbortCode::block_size;
    if (const AbortCode code = transfer.find_readable(hooks); code != ok) return code;
    if (const AbortCode code = transfer.open_upload(hooks); code != ok) return code;
    if (transfer.size() <= request[5] && request[5] != 0) {  // protocol switch threshold; 0: no switch
      transfer.answer_upload(hooks);
      return ok;
    }
    transfer.hold_value();
    transfer.progress().begin(request[0]);
    transfer.enter(State::block_upload_initiated);
    transfer.answer_with_size(sdo::block_upload_answer | sdo::crc_supported, sdo::block_size_indicated);
    return ok;
  }

  /// Accepts the start, a confirmation or the end of a block upload.
  [[nodiscard]] static AbortCode upload(const sdo::Data& request, Transfer& transfer, auto hooks) {
    switch (static_cast<sdo::BlockUpload>(request[0] & 3)) {
      case sdo::BlockUpload::initiate: break;
      case sdo::BlockUpload::start:
        if (transfer.state() != State::block_upload_initiated) break;
        transfer.enter(State::block_uploading);
        return next_segment(transfer, hooks);
      case sdo::BlockUpload::confirm:
        if (transfer.state() != State::block_uploading) break;
        return sub_block_confirmed(request, transfer, hooks);
      case sdo::BlockUpload::end:
        if (transfer.state() != State::block_upload_ending) break;
        transfer.enter(State::idle);
        return ok;
    }
    return transfer.reject_command();
  }

  /// Whether the sub-block has a further segment to send.
  [[nodiscard]] static bool has_segment(const Transfer& transfer) {
    const SdoBlockProgress& progress = transfer.progress();
    return transfer.state() == State::block_uploading && progress.sequence != progress.size && !progress.last;
  }

  /// Sets the next segment as the response.
  [[nodiscard]] static AbortCode next_segment(Transfer& transfer, auto hooks) {
    SdoBlockProgress& progress = transfer.progress();
    transfer.clear_reply(++progress.sequence);
    std::uint32_t size = 0;
    if (const AbortCode code = transfer.fetch(hooks, size, progress.last); code != ok) return code;
    if (progress.last) {
      transfer.reply()[0] |= sdo::last_block_segment;
      progress.unused = static_cast<std::uint8_t>(sdo::segment_bytes - size);
    }
    if (progress.repeated != 0) {
      --progress.repeated;
    } else {
      progress.add_to_crc(&transfer.reply()[1], size);
    }
    return ok;
  }

  // Download

  /// Starts a block download.
  [[nodiscard]] static AbortCode initiate_download(const sdo::Data& request, Transfer& transfer, auto hooks) {
    if (const AbortCode code = transfer.find(entry::writable, AbortCode::read_only, hooks); code != ok) return code;
    const bool indicated = (request[0] & sdo::block_size_indicated) != 0;
    if (const AbortCode code = transfer.open_download(indicated, sdo::word_of(request), hooks); code != ok) return code;
    transfer.progress().begin(request[0]);
    transfer.enter(State::block_downloading);
    transfer.answer(sdo::block_download_answer | sdo::crc_supported, sdo::largest_block);
    return ok;
  }

  /// Accepts the next segment in sequence; another one is only checked for the end of its sub-block. How many bytes of
  /// the last one are valid is not known before the end of the transfer: they are put in place, and counted then.
  [[nodiscard]] static AbortCode take_segment(const sdo::Data& request, Transfer& transfer, auto hooks) {
    SdoBlockProgress& progress = transfer.progress();
    const auto sequence = static_cast<std::uint8_t>(request[0] & sdo::sequence_mask);
    const bool last = (request[0] & sdo::last_block_segment) != 0;
    if (sequence == 0) return AbortCode::sequence_number;
    if (sequence == progress.sequence + 1) {
      progress.sequence = sequence;
      if (last) {
        transfer.hold_segment(&request[1]);
        transfer.enter(State::block_download_ending);
      } else {
        const AbortCode code = transfer.store(hooks, &request[1], sdo::segment_bytes, false);
        if (code != ok) return code;
        progress.add_to_crc(&request[1], sdo::segment_bytes);
      }
    }
    if (last || sequence == sdo::largest_block) confirm_sub_block(transfer);
    return ok;
  }

  /// Whether a sub-block has been received in part.
  [[nodiscard]] static bool sub_block_begun(const Transfer& transfer) {
    return transfer.state() == State::block_downloading && transfer.progress().sequence != 0;
  }

  /// Sets a response with the number of the last segment in sequence; the client repeats the others.
  static void confirm_sub_block(Transfer& transfer) {
    transfer.clear_reply(sdo::block_download_confirm);
    transfer.reply()[1] = transfer.progress().sequence;
    transfer.reply()[2] = sdo::largest_block;
    transfer.progress().sequence = 0;
  }

  /// Completes a block download, if its CRC is right.
  [[nodiscard]] static AbortCode end_download(const sdo::Data& request, Transfer& transfer, auto hooks) {
    if (transfer.state() != State::block_download_ending) return transfer.reject_command();
    SdoBlockProgress& progress = transfer.progress();
    const std::uint32_t size = sdo::segment_bytes - ((request[0] >> 2) & 7u);
    if (const AbortCode code = transfer.check_room(size); code != ok) return code;
    progress.add_to_crc(transfer.held_segment(), size);
    if (progress.checked && (request[1] | request[2] << 8) != progress.crc) return AbortCode::crc;
    if (const AbortCode code = transfer.store(hooks, transfer.held_segment(), size, true); code != ok) return code;
    if (const AbortCode code = transfer.finish(hooks); code != ok) return code;
    transfer.clear_reply(sdo::block_download_end_answer);
    return ok;
  }

 private:
  /// The client has received the first segments of the sub-block. The missing ones are sent again, in the next
  /// sub-block.
  [[nodiscard]] static AbortCode sub_block_confirmed(const sdo::Data& request, Transfer& transfer, auto hooks) {
    SdoBlockProgress& progress = transfer.progress();
    if (request[1] > progress.sequence) return AbortCode::sequence_number;
    const auto lost = static_cast<std::uint8_t>(progress.sequence - request[1]);
    if (lost == 0 && progress.last) {
      end_upload(transfer);
      return ok;
    }
    if (!progress.set_size(request[2])) return AbortCode::block_size;
    if (lost != 0) {
      transfer.step_back(lost * sdo::segment_bytes - progress.unused);
      progress.repeated = static_cast<std::uint8_t>(progress.repeated + lost);
      progress.unused = 0;
      progress.last = false;
    }
    progress.sequence = 0;
    return next_segment(transfer, hooks);
  }

  static void end_upload(Transfer& transfer) {
    const SdoBlockProgress& progress = transfer.progress();
    transfer.enter(State::block_upload_ending);
    transfer.clear_reply(static_cast<std::uint8_t>(sdo::block_upload_end | (progress.unused << 2)));
    if (!progress.checked) return;
    transfer.reply()[1] = static_cast<std::uint8_t>(progress.crc);
    transfer.reply()[2] = static_cast<std::uint8_t>(progress.crc >> 8);
  }
};

}  // namespace canopen
