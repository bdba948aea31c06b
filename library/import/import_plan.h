// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/run/balls.h"
#include "core/base/job_context.h"
#include "core/base/json_document.h"
#include "core/base/result.h"
#include "core/base/temporary_folder.h"
#include "core/rig/calibration.h"
#include "core/rig/photo_reading.h"
#include "core/rig/session.h"
#include "library/import/led_decision.h"
#include "library/import/source_folders.h"
#include "solve/input/light_list.h"

// Folders of photographs that other rigs and programs left, as sessions of weft: what would be made of them.

namespace weft::library {

/// How a session comes to its frames.
enum class FrameLink {
  kHard,      ///< another name of the same file
  kCopy,      ///< a file of its own, read-only, verified
  kSymbolic,  ///< a link to where the file lies now
};
inline constexpr std::array<const char*, 3> kFrameLinkNames = {"hard", "copy", "symbolic"};

struct ImportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path rig;          ///< rig file; its calibration, sessions and height where none is named
  std::filesystem::path calibration;  ///< folder
  std::string pattern;                ///< of names (name_pattern.h); empty: none
  FrameOrder order = FrameOrder::kAuto;
  FrameLink link = FrameLink::kHard;
  std::filesystem::path archive;  ///< folder of sessions; empty: the rig's
  double gap_s = 60;
  bool takes_missing = false;
  std::optional<double> cloth_height_mm;  ///< where no description says one
  /// How photographs that no rig took are read; the one of them with all lamps off, empty: none; what is
  /// known of balls that tell their lights, none: light files do.
  PhotoReading reading;
  std::filesystem::path dark;
  std::optional<calibration::BallsOptions> balls;
};

/// What is to become of one group of photographs.
enum class ImportState {
  kNew,      ///< it will be made
  kThere,    ///< it is there, of the same frames
  kRefused,  ///< `refusal` says why
};
inline constexpr std::array<const char*, 3> kImportStateNames = {"new", "there", "refused"};

/// One session. `frames`, and LEDs and the rest of `decision`, are in order of capture.
struct ProposedSession {
  ImportState state = ImportState::kNew;
  std::filesystem::path source;  ///< folder of its frames
  Session session;               ///< as it will be written, but for digests; its folder is where
  std::vector<SourceFrame> frames;
  LedDecision decision;
  std::vector<ImportDoubt> warnings;
  std::optional<Error> refusal;
};

/// A session of photographs that no rig took, and of the lights that were brought along.
struct ProposedPhotographs {
  ImportState state = ImportState::kNew;
  std::filesystem::path source;              ///< light file, or folder
  Session session;                           ///< as it will be written; its folder is where
  std::vector<std::filesystem::path> files;  ///< of its shots
  solve::LightList lights;                   ///< theirs, by the names that the session has
  std::filesystem::path mask;                ///< empty: there is none
  std::filesystem::path picture;             ///< of the balls that told the lights; empty: none did
  std::vector<std::filesystem::path> descriptions;
  std::vector<std::string> assumed;
  std::optional<Error> refusal;
};

/// All that will be done, and nothing done yet.
struct ImportProposal {
  std::filesystem::path archive;
  std::filesystem::path calibration;  ///< folder; empty where there are no sessions
  std::string calibration_id, rig;
  FrameLink link = FrameLink::kHard;
  std::vector<ProposedSession> sessions;
  std::vector<ProposedPhotographs> photographs;
  std::vector<LeftOver> left_over;
  std::shared_ptr<const TemporaryFolder> aside;  ///< has what balls told until it is imported

  std::size_t count(ImportState state) const;
  /// The first refusal; nothing where all can be imported.
  std::optional<Error> first_refusal() const;
};

/// Looks at all files, decodes every frame once, and decides. What speaks against one session is its refusal;
/// what speaks against all is the error: kUsage (nothing names a calibration or an archive, the pattern),
/// kNoInput (a folder that is not there, no photograph in any), kBadData (a calibration without lights, of
/// another rig), kCannotCreate (hard links to another disk). Reports the phases "look" and "read".
Result<ImportProposal> plan_import(const ImportOptions& options, const JobContext& context);

/// {"archive", "calibration", "rig", "sessions", "photographs", "left_over", "oddities"}.
Json json_of(const ImportProposal& plan);

}  // namespace weft::library
