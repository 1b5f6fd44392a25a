#include "fiimap/parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace fiimap {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& value,
                         const std::string& allowed) {
  throw std::invalid_argument("parameter " + name + " = '" + value + "': must be " + allowed);
}

bool parseNumber(const std::string& text, double* value) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  stream >> *value;
  return !stream.fail() && stream.eof() && std::isfinite(*value);
}

std::string describeRange(const std::string& kind, double min, double max,
                          const std::string& unit) {
  return kind + " in [" + toText(min) + ", " + toText(max) + "]" + (unit.empty() ? "" : " " + unit);
}

}  // namespace

std::string toText(double value) {
  for (int digits = std::numeric_limits<double>::digits10;; ++digits) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(digits);
    text << value;
    double read = 0.0;
    if (digits >= std::numeric_limits<double>::max_digits10 ||
        (parseNumber(text.str(), &read) && read == value)) {
      return text.str();
    }
  }
}

Parameter numberParameter(const std::string& name, double* field, double min, double max,
                          const std::string& unit, const std::string& meaning) {
  const std::string allowed = describeRange("a number", min, max, unit);
  return {name,
          unit,
          allowed,
          meaning,
          [field] { return toText(*field); },
          [=](const std::string& text) {
            double value = 0.0;
            if (!parseNumber(text, &value) || value < min || value > max) {
              refuse(name, text, allowed);
            }
            *field = value;
          },
          ValueKind::kNumber,
          min,
          max};
}

Parameter integerParameter(const std::string& name, int* field, int min, int max,
                           const std::string& unit, const std::string& meaning) {
  const std::string allowed = describeRange("a whole number", min, max, unit);
  return {name,
          unit,
          allowed,
          meaning,
          [field] { return std::to_string(*field); },
          [=](const std::string& text) {
            double value = 0.0;
            if (!parseNumber(text, &value) || value != std::floor(value) || value < min ||
                value > max) {
              refuse(name, text, allowed);
            }
            *field = static_cast<int>(value);
          },
          ValueKind::kInteger,
          static_cast<double>(min),
          static_cast<double>(max)};
}

Parameter flagParameter(const std::string& name, bool* field, const std::string& meaning) {
  const std::string allowed = "true or false";
  return {name,
          "",
          allowed,
          meaning,
          [field] { return std::string(*field ? "true" : "false"); },
          [=](const std::string& text) {
            if (text == "true" || text == "1") {
              *field = true;
            } else if (text == "false" || text == "0") {
              *field = false;
            } else {
              refuse(name, text, allowed);
            }
          },
          ValueKind::kFlag};
}

Parameter textParameter(const std::string& name, std::string* field, const std::string& meaning) {
  return {name,
          "",
          "text",
          meaning,
          [field] { return *field; },
          [field](const std::string& text) { *field = text; }};
}

Parameter tunable(Parameter parameter) {
  parameter.tunable = true;
  return parameter;
}

std::vector<Parameter> tunable(std::vector<Parameter> parameters) {
  for (Parameter& parameter : parameters) parameter.tunable = true;
  return parameters;
}

void requireLess(const std::string& low_name, double low, const std::string& high_name,
                 double high) {
  if (low < high) return;
  throw std::invalid_argument("parameter " + low_name + " = " + std::to_string(low) +
                              ": must be less than " + high_name + " = " + std::to_string(high));
}

std::vector<std::string> applyParameters(const ParameterMap& values,
                                         const std::vector<Parameter>& parameters) {
  std::vector<std::string> unknown;
  for (const auto& [name, value] : values) {
    const auto parameter =
        std::find_if(parameters.begin(), parameters.end(),
                     [&name = name](const Parameter& p) { return p.name == name; });
    if (parameter == parameters.end()) {
      unknown.push_back(name);
    } else {
      parameter->set(value);
    }
  }
  return unknown;
}

namespace internal {

std::string joinChoices(const std::vector<std::string>& names) {
  std::string joined;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) joined += i + 1 < names.size() ? ", " : " or ";
    joined += names[i];
  }
  return joined;
}

std::size_t indexOfChoice(const std::string& name, const std::string& value,
                          const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) refuse(name, value, joinChoices(names));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace internal
}  // namespace fiimap
