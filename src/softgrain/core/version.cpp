#include "softgrain/core/version.hpp"

#include "version_config.hpp"

namespace softgrain {

BuildInfo build_info() {
#if defined(__clang__)
  const char* compiler = "clang " __clang_version__;
#else
  const char* compiler = "g++ " __VERSION__;
#endif
  return {SOFTGRAIN_VERSION,     SOFTGRAIN_COMMIT,        compiler,
          SOFTGRAIN_BUILD_FLAGS, SOFTGRAIN_PYTHON_SOURCE, SOFTGRAIN_PYTHON_INSTALLED};
}

}  // namespace softgrain
