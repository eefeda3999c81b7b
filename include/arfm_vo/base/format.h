#pragma once

#include <string>

namespace arfm_vo {

/// The text that printf would print.
[[gnu::format(printf, 1, 2)]] std::string Format(const char* format, ...);

}  // namespace arfm_vo
