// SPDX-License-Identifier: Apache-2.0
// Preloaded into a program: makes it one that has set the locale of its environment, as a desktop
// program does that has a codec for a plug-in. Without it LC_ALL changes nothing in slf.
#include <clocale>
#include <cstdio>
#include <cstdlib>

namespace {

struct SetLocale {
  SetLocale() {
    char text[8];
    const bool set = std::setlocale(LC_ALL, "") != nullptr;
    std::snprintf(text, sizeof text, "%.1f", 0.5);
    if (set && text[1] == ',') return;
    std::fprintf(stderr, "decimal_commas: the locale has none\n");
    std::_Exit(97);
  }
};

const SetLocale kSetLocale;

}  // namespace
