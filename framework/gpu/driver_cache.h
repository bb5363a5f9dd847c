// Mesa's cache of machine code, which it writes behind its caller's back.
#pragma once

#include <string>
#include <string_view>

namespace aftershade::gpu {

/// Before Mesa first looks for its cache, where it will look: it would write through links, and end the
/// process where its index, a sparse file that it maps, finds no room. What keeps Mesa from having a cache,
/// with the remedy; the process then runs without one (MESA_SHADER_CACHE_DISABLE). "" where nothing does, or
/// the user wants none. The first call does the work. [any thread]
const std::string& prepare_driver_cache();

/// Whether a thread is one that writes Mesa's cache ("aftersh:disk$0") and has work, by its /proc/.../stat.
bool is_writing_driver_cache(std::string_view stat);

/// What was compiled before is in Mesa's cache afterwards, where another context finds it: Mesa hands it to
/// threads of least priority. At most a few hundredths of a second, since the disk may hang; then, and where
/// there is no /proc, the other context compiles it once more. [any thread]
void wait_for_driver_cache() noexcept;

}  // namespace aftershade::gpu
