#pragma once
#include "depth/file/sealed_file.h"
#include "forest/forest.h"

namespace ossa::forest {

/// One tree as model files of version 3 hold it: columns of bytes, made to compress well.
void PutTree(PayloadWriter* writer, const Tree& tree);
Tree GetTree(PayloadReader* reader);
/// As files of versions 1 and 2 hold it.
Tree GetTreeOfVersion2(PayloadReader* reader);

}  // namespace ossa::forest
