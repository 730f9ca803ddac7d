#include "device/dynamic_node.hpp"

#include <array>
#include <canopen/host/file_storage.hpp>
#include <canopen/host/memory_storage.hpp>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "device/values_service.hpp"

namespace edsc {
namespace {

constexpr std::size_t domain_bytes = 1024, readable_bytes = 16;

/// The storage of a node: a file, or the memory of the program.
class NodeStorage {
 public:
  NodeStorage(canopen::MemoryStorage& memory, const std::string& file) : memory_{memory} {
    if (!file.empty()) file_.emplace(file);
  }

  [[nodiscard]] canopen::StorageState open() { return file_ ? file_->open() : memory_.open(); }
  [[nodiscard]] std::uint32_t size() { return file_ ? file_->size() : memory_.size(); }
  [[nodiscard]] bool read(std::uint32_t position, std::span<std::uint8_t> bytes) {
    return file_ ? file_->read(position, bytes) : memory_.read(position, bytes);
  }
  [[nodiscard]] bool begin(std::uint32_t bytes) { return file_ ? file_->begin(bytes) : memory_.begin(bytes); }
  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) {
    return file_ ? file_->write(bytes) : memory_.write(bytes);
  }
  [[nodiscard]] bool commit() { return file_ ? file_->commit() : memory_.commit(); }

 private:
  canopen::MemoryStorage& memory_;
  std::optional<canopen::FileStorage> file_;
};

class NodeOfSheet final : public DynamicNode {
 public:
  NodeOfSheet(std::shared_ptr<const Sheet> sheet, canopen::SimulatedBus& bus, canopen::SimulatedMemory& memory,
              const std::string& file, NodeWatch* watch)
      : sheet_{std::move(sheet)},
        storage_{memory.parameters, file},
        node_{bus, memory.node_id(), canopen::stored_in(storage_), canopen::configured_by_lss(memory),
              WatchedBy{watch}} {
    node_.values().sheet = sheet_.get();
    domains_.reserve(sheet_->domains.size());
    for (const SheetDomain& domain : sheet_->domains) bind(domain);
  }

  void start(canopen::TimePoint now) override {
    node_.start(now);
    serve_until_ = now + longest_pause;
  }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override { node_.on_frame(frame, now); }
  void on_time(canopen::TimePoint now) override {
    serve_until_ = now + longest_pause;
    node_.on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override {
    const auto of_node = node_.next_deadline();
    return of_node && *of_node < serve_until_ ? of_node : serve_until_;
  }
  [[nodiscard]] canopen::NmtState state() const override { return node_.state(); }
  void accepted_frames(std::vector<canopen::AcceptedFrame>& frames) override {
    canopen::for_each_accepted_frame(node_, [&](const canopen::AcceptedFrame& frame) { frames.push_back(frame); });
  }

  canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, std::span<const std::uint8_t> bytes) override {
    return node_.set(index, sub_index, bytes);
  }
  void emergency(std::uint16_t code, canopen::ErrorRegister bits) override { node_.emergency(code, bits); }
  void emergency_over(canopen::ErrorRegister bits) override { node_.emergency_over(bits); }
  [[nodiscard]] std::string composition() const override { return " composition=edsc"; }

  [[nodiscard]] std::optional<std::vector<std::uint8_t>> get(std::uint16_t index, std::uint8_t sub_index) override {
    const auto entries = node_.entries();
    const canopen::entry::Word word = entries.find(index, sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return std::nullopt;
    if (canopen::entry::is_domain(word)) {
      const canopen::Domain domain = entries.domain(word);
      return std::vector<std::uint8_t>(domain.data, domain.data + domain.size);
    }
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = entries.read(word, scratch);
    return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
  }
  void request(canopen::NmtCommand command, canopen::TimePoint now) override { node_.request(command, now); }
  void on_bus_status(const canopen::BusStatus& status, canopen::TimePoint now) override {
    node_.on_bus_status(status, now);
  }
  [[nodiscard]] canopen::NodeId node_id() const override { return node_.node_id(); }
  void hold_error(canopen::ErrorRegister bits) override { node_.hold_error(bits); }

 private:
  /// A node has to be served every half hour at least.
  static constexpr canopen::Duration longest_pause{1'000'000'000};

  void bind(const SheetDomain& domain) {
    std::vector<std::uint8_t>& bytes = domains_.emplace_back(domain.bytes.begin(), domain.bytes.end());
    const std::size_t size = !bytes.empty() ? bytes.size() : domain.readable ? readable_bytes : 0;
    if (bytes.empty()) bytes.resize(domain_bytes);
    canopen::Domain bound{};
    bound.data = bytes.data();
    bound.size = static_cast<std::uint32_t>(size);
    bound.capacity = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(node_.values().bytes.data() + domain.offset, &bound, sizeof bound);
  }

  std::shared_ptr<const Sheet> sheet_;
  std::vector<std::vector<std::uint8_t>> domains_;
  NodeStorage storage_;
  canopen::Node<DynamicDevice, canopen::SimulatedBus, canopen::StoredIn<NodeStorage>,
                canopen::ConfiguredByLss<canopen::SimulatedMemory>, WatchedBy>
      node_;
  canopen::TimePoint serve_until_{};
};

}  // namespace

std::unique_ptr<DynamicNode> make_dynamic_node(std::shared_ptr<const Sheet> sheet, canopen::SimulatedBus& bus,
                                               canopen::SimulatedMemory& memory, const std::string& file,
                                               NodeWatch* watch) {
  return std::make_unique<NodeOfSheet>(std::move(sheet), bus, memory, file, watch);
}

}  // namespace edsc
