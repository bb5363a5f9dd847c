# aftershade_embed_text(TARGET NAME FILES...): std::string_view aftershade::NAME() in the target is these files, joined.
#
# Literals of escaped bytes, made when building, so that a change of a file rebuilds the target.
set(AFTERSHADE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
function(aftershade_embed_text TARGET NAME)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE FILES)
  set(RESULT ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp)
  add_custom_command(
    OUTPUT ${RESULT}
    COMMAND ${CMAKE_COMMAND} -DNAME=${NAME} -DRESULT=${RESULT} "-DFILES=${FILES}" -P ${AFTERSHADE_EMBED_SCRIPT}
    DEPENDS ${FILES} ${AFTERSHADE_EMBED_SCRIPT}
    VERBATIM)
  target_sources(${TARGET} PRIVATE ${RESULT})
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  set(LITERALS "")
  foreach(FILE ${FILES})
    # Read as hexadecimal digits: CMake's own strings lose semicolons and brackets here and there.
    file(READ ${FILE} BYTES HEX)
    string(REGEX REPLACE "(..)" "\\\\x\\1" BYTES "${BYTES}")
    # A literal for each line keeps the file readable for editors and compilers.
    string(REPLACE "\\x0a" "\\x0a\"\n    \"" BYTES "${BYTES}")
    string(APPEND LITERALS "    \"${BYTES}\"\n")
  endforeach()
  file(WRITE ${RESULT} "// Written by cmake/embed.cmake.
#include <string_view>

namespace aftershade {

std::string_view ${NAME}() {
    static constexpr std::string_view text =
${LITERALS}    ;
    return text;
}

}  // namespace aftershade
")
endif()
