// SPDX-License-Identifier: Apache-2.0
// Rows of the settings that observe photographs and fit view maps to them.
#pragma once

#include "encoder/setting_rows.h"

namespace slf {

/// Where a basis or a fit is the paper's alone. Given without --fit and --basis, these choose it.
extern const SettingScope kPaperFit, kSplines;
/// What the default preset has alone.
extern const SettingScope kHierarchicalFit;

void add_fit_rows(SettingTable& rows);

}  // namespace slf
