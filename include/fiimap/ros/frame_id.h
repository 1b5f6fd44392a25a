#pragma once

#include <string>

namespace fiimap {

/// Frame ids of old publishers begin with '/', which tf2 refuses.
inline std::string plainFrame(const std::string& frame_id) {
  return !frame_id.empty() && frame_id.front() == '/' ? frame_id.substr(1) : frame_id;
}

}  // namespace fiimap
