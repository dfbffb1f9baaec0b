// What the page calls: plain functions over one LiveSimulation. Memory is that of the module; a text or an
// array lasts until the next call.
#include <emscripten/emscripten.h>

#include <exception>
#include <memory>
#include <string>

#include "live_case.hpp"
#include "live_simulation.hpp"
#include "softgrain/core/error.hpp"

namespace softgrain {
namespace {

std::unique_ptr<LiveSimulation>& live() {
  static std::unique_ptr<LiveSimulation> simulation;
  return simulation;
}

/// What an action says, or what is wrong with it; "" if nothing.
template <class Action>
const char* words_of(const Action& action) {
  static std::string words;
  try {
    words = action();
  } catch (const std::exception& error) {
    words = error.what();
  }
  return words.c_str();
}

}  // namespace
}  // namespace softgrain

using namespace softgrain;

extern "C" {

/// A new simulation of the case of this text (live_case).
EMSCRIPTEN_KEEPALIVE const char* live_begin(const char* case_text) {
  return words_of([&] {
    live().reset();
    live() = std::make_unique<LiveSimulation>(live_case(case_text));
    return "";
  });
}

EMSCRIPTEN_KEEPALIVE double live_start_height() { return live()->start_height(); }

EMSCRIPTEN_KEEPALIVE void live_drive_to(double height) { live()->drive_to(height); }

/// One step; why there is no further one, "" if there is.
EMSCRIPTEN_KEEPALIVE const char* live_step() {
  return words_of([] {
    require(live() != nullptr, "no simulation has begun");
    live()->step();
    return live()->early_end();
  });
}

/// Where an array of the picture begins, and how many numbers it has. Array 0 draws the picture anew.
EMSCRIPTEN_KEEPALIVE const void* live_array(int which, int* size) {
  static const LivePicture* picture = nullptr;
  if (which == 0) picture = &live()->picture();
  const auto of = [&](const auto& numbers) -> const void* {
    *size = static_cast<int>(numbers.size());
    return numbers.data();
  };
  switch (which) {
    case 0:
      return of(picture->numbers);
    case 1:
      return of(picture->outline);
    case 2:
      return of(picture->outline_begin);
    case 3:
      return of(picture->disks);
    case 4:
      return of(picture->pressure);
    default:
      return of(picture->chains);
  }
}

}  // extern "C"
