// CLI11's classes by name, for headers of options.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI
