#include "application_station.hpp"

#include <optional>

#include "cpc_tc1/cpc_tc1.hpp"
#include "cpd/cpd.hpp"
#include "ezd_1136/ezd_1136.hpp"
#include "shared/input_line.hpp"
#include "shared/surroundings.hpp"
#include "support/access_probe.hpp"

namespace trace {

namespace {

template <template <class Bus> class Application, class Device>
class ApplicationStation final : public Station {
 public:
  explicit ApplicationStation(canopen::NodeId node_id) : around_{node_id} {}

  void power_on(canopen::TimePoint now) override {
    const bench::InApplication here;
    application_.emplace(*this, around_);
    application_->start(now);
  }
  void power_off() override { application_.reset(); }
  void on_frame(const canopen::Frame& frame, canopen::TimePoint now) override {
    const bench::InApplication here;
    if (application_) application_->on_frame(frame, now);
  }
  void on_time(canopen::TimePoint now) override {
    const bench::InApplication here;
    if (application_) application_->on_time(now);
  }
  [[nodiscard]] std::optional<canopen::TimePoint> next_deadline() const override {
    return application_ ? application_->next_deadline() : std::nullopt;
  }
  [[nodiscard]] bool input(const std::string& line, canopen::TimePoint now) override {
    const bench::InApplication here;
    return application_->input(nodes::InputLine{line}, now);
  }

  [[nodiscard]] canopen::AbortCode set(std::uint16_t index, std::uint8_t sub_index, const Value& value) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    return application_->node().set(index, sub_index, value.bytes(canopen::entry::wire_bytes(word)));
  }
  void emergency(const Emergency& error) override {
    application_->node().emergency(error.code, error.bits, error.info);
  }
  void emergency_over(canopen::ErrorRegister bits) override { application_->node().emergency_over(bits); }
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> value(std::uint16_t index, std::uint8_t sub_index) override {
    const canopen::entry::Word word = Device::dictionary.find(index, sub_index);
    if (word <= canopen::Dictionary::no_sub_index) return std::nullopt;
    std::array<std::uint8_t, 8> scratch{};
    const std::span<const std::uint8_t> bytes = application_->node().entries().read(word, scratch);
    return std::vector<std::uint8_t>{bytes.begin(), bytes.end()};
  }

 private:
  nodes::Surroundings around_;
  std::optional<Application<Station>> application_;  ///< empty without power
};

template <template <class Bus> class Application, class Device>
std::unique_ptr<Station> make(canopen::NodeId node_id) {
  return std::make_unique<ApplicationStation<Application, Device>>(node_id);
}

struct ApplicationRow {
  std::string_view name;
  std::unique_ptr<Station> (*make)(canopen::NodeId);
};

constexpr ApplicationRow applications[] = {
    {"cpc-tc1", make<cpc_tc1_node::CpcTc1, cpc_tc1::Device>},
    {"cpd", make<cpd_node::Cpd, cpd::Device>},
    {"ezd-1136", make<ezd_1136_node::Ezd1136, ezd_1136::Device>},
};

}  // namespace

std::unique_ptr<Station> make_application(std::string_view name, canopen::NodeId node_id) {
  for (const ApplicationRow& row : applications) {
    if (row.name == name) return row.make(node_id);
  }
  return nullptr;
}

}  // namespace trace
