// SPDX-License-Identifier: Apache-2.0
#include "bench/server/served_rig.h"

#include <chrono>
#include <csignal>
#include <string>
#include <utility>

namespace weft::bench {
namespace {

constexpr std::chrono::seconds kPatience(10);

/// The line of what weft serve has said that is its address; empty: it has not said it yet.
std::string address_in(const std::string& said) {
  const std::size_t begin = said.rfind("\nhttp://");
  const std::size_t end = begin == std::string::npos ? begin : said.find('\n', begin + 1);
  return end == std::string::npos ? "" : said.substr(begin + 1, end - begin - 1);
}

}  // namespace

Result<void> ServedRig::start(const std::filesystem::path& programs, const std::filesystem::path& scene,
                              double megapixels) {
  auto rig = virtual_rig::RigProcess::start(
      {.programs = programs, .scene = scene, .folder = folder_.path() / "rig", .megapixels = megapixels});
  if (!rig) return std::move(rig).error();
  rig_ = std::move(*rig);
  return {};
}

Result<void> ServedRig::serve() {
  if (daemon_) return {};
  auto daemon = rig_->weft({"serve"}, "serve.log");
  if (!daemon) return std::move(daemon).error();
  daemon_ = std::move(*daemon);
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    if (const std::string address = address_in(daemon_->said()); !address.empty()) {
      auto client = app::RigClient::connect(address);
      if (!client) return std::move(client).error();
      client_ = std::move(*client);
      port_ = std::stoi(address.substr(address.rfind(':') + 1));
      return {};
    }
    if (daemon_->wait(0.02) || std::chrono::steady_clock::now() > deadline) {
      return Error{ErrorKind::kTryAgain, "weft serve does not start", folder_.path().string(),
                   daemon_->said(), "mend that first"};
    }
  }
}

void ServedRig::kill_daemon() {
  daemon_->signal(SIGKILL);
  daemon_.reset();
}

Result<std::unique_ptr<app::RigServer>> server_without_devices(const std::string& name,
                                                               const std::filesystem::path& sessions,
                                                               const std::filesystem::path& state) {
  capture::Rig rig;
  rig.name = name;
  rig.scan.sessions = sessions;
  rig.daemon.port = 0;
  rig.daemon.state = state;
  const Error no_devices = {ErrorKind::kTryAgain, "this rig has no devices", rig.name, "", "name another"};
  return app::RigServer::start(
      rig, [=](const capture::Rig&) -> Result<capture::RigDevices> { return no_devices; },
      [=](const capture::ScanRequest&, capture::Lamps&, capture::Camera&, const capture::ScanEvents&,
          const capture::ScanControl&) -> Result<capture::ScanOutcome> { return no_devices; });
}

}  // namespace weft::bench
