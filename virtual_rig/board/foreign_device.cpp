// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/board/foreign_device.h"

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <utility>

namespace weft::virtual_rig {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenLooks = 2ms;
constexpr auto kBetweenLines = 200ms;

const std::map<std::string, ForeignTalk>& talks() {
  static const std::map<std::string, ForeignTalk> all = {
      {"gps", {nullptr, "$GPGGA,000000,0000.000,N,00000.000,E,0*00\r\n"}},
      {"printer",
       {[](const std::string&) { return std::string("ok\r\n"); }, "start\r\nbusy: processing\r\n"}},
      {"modem", {[](const std::string& said) { return said + "\r\nERROR\r\n"; }, ""}},
      {"echo", {[](const std::string& said) { return said; }, ""}},
      {"silent", {}}};
  return all;
}

}  // namespace

const std::vector<std::string>& foreign_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> names;
    for (const auto& [name, talk] : talks()) names.push_back(name);
    return names;
  }();
  return kinds;
}

ForeignTalk talk_of_foreign(const std::string& kind) {
  return talks().at(kind);
}

Result<std::unique_ptr<ForeignDevice>> ForeignDevice::start(const std::filesystem::path& terminal,
                                                            const std::filesystem::path& modem,
                                                            ForeignTalk talk) {
  auto made = PseudoTerminal::make(terminal);
  if (!made) return std::move(made).error();
  auto lines = make_modem_lines(modem);
  if (!lines) return std::move(lines).error();
  (*lines)->terminal = (*made)->device();
  return std::unique_ptr<ForeignDevice>(
      new ForeignDevice(std::move(*made), std::move(*lines), std::move(talk)));
}

ForeignDevice::ForeignDevice(std::unique_ptr<PseudoTerminal> terminal, SharedModemLines modem,
                             ForeignTalk talk)
    : terminal_(std::move(terminal)),
      modem_(std::move(modem)),
      talk_(std::move(talk)),
      thread_([this](const std::stop_token& stop) { live(stop); }) {}

void ForeignDevice::send(const std::string& text) const {
  terminal_->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void ForeignDevice::live(const std::stop_token& stop) const {
  auto next = std::chrono::steady_clock::now();
  for (; !stop.stop_requested(); std::this_thread::sleep_for(kBetweenLooks)) {
    std::array<std::uint8_t, 256> bytes = {};
    const std::size_t count = terminal_->read(bytes);
    if (count > 0 && talk_.answer)
      send(talk_.answer({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)}));
    if (const auto now = std::chrono::steady_clock::now(); !talk_.own.empty() && now >= next) {
      send(talk_.own);
      next = now + kBetweenLines;
    }
  }
}

}  // namespace weft::virtual_rig
