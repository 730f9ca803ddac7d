/// An empty program, whose size is subtracted from every other image.
#include "../cortex_m/startup.hpp"

void program() {
  for (;;) {
  }
}
