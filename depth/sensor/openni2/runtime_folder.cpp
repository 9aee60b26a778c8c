#include "depth/sensor/openni2/runtime_folder.h"

#include <dlfcn.h>

#include <cstdlib>

#include "depth/base/error.h"

namespace ossa::depth {

namespace fs = std::filesystem;

fs::path OpenNiRuntimeFolder() {
  if (const char* chosen = std::getenv("OSSA_OPENNI2")) return chosen;
  Dl_info info{};
  // The file that contains this function: our library, or the program if statically linked.
  if (dladdr(reinterpret_cast<const void*>(&OpenNiRuntimeFolder), &info) == 0) {
    throw InputError("OpenNI2: the folder of ossa's own library cannot be found");
  }
  const fs::path here = fs::absolute(info.dli_fname).parent_path();
  for (const fs::path& folder :
       {here / "openni2", here / "../lib/openni2", here / "../" OSSA_LIBRARY_FOLDER "/openni2"}) {
    if (fs::exists(folder / "reader/ossa_oni_reader")) return folder;
  }
  throw InputError((here / "openni2").string() +
                   ": expected ossa's OpenNI2 folder, found none (set OSSA_OPENNI2 to it)");
}

}  // namespace ossa::depth
