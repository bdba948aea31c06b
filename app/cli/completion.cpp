// SPDX-License-Identifier: Apache-2.0
#include "app/cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <string_view>

namespace weft::app {
namespace {

constexpr std::string_view kHead = "# SPDX-License-Identifier: Apache-2.0\n# Made from the verbs of weft.\n";

using Visit = std::function<void(const std::string& path, const CommandWord& word)>;

/// The program and all verbs below it, with the words that say them.
void walk(const std::string& path, const CommandWord& word, const Visit& visit) {
  visit(path, word);
  for (const CommandWord& each : word.verbs) walk(path + " " + each.name, each, visit);
}

/// In single quotes of a POSIX shell.
std::string shell_quoted(std::string_view text) {
  std::string escaped = "'";
  for (const char c : text) escaped += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return escaped + "'";
}

/// All ways to say a verb, each in quotes.
std::vector<std::string> said_paths(const CommandWord& program) {
  std::vector<std::string> paths;
  walk(program.name, program, [&](const std::string& path, const CommandWord& word) {
    if (&word != &program) paths.push_back(shell_quoted(path));
  });
  return paths;
}

bool takes_number(const CommandOption& option) {
  return option.value == "INT" || option.value == "UINT" || option.value == "FLOAT";
}

std::vector<std::string> words_after(const CommandWord& word) {
  std::vector<std::string> words;
  for (const CommandWord& verb : word.verbs) words.push_back(verb.name);
  for (const CommandOption& option : word.options) {
    if (!option.is_positional) words.insert(words.end(), option.names.begin(), option.names.end());
  }
  words.emplace_back("--help");
  return words;
}

// What may follow an option, in bash.
std::string bash_values(const std::string& path, const CommandWord& word) {
  std::string text;
  for (const CommandOption& option : word.options) {
    if (option.is_positional || !option.takes_value) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(shell_quoted(path + " " + name));
    const std::string action =
        !option.choices.empty()
            ? fmt::format("words={}", shell_quoted(fmt::format("{}", fmt::join(option.choices, " "))))
        : takes_number(option) ? "compopt +o default"
                               : "";
    text +=
        fmt::format("    {}) {}{}takes=1 ;;\n", fmt::join(patterns, "|"), action, action.empty() ? "" : "; ");
  }
  return text;
}

/// Text within [brackets] of _arguments, in zsh.
std::string zsh_help(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string zsh_arguments(const CommandWord& word) {
  std::string text;
  for (const CommandOption& option : word.options) {
    if (option.is_positional) continue;
    std::string value;
    if (!option.choices.empty()) {
      value = fmt::format(":{}:({})", option.value, fmt::join(option.choices, " "));
    } else if (option.takes_value) {
      value = fmt::format(":{}:{}", option.value, takes_number(option) ? " " : "_files");
    }
    for (const std::string& name : option.names) {
      const std::string once = option.takes_many ? "*" : fmt::format("({})", fmt::join(option.names, " "));
      text += fmt::format(" \\\n        {}",
                          shell_quoted(once + name + "[" + zsh_help(option.help) + "]" + value));
    }
  }
  return text + " \\\n        '*:file:_files'";
}

std::string fish_option(const std::string& path, const CommandOption& option) {
  std::string text = fmt::format("complete -c weft -n {}", shell_quoted("__weft_said " + path));
  for (const std::string& name : option.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (!option.choices.empty()) {
    text += fmt::format(" -x -a {}", shell_quoted(fmt::format("{}", fmt::join(option.choices, " "))));
  } else if (option.takes_value) {
    text += takes_number(option) ? " -x" : " -r";
  }
  std::string help;
  for (const char c : option.help) help += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return text + " -d '" + help + "'\n";
}

}  // namespace

std::string bash_completion(const CommandWord& program) {
  std::string values, words;
  walk(program.name, program, [&](const std::string& path, const CommandWord& word) {
    values += bash_values(path, word);
    words += fmt::format("      {}) words={} ;;\n", shell_quoted(path),
                         shell_quoted(fmt::format("{}", fmt::join(words_after(word), " "))));
  });
  return fmt::format(R"sh({}
_weft() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} said=weft words='' takes='' i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$said ${{COMP_WORDS[i]}}" in
      {}) said+=" ${{COMP_WORDS[i]}}" ;;
    esac
  done
  # --option=value comes as three words.
  if [[ $cur == '=' ]]; then
    cur=''
  elif [[ $prev == '=' ]]; then
    prev=${{COMP_WORDS[COMP_CWORD - 2]}}
  fi
  case "$said $prev" in
{}  esac
  if [[ -z $takes ]]; then
    case $said in
{}    esac
    # A word that may be a file's name is one.
    [[ $said == weft || $cur == -* || $words == [a-z]* ]] || words=''
  fi
  COMPREPLY=()
  while IFS='' read -r i; do COMPREPLY+=("$i"); done < <(compgen -W "$words" -- "$cur")
}}
complete -o default -F _weft weft
)sh",
                     kHead, fmt::join(said_paths(program), " | "), values, words);
}

std::string zsh_completion(const CommandWord& program) {
  std::string cases;
  walk(program.name, program, [&](const std::string& path, const CommandWord& word) {
    cases += fmt::format("    {})\n", shell_quoted(path));
    if (word.verbs.empty()) {
      cases += "      _arguments -s" + zsh_arguments(word) + "\n      ;;\n";
      return;
    }
    cases += "      verbs=(";
    for (const CommandWord& verb : word.verbs)
      cases += "\n        " + shell_quoted(verb.name + ":" + zsh_help(verb.help));
    cases += ")\n      _describe verb verbs\n      ;;\n";
  });
  return fmt::format(R"sh(#compdef weft
{}
_weft() {{
  local said=weft
  local -a verbs
  integer i
  for ((i = 2; i < CURRENT; i++)); do
    case "$said $words[i]" in
      ({}) said+=" $words[i]" ;;
    esac
  done
  case $said in
{}  esac
}}
_weft "$@"
)sh",
                     kHead, fmt::join(said_paths(program), "|"), cases);
}

std::string fish_completion(const CommandWord& program) {
  std::string text = fmt::format(R"sh({}
function __weft_said --description 'Whether these words are what was said so far'
  set -l said weft
  set -l words (commandline -opc)
  set -e words[1]
  for word in $words
    contains -- "$said $word" {} && set said "$said $word"
  end
  test "$said" = "$argv"
end

)sh",
                                 kHead, fmt::join(said_paths(program), " "));
  walk(program.name, program, [&](const std::string& path, const CommandWord& word) {
    for (const CommandWord& verb : word.verbs) {
      std::string help;
      for (const char c : verb.help)
        help += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
      text += fmt::format("complete -c weft -f -n {} -a {} -d '{}'\n", shell_quoted("__weft_said " + path),
                          verb.name, help);
    }
    for (const CommandOption& option : word.options) {
      if (!option.is_positional) text += fish_option(path, option);
    }
  });
  return text;
}

}  // namespace weft::app
