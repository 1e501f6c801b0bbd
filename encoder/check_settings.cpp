// SPDX-License-Identifier: Apache-2.0
#include "encoder/check_settings.h"

#include "encoder/fit/fit_settings.h"
#include "encoder/setting_rows.h"

namespace slf {

Result<Done, InputError> check_settings(const EncoderSettings& s) {
  SLF_CHECK(check_ranges(s));
  SLF_CHECK(check_fit_settings(s.fit));
  if (s.search.any() && s.fit.method != FitMethod::kHierarchical)
    return InputError{Errc::kInvalidArgument, "cross-validation: of the hierarchical fit alone"};
  return Done{};
}

}  // namespace slf
