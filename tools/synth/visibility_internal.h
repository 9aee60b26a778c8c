#pragma once
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Sets TruthBody::visible: true if at least 4 square centimetres of the joint's own parts are
/// visible near the joint.
void MarkVisibleJoints(LabelledFrame* frame);

}  // namespace ossa::tools
