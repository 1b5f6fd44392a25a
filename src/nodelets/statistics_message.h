#pragma once

#include <string>

#include <fiimap/Statistics.h>

#include "mapping_thread.h"

namespace fiimap {

Statistics toStatistics(const MapUpdate& update, const std::string& map_frame);

}  // namespace fiimap
