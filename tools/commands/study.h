#pragma once

namespace ossa::commands {

/// `ossa study`: an experiment as a TOML file describes it. Stands in experiment.cpp.
int Study(int argc, char** argv);

}  // namespace ossa::commands
