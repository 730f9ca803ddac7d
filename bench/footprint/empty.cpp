/// Nothing: what is taken off every other image.
#include "../cortex_m/startup.hpp"

void program() {
  for (;;) {
  }
}
