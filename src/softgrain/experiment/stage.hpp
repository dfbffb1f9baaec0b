#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "softgrain/experiment/case.hpp"

namespace softgrain {

/// What the distance that walls have come together means as a strain.
struct StrainMeasure {
  /// of_grain: eps = -ln(1 - d/R), where d, the approach of a grain's centre to a wall, is half the travel;
  /// of_box: eps = ln(h_start/h).
  enum class Kind { of_grain, of_box };
  Kind kind = Kind::of_box;
  double length = 1;  ///< 2 R, or h_start [m]

  double travel(double strain) const;  ///< [m]
  /// For the distance of bottom and top at the start and now [m].
  double strain(double start, double now) const;
};

/// One part of a loading: how the walls move, and until what.
struct Stage {
  /// Rate at which bottom and top come together [m/s]: > 0 together, < 0 apart, 0 at rest. Where `stress` is
  /// kept, the largest of both ways.
  double speed = 0;
  /// Vertical stress that the walls keep [Pa]; 0: none.
  double stress = 0;
  /// Share of the rate that each wall makes along its normal, by BoxWall.
  std::array<double, 4> share{0, 1, 0, 0};
  std::optional<double> strain{};    ///< it ends at this strain
  std::optional<double> duration{};  ///< it ends after this time [s]
};

/// How the walls move when it is not the case that says it.
struct WallMotion {
  double duration = 0;  ///< [s]
  /// Of time [s]: rate of the distance of bottom and top [m/s], negative while they come together.
  std::function<double(double)> velocity;
};

/// What ends a loading before its last stage does.
struct LoadingEnds {
  double max_stress = 0;   ///< vertical [Pa]; 0: any
  double max_overlap = 0;  ///< mean, over the mean radius; 0: any
  double hold_stress = 0;  ///< from this vertical stress on [Pa] the walls keep it ...
  double hold = 0;         ///< ... for this time [s]; 0: no stress is held
  double speed = 0;        ///< of the walls while they keep it [m/s], at most
};

/// Stages of the short forms of a case. All go to a last strain at constant speed, back at given strains by a
/// given strain and together again, and rest where they turn and at the end:
/// diametral (one grain) and compaction by the top wall alone; isotropic by all four walls, the top and
/// bottom at half the speed each, so that the box keeps its shape and centre.
std::vector<Stage> stages_of(const Case& the_case);

/// What a strain is in a case, with a box of this height at the start [m].
StrainMeasure strain_measure(const Case& the_case, double height);

/// The last strain of a case: loading.max_strain, or where undeformed grains fill
/// loading.max_packing_fraction, Phi_0 = Phi_start e^(d eps), in a box that shrinks in d directions.
double last_strain(const Case& the_case);

/// Raises UsageError for a loading that cannot be followed, and for a stress that is held for no time.
void check_loading(const Case& the_case);

/// What ends the loading of a case.
LoadingEnds ends_of(const Case& the_case);

}  // namespace softgrain
