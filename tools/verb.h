// SPDX-License-Identifier: Apache-2.0
// The verbs of `slf`. Each adds its subcommand; the one that the command line names says what to
// run.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "tools/failure.h"

namespace slf::tools {

/// Set by the parser's callback of the chosen verb, called once parsing is done.
using Run = std::function<Outcome()>;

void add_synth(CLI::App& program, Run& run);
void add_encode(CLI::App& program, Run& run);
void add_html(CLI::App& program, Run& run);
void add_igc(CLI::App& program, Run& run);
void add_settings_verb(CLI::App& program, Run& run);
void add_plan(CLI::App& program, Run& run);
void add_merge(CLI::App& program, Run& run);
void add_pack(CLI::App& program, Run& run);
void add_decode(CLI::App& program, Run& run);
void add_render(CLI::App& program, Run& run);
void add_eval(CLI::App& program, Run& run);
void add_export(CLI::App& program, Run& run);
void add_info(CLI::App& program, Run& run);
void add_truncate(CLI::App& program, Run& run);
void add_annotate(CLI::App& program, Run& run);

}  // namespace slf::tools
