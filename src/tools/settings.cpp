#include "settings.h"

#include <stdexcept>

namespace fiimap {

ParameterMap parseSettings(const std::vector<std::string>& settings) {
  ParameterMap values;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw std::invalid_argument("--set " + setting + ": must be name=value");
    }
    values[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return values;
}

}  // namespace fiimap
