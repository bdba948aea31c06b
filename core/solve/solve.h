// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "core/base/product.h"
#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/image/compression.h"
#include "core/image/image.h"
#include "core/rig/albedo_scale.h"
#include "core/solve/left_out_facts.h"
#include "core/solve/solve_parts.h"
#include "core/solve/solve_record.h"
#include "core/solve/verdict.h"

// A solve: the maps that one run of the solver left in <session>/solve/<id>/ (docs/formats.md).

namespace weft {

inline constexpr ProductKind kSolveProduct = {"weft.solve", "solve.json", "solve",
                                              "solve the session first with weft solve"};

/// The complete solve of a session that has this id; kNoInput where there is none. Which of them is current
/// says solve/session/current.h. A solve of photographs lies in the folder that stands for their session.
Result<Product> find_solve(const std::filesystem::path& session, const std::string& id);

/// The complete solves of a session, the oldest first.
std::vector<Product> list_solves(const std::filesystem::path& session);

/// How many pixels have which status.
struct StatusCounts {
  std::array<std::int64_t, kStatusNames.size()> pixels = {};  ///< with each bit, as kStatusNames has them

  std::int64_t with(StatusBit bit) const;
  friend bool operator==(const StatusCounts&, const StatusCounts&) = default;
};
/// {"SATURATED": 0, "SHADOWED": 21550, ...}; of kHowSolved only where a pixel has it.
void describe(Fields& fields, StatusCounts& counts);

/// Angles between the normals and those of a truth.
struct SolveError {
  double mean_deg = 0, median_deg = 0, p95_deg = 0, max_deg = 0;

  friend bool operator==(const SolveError&, const SolveError&) = default;
};
void describe(Fields& fields, SolveError& error);

/// What a solve gives and takes: as it was foretold, or as it came.
struct SolvePrice {
  double seconds = 0;   ///< wall, until solve.json is written
  double mean_deg = 0;  ///< that normals are expected to be off, where there is one
  double solved = 0;    ///< share of the cloth that has a normal
  Json parts_s;         ///< seconds by phase, for people; null where they are not known

  friend bool operator==(const SolvePrice&, const SolvePrice&) = default;
};
void describe(Fields& fields, SolvePrice& price);

/// Cloth of which less has a normal is not called solved.
inline constexpr double kLeastSolved = 0.5;

/// Mean error over all of a cloth of which the share `solved` is off by `mean_deg`. Where there is no normal
/// nothing is known, and straight up is one radian from a direction that may be any of the hemisphere, on the
/// mean.
double deg_of_whole(double mean_deg, double solved);

/// "0.77 degrees on 98 % of the cloth", or "nothing solved".
std::string error_in_words(double mean_deg, double solved);
/// "98 %": 100 only of all.
std::string share_in_words(double share);

/// How far the photograph of one light had moved.
struct RegisteredShot {
  int led = 0;
  double dx_px = 0, dy_px = 0, turn_deg = 0;
  double sigma_px = 0;        ///< standard deviation of the shift
  double cost_deg = 0;        ///< that normals would be off for it
  bool is_corrected = false;  ///< it was left out for it
  std::string verdict;        ///< "still", "left out", "flagged" or "not registered"

  friend bool operator==(const RegisteredShot&, const RegisteredShot&) = default;
};
void describe(Fields& fields, RegisteredShot& shot);

/// What tells whether the level `reference` has anything to gain.
struct GateFacts {
  std::string name, unit;
  double value = 0, limit = 0;
  bool is_over = false;

  friend bool operator==(const GateFacts&, const GateFacts&) = default;
};
void describe(Fields& fields, GateFacts& gate);

/// Pixels by the arithmetic that solved them.
struct SolvedBy {
  std::int64_t float32 = 0, in_double = 0, qr = 0, svd = 0, unsolved = 0, rejected_readings = 0;
  /// Share of the blocks that are solved as `robust` does; of the levels `robust` and `reference`.
  std::optional<double> robust_share = {};

  friend bool operator==(const SolvedBy&, const SolvedBy&) = default;
};
void describe(Fields& fields, SolvedBy& solved_by);

/// What solve.json says of a solve.
struct SolveFacts {
  std::string id;
  int solver_version = 0;
  std::string method;
  Compression compression = Compression::kNone;  ///< of EXR files
  int lights = 0;
  Size size;  ///< of the maps
  AlbedoScale albedo_scale = AlbedoScale::kRelative;
  bool is_rec709 = false;   ///< albedo is in linear Rec.709; else in the camera's channels
  std::int64_t pixels = 0;  ///< with a solution
  StatusCounts status;
  std::vector<Verdict> warnings;
  std::vector<std::string> assumed;    ///< of photographs and the file of their lights
  std::vector<std::string> pictures;   ///< files in its folder
  std::optional<LeftOutFacts> check;   ///< where a light could be left out
  std::optional<SolveError> error;     ///< where there is a truth
  std::optional<SolvePrice> foretold;  ///< where a price was asked before
  std::optional<SolvePrice> taken;     ///< none in documents of early versions
  std::optional<SolvedBy> solved_by;
  std::optional<std::vector<RegisteredShot>> registration;
  std::vector<GateFacts> gates;  ///< of the level `reference`

  std::optional<SolveInput> input;
  std::optional<ConditionFacts> conditions;
  std::optional<SigmaFacts> sigma_normal_deg;
  std::optional<SharpeningFacts> sharpening;       ///< where the spread of the lens is known
  std::optional<LateralColorFacts> lateral_color;  ///< where it was taken out
  std::optional<ReferenceLevelFacts> reference;    ///< of the level `reference`
  std::optional<ReflectanceSummary> reflectance;   ///< of the levels `robust` and `reference`
};

void describe(Fields& fields, SolveFacts& facts);

/// Reads solve.json, `where` being its name for messages. Documents of early versions have no color, warnings
/// or pictures. kBadData.
Result<SolveFacts> solve_facts_from_json(const Json& document,
                                         const std::string& where = kSolveProduct.document);
Json json_of(const SolveFacts& facts);

}  // namespace weft
