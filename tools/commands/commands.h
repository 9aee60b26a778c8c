#pragma once

namespace ossa::commands {

// One function per subcommand, each in a file of this folder with the same name.
int Evaluate(int argc, char** argv);
int Compare(int argc, char** argv);
int Fuse(int argc, char** argv);
int Experiment(int argc, char** argv);
int Study(int argc, char** argv);
int Database(int argc, char** argv);
int Learn(int argc, char** argv);
int Refine(int argc, char** argv);
int Crop(int argc, char** argv);
int PackNetwork(int argc, char** argv);
int Prior(int argc, char** argv);
int Surface(int argc, char** argv);
int Reconstruct(int argc, char** argv);
int Info(int argc, char** argv);
int Doctor(int argc, char** argv);
int Record(int argc, char** argv);
int Track(int argc, char** argv);
int View(int argc, char** argv);
int Train(int argc, char** argv);
int Render(int argc, char** argv);

/// The commands of the package ossa-tools: replaces this process by the program ossa-tools beside
/// it. Throws InputError that names the package if it is not installed.
int RunTools(int argc, char** argv);

}  // namespace ossa::commands
