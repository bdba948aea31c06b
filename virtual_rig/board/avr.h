// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "core/base/result.h"
#include "virtual_rig/board/lit_log.h"

struct avr_t;
struct avr_irq_t;

namespace weft::virtual_rig {

/// An ATmega328P at 16 MHz in simavr, with a LED board's wiring: LEDs 1 to 6 on PD2 to PD7, 7 to 10 on PB0 to
/// PB3, the light below on PB4, the polariser on PC0. For one thread.
class Avr {
 public:
  static constexpr double kCycles_per_s = 16e6;

  /// What happens on the wires, with the cycle it happens at.
  struct Wires {
    std::function<void(std::uint64_t cycle, std::uint8_t byte)> sent;
    std::function<void(std::uint64_t cycle, std::uint16_t lit)> pins;  ///< by bits of LitLog
  };

  static Result<std::unique_ptr<Avr>> load(const std::filesystem::path& elf, Wires wires);
  ~Avr();
  Avr(const Avr&) = delete;
  Avr& operator=(const Avr&) = delete;

  /// Cycles since it was made, through all resets.
  std::uint64_t cycles() const;
  /// Runs up to that cycle, an instruction more at most.
  void run_to(std::uint64_t cycle);

  /// Power goes and comes: what memory holds then is chance.
  void power_on();
  /// The reset pin.
  void reset();
  /// The program goes round in place from here on, until a reset.
  void hang();

  /// Whether the UART has room for a byte.
  bool listens() const { return listens_; }
  void hear(std::uint8_t byte);

 private:
  Avr(avr_t* avr, Wires wires);
  void connect_wires();
  void restart(std::uint8_t reset_flag);
  void go_dark();
  void was_reset();
  static void on_core_reset(avr_t* avr);
  static void on_pin(avr_irq_t* irq, std::uint32_t value, void* pin);
  static void on_byte(avr_irq_t* irq, std::uint32_t value, void* self);
  static void on_room(avr_irq_t* irq, std::uint32_t value, void* self);
  static void on_full(avr_irq_t* irq, std::uint32_t value, void* self);

  struct Pin {
    Avr* self;
    int output;
  };
  /// What stood where the program hangs.
  struct Hang {
    std::uint32_t at;
    std::array<std::uint8_t, 2> instruction;
  };

  avr_t* avr_;
  Wires wires_;
  void (*core_reset_)(avr_t*) = nullptr;
  std::array<Pin, kOutputs> pins_ = {};
  std::optional<Hang> hang_;
  std::uint64_t base_ = 0;  ///< cycles before simavr last began to count
  std::uint64_t chance_ = 1;
  std::uint16_t lit_ = 0;
  bool listens_ = true;
};

}  // namespace weft::virtual_rig
