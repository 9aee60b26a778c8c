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

/// Training images and those held out for proposals.
struct TrainData {
  tools::PersonSource training;
  tools::PersonSource held_out;
};

/// True where the card is of a forest that this very command made of this very data.
bool WasMadeBy(const std::string& card, const TrainArguments& a, const TrainData& data);

/// The card of a forest trained on the data, JSON text.
std::string MakeCard(const TrainArguments& a, const TrainData& data,
                     const forest::TrainSummary& summary);

/// The card of a model whose joints were learned again on `source`, made of the one before, which
/// it still has; that one where it is no JSON object.
std::string RenewCard(const forest::ForestModel& learned, const TrainArguments& a,
                      const tools::PersonSource& source);

}  // namespace ossa::commands
