#include "recon/methods/method_table.h"

#include <algorithm>

#include "depth/base/error.h"

namespace ossa::recon {
namespace {

#define OSSA_METHOD(file, maker, ...) MethodInfo{__VA_ARGS__},
constexpr MethodInfo kMethods[] = {
#include "recon/methods/methods.inc"
};
#undef OSSA_METHOD

}  // namespace

std::span<const MethodInfo> MethodTable() { return kMethods; }

const std::vector<std::string>& ReconstructionMethods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const MethodInfo& method : kMethods) list.emplace_back(method.name);
    return list;
  }();
  return names;
}

const MethodInfo* FindMethod(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kMethods), std::end(kMethods),
                                         [&](const MethodInfo& m) { return m.name == name; });
  return found == std::end(kMethods) ? nullptr : found;
}

const MethodInfo& RequireMethod(std::string_view name) {
  if (const MethodInfo* method = FindMethod(name)) return *method;
  std::string known;
  for (const MethodInfo& method : kMethods) {
    known.append(known.empty() ? "" : ", ").append(method.name);
  }
  throw InputError("reconstruction: unknown method '" + std::string(name) + "', expected one of " +
                   known);
}

}  // namespace ossa::recon
