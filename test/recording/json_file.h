#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace fiimap {

inline nlohmann::json readJson(const std::string& file) {
  nlohmann::json json;
  std::ifstream(file) >> json;
  return json;
}

}  // namespace fiimap
