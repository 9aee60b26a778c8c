#pragma once
#include <string>
#include <vector>

namespace ossa::commands {

/// Throws UsageError when two outputs are one file, of which the first would be lost, or an output
/// is one of the inputs, or of the files that an input folder is made of: a recording would be
/// replaced by what was made of it. Outputs may be folders. Empty names are
/// options that were not given; `#truth` and the like after an input's name are no part of it.
void CheckOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// Which name a file of one format may have, the same for every option: where its kind is told by
// the content (models, databases and what else is learned) or by the option (--json) any, but for
// one that ends as another kind of file; where programs tell it by the name (.oni, .png, .html) one
// that ends so. Of an option that was not given the name is empty.

/// Throws UsageError for a name that does not end so.
void CheckExtension(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name that ends as another kind of file that ossa writes.
void CheckNotOtherKind(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name whose extension is of no skeleton format that is written.
void CheckSkeletonName(const std::string& path);

}  // namespace ossa::commands
