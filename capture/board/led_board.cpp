// SPDX-License-Identifier: Apache-2.0
#include "capture/board/led_board.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "capture/board/board_replies.h"
#include "capture/board/board_wire.h"
#include "core/base/text.h"

namespace weft::capture {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kKeepAlive = 120ms;  ///< a quarter of the dead-man's time: three may be lost
constexpr auto kEndOfLight = 50ms;  ///< so close to the end of a light, it may be over already
constexpr double kRestMargin_s = 0.02;
constexpr int kMoreOutputsSince = 1;  // minor of the protocol

Clock::duration seconds(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

/// A board that has been greeted.
struct Connection {
  BoardWire wire;
  BoardFacts facts;
};

/// Where the board may be that does not answer at this port.
Error with_other_ports(Error error, const std::vector<std::string>& ports) {
  if (!ports.empty()) error.remedy += "; by their USB numbers LED boards may be at " + first_few(ports);
  return error;
}

Result<std::unique_ptr<Connection>> connect(const std::string& name, double greeting_s) {
  auto port = SerialPort::open(name);
  if (!port) return std::move(port).error();
  auto connection = std::make_unique<Connection>(Connection{BoardWire(std::move(*port)), {}});
  const auto hello = connection->wire.greet(greeting_s);
  if (!hello) return with_other_ports(hello.error(), connection->wire.port().other_boards());
  auto facts = facts_in(*hello, name);
  if (!facts) return std::move(facts).error();
  connection->facts = std::move(*facts);
  connection->facts.usb = connection->wire.port().usb_identity();
  return connection;
}

/// Where the board of this USB identity is now: under the name it was given, unless one other port is it. So
/// no other device is opened, which resets it. Boards without a serial number are not told from each other.
Result<std::string> port_of(const std::string& usb, const std::string& given) {
  if (usb.empty() || usb.ends_with(' ')) return given;
  const auto names = SerialPort::names_of_usb(usb);
  if (names.size() == 1) return names.front();
  if (!names.empty()) return given;
  return Error{ErrorKind::kNoDevice, "the LED board is gone", given,
               fmt::format("no port is USB device {}", usb), "plug the rig's own board in"};
}

bool has_more_outputs_by(const BoardFacts& facts) {
  return facts.protocol_minor >= kMoreOutputsSince;
}

/// LEDs as bits, and the request that lights them.
struct Light {
  std::uint16_t mask = 0;
  std::uint8_t command = kWeftLight;
  std::array<std::uint8_t, 4> payload = {};
  std::size_t length = 3;
  double most_s = 0;
};

Result<Light> light_of(std::span<const int> leds, double most_s, const BoardFacts& facts,
                       const std::string& port) {
  const auto wrong = [&](const std::string& why, const std::string& remedy) {
    return Error{ErrorKind::kUsage, "the LED board cannot be asked for this light", port, why, remedy};
  };
  Light light;
  if (leds.empty()) return light;
  if (leds.size() > 2 || (leds.size() == 2 && leds[0] == leds[1])) {
    return wrong("one LED or two different ones are lit together", "ask for one or two");
  }
  const bool is_below = leds.size() == 1 && leds[0] == facts.leds + 1 && has_more_outputs_by(facts);
  for (const int led : leds) {
    if (!is_below && (led < 1 || led > facts.leds)) {
      return wrong(fmt::format("there is no LED {}", led), fmt::format("choose from 1 to {}", facts.leds));
    }
    light.mask = static_cast<std::uint16_t>(light.mask | 1 << (led - 1));
  }
  if (!(most_s > 0 && most_s <= facts.longest_on_s)) {
    return wrong(fmt::format("{} s is not a time it allows", most_s),
                 fmt::format("expose for at most {} s", facts.longest_on_s));
  }
  light.most_s = most_s;
  light.command = leds.size() == 2 ? kWeftLightPair : kWeftLight;
  light.length = leds.size() + 2;
  std::ranges::transform(leds, light.payload.begin(), [](int led) { return static_cast<std::uint8_t>(led); });
  weft_put_u16(light.payload.data() + leds.size(),
               static_cast<std::uint16_t>(std::ceil(most_s * 100 - 1e-9)));
  return light;
}

class OpenLedBoard final : public LedBoard {
 public:
  OpenLedBoard(LedBoardOptions options, std::unique_ptr<Connection> connection)
      : options_(std::move(options)), facts_(connection->facts), connection_(std::move(connection)) {
    keeper_ = std::jthread([this](const std::stop_token& stop) { keep_alive(stop); });
  }

  ~OpenLedBoard() override {
    keeper_.request_stop();
    keeper_.join();
    if (connection_ && lit_ != 0) static_cast<void>(send({}));
  }

  int leds() const override { return facts_.leds; }
  BoardFacts facts() const override { return facts_; }

  Result<double> light(std::span<const int> leds, double most_s) override {
    const auto wanted = light_of(leds, most_s, facts_, options_.port);
    if (!wanted) return wanted.error();
    const std::lock_guard lock(mutex_);
    if (fault_) return *std::exchange(fault_, std::nullopt);
    const auto rest = send(*wanted);
    if (!rest) return rest.error();
    if (*rest == 0ms) return 0.0;
    if (auto dark = send({}); !dark) return dark.error();
    return std::chrono::duration<double>(*rest).count() + kRestMargin_s;
  }

  bool has_more_outputs() const override { return has_more_outputs_by(facts_); }

  Result<void> polarise(Polariser state) override {
    if (state == Polariser::kNone || !has_more_outputs()) {
      return Error{
          ErrorKind::kUsage, "the LED board cannot turn the polariser", options_.port,
          has_more_outputs() ? "it is turned to parallel or crossed" : "its firmware is older than that",
          has_more_outputs() ? "ask for one of these"
                             : "flash its firmware: weft rig flash " + options_.port};
    }
    const std::array<std::uint8_t, 1> payload = {state == Polariser::kCrossed ? std::uint8_t{kWeftCrossed}
                                                                              : std::uint8_t{kWeftParallel}};
    const std::lock_guard lock(mutex_);
    const auto reply = ask(kWeftPolariser, payload);
    return reply ? polariser_answer_in(*reply, options_.port) : reply.error();
  }

  Result<std::vector<double>> can_light_s() override {
    if (!has_more_outputs()) return std::vector<double>();
    const std::lock_guard lock(mutex_);
    const auto reply = ask(kWeftHeat, {});
    if (!reply) return reply.error();
    Result<std::vector<double>> seconds = heat_in(*reply, options_.port);
    if (!seconds) return seconds;
    for (double& each : *seconds) each = std::max(facts_.longest_on_s - each, 0.0);
    return seconds;
  }

  Result<BoardStatus> status() override {
    const std::lock_guard lock(mutex_);
    return ask_status();
  }

  Result<void> recover() override {
    const std::lock_guard lock(mutex_);
    lit_ = 0;
    connection_.reset();
    const auto name = port_of(facts_.usb, options_.port);
    if (!name) return name.error();
    auto connection = connect(*name, options_.greeting_s);
    if (!connection) return std::move(connection).error();
    const BoardFacts& found = (*connection)->facts;
    if (found.leds != facts_.leds || found.usb != facts_.usb) {
      return Error{ErrorKind::kBadData, "another LED board is on this port", options_.port,
                   fmt::format("{} LEDs, USB \"{}\", and it had {}, \"{}\"", found.leds, found.usb,
                               facts_.leds, facts_.usb),
                   "plug the rig's own board in"};
    }
    connection_ = std::move(*connection);
    fault_.reset();
    const auto dark = send({});
    if (!dark) return dark.error();
    return {};
  }

 private:
  /// Asks for a light. How long its LEDs must rest before that, 0 if it is lit.
  Result<std::chrono::milliseconds> send(const Light& light) {
    const auto reply = ask(light.command, std::span(light.payload).first(light.length));
    if (!reply) return reply.error();
    const auto answer = light_answer_in(*reply, options_.port);
    if (!answer) return answer.error();
    if (answer->rest > 0ms) return answer->rest;
    const bool kept = is_still_lit(answer->lit_before);
    lit_ = light.mask;
    lit_until_ = Clock::now() + seconds(light.most_s);
    if (kept) return 0ms;
    const auto status = ask_status();
    lit_ = 0;
    static_cast<void>(ask(kWeftLight, std::array<std::uint8_t, 3>{}));
    return status ? went_out(*status) : status.error();
  }

  /// Whether what the board says is lit is what it was asked to light and promised to keep.
  bool is_still_lit(std::uint16_t mask) const {
    return lit_ == 0 || mask == lit_ || Clock::now() > lit_until_ - kEndOfLight;
  }

  Error went_out(const BoardStatus& status) const {
    const bool was_reset = status.dark == WentDark::kNeverLit;  // though it has been lit
    const std::string why = was_reset ? fmt::format("the board was reset ({})", name_of(status.reset))
                                      : fmt::format("the lights went off {}", name_of(status.dark));
    return {ErrorKind::kTryAgain, "a light went out before its time", options_.port, why,
            "take the shot again; if it happens often check cable and power of the LED board"};
  }

  Result<BoardStatus> ask_status() {
    const auto reply = ask(kWeftStatus, {});
    if (!reply) return reply.error();
    return status_in(*reply, options_.port);
  }

  Result<BoardReply> ask(std::uint8_t command, std::span<const std::uint8_t> payload) {
    if (!connection_) {
      return Error{ErrorKind::kNoDevice, "the LED board is gone", options_.port,
                   "its port does not exist any more", "check its cable and plug it in"};
    }
    auto reply = connection_->wire.ask(command, payload);
    if (reply) return reply;
    lit_ = 0;  // whatever it lights now, its dead-man timer ends
    if (reply.error().kind == ErrorKind::kNoDevice) connection_.reset();
    return reply;
  }

  void keep_alive(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      tick_.wait_for(lock, stop, kKeepAlive, [] { return false; });
      if (stop.stop_requested()) return;
      if (lit_ != 0) look_after_light();
      if (connection_ && !connection_->wire.port().is_there()) connection_.reset();
    }
  }

  void look_after_light() {
    const auto status = ask_status();
    if (!status) {
      fault_ = status.error();
    } else if (const auto mask = mask_of(status->lit); !is_still_lit(mask)) {
      fault_ = went_out(*status);
      lit_ = 0;
    } else if (mask == 0) {
      lit_ = 0;
    }
  }

  const LedBoardOptions options_;
  const BoardFacts facts_;
  std::mutex mutex_;
  std::condition_variable_any tick_;
  std::unique_ptr<Connection> connection_;  ///< none: gone, and not found again
  std::uint16_t lit_ = 0;                   ///< what should be lit now
  Clock::time_point lit_until_;
  std::optional<Error> fault_;  ///< what the keeper found, for the next light()
  std::jthread keeper_;
};

}  // namespace

Result<std::unique_ptr<LedBoard>> LedBoard::open(const LedBoardOptions& options) {
  auto connection = connect(options.port, options.greeting_s);
  if (!connection) return std::move(connection).error();
  return std::unique_ptr<LedBoard>(std::make_unique<OpenLedBoard>(options, std::move(*connection)));
}

}  // namespace weft::capture
