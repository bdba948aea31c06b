// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/board/virtual_board.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "virtual_rig/board/avr.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/usb_terminal.h"

namespace weft::virtual_rig {
namespace {

Error cannot_make(const std::filesystem::path& link, int error_number) {
  return {ErrorKind::kCannotCreate, "the virtual board's terminal cannot be made", link.string(),
          std::generic_category().message(error_number), "choose a folder that can be written"};
}

void make_raw(int terminal) {
  termios settings = {};
  tcgetattr(terminal, &settings);
  cfmakeraw(&settings);
  cfsetspeed(&settings, B115200);
  tcsetattr(terminal, TCSANOW, &settings);
}

/// Names the terminal by the link in one step, so that nobody finds half of it.
bool make_link(const std::string& terminal, const std::filesystem::path& link) {
  const std::string aside = link.string() + ".partial";
  unlink(aside.c_str());
  return symlink(terminal.c_str(), aside.c_str()) == 0 && rename(aside.c_str(), link.c_str()) == 0;
}

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

constexpr std::uint64_t kSliceCycles =
    16'000;                          ///< 1 ms of the board's time, between two looks at the terminal
constexpr auto kMostBehind = 200ms;  ///< a machine too busy to keep up slows the board's time down
constexpr auto kNoise = 100ms;
constexpr auto kSlowness = 150ms;

class SimulatedBoard final : public VirtualBoard {
 public:
  SimulatedBoard(VirtualBoardOptions options, LitLog& pins, SharedModemLines modem, int wake)
      : options_(std::move(options)), pins_(pins), modem_(std::move(modem)), wake_(wake) {}

  ~SimulatedBoard() override {
    if (thread_.joinable()) {
      thread_.request_stop();
      wake();
      thread_.join();
    }
    lose_power();
    std::error_code ignored;
    std::filesystem::remove(options_.modem, ignored);
    close(wake_);
  }

  Result<void> begin() {
    auto avr =
        Avr::load(options_.firmware,
                  {[this](std::uint64_t, std::uint8_t byte) { send(byte); },
                   [this](std::uint64_t cycle, std::uint16_t lit) { pins_.record(time_of(cycle), lit); }});
    if (!avr) return std::move(avr).error();
    avr_ = std::move(*avr);
    if (auto terminal = get_power(); !terminal) return terminal;
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    return {};
  }

  double stood_still_s() const override { return stood_still_s_; }

  void inject(VirtualBoardFault fault) override {
    std::unique_lock lock(mutex_);
    faults_.push_back(fault);
    wake();
    happened_.wait(lock, [&] { return faults_.empty(); });
  }

 private:
  void wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = write(wake_, &one, sizeof one);
  }

  void run(const std::stop_token& stop) {
    prctl(PR_SET_TIMERSLACK, 1000UL);  // ns: naps below a millisecond end in time
    while (!stop.stop_requested()) {
      suffer_faults();
      if (terminal_) {
        const auto now = RigClock::now();
        live_until(now);
        hear_terminal(now);
        deliver();
      }
      wait();
    }
  }

  void suffer_faults() {
    const std::lock_guard lock(mutex_);
    for (const VirtualBoardFault fault : faults_) suffer(fault);
    faults_.clear();
    happened_.notify_all();
  }

  void suffer(VirtualBoardFault fault) {
    switch (fault) {
      case VirtualBoardFault::kUnplug:
        return lose_power();
      case VirtualBoardFault::kReplug:
        lose_power();
        static_cast<void>(get_power());
        return;
      case VirtualBoardFault::kElsewhere:
        lose_power();
        ++usb_number_;
        static_cast<void>(get_power());
        return;
      case VirtualBoardFault::kReset:
        return reset();
      case VirtualBoardFault::kHang:
        return avr_->hang();
      case VirtualBoardFault::kGarbage:
        noise_until_ = RigClock::now() + kNoise;
        return;
      case VirtualBoardFault::kDeaf:
        deaf_ = true;
        return;
      case VirtualBoardFault::kSlow:
        slow_ = true;
        return;
      case VirtualBoardFault::kWrongBaud:
        garbled_ = true;
        return;
      case VirtualBoardFault::kHear:
        deaf_ = slow_ = garbled_ = false;
        return;
    }
  }

