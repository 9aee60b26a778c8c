#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tools/experiments/experiment.h"
#include "tools/experiments/real/real_agreement_internal.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/real/real_held_internal.h"

namespace ossa::tools {

/// Accuracy of every stage on one set.
struct ScoredSet {
  std::string name;
  int64_t frames = 0, one_body = 0;  // stills; those in which exactly one body was found
  std::vector<StageScore> scores;
};

/// Name of a stage in tables: the other method's own name for RealStage::kPeer.
std::string NameInTable(const RealSet& set, RealStage stage);

// The tables of `ossa experiment real`, without rows, and their rows.
Table StillsTable();
void AddStillsRows(const RealSet& set, const ScoredSet& scored, Table& table);
Table RawAndFinalTable();
/// No row if the offset could not be removed.
void AddRawAndFinalRow(const std::string& set, const RawAndFinal& score, Table& table);
Table HolesTable();
void AddHolesRow(const ScoredSet& scored, std::string_view holes, Table& table);
Table JointsTable();
void AddJointRows(const RealSet& set, const ScoredSet& scored, Table& table);
Table AgreementTable();
void AddAgreementRow(const std::string& set, const std::string& joint,
                     const PeerAgreement& agreement, Table& table);
Table StatesTable();
void AddStatesRow(const RealSet& set, const StateScore& score, Table& table);
Table HeldTable();
void AddHeldRow(const std::string& set, const HeldScore& score, Table& table);
Table RecordingsTable();
void AddRecordingRow(const RealVideo& video, const VideoScore& score, Table& table);

// The same figures for real.json; lengths in the units of their names, shares in 0..1.
nlohmann::json SetToJson(const RealSet& set, const ScoredSet& scored);
nlohmann::json AgreementToJson(const std::string& set, const std::string& joint,
                               const PeerAgreement& agreement);
nlohmann::json StatesToJson(const RealSet& set, const StateScore& score);
nlohmann::json HeldToJson(const std::string& set, const HeldScore& score);
nlohmann::json VideoToJson(const RealVideo& video, const VideoScore& score);

}  // namespace ossa::tools
