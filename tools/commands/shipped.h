#pragma once
#include <memory>
#include <string>

namespace ossa::recon {
class PostureDatabase;
}

namespace ossa::commands {

/// The database named, or the shipped one when `file` is empty.
std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const std::string& file);

}  // namespace ossa::commands
