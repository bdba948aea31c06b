// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>

namespace weft::bench {

/// A request to a daemon on this port of 127.0.0.1, made wrong in one of many ways; a few are right by
/// chance.
std::string malformed_request(std::mt19937& random, int port);

}  // namespace weft::bench
