/// Damaged stored parameters: an image whose bytes are changed, cut or lengthened, with and without a matching
/// checksum, and two pages of flash with arbitrary flipped bits. A node starts with any of them, has values inside
/// their limits, sends no PDO, EMCY or SYNC on a CAN-ID that CiA 301 restricts, and can store again.
///
/// An input is a byte of settings and a sequence of changes of four bytes: the kind, the position (two bytes),
/// and a value.
#include <canopen/node.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <every_service/device.hpp>

#include <cmath>
#include <cstring>
#include <vector>

#include "fuzz.hpp"
#include "support/omitting.hpp"

namespace edsc::fuzz {
namespace {

namespace od = every_service::od;
using canopen::Frame;
using canopen::NodeId;
using canopen::TimePoint;
using namespace std::chrono_literals;

/// An image that has passed every checksum.
struct Memory {
  std::vector<std::uint8_t> image{};
  std::vector<std::uint8_t> fresh{};

  [[nodiscard]] canopen::StorageState open() const {
    return image.empty() ? canopen::StorageState::empty : canopen::StorageState::whole;
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(image.size()); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) const {
    if (position > image.size() || to.size() > image.size() - position) return false;
    if (!to.empty()) std::memcpy(to.data(), image.data() + position, to.size());
    return true;
  }
  [[nodiscard]] bool begin(std::uint32_t) {
    fresh.clear();
    return true;
  }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    fresh.insert(fresh.end(), bytes.begin(), bytes.end());
    return true;
  }
  [[nodiscard]] bool commit() {
    image = fresh;
    return true;
  }
};

constexpr std::uint32_t flash_page = 2048;

struct Pages {
  static constexpr std::uint32_t page_size = flash_page;
  static constexpr std::uint32_t word_size = 4;
  std::vector<std::uint8_t> cells = std::vector<std::uint8_t>(2 * flash_page, 0xFF);

  [[nodiscard]] bool erase(std::uint8_t page) {
    std::memset(&cells[page * flash_page], 0xFF, flash_page);
    return true;
  }
  [[nodiscard]] bool write(std::uint8_t page, std::uint32_t offset, std::span<const std::uint8_t> words) {
    require(offset <= flash_page && words.size() <= flash_page - offset, "a page is written inside its bounds");
    std::memcpy(&cells[page * flash_page + offset], words.data(), words.size());
    return true;
  }
  [[nodiscard]] bool read(std::uint8_t page, std::uint32_t offset, std::span<std::uint8_t> to) const {
    if (offset > flash_page || to.size() > flash_page - offset) return false;
    if (!to.empty()) std::memcpy(to.data(), &cells[page * flash_page + offset], to.size());
    return true;
  }
};

constexpr unsigned node_id = 5;

/// The CAN-IDs of table 41 of CiA 301, which a configurable COB-ID must not use.
[[nodiscard]] bool is_restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) || (id >= 0x601 && id <= 0x67F) ||
         (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

struct Bus {
  unsigned sent = 0;
  std::uint8_t answer = 0;  ///< first byte of the last SDO answer
  bool booted = false;

  bool send(const Frame& frame) {
    require(++sent < 2000, "what a node sends at once is bounded");
    require(frame.size <= 8 && !frame.remote, "data frames have up to eight bytes");
    if (frame.extended) return true;
    if (frame.id == 0x700 + node_id) {
      booted = true;
    } else if (frame.id == 0x580 + node_id && frame.size == 8) {
      answer = frame.data[0];
    } else {
      require(!is_restricted(frame.id), "no service uses a restricted CAN-ID");
    }
    return true;
  }
};

template <class Node>
void check_values(const Node& node) {
  require(node.template get<od::percentage>() <= 100, "a limit holds");
  const float ratio = node.template get<od::ratio>();
  require(ratio >= -1.0f && ratio <= 1.0f, "the limits of a REAL hold");
  require(node.template get<od::text>().size <= od::text::type::capacity(), "a string has its room");
  require(node.template get<od::octets>().size <= od::octets::type::capacity(), "octets have their room");
  std::uint8_t contacts[4];
  std::size_t i = 0;
  const auto& values = node.values();
  for (const auto& contact : values.application_cleared.contacts) std::memcpy(&contacts[i++], &contact, 1);
  for (const std::uint8_t contact : contacts) require(contact <= 1, "a BOOLEAN is 0 or 1");
}

/// Starts a node with this storage and checks it.
template <class S>
void start(S& storage, bool and_store) {
  Bus bus;
  TimePoint now{};
  auto node = bench::make_node<every_service::Device>(bus, NodeId{node_id}, canopen::stored_in(storage));
  node.start(now);
  require(bus.booted && node.state() == canopen::NmtState::pre_operational, "a device starts");
  check_values(node);
  for (const std::uint32_t entry : {0x100000u, 0x101400u, 0x140001u, 0x180001u, 0x1A0000u, 0x200500u, 0x200600u}) {
    Frame frame{.id = 0x600 + node_id, .size = 8, .data = {0x40}};
    canopen::sdo::put_multiplexer(frame.data, static_cast<std::uint16_t>(entry >> 8), static_cast<std::uint8_t>(entry));
    bus.answer = 0;
    node.on_frame(frame, now);
    require((bus.answer & 0xE0) == 0x40, "an entry is read");
  }
  node.on_frame(Frame{.id = 0, .size = 2, .data = {1, 0}}, now);
  (void)node.template set<od::byte>(static_cast<std::uint8_t>(node.template get<od::byte>() + 1));
  (void)node.template set<od::positions<1>>(node.template get<od::positions<1>>() ^ 1);
  for (int i = 0; i < 10; ++i) {
    bus.sent = 0;
    node.on_frame(Frame{.id = 0x080, .size = static_cast<std::uint8_t>(i & 1)}, now);
    node.on_frame(Frame{.id = 0x205, .size = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}}, now);
    node.emergency(0xFF00, canopen::ErrorRegister{});
    node.emergency_over(canopen::ErrorRegister{});
    if (const auto deadline = node.next_deadline(); deadline && *deadline > now) now = *deadline;
    node.on_time(now);
  }
  check_values(node);
  if (!and_store) return;
  require(node.save() == canopen::ok, "a node stores over what was damaged");
  start(storage, false);
}

