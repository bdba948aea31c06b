// SPDX-License-Identifier: Apache-2.0
#include "app/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <type_traits>

#include "core/files.h"
#include "core/number.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

template <typename T>
struct NumberIn {
  using Type = T;
};
template <typename T>
struct NumberIn<std::optional<T>> {
  using Type = T;
};
template <typename T>
struct NumberIn<std::vector<T>> {
  using Type = T;
};

// CLI11 by itself takes "nan", "0x10" and what overflows.
std::string why_no_real(const std::string& text) {
  return as_number(text) ? "" : why_no_number(text);
}
template <typename T>
std::string why_not_whole(const std::string& text) {
  return as_whole_number<T>(text) ? "" : "\"" + text + "\" is no whole number in its range";
}

template <typename T>
void check_number(CLI::Option& option) {
  if constexpr (std::is_floating_point_v<T>) {
    option.check(why_no_real);
  } else if constexpr (std::is_integral_v<T>) {
    option.check(why_not_whole<T>);
  }
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
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::in_range(int least, int most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::in_range(double least, double most) const {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::in_range(const NumberRange& range) const {
  return in_range(range.least, range.most);
}

Option Option::above_zero() const {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option Option::not_negative() const {
  option_->check(CLI::NonNegativeNumber);
  return *this;
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

Option Options::add(const std::string& names, Value value, const std::string& help) {
  return std::visit(
      [&](auto* each) {
        using Held = typename NumberIn<std::remove_pointer_t<decltype(each)>>::Type;
        CLI::Option* option = verb_.add_option(names, *each, help);
        if constexpr (std::is_same_v<Held, fs::path>) option->type_name("PATH")->transform(with_a_name);
        check_number<Held>(*option);
        return Option(option);
      },
      value);
}

Option Options::add_flag(const std::string& names, bool* value, const std::string& help) {
  return Option(verb_.add_flag(names, *value, help));
}

Option Options::add_word(const std::string& names, const std::vector<std::string>& words,
                         std::size_t otherwise, const std::function<void(std::size_t)>& choose,
                         const std::string& help) {
  const auto take = [words, choose](const std::string& word) {
    choose(static_cast<std::size_t>(std::ranges::find(words, word) - words.begin()));
  };
  return Option(verb_.add_option_function<std::string>(names, take, help)
                    ->check(CLI::IsMember(words))
                    ->default_str(words[otherwise]));
}

}  // namespace weft::app
