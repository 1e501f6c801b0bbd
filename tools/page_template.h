// SPDX-License-Identifier: Apache-2.0
// The viewer as one page, built by `npm run build` in web/ and taken into the program.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace slf::tools {

/// web/dist/one_file.html as it was when the program was built; empty where it was not there.
std::string_view page_template();

/// The template with {{slf:NAME}} replaced, for every name of `values`, wherever it stands. What is
/// put in is not looked at again. One pass: O(bytes).
std::string filled_template(std::string_view page,
                            const std::map<std::string, std::string>& values);

/// For text between tags and within quotes.
std::string escaped_html(std::string_view text);

/// RFC 4648, with padding.
std::string base64(const void* data, std::size_t size);
void append_base64(std::string& out, const void* data, std::size_t size);
constexpr std::size_t base64_size(std::size_t size) { return (size + 2) / 3 * 4; }

}  // namespace slf::tools
