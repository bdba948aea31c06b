// SPDX-License-Identifier: Apache-2.0
#include "bench/solve/registration.h"

#include "bench/program/rows.h"
#include "bench/program/verbs.h"

namespace weft::bench {
namespace {

app::Run add_registration(app::Options&) {
  return [](const app::CommonArguments& common) { return print_rows(registration(common.threads), common); };
}

}  // namespace

app::Verb registration_verb() {
  return {"registration",
          "Shots registered to each other: what a moved one costs and gets back, and what gloss feigns",
          add_registration};
}

}  // namespace weft::bench
