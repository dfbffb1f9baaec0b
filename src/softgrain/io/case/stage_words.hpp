#pragma once
#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>

#include "softgrain/loading/stage.hpp"

namespace softgrain {

/// What a part may do, in the words of a file.
struct Manner {
  const char* word;
  Control control;
};
inline constexpr std::array manners{Manner{"velocity", Control::velocity}, Manner{"rate", Control::rate},
                                    Manner{"stress", Control::stress},
                                    Manner{"strain_amplitude", Control::strain}};

/// What a stage may set, by the names of the keys.
struct Setting {
  const char* key;
  std::optional<double> Settings::*value;
};
inline constexpr std::array all_settings{Setting{"contact.friction", &Settings::friction},
                                         Setting{"contact.wall_friction", &Settings::wall_friction},
                                         Setting{"solver.tolerance", &Settings::solver_tolerance},
                                         Setting{"mpm.tolerance", &Settings::newton_tolerance},
                                         Setting{"mpm.damping", &Settings::damping}};

/// Of an end of a stage.
inline std::string stress_word(std::size_t part, int dimension) {
  return fmt::format("stress_{}", name_of(static_cast<Part>(part), dimension));
}

/// By component.
inline std::array<const char*, 3> strain_words(int dimension) {
  return dimension == 3 ? std::array{"strain", "strain_yy", "strain_xx"}
                        : std::array{"strain", "strain_xx", "strain_xy"};
}

}  // namespace softgrain