  void lose_power() {
    usb_.reset();
    terminal_.reset();
    modem_->terminal = 0;
    inbox_.clear();
    outbox_.clear();
    pins_.record(RigClock::now(), 0);
  }

  Result<void> get_power() {
    auto terminal = PseudoTerminal::make(options_.terminal);
    if (!terminal) return std::move(terminal).error();
    terminal_ = std::move(*terminal);
    if (options_.usb) {
      auto usb =
          UsbTerminal::make(options_.usb->machine, usb_number_, options_.usb->serial, options_.terminal);
      if (!usb) return std::move(usb).error();
      usb_ = std::move(*usb);
    }
    modem_->lines = 0;
    modem_->exclusive = 0;
    modem_->terminal = terminal_->device();
    dtr_rises_ = modem_->dtr_rises;
    set_clock();
    avr_->power_on();
    return {};
  }

  void set_clock() {
    clock_time_ = RigClock::now();
    clock_cycle_ = avr_->cycles();
  }

  RigClock::time_point time_of(std::uint64_t cycle) const {
    const double s = static_cast<double>(cycle - clock_cycle_) / Avr::kCycles_per_s;
    return clock_time_ + nanoseconds(std::llround(s * 1e9));
  }

  std::uint64_t cycle_at(RigClock::time_point time) const {
    const double s = std::chrono::duration<double>(time - clock_time_).count();
    return clock_cycle_ + static_cast<std::uint64_t>(std::llround(s * Avr::kCycles_per_s));
  }

  void reset() {
    inbox_.clear();
    set_clock();
    avr_->reset();
    bootloader_until_ = RigClock::now() + std::chrono::duration_cast<RigClock::duration>(
                                              std::chrono::duration<double>(options_.bootloader_s));
  }

  void live_until(RigClock::time_point now) {
    const bool starting = now < bootloader_until_;
    const auto behind = now - time_of(avr_->cycles());
    if (!starting && behind > kMostBehind)
      stood_still_s_ = stood_still_s_ + std::chrono::duration<double>(behind).count();
    if (starting || behind > kMostBehind) set_clock();
    for (const std::uint64_t end = cycle_at(now); !starting && avr_->cycles() < end;) {
      feed();
      avr_->run_to(std::min(end, avr_->cycles() + kSliceCycles));
    }
  }

  void feed() {
    for (; avr_->listens() && !inbox_.empty(); inbox_.pop_front()) avr_->hear(inbox_.front());
  }

  /// To be called once the board has lived until now: nothing reaches it before it was sent.
  void hear_terminal(RigClock::time_point now) {
    std::array<std::uint8_t, 256> bytes = {};
    const std::size_t count = terminal_->read(bytes);
    // After the read: what was sent after a rise of DTR must not be heard before the reset.
    const std::uint32_t rises = modem_->dtr_rises;
    if (std::exchange(dtr_rises_, rises) != rises) return reset();
    if (now < bootloader_until_) return;
    if (count > 0) busy_until_ = now + 5ms;
    const bool garbled = garbled_ || (count > 0 && !terminal_->is_at_115200_baud());
    for (std::size_t i = 0; i < count && !deaf_; ++i) {
      inbox_.push_back(garbled ? static_cast<std::uint8_t>(bytes[i] * 37 + 11) : bytes[i]);
    }
    if (now < noise_until_) {
      inbox_.push_back(static_cast<std::uint8_t>(noise_()));
      send(static_cast<std::uint8_t>(noise_()));
      busy_until_ = now + 5ms;
    }
    feed();
  }

  void send(std::uint8_t byte) { outbox_.push_back({RigClock::now() + (slow_ ? kSlowness : 0ms), byte}); }

  void deliver() {
    const auto now = RigClock::now();
    std::vector<std::uint8_t> due;
    for (; !outbox_.empty() && outbox_.front().when <= now; outbox_.pop_front())
      due.push_back(outbox_.front().byte);
    if (!due.empty()) terminal_->write(due);
  }

