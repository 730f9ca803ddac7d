#include <cstdio>

#include "sample.hpp"

namespace {

int failures = 0;

void expect(bool condition, const char* name) {
  if (condition) return;
  std::printf("FAIL: %s\n", name);
  ++failures;
}

}  // namespace

int main() {
  expect(sample::is_adult(18) && sample::is_adult(19) && !sample::is_adult(17), "is_adult");
  expect(sample::untested_edge(10) == 1 && sample::untested_edge(30) == 2, "untested_edge");
  expect(sample::sum_up_to(4) == 6, "sum_up_to");
  expect(sample::greeting("Ada") == "Hello, Ada", "greeting");
  expect(sample::value_of(2) == 20 && sample::value_of(3) == -1, "value_of");
  expect(sample::code_of(sample::Color::green) == 200, "code_of");
  expect(sizeof(sample::Buffer<2>) == 3 * sizeof(int), "Buffer");
  return failures;
}
