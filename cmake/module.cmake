# aftershade_module(NAME SOURCES ... LINKS ... PRIVATE_LINKS ...)
#
# One target per folder of framework/. LINKS names what the module's headers use; everything else is private, so
# that an include against the direction of DESIGN.md section 1 fails to compile or link.
add_library(aftershade_options INTERFACE)
target_include_directories(aftershade_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(aftershade_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off)
# GCC 12 warns of std::string's own operator+ when it is inlined (GCC bug 105651).
target_compile_options(aftershade_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(AFTERSHADE_WARNINGS_AS_ERRORS)
  target_compile_options(aftershade_options INTERFACE -Werror)
endif()
if(AFTERSHADE_SANITIZE)
  add_compile_options(-fsanitize=${AFTERSHADE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=${AFTERSHADE_SANITIZE})
  # GCC 12 loses track of std::regex under sanitizers (GCC bug 105562).
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
endif()

function(aftershade_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(aftershade_${name} STATIC ${ARG_SOURCES})
  target_link_libraries(aftershade_${name} PUBLIC ${ARG_LINKS} PRIVATE aftershade_options ${ARG_PRIVATE_LINKS})
endfunction()
