#pragma once

#include <functional>
#include <ostream>
#include <string>

namespace fiimap {

/// Writes a file; when this returns, all of it is on the disk and not only in a buffer.
/// \throws std::runtime_error with the system's reason; the file is then incomplete.
void writeCompleteFile(const std::string& file, const std::function<void(std::ostream&)>& write);

}  // namespace fiimap
