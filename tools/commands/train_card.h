#pragma once
#include <string>

#include "forest/training/train.h"
#include "tools/commands/train_options.h"
#include "tools/learning/person_source.h"

namespace ossa::commands {

/// The command as stored in a card: without options that do not change the model (threads, memory,
/// --resume, output), and with file names instead of paths. Independent of the spelling of the
/// options.
std::string DescribeCommand(int argc, char** argv);

/// Numbers of training images and of those held out for proposals.
struct TrainData {
  tools::PersonSource training;
  tools::PersonSource held_out;
};

/// Whether the card is of a forest made by this command from this data.
bool HasSameInputs(const std::string& card, const TrainArguments& a, const TrainData& data);

/// The card of a forest trained on the data, JSON text.
std::string MakeCard(const TrainArguments& a, const TrainData& data,
                     const forest::TrainSummary& summary);

/// The card of a model whose joints were learned again on `source`: the earlier card, extended;
/// unchanged if it is not a JSON object.
std::string UpdateCard(const forest::ForestModel& learned, const TrainArguments& a,
                       const tools::PersonSource& source);

}  // namespace ossa::commands
