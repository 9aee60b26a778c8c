#pragma once
#include <memory>
#include <string>

#include "tools/tracker/model_set.h"
#include "tools/viewer/viewer.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// Where the page of a command is served, the same for `view` and `track --view`.
struct PageArguments {
  int port = 8080;     // by convention, an HTTP port that needs no rights
  std::string listen;  // empty: this machine alone
  std::string token;   // empty: none on this machine, else a random one
};

/// --port, --listen and --token.
void AddPageOptions(CLI::App& app, PageArguments& arguments);

/// What they mean for a viewer.
viewer::ViewerOptions PageOptions(const PageArguments& arguments);

/// The skin of bodies that are fitted with these models: of the shipped surface; of others, whose
/// mesh nobody named, and without one null. Throws InputError.
std::shared_ptr<const recon::BodyMesh> LoadSkin(const tracker::ModelFiles& files);

/// Where browsers find the page, on stderr.
void SayWhere(const viewer::Viewer& viewer);

}  // namespace ossa::commands
