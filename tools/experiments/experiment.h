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

/// One table of a study, beside the paper's own numbers where there are any.
struct Table {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // as many cells a row as columns
  std::string note;                            // what differs from the paper's data or setting
};

/// Markdown, columns padded so that it reads on a terminal as well.
std::string ToMarkdown(const Table& table);

/// The numbers and names a study may be given in a TOML file, flat `key = value` lines. Asking
/// names the key and its default, so what a study can be told is what it asks for. A study asks for
/// all of them before it computes anything (Experiment::read_parameters): one that is misspelt or
/// out of range would else be told of after hours. Values that do not fit are InputErrors with
/// their line.
class Parameters {
 public:
  // A bound, so that products of counts fit 64 bits
  static constexpr int kMostInteger = 1'000'000'000;
  // Of numbers without a bound.
  static constexpr double kMostNumber = std::numeric_limits<double>::max();
  static constexpr double kLeastNumber = -kMostNumber;

  Parameters() = default;
  /// Throws InputError with file, line and column for what is no TOML, or not flat.
  static Parameters FromToml(const std::filesystem::path& path);

  double Number(const std::string& key, double usual, double least = kLeastNumber,
                double most = kMostNumber);
  /// Throws InputError for less than `least` or more than `most`.
  int Integer(const std::string& key, int usual, int least = 0, int most = kMostInteger);
  bool Flag(const std::string& key, bool usual);
  std::string Text(const std::string& key, const std::string& usual);
  std::vector<std::string> Texts(const std::string& key, const std::vector<std::string>& usual);
  std::string OneOf(const std::string& key, const std::vector<std::string>& known,
                    const std::string& usual);
  /// What recon::LoadMocap() takes: `authored`, `authored-floor`, or a file or folder that is
  /// there; of Motions() one at least.
  std::string Motion(const std::string& key, const std::string& usual);
  std::vector<std::string> Motions(const std::string& key);  // authored by default
  /// Some of `known`, all by default. Throws InputError for any other.
  std::set<std::string> Some(const std::string& key, const std::vector<std::string>& known);
  /// The same, `usual` by default, in the order in which they are given.
  std::vector<std::string> Some(const std::string& key, const std::vector<std::string>& known,
                                const std::vector<std::string>& usual);
  std::vector<double> Numbers(const std::string& key, const std::vector<double>& usual,
                              double least = kLeastNumber, double most = kMostNumber);
  /// The same, whole numbers, one at least.
  std::vector<int> Integers(const std::string& key, const std::vector<int>& usual, int least,
                            int most = kMostInteger);

  /// What was used, as TOML: written beside the results so that the study can be repeated.
  std::string Used() const;
  /// Throws InputError for a key of the file that was never read. From here on, reading a key that
  /// was not read before throws std::logic_error.
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

/// What an experiment is given.
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
  // Called with one line for each model file that does not belong to the others, each time they are
  // loaded and from any thread; may be empty.
  std::function<void(const std::string& line)> warn;

  /// Throws Interruption when the user pressed Ctrl-C. Studies call it between steps of a second.
  void ThrowIfInterrupted() const;

  /// The result of a costly step: kept under out/cache by the content of `key`, so that a study
  /// that was stopped takes up where it was. The key must name everything the result depends on:
  /// parameters, seed, ComputeCodeKey() of what computes it, and ComputeFileKey() of input files.
  /// `compute` returns any text, usually JSON. Throws Interruption before computing when the user
  /// pressed Ctrl-C.
  std::string Cached(const std::string& key, const std::function<std::string()>& compute) const;
};

/// XXH3 of a text, 32 hexadecimal digits, and "NAME:XXH3 of its content", for cache keys.
std::string ContentHash(const std::string& text);
std::string ComputeFileKey(const std::filesystem::path& path);

/// The code that made a number, for cache keys: this program and all ossa libraries that are linked
/// into it dynamically. All, for whoever lists those that a step runs forgets one.
std::string ComputeCodeKey();

/// The user stopped the study; what is cached stays.
struct Interruption {};

struct Experiment {
  std::string_view name;
  std::string_view summary;
  /// Reads every parameter of the study, also of parts that are not run, and computes
  /// nothing.
  void (*read_parameters)(ExperimentContext&);
  std::vector<Table> (*run)(ExperimentContext&);
};

/// Every experiment, in the order of `ossa experiment --help`. Add yours in registry.cpp.
std::span<const Experiment> Experiments();

/// The experiment of that name, or of the name that it had before 0.2 (`rooms`); null: there is
/// none.
const Experiment* FindExperiment(std::string_view name);

/// Runs one: writes TABLE.md, parameters.toml and summary.json to context.out and returns the
/// tables. Throws InputError for an unknown name or missing data, and, before anything is computed,
/// for parameters that are unknown or wrong and for files of the context that are not there.
std::vector<Table> RunExperiment(const std::string& name, ExperimentContext& context);

}  // namespace ossa::tools
