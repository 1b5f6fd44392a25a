#pragma once

#include <stdexcept>
#include <string>

#include "fiimap/parameters.h"

namespace fiimap {

/// The message of the refusal; empty when the value is accepted.
inline std::string refusal(const Parameter& parameter, const std::string& text) {
  try {
    parameter.set(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace fiimap
