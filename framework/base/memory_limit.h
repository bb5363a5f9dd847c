// Running out of memory: how it shows, and how to meet a limit of the address space (ulimit -v) early.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>

namespace aftershade {

/// Whether this is what running out of memory looks like: bad_alloc, length_error, a thread that the system
/// refused, or Error(ErrorKind::memory).
bool is_out_of_memory(const std::exception& error);

/// "out of memory (...): what to do".
std::string out_of_memory_text(const std::exception& error);

/// Bytes of address space that this process may still take; nullopt without a limit. Data
/// counts as address space where it has a limit (RLIMIT_AS, RLIMIT_DATA).
std::optional<std::uint64_t> address_space_left();

/// Memory that a process really uses; 0 where it is gone or /proc is not there.
std::uint64_t resident_bytes(int process);
/// Memory that this machine, or the control group of this process, has.
std::uint64_t machine_memory_bytes();

/// Throws Error(ErrorKind::memory) where a limit leaves less than `bytes`; `what` needs them, such as
/// "OpenGL".
void require_address_space(std::uint64_t bytes, const std::string& what);

/// At the start of main. Where the address space or data is limited, malloc keeps to one arena: each other
/// one reserves 64 MiB for a thread, which are never used here. llvmpipe gets as many threads as there is
/// room for, unless LP_NUM_THREADS says how many. A crash in a library that does not check what malloc gave
/// it, and an exception that ends a thread, then end the process with `exit_code` and a message, if memory is
/// what was missing.
void prepare_for_memory_limit(int exit_code);

/// For a program that runs for hours: what one thread frees, the others use again. Otherwise glibc gives
/// threads heaps of their own, and each keeps the most that it ever held. [before the first other thread]
void share_one_heap();

}  // namespace aftershade
