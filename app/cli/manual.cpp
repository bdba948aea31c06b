// SPDX-License-Identifier: Apache-2.0
#include "app/cli/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "app/cli/exit_code.h"

namespace weft::app {
namespace {

constexpr std::size_t kColumns = 78;

/// Text that no macro and no escape of roff is in.
std::string literal(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

/// An argument of a macro; \& keeps a word such as "No" from being one.
std::string argument(std::string_view text) {
  return "\\&" + literal(text);
}

/// Whether `word` ends a sentence, given what follows.
bool ends_sentence(const std::string& word, const std::string& next) {
  return !word.empty() && word.back() == '.' && !next.empty() &&
         std::islower(static_cast<unsigned char>(next.front())) == 0;
}

/// Lines of text, each sentence on lines of its own.
std::string prose(const std::string& text) {
  std::istringstream words(text);
  std::string lines, line, before;
  const auto end_line = [&] {
    if (!line.empty()) lines += line + "\n";
    line.clear();
  };
  for (std::string word; words >> word; before = word) {
    const std::string next = literal(word);
    if (ends_sentence(before, word) || line.size() + 1 + next.size() > kColumns) end_line();
    if (line.empty() && (next.front() == '.' || next.front() == '\'')) line = "\\&";
    line += (line.empty() || line == "\\&" ? "" : " ") + next;
  }
  end_line();
  return lines;
}

std::string with_full_stop(std::string text) {
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

std::string joined_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// "Fl o , Fl -output Ar PATH", "Ar session".
std::string macros_of(const CommandOption& option) {
  if (option.is_positional) return "Ar " + argument(option.names.front());
  std::string text;
  for (const std::string& name : option.names)
    text += (text.empty() ? "Fl " : " , Fl ") + argument(name.substr(1));
  if (option.takes_value) text += " Ar " + argument(option.value.empty() ? "VALUE" : option.value);
  return text;
}

std::string item_of(const CommandOption& option) {
  std::string said = with_full_stop(option.help);
  if (!option.choices.empty()) said += " One of " + joined_words(option.choices) + ".";
  if (!option.range.empty()) said += " A number " + option.range + ".";
  if (option.takes_value && !option.otherwise.empty()) said += " Default " + option.otherwise + ".";
  if (option.is_required && !option.is_positional) said += " It must be given.";
  return ".It " + macros_of(option) + "\n" + prose(said);
}

std::string list_of(const std::vector<CommandOption>& options) {
  if (options.empty()) return "";
  std::string text = ".Bl -tag -width Ds\n";
  for (const CommandOption& option : options) text += item_of(option);
  return text + ".El\n";
}

/// The words of a verb with what must follow them: "weft library tag session [options]".
std::string synopsis_of(const std::string& path, const CommandWord& word) {
  std::string text = ".Nm " + path + "\n";
  if (!word.verbs.empty()) return text + ".Ar verb\n.Op Ar options\n";
  for (const CommandOption& option : word.options) {
    const std::string dots = option.takes_many ? " ..." : "";
    if (option.is_required) {
      text += "." + macros_of(option) + dots + "\n";
    } else if (option.is_positional) {
      text += ".Op " + macros_of(option) + dots + "\n";
    }
  }
  return text + ".Op Ar options\n";
}

/// A verb's own verbs, each with its options, and theirs below them.
std::string verbs_below(const std::string& path, const CommandWord& word) {
  std::string text;
  for (const CommandWord& each : word.verbs) {
    const std::string said = path + " " + each.name;
    text += ".Ss " + said + "\n" + prose(with_full_stop(each.help));
    if (each.verbs.empty()) text += ".Pp\n" + synopsis_of(said, each) + list_of(each.options);
    text += verbs_below(said, each);
  }
  return text;
}

std::string file_stem(std::string path) {
  std::ranges::replace(path, ' ', '-');
  return path;
}

std::string head_of(const std::string& stem, const std::string& help, std::string_view version,
                    std::string_view date) {
  std::string title = stem;
  std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
  std::string line = help;
  if (line.ends_with('.')) line.pop_back();
  return fmt::format(
      ".\\\" SPDX-License-Identifier: Apache-2.0\n.Dd {}\n.Dt {} 1\n.Os weft {}\n.Sh NAME\n"
      ".Nm {}\n.Nd {}\n",
      date, title, version, stem, literal(line));
}

std::string exit_status() {
  std::string text = ".Sh EXIT STATUS\n.Bl -tag -width Ds -compact\n";
  for (const ExitCodeWords& each : kExitCodes)
    text += fmt::format(".It {}\n{}", static_cast<int>(each.code), prose(each.words));
  return text + ".El\n";
}

ManualPage page_of_verb(const std::string& program, const CommandWord& verb, std::string_view version,
                        std::string_view date) {
  const std::string path = program + " " + verb.name;
  const std::string stem = file_stem(path);
  std::string text = head_of(stem, verb.help, version, date) + ".Sh SYNOPSIS\n" + synopsis_of(path, verb) +
                     ".Sh DESCRIPTION\n" + prose(with_full_stop(verb.help)) + list_of(verb.options) +
                     verbs_below(path, verb) + exit_status() + ".Sh SEE ALSO\n.Xr " + file_stem(program) +
                     " 1\n";
  return {stem + ".1", text};
}

ManualPage page_of_program(const CommandWord& program, std::string_view version, std::string_view date) {
  const std::string stem = file_stem(program.name);
  const std::string said = program.name + ": ";
  const std::string help = program.help.starts_with(said) ? program.help.substr(said.size()) : program.help;
  std::string text = head_of(stem, help, version, date) + ".Sh SYNOPSIS\n.Nm " + program.name +
                     "\n.Ar verb\n.Op Ar options\n.Sh DESCRIPTION\n" + prose(with_full_stop(help)) +
                     "Each verb has a page of its own, and tells its units and defaults with\n.Fl \\-help .\n"
                     ".Bl -tag -width Ds\n";
  for (const CommandWord& verb : program.verbs)
    text += ".It Xr " + stem + "-" + verb.name + " 1\n" + prose(with_full_stop(verb.help));
  return {stem + ".1", text + ".El\n" + exit_status()};
}

}  // namespace

std::vector<ManualPage> manual_pages(const CommandWord& program, std::string_view version,
                                     std::string_view date) {
  std::vector<ManualPage> pages = {page_of_program(program, version, date)};
  for (const CommandWord& verb : program.verbs) {
    if (verb.program.empty()) pages.push_back(page_of_verb(program.name, verb, version, date));
  }
  return pages;
}

}  // namespace weft::app
