#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "softgrain/model/settings.hpp"

namespace softgrain {

/// What a stage moves: a component is both walls of a pair, or both ends of a periodic cell, each of which
/// makes half of the way, so that the box keeps its centre.
enum class Part : std::size_t {
  yy,      ///< bottom and top wall
  xx,      ///< left and right wall
  bottom,  ///< one wall alone
  top,
  left,
  right,
  xy,   ///< shear of a cell that repeats along both axes: what lies higher goes to +x
  all,  ///< all four walls, the box keeping its shape; of the short forms
};
constexpr std::size_t number_of_parts = 8;
/// Parts that have a stress: all but `all`. That of xy is -sigma_xy, which resists shear to +x.
constexpr std::size_t parts_with_stress = 7;

/// Share of the rate of a part that each wall makes along its normal, by BoxWall.
std::array<double, 4> share_of(Part part, double aspect);
/// The same of the walls of a box of Dim dimensions. In space, where the vertical axis is z, `yy` stands for
/// the vertical pair, `xx` for the pair along y and `xy` for that along x: there is no shear yet, and no side
/// wall alone. aspect_y: depth over height.
template <int Dim>
std::array<double, 2 * Dim> share_in(Part part, double aspect, double aspect_y) {
  std::array<double, 2 * Dim> share{};
  const auto plane = share_of(part, Dim == 2 ? aspect : aspect_y);
  for (std::size_t w = 0; w < plane.size(); ++w) share[w] = plane[w];
  if constexpr (Dim == 3) share[4] = share[5] = part == Part::all ? 0.5 * aspect : part == Part::xy ? 0.5 : 0;
  return share;
}
constexpr std::size_t number_of(Part part) { return static_cast<std::size_t>(part); }
/// 1 for what moves along y, or shears, 0 along x.
int axis_of(Part part);
/// 0: yy, 1: xx, 2: xy.
int component_of(Part part);
/// axis_of in a box of Dim dimensions.
template <int Dim>
int axis_in(Part part) {
  return Dim == 2 ? axis_of(part) : Dim - 1 - component_of(part);
}
/// "yy", "top"; in space "zz", "yy" and "xx" are the vertical pair, that along y and that along x.
std::string_view name_of(Part part, int dimension = 2);

enum class Control {
  rest,
  velocity,  ///< at which the walls come together [m/s], < 0: apart; of xy the rate [1/s]
  rate,      ///< of the strain [1/s], compression positive
  stress,    ///< that the walls keep [Pa], compression positive
  strain,    ///< that swings about that at the start of the stage
};
enum class Wave { sine, triangle };

/// What one part does.
struct Drive {
  Part part = Part::yy;
  Control control = Control::rest;
  double value = 0;      ///< [m/s], [1/s] or [Pa]
  double speed = 0;      ///< of walls that keep a stress, at most [m/s]; 0: that of the loading
  double amplitude = 0;  ///< of the wave: a strain, or a stress [Pa]; 0: none
  double period = 0;     ///< of the wave [s]
  Wave wave = Wave::sine;
  bool quasi_static = false;  ///< the case leaves the rate to its inertial number

  /// What it keeps or swings to at a time of its stage.
  double target(double time) const;
  /// Does it say how fast its walls go, whatever the grains do?
  bool is_given() const { return control == Control::velocity || control == Control::rate; }
  friend bool operator==(const Drive&, const Drive&) = default;
};

/// What ends a stage: the first that holds. Strains count from the start of the run, compression positive.
struct Until {
  std::optional<double> time{};                                   ///< since the stage began [s]
  std::array<std::optional<double>, 3> strain{};                  ///< yy, xx; xy: gamma; in space zz, yy, xx
  std::array<std::optional<double>, parts_with_stress> stress{};  ///< by Part [Pa]
  std::optional<double> packing_fraction{};                       ///< Phi_0
  std::optional<double> overlap{};                                ///< mean, as the column overlap_mean
  std::optional<double> rest{};                                   ///< kinetic over stored energy, below

  friend bool operator==(const Until&, const Until&) = default;
};

/// What leaves the stages of a short form before their end.
struct Exit {
  double stress = 0, overlap = 0;  ///< from this vertical stress [Pa] or mean overlap on; 0: any
  std::string_view key;            ///< that asks for it: "loading.max_stress"
  bool to_last = false;  ///< the last stage follows, while walls come together; else the loading ends
};

/// One part of a loading: what the walls do, and until what. A part that it does not name rests.
struct Stage {
  std::string name{};
  std::vector<Drive> drives{};
  Until until{};
  Settings set{};             ///< what changes where it begins, for it and for what follows
  int repeat = 1;             ///< how often the stages from `repeat_from` to this one are done
  std::string repeat_from{};  ///< name of a stage before; "": this stage alone

  // Of the short forms of a case:
  bool towards = false;       ///< the velocity has the sign that leads to the strain
  bool only_by_exit = false;  ///< it is left out where no exit leads to it
  std::vector<Exit> exits{};
  std::string_view key{};         ///< that asks for the stage
  std::optional<double> limit{};  ///< strain at which walls stop whose stage has no end in strain or time

  bool is_driven(Control control) const;
  /// "stage 'press'", or "stage 3": its name, or its number from 0.
  std::string title(std::size_t number) const;
  /// Is it repeated alone, while its walls only go towards a place, where the first turn leaves them?
  bool repeats_in_vain() const;
};

/// Stages one after the other, with the repeated ones as often as they are asked for. Raises UsageError for a
/// `repeat_from` that is not there, and for more than 100 000 stages.
std::vector<Stage> without_repeats(const std::vector<Stage>& stages);

/// What is wrong with a stage that contradicts itself, or that may never end; "" if nothing.
std::string fault_of(const Stage& stage, int dimension = 2);

/// Raises UsageError for the first stage with a fault.
void check_stages(const std::vector<Stage>& stages, int dimension = 2);

/// What the distance that walls have come together means as a strain.
struct StrainMeasure {
  /// of_grain: eps = -ln(1 - d/R), where d, the approach of a grain's centre to a wall, is half the travel;
  /// of_box: eps = ln(h_start/h).
  enum class Kind { of_grain, of_box };
  Kind kind = Kind::of_box;
  double length = 1;  ///< 2 R, or h_start [m]

  double travel(double strain) const;  ///< [m]
  /// For the distance of the walls at the start and now [m].
  double strain(double start, double now) const;
};

/// How the walls move when it is not the case that says it.
struct WallMotion {
  double duration = 0;  ///< [s]
  /// Of time [s]: rate of the distance of bottom and top [m/s], negative while they come together.
  std::function<double(double)> velocity;
};

/// sin(2 pi t/T), or a triangle that rises from 0 to 1 in T/4, falls to -1 and comes back.
double wave_at(Wave wave, double time, double period);

/// Of dt, in a time [s], at least one.
std::int64_t whole_steps(double time, double dt);

}  // namespace softgrain
