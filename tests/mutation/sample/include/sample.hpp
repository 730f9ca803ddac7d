#pragma once

#include <cstdint>
#include <string>

/// Each function has mutants of one kind; mutation_test.py names them by these lines.
namespace sample {

enum class Color : std::uint8_t { red = 1, green = 2 };

struct Row {
  int key, value;
};

constexpr Row rows[] = {{1, 10}, {2, 20}};

template <int size>
struct Buffer {
  int data[size + 1] = {};
};

inline bool is_adult(int age) { return age >= 18; }

inline int untested_edge(int age) { return age < 18 ? 1 : 2; }

inline int sum_up_to(int last) {
  int sum = 0;
  for (int i = 0; i < last; i += 1) {
    sum += i;
  }
  return sum;
}

inline std::string greeting(const std::string& name) { return "Hello, " + name; }

inline int value_of(int key) {
  for (const Row& row : rows) {
    if (row.key == key) return row.value;
  }
  return -1;
}

inline int code_of(Color color) {
  switch (color) {
    case Color::red: return 100;
    case Color::green: return 200;
  }
  return 0;
}

constexpr int twice(int number) { return number * 2; }

static_assert(twice(4) == 8);

inline int never_called(int number) { return number + 1; }

}  // namespace sample
