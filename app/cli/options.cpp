// SPDX-License-Identifier: Apache-2.0
#include "app/cli/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "core/base/files.h"
#include "core/base/number.h"
#include "core/describe/fields.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// CLI11 by itself takes "nan", "0x10" and what overflows.
std::string why_no_real(const std::string& text) {
  return as_number(text) ? "" : why_no_number(text);
}
template <typename T>
std::string why_not_whole(const std::string& text) {
  if (as_whole_number<T>(text)) return "";
  const std::optional<double> number = as_number(text);
  if (!number) return why_no_number(text);
  return "\"" + text +
         (*number == std::floor(*number) ? "\" is beyond what it can be" : "\" is no whole number");
}

template <typename T>
void check_number(CLI::Option& option) {
  if constexpr (std::is_floating_point_v<T>) {
    option.check(why_no_real);
  } else if constexpr (std::is_integral_v<T>) {
    option.check(why_not_whole<T>);
  }
}

// A rule whose words in the help are those of CLI11, and whose refusal is that of every other face.
Option hold(CLI::Option* option, CLI::Validator rule, const NumberRange& range, bool is_whole) {
  rule.operation([range, is_whole](const std::string& text) {
    const std::optional<double> number = as_number(text);
    if (number && range.holds(*number)) return std::string();
    return fmt::format("{}, and is {}", rule_of(range, is_whole), text);
  });
  return Option(option->check(rule));
}

// What it is called is its last part: "satin.weft/" and "." name a folder by no name.
std::string with_a_name(const std::string& path) {
  const std::string last = fs::path(path).filename().string();
  if (path.empty() || !(last.empty() || last == "." || last == "..")) return path;
  const fs::path plain = fs::path(path).lexically_normal();
  const fs::path without_end = plain.has_filename() ? plain : plain.parent_path();
  const std::string named = without_end.filename().string();
  return named.empty() || named == "." || named == ".." ? absolute_folder(path).string()
                                                        : without_end.string();
}

}  // namespace

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::needs(const Option& other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) const {
  CLI::Validator rule = CLI::IsMember(words);
  rule.operation([words](const std::string& text) {
    return std::ranges::find(words, text) != words.end() ? std::string() : rule_of_words(words, text);
  });
  option_->check(rule);
  return *this;
}

Option Option::in_range(int least, int most) const {
  return hold(option_, CLI::Range(least, most), {static_cast<double>(least), static_cast<double>(most)},
              true);
}

Option Option::in_range(double least, double most) const {
  return hold(option_, CLI::Range(least, most), {least, most}, false);
}

Option Option::in_range(const NumberRange& range) const {
  return in_range(range.least, range.most);
}

Option Option::above_zero(bool is_whole) const {
  return hold(option_, CLI::PositiveNumber, kAboveZero, is_whole);
}

Option Option::not_negative(bool is_whole) const {
  return hold(option_, CLI::NonNegativeNumber, kNotNegative, is_whole);
}

Option Option::by_commas() const {
  option_->delimiter(',');
  return *this;
}

Option Option::one_at_a_time() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::takes(int least, int most) const {
  option_->expected(least, most);
  return *this;
}

Option Option::shows_default() const {
  option_->capture_default_str();
  return *this;
}

bool Option::is_given() const {
  return option_->count() > 0;
}

std::string Option::name() const {
  return option_->get_name();
}

Option Options::add(const std::string& names, Value value, const std::string& help) {
  return std::visit(
      [&](auto* each) {
        using Held = typename Inner<std::remove_pointer_t<decltype(each)>>::Type;
        CLI::Option* option = verb_.add_option(names, *each, help);
        if constexpr (std::is_same_v<Held, fs::path>) option->type_name("PATH")->transform(with_a_name);
        check_number<Held>(*option);
        return Option(option);
      },
      value);
}

Option Options::add_text(const std::string& names, const std::function<std::string(const std::string&)>& read,
                         const std::string& help) {
  return Option(verb_
                    .add_option_function<std::string>(
                        names, [read](const std::string& text) { read(text); }, help)
                    ->check([read](const std::string& text) { return read(text); }));
}

Option Options::add_texts(const std::string& names,
                          const std::function<std::string(const std::string&)>& read,
                          const std::string& help) {
  return Option(verb_
                    .add_option_function<std::vector<std::string>>(
                        names,
                        [read](const std::vector<std::string>& texts) {
                          for (const std::string& text : texts) read(text);
                        },
                        help)
                    ->check([read](const std::string& text) { return read(text); }));
}

void Options::need_one(const std::vector<Option>& options) {
  verb_.parse_complete_callback([options] {
    if (std::ranges::any_of(options, &Option::is_given)) return;
    std::string names;
    for (const Option& each : options)
      names += (names.empty() ? "" : each.name() == options.back().name() ? " or " : ", ") + each.name();
    throw CLI::RequiredError(names);
  });
}

Option Options::add_flag(const std::string& names, bool* value, const std::string& help) {
  if (!names.starts_with('!')) return Option(verb_.add_flag(names, *value, help));
  return Option(verb_.add_flag_callback(
      names.substr(1), [value] { *value = false; }, help));
}

Option Options::add_word(const std::string& names, const std::vector<std::string>& words,
                         std::size_t otherwise, const std::function<void(std::size_t)>& choose,
                         const std::string& help) {
  const auto take = [words, choose](const std::string& word) {
    choose(static_cast<std::size_t>(std::ranges::find(words, word) - words.begin()));
  };
  return Option(verb_.add_option_function<std::string>(names, take, help)->default_str(words[otherwise]))
      .one_of(words);
}

}  // namespace weft::app
