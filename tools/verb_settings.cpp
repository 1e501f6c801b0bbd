// SPDX-License-Identifier: Apache-2.0
// slf settings: what the encoder can be told, for people and for programs that tell it.
#include <memory>

#include "tools/options.h"
#include "tools/setting_options.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

std::string settings_text() {
  std::string out, group;
  for (const SettingInfo& setting : encoder_settings()) {
    if (setting.group != group) out += "\n" + setting.group + "\n";
    group = setting.group;
    out += text("  %-22s %-40s %s\n", setting.name.c_str(), type_of(setting).c_str(),
                setting.initial.c_str());
  }
  return out;
}

}  // namespace

void add_settings_verb(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "settings", "List the settings of slf encode: name, range, what it is where nothing is said");
  auto common = std::make_shared<CommonOptions>();
  add_json(*verb, *common);
  verb->callback([&run, common] {
    run = [common]() -> Outcome {
      return common->json ? print(settings_table_json()) : print(settings_text());
    };
  });
}

}  // namespace slf::tools
