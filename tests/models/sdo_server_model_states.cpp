/// The states of the model of an SDO server, and the requests that lead from each to others.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "sdo_server_model.hpp"

namespace model {

std::string SdoServer::key() const {
  if (phase_ == Phase::idle) return "idle";
  const auto part = [](std::size_t position, std::size_t end) {
    return position == 0 ? 'b' : position + 7 >= end ? 'e' : 'm';
  };
  char text[80];
  const std::size_t end = phase_ == Phase::upload || phase_ >= Phase::block_upload_initiated ? entry_->value.size()
                          : announced_                                                       ? *announced_
                                                                                             : entry_->size;
  const bool block = phase_ != Phase::download && phase_ != Phase::upload;
  const unsigned sub_block = !block                         ? 0
                             : in_order_ == 0               ? 1
                             : in_order_ == 1               ? 2
                             : in_order_ + 1 == block_size_ ? 4
                             : in_order_ == block_size_     ? 5
                                                            : 3;
  const std::size_t position =
      phase_ == Phase::upload || phase_ >= Phase::block_upload_initiated ? position_ : taken_.size();
  std::snprintf(text, sizeof text, "%d %04X:%02X t%d %c %c%c%c n%u b%d", static_cast<int>(phase_),
                static_cast<unsigned>(entry_->index), static_cast<unsigned>(entry_->sub_index), toggle_,
                part(position, end), announced_ ? 's' : '-', block && crc_ ? 'c' : '-',
                block && last_arrived_ ? 'l' : '-', sub_block,
                block_size_ == 1     ? 1
                : block_size_ == 127 ? 3
                                     : 2);
  return text;
}

std::vector<Data> SdoServer::suggestions() const {
  std::vector<Data> list;
  const auto add = [&list](Data data) { list.push_back(data); };
  const auto byte = [](std::size_t value) { return static_cast<std::uint8_t>(value); };
  const Data content{0, 'a', 'b', 'c', 'd', 'e', 'f', 'g'};
  const auto content_with = [&](std::size_t command) {
    Data data = content;
    data[0] = byte(command);
    return data;
  };
  switch (phase_) {
    case Phase::idle: break;
    case Phase::download: {
      const std::size_t left =
          announced_.value_or(static_cast<std::uint32_t>(std::min<std::size_t>(entry_->size, 20))) - taken_.size();
      add(left > 7 ? content_with(toggle_) : content_with(toggle_ | (7 - left) << 1 | 1u));
      add(content_with(toggle_ | 5u << 1));
      break;
    }
    case Phase::upload: add({toggle_ == 0 ? byte(0x60) : byte(0x70)}); break;
    case Phase::block_download: {
      add(content_with(in_order_ + 1));
      add(content_with((in_order_ + 1) | 0x80u));
      add(content_with(block_size_));
      add(content_with(block_size_ | 0x80u));
      break;
    }
    case Phase::block_download_end:
      for (std::size_t unused = 0; unused < 8; ++unused) {
        Octets bytes(taken_.begin(), taken_.end() - static_cast<int>(unused));
        const std::uint16_t crc = crc_of(bytes);
        add({byte(0xC1 | unused << 2), byte(crc), byte(crc >> 8)});
      }
      break;
    case Phase::block_upload_initiated: add({0xA3}); break;
    case Phase::block_upload_sent:
      for (const unsigned size : {1u, 3u, 127u}) {
        add({0xA2, byte(in_order_), byte(size)});
        add({0xA2, byte(in_order_ - 1), byte(size)});
        add({0xA2, 0, byte(size)});
      }
      break;
    case Phase::block_upload_end: add({0xA1}); break;
  }
  return list;
}

}  // namespace model
