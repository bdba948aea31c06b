// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "core/descriptor.h"
#include "core/result.h"

namespace weft::bench {

/// Clients that keep the door of a daemon busy, until they go.
class Crowd {
 public:
  explicit Crowd(int port) : port_(port) {}

  static constexpr int kMalformed = 1000, kSilent = 64, kSlow = 32;

  /// Malformed requests one after another, drawn by `seed`.
  void send_malformed(std::uint64_t seed);
  bool sending() const { return sending_; }
  /// Who say nothing, every second one of them in the middle of its request. kTryAgain where one
  /// cannot connect.
  Result<void> stay_silent();
  /// Who ask for openapi.json twenty times at once and take 40 kB a second of it. Who is dropped
  /// comes back.
  void read_slowly();

 private:
  const int port_;
  std::atomic<bool> sending_ = false;
  std::vector<Descriptor> silent_;
  std::vector<std::jthread> threads_;
};

}  // namespace weft::bench
