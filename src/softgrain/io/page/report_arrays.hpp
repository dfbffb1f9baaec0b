#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "softgrain/io/page/report_codec.hpp"
#include "softgrain/io/page/report_frame.hpp"

namespace softgrain {

/// One column of all frames, one after another, as the page reads it.
struct EncodedColumn {
  std::string name;
  std::size_t stride = 1;  ///< from a number to the one that it is coded against
  std::size_t frames = 1;  ///< 1 where it never changes
  EncodedArray array;
};

/// The columns of the first frame that all frames have, with a resolution that suits what they say. Contacts
/// may be of any number in each frame.
std::vector<EncodedColumn> encode_columns(const std::vector<ReportFrame>& frames);

}  // namespace softgrain
