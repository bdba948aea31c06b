// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/number.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace weft::app {

/// One option of a verb: what it needs and what it refuses. A refusal names the option and ends with exit
/// code 64.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option required() const;
  Option excludes(const Option& other) const;
  Option needs(const Option& other) const;

  Option one_of(const std::vector<std::string>& words) const;
  Option in_range(int least, int most) const;
  Option in_range(double least, double most) const;
  Option in_range(const NumberRange& range) const;
  Option above_zero(bool is_whole = false) const;
  Option not_negative(bool is_whole = false) const;

  /// A list is written 1,4,7.
  Option by_commas() const;
  /// A list takes one value each time it is named: --in A --in B.
  Option one_at_a_time() const;
  /// How many values follow its name.
  Option takes(int least, int most) const;
  /// Its help says what it is where it is not given.
  Option shows_default() const;

  /// Whether it was given; once the command line is read.
  bool is_given() const;
  std::string name() const;

 private:
  CLI::Option* option_;
};

/// The options of a verb (CLI11, behind this header). `names` is "input" for a word without a dash, else
/// "-o,--output".
class Options {
 public:
  /// What an option is read into. It must live until the verb has run.
  using Value = std::variant<int*, double*, std::uint32_t*, std::uint64_t*, std::string*,
                             std::filesystem::path*, std::optional<int>*, std::optional<double>*,
                             std::optional<std::string>*, std::vector<int>*, std::vector<double>*,
                             std::vector<std::string>*, std::vector<std::filesystem::path>*>;

  explicit Options(CLI::App& verb) : verb_(verb) {}

  Option add(const std::string& names, Value value, const std::string& help);
  /// An enum by the name of its value; `words` has one a value, in their order. Its help says its default.
  template <typename Enum, std::size_t N>
  Option add_choice(const std::string& names, Enum* value, const std::array<const char*, N>& words,
                    const std::string& help) {
    return add_word(
        names, {words.begin(), words.end()}, static_cast<std::size_t>(*value),
        [value](std::size_t chosen) { *value = static_cast<Enum>(chosen); }, help);
  }
  /// A text that `read` takes, or says why it does not.
  Option add_text(const std::string& names, const std::function<std::string(const std::string&)>& read,
                  const std::string& help);
  /// Some of them, each as that.
  Option add_texts(const std::string& names, const std::function<std::string(const std::string&)>& read,
                   const std::string& help);
  /// Once all are read: of these one must have been given.
  void need_one(const std::vector<Option>& options);
  /// Turns `value` on; "!--no-previews" turns it off.
  Option add_flag(const std::string& names, bool* value, const std::string& help);
  /// One of some words; `choose` is given its place among them. Its help says what it is otherwise.
  Option add_word(const std::string& names, const std::vector<std::string>& words, std::size_t otherwise,
                  const std::function<void(std::size_t)>& choose, const std::string& help);

 private:
  CLI::App& verb_;
};

}  // namespace weft::app
