#include "softgrain/io/case/words.hpp"

#include <array>
#include <vector>

#include "softgrain/material/any_law.hpp"

namespace softgrain {

template <>
std::span<const Word<LoadingPath>> words_of() {
  static constexpr std::array words{Word{LoadingPath::diametral, "diametral"},
                                    Word{LoadingPath::compaction, "compaction"},
                                    Word{LoadingPath::isotropic, "isotropic"},
                                    Word{LoadingPath::biaxial, "biaxial"},
                                    Word{LoadingPath::triaxial, "triaxial"},
                                    Word{LoadingPath::shear, "shear"},
                                    Word{LoadingPath::die, "die"},
                                    Word{LoadingPath::relaxation, "relaxation"},
                                    Word{LoadingPath::stages, "stages"}};
  return words;
}

template <>
std::span<const Word<GrainModel>> words_of() {
  static constexpr std::array words{Word{GrainModel::bpm, "bpm"}, Word{GrainModel::mpm, "mpm"},
                                    Word{GrainModel::rigid, "rigid"}};
  return words;
}

template <>
std::span<const Word<ShapeOfGrain>> words_of() {
  static constexpr std::array words{Word{ShapeOfGrain::disk, "disk"}, Word{ShapeOfGrain::ellipse, "ellipse"},
                                    Word{ShapeOfGrain::polygon, "polygon"},
                                    Word{ShapeOfGrain::outline, "outline"},
                                    Word{ShapeOfGrain::surface, "surface"}};
  return words;
}

template <>
std::span<const Word<EqualPrimaries>> words_of() {
  static constexpr std::array words{Word{EqualPrimaries::count, "count"}, Word{EqualPrimaries::size, "size"}};
  return words;
}

template <>
std::span<const Word<MaterialLaw>> words_of() {
  static const std::vector<Word<MaterialLaw>> words = [] {
    std::vector<Word<MaterialLaw>> names;
    for (const LawChoice& choice : law_choices()) names.push_back({choice.law, choice.name});
    return names;
  }();
  return words;
}

template <>
std::span<const Word<Integrator>> words_of() {
  static constexpr std::array words{Word{Integrator::backward_euler, "implicit"},
                                    Word{Integrator::symplectic_euler, "explicit"}};
  return words;
}

template <>
std::span<const Word<Formulation>> words_of() {
  static constexpr std::array words{Word{Formulation::total_lagrangian, "total_lagrangian"},
                                    Word{Formulation::updated_lagrangian, "updated_lagrangian"}};
  return words;
}

template <>
std::span<const Word<ShapeFunction>> words_of() {
  static constexpr std::array words{Word{ShapeFunction::bilinear, "bilinear"},
                                    Word{ShapeFunction::gimp, "gimp"},
                                    Word{ShapeFunction::bspline, "bspline"}};
  return words;
}

template <>
std::span<const Word<ContactOn>> words_of() {
  static constexpr std::array words{Word{ContactOn::outline, "outline"},
                                    Word{ContactOn::grid_nodes, "grid_nodes"}};
  return words;
}

template <>
std::span<const Word<Activation>> words_of() {
  static constexpr std::array words{Word{Activation::anticipated, "anticipated"},
                                    Word{Activation::closed_at_mid_step, "closed_at_mid_step"},
                                    Word{Activation::closed_at_end_of_step, "closed_at_end_of_step"}};
  return words;
}

template <>
std::span<const Word<Places>> words_of() {
  static constexpr std::array words{Word{Places::random, "random"}, Word{Places::pour, "pour"}};
  return words;
}

template <>
std::span<const Word<SizeLaw>> words_of() {
  static constexpr std::array words{Word{SizeLaw::uniform, "uniform"}, Word{SizeLaw::lognormal, "lognormal"},
                                    Word{SizeLaw::list, "list"}};
  return words;
}

template <>
std::span<const Word<Precision>> words_of() {
  static constexpr std::array words{Word{Precision::single, "single"}, Word{Precision::full, "double"}};
  return words;
}

template <>
std::span<const Word<Wave>> words_of() {
  static constexpr std::array words{Word{Wave::sine, "sine"}, Word{Wave::triangle, "triangle"}};
  return words;
}

template <>
std::span<const Word<BoxEnd>> words_of() {
  static constexpr std::array words{Word{BoxEnd::walls, "walls"}, Word{BoxEnd::periodic, "periodic"}};
  return words;
}

}  // namespace softgrain
