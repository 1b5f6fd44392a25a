#pragma once

#include <string>

namespace fiimap {

/// Finds out, before work that takes long, whether a file can be written.
/// \throws std::runtime_error that names it, when it cannot.
void checkWritable(const std::string& file);

/// Writes a file that appears under its name when it is complete.
/// \throws std::runtime_error that names it, with nothing left behind.
void writeWhole(const std::string& file, const std::string& text);

}  // namespace fiimap