/// Stores values that differ from the defaults.
template <class S>
void fill(S& storage) {
  Bus bus;
  auto node = bench::make_node<every_service::Device>(bus, NodeId{node_id}, canopen::stored_in(storage));
  node.start({});
  (void)node.template set<od::percentage>(50);
  (void)node.template set<od::ratio>(0.5f);
  (void)node.template set<od::text>("stored");
  (void)node.template set<od::byte>(1);
  require(node.save() == canopen::ok, "a node stores");
}

void change(std::vector<std::uint8_t>& bytes, const std::uint8_t* change) {
  const std::size_t where = change[1] | static_cast<std::size_t>(change[2]) << 8;
  if (bytes.empty()) return;
  std::uint8_t& byte = bytes[where % bytes.size()];
  switch (change[0] % 4) {
    case 0: byte = change[3]; break;
    case 1: byte = static_cast<std::uint8_t>(byte ^ (1u << change[3] % 8)); break;
    case 2: byte = 0xFF; break;
    default: byte = static_cast<std::uint8_t>(byte + change[3]); break;
  }
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edsc::fuzz;
  if (size == 0) return 0;
  const std::uint8_t settings = data[0];
  ++data, --size;
  if ((settings & 1) != 0) {
    Pages pages;
    canopen::FlashStorage<Pages> storage{pages};
    fill(storage);
    if ((settings & 2) != 0) fill(storage);
    for (; size >= 4; data += 4, size -= 4) change(pages.cells, data);
    start(storage, true);
  } else {
    Memory storage;
    fill(storage);
    for (; size >= 4; data += 4, size -= 4) {
      if ((data[0] & 0xF0) == 0xF0) {
        storage.image.resize(storage.image.size() + data[3]);
      } else if ((data[0] & 0xF0) == 0xE0) {
        storage.image.resize((data[1] | static_cast<std::size_t>(data[2]) << 8) % (storage.image.size() + 1));
      } else {
        change(storage.image, data);
      }
    }
    start(storage, true);
  }
  return 0;
}
