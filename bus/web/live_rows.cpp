#include "web/live_rows.hpp"

#include <utility>

namespace edsc {

void LiveRows::publish(std::vector<LiveRow> rows, const std::vector<std::string>& removed) {
  {
    const std::lock_guard lock{mutex_};
    ++version_;
    for (const std::string& key : removed) rows_.erase(key);
    for (LiveRow& row : rows) {
      const auto [at, is_new] = rows_.try_emplace(std::move(row.key));
      if (is_new || at->second.json != row.json) at->second = {std::move(row.json), version_};
    }
  }
  changed_.notify_all();
}

std::optional<LiveRows::Update> LiveRows::wait(std::uint64_t version, std::chrono::milliseconds most) {
  std::unique_lock lock{mutex_};
  changed_.wait_for(lock, most, [&] { return version_ > version || has_ended_; });
  if (version_ <= version || has_ended_) return std::nullopt;
  Update update{version_, R"({"rows":[)"};
  const std::size_t begin = update.json.size();
  for (const auto& [key, row] : rows_) {
    if (row.version <= version) continue;
    if (update.json.size() != begin) update.json += ',';
    update.json += row.json;
  }
  update.json += "]}";
  return update;
}

void LiveRows::end() {
  {
    const std::lock_guard lock{mutex_};
    has_ended_ = true;
  }
  changed_.notify_all();
}

bool LiveRows::has_ended() const {
  const std::lock_guard lock{mutex_};
  return has_ended_;
}

}  // namespace edsc