  /// Until a byte or a fault comes; for a tenth of a byte's time while bytes are on their way, else for as
  /// long as nobody sees that the board's time stands still.
  void wait() {
    const bool busy = !inbox_.empty() || RigClock::now() < busy_until_;
    const nanoseconds nap = busy ? 100us : pins_.now() != 0 ? 1ms : 4ms;
    const timespec time = {0, nap.count()};
    std::array<pollfd, 2> watched = {
        {{wake_, POLLIN, 0}, {terminal_ ? terminal_->descriptor() : -1, POLLIN, 0}}};
    const bool woken = ppoll(watched.data(), watched.size(), &time, nullptr) > 0 && watched[0].revents != 0;
    std::uint64_t count = 0;
    if (woken) [[maybe_unused]]
      const auto drained = read(wake_, &count, sizeof count);
  }

  struct Sent {
    RigClock::time_point when;
    std::uint8_t byte;
  };

  const VirtualBoardOptions options_;
  LitLog& pins_;
  SharedModemLines modem_;
  const int wake_;
  std::unique_ptr<Avr> avr_;
  std::unique_ptr<PseudoTerminal> terminal_;  ///< none: unplugged
  std::unique_ptr<UsbTerminal> usb_;
  int usb_number_ = 0;
  RigClock::time_point clock_time_;  ///< when the board was at clock_cycle_
  std::uint64_t clock_cycle_ = 0;
  std::atomic<double> stood_still_s_ = 0;
  std::uint32_t dtr_rises_ = 0;
  RigClock::time_point bootloader_until_, noise_until_, busy_until_;
  std::deque<std::uint8_t> inbox_;
  std::deque<Sent> outbox_;
  bool deaf_ = false, slow_ = false, garbled_ = false;
  std::minstd_rand noise_;
  std::mutex mutex_;
  std::condition_variable happened_;
  std::vector<VirtualBoardFault> faults_;
  std::jthread thread_;
};

}  // namespace

Result<std::unique_ptr<PseudoTerminal>> PseudoTerminal::make(const std::filesystem::path& link) {
  const int board_end = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (board_end < 0) return cannot_make(link, errno);
  std::array<char, 64> name = {};
  const bool named = grantpt(board_end) == 0 && unlockpt(board_end) == 0 &&
                     ptsname_r(board_end, name.data(), name.size()) == 0;
  const int host_end = named ? open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC) : -1;
  struct stat facts {};
  if (host_end < 0 || fstat(host_end, &facts) != 0 || !make_link(name.data(), link)) {
    const int why = errno;
    if (host_end >= 0) close(host_end);
    close(board_end);
    return cannot_make(link, why);
  }
  make_raw(host_end);
  return std::unique_ptr<PseudoTerminal>(new PseudoTerminal(link, board_end, host_end, facts.st_rdev));
}

PseudoTerminal::~PseudoTerminal() {
  unlink(link_.c_str());
  close(host_end_);
  close(board_end_);
}

bool PseudoTerminal::is_at_115200_baud() const {
  termios settings = {};
  return tcgetattr(board_end_, &settings) == 0 && cfgetospeed(&settings) == B115200;
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> bytes) const {
  const ssize_t count = ::read(board_end_, bytes.data(), bytes.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

void PseudoTerminal::write(std::span<const std::uint8_t> bytes) const {
  [[maybe_unused]] const ssize_t written = ::write(board_end_, bytes.data(), bytes.size());
}

Result<std::unique_ptr<VirtualBoard>> VirtualBoard::start(const VirtualBoardOptions& options, LitLog& pins) {
  auto modem = make_modem_lines(options.modem);
  if (!modem) return std::move(modem).error();
  auto board = std::make_unique<SimulatedBoard>(options, pins, std::move(*modem),
                                                eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (auto begun = board->begin(); !begun) return std::move(begun).error();
  return std::unique_ptr<VirtualBoard>(std::move(board));
}

}  // namespace weft::virtual_rig
