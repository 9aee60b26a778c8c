#include "forest/kept_tables.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <oneapi/tbb/parallel_for.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/large_pages.h"
#include "depth/base/leftovers.h"
#include "forest/forest_file_internal.h"
#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

namespace fs = std::filesystem;

// Cached tables are stored in two files: a checksummed container with everything except the tables,
// including their sizes and checksums; and the tables, concatenated in memory layout. Only the
// build that wrote them can read them.
constexpr ContainerFormat kTablesFormat{{'o', 's', 's', 'a', 't', 'a', 'b', 's'}, 1, "kept tables"};

// Size and modification time of a file.
std::string Stamp(const fs::path& file) {
  struct stat is {};
  if (stat(file.c_str(), &is) != 0) return {};
  return file.string() + " " + std::to_string(is.st_size) + " " +
         std::to_string(is.st_mtim.tv_sec) + "." + std::to_string(is.st_mtim.tv_nsec) + " " +
         std::to_string(is.st_ino);
}

// The cache path without extension; none if caching is off or no folder is known. A privileged user
// has no folder that is certainly their own: sudo keeps HOME.
std::optional<fs::path> PlaceFor(const fs::path& model_file) {
  const char* chosen = std::getenv("OSSA_CACHE");
  const char* xdg = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (chosen != nullptr) {
    if (*chosen == '\0') return std::nullopt;
    folder = chosen;
  } else if (xdg != nullptr && *xdg == '/') {
    folder = fs::path(xdg) / "ossa";
  } else if (home != nullptr && *home == '/') {
    folder = fs::path(home) / ".cache/ossa";
  } else {
    return std::nullopt;
  }
  Dl_info own{};
  if (dladdr(reinterpret_cast<const void*>(&ReadKeptTables), &own) == 0) return std::nullopt;
  const std::string key = Stamp(model_file) + "\n" + Stamp(own.dli_fname);
  const std::string number = std::to_string(XXH3_64bits(key.data(), key.size()));
  return folder / ("forest-" + number);
}

fs::path HeadOf(const fs::path& place) { return place.string() + ".head"; }
fs::path TablesOf(const fs::path& place) { return place.string() + ".tables"; }

LeafTables& LeavesOf(RuntimeTables& tables, size_t tree) { return tables.leaves[tree]; }
const LeafTables& LeavesOf(const RuntimeTables& tables, size_t tree) {
  return tables.deferred != nullptr ? tables.deferred->whole(tree) : tables.leaves[tree];
}

// Calls `visit` with each table of a model, in a fixed order.
template <typename Data, typename Tables, typename Visit>
void ForEachTable(Data& data, Tables& tables, const Visit& visit) {
  for (size_t t = 0; t < data.trees.size(); ++t) {
    auto& leaves = LeavesOf(tables, t);
    visit(tables.trees[t].lines);
    visit(leaves.evidence);
    visit(leaves.shares);
    visit(leaves.first_shares);
    visit(leaves.shares_of);
    visit(tables.vote_rows[t]);
    visit(data.trees[t].votes);
  }
}

template <typename T>
uint64_t BytesOf(const std::vector<T>& table) {
  return table.size() * sizeof(T);
}

template <typename T>
uint64_t ChecksumOf(const std::vector<T>& table) {
  return XXH3_64bits(table.data(), BytesOf(table));
}

struct TableSize {
  uint64_t count = 0;
  uint64_t checksum = 0;
};

struct Kept {
  ForestData data;
  RuntimeTables tables;
};

std::vector<std::byte> PackHead(const ForestData& data, const RuntimeTables& tables) {
  PayloadWriter writer;
  writer.PutVector(PackForest(data, {}));
  writer.Put<uint64_t>(data.trees.size());
  for (size_t t = 0; t < data.trees.size(); ++t) {
    const LinedTree& lined = tables.trees[t];
    writer.Put(std::array{lined.first_node, lined.offset_step, data.trees[t].vote_depth});
  }
  ForEachTable(data, tables, [&](const auto& table) {
    writer.Put(TableSize{table.size(), ChecksumOf(table)});
  });
  return {writer.bytes().begin(), writer.bytes().end()};
}

template <typename T>
bool Fill(std::vector<T>& table, uint64_t count, int file, uint64_t at) {
  table = MakeLargeVector<T>(count);
  auto* to = reinterpret_cast<char*>(table.data());
  for (uint64_t done = 0, size = BytesOf(table); done < size;) {
    const ssize_t got = pread(file, to + done, size - done, static_cast<off_t>(at + done));
    if (got <= 0) return false;
    done += static_cast<uint64_t>(got);
  }
  return true;
}

