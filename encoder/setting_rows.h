// SPDX-License-Identifier: Apache-2.0
// The table of the encoder's settings: one row names, describes, reads and writes one of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slf/settings.h"

namespace slf {

struct SettingRow {
  SettingInfo info;
  /// Puts a value that wrong_value() accepts into its place. Empty: encoder/settings.cpp does more
  /// with it than that.
  std::function<void(EncoderSettings&, const std::string&)> apply;
};

const std::vector<SettingRow>& setting_rows();

}  // namespace slf
