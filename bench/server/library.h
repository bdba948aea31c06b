// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "bench/base/report.h"
#include "core/result.h"

namespace weft::bench {

struct ServerLibraryOptions {
  int served = 40'000, rebuilt = 10'000, searched = 100'000;  ///< sessions, folders without photographs
  int questions = 50;                                         ///< of each call
  std::function<void(int done, int steps)> progress = [](int, int) {};
};

/// A row a number that is asked of the library: what, of how many sessions, median and worst in ms, what is
/// asked in ms, whether it holds. The first rows are calls of a server without devices over HTTP (the choice
/// of POST scan by its dry run), the others of a catalogue: made from nothing, looked through where nothing
/// changed, searched by a word that a fifth of the sessions have and by a barcode. Errors: those of
/// RigServer::start() and Catalogue::open().
Result<Rows> server_library_table(const ServerLibraryOptions& options);

}  // namespace weft::bench
