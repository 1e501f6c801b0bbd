// SPDX-License-Identifier: Apache-2.0
// slf: surface light fields on the command line. One file per verb; this one parses, runs and
// turns what went wrong into one line and an exit code.
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string_view>
#include <vector>

#include "tools/heap.h"
#include "tools/interrupt.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

constexpr const char* kNoMemory = "slf: not enough memory\n";

int report(const Failure& failure) {
  std::fprintf(stderr, "slf: %s\n", printable(failure.message).c_str());
  return failure.code;
}

/// An exception that leaves a worker thread ends here: same line, same exit code as in main().
[[noreturn]] void on_terminate() {
  int code = kInternal;
  try {
    if (const auto current = std::current_exception()) std::rethrow_exception(current);
  } catch (const std::bad_alloc&) {
    code = kLimitExceeded;
  } catch (...) {
  }
  std::fputs(code == kLimitExceeded ? kNoMemory : "slf: internal error\n", stderr);
  _exit(code);
}

/// The verb that was being parsed when it failed, for the hint where to read on.
std::string verb_of(const CLI::App& program) {
  const auto chosen = program.get_subcommands();
  return chosen.empty() ? "slf" : "slf " + chosen.front()->get_name();
}

/// What no option and no argument took, in the order it was given.
std::string not_expected(const CLI::App& program) {
  std::string message = "not expected:";
  for (const std::string& word : program.remaining(true)) message += " " + word;
  return message;
}

int usage_error(const CLI::App& program, const CLI::ParseError& error, const char* first) {
  std::string message = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) message = not_expected(program);
  if (program.get_subcommands().empty() && first != nullptr && first[0] != '-')
    message = std::string(first) + " is not a verb";
  for (char& c : message)
    if (c == '\n') c = ' ';
  const std::string verb = verb_of(program);
  return report({kUsage, message + " (see " + verb + " --help)"});
}

/// `slf help [VERB]` as `slf [VERB] --help`; what is no verb stays alone, to be refused.
std::vector<const char*> words_of(const CLI::App& program, int argc, char** argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (argc < 2 || std::string_view(words[1]) != "help") return words;
  words.erase(words.begin() + 1);
  const auto is_meant = [&](const CLI::App* verb) { return verb->get_name() == words[1]; };
  if (argc == 2 || !program.get_subcommands(is_meant).empty()) words.push_back("--help");
  return words;
}

int run(int argc, char** argv) {
  CLI::App program{
      "Surface light fields: photographs and a point cloud in, .slf out, any view back."};
  program.name("slf");
  program.footer(std::string("slf VERB --help, or slf help VERB, has the options of a verb. FILE "
                             "may be - for standard "
                             "input or output.\n\n") +
                 kExitCodeHelp);
  program.set_version_flag("-V,--version", "slf " SLF_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  Run verb;
  add_synth(program, verb);
  add_encode(program, verb);
  add_plan(program, verb);
  add_merge(program, verb);
  add_pack(program, verb);
  add_decode(program, verb);
  add_render(program, verb);
  add_eval(program, verb);
  add_export(program, verb);
  add_info(program, verb);
  add_truncate(program, verb);
  add_annotate(program, verb);
  add_html(program, verb);
  add_igc(program, verb);
  add_settings_verb(program, verb);
  for (CLI::App* each : program.get_subcommands({})) each->footer("Exit codes: slf --help");
  const std::vector<const char*> words = words_of(program, argc, argv);
  try {
    program.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream said;
    program.exit(asked, said, said);
    const Outcome printed = print(said.str());
    return printed ? static_cast<int>(kSuccess) : report(printed.error());
  } catch (const CLI::ParseError& error) {
    return usage_error(program, error, words.size() > 1 ? words[1] : nullptr);
  }
  const Outcome outcome = verb();
  return outcome ? static_cast<int>(kSuccess) : report(outcome.error());
}

}  // namespace
}  // namespace slf::tools

int main(int argc, char** argv) {
  slf::tools::heap_on_huge_pages();
  slf::tools::install_interrupt_handler();
  std::set_terminate(slf::tools::on_terminate);
  try {
    return slf::tools::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fputs(slf::tools::kNoMemory, stderr);
    return slf::tools::kLimitExceeded;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "slf: internal error: %s\n", slf::tools::printable(error.what()).c_str());
    return slf::tools::kInternal;
  }
}
