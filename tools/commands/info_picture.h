#pragma once
#include <string>

#include "tools/commands/source_options.h"

namespace ossa::commands {

/// Writes the picture of `ossa info FILE --picture`: for a data set or depth images a contact
/// sheet, FILE.png, with twelve frames from the first to the last; for a forest model its card,
/// FILE.html: accuracy by part and joint, and its training data. Throws UsageError for another
/// extension and another kind of file.
void WriteInfoPicture(const SourceArguments& arguments, const std::string& path);

}  // namespace ossa::commands
