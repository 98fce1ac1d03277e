#pragma once

#include <string>
#include <string_view>

namespace gravure {

/// sha256_text() without the processor's SHA instructions, so that tests reach both ways on one machine.
std::string sha256_text_portable(std::string_view bytes);

}  // namespace gravure
