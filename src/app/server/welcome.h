// The first message to a page: what this program is, and what it knows by name.
#pragma once

#include <string>

#include "app/server/sessions.h"

namespace crescente::app {

std::string welcome(const std::string& key, bool taken_up, const SessionLimits& limits);

}  // namespace crescente::app
