#pragma once
#include <string>

#include "forest/training/train.h"
#include "tools/commands/train_options.h"
#include "tools/learning/person_source.h"

namespace ossa::commands {

/// The command as a card tells it: without what leaves the model as it is (threads, memory, whether
/// it was resumed, where it is written), and of files only their names: a card travels. The same
/// text however the same options are written.
std::string DescribeCommand(int argc, char** argv);

/// The card of a forest trained on `source`, JSON text.
std::string MakeCard(const TrainArguments& a, const tools::PersonSource& source,
                     const forest::TrainSummary& summary);

/// The card of a model whose joints were learned again on `source`, made of the one before, which
/// it still has; that one where it is no JSON object.
std::string RenewCard(const forest::ForestModel& learned, const TrainArguments& a,
                      const tools::PersonSource& source);

}  // namespace ossa::commands
