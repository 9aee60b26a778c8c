#include <array>

#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/process.h"
#include "tools/commands/study.h"
#include "tools/tracker/version.h"

namespace {

using ossa::commands::Command;

constexpr std::array kCommands = {
    Command{"evaluate", "measure a model on labelled data", ossa::commands::Evaluate},
    Command{"compare", "judge skeletons against the truth", ossa::commands::Compare},
    Command{"experiment", "run a study: a paper's tables beside its own numbers",
            ossa::commands::Experiment},
    Command{"study", "run an experiment as a TOML file describes it", ossa::commands::Study},
    Command{"database", "build a posture database from motion capture", ossa::commands::Database},
    Command{"learn", "learn a sensor's errors from observed and true skeletons",
            ossa::commands::Learn},
    Command{"refine", "learn a stage that refines a forest's joints at the depth image",
            ossa::commands::Refine},
    Command{"prior", "learn from motion capture how people move", ossa::commands::Prior},
    Command{"surface", "make the body that the surface fit poses", ossa::commands::Surface},
    Command{"reconstruct", "make recorded skeletons complete and plausible",
            ossa::commands::Reconstruct},
    Command{"info", "say what a file of ossa's holds", ossa::commands::Info},
    Command{"record", "record a source to an .oni file", ossa::commands::Record},
    Command{"track", "follow people and write their skeletons", ossa::commands::Track},
    Command{"view", "show a source or a skeleton file in a browser", ossa::commands::View},
    Command{"train", "train a body-part forest on labelled data", ossa::commands::Train},
    Command{"render", "make labelled depth images of people in motion", ossa::commands::Render},
};

}  // namespace

int main(int argc, char** argv) {
  ossa::commands::PrepareProcess();
  const int status = ossa::commands::RunOneOf(kCommands, ossa::tracker::Version(), argc, argv);
  return ossa::commands::EndOutput(status);
}
