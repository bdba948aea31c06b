// SPDX-License-Identifier: Apache-2.0
#include "app/cli/command_line.h"

#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <string_view>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "core/process.h"

namespace weft::app {
namespace {

struct RunOfVerb {
  const CLI::App* verb;
  Run run;
};

void add_common(Options& options, CommonArguments& common) {
  options.add_flag("--json", &common.json, "Print one JSON document on standard output");
  options.add_flag("-q,--quiet", &common.quiet, "No progress on standard error");
  options.add_flag("--json-events", &common.events,
                   "Progress, notes, errors and the end as lines of JSON on standard error");
  options.add("--threads", &common.threads, "Threads; 0 is all the machine has")
      .shows_default()
      .in_range(0, 1024);
}

void add_verbs(CLI::App& parent, std::span<const Verb> verbs, CommonArguments& common,
               std::vector<RunOfVerb>& runs) {
  parent.require_subcommand(1);
  for (const Verb& verb : verbs) {
    CLI::App* cli = parent.add_subcommand(verb.name, verb.help);
    if (!verb.verbs.empty()) add_verbs(*cli, verb.verbs, common, runs);
    if (verb.add == nullptr) continue;
    Options options(*cli);
    runs.push_back({cli, verb.add(options)});
    add_common(options, common);
  }
}

// The exit code where there is nothing to run: --help, or a usage error.
std::optional<int> read(CLI::App& cli, int argc, char** argv) {
  try {
    cli.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    const std::vector<std::string> unknown = cli.remaining(/*recurse=*/true);
    // What is not known says more than what is then missing.
    if (!asked_for_help && !unknown.empty()) {
      note("weft: " + unknown.front() + " was not expected. See weft --help.");
    } else {
      cli.exit(error);
    }
    return asked_for_help ? kDone : kUsageError;
  }
}

// The one place where an error becomes words and an exit code.
int finish(Result<int> result) {
  if (Result<void> printed = flush_output(); result && !printed) result = std::move(printed).error();
  if (result) return *result;
  complain(result.error());
  return exit_code_of(result.error().kind);
}

int finish(const Run& run, const CommonArguments& common) {
  try {
    return finish(run(common));
  } catch (const std::bad_alloc&) {
    return finish(Error{ErrorKind::kTryAgain, "out of memory", "", "",
                        "close other programs, or use a larger machine"});
  } catch (const std::exception& bug) {
    return finish(
        Error{ErrorKind::kInternal, "a bug in weft", "", bug.what(), "report it with the command you ran"});
  }
}

}  // namespace

int run_program(const Program& program, int argc, char** argv) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres writes a line for every step of a fit that failed
  const auto is_said = [&](const Verb& verb) { return argc > 1 && verb.name == argv[1]; };
  const auto said = std::ranges::find_if(program.verbs, is_said);
  if (said != program.verbs.end() && !said->program.empty())
    return finish(become(program_beside(said->program), {argv + 2, argv + argc}));

  CLI::App cli(program.help, program.name);
  cli.set_version_flag("--version", WEFT_VERSION);
  cli.footer(
      "Exit codes: 0 done, 2 done with warnings under --strict, 64 usage, 65 bad data, 66 no input, 69 "
      "device not there,\n"
      "70 our own bug, 73 cannot create, 74 input/output, 75 try again, 76 protocol, 130 interrupted.");
  CommonArguments common;
  std::vector<RunOfVerb> runs;
  add_verbs(cli, program.verbs, common, runs);
  if (const std::optional<int> code = read(cli, argc, argv)) return *code;
  const auto chosen = std::ranges::find_if(runs, [](const RunOfVerb& each) { return each.verb->parsed(); });
  if (common.events) speak_events();
  const int code = finish(chosen->run, common);
  tell_end(code);
  return code;
}

}  // namespace weft::app
