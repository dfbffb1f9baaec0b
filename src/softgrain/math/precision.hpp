#pragma once

namespace softgrain {

enum class Precision { full, single };  ///< double, float

}  // namespace softgrain
