#pragma once
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Sets TruthBody::visible: at least a few square centimetres of the joint's own parts are seen
/// within reach of the joint.
void MarkVisibleJoints(LabelledFrame* frame);

}  // namespace ossa::tools
