#include "depth/sensor/readers/ros/sqlite_bag.h"

#include <sqlite3.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/readers/ros/packed_bytes.h"

namespace ossa::depth {
namespace {

struct Close {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Database = std::unique_ptr<sqlite3, Close>;

Database Open(const std::string& path) {
  sqlite3* opened = nullptr;
  const int result = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
  Database database(opened);
  if (result != SQLITE_OK) {
    throw InputError(std::string("cannot be opened: ") + sqlite3_errmsg(opened));
  }
  return database;
}

// A query, row by row.
class Query {
 public:
  Query(sqlite3* database, const char* text) : database_(database) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database, text, -1, &statement, nullptr) != SQLITE_OK) Fail();
    statement_.reset(statement);
  }
  void Bind(const std::string& text) {
    sqlite3_bind_text(statement_.get(), 1, text.data(), static_cast<int>(text.size()),
                      SQLITE_TRANSIENT);
  }
  bool Next() {
    const int result = sqlite3_step(statement_.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) Fail();
    return result == SQLITE_ROW;
  }
  std::string Text(int column) const {
    const auto bytes = Bytes(column);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  int64_t Integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  /// Until the next row.
  std::span<const uint8_t> Bytes(int column) const {
    const void* bytes = sqlite3_column_blob(statement_.get(), column);  // first: it may convert
    const int size = sqlite3_column_bytes(statement_.get(), column);
    return {static_cast<const uint8_t*>(bytes), bytes == nullptr ? 0 : static_cast<size_t>(size)};
  }

 private:
  [[noreturn]] void Fail() const {
    const char* advice = sqlite3_errcode(database_) == SQLITE_CORRUPT
                             ? ": \"sqlite3 FILE .recover | sqlite3 NEW.db3\" saves what is there"
                             : "";
    throw InputError("expected a ROS 2 bag, an SQLite database of topics and messages, found: " +
                     std::string(sqlite3_errmsg(database_)) + advice);
  }

  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, Close> statement_;
};

// SQLite reads a file that was cut short without a word, up to what is missing. Its format
// (sqlite.org/fileformat, 1.3) states the number of pages.
std::string DescribeCut(const std::string& path) {
  constexpr size_t kPageSize = 16, kPages = 28, kHeader = 100;  // bytes, the format's
  std::array<uint8_t, kHeader> header{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(header.data()), kHeader)) return {};
  const auto number = [&header](size_t at, size_t size) {
    uint64_t value = 0;
    for (size_t i = at; i < at + size; ++i) value = 256 * value + header[i];
    return value;
  };
  constexpr uint64_t kLargestPage = 65536;  // bytes; the format states 1 for it
  const uint64_t page_size = number(kPageSize, 2) == 1 ? kLargestPage : number(kPageSize, 2);
  const uint64_t expected = page_size * number(kPages, 4);
  const uint64_t size = std::filesystem::file_size(path);
  if (size >= expected) return {};
  return "it is cut short: expected " + std::to_string(expected) + " bytes, found " +
         std::to_string(size) + "; what is there was read";
}

class SqliteBag final : public BagFile {
 public:
  explicit SqliteBag(const std::string& path) : database_(Open(path)), damage_(DescribeCut(path)) {}

  std::vector<BagTopic> ListTopics() override {
    Query query(database_.get(),
                "SELECT name, type FROM topics WHERE serialization_format = 'cdr' ORDER BY name");
    std::vector<BagTopic> topics;
    while (query.Next())
      topics.push_back({query.Text(0), Ros1TypeOf(query.Text(1)), RosWire::kCdr});
    return topics;
  }

  int64_t CountMessages(const std::string& topic) override {
    Query query(database_.get(),
                "SELECT count(*) FROM messages WHERE topic_id IN "
                "(SELECT id FROM topics WHERE name = ?)");
    query.Bind(topic);
    return query.Next() ? query.Integer(0) : 0;
  }

  void Read(const std::string& topic, const Take& take) override {
    Query query(database_.get(),
                "SELECT timestamp, data FROM messages WHERE topic_id IN "
                "(SELECT id FROM topics WHERE name = ?) ORDER BY id");
    query.Bind(topic);
    while (query.Next()) {
      const double time_s = kSecondsPerNanosecond * static_cast<double>(query.Integer(0));
      const auto bytes = query.Bytes(1);
      const bool goes_on =
          IsZstd(bytes) ? take({time_s, UnpackZstd(bytes)}) : take({time_s, bytes});
      if (!goes_on) return;
    }
  }

  std::string damage() const override { return damage_; }

 private:
  Database database_;
  std::string damage_;
};

}  // namespace

std::unique_ptr<BagFile> OpenSqliteBag(const std::string& path) {
  return std::make_unique<SqliteBag>(path);
}

}  // namespace ossa::depth
