// SPDX-License-Identifier: Apache-2.0
#include "exchange/document.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "core/base/json_document.h"

namespace weft::exchange {

namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

/// Eight hexadecimal digits of a text (FNV-1a of 32 bits).
std::string digits_of(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  std::string digits;
  for (int shift = 28; shift >= 0; shift -= 4) digits += "0123456789abcdef"[hash >> shift & 15U];
  return digits;
}

/// CON, LPT9: names of devices under Windows, with any extension.
bool is_device(std::string_view part) {
  const std::string stem = upper_case(part.substr(0, part.find('.')));
  static constexpr std::array<std::string_view, 5> kDevices = {"CON", "PRN", "AUX", "NUL", "CLOCK$"};
  if (std::ranges::find(kDevices, stem) != kDevices.end()) return true;
  return stem.size() == 4 && (stem.starts_with("COM") || stem.starts_with("LPT")) && is_digit(stem[3]) &&
         stem[3] != '0';
}

/// Why a part of a path is not portable, or null.
const char* objection_to_part(std::string_view part) {
  if (part.empty()) return "a part of it is empty";
  if (part.size() > 255) return "a part of it is longer than 255 bytes";
  if (part == "." || part == ".." || part == "~") return "it leaves or repeats its folder";
  if (part.find_first_of("<>:\"\\|?*$%") != std::string_view::npos) return "one of <>:\"\\|?*$% is in it";
  if (part.back() == '.' || part.back() == ' ') return "a part of it ends with a dot or a blank";
  if (is_device(part)) return "Windows keeps this name for a device";
  return nullptr;
}

}  // namespace

bool is_plain_text(std::string_view text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(text, is_control)) return false;
  try {
    (void)Json(text).dump();
  } catch (const Json::exception&) {
    return false;
  }
  return true;
}

Result<void> check_portable_path(std::string_view path) {
  const char* why = is_plain_text(path) ? nullptr : "it is no UTF-8, or a control character is in it";
  for (std::size_t begin = 0; why == nullptr && begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    why = objection_to_part(path.substr(begin, end - begin));
    begin = end + 1;
  }
  if (why == nullptr) return {};
  return Error{ErrorKind::kBadData, "a file name is not portable", std::string(path), why,
               "give the file a name of letters, digits, '.', '_' and '-'"};
}

std::string identifier_of(std::string_view name) {
  std::string identifier(name);
  bool has_any = false;
  for (char& c : identifier) {
    if (is_letter(c) || is_digit(c)) {
      has_any = true;
    } else {
      c = '_';
    }
  }
  if (!has_any) identifier = "cloth";
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) >= 0x80; }))
    identifier += "_" + digits_of(name);
  return is_digit(identifier.front()) ? "_" + identifier : identifier;
}

std::string number_text(double value) {
  if (value == 0) return "0";
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), error == std::errc() ? end : text.data()};
}

std::string numbers_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number_text(value);
  return text;
}

double ior_of_f0(double f0) {
  return 2 / (1 - std::sqrt(std::clamp(f0, 0.0, 0.9999))) - 1;
}

Alphas alphas_of(double roughness, double anisotropy) {
  const double across = roughness * roughness;
  return {across + (1 - across) * anisotropy * anisotropy, across};
}

}  // namespace weft::exchange
