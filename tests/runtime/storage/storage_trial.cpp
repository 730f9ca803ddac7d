/// Stored parameters under power cuts, updates and bit flips, compared with a model. The seed makes a run repeatable.
///
///     storage_trial cuts NUMBER [SEED]    power is cut while parameters are saved, between updates to six versions
///     storage_trial flips NUMBER [SEED]   images in flash with one to three flipped bits
#include <algorithm>
#include <array>
#include <canopen/node.hpp>
#include <canopen/storage/background_storage.hpp>
#include <canopen/storage/flash_storage.hpp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <parameters/device.hpp>
#include <parameters_1/device.hpp>
#include <parameters_2/device.hpp>
#include <parameters_3/device.hpp>
#include <parameters_4/device.hpp>
#include <parameters_5/device.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "flash_emulation.hpp"
#include "support/omitting.hpp"

namespace {

using canopen::StorageState;
using Random = std::mt19937;

std::uint32_t below(Random& random, std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); }

[[noreturn]] void fail(const std::string& what) {
  std::printf("%s\n", what.c_str());
  std::exit(1);
}

// A storage in flash, written at once or in steps

using Flash = bench::FlashEmulation<512, 8>;

class TrialStorage {
 public:
  TrialStorage(Flash& flash, bool in_steps) : flash_{flash}, in_steps_{in_steps} {}

  [[nodiscard]] StorageState open() { return in_steps_ ? steps_.open() : pages_.open(); }
  [[nodiscard]] std::uint32_t size() const { return in_steps_ ? steps_.size() : pages_.size(); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> to) {
    return in_steps_ ? steps_.read(position, to) : pages_.read(position, to);
  }
  [[nodiscard]] bool begin(std::uint32_t size) { return in_steps_ ? steps_.begin(size) : pages_.begin(size); }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    return in_steps_ ? steps_.write(bytes) : pages_.write(bytes);
  }
  [[nodiscard]] bool commit() {
    if (!in_steps_) return pages_.commit();
    if (!steps_.commit()) return false;
    steps_.finish();
    return !steps_.failed();
  }

 private:
  Flash& flash_;
  bool in_steps_;
  canopen::FlashStorage<Flash> pages_{flash_};
  canopen::BackgroundStorage<canopen::FlashStorage<Flash>, 480, 16> steps_{pages_};
};

// The model: what CiA 301 and the options of each version say, written by hand

enum Type : std::uint8_t { u8 = 0x01, u16 = 0x02, u32 = 0x04, i24 = 0x13, i32 = 0x14, real = 0x24, text = 0x30 };

constexpr unsigned communication = 2, application = 3, manufacturer = 4, group = 5, other = 1;  // sub-indices of 1010h

struct Entry {
  std::uint16_t index;
  std::uint8_t sub_index;
  Type type;
  unsigned section;
  std::uint32_t limit;    ///< highest value, or capacity; 0: none
  std::uint64_t initial;  ///< default value; of a text, its letters
};

using Version = std::vector<Entry>;

constexpr std::uint64_t letters(const char* word) {
  std::uint64_t bits = 0;
  for (unsigned i = 0; word[i] != 0; ++i) bits |= std::uint64_t{static_cast<std::uint8_t>(word[i])} << (8 * i);
  return bits;
}

std::vector<Version> versions() {
  const Version first{{0x1014, 0, u32, communication, 0, 0x80},
                      {0x1017, 0, u16, communication, 0, 0},
                      {0x2000, 0, u16, manufacturer, 10, 3},
                      {0x2001, 0, text, manufacturer, 8, letters("text")},
                      {0x2002, 0, i24, manufacturer, 0, 0xFFFFFB},
                      {0x2003, 1, u8, manufacturer, 0, 1},
                      {0x2003, 2, u8, manufacturer, 0, 2},
                      {0x2003, 3, u8, manufacturer, 0, 3},
                      {0x2004, 0, u32, manufacturer, 0, 1000},
                      {0x6000, 0, i32, application, 0, 0},
                      {0x6001, 0, real, application, 0x42C8'0000, 0x3FC0'0000},
                      {0xA000, 0, u16, other, 0, 0}};
  std::vector<Version> all(6, first);
  const auto find = [](Version& version, std::uint16_t index) {
    return std::ranges::find(version, index, &Entry::index);
  };
  find(all[1], 0x2000)->limit = 11;
  all[1].insert(find(all[1], 0x6000), {0x2009, 0, u16, manufacturer, 0, 9});
  find(all[2], 0x2000)->limit = 5;
  find(all[2], 0x6001)->limit = 0x4000'0000;
  find(all[3], 0x2000)->type = u32;
  find(all[3], 0x2001)->limit = 4;
  all[4].erase(find(all[4], 0x2002));
  all[4].insert(find(all[4], 0x2004), {0x2003, 4, u8, manufacturer, 0, 4});
  all[5].erase(find(all[5], 0x2004));
  all[5].erase(find(all[5], 0x6000));
  for (Entry& entry : all[5]) {
    if (entry.index == 0x2003) entry.section = group;
  }
  return all;
}

