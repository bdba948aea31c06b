// SPDX-License-Identifier: Apache-2.0
#include "app/cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace weft::app {

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
  CLI::Option* option = std::visit([&](auto* each) { return verb_.add_option(names, *each, help); }, value);
  if (std::holds_alternative<std::filesystem::path*>(value)) option->type_name("PATH");
  return Option(option);
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
