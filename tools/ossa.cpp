#include <array>

#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/process.h"
#include "tools/tracker/tracker.h"

namespace {

using ossa::commands::Command;
using ossa::commands::RunTools;

constexpr std::array kCommands = {
    Command{"track", "follow people and write their skeletons", ossa::commands::Track},
    Command{"view", "show a source or a skeleton file in a browser", ossa::commands::View},
    Command{"record", "record a source to an .oni file", ossa::commands::Record},
    Command{"reconstruct", "make recorded skeletons complete and plausible",
            ossa::commands::Reconstruct},
    Command{"fuse", "fuse the skeletons of several cameras", ossa::commands::Fuse},
    Command{"compare", "compare skeletons with the truth", ossa::commands::Compare},
    Command{"info", "show what a file contains", ossa::commands::Info},
    Command{"doctor", "check what keeps cameras from working", ossa::commands::Doctor},
    Command{"render", "make labelled depth images of people in motion", RunTools},
    Command{"train", "train a body-part forest on labelled data", RunTools},
    Command{"evaluate", "measure a model on labelled data", RunTools},
    Command{"refine", "train a stage of the refinement cascade", RunTools},
    Command{"crop", "cut people out of data sets for the training of a pose network", RunTools},
    Command{"pack-network", "make the file of a pose network from its weights", RunTools},
    Command{"learn", "learn a sensor's errors from observed and true skeletons", RunTools},
    Command{"prior", "learn a pose prior from motion capture", RunTools},
    Command{"surface", "make the body model of the surface fit", RunTools},
    Command{"database", "build a posture database from motion capture", RunTools},
    Command{"experiment", "run a study: a paper's tables beside its own numbers", RunTools},
    Command{"study", "run an experiment as a TOML file describes it", RunTools},
};

}  // namespace

int main(int argc, char** argv) {
  ossa::commands::PrepareProcess();
  const int status = ossa::commands::RunCommandOf(kCommands, ossa::tracker::Version(), argc, argv);
  return ossa::commands::EndOutput(status);
}
