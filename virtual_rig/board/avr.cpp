// SPDX-License-Identifier: GPL-3.0-or-later
#include "virtual_rig/board/avr.h"

#include <sim_avr.h>
#include <sim_elf.h>
#include <sim_irq.h>
// simavr's headers for its peripherals come after its core's.
#include <avr_extint.h>
#include <avr_ioport.h>
#include <avr_uart.h>

#include <cstdlib>
#include <cstring>
#include <utility>

namespace weft::virtual_rig {
namespace {

constexpr std::uint8_t kPowerOn = 1, kExternal = 2, kWatchdog = 8;  // bits of MCUSR
constexpr std::uint32_t kFirstMemory = 0x100;                       // registers lie below

void say_nothing(avr_t*, int, const char*, va_list) {}
void do_not_sleep(avr_t*, avr_cycle_count_t) {}
avr_cycle_count_t wake(avr_t*, avr_cycle_count_t, void*) {
  return 0;
}

/// Where an output is: its port and its pin there.
struct Place {
  char port;
  int pin;
};

Place place_of(int output) {
  if (output == kPolariserBit) return {'C', 0};
  return output < 6 ? Place{'D', output + 2} : Place{'B', output - 6};
}

avr_irq_t* uart(avr_t* avr, int wire) {
  return avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), wire);
}

}  // namespace

Result<std::unique_ptr<Avr>> Avr::load(const std::filesystem::path& elf, Wires wires) {
  avr_global_logger_set(say_nothing);
  elf_firmware_t firmware = {};
  if (!std::filesystem::is_regular_file(elf) || elf_read_firmware(elf.c_str(), &firmware) != 0) {
    return Error{ErrorKind::kNoInput, "the firmware cannot be read", elf.string(),
                 "it is not an ELF file for an AVR", "build it: ninja firmware"};
  }
  std::strcpy(firmware.mmcu, "atmega328p");
  firmware.frequency = static_cast<std::uint32_t>(kCycles_per_s);
  avr_t* avr = avr_make_mcu_by_name(firmware.mmcu);
  avr_init(avr);
  avr_load_firmware(avr, &firmware);
  std::free(firmware.flash);
  return std::unique_ptr<Avr>(new Avr(avr, std::move(wires)));
}

Avr::Avr(avr_t* avr, Wires wires) : avr_(avr), wires_(std::move(wires)), core_reset_(avr->reset) {
  avr_->log = LOG_NONE;
  avr_->frequency = static_cast<std::uint32_t>(kCycles_per_s);
  avr_->sleep = do_not_sleep;  // whoever runs it keeps the time
  avr_->custom.data = this;
  avr_->reset = on_core_reset;
  connect_wires();
  power_on();
}

Avr::~Avr() {
  avr_terminate(avr_);
  std::free(avr_);
}

void Avr::connect_wires() {
  for (int output = 0; output < kOutputs; ++output) {
    Pin& pin = pins_[static_cast<std::size_t>(output)];
    pin = {this, output};
    const Place place = place_of(output);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ(static_cast<std::uint32_t>(place.port)), place.pin),
        on_pin, &pin);
  }
  // Nothing is wired to INT0 and INT1; as level interrupts simavr would poll them at every cycle.
  for (std::uint8_t pin = 0; pin < 2; ++pin) avr_extint_set_strict_lvl_trig(avr_, pin, 0);
  std::uint32_t flags = 0;
  avr_ioctl(avr_, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
  avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  avr_irq_register_notify(uart(avr_, UART_IRQ_OUTPUT), on_byte, this);
  avr_irq_register_notify(uart(avr_, UART_IRQ_OUT_XON), on_room, this);
  avr_irq_register_notify(uart(avr_, UART_IRQ_OUT_XOFF), on_full, this);
}

std::uint64_t Avr::cycles() const {
  return base_ + avr_->cycle;
}

void Avr::run_to(std::uint64_t cycle) {
  if (cycles() >= cycle) return;
  // A sleep ends at the next timer: with one at the end of the run it ends there at the latest.
  avr_cycle_timer_register(avr_, cycle - cycles(), wake, this);
  while (cycles() < cycle) {
    const std::uint64_t before = avr_->cycle;
    const int state = avr_run(avr_);
    if (avr_->cycle < before) base_ += before - avr_->cycle;  // a reset makes simavr count from 0
    if (state == cpu_Crashed || state == cpu_Done) restart(kWatchdog);
  }
}

void Avr::power_on() {
  for (std::uint32_t at = kFirstMemory; at <= avr_->ramend; ++at) {
    chance_ = chance_ * 6364136223846793005U + 1442695040888963407U;
    avr_->data[at] = static_cast<std::uint8_t>(chance_ >> 56);
  }
  restart(kPowerOn);
}

void Avr::reset() {
  restart(kExternal);
}

void Avr::restart(std::uint8_t reset_flag) {
  const std::uint64_t before = avr_->cycle;
  avr_reset(avr_);
  base_ += before - avr_->cycle;
  const auto& flags = avr_->reset_flags;
  for (const avr_regbit_t flag : {flags.porf, flags.extrf, flags.borf, flags.wdrf})
    avr_regbit_clear(avr_, flag);
  avr_regbit_set(avr_, reset_flag == kPowerOn    ? flags.porf
                       : reset_flag == kExternal ? flags.extrf
                                                 : flags.wdrf);
}

void Avr::hang() {
  if (hang_) return;
  constexpr std::array<std::uint8_t, 2> kJumpToSelf = {0xFF, 0xCF};  // rjmp .-2
  hang_ = {avr_->pc, {avr_->flash[avr_->pc], avr_->flash[avr_->pc + 1]}};
  std::memcpy(avr_->flash + hang_->at, kJumpToSelf.data(), kJumpToSelf.size());
}

void Avr::hear(std::uint8_t byte) {
  avr_raise_irq(uart(avr_, UART_IRQ_INPUT), byte);
}

void Avr::go_dark() {
  if (lit_ == 0) return;
  lit_ = 0;
  wires_.pins(cycles(), lit_);
}

void Avr::was_reset() {
  if (hang_) std::memcpy(avr_->flash + hang_->at, hang_->instruction.data(), hang_->instruction.size());
  hang_.reset();
  listens_ = true;
  go_dark();
}

void Avr::on_core_reset(avr_t* avr) {
  auto* self = static_cast<Avr*>(avr->custom.data);
  if (self->core_reset_) self->core_reset_(avr);
  self->was_reset();
}

void Avr::on_pin(avr_irq_t*, std::uint32_t value, void* parameter) {
  const Pin& pin = *static_cast<Pin*>(parameter);
  const auto bit = static_cast<std::uint16_t>(1 << pin.output);
  Avr& self = *pin.self;
  const auto lit = static_cast<std::uint16_t>((value & 1) != 0 ? self.lit_ | bit : self.lit_ & ~bit);
  if (lit == self.lit_) return;
  self.lit_ = lit;
  self.wires_.pins(self.cycles(), lit);
}

void Avr::on_byte(avr_irq_t*, std::uint32_t value, void* parameter) {
  auto& self = *static_cast<Avr*>(parameter);
  self.wires_.sent(self.cycles(), static_cast<std::uint8_t>(value));
}

void Avr::on_room(avr_irq_t*, std::uint32_t, void* parameter) {
  static_cast<Avr*>(parameter)->listens_ = true;
}

void Avr::on_full(avr_irq_t*, std::uint32_t value, void* parameter) {
  if (value != 0) static_cast<Avr*>(parameter)->listens_ = false;
}

}  // namespace weft::virtual_rig
