// SPDX-License-Identifier: Apache-2.0
// The hardware of the LED board: an ATmega328P at 16 MHz, LEDs 1 to 6 on PD2 to PD7, 7 to 10 on PB0 to PB3,
// the light below on PB4, the polariser on PC0.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <stdbool.h>
#include <stdint.h>
#include <util/atomic.h>

#include "firmware/board.h"
#include "firmware/parser.h"

#define BAUD 115200
#define BAUD_TOL 3  // 16 MHz gives 2.1 % more, which every USB bridge takes
#include <util/setbaud.h>

enum { kRing = 64, kLedsOnD = 0xFC, kLedsOnB = 0x1F };

static uint8_t reset_cause __attribute__((section(".noinit")));
static struct WeftHeat heat __attribute__((section(".noinit")));

static volatile uint8_t ring[kRing], ring_head, ring_tail;
static volatile uint16_t overruns;
static volatile uint16_t clock_ms;

static struct WeftBoard board;
static struct WeftParser parser;

// The watchdog outlives the reset it caused, and ends a start that takes longer than its shortest time.
static void stop_watchdog(void) __attribute__((naked, used, section(".init3")));
static void stop_watchdog(void) {
  reset_cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

ISR(TIMER1_COMPA_vect) {
  ++clock_ms;
}

ISR(USART_RX_vect) {
  const uint8_t status = UCSR0A;
  const uint8_t byte = UDR0;
  const uint8_t next = (ring_head + 1) % kRing;
  if ((status & (_BV(FE0) | _BV(DOR0))) || next == ring_tail) {
    ++overruns;
    return;
  }
  ring[ring_head] = byte;
  ring_head = next;
}

static void start_hardware(void) {
  // PD2 and PD3 are INT0 and INT1, whose default, low level, a simulator polls at every cycle once they are
  // driven.
  EICRA = _BV(ISC11) | _BV(ISC01);
  DDRD = kLedsOnD;
  DDRB = kLedsOnB;
  DDRC = _BV(DDC0);
  UCSR0A = USE_2X ? _BV(U2X0) : 0;
  UBRR0H = UBRRH_VALUE;
  UBRR0L = UBRRL_VALUE;
  UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
  UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
  TCCR1B = _BV(WGM12) | _BV(CS11);
  OCR1A = F_CPU / 8 / 1000 - 1;
  TIMSK1 = _BV(OCIE1A);
  set_sleep_mode(SLEEP_MODE_IDLE);
  wdt_enable(WDTO_250MS);
  sei();
}

// Off before on: two LEDs are never lit together by the way from one to the next.
static void show(uint16_t lit) {
  const uint8_t d = (uint8_t)(lit << 2) & kLedsOnD;
  const uint8_t b = (uint8_t)(lit >> 6) & kLedsOnB;
  PORTD &= d;
  PORTB &= b;
  PORTD = d;
  PORTB = b;
}

static void turn(uint8_t polariser) {
  PORTC = polariser == kWeftCrossed ? _BV(PORTC0) : 0;
}

static uint16_t now_ms(void) {
  uint16_t now;
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    now = clock_ms;
  }
  return now;
}

static void tick(void) {
  static uint16_t ticked_ms;
  const uint16_t now = now_ms();
  while (ticked_ms != now) {
    ++ticked_ms;
    weft_lamps_tick(&board.lamps);
    show(board.lamps.lit);
  }
}

static void send(const uint8_t* bytes, uint8_t count) {
  for (uint8_t i = 0; i < count; ++i) {
    loop_until_bit_is_set(UCSR0A, UDRE0);
    UDR0 = bytes[i];
  }
}

// What was heard around an overrun has holes.
static void forget_torn_frames(void) {
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
    if (overruns != board.overruns) {
      board.overruns = overruns;
      ring_tail = ring_head;
      weft_parser_forget(&parser);
    }
  }
}

static void hear(void) {
  const uint8_t byte = ring[ring_tail];
  ring_tail = (ring_tail + 1) % kRing;
  if (!weft_parser_take(&parser, byte, board.lamps.uptime_ms)) return;
  board.bad_frames = parser.bad_frames;
  const uint8_t size = weft_board_answer(&board, parser.bytes);
  show(board.lamps.lit);
  turn(board.polariser);
  send(board.reply, size);
}

static void sleep_until_something_happens(void) {
  cli();
  if (ring_head == ring_tail) {
    sleep_enable();
    sei();
    sleep_cpu();
    sleep_disable();
  }
  sei();
}

int main(void) {
  weft_lamps_start(&board.lamps, &heat);
  board.reset_cause = reset_cause & 0x0F;
  start_hardware();
  for (;;) {
    wdt_reset();
    tick();
    forget_torn_frames();
    if (ring_head != ring_tail) {
      hear();
    } else {
      sleep_until_something_happens();
    }
  }
}
