#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fiimap/mapper_config.h"

namespace fiimap {

/// Parameter values as text by name, from wherever they come: ROS, YAML or a command line.
using ParameterMap = std::map<std::string, std::string>;

/// What a parameter's value is.
enum class ValueKind { kNumber, kInteger, kFlag, kText };

/// One setting of a configuration: its description and typed access to its field through text.
struct Parameter {
  std::string name;                  ///< as users write it
  std::string unit;                  ///< "m", "voxels", ... or "" where there is none
  std::string allowed;               ///< human-readable range or list of values
  std::string meaning;               ///< one sentence without full stop
  std::function<std::string()> get;  ///< the field's value now
  /// Parses and range-checks; throws std::invalid_argument naming parameter, value and range.
  std::function<void(const std::string&)> set;

  ValueKind kind = ValueKind::kText;      ///< of the field
  double min = 0.0;                       ///< of numbers, allowed
  double max = 0.0;                       ///< of numbers, allowed
  std::vector<std::string> choices = {};  ///< where only these are allowed
  bool tunable = false;                   ///< may change while the map is in use
};

/// The shortest text that reads back as the same number.
std::string toText(double value);

///@{
/// Builders of Parameters bound to a field, which must outlive them.
Parameter numberParameter(const std::string& name, double* field, double min, double max,
                          const std::string& unit, const std::string& meaning);
Parameter integerParameter(const std::string& name, int* field, int min, int max,
                           const std::string& unit, const std::string& meaning);
Parameter flagParameter(const std::string& name, bool* field, const std::string& meaning);
Parameter textParameter(const std::string& name, std::string* field, const std::string& meaning);
///@}

/// The same of an enumeration.
/// \param names the text of each enumerator, in the order of their values 0, 1, 2, ...
template <typename Enum>
Parameter choiceParameter(const std::string& name, Enum* field,
                          const std::vector<std::string>& names, const std::string& meaning);

///@{
/// Marks what may change while the map is in use.
Parameter tunable(Parameter parameter);
std::vector<Parameter> tunable(std::vector<Parameter> parameters);
///@}

/// All parameters of a MapperConfig, bound to `config`, in the order of config/default.yaml.
std::vector<Parameter> mapperParameters(MapperConfig* config);

/// Those of them that a sensor may have of its own.
/// \param prefix of their names.
std::vector<Parameter> readingParameters(ReadingConfig* config, const std::string& prefix = "");

/// Sets every parameter that `values` holds.
/// \return the names in `values` that no parameter has, so that the caller can warn or refuse.
/// \throws std::invalid_argument on a value of the wrong type or out of range.
std::vector<std::string> applyParameters(const ParameterMap& values,
                                         const std::vector<Parameter>& parameters);

/// Refuses values of two parameters that contradict each other.
/// \throws std::invalid_argument that names both, unless low < high.
void requireLess(const std::string& low_name, double low, const std::string& high_name,
                 double high);

// Implementation of the template.
namespace internal {
std::size_t indexOfChoice(const std::string& name, const std::string& value,
                          const std::vector<std::string>& names);
std::string joinChoices(const std::vector<std::string>& names);
}  // namespace internal

template <typename Enum>
Parameter choiceParameter(const std::string& name, Enum* field,
                          const std::vector<std::string>& names, const std::string& meaning) {
  return {name,
          "",
          internal::joinChoices(names),
          meaning,
          [field, names] { return names[static_cast<std::size_t>(*field)]; },
          [name, field, names](const std::string& value) {
            *field = static_cast<Enum>(internal::indexOfChoice(name, value, names));
          },
          ValueKind::kText,
          0.0,
          0.0,
          names};
}

}  // namespace fiimap
