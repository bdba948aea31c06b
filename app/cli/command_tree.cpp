// SPDX-License-Identifier: Apache-2.0
#include "app/cli/command_tree.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>

#include "app/cli/command_parser.h"

namespace weft::app {
namespace {

std::vector<std::string> split_at(std::string_view text, char border) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(border), text.size());
    if (end > 0) parts.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// What a validator of CLI11 says of itself, in words of ours.
void take_rule(const std::string& rule, CommandOption& option) {
  if (rule.starts_with('{')) {
    option.choices = split_at(rule.substr(1, rule.size() - 2), ',');
  } else if (const std::size_t open = rule.find("in ["); open != rule.npos) {
    const std::size_t dash = rule.find(" - ", open);
    if (dash == rule.npos) return;
    option.range = fmt::format("from {} to {}", rule.substr(open + 4, dash - open - 4),
                               rule.substr(dash + 3, rule.size() - dash - 4));
  } else if (rule == "POSITIVE") {
    option.range = "above 0";
  } else if (rule == "NONNEGATIVE") {
    option.range = "0 or more";
  }
}

CommandOption option_of(const CLI::Option& from) {
  CommandOption option;
  option.is_positional = from.get_positional();
  if (option.is_positional) {
    option.names = {from.get_name(/*positional=*/true)};
  } else {
    for (const std::string& name : from.get_snames()) option.names.push_back("-" + name);
    for (const std::string& name : from.get_lnames()) option.names.push_back("--" + name);
  }
  option.is_required = from.get_required();
  option.takes_value = from.get_items_expected_max() > 0;
  option.takes_many = from.get_items_expected_max() > 1;
  option.help = from.get_description();
  option.otherwise = from.get_default_str();
  if (!option.takes_value) return option;
  const std::string type = from.get_type_name();
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  if (colon != type.npos) {
    for (const std::string& rule : split_at(type.substr(colon + 1), ':')) take_rule(rule, option);
  }
  return option;
}

CommandWord word_of(const CLI::App& cli, const Verb& verb) {
  CommandWord word;
  word.name = verb.name;
  word.help = verb.help;
  word.program = verb.program;
  for (const CLI::Option* option : cli.get_options()) {
    if (option != cli.get_help_ptr()) word.options.push_back(option_of(*option));
  }
  for (const Verb& each : verb.verbs) word.verbs.push_back(word_of(*cli.get_subcommand(each.name), each));
  return word;
}

}  // namespace

CommandWord tree_of(const Program& program) {
  CLI::App cli(program.help, program.name);
  CommonArguments common;
  std::vector<RunOfVerb> runs;
  add_verbs(cli, program.verbs, common, runs);
  return word_of(cli, {.name = program.name, .help = program.help, .verbs = program.verbs});
}

std::string verb_lines_source(const Program& program) {
  std::string lines;
  for (const Verb& verb : program.verbs)
    lines += fmt::format("    {{\"{}\", R\"text({})text\", \"{}\", \"{}\"}},\n", verb.name, verb.help,
                         verb.program, verb.group);
  return "// SPDX-License-Identifier: Apache-2.0\n#include \"app/cli/verb_lines.h\"\n\n"
         "namespace weft::app {\nnamespace {\n\nconstexpr VerbLine kVerbLines[] = {\n" +
         lines +
         "};\n\n}  // namespace\n\nstd::span<const VerbLine> verb_lines() {\n  return kVerbLines;\n}\n\n"
         "}  // namespace weft::app\n";
}

}  // namespace weft::app
