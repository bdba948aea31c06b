// SPDX-License-Identifier: Apache-2.0
#include "app/cli/help_format.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>

namespace weft::app {
namespace {

constexpr std::size_t kNameColumns = 30;

class WrappedHelp : public CLI::Formatter {
 public:
  explicit WrappedHelp(std::size_t columns) : columns_(columns) {}

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return entry(make_option_name(option, is_positional) + make_option_opts(option),
                 make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* verb) const override {
    return entry(verb->get_display_name(true), verb->get_description());
  }
  std::string make_description(const CLI::App* app) const override {
    return wrapped(CLI::Formatter::make_description(app), columns_, 0);
  }
  std::string make_footer(const CLI::App* app) const override {
    return wrapped(CLI::Formatter::make_footer(app), columns_, 0);
  }

 private:
  std::string entry(const std::string& name, const std::string& says) const {
    std::string text = "  " + wrapped(name, columns_ - 2, 6);
    const std::size_t last = text.size() - (text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
    if (says.empty()) return text + "\n";
    text +=
        last < kNameColumns ? std::string(kNameColumns - last, ' ') : "\n" + std::string(kNameColumns, ' ');
    return text + wrapped(says, columns_ - kNameColumns, kNameColumns) + "\n";
  }

  std::size_t columns_;
};

}  // namespace

std::size_t columns_of_help() {
  winsize size = {};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 100;
  return std::clamp<std::size_t>(size.ws_col, 60, 120);
}

void format_help(CLI::App& program, std::size_t columns) {
  program.formatter(std::make_shared<WrappedHelp>(columns));
}

std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent) {
  std::string all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::size_t used = 0;
    if (!all.empty()) all += "\n" + std::string(indent, ' ');
    for (std::string word; words >> word; used += word.size()) {
      const bool fits = used + 1 + word.size() <= columns;
      if (used > 0) all += fits ? " " : "\n" + std::string(indent, ' ');
      used = used > 0 && fits ? used + 1 : 0;
      all += word;
    }
  }
  if (text.ends_with('\n')) all += '\n';
  return all;
}

}  // namespace weft::app
