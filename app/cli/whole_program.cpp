// SPDX-License-Identifier: Apache-2.0
#include "app/cli/whole_program.h"

#include <glog/logging.h>

#include <string_view>

#include "app/cli/command_tree.h"
#include "app/cli/completion.h"
#include "app/cli/exit_code.h"
#include "app/cli/manual.h"
#include "app/cli/terminal.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

/// A file that says what it said before keeps its time, so that nothing is built again for it.
Result<void> write_changed(const fs::path& file, const std::string& text) {
  const Result<std::string> before = read_text(file);
  if (before && *before == text) return {};
  if (Result<void> made = make_writable_folder(file.parent_path()); !made) return made;
  return write_file(file, text);
}

/// DIR/man1/*.1; of weft itself also DIR/completions/ and DIR/verb_lines.cpp.
Result<void> write_manuals(const Program& program, const fs::path& folder) {
  const CommandWord tree = tree_of(program);
  for (const ManualPage& page : manual_pages(tree, WEFT_VERSION, WEFT_VERSION_DATE)) {
    if (Result<void> ok = write_changed(folder / "man1" / page.file, page.text); !ok) return ok;
  }
  if (program.name != kProgramName) return {};
  const fs::path completions = folder / "completions";
  if (Result<void> ok = write_changed(completions / "weft.bash", bash_completion(tree)); !ok) return ok;
  if (Result<void> ok = write_changed(completions / "weft.zsh", zsh_completion(tree)); !ok) return ok;
  if (Result<void> ok = write_changed(completions / "weft.fish", fish_completion(tree)); !ok) return ok;
  return write_changed(folder / "verb_lines.cpp", verb_lines_source(program));
}

}  // namespace

int run_whole_program(const Program& program, int argc, char** argv) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres writes a line for every step of a fit that failed
  if (argc != 3 || std::string_view(argv[1]) != "--manuals") return run_program(program, argc, argv);
  const Result<void> written = write_manuals(program, argv[2]);
  if (written) return kDone;
  complain(written.error());
  return exit_code_of(written.error().kind);
}

}  // namespace weft::app