using Bytes = std::vector<std::uint8_t>;

struct Record {
  std::uint16_t index;
  std::uint8_t sub_index;
  Type type;
  Bytes bytes;
  std::uint8_t node_id;
};
using Image = std::vector<Record>;

std::size_t bytes_of(Type type) { return type == text ? 0 : type & 0xFu; }

Bytes initial_bytes(const Entry& entry, std::uint8_t node_id) {
  Bytes bytes;
  const std::uint64_t bits = entry.initial + (entry.index == 0x1014 ? node_id : 0);
  for (std::uint64_t left = bits; entry.type == text && left != 0; left >>= 8) {
    bytes.push_back(static_cast<std::uint8_t>(left));
  }
  for (std::size_t i = 0; i < bytes_of(entry.type); ++i) bytes.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
  return bytes;
}

bool fits(const Entry& entry, const Record& record) {
  if (entry.type != record.type) return false;
  if (entry.type == text) return record.bytes.size() <= entry.limit;
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < record.bytes.size(); ++i) number |= std::uint32_t{record.bytes[i]} << (8 * i);
  if (entry.index == 0x1014) return number < 0x800;  // COB-IDs of this trial
  return entry.limit == 0 || number <= entry.limit;  // positive REAL32s are in the order of their bits
}

const Entry* entry_of(const Version& version, const Record& record) {
  for (const Entry& entry : version) {
    if (entry.index == record.index && entry.sub_index == record.sub_index) return &entry;
  }
  return nullptr;
}

unsigned section_of(std::uint16_t index) {
  return index < 0x2000 ? communication : index < 0x6000 ? manufacturer : index < 0xA000 ? application : other;
}

bool is_stored_by(unsigned sub_index, unsigned section) { return sub_index == 1 || sub_index == section; }

/// The values of a version after power-on.
struct Values {
  std::vector<Bytes> values;  ///< one for each entry
  bool reported = false;      ///< EMCY 6300h
  friend bool operator==(const Values&, const Values&) = default;
};

Values loaded(const Version& version, const Image& image, std::uint8_t node_id) {
  Values result;
  for (const Entry& entry : version) result.values.push_back(initial_bytes(entry, node_id));
  for (const Record& record : image) {
    const Entry* const entry = entry_of(version, record);
    if (entry == nullptr || !fits(*entry, record)) {
      const bool is_default = entry != nullptr && entry->type == record.type && entry->type != text &&
                              record.bytes == initial_bytes(*entry, node_id);
      result.reported = result.reported || !is_default;
    } else if (!(record.index == 0x1014 && record.bytes == initial_bytes(*entry, record.node_id))) {
      result.values[static_cast<std::size_t>(entry - version.data())] = record.bytes;
    }
  }
  return result;
}

Image saved(const Version& version, const Image& image, unsigned sub_index, const Image& present) {
  Image result;
  for (const Record& record : image) {
    const Entry* const entry = entry_of(version, record);
    if (entry == nullptr || !fits(*entry, record) || !is_stored_by(sub_index, entry->section)) result.push_back(record);
  }
  // A value that could not have been written, and is still the present one, is not stored twice.
  for (const Record& record : present) {
    std::erase_if(result, [&](const Record& kept) {
      const Entry* const entry = entry_of(version, kept);
      return entry != nullptr && is_stored_by(sub_index, entry->section) && entry->type != text &&
             kept.index == record.index && kept.sub_index == record.sub_index && kept.type == record.type &&
             kept.bytes == record.bytes;
    });
  }
  for (const Record& record : present) {
    if (is_stored_by(sub_index, entry_of(version, record)->section)) result.push_back(record);
  }
  return result;
}

Image restored(const Version& version, const Image& image, unsigned sub_index) {
  Image result;
  for (const Record& record : image) {
    const Entry* const entry = entry_of(version, record);
    const bool is_loaded = entry != nullptr && fits(*entry, record);
    if (!is_stored_by(sub_index, is_loaded ? entry->section : section_of(record.index))) result.push_back(record);
  }
  return result;
}

// The devices

