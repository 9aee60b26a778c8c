#pragma once
#include <memory>
#include <string>

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

/// The skin of bodies that a page shows and exports, as --surface and --mesh name it; null where
/// one of them is "none", and of a surface of one's own without its mesh, which is said. Throws
/// InputError.
std::shared_ptr<const recon::BodyMesh> LoadSkin(const std::string& surface,
                                                const std::string& mesh);

/// Where browsers find the page, on stderr.
void SayWhere(const viewer::Viewer& viewer);

}  // namespace ossa::commands
