#include "compare/change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace edsc {
std::string message_of(const Change& change) {
  const Rule& rule = change.rule.row();
  std::string text{rule.title};
  if (!change.old_value.empty() && !change.new_value.empty()) {
    text += fmt::format(" {} becomes {}", change.old_value, change.new_value);
  } else if (!change.old_value.empty() || !change.new_value.empty()) {
    text += fmt::format(" {}", change.old_value.empty() ? change.new_value : change.old_value);
  }
  return fmt::format("{}: {}", text, rule.explanation);
}

Change& Changes::add(ChangeRule rule, std::string entry, std::string name, const Position& old_position,
                     const Position& new_position) {
  return all_.emplace_back(
      Change{rule, std::move(entry), std::move(name), {}, {}, old_position, new_position, rule.row().breaks});
}

void Changes::keep(Audience audience) {
  if (audience == Audience::all) return;
  std::erase_if(all_, [&](Change& change) {
    const bool was_breaking = change.is_breaking();
    (audience == Audience::wire ? change.breaks.source : change.breaks.master) = false;
    if (audience == Audience::source) change.breaks.pdo = false;
    change.breaks.storage = false;
    return was_breaking && !change.is_breaking();
  });
}

void Changes::append(Changes more) {
  all_.insert(all_.end(), std::make_move_iterator(more.all_.begin()), std::make_move_iterator(more.all_.end()));
}

std::size_t Changes::breaking() const {
  return static_cast<std::size_t>(std::ranges::count_if(all_, &Change::is_breaking));
}

}  // namespace edsc