struct Bus {
  bool reported = false;
  bool send(const canopen::Frame& frame) {
    reported = reported || (frame.size == 8 && frame.data[0] == 0x00 && frame.data[1] == 0x63);
    return true;
  }
};

template <class Device>
using Node = bench::NodeOf<Device, Bus, canopen::StoredIn<TrialStorage>>;

/// Reads the values of a version.
template <class N>
Image values_of(N& node, const Version& version) {
  Image image;
  for (const Entry& entry : version) {
    const canopen::entry::Word word = node.entries().find(entry.index, entry.sub_index);
    std::array<std::uint8_t, 8> scratch;
    const auto bytes = node.entries().read(word, scratch);
    image.push_back(
        {entry.index, entry.sub_index, entry.type, Bytes(bytes.begin(), bytes.end()), node.node_id().value()});
  }
  return image;
}

struct Trial {
  std::vector<Version> all = versions();
  Flash flash;
  Image image;  ///< that of the model
  Random random;
  std::uint64_t cuts = 0, updates = 0, reports = 0;

  /// A power-on with a version, some changes, a command that a power cut may end, and the check after the next
  /// power-on, with the same version.
  template <class Device>
  void run(std::size_t number) {
    const Version& version = all[number];
    const auto node_id = static_cast<std::uint8_t>(below(random, 8) == 0 ? 9 : 5);
    const bool in_steps = below(random, 2) == 0;
    flash.power_on();
    TrialStorage storage{flash, in_steps};
    Bus bus;
    Node<Device> node{bus, canopen::NodeId{node_id}, canopen::stored_in(storage)};
    node.start({});
    node.on_time({});
    expect(node, bus, version, loaded(version, image, node_id), "power-on");
    if (bus.reported) ++reports;
    for (unsigned changes = below(random, 4); changes > 0; --changes) change(node, version);
    const unsigned sub_index = 1 + below(random, number == 5 ? 5 : 4);
    const bool saves = below(random, 6) != 0;
    const Image before = image;
    const Image after =
        saves ? saved(version, image, sub_index, values_of(node, version)) : restored(version, image, sub_index);
    const bool is_cut = below(random, 4) != 0;
    flash.cut = static_cast<Flash::Cut>(below(random, 3));
    if (is_cut) flash.last_step = flash.steps + static_cast<int>(below(random, 40));
    const canopen::AbortCode code =
        saves ? node.save(static_cast<std::uint8_t>(sub_index)) : node.restore(static_cast<std::uint8_t>(sub_index));
    const bool had_power = flash.has_power();
    if (had_power && code != canopen::ok) fail("a command with power has failed");
    if (!had_power) ++cuts;
    image = after;
    if (had_power) return;
    // Power was cut: the old or the new image.
    flash.power_on();
    TrialStorage again{flash, in_steps};
    Bus second_bus;
    Node<Device> second{second_bus, canopen::NodeId{node_id}, canopen::stored_in(again)};
    second.start({});
    second.on_time({});
    const Values found = found_in(second, second_bus, version);
    if (found == loaded(version, after, node_id)) {
      if (found != loaded(version, before, node_id) || is_image(again, after)) return;
    } else if (found != loaded(version, before, node_id)) {
      fail("after a power cut the values are neither the old nor the new ones");
    }
    image = before;
  }

  template <class N>
  Values found_in(N& node, const Bus& bus, const Version& version) {
    Values found;
    for (const Record& record : values_of(node, version)) found.values.push_back(record.bytes);
    found.reported = bus.reported;
    return found;
  }

  template <class N>
  void expect(N& node, const Bus& bus, const Version& version, const Values& expected, const std::string& when) {
    const Values found = found_in(node, bus, version);
    if (found == expected) return;
    std::string text =
        when + ": reported " + std::to_string(found.reported) + ", expected " + std::to_string(expected.reported);
    for (std::size_t i = 0; i < version.size(); ++i) {
      if (found.values[i] == expected.values[i]) continue;
      char line[64];
      std::snprintf(line, sizeof line, "\n%04Xh:%02X is not as expected", version[i].index, version[i].sub_index);
      text += line;
    }
    fail(text);
  }

  /// Whether the storage has this image: after some commands the values of a version do not show it.
  static bool is_image(TrialStorage& storage, const Image& image) {
    std::uint32_t at = 4;
    for (const Record& record : image) {
      std::array<std::uint8_t, 4> header{};
      do {  // a context has the index 0
        if (at >= storage.size() || !storage.read(at, header)) return false;
        at += 4;
      } while (header[0] == 0 && header[1] == 0);
      if (header[0] != (record.index & 0xFF) || header[1] != record.index >> 8 || header[2] != record.sub_index ||
          header[3] != record.type)
        return false;
      if (record.type == text) at += 2;
      Bytes bytes(record.bytes.size());
      if (!storage.read(at, bytes) || bytes != record.bytes) return false;
      at += static_cast<std::uint32_t>(bytes.size());
    }
    return at == storage.size();
  }

