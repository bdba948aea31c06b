// SPDX-License-Identifier: Apache-2.0
#include "app/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "app/cli/command_parser.h"
#include "app/cli/exit_code.h"
#include "app/cli/help_format.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "core/base/process.h"
#include "core/describe/error_json.h"
#include "core/describe/fields.h"

namespace weft::app {
namespace {

void add_common(Options& options, CommonArguments& common) {
  options.add_flag("--json", &common.json, "Print one JSON document on standard output");
  options.add_flag("-q,--quiet", &common.quiet, "No progress on standard error");
  options.add_flag("--json-events", &common.events,
                   "Progress, notes, errors and the end as lines of JSON on standard error");
  options.add("--threads", &common.threads, "Threads; 0 is all the machine has")
      .shows_default()
      .in_range(0, 1024);
}

bool is_said(int argc, char** argv, std::string_view word) {
  return std::find(argv, argv + argc, word) != argv + argc;
}

// In words on standard error; for programs that asked for JSON, as an object on standard output too.
void tell_error(const Error& error, bool as_json) {
  if (as_json) {
    print_json({{"error", json_of(error)}});
    if (Result<void> printed = flush_output(); !printed) complain(printed.error());
  }
  complain(error);
}

// The verb that the words before an error said, else the program.
const CLI::App& verb_said(const CLI::App& cli) {
  const std::vector<CLI::App*> said = cli.get_subcommands();
  return said.empty() ? cli : verb_said(*said.front());
}

// "weft solve".
std::string words_of_verb(const CLI::App& verb) {
  const CLI::App* parent = verb.get_parent();
  return (parent != nullptr ? words_of_verb(*parent) + " " : "") + verb.get_name();
}

std::string words_of_unknown(const CLI::App& cli, const std::string& unknown) {
  const CLI::App& verb = verb_said(cli);
  std::vector<std::string> known;
  if (unknown.starts_with('-')) {
    for (const CLI::Option* option : verb.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  } else {
    for (const CLI::App* each : verb.get_subcommands(std::function<bool(const CLI::App*)>()))
      known.push_back(each->get_name());
  }
  const std::string words = unknown + " was not expected";
  return known.empty() ? words : words + "; did you mean '" + nearest_word(known, unknown) + "'";
}

// The exit code where there is nothing to run: --help, or a usage error.
std::optional<int> read(CLI::App& cli, int argc, char** argv) {
  try {
    cli.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      cli.exit(error);
      return kDone;
    }
    if (is_said(argc, argv, "--json-events")) speak_events();
    const std::vector<std::string> unknown = cli.remaining(/*recurse=*/true);
    const CLI::App& verb = verb_said(cli);
    // What is not known says more than what is then missing.
    const bool lacks_a_verb = verb.get_require_subcommand_min() > 0 && verb.get_subcommands().empty();
    const std::string why = !unknown.empty() ? words_of_unknown(cli, unknown.front())
                            : lacks_a_verb   ? "a verb is missing"
                                             : error.what();
    tell_error(
        {ErrorKind::kUsage, "the command cannot be read", "", why, "see " + words_of_verb(verb) + " --help"},
        is_said(argc, argv, "--json"));
    tell_end(kUsageError);
    return kUsageError;
  }
}

std::string words_of_exit_codes() {
  std::string text = "Exit codes:";
  std::size_t line = text.size();
  for (const ExitCodeWords& each : kExitCodes) {
    const std::string next = std::to_string(each.code) + " " + each.words;
    if (line + next.size() > 100) text += "\n", line = 0;
    text += (line == 0 ? "" : " ") + next + (each.code == kExitCodes.back().code ? "." : ",");
    line += next.size() + 2;
  }
  return text;
}

// The one place where an error becomes words and an exit code.
int finish(Result<int> result, bool as_json = false) {
  if (Result<void> printed = flush_output(); result && !printed) result = std::move(printed).error();
  if (result) return *result;
  tell_error(result.error(), as_json);
  return exit_code_of(result.error().kind);
}

int finish(const Run& run, const CommonArguments& common) {
  try {
    return finish(run(common), common.json);
  } catch (const std::bad_alloc&) {
    return finish(
        Error{ErrorKind::kTryAgain, "out of memory", "", "", "close other programs, or use a larger machine"},
        common.json);
  } catch (const std::exception& bug) {
    return finish(
        Error{ErrorKind::kInternal, "a bug in weft", "", bug.what(), "report it with the command you ran"},
        common.json);
  }
}

/// The verb that the first words say, and how many they are; old names among them become those of today.
struct SaidVerb {
  const Verb* verb = nullptr;
  int words = 0;
};

SaidVerb said_verb(std::vector<Verb>& verbs, int argc, char** argv) {
  SaidVerb said;
  std::vector<Verb>* among = &verbs;
  while (said.words + 1 < argc) {
    char*& word = argv[said.words + 1];
    const auto found = std::ranges::find_if(*among, [word](const Verb& verb) {
      return verb.name == word || (!verb.old_name.empty() && verb.old_name == word);
    });
    if (found == among->end()) break;
    word = found->name.data();
    said = {&*found, said.words + 1};
    among = &found->verbs;
  }
  return said;
}

// "weft help solve" asks what "weft solve --help" does. Empty where the first word is another.
std::vector<char*> words_for_help(int argc, char** argv) {
  static std::string option = "--help";
  if (argc < 2 || std::string_view(argv[1]) != "help") return {};
  std::vector<char*> words = {argv[0]};
  words.insert(words.end(), argv + 2, argv + argc);
  words.push_back(option.data());
  return words;
}

}  // namespace

void add_verbs(CLI::App& parent, const std::vector<Verb>& verbs, CommonArguments& common,
               std::vector<RunOfVerb>& runs) {
  parent.require_subcommand(1);
  for (const Verb& verb : verbs) {
    CLI::App* cli = parent.add_subcommand(verb.name, verb.help);
    if (!verb.group.empty()) cli->group(verb.group);
    if (!verb.verbs.empty()) add_verbs(*cli, verb.verbs, common, runs);
    if (verb.add == nullptr) continue;
    Options options(*cli);
    runs.push_back({cli, verb.add(options)});
    add_common(options, common);
  }
}

int run_program(Program program, int argc, char** argv) {
  if (std::vector<char*> words = words_for_help(argc, argv); !words.empty())
    return run_program(std::move(program), static_cast<int>(words.size()), words.data());
  const SaidVerb said = said_verb(program.verbs, argc, argv);
  if (said.verb != nullptr && !said.verb->program.empty())
    return finish(become(program_beside(said.verb->program), {argv + 1 + said.words, argv + argc}));
  const auto run_by_others = [&] {
    return finish(become(program_beside(program.others), {argv + 1, argv + argc}));
  };
  if (said.verb != nullptr && said.verb->add == nullptr && said.verb->verbs.empty()) return run_by_others();

  CLI::App cli(program.help, program.name);
  cli.set_version_flag("--version", program.version.empty() ? WEFT_VERSION : program.version);
  cli.footer(words_of_exit_codes());
  format_help(cli, columns_of_help());
  CommonArguments common;
  std::vector<RunOfVerb> runs;
  add_verbs(cli, program.verbs, common, runs);
  if (const std::optional<int> code = read(cli, argc, argv)) return *code;
  const auto chosen = std::ranges::find_if(runs, [](const RunOfVerb& each) { return each.verb->parsed(); });
  if (chosen == runs.end()) return run_by_others();
  if (common.events) speak_events();
  const int code = finish(chosen->run, common);
  tell_end(code);
  return code;
}

}  // namespace weft::app
