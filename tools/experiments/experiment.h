#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::tools {

/// One table of a study, with the paper's own numbers if there are any.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many cells a row as columns
  std::string note;                            // what differs from the paper's data or setting
};

/// Markdown, with columns aligned for terminals.
std::string ToMarkdown(const Table& table);

/// Parameters of a study from a TOML file of flat `key = value` lines. Reading a parameter declares
/// its key and default. A study reads all of them before it computes anything
/// (Experiment::read_parameters), so that wrong keys and values are reported at once. Wrong values
/// throw InputError with their line.
class Parameters {
 public:
  // A bound, so that products of counts fit 64 bits
  static constexpr int kMostInteger = 1'000'000'000;
  // Default bounds of numbers.
  static constexpr double kMostNumber = std::numeric_limits<double>::max();
  static constexpr double kLeastNumber = -kMostNumber;

  Parameters() = default;
  /// Throws InputError with file, line and column if the text is not flat TOML.
  static Parameters FromToml(const std::filesystem::path& path);

  double Number(const std::string& key, double usual, double least = kLeastNumber,
                double most = kMostNumber);
  /// Throws InputError for values below `least` or above `most`.
  int Integer(const std::string& key, int usual, int least = 0, int most = kMostInteger);
  bool Flag(const std::string& key, bool usual);
  std::string Text(const std::string& key, const std::string& usual);
  std::vector<std::string> Texts(const std::string& key, const std::vector<std::string>& usual);
  std::string OneOf(const std::string& key, const std::vector<std::string>& known,
                    const std::string& usual);
  /// A source of recon::LoadMocap(): `authored`, `authored-floor`, or an existing file or folder;
  /// Motions() needs at least one.
  std::string Motion(const std::string& key, const std::string& usual);
  std::vector<std::string> Motions(const std::string& key);  // authored by default
  /// A subset of `known`, all by default. Throws InputError for other values.
  std::set<std::string> Some(const std::string& key, const std::vector<std::string>& known);
  /// The same, `usual` by default, in the order of the file.
  std::vector<std::string> Some(const std::string& key, const std::vector<std::string>& known,
                                const std::vector<std::string>& usual);
  std::vector<double> Numbers(const std::string& key, const std::vector<double>& usual,
                              double least = kLeastNumber, double most = kMostNumber);
  /// A list of at least one whole number.
  std::vector<int> Integers(const std::string& key, const std::vector<int>& usual, int least,
                            int most = kMostInteger);

  /// All parameters with the values used, as TOML; written beside the results so that the study can
  /// be repeated.
  std::string Used() const;
  /// Throws InputError if the file has a key that was never read. After this call, reading a new
  /// key throws std::logic_error.
  void RequireAllUsed();

 private:
  struct Value {
    std::vector<double> numbers;
    std::vector<std::string> texts;
    bool list = false;
    bool flag = false;  // true or false, as the number 1 or 0
    int line = 0;
  };
  const Value* Find(const std::string& key, bool numbers, bool list);
  void RequireMotion(const std::string& key, const std::string& source) const;
  [[noreturn]] void FailAt(const std::string& key, const std::string& expected) const;

  std::string source_;
  bool all_asked_ = false;
  std::map<std::string, Value> values_;
  std::map<std::string, std::string> used_;
};

/// Input and services of an experiment.
struct ExperimentContext {
  std::filesystem::path out;     // a folder that exists; figures and extra files go here
  std::filesystem::path shared;  // the folder of real recordings; "" when the user gave none
  std::filesystem::path model;   // --model, --database: "" = the shipped ones
  std::filesystem::path database;
  Parameters parameters;
  uint64_t seed = 1;
  int threads = 1;
  bool full = false;  // the study's long form; the short one takes a minute or two
  std::function<void(double done, double total, const std::string& note)> progress;
  std::function<bool()> interrupted;  // true: stop soon, by ThrowIfInterrupted()
  // Called with one line for each model file that does not fit the others, whenever they are
  // loaded, from any thread; may be empty.
  std::function<void(const std::string& line)> warn;

  /// Throws Interruption after Ctrl-C. Studies call it about once a second.
  void ThrowIfInterrupted() const;

  /// The result of an expensive step, cached under out/cache by `key`, so that an interrupted study
  /// can resume. The key must contain everything that the result depends on: parameters, seed,
  /// ComputeCodeKey(), and ComputeFileKey() of input files. `compute` returns any text, usually
  /// JSON. Throws Interruption instead of computing after Ctrl-C.
  std::string Cached(const std::string& key, const std::function<std::string()>& compute) const;
};

/// XXH3 of a text, 32 hexadecimal digits, and "NAME:XXH3 of its content", for cache keys.
std::string ContentHash(const std::string& text);
std::string ComputeFileKey(const std::filesystem::path& path);

/// Identifies the code for cache keys: this program and all ossa libraries linked into it
/// dynamically.
std::string ComputeCodeKey();

/// Thrown when the user stops the study; the cache is kept.
struct Interruption {};

struct Experiment {
  std::string_view name;
  std::string_view summary;
  /// Reads every parameter of the study, also those of parts that are not run, and computes
  /// nothing.
  void (*read_parameters)(ExperimentContext&);
  std::vector<Table> (*run)(ExperimentContext&);
};

/// All experiments, in the order of `ossa experiment --help`; defined in registry.cpp.
std::span<const Experiment> Experiments();

/// The experiment of this name, or of its name before 0.2 (`rooms`); null if there is none.
const Experiment* FindExperiment(std::string_view name);

/// Runs an experiment: writes TABLE.md, parameters.toml and summary.json to context.out and returns
/// the tables. Throws InputError for an unknown name or missing data, and, before anything is
/// computed, for unknown or wrong parameters and missing files of the context.
std::vector<Table> RunExperiment(const std::string& name, ExperimentContext& context);

}  // namespace ossa::tools
