#pragma once
#include <memory>
#include <string>

#include "tools/viewer/viewer.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// The server of a command's page, the same for `view` and `track --view`.
struct PageArguments {
  int port = 8080;     // by convention, an HTTP port that needs no rights
  std::string listen;  // empty: this machine only
  std::string token;   // empty: none on this machine, else a random one
};

/// Adds --port, --listen and --token.
void AddPageOptions(CLI::App& app, PageArguments& arguments);

/// Converts them to options of a viewer.
viewer::ViewerOptions PageOptions(const PageArguments& arguments);

/// The skin of bodies that a page shows and exports, from --surface and --mesh; null if one of them
/// is "none", and for a custom surface without its mesh, for which a line is printed. Throws
/// InputError.
std::shared_ptr<const recon::BodyMesh> LoadSkin(const std::string& surface,
                                                const std::string& mesh);

/// Prints the address of the page to stderr.
void PrintUrls(const viewer::Viewer& viewer);

}  // namespace ossa::commands
