# aftershade_native_effects(TARGET FOLDER FUNCTION): links the native code of effects into the program.
#
# FOLDER/<id>/<id>.cpp is the native code of the effect <id>; other .cpp files of its folder are compiled along, but for
# *_test.cpp. Each library's entry gets a name of its own, and FUNCTION (in namespace aftershade) lists them: a static
# initialiser that registered itself would be dropped by the linker, which takes from an archive only what is asked for.
function(aftershade_native_effects TARGET FOLDER FUNCTION)
  file(GLOB SOURCES CONFIGURE_DEPENDS ${FOLDER}/*/*.cpp)
  list(FILTER SOURCES EXCLUDE REGEX "_test\\.cpp$")
  set(DECLARATIONS "")
  set(ENTRIES "")
  set(COUNT 0)
  foreach(SOURCE ${SOURCES})
    cmake_path(GET SOURCE PARENT_PATH EFFECT_FOLDER)
    cmake_path(GET EFFECT_FOLDER FILENAME ID)
    if(NOT EXISTS ${EFFECT_FOLDER}/${ID}.cpp)
      message(FATAL_ERROR "${SOURCE}: the native code of an effect is ${ID}.cpp (tests are *_test.cpp); it is not there")
    endif()
    set_source_files_properties(${SOURCE} PROPERTIES
                                COMPILE_DEFINITIONS AFTERSHADE_LIBRARY_ENTRY=aftershade_entry_${ID})
    cmake_path(GET SOURCE STEM NAME)
    if(NAME STREQUAL ID)
      string(APPEND DECLARATIONS "extern \"C\" const aftershade_library aftershade_entry_${ID};\n")
      string(APPEND ENTRIES "    {\"${ID}/${ID}.cpp\", &aftershade_entry_${ID}},\n")
      math(EXPR COUNT "${COUNT} + 1")
    endif()
  endforeach()
  set(LISTING ${CMAKE_CURRENT_BINARY_DIR}/${FUNCTION}.cpp)
  file(CONFIGURE OUTPUT ${LISTING} @ONLY CONTENT [[// Written by cmake/native.cmake.
#include <array>

#include "framework/effect/native/native_library.h"

@DECLARATIONS@
namespace aftershade {

std::span<const StaticNativeLibrary> @FUNCTION@();

std::span<const StaticNativeLibrary> @FUNCTION@() {
    static const std::array<StaticNativeLibrary, @COUNT@> libraries{{
@ENTRIES@    }};
    return libraries;
}

}  // namespace aftershade
]])
  add_library(${TARGET} STATIC ${LISTING} ${SOURCES})
  target_link_libraries(${TARGET} PRIVATE aftershade_options)
  # As a plug-in's author has it: the header alone, without a path.
  target_include_directories(${TARGET} PRIVATE ${PROJECT_SOURCE_DIR}/framework/plugin)
endfunction()
