#pragma once
#include <vector>

#include "softgrain/material/any_law.hpp"

namespace softgrain {

/// How a material point is driven, always in plane strain (F_33 = 1). `strain` is
///   shear     gamma of F = 1 + gamma e_x (x) e_y
///   uniaxial  ln of the stretch along x; along y the point is free of stress
///   confined  the same, and along y it keeps its width
///   cycle     as uniaxial: to the strain, back to none, and to the strain again
enum class ElementPath { shear, uniaxial, confined, cycle };

struct ElementTest {
  ElementPath path = ElementPath::uniaxial;
  double strain = 0.2;  ///< to go to [-]; below 0 pressed
  double rate = 1;      ///< |d strain/dt| [1/s]; matters to laws with time in them
  int steps = 200;      ///< to there; as many for each way of a cycle
};

/// A point at the end of a step.
struct ElementRow {
  double time = 0;                                                    ///< [s]
  double strain = 0;                                                  ///< along the path [-]
  double stretch = 1;                                                 ///< along y [-]
  double stress_xx = 0, stress_yy = 0, stress_zz = 0, stress_xy = 0;  ///< Cauchy's [Pa], tension positive
  double pressure = 0;                                                ///< -tr(stress)/3 [Pa]
  double von_mises = 0;                                               ///< sqrt(3/2 s : s) [Pa]
  double plastic_strain = 0;                                          ///< equivalent; 0 where nothing flows
  /// Done on the point, int P : dF by the trapezoidal rule; elastic energy in it; what is lost [J/m^3 of the
  /// undeformed material]. work = stored + dissipated but for the length of the steps.
  double work = 0, stored = 0, dissipated = 0;
};

/// The element test: drives one point of the law, with what it remembers, along the path. The first row is
/// the undeformed point. UsageError for a test that cannot be; NumericalError where no width is free of
/// stress.
std::vector<ElementRow> drive_point(const AnyLaw& law, const ElementTest& test);

}  // namespace softgrain
