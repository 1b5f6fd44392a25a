#pragma once

namespace fiimap {

/// `fiimap_eval report`: becomes the program `report` beside fiimap_eval, which runs the other
/// commands and puts what they say on a page. \param arguments those after `report`.
/// \return never, when the program starts.
/// \throws std::runtime_error when it does not.
int makeReport(int argument_count, char** arguments);

}  // namespace fiimap
