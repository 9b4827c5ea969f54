// The log as the library sees it: a function that the application owns. The library itself never prints.
#pragma once

#include <functional>
#include <string_view>

namespace crescente {

enum class LogLevel { debug, info, warning, error };

using LogSink = std::function<void(LogLevel, std::string_view)>;

}  // namespace crescente
