# aftershade_module(NAME LINKS ... PRIVATE_LINKS ... OPTIMISED SOURCES...)
#
# One target per folder of framework/, of every .cpp file in it. LINKS names what the module's headers use; everything
# else is private, so that an include against the direction of docs/architecture.md fails to compile or link. OPTIMISED names
# the sources whose loops over pixels decide a run's time; the others compile in two thirds of the time at -O1.
option(AFTERSHADE_UNITY "Compile several sources at once: a third of a full build's time, slower after small changes" ON)

add_library(aftershade_options INTERFACE)
target_include_directories(aftershade_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(aftershade_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off)
# Once they are inlined, GCC 12 warns of std::string's own copies and operator+ (GCC bugs 105651, 105329), and GCC 16 of
# std::variant's vectors.
target_compile_options(aftershade_options INTERFACE "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds;-Wno-free-nonheap-object>")
# Embedded texts are longer than every C++ compiler must take; these take them.
target_compile_options(aftershade_options INTERFACE $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>)
# GCC cleans up its memory each time that it has grown by a share; with larger shares a build takes 0.9 of the processor
# time (a source then takes up to 1.6 GB).
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-expand=200 --param ggc-min-heapsize=600000>")
if(AFTERSHADE_WARNINGS_AS_ERRORS)
  target_compile_options(aftershade_options INTERFACE -Werror)
endif()
if(AFTERSHADE_SANITIZE)
  add_compile_options(-fsanitize=${AFTERSHADE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=${AFTERSHADE_SANITIZE})
  # GCC 12 loses track of std::regex under sanitizers (GCC bug 105562).
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

# What most sources include, parsed once. Headers must not count on it: headers_alone compiles each without.
set(AFTERSHADE_STANDARD_HEADERS
  <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <functional> <future> <map> <memory> <mutex> <optional> <set>
  <span> <sstream> <string> <string_view> <utility> <variant> <vector>)
set(AFTERSHADE_PRECOMPILED_HEADERS ${AFTERSHADE_STANDARD_HEADERS} <nlohmann/json.hpp>)
if(AFTERSHADE_FUZZ)
  # Counters at every branch, for libFuzzer to see where an input goes.
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# For code without loops over pixels: it compiles in two thirds of the time.
set(AFTERSHADE_PLAIN_OPTIMISATION $<$<CONFIG:Release>:-O1>)

# GCC keeps the level of optimisation that a precompiled header was made with for every function that the header
# defines, whatever the source that includes it asks for: one header for each level. With one at -O3 for all, sources
# at -O1 took half as long again.
foreach(level IN ITEMS plain optimised)
  add_library(aftershade_precompiled_${level} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(aftershade_precompiled_${level} PRIVATE aftershade_options)
  target_precompile_headers(aftershade_precompiled_${level} PRIVATE ${AFTERSHADE_PRECOMPILED_HEADERS})
endforeach()
target_compile_options(aftershade_precompiled_plain PRIVATE ${AFTERSHADE_PLAIN_OPTIMISATION})

# aftershade_fast_build(TARGET SOURCES_AT_ONCE plain|optimised)
function(aftershade_fast_build target batch level)
  if(level STREQUAL plain)
    target_compile_options(${target} PRIVATE ${AFTERSHADE_PLAIN_OPTIMISATION})
  endif()
  target_precompile_headers(${target} REUSE_FROM aftershade_precompiled_${level})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${AFTERSHADE_UNITY} UNITY_BUILD_BATCH_SIZE ${batch})
endfunction()

function(aftershade_module name)
  cmake_parse_arguments(ARG "" "" "LINKS;PRIVATE_LINKS;OPTIMISED" ${ARGN})
  file(GLOB_RECURSE SOURCES CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  set(links PUBLIC ${ARG_LINKS} PRIVATE aftershade_options ${ARG_PRIVATE_LINKS})
  if(ARG_OPTIMISED)
    list(REMOVE_ITEM SOURCES ${ARG_OPTIMISED})
    add_library(aftershade_${name}_optimised OBJECT ${ARG_OPTIMISED})
    target_link_libraries(aftershade_${name}_optimised ${links})
    aftershade_fast_build(aftershade_${name}_optimised 64 optimised)
    list(APPEND SOURCES $<TARGET_OBJECTS:aftershade_${name}_optimised>)
  endif()
  add_library(aftershade_${name} STATIC ${SOURCES})
  target_link_libraries(aftershade_${name} ${links})
  aftershade_fast_build(aftershade_${name} 64 plain)
endfunction()
