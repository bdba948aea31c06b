// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/base/result.h"

namespace weft::app {

/// What the program tells its caller when it ends (sysexits.h where it has a word for it).
enum ExitCode {
  kDone = 0,
  kDoneWithWarnings = 2,  ///< only under --strict
  kUsageError = 64,
  kBadDataError = 65,
  kNoInputError = 66,
  kNoDeviceError = 69,
  kInternalError = 70,
  kCannotCreateError = 73,
  kInputOutputError = 74,
  kTryAgainError = 75,
  kProtocolError = 76,
  kInterruptedError = 130,
};

struct ExitCodeWords {
  ExitCode code;
  const char* words;  ///< as help and the manual have them
};

inline constexpr std::array kExitCodes = {
    ExitCodeWords{kDone, "done"},
    ExitCodeWords{kDoneWithWarnings, "done with warnings under --strict"},
    ExitCodeWords{kUsageError, "usage"},
    ExitCodeWords{kBadDataError, "bad data"},
    ExitCodeWords{kNoInputError, "no input"},
    ExitCodeWords{kNoDeviceError, "device not there"},
    ExitCodeWords{kInternalError, "our own bug"},
    ExitCodeWords{kCannotCreateError, "cannot create"},
    ExitCodeWords{kInputOutputError, "input/output"},
    ExitCodeWords{kTryAgainError, "try again"},
    ExitCodeWords{kProtocolError, "protocol"},
    ExitCodeWords{kInterruptedError, "interrupted"}};

constexpr ExitCode exit_code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return kUsageError;
    case ErrorKind::kBadData:
      return kBadDataError;
    case ErrorKind::kNoInput:
      return kNoInputError;
    case ErrorKind::kNoDevice:
      return kNoDeviceError;
    case ErrorKind::kInternal:
      return kInternalError;
    case ErrorKind::kCannotCreate:
      return kCannotCreateError;
    case ErrorKind::kInputOutput:
      return kInputOutputError;
    case ErrorKind::kTryAgain:
      return kTryAgainError;
    case ErrorKind::kProtocol:
      return kProtocolError;
    case ErrorKind::kInterrupted:
      return kInterruptedError;
  }
  return kInternalError;
}

}  // namespace weft::app
