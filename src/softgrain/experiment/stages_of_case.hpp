#pragma once
#include <vector>

#include "softgrain/experiment/case.hpp"
#include "softgrain/loading/plan.hpp"
#include "softgrain/loading/stage.hpp"

namespace softgrain {

/// Stages of a case: its own, or those of its short form.
/// diametral (one grain), compaction, isotropic: to a last strain at constant speed, back at given strains by
/// a given strain and together again, with rests where they turn and at the end; by the top wall alone, or by
/// all four, the top and bottom at half the speed each, so that the box keeps its shape and centre.
/// biaxial, die, relaxation: see LoadingPath.
std::vector<Stage> stages_of(const Case& the_case);

/// What the stages of a case count in; the Loading takes the start from its box.
LoadingFrame frame_of(const Case& the_case);

/// The last strain of a case: loading.max_strain, or where undeformed grains fill
/// loading.max_packing_fraction, Phi_0 = Phi_start e^(d eps), in a box that shrinks in d directions; of
/// stages, the largest that they name.
double last_strain(const Case& the_case);

/// Raises UsageError for a loading that cannot be followed, and for a stress that is held for no time.
void check_loading(const Case& the_case);

/// The least stress that walls keep [Pa]; 0: none do.
double least_kept_stress(const Case& the_case);
/// The largest stress that walls keep while others are moved [Pa]; 0: none do.
double stress_beside_motion(const Case& the_case);
/// The largest stress that the stages name [Pa]; 0: they name none.
double largest_named_stress(const Case& the_case);
/// Speed of the walls, of the fastest stage of one's own in a box of this height [m/s].
double fastest_speed(const Case& the_case, double height);
/// The largest rate of strain, or of shear strain, that the loading of a case gives a box of this height (of
/// one grain between walls: this distance) as it starts [1/s]. Walls that keep a stress come at their largest
/// speed where nothing else moves; 0: nothing moves.
double fastest_rate(const Case& the_case, double height);

}  // namespace softgrain
