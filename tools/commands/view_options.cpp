#include "tools/commands/view_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/commands/process.h"
#include "tools/tracker/body_mesh_file.h"

namespace ossa::commands {

void AddPageOptions(CLI::App& app, PageArguments& arguments) {
  app.add_option("--port", arguments.port, "port of the page (default 8080, 0: any free one)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--listen", arguments.listen,
                 "IP address on which the page is served to other machines, 0.0.0.0: all (default: "
                 "this machine only)");
  app.add_option(
         "--token", arguments.token,
         "access token of the page, letters and digits (default: with --listen a random one)")
      ->check([](const std::string& text) {
        const bool plain = !text.empty() && text.find_first_not_of(
                                                "0123456789"
                                                "abcdefghijklmnopqrstuvwxyz"
                                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
        return plain ? std::string() : "expected letters and digits, found '" + text + "'";
      });
}

viewer::ViewerOptions PageOptions(const PageArguments& arguments) {
  viewer::ViewerOptions options;
  options.port = arguments.port;
  options.token = arguments.token;
  if (arguments.listen.empty()) return options;
  options.address = arguments.listen;
  if (options.token.empty()) options.token = viewer::RandomToken();
  return options;
}

std::shared_ptr<const recon::BodyMesh> LoadSkin(const std::string& surface,
                                                const std::string& mesh) {
  if (surface == "none" || mesh == "none") return nullptr;
  if (surface.empty() || !mesh.empty()) return tracker::LoadBodyMesh(surface, mesh);
  PrintError(fmt::format(
      "ossa: --surface {}: the page shows no skin of it: --mesh FILE.ossamesh names one\n",
      surface));
  return nullptr;
}

void PrintUrls(const viewer::Viewer& viewer) {
  for (const std::string& url : viewer.urls()) PrintError(fmt::format("watch at {}\n", url));
}

}  // namespace ossa::commands