// Reads everything except the tables, and their sizes in ForEachTable's order.
std::vector<TableSize> ReadHead(const fs::path& file, Kept* kept) {
  const std::vector<std::byte> bytes = ReadContainer(file, kTablesFormat);
  PayloadReader head(bytes, file.string());
  kept->data = ParseForest(head.GetVector<std::byte>("forest without its tables"), file.string());
  const auto trees = head.Get<uint64_t>("trees");
  constexpr uint64_t kMost = 64;  // of trees; the bound of ForestModel
  if (trees > kMost) head.Fail("trees", "more than 64");
  kept->data.trees.resize(trees);
  kept->tables.trees.resize(trees);
  kept->tables.leaves.resize(trees);
  kept->tables.vote_rows.resize(trees);
  for (size_t t = 0; t < trees; ++t) {
    const auto [first_node, offset_step, vote_depth] = head.Get<std::array<int, 3>>("tree");
    kept->tables.trees[t].first_node = first_node;
    kept->tables.trees[t].offset_step = offset_step;
    kept->data.trees[t].vote_depth = vote_depth;
  }
  std::vector<TableSize> sizes;
  ForEachTable(kept->data, kept->tables,
               [&](const auto&) { sizes.push_back(head.Get<TableSize>("size and checksum")); });
  head.ExpectEnd();
  AddPriorTables(kept->data, &kept->tables);
  return sizes;
}

// Checks the file length first, so that files of another length are not read; reads tables in
// parallel.
bool FillTables(const std::vector<TableSize>& sizes, const fs::path& path, Kept* kept) {
  std::vector<std::function<bool(int)>> steps;
  uint64_t at = 0;
  ForEachTable(kept->data, kept->tables, [&](auto& table) {
    const TableSize size = sizes[steps.size()];
    steps.push_back([&table, size, at](int file) {
      return Fill(table, size.count, file, at) && ChecksumOf(table) == size.checksum;
    });
    at += size.count * sizeof(table[0]);
  });
  std::error_code unknown;
  if (fs::file_size(path, unknown) != at) return false;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  std::atomic<bool> is_whole = true;
  oneapi::tbb::parallel_for(size_t{0}, steps.size(), [&](size_t i) {
    if (!steps[i](file)) is_whole = false;
  });
  close(file);
  return is_whole;
}

// Removes caches of earlier models and builds except the newest: a command and a Python package may
// alternate.
void RemoveOldOnes(const fs::path& folder) {
  constexpr size_t kStaying = 2;  // by hand
  std::vector<std::pair<fs::file_time_type, fs::path>> heads;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("forest-") || !name.ends_with(".head")) continue;
    heads.emplace_back(fs::last_write_time(entry.path(), ignored), entry.path());
  }
  std::sort(heads.rbegin(), heads.rend());
  for (size_t i = kStaying; i < heads.size(); ++i) {
    fs::remove(heads[i].second, ignored);
    fs::remove(heads[i].second.replace_extension(".tables"), ignored);
  }
}

void Write(const fs::path& place, const ForestData& data, const RuntimeTables& of) try {
  fs::create_directories(place.parent_path());
  AtomicFile tables(TablesOf(place));
  ForEachTable(data, of, [&](const auto& table) {
    tables.stream().write(reinterpret_cast<const char*>(table.data()),
                          static_cast<std::streamsize>(BytesOf(table)));
  });
  tables.CommitOneOfMany();  // checksums detect incomplete data after a power loss
  WriteContainer(HeadOf(place), kTablesFormat, PackHead(data, of));
  RemoveOldOnes(place.parent_path());
  RemoveLeftoversOf(TablesOf(place));
} catch (const InputError&) {
} catch (const fs::filesystem_error&) {
}

}  // namespace

bool MayHaveKeptTables(const fs::path& model_file) {
  const auto place = PlaceFor(model_file);
  std::error_code unknown;
  return place && fs::exists(HeadOf(*place), unknown);
}

std::optional<ForestModel> ReadKeptTables(const fs::path& model_file) try {
  const auto place = PlaceFor(model_file);
  if (!place || !MayHaveKeptTables(model_file)) return std::nullopt;
  Kept kept;
  const std::vector<TableSize> sizes = ReadHead(HeadOf(*place), &kept);
  ReturnFreedMemory();  // before the tables are allocated
  if (!FillTables(sizes, TablesOf(*place), &kept)) return std::nullopt;
  return ForestModel(std::make_shared<const ForestData>(std::move(kept.data)),
                     std::make_shared<const RuntimeTables>(std::move(kept.tables)));
} catch (const InputError&) {
  return std::nullopt;
}

void KeepTables(const fs::path& model_file, const ForestModel& model) {
  const auto place = PlaceFor(model_file);
  if (!place) return;
  const RuntimeTables* tables = model.tables_.get();  // outlives the deferred leaves
  const auto write = [place = *place, data = model.data_, tables] { Write(place, *data, *tables); };
  if (tables->deferred == nullptr) return write();
  tables->deferred->OnceWhole(write);
}

}  // namespace ossa::forest
