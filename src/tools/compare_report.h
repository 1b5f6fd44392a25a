#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "update_comparison.h"

namespace fiimap {

/// Quantiles of every method, whole and by change score; keys as documented in docs/evaluation.md.
nlohmann::json summaryOf(const UpdateComparison& comparison);
/// The same for people.
std::string toText(const UpdateComparison& comparison);
/// A row for each update: number, stamp, change score and the time of every method.
std::string toCsv(const UpdateComparison& comparison);

}  // namespace fiimap
