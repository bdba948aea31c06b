// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/virtual_camera.h"

#include <utility>

#include "virtual_rig/ptp/body.h"
#include "virtual_rig/ptp/network_link.h"
#include "virtual_rig/ptp/usb_link.h"

namespace weft::virtual_rig {
namespace {

class PtpCamera : public VirtualCamera {
 public:
  PtpCamera(const VirtualCameraOptions& options, DevelopExposure develop)
      : body_(options, std::move(develop)) {}
  ~PtpCamera() override {
    body_.stop();
    body_.attach(nullptr, nullptr);
  }

  Result<void> connect(const VirtualCameraOptions& options) {
    Result<std::unique_ptr<ptp::NetworkLink>> network = ptp::NetworkLink::make(body_, options.port);
    if (!network) return network.error();
    network_ = *std::move(network);
    if (!options.usb.empty()) {
      Result<std::unique_ptr<ptp::UsbLink>> usb =
          ptp::UsbLink::make(body_, options.usb, ptp::facts_of(options.body).usb_product);
      if (!usb) return usb.error();
      usb_ = *std::move(usb);
    }
    body_.attach(network_.get(), usb_.get());
    return {};
  }

  std::uint16_t port() const override { return network_->port(); }
  int shots() const override { return body_.shots(); }

  Result<void> inject(const CameraFault& fault) override {
    const ptp::PtpFaultKind* const kind = ptp::find_fault(fault.name);
    if (!kind)
      return Error{ErrorKind::kUsage, "no such fault of a camera", fault.name,
                   "it is none of those it can have", "choose one of its list of faults"};
    if (fault.shot < 1)
      return Error{ErrorKind::kUsage, "fault befalls no shot", fault.name,
                   "shots are counted from 1 and it is to befall " + std::to_string(fault.shot),
                   "name a shot from 1 on"};
    body_.inject(*kind, fault.shot);
    return {};
  }

 private:
  ptp::PtpBody body_;
  std::unique_ptr<ptp::NetworkLink> network_;
  std::unique_ptr<ptp::UsbLink> usb_;
};

}  // namespace

const std::vector<std::pair<std::string, std::string>>& camera_faults() {
  static const auto faults = [] {
    std::vector<std::pair<std::string, std::string>> named;
    for (const ptp::PtpFaultKind& kind : ptp::fault_kinds()) named.emplace_back(kind.name, kind.sentence);
    return named;
  }();
  return faults;
}

Result<std::unique_ptr<VirtualCamera>> VirtualCamera::start(const VirtualCameraOptions& options,
                                                            DevelopExposure develop) {
  auto camera = std::make_unique<PtpCamera>(options, std::move(develop));
  if (const Result<void> connected = camera->connect(options); !connected) return connected.error();
  return std::unique_ptr<VirtualCamera>(std::move(camera));
}

}  // namespace weft::virtual_rig
