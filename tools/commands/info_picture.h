#pragma once
#include <string>

#include "tools/commands/source_options.h"

namespace ossa::commands {

/// `ossa info FILE --picture`: of a data set or of depth images a contact sheet, FILE.png, twelve
/// frames from the first to the last; of a forest model its card, FILE.html: accuracy by part and
/// joint, and what it was learned from. Throws UsageError where the name does not end so or the
/// file is of another kind.
void WriteInfoPicture(const SourceArguments& arguments, const std::string& path);

}  // namespace ossa::commands