  template <class N>
  void change(N& node, const Version& version) {
    const Entry& entry = version[below(random, static_cast<std::uint32_t>(version.size()))];
    Bytes bytes(entry.type == text ? below(random, entry.limit + 1) : bytes_of(entry.type));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>('a' + below(random, 26));
    if (entry.index == 0x1014) bytes = {static_cast<std::uint8_t>(0x90 + below(random, 16)), 0, 0, 0};
    if (entry.index == 0x2000) bytes.assign(bytes.size(), 0), bytes[0] = static_cast<std::uint8_t>(below(random, 12));
    if (entry.index == 0x6001) bytes = {0, 0, static_cast<std::uint8_t>(below(random, 200)), 0x40};
    static_cast<void>(node.set(entry.index, entry.sub_index, bytes));
  }

  void run_one() {
    const std::size_t number = version_;
    switch (number) {
      case 0: run<parameters::Device>(0); break;
      case 1: run<parameters_1::Device>(1); break;
      case 2: run<parameters_2::Device>(2); break;
      case 3: run<parameters_3::Device>(3); break;
      case 4: run<parameters_4::Device>(4); break;
      default: run<parameters_5::Device>(5); break;
    }
    if (below(random, 3) == 0) {
      version_ = below(random, 6);
      if (version_ != number) ++updates;
    }
    if (flash.misused) fail("a word of flash was written twice");
  }

 private:
  std::size_t version_ = 0;
};

int run_cuts(std::uint64_t number, std::uint32_t seed) {
  Trial trial;
  trial.random.seed(seed);
  while (trial.cuts < number) trial.run_one();
  std::printf("%llu power cuts, %llu updates, %llu power-ons with a report\n",
              static_cast<unsigned long long>(trial.cuts), static_cast<unsigned long long>(trial.updates),
              static_cast<unsigned long long>(trial.reports));
  return 0;
}

/// Images of `Size` bytes in pages with words of `WordSize` bytes.
template <std::uint32_t WordSize>
void flip(Random& random, std::uint64_t& unreported, std::uint64_t& reported) {
  using Pages = bench::FlashEmulation<256, WordSize>;
  Pages pages;
  canopen::FlashStorage storage{pages};
  static_cast<void>(storage.open());
  const auto put = [&](std::uint8_t first, std::uint32_t size) {
    Bytes bytes(size, first);
    if (!storage.begin(size) || !storage.write(bytes) || !storage.commit()) fail("an image was not written");
    return bytes;
  };
  static_cast<void>(put(1, 1 + below(random, 60)));
  const Bytes newest = put(2, 1 + below(random, 60));
  const std::uint32_t flips = 1 + below(random, 3);
  for (std::uint32_t i = 0; i < flips; ++i) {
    pages.pages[below(random, 2)].at(below(random, 256)) ^= static_cast<std::uint8_t>(1u << below(random, 8));
  }
  canopen::FlashStorage after{pages};
  const StorageState state = after.open();
  Bytes bytes(after.size());
  if (!after.read(0, bytes)) fail("an image cannot be read");
  if (state == StorageState::damaged) {
    ++reported;
  } else if (bytes != newest) {
    ++unreported;
  }
}

int run_flips(std::uint64_t number, std::uint32_t seed) {
  Random random{seed};
  std::uint64_t unreported = 0;
  std::uint64_t reported = 0;
  for (std::uint64_t i = 0; i < number; ++i) {
    switch (i % 4) {
      case 0: flip<1>(random, unreported, reported); break;
      case 1: flip<4>(random, unreported, reported); break;
      case 2: flip<8>(random, unreported, reported); break;
      default: flip<32>(random, unreported, reported); break;
    }
  }
  std::printf("%llu images with flipped bits: %llu reported as damaged, %llu with older values and no report\n",
              static_cast<unsigned long long>(number), static_cast<unsigned long long>(reported),
              static_cast<unsigned long long>(unreported));
  return unreported == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) return 2;
  const std::uint64_t number = std::strtoull(arguments[2], nullptr, 10);
  const auto seed = static_cast<std::uint32_t>(count > 3 ? std::strtoul(arguments[3], nullptr, 10) : 1);
  return std::string{"flips"} == arguments[1] ? run_flips(number, seed) : run_cuts(number, seed);
}
